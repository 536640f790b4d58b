import assert from 'node:assert/strict';
import { test } from 'node:test';
import { proofPage, selectedPair } from '../src/proof';

test('the page of an answer is shown, and of no answer none', () => {
  assert.equal(proofPage({ equal: true, page: '# a · b\n' }), '# a · b\n');
  for (const answer of [null, undefined, {}, { page: '' }, { page: 1 }]) {
    assert.equal(proofPage(answer), undefined);
  }
});

test('two selected files are compared with each other', () => {
  assert.deepEqual(selectedPair(['a', 'b']), ['a', 'b']);
  for (const selected of [undefined, 'a', ['a'], ['a', 'b', 'c']]) {
    assert.equal(selectedPair(selected), undefined);
  }
});
