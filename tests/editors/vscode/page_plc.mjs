// A PLC on a line, which here is a virtual one: compared, downloaded, watched in the text, driven, stopped.

import { spawn } from 'node:child_process';
import { createInterface } from 'node:readline';

/** The files of these checks, and the fixtures of which they are copies. */
export const PLC_FILES = { 'downloaded.lad': 'motor.lad' };

export const PLC_TESTS = {
  'a program is downloaded to a PLC after a look at what changes, and its power is shown in the text': download,
};

/** A virtual PLC with an empty memory, and where it listens. */
async function virtualPlc() {
  const plc = spawn(process.env.RUNGWISE_SERVER, ['plc', '--listen', '127.0.0.1:0'], { stdio: ['pipe', 'pipe', 'inherit'] });
  const lines = createInterface({ input: plc.stdout });
  const [line] = await new Promise((resolve) => lines.once('line', (...words) => resolve(words)));
  return { plc, port: line.trim().split(' ').at(-1) };
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
  await workbench.page.keyboard.press('Control+a');
  await workbench.page.keyboard.type(text);
  await workbench.page.keyboard.press('Enter');
  await workbench.page.waitForSelector('.quick-input-widget', { state: 'hidden', timeout: 45_000 });
}

async function download(workbench) {
  const { plc, port } = await virtualPlc();
  try {
    await workbench.clear();
    await workbench.openFile('downloaded.lad');
    await ask(workbench, 'Rungwise: PLC: Connect', 'Port of the PLC');
    const other = workbench.page.locator('.quick-input-list .monaco-list-row', { hasText: 'Another port' }).first();
    await other.click();
    await workbench.page.locator('.quick-input-widget input').first().waitFor({ timeout: 45_000 });
    await answer(workbench, port);
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
