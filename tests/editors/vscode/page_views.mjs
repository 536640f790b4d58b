// What the extension shows beside the program: walkthrough, pages, devices in use, tasks, lenses and hints, fences.

export const VIEW_TESTS = {
  'the walkthrough opens with its pictures': walkthrough,
  'the code of an error opens the page of its rule': explain,
  'the devices in use stand beside the program and follow it': usage,
  'lenses and hints are drawn into the program': hints,
  'a drawing in a fence of a Markdown file has its errors': fences,
  'the icons of the files are seen in both themes': icons,
  'the task lists what it finds in the problems': task,
};

async function walkthrough(workbench) {
  await workbench.command('Rungwise: Get Started');
  const page = workbench.page.locator('.gettingStartedContainer');
  await page.locator('text=Get started with Rungwise').first().waitFor({ timeout: 30_000 });
  await page.locator('.step-list-container .getting-started-step').nth(2).waitFor({ timeout: 15_000 });
  // The picture of the first step is a drawing of its own.
  await workbench.until('the picture', async () => (await page.locator('.getting-started-media svg, .getting-started-media iframe, .getting-started-media webview').count()) > 0);
  await workbench.page.waitForTimeout(1500);
  await workbench.screenshot('15-walkthrough');
  await workbench.page.keyboard.press('Control+F4');
}

async function explain(workbench) {
  await workbench.openFile('three_mistakes.lad');
  await workbench.goTo(7, 2);
  await workbench.chord('e');
  await workbench.page.waitForSelector('.tab.active[data-resource-name="short-circuit.md"]', { timeout: 15_000 });
  await workbench.until('the page in the preview', async () => {
    for (const frame of workbench.page.frames()) {
      if (/short/i.test(await frame.locator('body').innerText({ timeout: 500 }).catch(() => ''))) {
        return true;
      }
    }
    return false;
  }, 30_000);
  await workbench.screenshot('16-page-of-a-rule');
  await workbench.page.keyboard.press('Control+F4');
}

async function usage(workbench) {
  await workbench.openFile('conveyor_fx.il');
  await workbench.focusEditor();
  await workbench.chord('u');
  await workbench.page.waitForSelector('.tab[data-resource-name="conveyor_fx.il.usage"]', { timeout: 15_000 });
  const table = workbench.page.locator('.editor-instance[data-uri], .editor-instance').last().locator('.view-line');
  await workbench.until('the devices', async () => (await table.allInnerTexts()).some((line) => /\bT0\b/.test(line)));
  await workbench.screenshot('17-devices-in-use');
  await workbench.page.locator('.tab[data-resource-name="conveyor_fx.il.usage"]').click();
  await workbench.page.keyboard.press('Control+F4');
}

async function hints(workbench) {
  await workbench.openFile('conveyor_fx.il');
  await workbench.until('a lens', async () => (await workbench.page.locator('.editor-instance .codelens-decoration').count()) > 0);
  await workbench.until('the hint', async () => (await workbench.editorLines()).some((line) => /K50.*5\ss/.test(line)));
  await workbench.screenshot('18-lenses-and-hints');
}

async function fences(workbench) {
  await workbench.openFile('notes.md');
  await workbench.until('a squiggle', async () => (await workbench.errorSquiggles()) >= 1);
  await workbench.screenshot('19-fence');
}

async function icons(workbench) {
  const icon = () => workbench.page.locator('.explorer-folders-view .monaco-icon-label[aria-label*=".lad"]').first()
    .evaluate((node) => getComputedStyle(node, '::before').backgroundImage);
  for (const [theme, file] of [['Default Light Modern', 'ladder-light'], ['Default Dark Modern', 'ladder-dark']]) {
    await workbench.command('Preferences: Color Theme');
    await workbench.page.waitForSelector('.quick-input-widget:visible');
    await workbench.page.keyboard.type(theme.replace('Default ', ''));
    await workbench.page.waitForTimeout(400);
    await workbench.page.keyboard.press('Enter');
    await workbench.until(`the icon ${file}`, async () => (await icon()).includes(file));
    await workbench.screenshot(`20-${file}`);
  }
}

async function task(workbench) {
  await workbench.command('Tasks: Run Task');
  const choose = async (text) => {
    await workbench.page.locator('.quick-input-list .monaco-list-row', { hasText: text }).first().click({ timeout: 15_000 });
  };
  await choose('rungwise');
  await choose('rungwise: check');
  await workbench.page.keyboard.press('Control+Shift+M');
  // A file that was never opened in this page: only the task knows about it.
  await workbench.until('the finding of the task', async () =>
    (await workbench.problems()).some((row) => row.includes('short-circuit')), 20_000);
  await workbench.screenshot('21-task');
}
