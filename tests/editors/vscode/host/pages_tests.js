// Pages, tasks, the example, the walkthrough, the devices in use.

const assert = require('node:assert/strict');
const fs = require('node:fs');
const path = require('node:path');
const vscode = require('vscode');
const { WORKSPACE, codeOf, errors, find, open, until, untilCodes } = require('./support');

const run = (command, ...args) => vscode.commands.executeCommand(`rungwise.${command}`, ...args);
const closeAll = () => vscode.commands.executeCommand('workbench.action.closeAllEditors');
const activeTab = () => vscode.window.tabGroups.activeTabGroup.activeTab;

/** Runs a task to its end and gives its exit code. */
async function runTask(task) {
  const ended = new Promise((resolve) => {
    const listener = vscode.tasks.onDidEndTaskProcess(({ execution, exitCode }) => {
      if (execution.task.name === task.name) {
        listener.dispose();
        resolve(exitCode);
      }
    });
  });
  await vscode.tasks.executeTask(task);
  return ended;
}

const taskErrors = () =>
  vscode.languages.getDiagnostics().flatMap(([uri, list]) =>
    // What a task found has no owner in this interface; the server's own findings link to a page.
    list.filter((d) => typeof d.code !== 'object').map((d) => `${path.basename(uri.fsPath)}:${d.range.start.line + 1} ${d.code}`));

module.exports = [
  ['Explain shows the page of the error at the cursor', async () => {
    const document = await open('three_mistakes.lad');
    await until('errors', () => errors(document).length === 3);
    const short = errors(document).find((error) => codeOf(error) === 'short-circuit');
    vscode.window.activeTextEditor.selection = new vscode.Selection(short.range.start, short.range.start);
    assert.match(await run('explain'), /short.circuit/i);
    assert.match(activeTab().label, /short-circuit/);
    await closeAll();
  }],
  ['Explain shows the page of the instruction at the cursor', async () => {
    const document = await open('conveyor_fx.il');
    await untilCodes(document, []);
    const at = find(document, 'MOV');
    vscode.window.activeTextEditor.selection = new vscode.Selection(at, at);
    assert.match(await run('explain'), /MOV/);
    assert.equal(await run('explain', 'nosuchword'), undefined);
    await closeAll();
  }],
  ['the code of a diagnostic links to the page of its rule', async () => {
    const document = await open('three_mistakes.lad');
    await until('errors', () => errors(document).length === 3);
    for (const error of errors(document)) {
      const page = await vscode.workspace.openTextDocument(error.code.target);
      assert.ok(page.getText().includes(error.code.value), page.getText().slice(0, 200));
    }
  }],
  ['Show Status says which server runs, and why that one', async () => {
    const document = await open('conveyor_fx.il');
    await untilCodes(document, []);
    const page = await run('showStatus');
    for (const part of ['bundled', 'running', 'conveyor_fx.il', 'fx2n', '"inlayHints"']) {
      assert.ok(page.includes(part), `${part} is not in:\n${page}`);
    }
    await closeAll();
  }],
  ['the task "check" lists the findings of files that are not open', async () => {
    // A file that was open in this session counts as open for minutes, and what is open has the server's own findings.
    const tasks = await vscode.tasks.fetchTasks({ type: 'rungwise' });
    assert.deepEqual(tasks.map((task) => task.name).sort(), ['check', 'fmt --check']);
    assert.equal(await runTask(tasks.find((task) => task.name === 'check')), 1);
    const wanted = ['never_opened.lad:5 short-circuit'];
    await until(`problems ${wanted}`, () => wanted.every((problem) => taskErrors().includes(problem)), 5_000)
      .catch((error) => assert.fail(`${error.message}: ${taskErrors()}`));
  }],
  ['the task "fmt --check" finds the ragged drawing and leaves it alone', async () => {
    const file = path.join(WORKSPACE, 'ragged.lad');
    const before = fs.readFileSync(file, 'utf8');
    const tasks = await vscode.tasks.fetchTasks({ type: 'rungwise' });
    assert.equal(await runTask(tasks.find((task) => task.name === 'fmt --check')), 1);
    assert.equal(fs.readFileSync(file, 'utf8'), before);
  }],
  ['the example is copied into a folder, never over anything, and is clean', async () => {
    const folder = vscode.Uri.file(fs.mkdtempSync(path.join(path.dirname(WORKSPACE), 'example-')));
    const first = await run('openExample', { folder });
    const second = await run('openExample', { folder });
    assert.notEqual(first.toString(), second.toString());
    assert.ok(fs.existsSync(path.join(path.dirname(first.fsPath), 'rungwise.toml')));
    const document = vscode.workspace.textDocuments.find(({ uri }) => uri.toString() === second.toString());
    await untilCodes(document, []);
    await closeAll();
  }],
  ['the example is opened without saving', async () => {
    const uri = await run('openExample', { scratch: true });
    assert.equal(uri.scheme, 'untitled');
    assert.equal(vscode.window.activeTextEditor.document.languageId, 'ladder');
    await vscode.commands.executeCommand('workbench.action.revertAndCloseActiveEditor');
  }],
  ['Get Started opens the walkthrough', async () => {
    await run('openWalkthrough');
    await until('the walkthrough', () => /Rungwise|Walkthrough|Welcome/i.test(activeTab()?.label ?? ''));
    await closeAll();
  }],
];
