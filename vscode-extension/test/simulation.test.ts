import assert from 'node:assert/strict';
import { test } from 'node:test';
import { clock, deviceAt, parsePicture } from '../src/simulation';

const range = (line: number) => ({ start: { line, character: 1 }, end: { line, character: 4 } });

test('a picture is sorted by how it is painted, and what is none is left out', () => {
  const elements = [
    { range: range(1), kind: 'wire', energised: true },
    { range: range(2), kind: 'contact', energised: false, conducts: true },
    { range: range(3), kind: 'contact', energised: false, conducts: false },
    { range: range(4), kind: 'value', energised: false, value: 12 },
    { range: range(5), kind: 'forced', energised: false, value: true },
  ];
  const picture = parsePicture({ uri: 'file:///a.lad', version: 3, mode: 'paused', scan: 7, time_ms: 70, elements });
  assert.deepEqual(picture?.energised, [range(1)]);
  assert.deepEqual(picture.ready, [range(2)]);
  assert.deepEqual(picture.values, [{ range: range(4), value: '12' }]);
  assert.deepEqual(picture.forced, [{ range: range(5), value: 'true' }]);
  assert.deepEqual([picture.mode, picture.scan, picture.timeMs, picture.errors], ['paused', 7, 70, []]);
  assert.equal(parsePicture({ uri: 'file:///a.lad' }), undefined);
  assert.equal(parsePicture(null), undefined);
});

test('times are read at a glance', () => {
  assert.deepEqual([clock(350), clock(59_990), clock(725_000)], ['0.35 s', '59.99 s', '12 min 5 s']);
});

test('the device at the cursor is the word that it touches', () => {
  const line = '|  X10    Motor.Run |';
  assert.deepEqual([3, 6, 8, 12].map((at) => deviceAt(line, at)), ['X10', 'X10', undefined, 'Motor.Run']);
});
