// Diagnostics at the exact cells, and what edits do to them.

const assert = require('node:assert/strict');
const vscode = require('vscode');
const { assertCells, codeOf, errors, open, replace, revert, until, untilCodes } = require('./support');

const LADDER = 'three_mistakes.lad';
const THREE = ['short-circuit', 'open-circuit', 'mixed-connection'];

/** Blanks out columns `from` to `to` (excluded) of some lines in one edit. */
async function blank(document, ...places) {
  const editor = await vscode.window.showTextDocument(document);
  await editor.edit((edit) => {
    for (const [line, from, to] of places) {
      edit.replace(new vscode.Range(line, from, line, to), ' '.repeat(to - from));
    }
  });
}

/** Opens the ladder, edits it, expects these errors, and expects all three again when the edit is taken back. */
async function edited(change, codes) {
  const document = await open(LADDER);
  await untilCodes(document, THREE);
  await change(document);
  await untilCodes(document, codes);
  assertCells(document, LADDER);
  await revert(document);
  await untilCodes(document, THREE);
}

module.exports = [
  ['a short circuit, an open circuit and a bridge are the three errors of a ladder, at their cells', async () => {
    const document = await open(LADDER);
    await untilCodes(document, THREE);
    assertCells(document, LADDER);
    for (const diagnostic of errors(document)) {
      assert.equal(diagnostic.source, 'rungwise');
      assert.ok(diagnostic.message.length > 20, `a message says what is wrong: "${diagnostic.message}"`);
    }
  }],
  ['drawing the missing wire clears the open circuit and nothing else', () =>
    edited((document) => replace(document, 12, 16, 20, '----'), ['short-circuit', 'mixed-connection'])],
  ['taking the bypass wire away clears the short circuit and nothing else', () =>
    edited((document) => blank(document, [5, 16, 17], [6, 1, 17]).then(() => replace(document, 6, 0, 1, '|')),
      ['open-circuit', 'mixed-connection'])],
  ['taking the bridge away clears the mixed connection and nothing else', () =>
    edited((document) => blank(document, [19, 10, 19], [20, 10, 23], [21, 22, 23]), ['open-circuit', 'short-circuit'])],
  ['a rung that is broken gets an error, and loses it by undo', async () => {
    const document = await open('ragged.lad');
    await untilCodes(document, []);
    await replace(document, 2, 20, 24, '    ');
    await vscode.commands.executeCommand('undo');
    await untilCodes(document, []);
    await replace(document, 2, 20, 24, '    ');
    await until('an error', () => errors(document).some((d) => codeOf(d) === 'open-circuit'));
    await vscode.commands.executeCommand('undo');
    await untilCodes(document, []);
  }],
  ['an instruction list gets its errors at their words', async () => {
    const document = await open('mistakes_fx.il');
    await untilCodes(document, ['unknown-instruction', 'octal-digit']);
    assertCells(document, 'mistakes_fx.il');
    await replace(document, 2, 0, 4, 'MOV');
    await untilCodes(document, ['octal-digit']);
    await replace(document, 3, 3, 5, 'X7');
    await untilCodes(document, []);
    await revert(document);
  }],
  ['clean programs have no errors', async () => {
    for (const name of ['conveyor_fx.il', 'mixer_iec.il', 'ragged.lad']) {
      await untilCodes(await open(name), []);
    }
  }],
];
