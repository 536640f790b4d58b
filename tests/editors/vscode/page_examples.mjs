// Every example of the FX family by clicking: downloaded, compared, driven beside the simulator, uploaded and proved equal.

import { spawnSync } from 'node:child_process';
import { cpSync, existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { panelPage } from './page_panel.mjs';
import { connect, virtualPlc } from './page_plc.mjs';

const WAIT = { timeout: 45_000 };

/**
 * What is done to each of them, one after the other, and what is looked at when it has come to rest. Two examples are
 * programs of IEC 61131-3, which no PLC of the family takes, and one has mistakes on purpose.
 */
const EXAMPLES = {
  'batch-counter': { model: 'fx1n', file: 'batch.il', deeds: ['X1=1', 'X0=1', 'X0=0', 'X0=1', 'X0=0'], outputs: ['Y0', 'Y1', 'C0', 'D0'] },
  conveyor: { model: 'fx2n', file: 'conveyor.il', deeds: ['X0=1', 'X1=1', 'X2=1', 'X3=1'], outputs: ['Y0', 'Y1', 'Y2', 'Y3', 'Y4'] },
  'getting-started': { model: 'fx2n', file: 'first-steps.lad', deeds: ['X0=1', 'X0=0', 'X1=1'], outputs: ['Y0', 'Y1'] },
  motor: { model: 'fx2n', file: 'motor.lad', deeds: ['X2=1', 'X3=1', 'X0=1', 'X0=0', 'X1=1', 'X2=0'], outputs: ['M0', 'Y0', 'Y1'] },
  'packing-line': { model: 'fx2n', file: 'main.il', deeds: ['X0=1', 'X0=0', 'X2=1', 'X3=1', 'X1=1'], outputs: ['M0', 'M1', 'M2', 'Y0', 'Y1'] },
  'tank-level': { model: 'fx2n', file: 'tank.lad', deeds: ['X0=1', 'D0=100', 'D0=500', 'D0=900'], outputs: ['M0', 'Y0', 'Y1', 'Y2', 'Y3'] },
  'traffic-lights': { model: 'fx1s', file: 'lights.lad', deeds: ['X0=1', 'X0=0'], outputs: ['Y0', 'Y1', 'Y2', 'Y3', 'Y4', 'Y5'] },
};

export const EXAMPLE_TESTS = Object.fromEntries(
  Object.keys(EXAMPLES).map((name) => [
    `the example ${name} goes into a PLC, does there what it does in the simulator, and comes back proved equal`,
    (workbench, workspace) => thereAndBack(workbench, workspace, name, EXAMPLES[name]),
  ]),
);

/** What the command line gives; anything but success is a failure. */
function rungwise(...words) {
  const { status, stdout, stderr } = spawnSync(process.env.RUNGWISE_SERVER, words, { encoding: 'utf8' });
  if (status !== 0) {
    throw new Error(`rungwise ${words.join(' ')}: ${status}\n${stdout}${stderr}`);
  }
  return stdout;
}

/** What a simulated PLC shows when it has come to rest after the first deeds, a second apart. */
function simulated(folder, deeds, outputs) {
  const sets = deeds.flatMap((deed, at) => ['--set', `${deed}@${at}s`]);
  const rows = JSON.parse(rungwise('run', folder, ...sets, '--time', `${deeds.length}s`, '--watch', outputs.join(','), '--format', 'json'));
  return rows.scans.at(-1).values;
}

function button(workbench, label) {
  return workbench.page.locator('.monaco-dialog-box .monaco-button').filter({ hasText: new RegExp(`^${label}$`) }).first();
}

async function told(workbench, text) {
  await workbench.page.locator('.notifications-toasts', { hasText: text }).first().waitFor(WAIT);
}

async function thereAndBack(workbench, workspace, name, { model, file, deeds, outputs }) {
  const folder = join(workspace, 'examples', name);
  cpSync(fileURLToPath(new URL(`../../../examples/${name}`, import.meta.url)), folder, { recursive: true });
  const { plc, port } = await virtualPlc('--model', model);
  try {
    await workbench.clear();
    await workbench.openByName(`examples/${name}/${file}`, file);
    await connect(workbench, port);
    await workbench.status(`${model.toUpperCase()} RUN`);
    await workbench.command('Rungwise: PLC: Download');
    await button(workbench, 'Download and Start').click();
    await told(workbench, 'read back and compared; the PLC is in RUN');
    await workbench.openByName(`examples/${name}/${file}`, file);
    await workbench.command('Rungwise: PLC: Compare with the Program');
    await told(workbench, 'The program in the PLC is the same.');
    await workbench.command('Rungwise: PLC: Monitor the Program');
    await workbench.status('PLC, look ');
    await drive(workbench, folder, deeds, outputs);
    await workbench.screenshot(`60-example-${name}`);
    await workbench.command('Rungwise: PLC: Upload to a New Document');
    const untitled = workbench.page.locator('.tab.active', { hasText: 'Untitled' }).first();
    await untitled.waitFor(WAIT);
    const uploaded = join(folder, 'uploaded.il');
    await save(workbench, uploaded);
    await workbench.command('Rungwise: PLC: Stop');
    await workbench.status(`${model.toUpperCase()} STOP`);
    await workbench.command('Rungwise: PLC: Disconnect');
    proved(folder, uploaded);
    await workbench.clear();
  } finally {
    plc.kill();
  }
}

/** Does it in the table of devices, and waits after each deed until the PLC shows what the simulator does. */
async function drive(workbench, folder, deeds, outputs) {
  await workbench.command('Rungwise: PLC: Device Table');
  const panel = await panelPage(workbench);
  const row = (device) => panel.locator(`[data-name="${device}"]`);
  for (const device of outputs) {
    if ((await row(device).count()) === 0) {
      const add = panel.locator('[aria-label^="Add devices"]');
      await add.fill(device);
      await add.press('Enter');
      await row(device).waitFor(WAIT);
    }
  }
  for (let done = 1; done <= deeds.length; done += 1) {
    const [device, value] = deeds[done - 1].split('=');
    if (device.startsWith('X')) {
      await row(device).locator('.switch').click();
      const operate = workbench.page.locator('.monaco-dialog-box .monaco-button', { hasText: 'Operate' }).first();
      if (done === 1 && (await operate.waitFor({ timeout: 2_000 }).then(() => true, () => false))) {
        await operate.click();
      }
      await workbench.until(`${device} as it was switched`, async () => (await row(device).getAttribute('data-on')) === String(value === '1'));
    } else {
      await row(device).locator('.number').fill(value);
      await row(device).locator('.number').press('Enter');
    }
    const expected = simulated(folder, deeds.slice(0, done), outputs);
    for (const output of outputs) {
      await workbench.until(`${output} = ${expected[output]} after ${deeds.slice(0, done)}`, async () => {
        const shown = row(output);
        // Only what is on the screen is read.
        await shown.scrollIntoViewIfNeeded();
        return typeof expected[output] === 'boolean'
          ? (await shown.getAttribute('data-on')) === String(expected[output])
          : (await shownNumber(shown)) === expected[output];
      });
    }
  }
}

/** The number that a row shows: that of a timer or counter stands before its preset. */
async function shownNumber(row) {
  const box = row.locator('.number');
  return Number.parseFloat((await box.count()) > 0 ? await box.inputValue() : (await row.innerText()).split('\n').at(-1));
}

/** Saves the document that is open under another name. */
async function save(workbench, path) {
  await workbench.page.keyboard.press('Control+Shift+S');
  const box = workbench.page.locator('.quick-input-widget:visible input').first();
  await workbench.until('a name that is proposed', async () => (await box.inputValue()).endsWith('.il'));
  await box.fill(path);
  await box.press('Enter');
  await workbench.until(path, () => existsSync(path) && readFileSync(path, 'utf8').includes('END'));
  await workbench.page.locator('.tab.active', { hasText: 'uploaded.il' }).first().waitFor(WAIT);
  await workbench.page.waitForSelector('.quick-input-widget', { state: 'hidden', ...WAIT });
}

/** The list from the PLC, drawn as a ladder, is proved equal to the example. */
function proved(folder, uploaded) {
  const drawn = join(folder, 'uploaded.lad');
  rungwise('translate', uploaded, '--to', 'ladder', '-o', drawn);
  rungwise('prove', folder, drawn);
}
