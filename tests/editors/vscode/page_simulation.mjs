// A program runs beside its text: started from the palette, switched at the cursor, stopped, looked back into.

/** The files of these checks, and the fixtures of which they are copies. */
export const SIMULATION_FILES = { 'running.lad': 'motor.lad' };

export const SIMULATION_TESTS = {
  'a simulation paints power, holds a seal-in, and goes back past the click': simulation,
};

/** The pieces of the editor's text that are bold: what is energised. */
async function energised(workbench) {
  return workbench.page.locator('.editor-instance .view-lines span').evaluateAll((spans) =>
    spans
      .filter((span) => span.children.length === 0 && Number(getComputedStyle(span).fontWeight) >= 700)
      .map((span) => span.textContent.replaceAll('\u00a0', ' ')));
}

async function simulation(workbench) {
  await workbench.clear();
  await workbench.openFile('running.lad');
  await workbench.goTo(2, 6);
  await workbench.command('Rungwise: Start Simulation');
  await workbench.status('scan ');
  // Only the wires from the rail to the first contacts have power.
  await workbench.until('power at the rail', async () => (await energised(workbench)).join('').startsWith('---'));
  const coil = async () => (await energised(workbench)).some((text) => text.includes('( )'));
  if (await coil()) {
    throw new Error(`a coil has power: ${await energised(workbench)}`);
  }
  // The contact at the cursor is closed, and opened again: the motor holds itself.
  await workbench.chord('t');
  await workbench.until('the motor on', coil);
  await workbench.chord('t');
  await workbench.until('the motor held by itself', async () => {
    const parts = await energised(workbench);
    return parts.some((text) => text.includes('( )')) && parts.filter((text) => text.includes('| |')).length >= 1;
  });
  await workbench.until('the value of the timer', async () =>
    (await workbench.page.locator('.editor-instance .view-lines').first().evaluate((node) =>
      [...node.querySelectorAll('span')].some((span) => /T0 = 10/.test(getComputedStyle(span, '::after').content)))));
  await workbench.screenshot('33-simulation');
  // Back to before the start: no coil has power, and time stands still.
  await workbench.command('Rungwise: Pause or Continue Simulation');
  await workbench.page.waitForTimeout(200);
  await workbench.command('Rungwise: Step Back One Scan');
  await workbench.until('the motor still on a scan before', coil);
  await workbench.command('Rungwise: Reset Simulation');
  await workbench.until('the motor off', async () => !(await coil()));
  await workbench.screenshot('34-simulation-reset');
  await workbench.command('Rungwise: Stop Simulation');
  await workbench.until('a text without power', async () => (await energised(workbench)).length === 0);
  await workbench.clear();
}
