// The view "Devices": the tree follows the program, its uses lead to their places, and the filter finds devices.

/** The files of these checks, and the fixtures of which they are copies. */
export const DEVICE_FILES = { 'devices.il': 'conveyor_fx.il', 'devices_found.il': 'conveyor_fx.il' };

export const DEVICE_TESTS = {
  'the tree of devices leads to uses and follows the program': inExplorerAfterwards(tree),
  'the filter of devices finds names and says how many': inExplorerAfterwards(filter),
};

/** Other checks begin in the explorer. */
function inExplorerAfterwards(check) {
  return async (workbench) => {
    try {
      await check(workbench);
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
  await row(workbench, 'Y output relay').click();
  await untilRow(workbench, /^Y0.*read 2 ×, written 1 ×/);
  await row(workbench, /^Y0/).click();
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
