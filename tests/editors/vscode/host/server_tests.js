// Commands, status, settings, and the life of the server: restart, crash, a wrong path.

const assert = require('node:assert/strict');
const fs = require('node:fs');
const path = require('node:path');
const vscode = require('vscode');
const { errors, open, until, untilCodes } = require('./support');

const extension = () => vscode.extensions.getExtension('rungwise.rungwise');
const api = () => extension().exports;
const rungwise = () => vscode.workspace.getConfiguration('rungwise');
const set = (name, value) => rungwise().update(name, value, vscode.ConfigurationTarget.Global);

/** Process numbers of the bundled server: programs whose command line names it. */
function serverProcesses() {
  const program = path.join(extension().extensionPath, 'bin', 'rungwise');
  return fs.readdirSync('/proc').filter((entry) => /^\d+$/.test(entry)).map(Number).filter((pid) => {
    try {
      return fs.readFileSync(`/proc/${pid}/cmdline`, 'utf8').split('\0').includes(program);
    } catch {
      return false;
    }
  });
}

async function untilOneServer() {
  return until('one running server', () => {
    const found = serverProcesses();
    return api().serverState() === 'running' && found.length === 1 && found;
  });
}

module.exports = [
  ['Check Program answers with a summary', async () => {
    await untilCodes(await open('conveyor_fx.il'), []);
    const clean = await vscode.commands.executeCommand('rungwise.checkProgram');
    assert.match(clean, /\bcheck passed: \d+ rungs, 15 of \d+ steps\b/);
    const { uri } = await open('three_mistakes.lad');
    const broken = await vscode.commands.executeCommand('rungwise.checkProgram', uri);
    assert.match(broken, /\b3 errors\b/);
    assert.doesNotMatch(broken, /passed/);
  }],
  ['Show Server Version knows the version', async () => {
    assert.match(await vscode.commands.executeCommand('rungwise.serverVersion'), /^\d+\.\d+\.\d+/);
  }],
  ['the status shows target, dialect and steps, and follows the setting', async () => {
    const document = await open('conveyor_fx.il');
    const status = () => api().programStatus(document.uri.toString());
    await until('a status', () => status()?.target === 'fx2n' && status().dialect === 'fx');
    assert.equal(status().steps, 15);
    assert.ok(status().capacity >= 2000);
    assert.match(api().statusBarText(), /FX2N.*15\//);
    try {
      await set('target', 'fx3u');
      await until('the target FX3U', () => status()?.target === 'fx3u' && /FX3U/.test(api().statusBarText()));
    } finally {
      await set('target', undefined);
    }
    await until('the target FX2N', () => status()?.target === 'fx2n');
    const iec = await open('mixer_iec.il');
    await until('the target IEC', () => api().programStatus(iec.uri.toString())?.target === 'iec');
  }],
  ['Restart Server leaves one server, which knows the open documents', async () => {
    const document = await open('three_mistakes.lad');
    const [before] = await untilOneServer();
    await vscode.commands.executeCommand('rungwise.restartServer');
    const [after] = await untilOneServer();
    assert.notEqual(after, before);
    await until('diagnostics', () => errors(document).length === 3);
  }],
  ['a server that is killed comes back, with its diagnostics', async () => {
    const document = await open('three_mistakes.lad');
    const [before] = await untilOneServer();
    process.kill(before, 'SIGKILL');
    await until('another server', () => serverProcesses().some((pid) => pid !== before));
    await untilOneServer();
    await until('diagnostics', () => errors(document).length === 3);
  }],
  ['a wrong path is a readable failure, and a right one is the cure', async () => {
    try {
      await set('server.path', '/nowhere/rungwise');
      await until('the failure', () => api().serverState() === 'failed');
      assert.equal(api().serverVersion(), undefined);
      assert.match(api().statusBarText(), /\$\(error\)/);
      await until('the end of the old server', () => serverProcesses().length === 0);
    } finally {
      await set('server.path', undefined);
    }
    await untilOneServer();
  }],
];
