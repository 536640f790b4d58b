// The edition for the browser alone, in which no program can be started: the same extension, run in a web worker.

import { openBrowser } from './browser.mjs';
import { Workbench } from './workbench.mjs';

const KIND = 'remote.extensionKind';

export async function runWebTests(server, workspace, home, report, artefacts) {
  server.changeSetting(KIND, { 'rungwise.rungwise': ['web'] });
  await server.start(workspace);
  const browser = await openBrowser(home);
  try {
    const workbench = new Workbench(await browser.newPage(), artefacts);
    await report.check('page: in the browser alone there are colours and snippets, and a message that says why no more', async () => {
      await workbench.load(`http://${server.authority}/?folder=${workspace}`);
      await workbench.openFile('edited.lad');
      const toast = workbench.page.locator('.notification-toast', { hasText: 'without a computer for the language server' }).first();
      await toast.waitFor({ timeout: 45_000 });
      await workbench.until('colours', async () => {
        const colours = await workbench.page.locator('.editor-instance .view-line span span').evaluateAll((spans) =>
          spans.filter((span) => span.textContent.trim() !== '').map((span) => getComputedStyle(span).color));
        return new Set(colours).size >= 3;
      });
      await workbench.page.waitForTimeout(500); // The message slides in.
      await workbench.screenshot('23-in-the-browser-alone');
      await toast.hover();
      await toast.locator('.codicon-notifications-clear').click();
      await workbench.focusEditor();
      await workbench.page.keyboard.press('Control+End');
      await workbench.page.keyboard.type('seal', { delay: 60 });
      await workbench.until('the snippet', async () => {
        const rows = await workbench.page.locator('.suggest-widget.visible .monaco-list-row').allInnerTexts();
        return rows.some((row) => /^seal\b/.test(row.trim()));
      });
    });
  } finally {
    await browser.close();
    server.stop();
    server.changeSetting(KIND, undefined);
  }
}
