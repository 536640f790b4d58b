/** Which changes of a drawing call for mending, and where: pure, so that it is tested without an editor. */

import type { PlainRange } from './structuralEdits';

/** One replaced range of a change event. */
export interface PlainChange {
  readonly range: PlainRange;
  readonly text: string;
}

/** Beyond this it is a program that was replaced, not a drawing that is being edited. */
const MOST_CHANGES = 16;
const MOST_LINES = 400;

/**
 * The lines, first and last from 0 in the text after the change, that may have lost their columns.
 *
 * `undefined` for what needs no mending: a typed character (on-type formatting looks after it), a cell typed over
 * another one, and the removal of whole lines, which moves nothing sideways.
 */
export function linesToMend(changes: readonly PlainChange[]): { first: number; last: number } | undefined {
  if (changes.length === 0 || changes.length > MOST_CHANGES) {
    return undefined;
  }
  if (changes.length === 1 && !movesCells(changes[0]!)) {
    return undefined;
  }
  // Ranges are those before the change; every change above shifts the lines of those below.
  const sorted = [...changes].sort((a, b) => a.range.start.line - b.range.start.line);
  let shift = 0;
  let first = Number.POSITIVE_INFINITY;
  let last = 0;
  for (const { range, text } of sorted) {
    const start = range.start.line + shift;
    const added = lineBreaks(text);
    first = Math.min(first, start);
    last = Math.max(last, start + added);
    shift += added - (range.end.line - range.start.line);
  }
  return last - first > MOST_LINES ? undefined : { first, last };
}

/** Joins two stretches of lines; the earlier one may have moved since, so one line is added on both sides. */
export function joinLines(
  a: { first: number; last: number } | undefined,
  b: { first: number; last: number },
): { first: number; last: number } {
  return a === undefined
    ? b
    : { first: Math.max(0, Math.min(a.first - 1, b.first)), last: Math.max(a.last + 1, b.last) };
}

function movesCells({ range, text }: PlainChange): boolean {
  const sameLine = range.start.line === range.end.line;
  const removed = sameLine ? range.end.character - range.start.character : Number.POSITIVE_INFINITY;
  if (text === '') {
    // Whole lines from the first column to the first column leave every other line as it was.
    return sameLine || range.start.character !== 0 || range.end.character !== 0;
  }
  const typed = [...text].length === 1 || text === '\r\n';
  return !typed && !(sameLine && lineBreaks(text) === 0 && text.length === removed);
}

function lineBreaks(text: string): number {
  return text.split(/\r\n|\r|\n/).length - 1;
}
