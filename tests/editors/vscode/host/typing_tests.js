// Typing in a drawing at any speed: a burst of keys without a pause gives what slow typing gives.

const assert = require('node:assert/strict');
const vscode = require('vscode');
const { openText, sleep, until } = require('./support');

const PLAIN = ['|   X0      X1                             Y0  |', '+---| |-----| |----------------------------( )-+'];
const SEAL_IN = [
  '|   X0        X1                           Y0  |',
  '+---| |---+---|/|--------------------------( )-+',
  '|   Y0    |                                    |',
  '+---| |---+                                    |',
];
const SEAL_IN_SNIPPET = [
  '|   ${1:X0}        ${2:X1}                           ${3:Y0}  |',
  '+---| |---+---|/|--------------------------( )-+',
  '|   ${3:Y0}    |                                    |',
  '+---| |---+                                    |',
  '$0',
].join('\n');
const END = ['', '+--[END]---------------------------------------+', ''];
const program = (lines) => [...lines, ...END].join('\n');

const NEXT = { command: 'jumpToNextSnippetPlaceholder' };
const LEFT = { command: 'deleteLeft' };
const RIGHT = { command: 'deleteRight' };

/**
 * Each: what is typed, the drawing before, the cursor (line and column from 0), the steps, the drawing afterwards. A step
 * is text, a key that is a command of the editor, an `edit` that makes a name to type over, a `snippet`, or a text to be
 * `selected` by then.
 */
const SCRIPTS = [
  ['a name over a longer one', PLAIN, [1, 10], [{ edit: 'insertContact' }, 'X2'],
    ['|   X0      X2      X1                     Y0  |', '+---| |-----| |-----| |--------------------( )-+']],
  ['a name over a shorter one', PLAIN, [1, 10], [{ edit: 'insertContact' }, 'X1234'],
    ['|   X0      X1234   X1                     Y0  |', '+---| |-----| |-----| |--------------------( )-+']],
  ['contacts in a wire', PLAIN, [1, 27], ['|/|', '--', '| |'],
    [PLAIN[0], '+---| |-----| |------------|/|--| |--------( )-+']],
  ['an instruction in a wire', PLAIN, [1, 27], ['[MOV K1 D0]'],
    [PLAIN[0], '+---| |-----| |------------[MOV K1 D0]-----( )-+']],
  ['a name that outgrows its place', SEAL_IN, [0, 6], ['123456789012'], [
    '|   X0123456789012 X1                      Y0  |',
    '+---| |---+--------|/|---------------------( )-+',
    ...SEAL_IN.slice(2),
  ]],
  ['a name that is taken back and another', PLAIN, [0, 6], [LEFT, LEFT, 'Y17', LEFT, '8'],
    ['|   Y18     X1                             Y0  |', PLAIN[1]]],
  ['wire that is deleted, and a contact', PLAIN, [1, 27], [RIGHT, RIGHT, RIGHT, '| |', LEFT, LEFT, LEFT, '| |'],
    [PLAIN[0], '+---| |-----| |------------| |-------------( )-+']],
  ['the mark of a contact', PLAIN, [1, 6], [LEFT, '/'], [PLAIN[0], '+---|/|-----| |----------------------------( )-+']],
  ['the names of a snippet, one of them at two cursors', [], [0, 0], [{ snippet: SEAL_IN_SNIPPET }, 'X10', NEXT, 'B', NEXT, 'Y10'], [
    '|   X10       B                            Y10 |',
    '+---| |---+---|/|--------------------------( )-+',
    '|   Y10   |                                    |',
    '+---| |---+                                    |',
  ]],
  ['Enter at a contact, and the name of the branch', PLAIN, [1, 4], ['\n', { selected: '???' }, 'X17'], [
    '|   X0        X1                           Y0  |',
    '+---| |---+---| |--------------------------( )-+',
    '|   X17   |                                    |',
    '+---| |---+                                    |',
  ]],
  ['Enter behind a rung, and a contact of the next', PLAIN, [1, 48], ['\n', '| |'], [
    ...PLAIN,
    '',
    '|                                              |',
    '+---| |----------------------------------------+',
  ]],
];

async function settled(document, still = 6) {
  for (let same = 0, version; same < still; same++) {
    await sleep(25);
    if (document.version !== version) {
      [same, version] = [0, document.version];
    }
  }
}

/** Types with a pause behind each key; without one the keys do not wait for anything. `undefined` waits for all answers. */
async function play([, before, at, steps, after], pause) {
  const document = await openText('ladder', program(before));
  const editor = vscode.window.activeTextEditor;
  editor.selection = new vscode.Selection(...at, ...at);
  const keys = [];
  for (const step of steps) {
    if (step.edit) {
      await until(`the edit ${step.edit}`, () => vscode.commands.executeCommand(`rungwise.${step.edit}`));
    } else if (step.selected) {
      // Without a pause the name is typed before there is a place for it.
      await (pause === undefined && until(step.selected, () => document.getText(editor.selection) === step.selected));
    } else if (step.snippet) {
      await editor.insertSnippet(new vscode.SnippetString(step.snippet));
      await settled(document);
    } else {
      const presses = step.command
        ? [() => vscode.commands.executeCommand(step.command)]
        : [...step].map((text) => () => vscode.commands.executeCommand('type', { text }));
      for (const press of presses) {
        keys.push(press());
        await (pause === undefined ? keys.at(-1).then(() => settled(document)) : pause > 0 && sleep(pause));
      }
    }
  }
  await Promise.all(keys);
  const wanted = program(after);
  await until('the drawing', () => document.getText() === wanted)
    .catch((error) => assert.fail(`pause ${pause}: ${error.message}\nwanted:\n${wanted}\nfound:\n${document.getText()}`));
  await settled(document);
  assert.equal(document.getText(), wanted, `pause ${pause}: it changed afterwards`);
  await vscode.commands.executeCommand('workbench.action.revertAndCloseActiveEditor');
}

module.exports = SCRIPTS.map((script) => [`typed at any speed: ${script[0]}`, async () => {
  for (const pause of [undefined, 0, 0, 7, 30]) {
    await play(script, pause);
  }
}]);
