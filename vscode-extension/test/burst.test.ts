import assert from 'node:assert/strict';
import { test } from 'node:test';
import { areKeystrokes, Burst, isMadeBy, type Ask, type Keystroke, type PlainEdit } from '../src/burst';
import { cellWidth, filling, isWords } from '../src/cells';
import type { PlainChange } from '../src/mending';

const change = (line: number, from: number, to: number, text: string, endLine = line): PlainChange => ({
  range: { start: { line, character: from }, end: { line: endLine, character: to } },
  text,
});

/** A server that knows one thing: a character that was squeezed in takes one of two like cells behind it away. */
const squeezed: Ask = async ({ text, position: { line, character } }) => {
  const row = text.split('\n')[line] ?? '';
  for (let at = character; at < row.length; at++) {
    if (row[at] === row[at + 1] && /[ -]/.test(row[at] ?? '')) {
      return [{ range: { start: { line, character: at }, end: { line, character: at + 1 } }, newText: '' }];
    }
  }
  return [];
};

function applied(lines: string[], edits: readonly PlainEdit[]): string[] {
  const rows = lines.join('\n').split('\n');
  const offset = (line: number, character: number) => rows.slice(0, line).reduce((sum, row) => sum + row.length + 1, character);
  let text = rows.join('\n');
  for (const { range: { start, end }, newText } of [...edits].reverse()) {
    text = text.slice(0, offset(start.line, start.character)) + newText + text.slice(offset(end.line, end.character));
  }
  return text.split('\n');
}

const changedRows = (rows: string[], changes: readonly PlainChange[]) =>
  applied(rows, [...changes].sort((a, b) => a.range.start.line - b.range.start.line || a.range.start.character - b.range.start.character)
    .map(({ range, text }) => ({ range, newText: text })));

/**
 * Types changes, `ahead` of which are in the text before the first is answered, and gives the rows that come of it. The
 * burst has all rows.
 */
async function typed(rows: string[], changes: (readonly Keystroke[])[], ahead: number, ask: Ask = squeezed): Promise<string[]> {
  let text = rows;
  for (let at = 0; at < changes.length; at += ahead) {
    const now = changes.slice(at, at + ahead);
    text = changedRows(text, now[0] ?? []);
    const burst = new Burst(0, text.join('\n'), now[0] ?? []);
    for (const next of now.slice(1)) {
      text = changedRows(text, next);
      burst.add(next);
    }
    while (!burst.isAnswered) {
      await burst.answerNext(ask);
    }
    const edits = burst.edits();
    text = applied(text, edits);
    burst.applied();
    assert.deepEqual(burst.edits(), []);
  }
  return text;
}

/** Keys one after another from a place: a character, `<` for Backspace, `>` for Delete. */
function keys(line: number, column: number, text: string): Keystroke[][] {
  let at = column;
  return [...text].map((key) => {
    if (key === '<') {
      at -= 1;
      return [change(line, at, at + 1, '')];
    }
    const made = key === '>' ? change(line, at, at + 1, '') : change(line, at, at, key);
    at += key === '>' ? 0 : 1;
    return [made];
  });
}

const RUNG = ['|   X0      X1            Y0  |', '+---| |-----| |-----------( )-+'];

test('a burst is answered as the keystrokes one by one', async () => {
  for (const [line, column, text] of [
    [0, 6, '17'], [0, 6, '<<Y17'], [0, 6, '123<<4'], [0, 4, '>>Y2'], [1, 17, '| |'], [1, 17, '| |<<<'], [1, 17, '>>>| |'], [1, 5, '>/'],
  ] as const) {
    const slowly = await typed(RUNG, keys(line, column, text), 1);
    for (const ahead of [2, 3, 99]) {
      assert.deepEqual(await typed(RUNG, keys(line, column, text), ahead), slowly, `${text}, ${ahead} keys ahead`);
    }
    assert.deepEqual(slowly.map((row) => row.length), RUNG.map((row) => row.length), text);
  }
});

test('a selection that is typed over gives its cells back', async () => {
  const placeholder = ['|   ???     X1            Y0  |', RUNG[1]!];
  for (const name of ['X', 'X17', 'X1234']) {
    const changes = [...name].map((character, index) => [index === 0 ? change(0, 4, 7, 'X') : change(0, 4 + index, 4 + index, character)]);
    const wanted = placeholder[0]!.replace(/\?\?\? */, (place) => name.padEnd(place.length));
    for (const ahead of [1, 2, 9]) {
      assert.deepEqual(await typed(placeholder, changes, ahead), [wanted, RUNG[1]]);
    }
  }
});

test('a name that is put in at once is a burst of its characters', async () => {
  assert.deepEqual((await typed(RUNG, [[change(0, 4, 6, 'X17')]], 1))[0], '|   X17     X1            Y0  |');
  assert.deepEqual((await typed(RUNG, [[change(0, 4, 6, 'A')]], 1))[0], '|   A       X1            Y0  |');
});

test('ideographs fill two cells', async () => {
  const known: Keystroke = { ...change(0, 4, 6, 'A'), removed: '触点' };
  assert.deepEqual(await typed(['|   触点   X1   |'], [[known]], 1), ['|   A      X1   |']);
  assert.deepEqual(await typed(['|   ???    X1   |'], [[change(0, 4, 7, '触')]], 1), ['|   触     X1   |']);
  assert.equal(cellWidth('触点X1'), 6);
});

test('several cursors type at the same time', async () => {
  const rows = ['|   X0      Y0   |', '+---| |-----( )--+', '|   Y0           |'];
  const changes = ['Y', '1', '2'].map((key, index) =>
    index === 0 ? [change(0, 12, 14, key), change(2, 4, 6, key)] : [change(2, 4 + index, 4 + index, key), change(0, 12 + index, 12 + index, key)]);
  for (const ahead of [1, 3]) {
    assert.deepEqual(await typed(rows, changes, ahead), ['|   X0      Y12  |', rows[1], '|   Y12          |']);
  }
  const same = [change(0, 4, 4, 'A'), change(0, 12, 12, 'B')];
  assert.deepEqual((await typed(rows, [same], 1))[0], '|   AX0     BY0  |');
});

test('Enter may be answered with lines, and what is typed behind it finds its place', async () => {
  const rows = ['+---+---+', '|   |   |'];
  const branch: Ask = async ({ character }) =>
    character === '\n'
      ? [{ range: { start: { line: 0, character: 4 }, end: { line: 1, character: 0 } }, newText: '' },
        { range: { start: { line: 2, character: 9 }, end: { line: 2, character: 9 } }, newText: '\n+---+   |' }]
      : [];
  const enter = [change(0, 4, 4, '\n')];
  // Before the answer the line below is one further down.
  assert.deepEqual(await typed(rows, [enter, [change(1, 4, 5, 'X')]], 1, branch), ['+---+---+', '|   X   |', '+---+   |']);
  assert.deepEqual(await typed(rows, [enter, [change(2, 4, 5, 'X')]], 2, branch), ['+---+---+', '|   X   |', '+---+   |']);
});

test('what is typed behind Enter goes where its answer wants it', async () => {
  const branch: Ask = async ({ text, character }) =>
    character === '\n'
      ? [{ range: { start: { line: 0, character: 1 }, end: { line: 1, character: 0 } }, newText: '' },
        { range: { start: { line: 1, character: 3 }, end: { line: 1, character: 3 } }, newText: '\n|   ???  |' }]
      : squeezed({ text, position: { line: 1, character: text.split('\n')[1]!.search(/\w +\|$/) + 1 }, character });
  const enter = [change(0, 1, 1, '\n')];
  const end = async (...changes: PlainChange[]) => {
    let text = changedRows(['+--+'], enter);
    const burst = new Burst(0, text.join('\n'), [...enter]);
    for (const next of changes) {
      text = changedRows(text, [next]);
      burst.add([next]);
    }
    while (!burst.isAnswered) {
      await burst.answerNext(branch);
    }
    const { edit, from, to } = burst.placed()!;
    const rows = applied(text, burst.edits());
    assert.deepEqual(applied(text, [edit]), rows);
    return [...rows, edit.newText.slice(0, from).split('\n').at(-1), edit.newText.slice(from, to)];
  };
  assert.deepEqual(await end(), ['+--+', '|   ???  |', '|   ', '???']);
  assert.deepEqual(await end(change(1, 0, 0, 'X'), change(1, 1, 1, '9')), ['+--+', '|   X9   |', '|   X9', '']);
  assert.deepEqual(await end(change(1, 0, 0, 'X'), change(1, 1, 1, '8'), change(1, 1, 2, ''), change(1, 1, 1, '9')), ['+--+', '|   X9   |', '|   X9', '']);
});

test('lines that are no drawing lose cells without others, and places outside are refused', async () => {
  await assert.rejects(typed(['(* ??? *)'], [[change(0, 3, 6, 'X')]], 1));
  await assert.rejects(typed(['(* ??? *)'], [[change(0, 3, 4, '')]], 1));
  const outside: Ask = async () => [{ range: { start: { line: 5, character: 0 }, end: { line: 5, character: 0 } }, newText: 'x' }];
  await assert.rejects(typed(RUNG, keys(0, 6, '1'), 1, outside));
  const never: Ask = () => assert.fail('nothing stands behind');
  assert.deepEqual(await typed(['X1'], keys(0, 2, '2'), 1, never), ['X12']);
});

test('an edit at the cursor takes the next character along', () => {
  const burst = new Burst(7, '|  X  |', [change(7, 4, 5, '')]);
  return burst.answerNext(squeezed).then(() => {
    assert.deepEqual(burst.edits(), [{ range: { start: { line: 7, character: 5 }, end: { line: 7, character: 6 } }, newText: '  ' }]);
  });
});

test('lines belong to a burst as they are in the document', () => {
  const burst = new Burst(3, 'a\nb', [change(3, 0, 0, 'a')]);
  assert.deepEqual([2, 3, 4, 5].map((line) => burst.has(line)), [false, true, true, false]);
  burst.add([change(4, 1, 1, '\n')]);
  assert.equal(burst.lineCount, 3);
  burst.first += 1;
  assert.deepEqual([3, 4, 6, 7].map((line) => burst.has(line)), [false, true, true, false]);
});

test('what is typed within a line, and Enter, are keystrokes; pieces of drawings and several lines are not', () => {
  for (const one of [change(0, 4, 4, 'X'), change(0, 4, 7, ''), change(0, 4, 4, 'T0 K50'), change(0, 4, 4, '\r\n'), change(0, 4, 7, '| |'), change(0, 4, 4, '触')]) {
    assert.ok(areKeystrokes([one]), one.text);
  }
  for (const one of [change(0, 4, 4, '| |'), change(0, 4, 4, 'a\nb'), change(0, 4, 2, '', 1), change(0, 4, 6, '\n'), change(0, 4, 4, 'X'.repeat(65))]) {
    assert.ok(!areKeystrokes([one]), one.text);
  }
  assert.ok(!areKeystrokes([change(0, 4, 4, '\n'), change(2, 4, 4, '\n')]));
  assert.ok(isWords('触点_1.Q') && !isWords('a|b') && !isWords('──'));
});

test('a row that lost cells gets them where they make no difference', () => {
  const filled = (row: string, at: number) => {
    const found = filling(row, at);
    return found && row.slice(0, found.at) + found.cell + row.slice(found.at);
  };
  assert.equal(filled('+--||--+', 4), '+--| |--+');
  assert.equal(filled('+--()--+', 4), '+--( )--+');
  assert.equal(filled('+------+', 4), '+-------+');
  assert.equal(filled('|  X1  Y2  |', 4), '|  X1   Y2  |');
  assert.equal(filled('|  T1 K0|', 7), '|  T1 K0 |');
  assert.equal(filled('+--[MOV K1 D0]--+', 5), '+--[MOV K1 D0]---+');
  assert.deepEqual(filling('|  X   |', 4), { at: 5, cell: ' ' });
  assert.equal(filling('(* X1 *)', 4), undefined);
});

test('a change is known by its edits, in any order', () => {
  const edits = [change(0, 1, 2, ''), change(3, 0, 0, 'a\r\nb')].map(({ range, text }) => ({ range, newText: text }));
  assert.ok(isMadeBy([change(3, 0, 0, 'a\nb'), change(0, 1, 2, '')], edits));
  assert.ok(!isMadeBy([change(0, 1, 2, '')], edits));
  assert.ok(!isMadeBy([change(0, 1, 1, '')], [{ ...edits[0]! }]));
});
