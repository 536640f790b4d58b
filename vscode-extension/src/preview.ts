/** A document with a change that is not made yet: pure, so that it is tested without an editor. */

import type { PlainEdit } from './burst';
import { endOf, type PlainChange } from './mending';
import type { PlainPosition } from './structuralEdits';

/** Lines by their numbers from 0. */
export interface Rows {
  readonly lineCount: number;
  lineAt(line: number): string;
}

/** Lines that stand instead of others, as the server reads them: `end` is the first line behind those they replace. */
export interface OtherLines {
  readonly first: number;
  readonly end: number;
  readonly text: string;
}

/** One edit of the document, and where the cursor is in its text afterwards. */
export interface PlacedEdit extends PlainEdit {
  readonly cursor: number;
}

export class Preview implements Rows {
  /** Where what is put in ends, in the text with the change. */
  readonly cursor: PlainPosition;
  private readonly first: number;
  private readonly end: number;
  private readonly rows: readonly string[];

  constructor(
    private readonly document: Rows,
    { range, text }: PlainChange,
  ) {
    const { start, end } = range;
    const head = document.lineAt(start.line).slice(0, start.character);
    const tail = document.lineAt(end.line).slice(end.character);
    this.first = start.line;
    this.end = end.line + 1;
    this.rows = (head + text + tail).split(/\r\n|\r|\n/);
    this.cursor = endOf(start, text, start.line);
  }

  get lineCount(): number {
    return this.document.lineCount + this.added;
  }

  lineAt(line: number): string {
    if (line < this.first) {
      return this.document.lineAt(line);
    }
    return this.rows[line - this.first] ?? this.document.lineAt(line - this.added);
  }

  /** The lines of the change, for the server. */
  lines(): OtherLines {
    const isLast = this.end >= this.document.lineCount;
    return { first: this.first, end: this.end, text: this.rows.join('\n') + (isLast ? '' : '\n') };
  }

  /** The change and edits of the text with it, which do not overlap, as one edit of the document. */
  joined(edits: readonly PlainEdit[]): PlacedEdit {
    const low = Math.min(this.first, ...edits.map(({ range }) => range.start.line));
    const high = Math.max(this.first + this.rows.length - 1, ...edits.map(({ range }) => range.end.line));
    const before = rowsOf(this.document, low, high - this.added);
    const changed = rowsOf(this, low, high);
    const places = edits.map(({ range, newText }) => ({
      start: offsetIn(changed, range.start, low),
      end: offsetIn(changed, range.end, low),
      newText: newText.replace(/\r\n?/g, '\n'),
    }));
    places.sort((a, b) => a.start - b.start || a.end - b.end);
    let after = '';
    let from = 0;
    let cursor = offsetIn(changed, this.cursor, low);
    const wanted = cursor;
    for (const { start, end, newText } of places) {
      after += changed.slice(from, start) + newText;
      from = end;
      // What is put in at the cursor stays behind it, as it does where wire is filled up.
      if (end <= wanted && start < wanted) {
        cursor += newText.length - (end - start);
      } else if (start < wanted) {
        cursor += Math.min(wanted - start, newText.length) - (wanted - start);
      }
    }
    return smallest(before, after + changed.slice(from), cursor, low);
  }

  private get added(): number {
    return this.rows.length - (this.end - this.first);
  }
}

/** The smallest edit that makes a text another one and has the cursor in it. */
function smallest(before: string, after: string, cursor: number, firstLine: number): PlacedEdit {
  const least = Math.min(before.length, after.length);
  let head = 0;
  while (head < Math.min(least, cursor) && before[head] === after[head]) {
    head += 1;
  }
  let tail = 0;
  const behind = Math.min(least - head, after.length - cursor);
  while (tail < behind && before[before.length - 1 - tail] === after[after.length - 1 - tail]) {
    tail += 1;
  }
  // A character of two units stays in one piece.
  head -= isLow(before, head) || isLow(after, head) ? 1 : 0;
  tail -= isLow(before, before.length - tail) || isLow(after, after.length - tail) ? 1 : 0;
  const [start, end] = [head, before.length - tail].map((offset) => positionIn(before, offset, firstLine));
  return { range: { start: start!, end: end! }, newText: after.slice(head, after.length - tail), cursor: cursor - head };
}

function isLow(text: string, at: number): boolean {
  return /^[\uDC00-\uDFFF]/.test(text.charAt(at));
}

function rowsOf(rows: Rows, first: number, last: number): string {
  return Array.from({ length: last - first + 1 }, (_, index) => rows.lineAt(first + index)).join('\n');
}

/** Throws for a line that is not there. */
function offsetIn(text: string, { line, character }: PlainPosition, firstLine: number): number {
  let start = 0;
  for (let left = line - firstLine; left > 0; left--) {
    start = text.indexOf('\n', start) + 1;
    if (start === 0) {
      throw new Error('a place outside of the lines');
    }
  }
  const end = text.indexOf('\n', start);
  return Math.min(start + character, end < 0 ? text.length : end);
}

function positionIn(text: string, offset: number, firstLine: number): PlainPosition {
  const above = text.slice(0, offset).split('\n');
  return { line: firstLine + above.length - 1, character: above.at(-1)?.length ?? 0 };
}
