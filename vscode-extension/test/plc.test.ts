import assert from 'node:assert/strict';
import { test } from 'node:test';
import { alarmRows, NO_PLC, noteAlarm, parseState, raised, rowsOf, statusText } from '../src/plc';

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

test('an alarm is a row with the times when it was raised and gone', () => {
  const told = { uri: 'file:///a.il', source: 'plc', when: 'D10 > 100', message: 'Too full', severity: 'error', raised: true, ended: false, time_ms: 5, at_ms: 1000 };
  const clock = (at: number) => `${at / 1000} s`;
  const rows = (alarms: Parameters<typeof alarmRows>[0]) => alarmRows(alarms, clock).map(({ label, description, icon }) => `${icon} ${label}: ${description}`);
  const first = noteAlarm([], told);
  assert.deepEqual(rows(first), ['error Too full: since 1 s']);
  // That of the simulator is another one.
  const both = noteAlarm(first, { ...told, source: 'simulator', severity: 'hint', at_ms: 2000 });
  assert.deepEqual(rows(both), ['info Too full: since 2 s · simulation', 'error Too full: since 1 s']);
  const gone = noteAlarm(both, { ...told, raised: false, at_ms: 3000 });
  assert.deepEqual(rows(gone), ['info Too full: since 2 s · simulation', 'pass Too full: 1 s – 3 s']);
  assert.equal(raised(gone).length, 1);
  const again = noteAlarm(gone, { ...told, at_ms: 4000 });
  assert.equal(rows(again)[0], 'error Too full: since 4 s');
  assert.equal(again.length, 3);
  assert.equal(noteAlarm(again, { raised: true }), again);
});

test('of many alarms the newest are kept', () => {
  const told = (at: number) => ({ uri: 'a', source: 'plc', when: `D${at}`, message: 'm', severity: 'hint', raised: true, at_ms: at });
  const alarms = Array.from({ length: 80 }, (_, at) => told(at)).reduce(noteAlarm, [] as Parameters<typeof noteAlarm>[0]);
  assert.equal(alarms.length, 50);
  assert.equal(alarms[0]?.when, 'D79');
});
