// A folder that nobody has trusted: its settings must not choose the program that is started.

import { existsSync, mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { openBrowser } from './browser.mjs';
import { listener, projectAt } from './page_line.mjs';
import { Workbench } from './workbench.mjs';

export async function runTrustTests(server, workspace, home, report, artefacts) {
  const marker = join(home, 'started-by-the-folder');
  const program = join(workspace, 'server.sh');
  writeFileSync(program, `#!/bin/sh\ntouch "${marker}"\n`, { mode: 0o755 });
  mkdirSync(join(workspace, '.vscode'));
  const settings = { 'rungwise.server.path': program, 'rungwise.target': 'fx3u' };
  writeFileSync(join(workspace, '.vscode', 'settings.json'), JSON.stringify(settings));
  const line = await listener();
  projectAt(workspace, line.port);
  await server.start(workspace, { trusted: false });
  const browser = await openBrowser(home);
  try {
    const workbench = new Workbench(await browser.newPage(), artefacts);
    await report.check('page: a folder without trust does not choose the server, and has all else', async () => {
      await workbench.load(`http://${server.authority}/?folder=${workspace}`);
      await workbench.status('Restricted Mode');
      await workbench.openFile('three_mistakes.lad');
      await workbench.until('squiggles', async () => (await workbench.errorSquiggles()) >= 3);
      // A setting without danger counts.
      await workbench.status('FX3U');
      await workbench.screenshot('21-without-trust');
      if (existsSync(marker)) {
        throw new Error('the program that the folder names was started');
      }
    });
    await report.check('page: in a folder without trust nothing is said to a PLC, whoever asks for it', async () => {
      await workbench.openByName('named.il');
      await workbench.status('FX3U');
      await workbench.command('Rungwise: PLC: Connect');
      await workbench.page.locator('.notifications-toasts', { hasText: 'in a workspace that is not trusted' }).first().waitFor({ timeout: 45_000 });
      if (line.count() !== 0) {
        throw new Error(`${line.count()} connections`);
      }
    });
  } finally {
    await browser.close();
    server.stop();
    line.server.close();
  }
}
