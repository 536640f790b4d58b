// Scenario tests as a person runs them: a lens, the test view, the place of a difference, what is covered, a recording.

/** The files of these checks, and the fixtures of which they are copies. */
export const TESTING_FILES = { 'tested.lad': 'motor.lad', 'tested.test.toml': 'motor.test.toml' };

export const TESTING_TESTS = {
  'scenarios run from a lens, fail at their place, pass when mended, and show what they cover': scenarios,
  'what was done to a simulation is opened as a scenario test': recording,
};

const lens = (workbench, title) => workbench.page.locator('.codelens-decoration a', { hasText: title });

async function scenarios(workbench) {
  await workbench.clear();
  await workbench.openFile('tested.test.toml');
  await workbench.until('a lens above each scenario, and one for both', async () => (await lens(workbench, 'Run scenario').count()) === 3);
  await lens(workbench, 'Run scenarios').first().click();
  // The scenario that fails has a mark in the margin, and its message stands behind the line.
  const marks = () => workbench.page.locator('.editor-instance [class*="testing-failed"]').count();
  const isMarked = async () => (await marks()) > 0;
  await workbench.until('the difference at its place', isMarked);
  await workbench.screenshot('35-scenario-failed');
  await pictured(workbench);
  await workbench.command('Testing: Focus on Test Explorer View');
  const rows = workbench.page.locator('.test-explorer .monaco-list-row');
  await workbench.until('the file in the test view', async () => (await rows.allInnerTexts()).some((row) => row.includes('tested.test.toml')));
  await workbench.command('Explorer: Focus on Folders View');
  // What is typed is run, saved or not.
  await workbench.goTo(5, 55);
  await workbench.page.keyboard.press('Delete');
  await workbench.page.keyboard.type('1');
  await workbench.until('the mended text', async () => (await workbench.editorLines()).some((line) => line.includes('Y0 = 1')));
  await workbench.command('Test: Run All Tests with Coverage');
  // The explorer shows beside a program how much of it is covered.
  const files = workbench.page.locator('.explorer-folders-view .monaco-list-row');
  await workbench.until('what is covered of the program', async () =>
    (await files.allInnerTexts()).some((row) => row.includes('tested.lad') && row.includes('%')));
  await workbench.until('no difference any more', async () => !(await isMarked()));
  await gutters(workbench);
  await workbench.screenshot('36-scenario-coverage');
  await workbench.openFile('tested.test.toml');
  await workbench.command('File: Revert File');
  await workbench.openFile('tested.lad');
  await workbench.until('lenses of the program', async () =>
    (await lens(workbench, 'Simulate').count()) === 1 && (await lens(workbench, 'Run scenarios').count()) === 1);
  await workbench.clear();
}

/** The message of a scenario that failed shows what was, and what was expected, over time. */
async function pictured(workbench) {
  await workbench.openFile('tested.test.toml');
  await workbench.goTo(6, 1);
  await workbench.command('Test: Peek Output');
  const peek = workbench.page.locator('.test-output-peek-message-container');
  const text = await workbench.until('the message with its picture', async () => {
    const words = (await peek.allInnerTexts()).join('\n').replaceAll('\u00a0', ' ');
    return words.includes('expected') && words;
  });
  const lines = text.split('\n');
  const of = (name) => lines.find((line) => line.trim().startsWith(name) && /[_▆^]/.test(line)) ?? '';
  // The input, the output, what was expected of it and where they differ stand below each other.
  const columns = [of('X0').indexOf('▆'), of('Y0').indexOf('▆'), of('expected').indexOf('_'), of('^').indexOf('^')];
  if (!/Y0 is 1 where 0 was expected/.test(text) || columns[0] < 5 || columns.some((column) => column !== columns[0])) {
    throw new Error(`columns ${columns} of\n${text}`);
  }
  await workbench.screenshot('35-scenario-picture');
  await workbench.page.keyboard.press('Escape');
}

/** Beside the lines of the program stands what of them was covered: of the rung that starts only the start. */
async function gutters(workbench) {
  await workbench.openFile('tested.lad');
  const covered = workbench.page.locator('.editor-instance .coverage-deco-gutter');
  await workbench.until('marks beside the lines', async () => (await covered.count()) > 0);
  const kinds = await covered.evaluateAll((marks) => marks.map((mark) => mark.className));
  if (!kinds.some((kind) => kind.includes('coverage-deco-hit')) || !kinds.some((kind) => kind.includes('coverage-deco-miss'))) {
    throw new Error(`beside the lines stand ${kinds.join(' | ')}`);
  }
}

async function recording(workbench) {
  await workbench.clear();
  await workbench.openFile('tested.lad');
  await workbench.goTo(2, 6);
  await lens(workbench, 'Simulate').first().click();
  await workbench.status('scan ');
  await workbench.chord('t');
  await workbench.until('the motor on', async () => (await workbench.documentLines()).length > 0
    && (await workbench.page.locator('.statusbar-item', { hasText: 'scan ' }).count()) > 0);
  await workbench.command('Rungwise: Step Back One Scan');
  await workbench.command('Rungwise: Simulate One Scan');
  await workbench.chord('t');
  await workbench.command('Rungwise: Simulate One Scan');
  await workbench.command('Rungwise: Record Scenario');
  // The name of the file that is there already is not taken.
  await workbench.page.waitForSelector('.tab.active[data-resource-name="tested-2.test.toml"]', { timeout: 45_000 });
  await workbench.until('what was done', async () => (await workbench.editorLines()).some((line) => /set = \{ X0 = [01] \}/.test(line)));
  await workbench.screenshot('37-recorded');
  await workbench.command('File: Revert File');
  await workbench.openFile('tested.lad');
  await workbench.command('Rungwise: Stop Simulation');
  await workbench.clear();
}
