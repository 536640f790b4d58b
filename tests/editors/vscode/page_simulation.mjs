// A program runs beside its text: started from the palette, switched at the cursor, stopped, looked back into.

import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

/** The files of these checks, and the fixtures of which they are copies. */
export const SIMULATION_FILES = { 'running.lad': 'motor.lad' };

export const SIMULATION_TESTS = {
  'a simulation paints power, holds a seal-in, and goes back past the click': simulation,
  'a program in two files is one simulation, painted side by side and stopped from either': sideBySide,
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

/** A program in two files, side by side: what is done in the one is seen in the other, and it is stopped from either. */
async function sideBySide(workbench, workspace) {
  const folder = join(workspace, 'side-by-side');
  mkdirSync(folder, { recursive: true });
  writeFileSync(join(folder, 'rungwise.toml'), 'target = "fx2n"\nfiles = ["calling.il", "called.lad"]\n');
  writeFileSync(join(folder, 'calling.il'), 'LD X0\nCALL P1\nFEND\n');
  writeFileSync(join(folder, 'called.lad'), 'P1:\n|   X1       Y0 |\n+---| |-----( )-+\n\n+--[SRET]-------+\n\n+--[END]--------+\n');
  const has = async (words) => (await energised(workbench)).join('\n').includes(words);
  await workbench.clear();
  await workbench.openByName('calling.il');
  await workbench.page.locator('.tab.active[data-resource-name="calling.il"]').waitFor({ timeout: 45_000 });
  await workbench.status('steps');
  await workbench.goTo(1, 4);
  await workbench.command('Rungwise: Start Simulation');
  await workbench.status('scan ');
  await workbench.command('Rungwise: Toggle Device at Cursor');
  await workbench.until('the call', () => has('CALL'));
  // A file that is opened beside it belongs to it, as do the keys there.
  await workbench.page.keyboard.press('Control+\\');
  await workbench.until('two groups', async () => (await workbench.page.locator('.editor-group-container').count()) === 2);
  await workbench.openByName('called.lad');
  await workbench.page.locator('.tab.active[data-resource-name="called.lad"]').waitFor({ timeout: 45_000 });
  await workbench.goTo(2, 6);
  await workbench.until('power at the rail of the other file', () => has('---'));
  await workbench.command('Rungwise: Toggle Device at Cursor');
  await workbench.until('the coil, beside the call', async () => (await has('( )')) && (await has('CALL')));
  await workbench.screenshot('35-simulation-side-by-side');
  await workbench.command('Rungwise: Stop Simulation');
  await workbench.until('no power in either', async () => (await energised(workbench)).length === 0);
  await workbench.clear();
}
