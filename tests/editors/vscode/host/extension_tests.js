// The extension as such: installed, active, languages, commands, snippets.

const assert = require('node:assert/strict');
const { spawnSync } = require('node:child_process');
const fs = require('node:fs');
const path = require('node:path');
const vscode = require('vscode');
const { WORKSPACE, open, openText, until } = require('./support');

const extension = () => vscode.extensions.getExtension('rungwise.rungwise');

/** Text that a snippet inserts when nothing is typed over. */
function expand(snippet) {
  return [snippet.body].flat().join('\n')
    .replace(/\$\{\d+\|([^,|]*)[^|]*\|\}/g, '$1')
    .replace(/\$\{\d+:([^}]*)\}/g, '$1')
    .replace(/\$\d+/g, '');
}

const snippets = (language) =>
  JSON.parse(fs.readFileSync(path.join(extension().extensionPath, 'snippets', `${language}.json`), 'utf8'));

/** Writes a program into a folder of its own and gives its path. */
function write(name, text) {
  const file = path.join(fs.mkdtempSync(path.join(path.dirname(WORKSPACE), 'snippet-')), name.replace(/\W+/g, '-').replace(/-(lad|il)$/, '.$1'));
  fs.writeFileSync(file, text);
  return file;
}

/** Runs the server that is inside the extension, and gives what it printed. */
function server(args) {
  const { stdout, stderr } = spawnSync(path.join(extension().extensionPath, 'bin', 'rungwise'), args, { encoding: 'utf8' });
  assert.equal(stderr, '');
  return stdout;
}

/** Checks programs, given as [title, text], with the server that is inside the extension. */
function assertNoErrors(programs, ending) {
  const titles = new Map(programs.map(([title, text]) => [write(`${title}.${ending}`, text), title]));
  const { files } = JSON.parse(server(['check', '--format', 'json', ...titles.keys()]));
  assert.equal(files.length, programs.length);
  for (const file of files) {
    const errors = file.diagnostics.filter((diagnostic) => diagnostic.severity === 'error');
    assert.deepEqual(errors, [], `${titles.get(file.path)}:\n${fs.readFileSync(file.path, 'utf8')}`);
  }
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
  ['every rung among the ladder snippets is a program without errors, in canonical form', async () => {
    const rungs = Object.entries(snippets('ladder')).filter(([title]) => /^(Rungs?:|Program)/.test(title));
    const end = expand(rungs.find(([title]) => title === 'Rung: END')[1]);
    const programs = rungs.map(([title, snippet]) => {
      const drawing = expand(snippet);
      // An FX program ends with END, a jump needs its label; a function block needs no FX end.
      const rest = title.includes('jump') ? `P0:\n${end}` : /END|IEC|\(TON\)|declarations/.test(title) ? '' : end;
      return [title, `${drawing}\n${rest}`, drawing];
    });
    assert.ok(rungs.length >= 15);
    assertNoErrors(programs, 'lad');
    for (const [title, , drawing] of programs) {
      // A snippet that the formatter would move about makes a poor neighbour in a formatted file.
      assert.equal(server(['fmt', '--stdout', write(`${title}.lad`, drawing)]).trimEnd(), drawing.trimEnd(), title);
    }
  }],
  ['every rung among the FX snippets is a program without errors', async () => {
    const list = Object.entries(snippets('plc-il')).filter(([title]) => /^FX: /.test(title));
    assert.ok(list.length >= 10);
    assertNoErrors(list.map(([title, snippet]) => {
      const after = { 'FX: step': 'RET\n' }[title] ?? '';
      const end = /\bEND$/.test(expand(snippet).trim()) ? '' : 'END\n';
      return [title, `// dialect: fx\n${expand(snippet)}\n${after}${end}`];
    }), 'il');
  }],
];
