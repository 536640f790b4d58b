/** Cells of a drawing: which characters are wire, what a name is made of, where a row gets a cell that it lost. */

import { eastAsianWidth } from 'get-east-asian-width';

const WIRE = /[-─]/;
/** What a drawing is made of; everything else is part of a word. */
const DRAWN = /[\s|+()[\]{}<>/─-╿-]/;
const UPRIGHT = /[|│]/;
/** A row with a rail at both ends, or what stands for one. */
const ROW = /^\s*[|+│├└┌┝].*[|+│┤┘┐]\s*$/;

/** The cells that a text fills: ideographs fill two. */
export function cellWidth(text: string): number {
  return [...text].reduce((sum, character) => sum + eastAsianWidth(character.codePointAt(0) ?? 0), 0);
}

/** Whether a text is a name or operand, and no drawing. */
export function isWords(text: string): boolean {
  return [...text].every((character) => character === ' ' || !DRAWN.test(character));
}

/** Where a row that lost cells at `at` gets others, and which; `undefined` if it is no row of a drawing. */
export function filling(row: string, at: number): { at: number; cell: string } | undefined {
  if (!ROW.test(row)) {
    return undefined;
  }
  const cell = (column: number) => row[column] ?? '';
  const framed = UPRIGHT.test(cell(at - 1)) && UPRIGHT.test(cell(at)) || (cell(at - 1) === '(' && cell(at) === ')');
  if (framed) {
    return { at, cell: ' ' };
  }
  // What was typed into a box came out of the wire behind it, and goes back there.
  const close = isBracketed(row, at) ? row.slice(at).search(/[\])}]/) + at : -1;
  if (close >= at && (WIRE.test(cell(close + 1)) || cell(close + 1) === ' ')) {
    return { at: close + 1, cell: cell(close + 1) };
  }
  // A word stays in one piece.
  let end = at;
  while (cell(end) !== '' && !DRAWN.test(cell(end))) {
    end += 1;
  }
  if (end > at && (cell(end) === ' ' || UPRIGHT.test(cell(end)))) {
    return { at: end, cell: ' ' };
  }
  const filler = [cell(at), cell(at - 1)].find((beside) => WIRE.test(beside)) ?? ' ';
  // Among cells of its kind it is all the same where a cell is put in, and away from the cursor it cannot move that.
  return { at: at + (cell(at) === filler ? 1 : 0), cell: filler };
}

function isBracketed(row: string, at: number): boolean {
  const last = [...row.slice(0, at)].findLast((character) => /[[({\])}]/.test(character));
  return last !== undefined && /[[({]/.test(last);
}
