import assert from 'node:assert/strict';
import { test } from 'node:test';
import type { PlainChange } from '../src/mending';
import { burstEnd, isMadeBy, moved, oneCellLess, owedFor, type Owed } from '../src/owed';

const change = (line: number, from: number, to: number, text: string, endLine = line): PlainChange => ({
  range: { start: { line, character: from }, end: { line: endLine, character: to } },
  text,
});
const NONE = new Map<number, number>();
const plain = (notes: readonly Owed[] | undefined) => notes?.map(({ at, kind, text }) => [kind, at.line, at.character, text]);

/** What is owed to a row after one change of it, as [column, cells]. */
function cells(row: string, from: number, to: number, text = 'X') {
  const after = row.slice(0, from) + text + row.slice(to);
  return plain(owedFor([change(0, from, to, text)], () => after, NONE))?.map(([, , column, put]) => [column, put]);
}

test('cells that go away are put there again, wire in a wire, beside the cursor where that is the same', () => {
  assert.deepEqual(cells('|   ???   |', 4, 7), [[6, '  ']]);
  assert.deepEqual(cells('|  ???|  |', 3, 6), [[4, '  ']]);
  assert.deepEqual(cells('+---???---+', 4, 7, 'P'), [[6, '--']]);
  assert.deepEqual(cells('|   X1  |', 5, 6, ''), [[6, ' ']]);
  assert.deepEqual(cells('+-------+', 4, 6, ''), [[5, '--']]);
  assert.deepEqual(cells('+--|/|--+', 4, 5, ''), [[4, ' ']]);
  assert.deepEqual(cells('|   X10   |', 4, 7, 'Y1'), [[7, ' ']]);
  assert.deepEqual(cells('|   X1  |', 4, 5, 'Y'), []);
  assert.equal(cells('(* ??? *)', 3, 6), undefined);
  assert.equal(cells('|   X0   |', 4, 6, 'X17'), undefined);
});

test('every typed character is owed an answer, at every cursor', () => {
  assert.deepEqual(plain(owedFor([change(2, 4, 4, '1'), change(0, 43, 43, '1')], () => '', NONE)), [
    ['typed', 0, 44, '1'],
    ['typed', 2, 5, '1'],
  ]);
  const row = '|   Y         Y  |';
  assert.deepEqual(plain(owedFor([change(0, 4, 6, 'Y'), change(0, 15, 17, 'Y')], () => row, NONE)), [
    ['cells', 0, 6, ' '],
    ['cells', 0, 16, ' '],
  ]);
  assert.equal(owedFor([change(0, 4, 4, '\n')], () => '', NONE), undefined);
});

test('what is owed moves with the text; the next character is typed behind the one before it', () => {
  const notes: Owed[] = [
    { at: { line: 0, character: 5 }, kind: 'typed', text: 'X' },
    { at: { line: 0, character: 6 }, kind: 'cells', text: ' ' },
  ];
  assert.deepEqual(plain(moved(notes, [change(0, 5, 5, '1')]).notes), [['typed', 0, 5, 'X'], ['cells', 0, 7, ' ']]);
  assert.deepEqual(plain(moved(notes, [change(0, 0, 0, 'a\nbc')]).notes), [['typed', 1, 7, 'X'], ['cells', 1, 8, ' ']]);
  assert.deepEqual(plain(moved(notes, [change(0, 2, 3, '')]).notes), [['typed', 0, 4, 'X'], ['cells', 0, 5, ' ']]);
  assert.deepEqual(plain(moved(notes, [change(1, 0, 4, 'zzz')]).notes), [['typed', 0, 5, 'X'], ['cells', 0, 6, ' ']]);
});

test('a character that is taken back before its answer leaves nothing to do', () => {
  const { notes, undone } = moved([{ at: { line: 0, character: 5 }, kind: 'typed', text: 'X' }], [change(0, 4, 5, '')]);
  assert.deepEqual(notes, []);
  assert.deepEqual(plain(owedFor([change(0, 4, 5, '')], () => '|   X0   |', undone)), []);
});

test('a change is known by its edits, in any order', () => {
  const edits = [change(0, 1, 2, ''), change(3, 0, 0, 'a\r\nb')];
  assert.ok(isMadeBy([change(3, 0, 0, 'a\nb'), change(0, 1, 2, '')], edits));
  assert.ok(!isMadeBy([change(0, 1, 2, '')], edits));
  assert.ok(!isMadeBy([change(0, 1, 1, '')], [change(0, 1, 2, '')]));
});

test('of a burst all but the last character take cells behind its end', () => {
  const typed = (character: number, line = 0): Owed => ({ at: { line, character }, kind: 'typed', text: 'X' });
  assert.deepEqual(burstEnd([typed(5), typed(6), typed(4, 3), typed(7), typed(9)]), { line: 0, character: 7 });
  assert.equal(burstEnd([typed(5), typed(9)]), undefined);
  assert.equal(burstEnd([{ ...typed(5), kind: 'cells' }, typed(6)]), undefined);
  assert.equal(burstEnd([]), undefined);
  const less = (row: string, character: number) => oneCellLess(row, { line: 0, character });
  assert.deepEqual(less('+--| |---+', 6), change(0, 6, 7, ''));
  assert.deepEqual(less('|  X1  X2 |', 5), change(0, 5, 6, ''));
  assert.equal(less('+--| |-+', 6), undefined);
  assert.equal(less('|  X1', 5), undefined);
});
