// Other forms of a rung: the page that follows the cursor, the menu of code actions, the equation in the hover.

/** The files of these checks, and the fixtures of which they are copies. */
export const TRANSLATION_FILES = { 'forms.lad': 'clamp.lad', 'rewritten.lad': 'clamp.lad', 'equation.lad': 'clamp.lad' };

export const TRANSLATION_TESTS = {
  'the forms of the rung at the cursor stand beside the program and follow it': forms,
  'a refactoring that is proved is chosen from the menu of code actions': refactoring,
  'pointing at an output shows its equation': equation,
};

/** The lines of the editor that was opened last. */
async function lastLines(workbench) {
  const lines = await workbench.page.locator('.editor-instance').last().locator('.view-line').allInnerTexts();
  return lines.map((line) => line.replaceAll('\u00a0', ' '));
}

async function forms(workbench) {
  await workbench.clear();
  await workbench.openFile('forms.lad');
  await workbench.goTo(2, 5);
  await workbench.chord('f');
  const shown = (words) => workbench.until(`${words} in the page`, async () => (await lastLines(workbench)).some((line) => line.includes(words)));
  await shown('Y0 = X0*([X1] + X2)');
  await shown('proved equal');
  await shown('ANB');
  await workbench.screenshot('29-forms-of-a-rung');
  // The keyboard is still in the program, and the page goes where the cursor goes.
  await workbench.page.keyboard.press('Control+End');
  await workbench.page.keyboard.press('ArrowUp');
  await workbench.page.keyboard.press('ArrowUp');
  await workbench.page.keyboard.press('ArrowUp');
  await shown('Y1 = [X0]');
  // A program that changes changes its forms.
  await workbench.goTo(8, 6);
  await workbench.page.keyboard.press('Delete');
  await workbench.page.keyboard.type('7');
  await shown('Y1 = [X7]');
  await workbench.clear();
}

async function refactoring(workbench) {
  await workbench.clear();
  await workbench.openFile('rewritten.lad');
  await workbench.goTo(2, 5);
  await workbench.until('the checked program', async () => (await workbench.page.locator('.codelens-decoration').count()) > 0);
  await workbench.page.keyboard.press('Control+.');
  const row = workbench.page.locator('.action-widget .monaco-list-row', { hasText: 'Move wide branch first (saves 1 step)' }).first();
  await row.waitFor({ timeout: 45_000 });
  await workbench.screenshot('30-code-actions');
  await row.click();
  await workbench.until('the wide branch first', async () =>
    (await workbench.documentLines()).some((line) => /^\|\s+X1\s+X0\s+Y0\s+\|$/.test(line)));
  await workbench.screenshot('31-wide-branch-first');
  await workbench.clear();
}

async function equation(workbench) {
  await workbench.clear();
  await workbench.openFile('equation.lad');
  await workbench.goTo(2, 45);
  await workbench.hoverAtCursor('Y0 = X0*([X1] + X2)');
  await workbench.screenshot('32-equation');
  await workbench.clear();
}
