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
