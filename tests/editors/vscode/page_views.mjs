// What the extension shows beside the program and draws into it: lenses, hints, devices in use, pages, the walkthrough.
//
// Each check has a file of its own, so that it finds the same whatever the checks before it have done.

/** The files of these checks, and the fixtures of which they are copies. */
export const VIEW_FILES = { 'lenses.il': 'conveyor_fx.il', 'in_use.il': 'conveyor_fx.il', 'explained.lad': 'three_mistakes.lad' };

export const VIEW_TESTS = {
  'lenses and hints are drawn into the program': lensesAndHints,
  'a drawing in a fence of a Markdown file has its errors': fences,
  'the devices in use stand beside the program and follow it': usage,
  'the code of an error opens the page of its rule': explain,
  'the walkthrough opens with its steps': walkthrough,
};

/** The lenses on the screen, one text for each line; VS Code joins them with no-break spaces. */
async function lensTexts(workbench) {
  const texts = await workbench.page.locator('.codelens-decoration').evaluateAll((nodes) => nodes.map((node) => node.textContent));
  return texts.map((text) => text.replaceAll('\u00a0', ' '));
}

/** Waits until one of the lenses on the screen has these words. */
function untilLens(workbench, words) {
  return workbench.until(`the lens ${words}`, async () => (await lensTexts(workbench)).some((text) => words.test(text)));
}

async function lensesAndHints(workbench) {
  await workbench.clear();
  await workbench.openFile('lenses.il');
  await untilLens(workbench, /4 steps.*Y0: 2 references/);
  await untilLens(workbench, /next free: /);
  await workbench.until('the hint', async () => (await workbench.editorLines()).some((line) => /K50.*5\ss/.test(line)));
  await workbench.screenshot('18-lenses-and-hints');
}

async function fences(workbench) {
  await workbench.clear();
  await workbench.openFile('notes.md');
  await workbench.until('a squiggle', async () => (await workbench.errorSquiggles()) >= 1);
  await workbench.screenshot('19-fence');
}

async function usage(workbench) {
  await workbench.clear();
  await workbench.openFile('in_use.il');
  await workbench.focusEditor();
  await workbench.chord('u');
  await workbench.page.waitForSelector('.tab[data-resource-name="in_use.il.usage"]', { timeout: 45_000 });
  const rows = async () => {
    const lines = await workbench.page.locator('.editor-instance').last().locator('.view-line').allInnerTexts();
    return lines.map((row) => row.replaceAll('\u00a0', ' '));
  };
  await workbench.until('the devices', async () => (await rows()).some((row) => /^T0\s+ro\b/.test(row)));
  await workbench.screenshot('17-devices-in-use');
  // The keyboard is still in the program.
  await workbench.page.keyboard.press('Control+End');
  await workbench.page.keyboard.type('LD M7');
  await workbench.until('the new device', async () => (await rows()).some((row) => /^M0\b.*r-/.test(row)));
  await workbench.clear();
}

async function explain(workbench) {
  await workbench.clear();
  await workbench.openFile('explained.lad');
  await workbench.until('the squiggles', async () => (await workbench.errorSquiggles()) >= 3);
  await workbench.goTo(7, 3);
  // The hover at the cursor has the code as a link; a person points and clicks.
  const link = await workbench.hoverAtCursor('short-circuit', 'a');
  await workbench.screenshot('15-link-of-an-error');
  await link.click();
  await workbench.page.locator('.tab[data-resource-name="short-circuit.md"]').first().waitFor({ timeout: 45_000 });
  const page = await workbench.until('the page in the preview', () => frameWith(workbench, /A branch made only of wire/), 45_000);
  await workbench.screenshot('16-page-of-a-rule');
  await wholeDrawings(workbench, page);
  await workbench.clear();
}

/** The page of a webview that has these words. */
async function frameWith(workbench, words) {
  for (const frame of workbench.page.frames().slice(1)) {
    if (words.test(await frame.locator('body').innerText({ timeout: 500 }).catch(() => ''))) {
      return frame;
    }
  }
  return undefined;
}

/** In a preview that is narrower than a drawing the rows are not folded. */
async function wholeDrawings(workbench, page) {
  const size = workbench.page.viewportSize();
  await workbench.page.setViewportSize({ ...size, width: 640 });
  const heights = () => page.locator('pre code').evaluateAll((blocks) => blocks.map((block) => {
    const rows = block.textContent.trimEnd().split('\n').length;
    return block.getBoundingClientRect().height / Number.parseFloat(getComputedStyle(block).lineHeight) - rows;
  }));
  try {
    await workbench.until('a preview that is narrower than its drawings', () =>
      page.locator('pre, pre *').evaluateAll((parts) => parts.some((part) => part.scrollWidth > part.clientWidth + 20)));
    await workbench.until('rows that are not folded', async () => (await heights()).every((more) => more < 1));
    await workbench.screenshot('22-page-in-a-narrow-preview');
  } finally {
    await workbench.page.setViewportSize(size);
  }
}

async function walkthrough(workbench) {
  await workbench.clear();
  await workbench.command('Rungwise: Get Started');
  const page = workbench.page.locator('.gettingStartedContainer');
  await page.locator('text=Get started with Rungwise').first().waitFor({ timeout: 45_000 });
  await workbench.until('all steps', async () => {
    const text = await page.innerText();
    const steps = ['Open the example', 'Make a mistake', 'Edit the drawing', 'Check the program', 'Choose your PLC'];
    return steps.every((step) => text.includes(step));
  });
  await workbench.page.waitForTimeout(800); // The picture is drawn in a page of its own.
  await workbench.screenshot('20-walkthrough');
  await workbench.clear();
}
