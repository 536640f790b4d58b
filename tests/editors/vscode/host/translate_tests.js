// Translations and refactorings as code actions, and the forms of a rung, with the real server.

const assert = require('node:assert/strict');
const vscode = require('vscode');
const { find, hoverText, open, openText, until } = require('./support');

const LIST = 'LD X0\nLD X1\nOR X2\nANB\nOUT Y0\nLD X5\nOUT Y5\nEND\n';

/** The code actions of a kind at a place; the server may not know the document yet. */
function actions(document, position, kind) {
  const range = new vscode.Range(position, position);
  return until(`actions of the kind ${kind}`, async () => {
    const found = await vscode.commands.executeCommand('vscode.executeCodeActionProvider', document.uri, range, kind);
    return found.length > 0 && found;
  });
}

const run = ({ command }) => vscode.commands.executeCommand(command.command, ...command.arguments);
const texts = () => vscode.workspace.textDocuments.map((document) => document.getText());

module.exports = [
  ['a rung is opened in another form beside the program', async () => {
    const document = await openText('plc-il', LIST);
    const [action] = await actions(document, find(document, 'OR X2'), 'refactor.rewrite.translate.boolean');
    assert.equal(action.title, 'Translate rung to boolean form (proved equal)');
    await run(action);
    await until('the boolean form', () => texts().includes('Y0 = X0*(X1 + X2)\n'));
    const drawing = await open('ragged.lad');
    const source = await actions(drawing, new vscode.Position(0, 0), 'source.translate.fx');
    assert.deepEqual(source.map(({ title }) => title), ['Translate file to FX list', 'Copy file as FX list']);
    await run(source[0]);
    const lists = () => vscode.workspace.textDocuments.filter(({ languageId, isUntitled }) => isUntitled && languageId === 'plc-il');
    await until('the list', () => lists().some((list) => list.getText() !== LIST && /^END$/m.test(list.getText())));
  }],
  ['a rung is copied in another form', async () => {
    const document = await openText('plc-il', LIST);
    const [action] = await actions(document, find(document, 'OR X2'), 'refactor.rewrite.translate.boolean.copy');
    await vscode.env.clipboard.writeText('');
    await run(action);
    await until('the clipboard', async () => (await vscode.env.clipboard.readText()) === 'Y0 = X0*(X1 + X2)\n');
  }],
  ['a refactoring that saves steps is applied', async () => {
    const document = await openText('plc-il', LIST);
    const [action] = await actions(document, find(document, 'LD X0'), 'refactor.rewrite.rung.wideFirst');
    assert.equal(action.title, 'Move wide branch first (saves 1 step)');
    assert.ok(await vscode.workspace.applyEdit(action.edit));
    assert.match(document.getText(), /^LD X1\nOR X2\nAND X0\nOUT Y0$/m);
  }],
  ['the forms of a rung follow the cursor with the real server', async () => {
    const document = await openText('plc-il', LIST);
    const editor = await vscode.window.showTextDocument(document);
    const go = (word) => (editor.selection = new vscode.Selection(find(document, word), find(document, word)));
    const page = () => vscode.workspace.textDocuments.find(({ uri }) => uri.scheme === 'rungwise-forms')?.getText() ?? '';
    go('OUT Y0');
    await vscode.commands.executeCommand('rungwise.showForms');
    await until('all forms of the first rung', () => /Y0 = X0\*\(X1 \+ X2\)/.test(page()) && /proved/.test(page()) && /\( \)/.test(page()));
    go('OUT Y5');
    await until('the next rung', () => /Y5 = X5/.test(page()) && !/X1 \+ X2/.test(page()));
  }],
  ['two programs are compared, and the page shows how they differ', async () => {
    const left = await openText('plc-il', 'LD X0\nANI X1\nOUT Y0\nEND\n');
    const right = await openText('plc-il', 'LD X0\nAND X1\nOUT Y0\nEND\n');
    const prove = (one, other) => vscode.commands.executeCommand('rungwise.proveEqual', one.uri, other.uri);
    const page = await until('the proof', () => prove(left, right));
    assert.match(page, /different: Y0/);
    const shown = () => vscode.workspace.textDocuments.find(({ uri }) => uri.scheme === 'rungwise-proof')?.getText();
    assert.equal(shown(), page);
    assert.match(await prove(left, left), /equal: for all inputs/);
  }],
  ['the hover of an output shows its equation', async () => {
    const document = await openText('plc-il', LIST);
    await until('the equation', async () => (await hoverText(document, find(document, 'Y0'))).includes('Y0 = X0*(X1 + X2)'));
  }],
];
