// Runs the tests of host/ inside the extension host of a code-server.

import { existsSync, readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { openBrowser } from './browser.mjs';

const HERE = dirname(fileURLToPath(import.meta.url));
const TIMEOUT_MS = 300_000;

/** Starts the tests by opening a page, and reports what they write. */
export async function runHostTests(server, workspace, home, report, artefacts) {
  const results = join(home, 'host-results.jsonl');
  const environment = { RUNGWISE_TEST_RESULTS: results, RUNGWISE_TEST_WORKSPACE: workspace };
  await server.start(workspace, { environment, testDriver: true });
  const browser = await openBrowser(home);
  try {
    const page = await browser.newPage();
    const remote = (path) => `vscode-remote://${server.authority}${path}`;
    const payload = [
      ['extensionDevelopmentPath', remote(join(HERE, 'host'))],
      ['extensionTestsPath', remote(join(HERE, 'host', 'tests.js'))],
    ];
    await page.goto(`http://${server.authority}/?folder=${workspace}&payload=${encodeURIComponent(JSON.stringify(payload))}`);
    const done = await waitForEnd(results, page, report);
    await page.screenshot({ path: join(artefacts, 'host-tests-end.png') });
    if (!done) {
      report.fail('the tests in the extension host end', `no end within ${TIMEOUT_MS} ms`);
    }
  } finally {
    await browser.close();
    server.stop();
  }
}

async function waitForEnd(results, page, report) {
  const end = Date.now() + TIMEOUT_MS;
  let seen = 0;
  while (Date.now() < end) {
    const lines = existsSync(results) ? readFileSync(results, 'utf8').split('\n').slice(0, -1) : [];
    for (const line of lines.slice(seen).map((text) => JSON.parse(text))) {
      if (line.done) {
        return true;
      }
      if (line.error) {
        report.fail(`host: ${line.name}`, line.error);
      } else {
        report.pass(`host: ${line.name}`, line.durationMs);
      }
    }
    seen = lines.length;
    await page.waitForTimeout(250);
  }
  return false;
}
