// The view "Devices": the tree follows the program, its uses lead to their places, and the filter finds devices.

import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

/** The files of these checks, and the fixtures of which they are copies. */
export const DEVICE_FILES = { 'devices.il': 'conveyor_fx.il', 'devices_found.il': 'conveyor_fx.il' };

export const DEVICE_TESTS = {
  'the tree of devices leads to uses and follows the program': inExplorerAfterwards(tree),
  'the tree of a project has the devices of all its files with their comments': inExplorerAfterwards(project),
  'the filter of devices finds names and says how many': inExplorerAfterwards(filter),
};

/** Other checks begin in the explorer. */
function inExplorerAfterwards(check) {
  return async (workbench, workspace) => {
    try {
      await check(workbench, workspace);
    } catch (error) {
      await workbench.screenshot(`failed-${check.name}`);
      throw error;
    } finally {
      await workbench.calm();
      await workbench.command('View: Show Explorer');
      await workbench.page.waitForSelector('.explorer-folders-view .monaco-list-row');
      await workbench.clear();
    }
  };
}

const row = (workbench, words) => workbench.page.locator('.tree-explorer-viewlet-tree-view .monaco-list-row', { hasText: words });

/** The rows of the tree from top to bottom. */
async function rows(workbench) {
  const found = await row(workbench, /./).evaluateAll((nodes) =>
    nodes.map((node) => [Number.parseFloat(node.style.top), node.querySelector('.monaco-icon-label')?.textContent ?? '']));
  return found.sort((a, b) => a[0] - b[0]).map(([, text]) => text.replaceAll('\u00a0', ' '));
}

const untilRow = (workbench, words) =>
  workbench.until(`the row ${words}`, async () => (await rows(workbench)).find((text) => words.test(text)));

async function begin(workbench, file) {
  await workbench.clear();
  await workbench.openFile(file);
  await workbench.command('Rungwise: Focus on Devices View');
  await untilRow(workbench, /^X input relay.*2 used · next free: X2/);
}

async function tree(workbench) {
  await begin(workbench, 'devices.il');
  await openRow(workbench, 'Y output relay', /^Y0.*read 2 ×, written 1 ×/);
  await openRow(workbench, /^Y0/, /^1 OR Y0/);
  await untilRow(workbench, /^1 OR Y0.*line 4 · rung 1/);
  await workbench.screenshot('24-tree-of-devices');
  await row(workbench, '1 OR Y0').click();
  await workbench.status('Ln 4, Col 8 (2 selected)');
  // The keyboard is in the program, and the tree follows what is typed.
  await workbench.page.keyboard.press('Control+End');
  await workbench.page.keyboard.type('\nLD M7\nOUT M2\nEND\n');
  await row(workbench, 'M auxiliary relay').click();
  await untilRow(workbench, /^M3–M6.*4 free/);
  const found = await rows(workbench);
  const [first, gap, last] = [/^M2\s*read/, /^M3–M6/, /^M7\s*read/].map((words) => found.findIndex((text) => words.test(text)));
  if (!(first >= 0 && gap === first + 1 && last === gap + 1)) {
    throw new Error(`free devices are not between those in use: ${found.join(', ')}`);
  }
  // What was open has stayed open.
  await untilRow(workbench, /^1 OR Y0/);
  await workbench.screenshot('25-free-devices');
}

async function project(workbench, workspace) {
  const folder = join(workspace, 'press');
  mkdirSync(folder);
  const write = (name, text) => writeFileSync(join(folder, name), text);
  write('rungwise.toml', 'target = "fx2n"\ncomments = "devices.csv"\nfiles = ["press.il", "lamp.il"]\n');
  write('devices.csv', 'X0;Start;green button\n');
  write('press.il', 'LD X0\nOUT Y0\n');
  write('lamp.il', 'LD Y0\n// 灯\nAND X0\nOUT Y3\nEND\n');
  await workbench.clear();
  await workbench.page.keyboard.press('Control+p');
  await workbench.page.waitForSelector('.quick-input-widget:visible');
  await workbench.page.keyboard.type('press/press.il');
  await workbench.page.locator('.quick-input-list .monaco-list-row', { hasText: 'press.il' }).first().waitFor();
  await workbench.page.keyboard.press('Enter');
  await workbench.page.waitForSelector('.tab.active[data-resource-name="press.il"]');
  await workbench.command('Rungwise: Focus on Devices View');
  await untilRow(workbench, /^Y output relay.*2 used/);
  await openRow(workbench, /^X input relay/, /^X0/);
  await untilRow(workbench, /^X0\s*Start · green button · read 2 ×/);
  await openRow(workbench, /^X0/, /^AND X0/);
  await untilRow(workbench, /^LD X0\s*press.il:1 · rung 1/);
  await workbench.screenshot('28-devices-of-a-project');
  // A file that is not open is opened at the place.
  await row(workbench, 'AND X0').click();
  await workbench.page.waitForSelector('.tab.active[data-resource-name="lamp.il"]');
  await workbench.status('Ln 3, Col 7 (2 selected)');
  await untilRow(workbench, /^AND X0\s*lamp.il:3/);
  write('devices.csv', 'X0;Start;blue button\n');
  await untilRow(workbench, /^X0\s*Start · blue button/);
}

/** Opens a row of the tree, if it is not open already. */
async function openRow(workbench, words, inside) {
  if (!(await rows(workbench)).some((text) => inside.test(text))) {
    await row(workbench, words).click();
  }
  await untilRow(workbench, inside);
}

async function filter(workbench) {
  await begin(workbench, 'devices_found.il');
  await workbench.page.locator('.part.sidebar .action-label[aria-label*="Filter Devices"]').first().click();
  await workbench.page.waitForSelector('.quick-input-widget:visible');
  await workbench.page.keyboard.type('x1');
  await workbench.until('the devices with x1 alone', async () => {
    const shown = await rows(workbench);
    return shown.length === 2 && /^X input relay/.test(shown[0]) && /^X1\s*read/.test(shown[1]);
  });
  await workbench.page.locator('.part.sidebar', { hasText: '"x1": 1 of 5 devices' }).first().waitFor();
  await workbench.screenshot('26-filtered-devices');
  await workbench.page.keyboard.press('Enter');
  await workbench.command('Rungwise: Clear Filter of Devices');
  await untilRow(workbench, /^Y output relay/);
  await workbench.clear();
  await workbench.page.locator('.pane-body .welcome-view:visible', { hasText: 'to see the devices that it uses' }).first().waitFor();
  await workbench.screenshot('27-no-program-no-devices');
}
