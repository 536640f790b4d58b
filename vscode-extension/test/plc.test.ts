import assert from 'node:assert/strict';
import { test } from 'node:test';
import { NO_PLC, parseState, rowsOf, statusText } from '../src/plc';

const CONNECTED = {
  connected: true,
  port: 'tcp://127.0.0.1:5551',
  title: 'FX2N',
  version: '3.10',
  mode: 'RUN',
  capacity: 8000,
  sum: 'D6FE',
  scan_time_ms: 10,
  errors: [{ register: 'D8067', code: 6705 }],
};

test('what is no state says that no PLC is connected, and why', () => {
  assert.deepEqual(parseState(null), NO_PLC);
  assert.deepEqual(parseState({ connected: false }), NO_PLC);
  assert.deepEqual(rowsOf(parseState({ connected: false, reason: 'the line is gone' })), []);
  assert.equal(parseState({ connected: false, reason: 'the line is gone' }).reason, 'the line is gone');
});

test('rows tell model, port, mode, program, memory, scan time and errors', () => {
  const rows = rowsOf(parseState({ ...CONNECTED, match: 'different' }));
  assert.deepEqual(
    rows.map(({ label, description }) => `${label}: ${description}`),
    [
      'FX2N: 3.10',
      'Port: tcp://127.0.0.1:5551',
      'Mode: RUN',
      'Program: not as in the editor',
      'Memory: 8000 steps, sum D6FE',
      'Scan time: 10 ms',
      'Error: D8067 = 6705',
    ],
  );
});

test('the status bar shows the mode, and a sign where the programs differ', () => {
  assert.equal(statusText(parseState({ ...CONNECTED, match: 'same' })), '$(play-circle) FX2N RUN');
  assert.equal(statusText(parseState({ ...CONNECTED, mode: 'STOP', match: 'different' })), '$(stop-circle) FX2N STOP $(diff)');
});
