import assert from 'node:assert/strict';
import { test } from 'node:test';
import { FormsFollower, formsArgument, formsPage, type Asking, type FormsPlace } from '../src/forms';

const at = (line: number): FormsPlace => ({ uri: 'file:///a.lad', position: { line, character: 3 } });
const answerFor = (place: FormsPlace) => ({ forms: [{ to: 'boolean', text: `Y0 = X${place.position?.line}`, certificate: 'proved', notes: [] }] });

/** A server whose answers come when the test says so. */
class FakeServer {
  readonly asked: { place: FormsPlace; cancelled: boolean; answer(value: unknown): void; fail(reason: Error): void }[] = [];

  readonly ask = (place: FormsPlace): Asking => {
    const question = { place, cancelled: false, answer: (_: unknown) => {}, fail: (_: Error) => {} };
    const answer = new Promise<unknown>((resolve, reject) => Object.assign(question, { answer: resolve, fail: reject }));
    this.asked.push(question);
    return { answer, cancel: () => void (question.cancelled = true) };
  };
}

const pause = (ms: number) => new Promise((resolve) => setTimeout(resolve, ms));

test('the question has the place and wants all forms', () => {
  assert.deepEqual(formsArgument(at(4)), { uri: 'file:///a.lad', position: { line: 4, character: 3 }, to: 'all' });
});

test('each form is a program in a fence with its certificate and notes', () => {
  const forms = [
    { to: 'fx', text: 'LD X0\nOUT Y0\n', certificate: 'proved', notes: ['saves 3 steps'] },
    { to: 'iec', text: 'LD %IX0.0', certificate: 'construction', notes: [] },
    { to: 'ladder', text: '|--| |--|', certificate: 'undecided' },
    { to: 'boolean', text: 'Y0 = X0' },
  ];
  assert.equal(formsPage({ forms }), [
    '## Instruction list, FX — proved equal\n\n```il\nLD X0\nOUT Y0\n```\n\n- saves 3 steps\n',
    '## Instruction list, IEC 61131-3 — equal by construction\n\n```il\nLD %IX0.0\n```\n',
    '## Ladder diagram — not decided\n\n```ladder\n|--| |--|\n```\n',
    '## Boolean form\n\n```\nY0 = X0\n```\n',
  ].join('\n'));
});

test('backticks in a program do not end its fence', () => {
  const page = formsPage({ forms: [{ to: 'fx', text: '// ````\nEND' }] });
  assert.match(page, /^`{5}il\n\/\/ ````\nEND\n`{5}$/m);
});

test('without a rung there is a sentence', () => {
  for (const answer of [null, undefined, {}, { forms: [] }, { forms: 3 }]) {
    assert.equal(formsPage(answer), 'There is no rung at the cursor.\n');
  }
});

test('of places in quick succession the last one is asked about, once', async () => {
  const server = new FakeServer();
  const shown: string[] = [];
  const follower = new FormsFollower(server.ask, (page) => shown.push(page), 20);
  [1, 2, 3].forEach((line) => follower.moved(at(line)));
  await pause(60);
  assert.deepEqual(server.asked.map(({ place }) => place), [at(3)]);
  server.asked[0]?.answer(answerFor(at(3)));
  await pause(0);
  assert.equal(shown.length, 1);
  assert.match(shown[0] ?? '', /Y0 = X3/);
});

test('a cursor that runs on is followed on its way', async () => {
  const server = new FakeServer();
  const follower = new FormsFollower(server.ask, () => undefined, 20);
  for (let line = 0; line < 20; line++) {
    follower.moved(at(line));
    await pause(5);
  }
  follower.stop();
  assert.ok(server.asked.length >= 2, `${server.asked.length} questions`);
});

test('a question of before is cancelled, and its answer is not shown', async () => {
  const server = new FakeServer();
  const shown: string[] = [];
  const follower = new FormsFollower(server.ask, (page) => shown.push(page), 5);
  follower.moved(at(1));
  await pause(30);
  follower.moved(at(2));
  await pause(30);
  const [first, second] = server.asked;
  assert.deepEqual([first?.cancelled, second?.cancelled], [true, false]);
  second?.answer(answerFor(at(2)));
  first?.answer(answerFor(at(1)));
  await pause(0);
  assert.equal(shown.length, 1);
  assert.match(shown[0] ?? '', /Y0 = X2/);
});

test('an error is said, and stopping forgets what was asked', async () => {
  const server = new FakeServer();
  const shown: string[] = [];
  const follower = new FormsFollower(server.ask, (page) => shown.push(page), 5);
  follower.moved(at(1));
  await pause(30);
  server.asked[0]?.fail(new Error('the language server is not running'));
  await pause(0);
  assert.deepEqual(shown, ['the language server is not running\n']);
  follower.moved(at(2));
  await pause(30);
  follower.moved(at(3));
  follower.stop();
  assert.equal(server.asked[1]?.cancelled, true);
  server.asked[1]?.answer(answerFor(at(2)));
  await pause(30);
  assert.equal(shown.length, 1);
  assert.equal(server.asked.length, 2);
});
