// The extension as such: installed, active, languages, commands, snippets.

const assert = require('node:assert/strict');
const fs = require('node:fs');
const path = require('node:path');
const vscode = require('vscode');
const { describe, errors, open, openText, sleep, until } = require('./support');

const extension = () => vscode.extensions.getExtension('rungwise.rungwise');

/** Text that a snippet inserts when nothing is typed over. */
function expand(snippet) {
  return [snippet.body].flat().join('\n')
    .replace(/\$\{\d+\|([^,|]*)[^|]*\|\}/g, '$1')
    .replace(/\$\{\d+:([^}]*)\}/g, '$1')
    .replace(/\$\d+/g, '');
}

async function assertNoErrors(title, document) {
  const uri = document.uri.toString();
  await until(`a status of ${title}`, () => extension().exports.programStatus(uri));
  // Only a result that stays is one: diagnostics follow the status within a moment.
  await sleep(300);
  assert.equal(errors(document).length, 0, `${title}: ${describe(document)}\n${document.getText()}`);
}

module.exports = [
  ['the extension is installed from the VSIX, and its own server runs', async () => {
    assert.ok(extension(), 'rungwise.rungwise is not installed');
    await open('conveyor_fx.il');
    const api = await extension().activate();
    await until('a running server', () => api.serverState() === 'running');
    assert.match(api.serverVersion(), /^\d+\.\d+\.\d+/);
    const program = path.join(extension().extensionPath, 'bin', 'rungwise');
    assert.ok(fs.existsSync(program), 'no server inside the extension');
  }],
  ['files get their languages', async () => {
    assert.equal((await open('three_mistakes.lad')).languageId, 'ladder');
    assert.equal((await open('mixer_iec.il')).languageId, 'plc-il');
  }],
  ['all commands of package.json are registered', async () => {
    const registered = await vscode.commands.getCommands(true);
    for (const { command } of extension().packageJSON.contributes.commands) {
      assert.ok(registered.includes(command), command);
    }
  }],
  ['comments are toggled with //', async () => {
    for (const language of ['ladder', 'plc-il']) {
      const document = await openText(language, 'LD X0\n');
      await vscode.commands.executeCommand('editor.action.commentLine');
      await until('a comment', () => document.lineAt(0).text === '// LD X0');
      await vscode.commands.executeCommand('workbench.action.revertAndCloseActiveEditor');
    }
  }],
  ['every rung among the ladder snippets is a program without errors', async () => {
    const file = path.join(extension().extensionPath, 'snippets', 'ladder.json');
    const rungs = Object.entries(JSON.parse(fs.readFileSync(file, 'utf8'))).filter(([title]) => /^(Rungs?:|Program)/.test(title));
    const end = expand(rungs.find(([title]) => title === 'Rung: END')[1]);
    for (const [title, snippet] of rungs) {
      const drawing = expand(snippet);
      // An FX program ends with END, a jump needs its label; a function block needs no FX end.
      const rest = title.includes('jump') ? `FINISH:\n${end}` : /END|IEC|\(TON\)|declarations/.test(title) ? '' : end;
      const document = await openText('ladder', `${drawing}\n${rest}`);
      await assertNoErrors(title, document);
      await vscode.commands.executeCommand('workbench.action.revertAndCloseActiveEditor');
    }
    assert.ok(rungs.length >= 15);
  }],
  ['every rung among the FX snippets is a program without errors', async () => {
    const file = path.join(extension().extensionPath, 'snippets', 'plc-il.json');
    const snippets = Object.entries(JSON.parse(fs.readFileSync(file, 'utf8'))).filter(([title]) => /^FX: /.test(title));
    for (const [title, snippet] of snippets) {
      const after = { 'FX: step': 'RET\n' }[title] ?? '';
      const end = /\bEND$/.test(expand(snippet).trim()) ? '' : 'END\n';
      const document = await openText('plc-il', `// dialect: fx\n${expand(snippet)}\n${after}${end}`);
      await assertNoErrors(title, document);
      await vscode.commands.executeCommand('workbench.action.revertAndCloseActiveEditor');
    }
    assert.ok(snippets.length >= 10);
  }],
];
