import assert from 'node:assert/strict';
import { test } from 'node:test';
import { configurationOf, flat, forceLine, isEmpty, plainValue, type Reason } from '../src/debugging';

test('F5 without a launch file debugs the program in the editor', () => {
  assert.ok(isEmpty({}));
  assert.ok(!isEmpty({ type: 'rungwise', request: 'launch', name: 'mine' }));
  assert.deepEqual(configurationOf('/plc/motor.lad', 'Debug'), {
    type: 'rungwise', request: 'launch', name: 'Debug', program: '/plc/motor.lad', stopOnEntry: true,
  });
});

test('a force begins with the value, without what the debugger says of it', () => {
  for (const [shown, value] of [['1 (forced)', '1'], ['-5', '-5'], ['0 (1 from the next scan on)', '0'], ['1（强制）', '1']]) {
    assert.equal(plainValue(shown ?? ''), value);
  }
  assert.equal(forceLine('Y0', ' off '), 'force Y0=off');
});

test('reasons stand one below the other', () => {
  const leaf = (text: string): Reason => ({ text, because: [] });
  const tree: Reason = { text: 'a', because: [{ text: 'b', because: [leaf('c')] }, leaf('d')] };
  assert.deepEqual(flat(tree).map(({ reason, depth }) => `${reason.text}${depth}`), ['a0', 'b1', 'c2', 'd1']);
});
