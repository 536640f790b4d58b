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
  const message = workbench.page.locator('.test-message-inline-content', { hasText: 'Y0 is 1 where 0 was expected' });
  await message.first().waitFor({ timeout: 45_000 });
  await workbench.screenshot('35-scenario-failed');
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
  const covered = workbench.page.locator('.test-coverage-list .monaco-list-row', { hasText: 'tested.lad' });
  await covered.first().waitFor({ timeout: 45_000 });
  await workbench.until('no difference any more', async () => (await message.count()) === 0);
  await workbench.screenshot('36-scenario-coverage');
  await workbench.command('Explorer: Focus on Folders View');
  await workbench.command('Test: Close Coverage');
  await workbench.command('File: Revert File');
  await workbench.openFile('tested.lad');
  await workbench.until('lenses of the program', async () =>
    (await lens(workbench, 'Simulate').count()) === 1 && (await lens(workbench, 'Run scenarios').count()) === 1);
  await workbench.clear();
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
