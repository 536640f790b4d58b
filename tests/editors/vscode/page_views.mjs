// What the extension shows beside the program and draws into it: lenses, hints, pages, the walkthrough.

export const VIEW_TESTS = {
  'lenses and hints are drawn into the program': lensesAndHints,
  'a drawing in a fence of a Markdown file has its errors': fences,
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
  await workbench.openFile('conveyor_fx.il');
  await untilLens(workbench, /4 steps.*Y0: 2 references/);
  await untilLens(workbench, /next free: /);
  await workbench.until('the hint', async () => (await workbench.editorLines()).some((line) => /K50.*5\ss/.test(line)));
  await workbench.screenshot('18-lenses-and-hints');
}

async function fences(workbench) {
  await workbench.openFile('notes.md');
  await workbench.until('a squiggle', async () => (await workbench.errorSquiggles()) >= 1);
  await workbench.screenshot('19-fence');
}

async function explain(workbench) {
  await workbench.openFile('three_mistakes.lad');
  await workbench.goTo(7, 3);
  await workbench.until('the squiggle', async () => (await workbench.errorSquiggles()) >= 3);
  // The hover at the cursor has the code as a link; a person points and clicks.
  await workbench.page.keyboard.press('Control+k');
  await workbench.page.keyboard.press('Control+i');
  const link = workbench.page.locator('.monaco-hover:visible a', { hasText: 'short-circuit' }).first();
  await link.waitFor({ timeout: 15_000 });
  await workbench.screenshot('15-link-of-an-error');
  await link.click();
  const page = workbench.page.locator('.tab[data-resource-name="short-circuit.md"]').first();
  await page.waitFor({ timeout: 15_000 });
  await workbench.until('the page in the preview', async () => {
    for (const frame of workbench.page.frames().slice(1)) {
      if (/A branch made only of wire/.test(await frame.locator('body').innerText({ timeout: 500 }).catch(() => ''))) {
        return true;
      }
    }
    return false;
  }, 30_000);
  await workbench.screenshot('16-page-of-a-rule');
  await page.click({ button: 'middle' });
  await page.waitFor({ state: 'detached', timeout: 15_000 });
}

async function walkthrough(workbench) {
  await workbench.openFile('conveyor_fx.il');
  await workbench.focusEditor();
  await workbench.command('Rungwise: Get Started');
  const page = workbench.page.locator('.gettingStartedContainer');
  await page.locator('text=Get started with Rungwise').first().waitFor({ timeout: 30_000 });
  await workbench.until('all steps', async () => {
    const text = await page.innerText();
    return ['Open the example', 'Make a mistake', 'Edit the drawing', 'Check the program', 'Choose your PLC'].every((step) => text.includes(step));
  });
  await workbench.page.waitForTimeout(800); // The picture is drawn in a page of its own.
  await workbench.screenshot('20-walkthrough');
}
