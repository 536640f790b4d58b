import assert from 'node:assert/strict';
import { test } from 'node:test';
import { alarmRows, alarmsOf, isProgram, NO_PLC, noteAlarm, parseState, raised, rowsOf, statusText } from '../src/plc';
import { lookText } from '../src/simulation';

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

test('a row says whether the program is that of the editor, as far as that is known, and icons say the mode', () => {
  const shown = (more: object, id: string) => {
    const row = rowsOf(parseState({ ...CONNECTED, ...more })).find((row) => row.id === id);
    return `${row?.icon} ${row?.description}`;
  };
  assert.equal(shown({ match: 'same' }, 'match'), 'check as in the editor');
  assert.equal(shown({ match: 'different' }, 'match'), 'diff not as in the editor');
  assert.equal(shown({ match: 'unknown' }, 'match'), 'question not compared yet');
  assert.equal(shown({}, 'match'), 'question not compared yet');
  assert.equal(shown({}, 'mode'), 'play-circle RUN');
  assert.equal(shown({ mode: 'STOP' }, 'mode'), 'stop-circle STOP');
});

test('the status bar shows the mode, and a sign where the programs differ', () => {
  assert.equal(statusText(parseState({ ...CONNECTED, match: 'same' })), '$(play-circle) FX2N RUN');
  assert.equal(statusText(parseState({ ...CONNECTED, mode: 'STOP', match: 'different' })), '$(stop-circle) FX2N STOP $(diff)');
});

test('the two sides of a difference are no programs to compare with the PLC', () => {
  const document = (languageId: string, scheme: string) => ({ languageId, uri: { scheme } });
  assert.ok(isProgram(document('plc-il', 'file')) && isProgram(document('ladder', 'untitled')));
  assert.ok(!isProgram(document('plc-il', 'rungwise-plc')) && !isProgram(document('toml', 'file')));
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
  // Raised twice without a word between, it is one row.
  const twice = noteAlarm(again, { ...told, at_ms: 5000 });
  assert.equal(rows(twice)[0], 'error Too full: since 5 s');
  assert.equal(twice.length, 3);
});

test('alarms in a PLC are those of the program that is monitored', () => {
  const told = (uri: string, source: string) => ({ uri, source, when: 'D1', message: 'm', severity: 'hint', raised: true, at_ms: 1 });
  const all = [told('a', 'plc'), told('b', 'plc'), told('c', 'simulator')].reduce(noteAlarm, [] as Parameters<typeof noteAlarm>[0]);
  const of = (monitored?: string) => alarmsOf(all, monitored).map(({ uri }) => uri).sort();
  assert.deepEqual([of(), of('a'), of('d')], [['a', 'b', 'c'], ['a', 'c'], ['c']]);
});

test('the status bar says of how many scans the values of a look may be', () => {
  assert.equal(lookText({ scan: 3, timeMs: 1500, exchanges: 1 }), '$(plug) PLC, look 3 · 1.50 s');
  assert.equal(lookText({ scan: 3, timeMs: 1500, exchanges: 4 }), '$(plug) PLC, look 3 · 1.50 s · values of up to 4 scans');
});

test('of many alarms the newest are kept', () => {
  const told = (at: number) => ({ uri: 'a', source: 'plc', when: `D${at}`, message: 'm', severity: 'hint', raised: true, at_ms: at });
  const alarms = Array.from({ length: 80 }, (_, at) => told(at)).reduce(noteAlarm, [] as Parameters<typeof noteAlarm>[0]);
  assert.equal(alarms.length, 50);
  assert.equal(alarms[0]?.when, 'D79');
});
