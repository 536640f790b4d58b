// A PLC on a line, which here is a virtual one: compared, downloaded, watched in the text, driven, stopped.

import { spawn } from 'node:child_process';
import { createInterface } from 'node:readline';
import { fileURLToPath } from 'node:url';
import { panelPage } from './page_panel.mjs';

/** The files of these checks, and the fixtures of which they are copies. */
export const PLC_FILES = { 'downloaded.lad': 'motor.lad', 'plant/rungwise.toml': 'alarm.toml', 'plant/table.lad': 'motor.lad' };

export const PLC_TESTS = {
  'a program is downloaded to a PLC after a look at what changes, and its power is shown in the text': download,
  'a table of devices shows, writes and holds what is in a PLC, and an alarm is told': table,
};

/** A virtual PLC, with an empty memory if nothing else is said, and where it listens. */
export async function virtualPlc(...more) {
  const plc = spawn(process.env.RUNGWISE_SERVER, ['plc', '--listen', '127.0.0.1:0', ...more], { stdio: ['pipe', 'pipe', 'inherit'] });
  const lines = createInterface({ input: plc.stdout });
  const next = () => new Promise((resolve) => lines.once('line', resolve));
  const port = (await next()).trim().split(' ').at(-1);
  /** What somebody in front of it reads of a device. */
  const shown = (device) => {
    const answer = next();
    plc.stdin.write(`${device}\n`);
    return answer;
  };
  return { plc, port, shown };
}

export async function connect(workbench, port) {
  await ask(workbench, 'Rungwise: PLC: Connect', 'Port of the PLC');
  const other = workbench.page.locator('.quick-input-list .monaco-list-row', { hasText: 'Another port' }).first();
  await other.click();
  // The list goes, and a box comes that proposes a port.
  const proposed = () => workbench.page.locator('.quick-input-widget:visible input').first().inputValue({ timeout: 1_000 });
  await workbench.until('the box for a port', () => proposed().then((value) => value.startsWith('tcp:'), () => false));
  await answer(workbench, port);
}

/** Whether a coil of the text is painted as energised. */
async function hasPower(workbench) {
  const bold = await workbench.page.locator('.editor-instance .view-lines span').evaluateAll((spans) =>
    spans
      .filter((span) => span.children.length === 0 && Number(getComputedStyle(span).fontWeight) >= 700)
      .map((span) => span.textContent.replaceAll('\u00a0', ' ')));
  return bold.some((text) => text.includes('( )'));
}

/** Runs a command that asks something, and waits until it does. */
async function ask(workbench, command, title) {
  await workbench.page.keyboard.press('F1');
  await workbench.page.waitForSelector('.quick-input-widget:visible', { timeout: 45_000 });
  await workbench.page.keyboard.type(command);
  await workbench.page.locator('.quick-input-list .monaco-list-row', { hasText: command }).first().waitFor({ timeout: 45_000 });
  await workbench.page.keyboard.press('Enter');
  await workbench.page.locator('.quick-input-title', { hasText: title }).first().waitFor({ timeout: 45_000 });
}

/** Answers the box at the top of the window. */
async function answer(workbench, text) {
  const box = workbench.page.locator('.quick-input-widget input').first();
  await box.fill(text);
  await box.press('Enter');
  await workbench.page.waitForSelector('.quick-input-widget', { state: 'hidden', timeout: 45_000 });
}

async function download(workbench) {
  const { plc, port } = await virtualPlc();
  try {
    await workbench.clear();
    await workbench.openFile('downloaded.lad');
    await connect(workbench, port);
    await workbench.status('FX2N RUN');
    await workbench.command('Rungwise: PLC: Download');
    const start = workbench.page.locator('.monaco-dialog-box .monaco-button', { hasText: 'Download and Start' }).first();
    await start.waitFor({ timeout: 45_000 });
    await workbench.screenshot('50-plc-difference');
    await start.click();
    await workbench.page.locator('.notifications-toasts', { hasText: 'read back and compared; the PLC is in RUN' }).first().waitFor({ timeout: 45_000 });
    await workbench.openFile('downloaded.lad');
    await workbench.command('Rungwise: PLC: Monitor the Program');
    await workbench.status('PLC, look ');
    if (await hasPower(workbench)) {
      throw new Error('a coil has power');
    }
    await ask(workbench, 'Rungwise: PLC: Write a Device', 'Write into the PLC');
    await answer(workbench, 'X0=1');
    await workbench.until('the motor on', () => hasPower(workbench));
    // The status bar leads to the view, which tells the same in full.
    await workbench.page.locator('.statusbar-item', { hasText: 'FX2N RUN' }).first().click();
    await workbench.page.locator('.pane-body .monaco-list-row', { hasText: 'as in the editor' }).first().waitFor({ timeout: 45_000 });
    await workbench.screenshot('51-plc-monitor');
    await workbench.command('Rungwise: PLC: Stop');
    await workbench.status('FX2N STOP');
    await workbench.until('the motor off', async () => !(await hasPower(workbench)));
    await workbench.command('Rungwise: PLC: Disconnect');
    await workbench.screenshot('52-plc-disconnected');
    await workbench.clear();
  } finally {
    plc.kill();
  }
}

async function table(workbench) {
  const motor = fileURLToPath(new URL('../fixtures/motor.lad', import.meta.url));
  const { plc, port, shown } = await virtualPlc('--program', motor);
  try {
    await workbench.clear();
    await workbench.openFile('table.lad');
    await connect(workbench, port);
    await workbench.status('FX2N RUN');
    await workbench.command('Rungwise: PLC: Device Table');
    const panel = await panelPage(workbench);
    const row = (name) => panel.locator(`[data-name="${name}"]`);
    const isOn = async (name) => (await row(name).getAttribute('data-on')) === 'true';
    await row('X0').waitFor();
    // Who has not agreed that the panel may write is asked, once.
    await row('X0').locator('.switch').click();
    await workbench.page.locator('.monaco-dialog-box .monaco-button', { hasText: 'Operate' }).first().click();
    await workbench.until('the motor', () => isOn('Y0'));
    // A register that the program does not use, by keys: shown as a floating point number, written, held.
    await panel.locator('[aria-label^="Add devices"]').fill('D100');
    await panel.locator('[aria-label^="Add devices"]').press('Enter');
    await row('D100').waitFor();
    await row('D100').locator('.chart').focus();
    for (let count = 0; count < 4; count += 1) {
      await workbench.page.keyboard.press('v');
    }
    await row('D100').locator('.number').fill('1.5');
    await row('D100').locator('.number').press('Enter');
    await workbench.until('1.5 in the PLC', async () => (await shown('D101')) === 'D101 = 16320');
    await row('D100').locator('.chart').focus();
    await workbench.page.keyboard.press('v');
    await row('D100').locator('.number').fill('120');
    await row('D100').locator('.number').press('Enter');
    await workbench.until('the number', async () => (await shown('D100')) === 'D100 = 120');
    // The alarm of the project: a message, and a row with its time in the view.
    await workbench.page.locator('.notifications-toasts', { hasText: 'The tank is too full' }).first().waitFor({ timeout: 45_000 });
    await row('D100').locator('.chart').focus();
    await workbench.page.keyboard.press('f');
    await workbench.until('the mark of what is held', async () => (await row('D100').getAttribute('data-forced')) === 'true');
    plc.stdin.write('D100=3\n');
    await workbench.until('what is held, written again', async () => (await shown('D100')) === 'D100 = 120');
    await workbench.page.locator('.statusbar-item', { hasText: 'FX2N RUN' }).first().click();
    await workbench.page.locator('.pane-body .monaco-list-row', { hasText: 'since' }).first().waitFor({ timeout: 45_000 });
    await workbench.screenshot('53-plc-table');
    await row('D100').locator('.chart').focus();
    await workbench.page.keyboard.press('r');
    await workbench.until('no mark', async () => (await row('D100').getAttribute('data-forced')) === null);
    await row('D100').locator('.number').fill('7');
    await row('D100').locator('.number').press('Enter');
    await workbench.until('the other number', async () => (await shown('D100')) === 'D100 = 7');
    await workbench.page.locator('.pane-body .monaco-list-row', { hasText: ' – ' }).first().waitFor({ timeout: 45_000 });
    await workbench.command('Rungwise: PLC: Disconnect');
    await workbench.until('a panel that says so', async () => (await panel.locator('.mode').innerText()) === 'Stopped');
    await workbench.clear();
  } finally {
    plc.kill();
  }
}
