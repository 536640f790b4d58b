// The tests in a real VS Code: builds the VSIX, installs it in code-server, runs the tests in the extension host and then
// the tests that use the page as a person does.
//
// Usage: node run.mjs CACHE ARTEFACTS SERVER

import { execFileSync } from 'node:child_process';
import { cpSync, mkdirSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { Report } from '../report.mjs';
import { CodeServer } from './code_server.mjs';
import { runHostTests } from './host_tests.mjs';
import { runPageTests } from './page_tests.mjs';
import { runTrustTests } from './page_trust.mjs';
import { runWebTests } from './page_web.mjs';

const [cache, artefacts, binary] = process.argv.slice(2);
const tests = join(dirname(fileURLToPath(import.meta.url)), '..');
const home = mkdtempSync(join(tmpdir(), 'rungwise-vscode-'));
const report = new Report();
const server = new CodeServer(cache, home);
for (const signal of ['SIGINT', 'SIGTERM', 'SIGHUP']) {
  process.on(signal, () => {
    server.stop();
    process.exit(1);
  });
}

await report.check('the VSIX is built and installed', () => {
  const vsix = join(home, 'rungwise.vsix');
  const script = join(tests, '../../vscode-extension/scripts/package.mjs');
  execFileSync(process.execPath, [script, '--server', binary, '--out', vsix], { stdio: ['ignore', 'inherit', 'inherit'] });
  const said = server.install(vsix);
  if (!/successfully installed/.test(said)) {
    throw new Error(said);
  }
});
mkdirSync(artefacts, { recursive: true });
await withWorkspace('host', (workspace) => runHostTests(server, workspace, home, report, artefacts));
await withWorkspace('page', (workspace) => runPageTests(server, workspace, home, report, artefacts));
await withWorkspace('trust', (workspace) => runTrustTests(server, workspace, home, report, artefacts));
await withWorkspace('web', (workspace) => runWebTests(server, workspace, home, report, artefacts));
const code = report.finish();
cpSync(server.log, join(artefacts, 'code-server.log'));
if (code === 0) {
  rmSync(home, { recursive: true, force: true });
} else {
  console.log(`user folder and logs: ${home}`);
}
process.exit(code);

/** Gives each part a fresh copy of the fixtures, so that no part sees what another one saved. */
async function withWorkspace(name, body) {
  const workspace = join(home, name);
  cpSync(join(tests, 'fixtures'), workspace, { recursive: true });
  try {
    await body(workspace);
  } catch (error) {
    report.fail(`the ${name} tests run to their end`, error);
  } finally {
    server.stop();
  }
}
