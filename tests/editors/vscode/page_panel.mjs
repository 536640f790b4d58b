// The I/O panel of a program that is simulated: operated with mouse and keys, looked back with, and saved.

import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';

/** The files of these checks, and the fixtures of which they are copies. */
export const PANEL_FILES = { 'operated.lad': 'motor.lad', 'restarted.lad': 'motor.lad', 'mixer.il': 'mixer_iec.il' };

export const PANEL_TESTS = {
  'a click on the panel starts the motor, which holds itself, and one goes back past the click': operated,
  'a panel is operated by keys, and its chart is looked at and saved': byKeys,
  'a panel tells that the simulation is stopped, and starts it': restarted,
  'a panel of an IEC 61131-3 program has its variables, and the text shows what is forced': declared,
};

/** The page of the panel. */
export async function panelPage(workbench) {
  return workbench.until('the panel', async () => {
    for (const frame of workbench.page.frames().slice(1)) {
      if ((await frame.locator('.toolbar .mode').count().catch(() => 0)) > 0) {
        return frame;
      }
    }
    return undefined;
  });
}

/** Opens a file, starts its simulation, and gives the page of its panel. */
export async function openPanel(workbench, file, first = 'X0') {
  await workbench.clear();
  await workbench.openFile(file);
  await workbench.goTo(2, 6);
  await workbench.command('Rungwise: Start Simulation');
  await workbench.status('scan ');
  await workbench.command('Rungwise: I/O Panel');
  const panel = await panelPage(workbench);
  await panel.locator(`[data-name$="${first}"]`).waitFor();
  return panel;
}

/** Whether the lamp of a row is on. */
export const isOn = async (panel, name) => (await panel.locator(`[data-name="${name}"]`).getAttribute('data-on')) === 'true';

/** The pieces of the editor's text that are bold: what is energised. */
async function energised(workbench) {
  return workbench.page.locator('.editor-instance .view-lines span').evaluateAll((spans) =>
    spans
      .filter((span) => span.children.length === 0 && Number(getComputedStyle(span).fontWeight) >= 700)
      .map((span) => span.textContent.replaceAll('\u00a0', ' ')));
}

/** The names in the editor's text behind which stands the letter F of what is forced, which a span of its own has. */
async function forcedNames(workbench) {
  return workbench.page.locator('.editor-instance .view-lines').first().evaluate((lines) =>
    [...lines.querySelectorAll('span')]
      .filter((span) => /^"F"/.test(getComputedStyle(span, '::after').content))
      .map((span) => {
        const before = span.textContent === '' ? span.previousElementSibling?.textContent ?? '' : span.textContent;
        return before.replaceAll('\u00a0', ' ').trim().split(' ').pop();
      }));
}

const hasCoil = async (workbench) => (await energised(workbench)).some((text) => text.includes('( )'));

async function operated(workbench) {
  const panel = await openPanel(workbench, 'operated.lad');
  const names = await panel.locator('.row').evaluateAll((rows) => rows.map((row) => row.dataset.name));
  if (names.join(' ') !== 'X0 X1 Y0 Y1 T0') {
    throw new Error(`on the panel are ${names}`);
  }
  if (await hasCoil(workbench)) {
    throw new Error('a coil has power before the click');
  }
  await panel.locator('[data-name="X0"] .push').click();
  await workbench.until('the motor, held by itself', async () => (await isOn(panel, 'Y0')) && !(await isOn(panel, 'X0')));
  await workbench.until('the rung painted', () => hasCoil(workbench));
  await workbench.until('the lamp a second later', () => isOn(panel, 'Y1'));
  const timer = panel.locator('[data-name="T0"]');
  if ((await timer.locator('.value').innerText()) !== '1.0 s / 1.0 s' || (await timer.locator('.bar').getAttribute('aria-valuenow')) !== '100') {
    throw new Error(await timer.innerHTML());
  }
  await workbench.screenshot('40-panel');
  // To before the last change of Y0, which is that of the click.
  await panel.locator('[data-name="Y0"] [aria-haspopup="menu"]').click();
  await panel.locator('.menu button', { hasText: 'before its last change' }).click();
  await workbench.until('the motor off, in a pause', async () =>
    !(await isOn(panel, 'Y0')) && (await panel.locator('.mode').getAttribute('data-mode')) === 'paused');
  await workbench.until('the rung without power', async () => !(await hasCoil(workbench)));
  // The same moment again, with nobody at the button: the motor stays off.
  await panel.locator('[aria-label="Step (S)"]').click();
  await panel.locator('[aria-label="Step (S)"]').click();
  if (await isOn(panel, 'Y0')) {
    throw new Error('the click is still there');
  }
  // A switch that stands on is seen by the next scan.
  await panel.locator('[data-name="X0"] .switch').click();
  await panel.locator('[data-name="X0"] .switch[aria-checked="true"]').waitFor();
  if (await isOn(panel, 'X0')) {
    throw new Error('the program has seen the input without a scan');
  }
  await panel.locator('[aria-label="Step (S)"]').click();
  await workbench.until('the motor', async () => (await isOn(panel, 'X0')) && (await isOn(panel, 'Y0')));
  await workbench.command('Rungwise: Stop Simulation');
  await workbench.clear();
}

async function byKeys(workbench, workspace) {
  const panel = await openPanel(workbench, 'operated.lad');
  const keyboard = workbench.page.keyboard;
  // A push button is held by the space bar.
  await panel.locator('[data-name="X0"] .push').focus();
  await keyboard.down(' ');
  await workbench.until('the input on', () => isOn(panel, 'X0'));
  await keyboard.up(' ');
  await workbench.until('the input off, the motor on', async () => !(await isOn(panel, 'X0')) && (await isOn(panel, 'Y0')));
  // Down to the row below, whose input is forced, first at its value, then at the other one.
  await keyboard.press('ArrowDown');
  await keyboard.press('f');
  await panel.locator('[data-name="X1"][data-forced]').waitFor();
  await keyboard.press('f');
  await workbench.until('the motor stopped', async () => (await isOn(panel, 'X1')) && !(await isOn(panel, 'Y0')));
  await workbench.until('the forced contact marked in the text', async () => (await forcedNames(workbench)).includes('X1'));
  await workbench.screenshot('41-panel-forced');
  await keyboard.press('r');
  await panel.locator('[data-name="X1"]:not([data-forced])').waitFor();
  await workbench.until('no mark in the text', async () => (await forcedNames(workbench)).length === 0);
  await keyboard.press('g');
  await panel.locator('.mode[data-mode="paused"]').waitFor();
  // The chart says what is at its cursor; P goes to the change before.
  const chart = panel.locator('canvas');
  await chart.focus();
  await keyboard.press('0');
  const told = panel.locator('.told');
  for (const [key, wanted] of [['p', /X1 1, Y0 0/], ['p', /X0 0, X1 0, Y0 1/]]) {
    await workbench.until(`what is told after ${key}`, async () => {
      await keyboard.press(key);
      return wanted.test(await told.innerText());
    });
  }
  await workbench.screenshot('42-chart');
  await save(workbench, panel, 'What is seen, as SVG', join(workspace, 'operated.svg'), (text) =>
    /^<\?xml/.test(text) && /<\/svg>\s*$/.test(text) && text.includes('>Y0<') && !/NaN|undefined/.test(text));
  await save(workbench, panel, 'All changes, as VCD', join(workspace, 'operated.vcd'), (text) =>
    text.includes('$timescale 1 ns $end') && / Y0 \$end/.test(text) && /^#\d+\n/m.test(text));
  await save(workbench, panel, 'What is seen, as PNG', join(workspace, 'operated.png'), (text) => text.startsWith('\ufffdPNG'));
  await workbench.command('Rungwise: Stop Simulation');
  await workbench.clear();
}

/** Saves the chart under the name that is proposed, and looks at the file. */
export async function save(workbench, panel, label, file, isRight) {
  await panel.locator('.tools .text').click();
  await panel.locator('.menu button', { hasText: label }).click();
  await workbench.page.waitForSelector('.quick-input-widget:visible', { timeout: 45_000 });
  await workbench.page.locator('.quick-input-widget .quick-input-action, .quick-input-widget .monaco-button', { hasText: /Save|OK/ }).first().click();
  await workbench.until(`the file ${file}`, () => existsSync(file) && isRight(readFileSync(file, 'utf8')));
}

async function restarted(workbench) {
  const panel = await openPanel(workbench, 'restarted.lad');
  await panel.locator('[aria-label="Stop"]').click();
  await panel.locator('.mode[data-mode="stopped"]').waitFor();
  await workbench.until('disabled controls', () => panel.locator('[data-name="X0"] .push').isDisabled());
  await workbench.screenshot('43-panel-stopped');
  await panel.locator('.run.primary').click();
  await panel.locator('.mode[data-mode="running"]').waitFor();
  await panel.locator('[data-name="X0"] .push').click();
  await workbench.until('the motor', () => isOn(panel, 'Y0'));
  await workbench.command('Rungwise: Stop Simulation');
  await panel.locator('.mode[data-mode="stopped"]').waitFor();
  await workbench.clear();
}

async function declared(workbench) {
  const panel = await openPanel(workbench, 'mixer.il', 'Start');
  const row = (name) => panel.locator(`[data-name="${name}"]`);
  const proposed = await panel.locator('.fields input[type="text"]').getAttribute('placeholder');
  if (proposed !== 'Add variables: Mixer.Delay.Q') {
    throw new Error(`a panel of variables proposes ${proposed}`);
  }
  const names = await panel.locator('.row').evaluateAll((rows) => rows.map((own) => own.dataset.name));
  if (names.join(' ') !== 'Mixer.Start Mixer.Stop Mixer.Motor Mixer.Delay.ET') {
    throw new Error(`on the panel are ${names}`);
  }
  await row('Mixer.Start').locator('.push').click();
  await workbench.until('the mixer, held by itself', async () => (await isOn(panel, 'Mixer.Motor')) && !(await isOn(panel, 'Mixer.Start')));
  await row('Mixer.Stop').locator('.switch').focus();
  await workbench.page.keyboard.press('f');
  await workbench.until('the forced input marked in the text', async () => (await forcedNames(workbench)).includes('Stop'));
  await workbench.screenshot('44-panel-iec');
  await workbench.page.keyboard.press('f');
  await workbench.until('the mixer stopped', async () => !(await isOn(panel, 'Mixer.Motor')));
  await workbench.command('Rungwise: Stop Simulation');
  await workbench.clear();
}
