import assert from 'node:assert/strict';
import { chmodSync, mkdtempSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { checkSummary } from '../src/checkResult';
import { CRASH_WINDOW_MS, CrashPolicy } from '../src/crashPolicy';
import { brokenServerMessage, missingServerMessage } from '../src/failure';
import { failureReason, parseVersion, probeServer } from '../src/probe';
import { targetChoices } from '../src/targets';

function program(text: string): string {
  const file = join(mkdtempSync(join(tmpdir(), 'rungwise-')), 'rungwise');
  writeFileSync(file, text);
  chmodSync(file, 0o755);
  return file;
}

test('the version is read from the answer of Rungwise only', () => {
  assert.equal(parseVersion('rungwise 0.1.0\n'), '0.1.0');
  assert.equal(parseVersion('rungwise 1.2.3-rc.1 (a1b2c3)'), '1.2.3-rc.1');
  assert.equal(parseVersion('GNU ls 9.1.0'), undefined);
});

test('a probe tells a server from a wrong, a broken, a hanging and a missing program', async () => {
  const version = await probeServer(program('#!/bin/sh\necho rungwise 0.1.0\n'));
  assert.deepEqual(version, { kind: 'ok', version: '0.1.0' });
  const reason = async (file: string, timeoutMs?: number) => {
    const result = await probeServer(file, timeoutMs);
    return result.kind === 'failed' ? result.reason : 'ok';
  };
  assert.match(await reason(program('#!/bin/sh\necho hello\n')), /not Rungwise: --version printed "hello"/);
  assert.match(await reason(program('#!/bin/sh\necho no library >&2\nexit 127\n')), /exit code 127: no library/);
  assert.match(await reason(program('#!/bin/sh\nexec sleep 30\n'), 200), /no answer within 0\.2 s/);
  assert.match(await reason('/nowhere/rungwise'), /no such file/);
});

test('the codes of the operating system are put in words', () => {
  const error = (code: string) => failureReason({ code, message: 'spawn' }, '', 1000);
  assert.match(error('EACCES'), /no permission/);
  assert.match(error('ENOEXEC'), /not a program for this kind of computer/);
  assert.equal(error('EIO'), 'spawn');
});

test('messages name the file and what to do', () => {
  const wrong = missingServerMessage({ kind: 'missing', origin: 'setting', tried: ['/x'] });
  assert.match(wrong, /"rungwise\.server\.path" names \/x/);
  assert.match(missingServerMessage({ kind: 'missing', origin: 'environment', tried: ['/y'] }), /RUNGWISE_SERVER names \/y/);
  assert.match(missingServerMessage({ kind: 'missing', origin: 'none', tried: [] }), /cargo build --release/);
  assert.match(brokenServerMessage('/x', 'it is tired'), /\/x does not start: it is tired\./);
});

test('crashes are followed by restarts with growing delays, then by giving up', () => {
  const policy = new CrashPolicy();
  const delays = [0, 1, 2, 3].map((now) => policy.decide(now));
  assert.deepEqual(
    delays.map((d) => (d.kind === 'restart' ? d.delayMs : -1)),
    [100, 200, 400, 800],
  );
  assert.deepEqual(policy.decide(4), { kind: 'give-up', crashes: 5 });
});

test('old crashes and those before a restart by hand do not count', () => {
  const policy = new CrashPolicy();
  for (let i = 0; i < 20; i++) {
    assert.equal(policy.decide(i * CRASH_WINDOW_MS).kind, 'restart');
  }
  for (let i = 0; i < 4; i++) {
    policy.decide(1e9 + i);
  }
  policy.reset();
  assert.deepEqual(policy.decide(1e9 + 9), { kind: 'restart', delayMs: 100 });
});

test('the answer of a check becomes a sentence of the right weight', () => {
  assert.deepEqual(checkSummary({ message: 'Check passed, 3 rungs.', errors: 0, warnings: 0 }), {
    message: 'Check passed, 3 rungs.',
    severity: 'information',
  });
  assert.equal(checkSummary({ message: 'm', summary: { errors: 2, warnings: 1 } }).severity, 'error');
  assert.equal(checkSummary({ message: 'm', warnings: 1 }).severity, 'warning');
  assert.equal(checkSummary('Check passed.').message, 'Check passed.');
  assert.equal(checkSummary(null).severity, 'error');
});

test('the chosen target is marked, and what automatic came to', () => {
  const marked = (current: string | null, used?: string) =>
    targetChoices(current, used)
      .filter((choice) => choice.description.includes('selected'))
      .map((choice) => `${choice.value} ${choice.description}`);
  assert.deepEqual(marked('fx3u', 'fx3u'), ['fx3u 64,000 steps (selected)']);
  assert.match(marked(null, 'fx2n')[0] ?? '', /^auto .*\(selected: FX2N\)$/);
});
