import assert from 'node:assert/strict';
import { test } from 'node:test';
import { pageDocument } from '../src/panel/document';
import {
  basesOf, firstSignals, grouped, isSwitch, namesOf, parseMoment, parseRows, progress, readAs, reading, sliderEnds, typedIn, typedNumber, variableToAdd, written, type Row,
} from '../src/panel/rows';
import { LABEL_WIDTH, rowAt, scanAt, scene, sceneHeight, type Shape } from '../src/panel/scene';
import { svg } from '../src/panel/svg';
import { Traces, type TraceAnswer } from '../src/panel/traces';
import { FIRST_VIEW, duration, fit, follow, pan, ticks, zoom } from '../src/panel/viewport';

const ANSWER = {
  rows: [
    { name: 'Y0', label: 'Y0', group: 'outputs', type: 'bit', symbol: 'Motor', comment: '' },
    { name: 'X0', label: 'X0', group: 'inputs', type: 'bit', symbol: '', comment: 'start button' },
    { name: 'T0', label: 'T0', group: 'timers', type: 'word', symbol: '', comment: '', contact: 'TS0', preset: 10, unit_ms: 100 },
    { name: 'C0', label: 'C0', group: 'counters', type: 'word', contact: 'CS0', preset_of: 'D5', least: -32768, greatest: 32767 },
    { name: 'Z', group: 'nowhere', type: 'bit' },
    { group: 'inputs', type: 'bit' },
  ],
};
const rows = parseRows(ANSWER);
const row = (name: string): Row => rows.find((one) => one.name === name) ?? assert.fail(name);

test('rows of an answer are read, and what is none is left out', () => {
  assert.deepEqual(rows.map(({ name }) => name), ['Y0', 'X0', 'T0', 'C0']);
  assert.deepEqual([row('T0').unitMs, row('T0').preset, row('T0').contact], [100, 10, 'TS0']);
  assert.deepEqual(namesOf(row('C0')), ['C0', 'CS0', 'D5']);
  assert.deepEqual(parseRows(null), []);
});

test('a panel shows groups in their order, and those of which something was searched', () => {
  const shown = (filter: string) => grouped(rows, filter).map(({ group, rows: own }) => [group, own.map(({ name }) => name)]);
  assert.deepEqual(shown(''), [['inputs', ['X0']], ['outputs', ['Y0']], ['timers', ['T0']], ['counters', ['C0']]]);
  assert.deepEqual(shown('START but'), [['inputs', ['X0']]]);
  assert.deepEqual(shown('motor'), [['outputs', ['Y0']]]);
  assert.deepEqual(firstSignals(rows), ['X0', 'Y0', 'T0', 'C0']);
  assert.deepEqual(rows.filter(isSwitch).map(({ name }) => name), ['X0']);
});

test('what can be added to a panel is said in names that the program has', () => {
  const added = (names: readonly string[], contact?: string) =>
    variableToAdd(parseRows({ rows: names.map((name) => ({ name, group: 'variables', type: 'bit', contact })) }));
  assert.equal(variableToAdd(rows), undefined);
  assert.equal(variableToAdd([]), undefined);
  assert.equal(added(['Mixer.Start', 'Mixer.X0']), 'Mixer.Start');
  assert.equal(added(['Mixer.Delay.ET'], 'Mixer.Delay.Q'), 'Mixer.Delay.Q');
});

test('numbers are read and written as people do', () => {
  assert.deepEqual([reading(7, 100), reading(250, 10), reading(-3, undefined), reading(true, 100)], ['0.7 s', '2.50 s', '-3', 'true']);
  assert.deepEqual([progress(5, 10), progress(50, 10), progress(5, undefined), progress(5, 0)], [0.5, 1, undefined, undefined]);
  assert.deepEqual([sliderEnds(7, {}), sliderEnds(-7, {}), sliderEnds(20_000, {})], [[0, 100], [-100, 100], [0, 32767]]);
  assert.deepEqual(['12', ' -5 ', 'H1F', '16#ff', '', '1.5', '99999', 'x'].map((word) => typedNumber(word, row('C0'))), [
    12, -5, 31, 255, undefined, undefined, undefined, undefined,
  ]);
});

test('a state of the server is a moment, and anything else is none', () => {
  const moment = parseMoment({ mode: 'paused', scan: 3, time_ms: 30, first_scan: 1, scan_ms: 10, edition: 2, branch: 1, values: [] });
  assert.deepEqual(moment, { source: 'simulator', mode: 'paused', scan: 3, timeMs: 30, firstScan: 1, scanMs: 10, edition: 2, branch: 1, values: [] });
  assert.equal(parseMoment({ uri: 'file:///a.lad' }), undefined);
  assert.equal(parseMoment(null), undefined);
});

const answer = (from: number, to: number, points: TraceAnswer['signals'][0]['points'], more: Partial<TraceAnswer> = {}): TraceAnswer => ({
  from, to, branch: 0, signals: [{ name: 'X0', known_from: from, points }], ...more,
});

test('answers about what is new are put behind what is known', () => {
  const traces = new Traces();
  const first = traces.question(['X0'], 0);
  assert.deepEqual([first.from, first.to], [0, undefined]);
  traces.take(first, answer(0, 20, [[0, false], [5, true], [9, false]]));
  const next = traces.question(['X0'], 0);
  assert.equal(next.from, 20);
  traces.take(next, answer(20, 40, [[20, false], [30, true]]));
  assert.deepEqual(traces.points('X0', 0, 40), [[0, false], [5, true], [9, false], [30, true]]);
  assert.deepEqual(traces.points('X0', 6, 29), [[5, true], [9, false]]);
  assert.deepEqual([4, 5, 29, 30].map((scan) => traces.value('X0', scan)), [false, true, false, true]);
  assert.deepEqual([traces.change(['X0'], 5, true), traces.change(['X0'], 9, false), traces.change(['X0'], 30, true)], [9, 5, undefined]);
});

test('what was taken back, or a signal that is new, is asked for from the beginning', () => {
  const traces = new Traces();
  traces.take(traces.question(['X0'], 0), answer(0, 20, [[0, false], [15, true]]));
  assert.equal(traces.question(['X0', 'Y0'], 0).from, 0);
  const again = traces.question(['X0'], 1);
  assert.equal(again.from, 0);
  traces.take(again, answer(0, 10, [[0, false]], { branch: 1 }));
  assert.deepEqual([traces.lastScan, traces.value('X0', 15), traces.question(['X0'], 1).from], [10, false, 10]);
});

test('a past of which changes were left out is looked at closely where it is shown', () => {
  const traces = new Traces();
  const question = traces.question(['X0'], 0);
  const many = Array.from({ length: question.most }, (_, at): [number, boolean] => [at * 100, at % 2 === 0]);
  traces.take(question, answer(0, question.most * 100, many));
  const closer = traces.closer(['X0'], 1_000, 1_100) ?? assert.fail('nothing is asked');
  assert.ok(closer.from <= 1_000 && (closer.to ?? 0) >= 1_100);
  traces.take(closer, answer(closer.from, closer.to ?? 0, [[closer.from, true], [1_050, false]]));
  assert.deepEqual(traces.points('X0', 1_000, 1_100), [[closer.from, true], [1_050, false]]);
  assert.equal(traces.closer(['X0'], 1_000, 1_100), undefined);
});

test('of a long run the newest scans are known one by one', () => {
  const traces = new Traces();
  const overview = traces.question(['X0'], 0);
  const end = 1_000_000;
  const many = Array.from({ length: overview.most }, (_, at): [number, boolean] => [at * (end / overview.most), at % 2 === 0]);
  traces.take(overview, answer(0, end, many));
  const tail = traces.question(['X0'], 0);
  assert.deepEqual([tail.from, tail.to], [end - overview.most / 2, undefined]);
  // No scan can have more changes than are asked for.
  assert.ok(end - tail.from < tail.most);
  traces.take(tail, answer(tail.from, end, [[tail.from, false], [end - 3, true], [end - 1, false]]));
  assert.deepEqual([traces.lastScan, traces.value('X0', end - 2), traces.value('X0', end)], [end, true, false]);
  assert.equal(traces.closer(['X0'], end - 300, end), undefined);
});

test('a chart follows the newest scan until it is moved away, and again from the right edge on', () => {
  const view = follow(FIRST_VIEW, 1_000);
  assert.deepEqual(view, { from: 700, to: 1_000, follows: true });
  assert.deepEqual(follow(FIRST_VIEW, 10), { from: 0, to: 300, follows: true });
  const back = pan(view, -100, 1_000);
  assert.deepEqual(back, { from: 600, to: 900, follows: false });
  assert.deepEqual(follow(back, 2_000), back);
  assert.equal(pan(back, 150, 1_000).follows, true);
  const closer = zoom(back, 0.5, 700, 1_000);
  // The scan under the mouse stays there.
  assert.deepEqual(closer, { from: 650, to: 800, follows: false });
  assert.deepEqual(zoom(view, 0.5, 700, 1_000), { from: 850, to: 1_000, follows: true });
  assert.deepEqual(fit(5_000), { from: 0, to: 5_000, follows: true });
});

test('lines of time stand at round times', () => {
  assert.deepEqual(ticks({ from: 0, to: 300, follows: true }, 10, 6).map(({ label }) => label), ['0 ms', '500 ms', '1.0 s', '1.5 s', '2.0 s', '2.5 s', '3.0 s'].map((label) => label));
  assert.deepEqual(ticks({ from: 100, to: 112, follows: false }, 10, 6).map(({ scan }) => scan), [100, 102, 104, 106, 108, 110, 112]);
  assert.deepEqual([duration(125_000, 60_000), duration(3_725_000, 60_000), duration(12, 1), duration(59_000, 10_000)], ['2:05', '1:02:05', '12 ms', '59 s']);
});

const wish = { width: LABEL_WIDTH + 510, rows: [row('X0'), row('T0')], view: { from: 0, to: 100, follows: false }, scanMs: 10, cursor: 50 };

test('a chart has a high line with an area where a bit is on, steps for numbers, and values at the cursor', () => {
  const traces = new Traces();
  traces.take(traces.question(['X0', 'T0'], 0), {
    from: 0, to: 100, branch: 0,
    signals: [
      { name: 'X0', known_from: 0, points: [[0, false], [40, true], [60, false]] },
      { name: 'T0', known_from: 0, points: [[0, 0], [45, 7]] },
    ],
  });
  const { shapes, height } = scene({ ...wish, traces });
  assert.equal(height, sceneHeight(wish.rows));
  const areas = shapes.filter((shape) => shape.kind === 'area');
  // 500 pixels for 100 scans.
  assert.deepEqual(areas.map(({ x, width }) => [x, width]), [[LABEL_WIDTH + 200, 100]]);
  const line = shapes.find((shape): shape is Extract<Shape, { kind: 'path' }> => shape.look === 'on') ?? assert.fail('no line');
  const [low] = line.points[0]?.slice(1) ?? [];
  assert.deepEqual(line.points.filter(([, y]) => y < Number(low)).map(([x]) => x), [LABEL_WIDTH + 200, LABEL_WIDTH + 300]);
  const texts = shapes.flatMap((shape) => (shape.kind === 'text' ? [shape.text] : []));
  for (const text of ['X0', '1', 'T0', '0.7 s', '50 · 500 ms']) {
    assert.ok(texts.includes(text), `${text} in ${texts}`);
  }
  assert.equal(Math.round(scanAt(LABEL_WIDTH + 250, wish.width, wish.view)), 50);
  assert.deepEqual([rowAt(10, wish.rows), rowAt(30, wish.rows)?.name, rowAt(60, wish.rows)?.name], [undefined, 'X0', 'T0']);
});

test('a bit that changes in each scan takes no more lines than there are pixels', () => {
  const traces = new Traces();
  const points = Array.from({ length: 3_000 }, (_, scan): [number, boolean] => [scan, scan % 2 === 0]);
  traces.take(traces.question(['X0'], 0), answer(0, 3_000, points));
  const { shapes } = scene({ ...wish, rows: [row('X0')], traces, view: { from: 0, to: 3_000, follows: true } });
  const line = shapes.find((shape): shape is Extract<Shape, { kind: 'path' }> => shape.look === 'on') ?? assert.fail('no line');
  assert.ok(line.points.length < 2_100, `${line.points.length} points`);
  const heights = new Set(line.points.map(([, y]) => y));
  assert.equal(heights.size, 2);
});

test('a saved chart is a well-formed drawing', () => {
  const traces = new Traces();
  traces.take(traces.question(['X0'], 0), answer(0, 100, [[0, false], [40, true]]));
  const colours = { background: '#fff', foreground: '#000', dim: '#888', line: '#ccc', on: '#00f', word: '#808', font: '"Segoe UI", sans' };
  const text = svg(scene({ ...wish, traces }), colours, 'X < Y & Z');
  assert.match(text, /^<\?xml version="1.0"/);
  assert.match(text, /<title>X &lt; Y &amp; Z<\/title>/);
  assert.ok(text.includes('font-family="&quot;Segoe UI&quot;, sans"'));
  assert.ok((text.match(/<polyline /g) ?? []).length >= 3);
  assert.ok(!/NaN|undefined|Infinity/.test(text));
});

test('nothing but its own script runs in the page of a panel', () => {
  const page = pageDocument({ source: 'https://own', script: 'https://own/panel.js', style: 'https://own/panel.css', title: 'a<b', nonce: 'abc' });
  assert.ok(page.includes(`content="default-src 'none'; style-src https://own; script-src 'nonce-abc'"`));
  assert.ok(page.includes('<title>a&lt;b</title>'));
  assert.ok(!/unsafe|\son\w+=/.test(page));
});

test('the number of a register is written and typed in any base', () => {
  const word = { least: -32768, greatest: 32767 };
  const wide = { least: -0x80000000, greatest: 0x7fffffff };
  assert.equal(written(-2, 'hexadecimal'), 'HFFFE');
  assert.equal(written(100000, 'hexadecimal'), 'H000186A0');
  assert.equal(written(5, 'binary'), '0000 0000 0000 0101');
  assert.equal(written(0x3f800000, 'float'), '1');
  assert.equal(written(0x3dcccccd, 'float'), '0.1');
  assert.equal(written(true, 'binary'), 'true');
  for (const base of ['decimal', 'hexadecimal', 'binary'] as const) {
    for (const value of [0, 1, -1, 32767, -32768]) {
      assert.equal(typedIn(written(value, base), base, word), value, `${base} ${value}`);
    }
  }
  for (const value of [70000, -70000, -0x80000000]) {
    assert.equal(typedIn(written(value, 'hexadecimal'), 'hexadecimal', wide), value);
    assert.equal(typedIn(written(value, 'double'), 'double', word), value);
  }
  assert.equal(typedIn('1.5', 'float', word), 0x3fc00000);
  assert.equal(typedIn('FFFE', 'hexadecimal', word), -2);
  for (const [text, base] of [['12345', 'binary'], ['HFFFFF', 'hexadecimal'], ['1e99', 'float'], ['', 'float'], ['x', 'double']] as const) {
    assert.equal(typedIn(text, base, word), undefined, text);
  }
});

test('two registers are read for 32 bits, and only registers have these bases', () => {
  const row = { name: 'D0', label: 'D0', group: 'registers', type: 'word', symbol: '', comment: '' } as const;
  assert.deepEqual(namesOf(row, 'float'), ['D0', 'D0:32']);
  assert.deepEqual(namesOf(row), ['D0']);
  assert.equal(readAs('D0', 'binary'), 'D0');
  assert.equal(basesOf(row).length, 5);
  assert.equal(basesOf({ ...row, name: 'C200' }).length, 3);
  assert.equal(basesOf({ ...row, unitMs: 100 }).length, 1);
});

test('the moments of a PLC are milliseconds, and its panel stays open while it stands still', () => {
  const moment = parseMoment({ source: 'plc', mode: 'stopped', scan: 7, time_ms: 1234.5, values: [] });
  assert.deepEqual([moment?.source, moment?.mode, moment?.scan, moment?.scanMs], ['plc', 'running', 1234, 1]);
});
