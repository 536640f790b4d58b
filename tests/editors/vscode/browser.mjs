// Opens Chromium with an empty profile, in a folder below `home`.

import { mkdtempSync } from 'node:fs';
import { join } from 'node:path';
import { chromium } from 'playwright-core';

export function openBrowser(home) {
  return chromium.launchPersistentContext(mkdtempSync(join(home, 'chromium-')), {
    executablePath: process.env.RUNGWISE_CHROMIUM ?? '/usr/bin/chromium',
    headless: true,
    viewport: { width: 1280, height: 800 },
    timeout: 60_000,
    args: [
      '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
      '--disable-component-update', '--disable-sync',
    ],
  });
}
