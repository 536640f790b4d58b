// What a person does with a PLC by clicking: comparing, uploading, starting, ending a download; and that nothing is
// said to a PLC by opening a folder.

import { mkdirSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:net';
import { join } from 'node:path';
import { connect, virtualPlc } from './page_plc.mjs';

const WAIT = { timeout: 45_000 };

export const LINE_TESTS = {
  'a program is compared with the PLC, what differs is marked, and what is in the PLC becomes a new document': compare,
  'a PLC is started only by whoever chooses that': start,
  'a download is ended by the button of its only notification, and the next one finishes the job': cancel,
  'nothing is said to the PLC of a project before a command asks for it': silence,
};

const MOTOR = 'LD X0\nOUT Y0\nLD X1\nOUT Y1\nEND\n';

/** The lines that are marked as not so in the PLC. */
function drifted(workbench) {
  return workbench.page.locator('.editor-instance .view-overlays .cdr').evaluateAll((marks) =>
    marks.filter((mark) => getComputedStyle(mark).borderLeftStyle === 'dotted').length);
}

async function told(workbench, text) {
  await workbench.page.locator('.notifications-toasts', { hasText: text }).first().waitFor(WAIT);
}

/** A button of the question that is asked. */
function button(workbench, label) {
  return workbench.page.locator('.monaco-dialog-box .monaco-button').filter({ hasText: new RegExp(`^${label}$`) }).first();
}

async function compare(workbench, workspace) {
  writeFileSync(join(workspace, 'compared.il'), MOTOR);
  const { plc, port } = await virtualPlc('--program', join(workspace, 'compared.il'));
  try {
    await workbench.clear();
    await workbench.openByName('compared.il');
    await connect(workbench, port);
    await workbench.status('FX2N RUN');
    await workbench.command('Rungwise: PLC: Compare with the Program');
    await told(workbench, 'The program in the PLC is the same.');
    await workbench.focusEditor();
    await workbench.page.keyboard.press('Control+End');
    await workbench.page.keyboard.type('// the end\n');
    await workbench.focusEditor();
    await workbench.page.keyboard.press('End');
    await workbench.page.keyboard.press('Backspace');
    await workbench.page.keyboard.type('7');
    await workbench.until('one line that is marked', async () => (await drifted(workbench)) === 1);
    await workbench.screenshot('54-plc-drift');
    await workbench.command('Rungwise: PLC: Compare with the Program');
    await workbench.page.locator('.tab', { hasText: 'PLC ↔ editor' }).first().waitFor(WAIT);
    const shown = async () => (await workbench.page.locator('.monaco-diff-editor .view-line').allInnerTexts()).join('\n').replaceAll('\u00a0', ' ');
    await workbench.until('both sides', async () => (await shown()).includes('LD X0') && (await shown()).includes('LD X7'));
    await workbench.screenshot('55-plc-compared');
    await workbench.command('Rungwise: PLC: Upload to a New Document');
    await workbench.page.locator('.tab.active', { hasText: 'Untitled' }).first().waitFor(WAIT);
    await workbench.until('the program of the PLC', async () => (await workbench.editorLines()).join('\n').startsWith('LD X0\nOUT Y0\nLD X1\nOUT Y1\nEND'));
    await workbench.command('Rungwise: PLC: Disconnect');
    await workbench.clear();
  } finally {
    plc.kill();
  }
}

async function start(workbench, workspace) {
  writeFileSync(join(workspace, 'started.il'), MOTOR);
  const { plc, port, shown } = await virtualPlc('--program', join(workspace, 'started.il'), '--switch', 'stop');
  try {
    await workbench.clear();
    await workbench.openByName('started.il');
    await connect(workbench, port);
    await workbench.status('FX2N STOP');
    const asked = async (command) => {
      await workbench.command(command);
      await workbench.page.locator('.monaco-dialog-box', { hasText: 'machine may move' }).first().waitFor(WAIT);
    };
    // Enter, in haste, moves nothing; neither does Escape.
    for (const key of ['Enter', 'Escape']) {
      for (const command of ['Rungwise: PLC: Start', 'Rungwise: PLC: Download']) {
        await asked(command);
        await workbench.page.keyboard.press(key);
        await workbench.page.locator('.monaco-dialog-box').first().waitFor({ state: 'hidden', ...WAIT });
        if (!(await shown('M8000')).endsWith('= 0')) {
          throw new Error(`${command}, ${key}: ${await shown('M8000')}`);
        }
      }
    }
    await asked('Rungwise: PLC: Start');
    await workbench.screenshot('56-plc-start');
    await button(workbench, 'Start').click();
    await workbench.status('FX2N RUN');
    await workbench.command('Rungwise: PLC: Disconnect');
    await workbench.clear();
  } finally {
    plc.kill();
  }
}

async function cancel(workbench, workspace) {
  const rungs = Array.from({ length: 300 }, (_, at) => `LD M${at}\nOUT M${at + 1}\n`).join('');
  writeFileSync(join(workspace, 'slow.il'), `${rungs}END\n`);
  // As slow as a real line, so that there is time.
  const { plc, port } = await virtualPlc('--baud', '9600');
  try {
    await workbench.clear();
    await workbench.openByName('slow.il');
    await connect(workbench, port);
    await workbench.status('FX2N RUN');
    await workbench.command('Rungwise: PLC: Download');
    await button(workbench, 'Download').click();
    const toasts = workbench.page.locator('.notifications-toasts .notification-list-item', { hasText: 'Downloading' });
    await toasts.filter({ hasText: /writing: \d+ of \d+ bytes, \d+ s left/ }).first().waitFor(WAIT);
    await workbench.screenshot('57-plc-progress');
    const others = await workbench.page.locator('.statusbar-item', { hasText: 'Line to the PLC' }).count();
    if ((await toasts.count()) !== 1 || others !== 0) {
      throw new Error(`${await toasts.count()} notifications, ${others} bars besides`);
    }
    await toasts.first().hover();
    await toasts.first().locator('.monaco-button', { hasText: 'Cancel' }).click();
    await told(workbench, 'written in part');
    await workbench.status('FX2N STOP');
    await workbench.screenshot('58-plc-cancelled');
    await workbench.openByName('slow.il');
    await workbench.command('Rungwise: PLC: Download');
    await button(workbench, 'Download and Start').click();
    await told(workbench, 'read back and compared; the PLC is in RUN');
    await workbench.command('Rungwise: PLC: Disconnect');
    await workbench.clear();
  } finally {
    plc.kill();
  }
}

/** Somebody who listens in the place of a PLC and counts who comes; `port` is as in rungwise.toml. */
export async function listener() {
  let count = 0;
  const server = createServer((socket) => {
    count += 1;
    socket.destroy();
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return { server, port: `tcp://127.0.0.1:${server.address().port}`, count: () => count };
}

/** A project that names its port. */
export function projectAt(workspace, port) {
  mkdirSync(join(workspace, 'line'), { recursive: true });
  writeFileSync(join(workspace, 'line', 'rungwise.toml'), `target = "fx2n"\nport = "${port}"\n`);
  writeFileSync(join(workspace, 'line', 'named.il'), MOTOR);
}

async function silence(workbench, workspace, code) {
  const { server, port, count } = await listener();
  try {
    projectAt(workspace, port);
    await workbench.clear();
    // The folder is opened anew, with a file of the project, which is edited and looked at.
    await workbench.load(`http://${code.authority}/?folder=${workspace}`);
    await workbench.openByName('named.il');
    await workbench.status('FX2N');
    await workbench.focusEditor();
    await workbench.page.keyboard.type('LD X9\n');
    await workbench.until('the mistake', async () => (await workbench.errorSquiggles()) >= 1);
    await workbench.command('Focus on PLC View');
    if (count() !== 0) {
      throw new Error(`${count()} connections, and nobody has asked for one`);
    }
    await workbench.focusEditor();
    await workbench.page.keyboard.press('F1');
    await workbench.page.keyboard.type('Rungwise: PLC: Connect');
    await workbench.page.locator('.quick-input-list .monaco-list-row.focused', { hasText: 'PLC: Connect' }).waitFor(WAIT);
    await workbench.page.keyboard.press('Enter');
    await workbench.page.locator('.quick-input-list .monaco-list-row', { hasText: 'rungwise.toml' }).first().click();
    await workbench.until('the connection that was asked for', () => count() > 0);
    await workbench.clear();
  } finally {
    server.close();
  }
}
