// Draws as a person does, in the page: edits by their keys, deletions, the menu.

export const DRAWING_TESTS = {
  'a contact, a branch and a coil are inserted by their keys and taken back': editsByKeys,
  'deleting cells keeps the columns, and is undone at once': deletion,
  'the context menu has the edits': contextMenu,
};

async function untilText(workbench, what, wanted) {
  let lines = [];
  try {
    await workbench.until(what, async () => {
      lines = (await workbench.documentLines());
      return JSON.stringify(lines) === JSON.stringify(wanted);
    }, 6_000);
  } catch (error) {
    throw new Error(`${error.message}\nwanted:\n${wanted.join('\n')}\nfound:\n${lines.join('\n')}`);
  }
}

async function editsByKeys(workbench) {
  await workbench.openFile('edited.lad');
  const before = await workbench.documentLines();
  await workbench.goTo(2, 15);
  await workbench.chord('b');
  await workbench.until('the branch', async () => (await workbench.documentLines())[2].includes('???'));
  await workbench.screenshot('13-inserted-branch');
  await workbench.page.keyboard.press('Control+z');
  await untilText(workbench, 'the branch to go', before);
  await workbench.chord('i');
  await workbench.until('the other contact', async () => (await workbench.documentLines())[1].startsWith('+---| |---+---| |---'));
  await workbench.page.keyboard.press('Control+z');
  await untilText(workbench, 'the contact to be as before', before);
}

async function deletion(workbench) {
  await workbench.openFile('edited.lad');
  const before = await workbench.documentLines();
  await workbench.goTo(1, 17);
  await workbench.page.keyboard.press('Backspace');
  const shorter = [...before];
  shorter[0] = before[0].replace('X1 ', 'X  ');
  await untilText(workbench, 'the name one character shorter, and all columns as before', shorter);
  await workbench.page.keyboard.press('Control+z');
  await untilText(workbench, 'the name again', before);
  await workbench.goTo(2, 28);
  await workbench.page.keyboard.press('Delete');
  await workbench.page.keyboard.press('Delete');
  await untilText(workbench, 'a wire without a gap', before);
}

async function contextMenu(workbench) {
  await workbench.openFile('edited.lad');
  await workbench.goTo(2, 15);
  await workbench.page.keyboard.press('Shift+F10');
  const entry = workbench.page.locator('.monaco-menu .action-label', { hasText: /^Rungwise$/ }).first();
  await entry.waitFor({ timeout: 10_000 });
  await entry.hover();
  await workbench.page.locator('.monaco-menu .action-label', { hasText: 'Insert Contact' }).first().waitFor({ timeout: 10_000 });
  await workbench.page.waitForTimeout(300);
  await workbench.screenshot('14-menu');
  await workbench.page.keyboard.press('Escape');
  await workbench.page.keyboard.press('Escape');
  await workbench.page.keyboard.press('Escape');
}
