/**
 * What is still owed to a drawing after keystrokes: pure, so that it is tested without an editor.
 *
 * An editor drops the answer to a keystroke when the next one comes first, and asks nothing at all when there are several
 * cursors, as in a snippet that names a device twice. Therefore each keystroke is noted until it has been answered, and
 * what is noted moves with the text.
 */

import type { PlainChange } from './mending';
import type { PlainPosition } from './structuralEdits';

/** One answer that is due: of the server to a typed character, or cells for those that went away. */
export interface Owed {
  /** For a typed character the place behind it, for cells the place where they are put in. */
  readonly at: PlainPosition;
  readonly kind: 'typed' | 'cells';
  readonly text: string;
}

/** The notes after a change, and how many typed characters it took away before they were answered, by line. */
export function moved<Note extends Owed>(
  notes: readonly Note[],
  changes: readonly PlainChange[],
): { notes: Note[]; undone: Map<number, number> } {
  const undone = new Map<number, number>();
  let left = [...notes];
  // Ranges are those before the change, so the lowest one is taken first: it moves nothing above it.
  for (const change of [...changes].sort((a, b) => compare(b.range.start, a.range.start))) {
    left = left.flatMap((note) => {
      const at = movedPlace(note, change);
      if (at === undefined && note.kind === 'typed') {
        undone.set(change.range.start.line, (undone.get(change.range.start.line) ?? 0) + 1);
      }
      return at === undefined ? [] : [{ ...note, at }];
    });
  }
  return { notes: left, undone };
}

function movedPlace({ at, kind }: Owed, { range, text }: PlainChange): PlainPosition | undefined {
  const { start, end } = range;
  // The next character is typed exactly behind the one before it, which does not move by that.
  if (kind === 'typed' ? compare(at, start) <= 0 : compare(at, start) < 0) {
    return at;
  }
  if (compare(at, end) < 0 || (kind === 'typed' && compare(at, end) === 0)) {
    return undefined;
  }
  const rows = text.split(/\r\n|\r|\n/);
  const tail = rows.at(-1) ?? '';
  const behind = at.character - end.character;
  return {
    line: at.line + rows.length - 1 - (end.line - start.line),
    character: at.line !== end.line ? at.character : behind + tail.length + (rows.length === 1 ? start.character : 0),
  };
}

/**
 * What a change owes to the drawing: nothing unless each of its parts is in one line and types a character or takes cells
 * away.
 *
 * `rowAt` gives a line after the change; `undone` is what `moved` said. Of cells that went away as many are put there,
 * wire in a wire and blanks elsewhere.
 */
export function owedFor(
  changes: readonly PlainChange[],
  rowAt: (line: number) => string,
  undone: ReadonlyMap<number, number>,
): Owed[] | undefined {
  const notes: Owed[] = [];
  // Parts in one line push those behind them aside.
  const shifts = new Map<number, number>();
  for (const { range, text } of [...changes].sort((a, b) => compare(a.range.start, b.range.start))) {
    const { start, end } = range;
    if (start.line !== end.line || /[\r\n]/.test(text)) {
      return undefined;
    }
    const { line } = start;
    const shift = shifts.get(line) ?? 0;
    const at = { line, character: start.character + shift + text.length };
    const removed = end.character - start.character - (undone.get(line) ?? 0);
    shifts.set(line, shift + text.length - (end.character - start.character));
    if (text !== '' && removed <= 0 && [...text].length === 1) {
      notes.push({ at, kind: 'typed', text });
    } else if (removed > text.length) {
      const cells = filling(rowAt(line), at, start.character + shift, removed - text.length);
      if (cells === undefined) {
        return undefined;
      }
      notes.push(cells);
    } else if (removed < text.length) {
      return undefined;
    }
  }
  return notes;
}

/** Cells for a row of a drawing from which some went away, or which lost some between `from` and `at`. */
function filling(row: string, at: PlainPosition, from: number, missing: number): Owed | undefined {
  if (!/^\s*[|+│├└┌┝].*[|+│┤┘┐]\s*$/.test(row)) {
    return undefined;
  }
  const [before, behind] = [row[from - 1] ?? '', row[at.character] ?? ''];
  const wire = [behind, before].find((cell) => /[-─]/.test(cell)) ?? ' ';
  // Among cells of its kind it is all the same where a cell is put in, and away from the cursor it cannot move that.
  const character = at.character + (behind === wire ? 1 : 0);
  return { at: { line: at.line, character }, kind: 'cells', text: wire.repeat(missing) };
}

/**
 * Where the burst of keystrokes ends to which the first note belongs: behind the last of the characters that follow it
 * without a gap and are not answered either. `undefined` if it stands alone.
 *
 * The server takes what stands behind a character for the drawing, so it can be asked for the last one only.
 */
export function burstEnd([first, ...others]: readonly Owed[]): PlainPosition | undefined {
  let end = first?.at;
  for (const { at, kind, text } of first?.kind === 'typed' ? others : []) {
    if (end !== undefined && kind === 'typed' && at.line === end.line && at.character === end.character + text.length) {
      end = at;
    }
  }
  return end === first?.at ? undefined : end;
}

/** The edit that takes one cell out of the wire or the blanks that begin at a place; `undefined` if there are none. */
export function oneCellLess(row: string, { line, character }: PlainPosition): PlainChange | undefined {
  const cell = row[character] ?? '';
  const gives = /[ \-─]/.test(cell) && row[character + 1] === cell;
  return gives ? { range: { start: { line, character }, end: { line, character: character + 1 } }, text: '' } : undefined;
}

/** Whether a change is the one that these edits make. */
export function isMadeBy(changes: readonly PlainChange[], edits: readonly PlainChange[]): boolean {
  const key = ({ range, text }: PlainChange) =>
    [range.start.line, range.start.character, range.end.line, range.end.character, text.replace(/\r\n?/g, '\n')].join(':');
  const wanted = edits.map(key).sort();
  const found = changes.map(key).sort();
  return wanted.length === found.length && wanted.every((one, index) => one === found[index]);
}

function compare(a: PlainPosition, b: PlainPosition): number {
  return a.line - b.line || a.character - b.character;
}
