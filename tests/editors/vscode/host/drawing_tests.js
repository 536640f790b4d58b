// Structural edits of a drawing: one script for each, with its text before and after, the selection, and one undo.

const assert = require('node:assert/strict');
const vscode = require('vscode');
const { errors, openText, sleep, until } = require('./support');

const SEAL_IN = [
  '|   X0        X1                           Y0  |',
  '+---| |---+---|/|--------------------------( )-+',
  '|   Y0    |                                    |',
  '+---| |---+                                    |',
];
const END = ['', '+--[END]---------------------------------------+', ''];
const PLAIN = ['|   X0                                     Y0  |', '+---| |------------------------------------( )-+'];
const EMPTY = ['|                                              |', '+----------------------------------------------+'];

/**
 * Each: the command, the drawing before, where the cursor is (line, column; a second place for a selection), the drawing
 * afterwards, and the text that is selected then. `operand` goes with the command as a keybinding gives it.
 */
const EDITS = [
  {
    edit: 'insertContact', before: SEAL_IN, at: [0, 14], selected: '???',
    after: [
      '|   X0        ???     X1                   Y0  |',
      '+---| |---+---| |-----|/|------------------( )-+',
      ...SEAL_IN.slice(2),
    ],
  },
  {
    edit: 'insertContact', before: SEAL_IN, at: [0, 14], operand: 'X5', selected: '',
    after: [
      '|   X0        X5      X1                   Y0  |',
      '+---| |---+---| |-----|/|------------------( )-+',
      ...SEAL_IN.slice(2),
    ],
  },
  {
    edit: 'insertNegatedContact', before: PLAIN, at: [1, 5], selected: '???',
    after: ['|   ???     X0                             Y0  |', '+---|/|-----| |----------------------------( )-+'],
  },
  {
    edit: 'insertCoil', before: EMPTY, at: [1, 4], operand: 'Y1', selected: '',
    after: ['|                                          Y1  |', '+------------------------------------------( )-+'],
  },
  {
    edit: 'insertSetCoil', before: EMPTY, at: [1, 4], operand: 'M0', selected: '',
    after: ['|                                          M0  |', '+------------------------------------------(S)-+'],
  },
  {
    edit: 'insertResetCoil', before: EMPTY, at: [1, 4], operand: 'M0', selected: '',
    after: ['|                                          M0  |', '+------------------------------------------(R)-+'],
  },
  {
    edit: 'insertBox', before: EMPTY, at: [1, 4], operand: 'MOV K10 D0', selected: '',
    after: [EMPTY[0], '+--[MOV K10 D0]--------------------------------+'],
  },
  {
    edit: 'insertBranch', before: SEAL_IN, at: [1, 15], selected: '???',
    after: [
      '|   X0        X1                           Y0  |',
      '+---| |---+---|/|---+----------------------( )-+',
      '|   Y0    |   ???   |                          |',
      '+---| |---+---| |---+                          |',
    ],
  },
  { edit: 'insertRung', before: PLAIN, at: [1, 5], selected: '', after: [...PLAIN, '', ...EMPTY] },
  { edit: 'insertRungAbove', before: PLAIN, at: [1, 5], selected: '', after: [...EMPTY, '', ...PLAIN] },
  {
    edit: 'moveBranchUp', before: SEAL_IN, at: [3, 5], selected: '',
    after: [SEAL_IN[0].replace('X0', 'Y0'), SEAL_IN[1], SEAL_IN[2].replace('Y0', 'X0'), SEAL_IN[3]],
  },
  {
    edit: 'moveBranchDown', before: SEAL_IN, at: [1, 5], selected: '',
    after: [SEAL_IN[0].replace('X0', 'Y0'), SEAL_IN[1], SEAL_IN[2].replace('Y0', 'X0'), SEAL_IN[3]],
  },
  {
    edit: 'wrapInBranch', at: [1, 4], to: [1, 15], selected: '???',
    before: ['|   X0      X1                             Y0  |', '+---| |-----| |----------------------------( )-+'],
    after: [
      '|   X0      X1                             Y0  |',
      '+---| |-----| |---+------------------------( )-+',
      '|   ???           |                            |',
      '+---| |-----------+                            |',
    ],
  },
  {
    edit: 'deleteElement', before: SEAL_IN, at: [1, 15], selected: '',
    after: [
      '|   X0                                     Y0  |',
      '+---| |---+--------------------------------( )-+',
      ...SEAL_IN.slice(2),
    ],
  },
  {
    edit: 'deleteBranch', before: SEAL_IN, at: [3, 5], selected: '',
    after: ['|   X0      X1                             Y0  |', '+---| |-----|/|----------------------------( )-+'],
  },
  {
    edit: 'negate', before: SEAL_IN, at: [1, 15], selected: '',
    after: [SEAL_IN[0], '+---| |---+---| |--------------------------( )-+', ...SEAL_IN.slice(2)],
  },
  {
    edit: 'mend', at: [0, 14], selected: '',
    before: ['|   X10        X1                           Y0  |', ...SEAL_IN.slice(1)],
    after: ['|   X10       X1                           Y0  |', ...SEAL_IN.slice(1)],
  },
];

const program = (lines) => [...lines, ...END].join('\n');

async function open(text) {
  const document = await openText('ladder', text);
  return { document, editor: vscode.window.activeTextEditor };
}

const close = () => vscode.commands.executeCommand('workbench.action.revertAndCloseActiveEditor');

async function runEdit({ edit, before, at, to, operand, after, selected }) {
  const { document, editor } = await open(program(before));
  editor.selection = new vscode.Selection(...at, ...(to ?? at));
  const done = await vscode.commands.executeCommand(`rungwise.${edit}`, operand && { operand });
  assert.equal(document.getText(), program(after), edit);
  assert.equal(done, true);
  assert.equal(document.getText(editor.selection), selected);
  // What was inserted without a name is typed over, and all of it goes by one undo for the edit.
  await vscode.commands.executeCommand('undo');
  assert.equal(document.getText(), program(before), `one undo of ${edit}`);
  await vscode.commands.executeCommand('redo');
  assert.equal(document.getText(), program(after), `one redo of ${edit}`);
  await close();
}

module.exports = [
  ...EDITS.map((script) => [`the edit ${script.edit}${script.operand ? ` of ${script.operand}` : ''}`, () => runEdit(script)]),
  ['an edit that is not possible says why and changes nothing', async () => {
    const { document, editor } = await open(program(SEAL_IN));
    editor.selection = new vscode.Selection(1, 15, 1, 15);
    assert.equal(await vscode.commands.executeCommand('rungwise.insertCoil'), false);
    assert.equal(document.getText(), program(SEAL_IN));
    await close();
  }],
  ['edits in a hurry run one after another', async () => {
    const { document, editor } = await open(program(PLAIN));
    editor.selection = new vscode.Selection(1, 5, 1, 5);
    const run = (operand) => vscode.commands.executeCommand('rungwise.insertContact', { operand });
    assert.deepEqual(await Promise.all([run('X1'), run('X2'), run('X3')]), [true, true, true]);
    const [names] = document.getText().split('\n');
    for (const name of ['X0', 'X1', 'X2', 'X3', 'Y0']) {
      assert.ok(names.split(/\s+/).includes(name), names);
    }
    await until('no errors', () => errors(document).length === 0);
    await close();
  }],
  ['a pasted name that is longer pushes nothing aside', async () => {
    const { document, editor } = await open(program(SEAL_IN));
    editor.selection = new vscode.Selection(0, 4, 0, 6);
    await vscode.commands.executeCommand('paste', { text: 'X17' });
    const wanted = program(['|   X17       X1                           Y0  |', ...SEAL_IN.slice(1)]);
    await until(`the name in its place`, () => document.getText() === wanted)
      .catch((error) => assert.fail(`${error.message}\n${document.getText()}`));
    // VS Code closes the undo step of a paste itself, so the mending is a step of its own.
    await vscode.commands.executeCommand('undo');
    await vscode.commands.executeCommand('undo');
    assert.equal(document.getText(), program(SEAL_IN));
    await close();
  }],
];
