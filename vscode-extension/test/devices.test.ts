import assert from 'node:assert/strict';
import { test } from 'node:test';
import { DeviceList, itemOf, usesOf, type DeviceNode } from '../src/devices';

const row = (device: string, more: object = {}) => ({
  device, kind: device[0], symbol: '', comment: '', preset: '', latched: false, reads: 1, writes: 0, gaps: [], ...more,
});
const ANSWER = {
  files: ['main.il', 'pump.il'],
  kinds: [
    { kind: 'X', name: 'input relay', used: 2, next: 'X2' },
    { kind: 'M', name: 'auxiliary relay', used: 17, next: null },
  ],
  devices: [
    row('X0', { symbol: 'Start', comment: 'green button', gaps: [{ first: 'X1', last: 'X1', count: 1 }, { first: 'X3', last: 'X5', count: 3 }] }),
    row('X6', { comment: 'stop' }),
    row('M0', { reads: 2, writes: 1, latched: true }),
  ],
};

function listed(filter = ''): string[] {
  const list = DeviceList.of(ANSWER);
  assert.ok(list);
  const show = (node: DeviceNode) => `${itemOf(node, filter).label}|${itemOf(node, filter).description}`;
  return list.roots(filter).flatMap((kind) => [show(kind), ...list.children(kind, filter).map((node) => `  ${show(node)}`)]);
}

test('kinds have their devices, with the free ones between them', () => {
  assert.deepEqual(listed(), [
    'X input relay|2 used · next free: X2',
    '  X0|Start · green button · read 1 ×, written 0 ×',
    '  X1|1 free',
    '  X3–X5|3 free',
    '  X6|stop · read 1 ×, written 0 ×',
    'M auxiliary relay|17 used',
    '  M0|read 2 ×, written 1 ×',
  ]);
});

test('the filter finds names, symbols and comments by all their words, and shows nothing free', () => {
  assert.deepEqual(listed('BUTTON start').map((line) => line.split('|')[0]), ['X input relay', '  X0']);
  assert.deepEqual(listed('m').map((line) => line.split('|')[0]), ['M auxiliary relay', '  M0']);
  assert.deepEqual(listed('start stop'), []);
  assert.deepEqual(DeviceList.of(ANSWER)?.count('x'), { all: 3, matching: 2 });
});

test('what is found is open, and closing it says nothing of the whole list', () => {
  const kind = DeviceList.of(ANSWER)?.roots('')[0];
  assert.ok(kind);
  assert.equal(itemOf(kind, '').state, 'closed');
  assert.equal(itemOf(kind, 'x').state, 'open');
  assert.notEqual(itemOf(kind, '').id, itemOf(kind, 'x').id);
});

test('every node has an id of its own', () => {
  const list = DeviceList.of(ANSWER);
  assert.ok(list);
  const nodes = list.roots('').flatMap((kind) => [kind, ...list.children(kind, '')]);
  assert.equal(new Set(nodes.map((node) => itemOf(node, '').id)).size, nodes.length);
});

test('the icon says how a device is used', () => {
  const icon = (reads: number, writes: number) => {
    const list = DeviceList.of({ ...ANSWER, devices: [row('M0', { reads, writes })] });
    const kind = list?.roots('')[0];
    assert.ok(list && kind);
    return list.children(kind, '').map((node) => itemOf(node, '').icon);
  };
  assert.deepEqual([icon(1, 0), icon(0, 1), icon(3, 1), icon(0, 0)].flat(), ['eye', 'edit', 'arrow-swap', 'symbol-constant']);
});

test('uses say their place, and their file where there are several', () => {
  const use = { uri: 'file:///pump.il', file: 'pump.il', line: 3, column: 4, rung: 2, access: 'write', text: 'OUT M0' };
  const shown = (files: string[], more: object = {}) =>
    usesOf({ files, devices: [row('M0', { uses: [{ ...use, ...more }] })] }, 'M0').map((node) => itemOf(node, '').description);
  assert.deepEqual(shown(['pump.il']), ['line 3 · rung 2']);
  assert.deepEqual(shown(['main.il', 'pump.il'], { rung: null }), ['pump.il:3']);
  assert.deepEqual(usesOf(null, 'M0'), []);
});

test('uses at the same place are different nodes', () => {
  const use = { uri: 'file:///a.il', file: 'a.il', line: 1, column: 4, rung: 1, access: 'read', text: 'LD M0' };
  const nodes = usesOf({ files: ['a.il'], devices: [row('M0', { uses: [use, use] })] }, 'M0');
  assert.equal(new Set(nodes.map((node) => itemOf(node, '').id)).size, 2);
});

test('an answer of another shape is no list', () => {
  for (const answer of [undefined, null, 'text', {}, { text: 'Used devices' }]) {
    assert.equal(DeviceList.of(answer), undefined);
  }
});
