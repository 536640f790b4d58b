import assert from 'node:assert/strict';
import { test } from 'node:test';
import { joinStretches, linesToMend, rungPlaces, type PlainChange } from '../src/mending';
import { operandOf, parseEditAnswer, placedEdit } from '../src/structuralEdits';

/** First line, last line and places of a stretch, each place as [line, character]. */
const plain = (stretch: ReturnType<typeof linesToMend>) =>
  stretch && [stretch.first, stretch.last, ...stretch.places.map(({ line, character }) => [line, character])];

const change = (line: number, from: number, endLine: number, to: number, text: string): PlainChange => ({
  range: { start: { line, character: from }, end: { line: endLine, character: to } },
  text,
});

test('a deletion inside a line is mended, whether by Backspace, Delete or Cut', () => {
  assert.deepEqual(plain(linesToMend([change(4, 10, 4, 11, '')])), [4, 4, [4, 10]]);
  assert.deepEqual(plain(linesToMend([change(4, 3, 4, 20, '')])), [4, 4, [4, 3]]);
});

test('joining two lines is mended, removing whole lines is not', () => {
  assert.deepEqual(plain(linesToMend([change(4, 10, 5, 0, '')])), [4, 4, [4, 10]]);
  assert.equal(linesToMend([change(4, 0, 6, 0, '')]), undefined);
});

test('a typed character is left to on-type formatting, a cell typed over moves nothing', () => {
  assert.equal(linesToMend([change(4, 10, 4, 10, 'X')]), undefined);
  assert.equal(linesToMend([change(4, 10, 4, 13, 'X')]), undefined);
  assert.equal(linesToMend([change(4, 10, 4, 13, '---')]), undefined);
  assert.equal(linesToMend([change(4, 10, 4, 10, '\r\n')]), undefined);
  assert.equal(linesToMend([change(4, 10, 4, 10, '触')]), undefined);
});

test('a paste is mended over the lines that it brought', () => {
  assert.deepEqual(plain(linesToMend([change(4, 10, 4, 10, 'X10')])), [4, 4, [4, 13]]);
  assert.deepEqual(plain(linesToMend([change(4, 0, 4, 0, 'a\nb\r\nc\n')])), [4, 7, [7, 0]]);
});

test('several changes at once are one stretch of lines, counted after the changes above', () => {
  const changes = [change(9, 4, 9, 6, 'Y10'), change(2, 4, 2, 6, 'Y10')];
  assert.deepEqual(plain(linesToMend(changes)), [2, 9, [2, 7], [9, 7]]);
  assert.deepEqual(plain(linesToMend([change(9, 0, 9, 2, ''), change(2, 0, 2, 0, 'a\nb\n')])), [2, 11, [4, 0], [11, 0]]);
});

test('a replaced program is not mended', () => {
  assert.equal(linesToMend([change(0, 0, 900, 0, 'x\n'.repeat(900))]), undefined);
  assert.equal(linesToMend(Array.from({ length: 17 }, (_, line) => change(line, 1, line, 2, ''))), undefined);
});

test('stretches are joined with a line to spare', () => {
  const later = { first: 7, last: 7, places: [{ line: 7, character: 3 }] };
  assert.equal(joinStretches(undefined, later), later);
  assert.deepEqual(plain(joinStretches({ first: 0, last: 4, places: [] }, later)), [0, 7, [7, 3]]);
});

test('edits with a selection are one edit of whole lines, which holds what is selected', () => {
  const lines = ['a', '|   |', '+---+', 'b', 'c'];
  const edits = [change(1, 1, 1, 4, '???'), change(2, 2, 2, 3, '|'), change(3, 1, 3, 1, '\nB')].map(({ range, text }) => ({
    range,
    newText: text,
  }));
  const placed = (from: number, line: number, to: number, count: number, some = edits) => {
    const selection = { start: { line: from, character: to }, end: { line, character: to + count } };
    const { edit, from: start, to: end } = placedEdit((at) => lines[at]!, some, selection);
    return [edit.range.start.line, edit.range.end.line, edit.range.end.character, edit.newText, edit.newText.slice(start, end)];
  };
  const text = '|???|\n+-|-+\nb\nB';
  assert.deepEqual(placed(1, 1, 1, 3), [1, 3, 1, text, '???']);
  assert.deepEqual(placed(4, 4, 0, 1), [1, 3, 1, text, 'B']);
  assert.deepEqual(placed(5, 5, 0, 1), [1, 4, 1, `${text}\nc`, 'c']);
  assert.deepEqual(placed(0, 0, 0, 1), [0, 3, 1, `a\n${text}`, 'a']);
  assert.deepEqual(placed(0, 0, 1, 0, edits.slice(0, 1)), [0, 1, 5, 'a\n|???|', '']);
});

test('an answer of the server is read, a broken one is refused', () => {
  const range = { start: { line: 1, character: 2 }, end: { line: 1, character: 4 } };
  const edits = [{ range, newText: '--' }];
  assert.deepEqual(parseEditAnswer({ edits, selection: range }), { edits, selection: range });
  assert.deepEqual(parseEditAnswer({ edits: [] }), { edits: [], selection: undefined });
  assert.equal(parseEditAnswer(null), undefined);
  assert.equal(parseEditAnswer({ edits: [{ range, newText: 5 }] }), undefined);
  assert.equal(parseEditAnswer({ edits: [{ range: { start: {} }, newText: '' }] }), undefined);
});

test('a keybinding may give an operand', () => {
  assert.equal(operandOf('X5'), 'X5');
  assert.equal(operandOf({ operand: ' X5 ' }), 'X5');
  for (const nothing of [undefined, null, '', {}, { operand: '' }, 5]) {
    assert.equal(operandOf(nothing), undefined);
  }
});

test('each rung of a stretch is asked for once, where it was changed, else at a line of its drawing', () => {
  const lines = ['(* one *)', '|  X0 |', '+-| |-+', '', '  ', '|  X1 |', '+-| |-+', 'LABEL:'];
  const asked = (first: number, last: number, ...places: { line: number; character: number }[]) =>
    rungPlaces((line) => lines[line] ?? '', { first, last, places }).map(({ line, character }) => [line, character]);
  assert.deepEqual(asked(0, 7), [[1, 0], [5, 0]]);
  assert.deepEqual(asked(2, 5, { line: 5, character: 4 }), [[2, 0], [5, 4]]);
  assert.deepEqual(asked(7, 7), [[7, 0]]);
  assert.deepEqual(asked(3, 4), []);
});
