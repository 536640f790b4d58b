import assert from 'node:assert/strict';
import { test } from 'node:test';
import { parseStatus, statusItem } from '../src/status';

const FX = { uri: 'file:///a.il', target: 'fx2n', dialect: 'fx', steps: 42, capacity: 8000, rungs: 7 };

test('a program on a PLC shows target, dialect and steps', () => {
  const item = statusItem('running', parseStatus(FX));
  assert.equal(item.text, '$(circuit-board) FX2N · FX · 42/8,000 steps');
  assert.equal(item.severity, 'normal');
  assert.equal(item.command, 'rungwise.selectTarget');
  assert.match(item.tooltip, /42 of 8,000 steps \(0\.5 %\)\nRungs: 7\n/);
});

test('what says nothing new is left out', () => {
  const iec = parseStatus({ uri: 'file:///a.il', target: 'iec', dialect: 'iec', steps: null, capacity: 0 });
  assert.equal(statusItem('running', iec).text, '$(circuit-board) IEC');
  const ladder = parseStatus({ ...FX, dialect: 'ladder', capacity: null });
  assert.equal(statusItem('running', ladder).text, '$(circuit-board) FX2N · 42 steps');
  assert.equal(statusItem('running', undefined).text, '$(circuit-board) Rungwise');
});

test('a program that does not fit warns', () => {
  assert.equal(statusItem('running', parseStatus({ ...FX, steps: 8000 })).severity, 'normal');
  const item = statusItem('running', parseStatus({ ...FX, steps: 1_234_567 }));
  assert.equal(item.severity, 'warning');
  assert.match(item.text, /1,234,567\/8,000 steps/);
});

test('a server that does not run is seen, and the click leads on', () => {
  assert.equal(statusItem('failed', parseStatus(FX)).command, 'rungwise.showOutput');
  assert.equal(statusItem('failed', undefined).severity, 'error');
  assert.equal(statusItem('stopped', undefined).command, 'rungwise.restartServer');
  assert.match(statusItem('starting', undefined).text, /spin/);
});

test('what is no status is refused', () => {
  for (const value of [null, 'fx2n', {}, { uri: 3 }]) {
    assert.equal(parseStatus(value), undefined);
  }
  assert.deepEqual(parseStatus({ uri: 'u', steps: -1, capacity: 'many' }), {
    uri: 'u',
    target: '',
    dialect: '',
    steps: undefined,
    capacity: undefined,
    rungs: undefined,
  });
});
