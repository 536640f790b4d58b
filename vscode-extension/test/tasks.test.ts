import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { explainable, pageWord } from '../src/explain';
import { taskArguments, taskName } from '../src/taskDefinition';

const manifest = JSON.parse(readFileSync('package.json', 'utf8'));

test('a task becomes a command line that never changes a file', () => {
  assert.deepEqual(taskArguments({ command: 'check' }), ['check', '.']);
  assert.deepEqual(taskArguments({ command: 'fmt' }), ['fmt', '--check', '.']);
  assert.deepEqual(taskArguments({ command: 'fmt', args: ['--check'], paths: ['a.lad'] }), ['fmt', '--check', 'a.lad']);
  assert.deepEqual(taskArguments({ command: 'check', args: ['--target', 'fx3u'], paths: ['a', 'b'] }), [
    'check', '--target', 'fx3u', 'a', 'b',
  ]);
  assert.equal(taskArguments({ command: 'download' }), undefined);
  assert.equal(taskArguments({}), undefined);
});

test('tasks have names', () => {
  assert.equal(taskName({ command: 'check' }), 'check');
  assert.equal(taskName({ command: 'fmt', paths: ['a.lad'] }), 'fmt --check a.lad');
});

test('the problem matcher reads the headlines of check and nothing else', () => {
  const [{ pattern }] = manifest.contributes.problemMatchers;
  const regexp = new RegExp(pattern.regexp);
  const read = (line: string) => {
    const found = regexp.exec(line);
    return found && ['file', 'line', 'column', 'severity', 'code', 'message'].map((name) => found[pattern[name]]);
  };
  assert.deepEqual(read('a b/short.lad:5:12: error[short-circuit]: short circuit: this wire bypasses X1'), [
    'a b/short.lad', '5', '12', 'error', 'short-circuit', 'short circuit: this wire bypasses X1',
  ]);
  assert.deepEqual(read('C:\\p\\a.lad:5:12: warning[missing-end]: no END')?.slice(0, 2), ['C:\\p\\a.lad', '5']);
  for (const line of ['5 | +---| |---', '  note: a.lad:3:1: the other one', '  fix: replace with X7', 'check passed: 4 rungs']) {
    assert.equal(read(line), null, line);
  }
});

test('the address of a page has its word', () => {
  assert.equal(pageWord('/explain/open-circuit.md'), 'open-circuit');
  assert.equal(pageWord('/explain/LD=.md'), 'LD=');
});

test('what the program says about an unknown word is told without its code', () => {
  const stderr = 'error[unknown-word]: `FOO` is neither a rule nor an instruction\n  help: near it are: FOR\n';
  assert.equal(explainable(stderr), '`FOO` is neither a rule nor an instruction');
  assert.equal(explainable('\n'), undefined);
});
