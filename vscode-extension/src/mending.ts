/** Which changes of a drawing call for mending, and where: pure, so that it is tested without an editor. */

import type { PlainPosition, PlainRange } from './structuralEdits';

/** One replaced range of a change event. */
export interface PlainChange {
  readonly range: PlainRange;
  readonly text: string;
}

/** Lines, first and last from 0, that may have lost their columns, and the places where they did. */
export interface Stretch {
  readonly first: number;
  readonly last: number;
  /** Ends of what was put in or taken out: cells that are missing are put there. */
  readonly places: readonly PlainPosition[];
}

/** Beyond this it is a program that was replaced, not a drawing that is being edited. */
const MOST_CHANGES = 16;
export const MOST_LINES = 400;

/**
 * What may have lost its columns, in the text after the change.
 *
 * `undefined` for what needs no mending: a typed character (it is answered by itself), a cell typed over
 * another one, and the removal of whole lines, which moves nothing sideways.
 */
export function linesToMend(changes: readonly PlainChange[]): Stretch | undefined {
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
  const places: PlainPosition[] = [];
  for (const { range, text } of sorted) {
    const start = range.start.line + shift;
    const added = lineBreaks(text);
    first = Math.min(first, start);
    last = Math.max(last, start + added);
    shift += added - (range.end.line - range.start.line);
    places.push(endOf(range.start, text, start));
  }
  return last - first > MOST_LINES ? undefined : { first, last, places };
}

/**
 * One place in each block of lines without a blank one: a rung is mended as a whole, and a paste may bring several.
 *
 * The place of a change is taken first, then the first line of a drawing, which may have a comment above it.
 */
export function rungPlaces(lineAt: (line: number) => string, { first, last, places }: Stretch): PlainPosition[] {
  const found: PlainPosition[] = [];
  let block: number[] = [];
  for (let line = first; line <= last + 1; line++) {
    if (line <= last && lineAt(line).trim() !== '') {
      block.push(line);
      continue;
    }
    const changed = places.find((place) => block.includes(place.line));
    const drawn = block.find((candidate) => /^\s*[|+│├└┌]/.test(lineAt(candidate))) ?? block[0];
    found.push(...[changed ?? (drawn === undefined ? undefined : { line: drawn, character: 0 })].filter((at) => at !== undefined));
    block = [];
  }
  return found;
}

/** Joins two stretches; the earlier one may have moved since, so one line is added on both sides. */
export function joinStretches(a: Stretch | undefined, b: Stretch): Stretch {
  return a === undefined
    ? b
    : { first: Math.max(0, Math.min(a.first - 1, b.first)), last: Math.max(a.last + 1, b.last), places: b.places };
}

/** Where a text ends that was put in at `start`, which lies in line `line` by now. */
function endOf(start: PlainPosition, text: string, line: number): PlainPosition {
  const rows = text.split(/\r\n|\r|\n/);
  const tail = rows.at(-1) ?? '';
  return { line: line + rows.length - 1, character: (rows.length === 1 ? start.character : 0) + tail.length };
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
