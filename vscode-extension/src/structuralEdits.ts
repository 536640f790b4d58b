/** The structural edits of a ladder drawing: what they are called, and how the server's answer is read. */

/** Names of the edits of the request `rungwise/edit`. Each is a command `rungwise.NAME`. */
export const STRUCTURAL_EDITS = [
  'insertContact',
  'insertNegatedContact',
  'insertCoil',
  'insertSetCoil',
  'insertResetCoil',
  'insertBox',
  'insertBranch',
  'insertRung',
  'insertRungAbove',
  'moveBranchUp',
  'moveBranchDown',
  'wrapInBranch',
  'deleteElement',
  'deleteBranch',
  'negate',
  'mend',
] as const;

export type StructuralEdit = (typeof STRUCTURAL_EDITS)[number];

/** A place in the protocol's form: line and UTF-16 unit, both from 0. */
export interface PlainPosition {
  readonly line: number;
  readonly character: number;
}

export interface PlainRange {
  readonly start: PlainPosition;
  readonly end: PlainPosition;
}

/** Answer of `rungwise/edit`: what to change, and what is selected afterwards. */
export interface EditAnswer {
  readonly edits: readonly { readonly range: PlainRange; readonly newText: string }[];
  /** In the text after the edits; absent when the server leaves the cursor alone. */
  readonly selection: PlainRange | undefined;
}

/** An edit with what is to be selected in its text, from one offset to the other. */
export interface PlacedEdit {
  readonly edit: { readonly range: PlainRange; readonly newText: string };
  readonly from: number;
  readonly to: number;
}

/** All edits of an answer as one that holds what is selected afterwards, from the begin of a line to the end of one. */
export function placedEdit(
  lineAt: (line: number) => string,
  edits: EditAnswer['edits'],
  selection: PlainRange,
): PlacedEdit {
  const added = edits.reduce((sum, { range, newText }) => sum + newText.split('\n').length - 1 - rowsBelow(range), 0);
  const first = Math.min(selection.start.line, ...edits.map(({ range }) => range.start.line));
  const last = Math.max(selection.end.line - added, ...edits.map(({ range }) => range.end.line));
  let newText = Array.from({ length: last - first + 1 }, (_, index) => lineAt(first + index)).join('\n');
  const offset = ({ line, character }: PlainPosition) => {
    const above = newText.split('\n').slice(0, line - first);
    return above.reduce((sum, row) => sum + row.length + 1, character);
  };
  const latestFirst = [...edits].sort((a, b) => comparePositions(b.range.start, a.range.start));
  for (const { range, newText: put } of latestFirst) {
    newText = newText.slice(0, offset(range.start)) + put + newText.slice(offset(range.end));
  }
  const range = { start: { line: first, character: 0 }, end: { line: last, character: lineAt(last).length } };
  return { edit: { range, newText }, from: offset(selection.start), to: offset(selection.end) };
}

/** Checks what came over the wire; `undefined` if it is not an answer. */
export function parseEditAnswer(value: unknown): EditAnswer | undefined {
  const fields = record(value);
  const edits = fields?.['edits'];
  if (!Array.isArray(edits)) {
    return undefined;
  }
  const read = edits.map((edit: unknown) => {
    const range = parseRange(record(edit)?.['range']);
    const newText = record(edit)?.['newText'];
    return range !== undefined && typeof newText === 'string' ? { range, newText } : undefined;
  });
  // An edit that cannot be read would leave half of a change.
  return read.includes(undefined)
    ? undefined
    : { edits: read.filter((edit) => edit !== undefined), selection: parseRange(fields?.['selection']) };
}

/** The operand that a keybinding gives as `"args": {"operand": "X5"}`, or as `"args": "X5"`. */
export function operandOf(args: unknown): string | undefined {
  const operand = typeof args === 'string' ? args : record(args)?.['operand'];
  return typeof operand === 'string' && operand.trim() !== '' ? operand.trim() : undefined;
}

export function comparePositions(a: PlainPosition, b: PlainPosition): number {
  return a.line - b.line || a.character - b.character;
}

function rowsBelow({ start, end }: PlainRange): number {
  return end.line - start.line;
}

function parseRange(value: unknown): PlainRange | undefined {
  const start = parsePosition(record(value)?.['start']);
  const end = parsePosition(record(value)?.['end']);
  return start !== undefined && end !== undefined ? { start, end } : undefined;
}

function parsePosition(value: unknown): PlainPosition | undefined {
  const fields = record(value);
  const line = fields?.['line'];
  const character = fields?.['character'];
  return typeof line === 'number' && typeof character === 'number' ? { line, character } : undefined;
}

function record(value: unknown): Record<string, unknown> | undefined {
  return typeof value === 'object' && value !== null ? (value as Record<string, unknown>) : undefined;
}
