import { cpSync, mkdirSync, mkdtempSync, rmSync } from 'node:fs';
import { execFileSync } from 'node:child_process';
import { CodeServer } from './vscode/code_server.mjs';
import { openBrowser } from './vscode/browser.mjs';
import { Workbench } from './vscode/workbench.mjs';
const home = '/tmp/panel/drive/home'; mkdirSync(home, { recursive: true });
const server = new CodeServer('/work/main/.cache/editors', home);
execFileSync(process.execPath, ['/work/wt/panel/vscode-extension/scripts/package.mjs', '--server', '/tmp/panel/rungwise', '--out', home + '/r.vsix'], { stdio: 'inherit' });
console.log(server.install(home + '/r.vsix'));
const ws = home + '/ws'; rmSync(ws, { recursive: true, force: true }); cpSync('/work/wt/panel/examples', ws, { recursive: true });
cpSync('/work/wt/panel/tests/editors/fixtures/motor.lad', ws + '/plain.lad');
await server.start(ws);
const browser = await openBrowser(home);
const page = await browser.newPage();
page.on('console', (m) => { if (m.type() === 'error') console.log('CONSOLE', m.text().slice(0, 400)); });
await page.setViewportSize({ width: 1440, height: 900 });
const wb = new Workbench(page, '/tmp/panel/drive');
try {
  const { run } = await import(process.argv[2]);
  await wb.load(`http://${server.authority}/?folder=${ws}`);
  await run(wb, server, ws);
} catch (e) { console.log(e); await wb.screenshot('error').catch(() => {}); }
finally { await browser.close(); server.stop(); }
process.exit(0);
