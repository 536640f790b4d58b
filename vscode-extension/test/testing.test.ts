import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Covered, freeName, listed, results } from '../src/testing';

const RANGE = { start: { line: 0, character: 0 }, end: { line: 0, character: 4 } };

test('answers of the server are read, and others give nothing', () => {
  const file = { uri: 'file:///a.test.toml', scenarios: [{ name: 'starts', range: RANGE }], problems: [] };
  assert.deepEqual(listed({ files: [file] }), [file]);
  assert.deepEqual(listed({ files: [{ uri: 'file:///a.test.toml' }] }), [
    { uri: 'file:///a.test.toml', scenarios: [], problems: [] },
  ]);
  for (const other of [null, undefined, 7, {}, { files: 7 }, { files: [null, {}, 7] }]) {
    assert.deepEqual(listed(other), []);
    assert.deepEqual(results(other), []);
  }
});

test('what several files have seen of a program is added up', () => {
  const contact = (on: number, off: number) => ({ name: 'X0', range: RANGE, on, off });
  const seen = (on: number, off: number) => {
    const rungs = [{ range: RANGE, evaluated: on + off, contacts: [contact(on, off)] }];
    return { uri: 't', problems: [], scenarios: [], golden: [], coverage: [{ uri: 'p', rungs }] };
  };
  const covered = new Covered();
  covered.add(seen(2, 0));
  covered.add(seen(0, 3));
  assert.deepEqual(covered.files(), [
    { uri: 'p', rungs: [{ range: RANGE, evaluated: 5, contacts: [contact(2, 3)] }] },
  ]);
});

test('a recorded scenario takes no name that is there', async () => {
  const taken = ['motor.test.toml', 'motor-2.test.toml'];
  assert.equal(await freeName('motor.test.toml', async (name) => taken.includes(name)), 'motor-3.test.toml');
  assert.equal(await freeName('motor.test.toml', async () => false), 'motor.test.toml');
});
