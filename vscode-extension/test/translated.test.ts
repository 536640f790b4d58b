import assert from 'node:assert/strict';
import { test } from 'node:test';
import { translationOf } from '../src/translated';

test('a form becomes a document of its language', () => {
  const form = (to: string) => ({ forms: [{ to, text: 'LD X0\n', certificate: 'proved', notes: ['line 2: why'] }] });
  assert.deepEqual(translationOf(form('fx')), { text: 'LD X0\n', language: 'plc-il', notes: ['line 2: why'] });
  assert.equal(translationOf(form('iec'))?.language, 'plc-il');
  assert.equal(translationOf(form('ladder'))?.language, 'ladder');
  assert.equal(translationOf(form('boolean'))?.language, 'plaintext');
});

test('without a form there is nothing to show', () => {
  for (const answer of [null, undefined, {}, { forms: [] }, { forms: 'no' }, { forms: [{ to: 'fx' }] }]) {
    assert.equal(translationOf(answer), undefined);
  }
});
