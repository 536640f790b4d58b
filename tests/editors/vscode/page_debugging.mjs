// VS Code's own debugger on a drawing: F5 without a launch file, a data breakpoint, forward and back.

/** The files of these checks, and the fixtures of which they are copies. */
export const DEBUGGING_FILES = { 'debugged.lad': 'motor.lad' };

export const DEBUGGING_TESTS = {
  'F5 stops at the first rung, a change of an output is caught, and time goes back': debugging,
};

/** The number of the line at which the program stands. */
async function stoppedAt(workbench) {
  return workbench.page.locator('.editor-instance').first().evaluate((editor) => {
    const top = (node) => node.closest('[style*="top"]')?.getBoundingClientRect().top;
    const frame = editor.querySelector('.view-overlays .debug-top-stack-frame-line');
    const numbers = [...editor.querySelectorAll('.margin-view-overlays .line-numbers')];
    return frame === null ? undefined : Number(numbers.find((node) => top(node) === top(frame))?.textContent);
  });
}

const untilLine = (workbench, line) =>
  workbench.until(`line ${line} reached`, async () => (await stoppedAt(workbench)) === line);

const variable = (workbench, name) =>
  workbench.page.locator('.debug-variables .monaco-list-row', { hasText: name }).first();

async function debugging(workbench) {
  const { page } = workbench;
  await workbench.clear();
  await workbench.openFile('debugged.lad');
  await workbench.focusEditor();
  // The lens above the program does what F5 does.
  await page.locator('.codelens-decoration a', { hasText: /^Debug$/ }).first().click();
  await page.locator('.debug-toolbar').waitFor({ timeout: 90_000 });
  await page.keyboard.press('Shift+F5');
  await page.locator('.debug-toolbar').waitFor({ state: 'hidden' });
  await workbench.focusEditor();
  await page.keyboard.press('F5');
  await page.locator('.debug-toolbar').waitFor({ timeout: 90_000 });
  try {
    await untilLine(workbench, 2);
    await workbench.command('View: Show Run and Debug');
    // The outputs, and the breakpoint of one of them in the menu.
    await variable(workbench, 'Outputs').click();
    await variable(workbench, 'Y0').click({ button: 'right' });
    const entry = page.locator('.context-view .action-label', { hasText: 'Break on Value Change' }).first();
    await entry.waitFor();
    // A menu that has just opened takes the end of the click that opened it for none.
    await workbench.until('the entry chosen', async () => {
      await entry.click({ timeout: 1_000 }).catch(() => undefined);
      return !(await entry.isVisible());
    });
    await variable(workbench, 'Inputs').click();
    // The console switches the input on.
    await workbench.command('Debug Console: Focus on Debug Console View');
    await page.keyboard.type('set X0=1');
    await page.keyboard.press('Escape');
    await page.keyboard.press('Enter');
    await workbench.until('the input on', async () => /X0\s*=?\s*1/.test(await variable(workbench, 'X0').innerText()));
    await page.keyboard.press('F5');
    // Behind the rung that switched the output.
    await untilLine(workbench, 7);
    await workbench.until('the output on', async () => /Y0\s*=?\s*1/.test(await variable(workbench, 'Y0').innerText()));
    // The editor has the keyboard where the program stops.
    await workbench.command('Debug Console: Focus on Debug Console View');
    await page.keyboard.type('why Y0');
    await page.keyboard.press('Escape');
    await page.keyboard.press('Enter');
    await workbench.until('the reasons', async () =>
      /X0 is on: an input/.test((await page.locator('.monaco-list[aria-label="Debug Console"]').innerText()).replaceAll('\u00a0', ' ')));
    await workbench.screenshot('35-debugger');
    // Back to before the coil was driven, where it is off.
    await page.locator('.debug-toolbar .codicon-debug-step-back').click();
    await untilLine(workbench, 3);
    await workbench.until('the output off', async () => /Y0\s*=?\s*0/.test(await variable(workbench, 'Y0').innerText()));
    await workbench.screenshot('36-debugger-back');
  } catch (error) {
    await workbench.screenshot('failed-debugger');
    throw error;
  } finally {
    await workbench.calm();
    await page.keyboard.press('Shift+F5');
    await page.locator('.debug-toolbar').waitFor({ state: 'hidden' });
    await workbench.command('View: Show Explorer');
    await workbench.clear();
  }
}
