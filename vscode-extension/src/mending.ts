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
const MOST_LINES = 400;

/**
 * What may have lost its columns, in the text after the change.
 *
 * `undefined` for what needs no mending: a typed character (on-type formatting looks after it), a cell typed over
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
 * Where a single typed character replaced something else than one cell; else `undefined`.
 *
 * On-type formatting takes every character for one that was squeezed in, so after typing over a selection the drawing is
 * mended instead.
 */
export function typedOverSelection(changes: readonly PlainChange[]): Stretch | undefined {
  const change = changes[0];
  if (changes.length !== 1 || change === undefined || [...change.text].length !== 1 || lineBreaks(change.text) > 0) {
    return undefined;
  }
  const { start, end } = change.range;
  const squeezed = start.line === end.line && start.character === end.character;
  return squeezed ? undefined : { first: start.line, last: start.line, places: [endOf(start, change.text, start.line)] };
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

/**
 * What brings a row back to its width where that is known without asking: cells of one line of a drawing went away.
 *
 * As many are put there, wire in a wire and blanks elsewhere. `row` is the line after the change.
 */
export function filling(changes: readonly PlainChange[], row: string): { at: PlainPosition; text: string } | undefined {
  const change = changes[0];
  if (changes.length !== 1 || change === undefined || lineBreaks(change.text) > 0) {
    return undefined;
  }
  const { start, end } = change.range;
  const missing = start.line === end.line ? end.character - start.character - change.text.length : 0;
  const drawn = /^\s*[|+│├└┌┝].*[|+│┤┘┐]\s*$/.test(row);
  if (missing <= 0 || !drawn) {
    return undefined;
  }
  const at = endOf(start, change.text, start.line);
  const [before, behind] = [row[start.character - 1] ?? '', row[at.character] ?? ''];
  const wire = [behind, before].find((cell) => /[-─]/.test(cell));
  return { at, text: (wire ?? ' ').repeat(missing) };
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
