import assert from 'node:assert/strict';
import { test } from 'node:test';
import type { PlainEdit } from '../src/burst';
import { Preview, type Rows } from '../src/preview';

const ROWS = ['|   X0      X1            Y0  |', '+---| |-----| |-----------( )-+', '', '+--[END]------------------+'];
const rows: Rows = { lineCount: ROWS.length, lineAt: (line) => ROWS[line]! };

const edit = (line: number, from: number, to: number, newText: string, endLine = line): PlainEdit => ({
  range: { start: { line, character: from }, end: { line: endLine, character: to } },
  newText,
});

const change = (line: number, from: number, to: number, text: string, endLine = line) => {
  const { range, newText } = edit(line, from, to, text, endLine);
  return { range, text: newText };
};

/** The rows after an edit, with `^` where the cursor is. */
function made({ range: { start, end }, newText, cursor }: ReturnType<Preview['joined']>): string[] {
  const head = ROWS.slice(0, start.line).map((row) => `${row}\n`).join('') + ROWS[start.line]!.slice(0, start.character);
  const tail = [ROWS[end.line]!.slice(end.character), ...ROWS.slice(end.line + 1)].join('\n');
  return `${head}${newText.slice(0, cursor)}^${newText.slice(cursor)}${tail}`.split('\n');
}

test('a preview has the rows of a change and the other ones', () => {
  const preview = new Preview(rows, change(1, 19, 24, '--\r\n(* note *)\n--', 2));
  const all = Array.from({ length: preview.lineCount }, (_, line) => preview.lineAt(line));
  assert.deepEqual(all, [ROWS[0], '+---| |-----| |------', '(* note *)', '--', ROWS[3]]);
  assert.deepEqual(preview.cursor, { line: 3, character: 2 });
  assert.deepEqual(preview.lines(), { first: 1, end: 3, text: '+---| |-----| |------\n(* note *)\n--\n' });
  const last = new Preview(rows, change(3, 0, 0, '| '));
  assert.deepEqual(last.lines(), { first: 3, end: 4, text: `| ${ROWS[3]}` }, 'behind the last line is no line end');
});

test('what a paste calls for is one edit with it, and the cursor is behind what was pasted', () => {
  const preview = new Preview(rows, change(0, 12, 14, 'X1234'));
  assert.equal(preview.lineAt(0), '|   X0      X1234            Y0  |');
  const joined = preview.joined([edit(0, 17, 20, ''), edit(1, 15, 16, '==')]);
  assert.deepEqual(made(joined), ['|   X0      X1234^         Y0  |', '+---| |-----| |==----------( )-+', ...ROWS.slice(2)]);
  assert.deepEqual(joined.range.start, { line: 0, character: 14 }, 'no more than what differs');
});

test('the cursor follows what is put in before it, and not what is put in at it', () => {
  const preview = new Preview(rows, change(1, 15, 15, '| |'));
  const joined = preview.joined([edit(1, 1, 1, '-'), edit(1, 18, 18, '-'), edit(1, 20, 22, '')]);
  assert.equal(made(joined)[1], '+----| |-----| || |^----------( )-+');
  const inside = preview.joined([edit(1, 14, 19, '=')]);
  assert.equal(made(inside)[1], '+---| |-----| =^----------( )-+');
});

test('a paste of several rows is one edit as well', () => {
  const preview = new Preview(rows, change(2, 0, 0, '|  X2  |\n+--| |-+\n'));
  const joined = preview.joined([edit(2, 1, 1, ' '), edit(3, 1, 1, '-')]);
  assert.deepEqual(made(joined), [...ROWS.slice(0, 2), '|   X2  |', '+---| |-+', '^', ROWS[3]]);
});

test('a character of two units stays whole, and the range with it', () => {
  const wide: Rows = { lineCount: 1, lineAt: () => '|𠀀|' };
  const joined = new Preview(wide, { range: edit(0, 1, 3, '').range, text: '𠀁' }).joined([]);
  assert.deepEqual(joined, { range: edit(0, 1, 3, '').range, newText: '𠀁', cursor: 2 });
});
