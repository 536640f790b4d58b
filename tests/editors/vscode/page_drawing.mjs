// Draws as a person does, in the page: a whole program from nothing, edits by their keys, deletions, the menu.

const SEAL_IN = [
  '|   X10       X11     X2   X3              Y10 |',
  '+---| |---+---|/|-----| |--| |-------------( )-+',
  '|   Y10   |                                    |',
  '+---| |---+                                    |',
];
const TIMER = [
  '|   Y10                                  T1 K30|',
  '+---| |------------------------------------( )-+',
  '',
  '|   T1                                     Y11 |',
  '+---| |---+--------------------------------( )-+',
  '|   X5    |                                    |',
  '+---| |---+                                    |',
];
const END = '+--[END]---------------------------------------+';

export const DRAWING_TESTS = {
  'a program is typed from nothing: snippets, names longer than their places, contacts in a wire, Enter for a branch': wholeProgram,
  'a contact, a branch and a coil are inserted by their keys and taken back': editsByKeys,
  'deleting cells keeps the columns, and is undone at once': deletion,
  'the context menu has the edits': contextMenu,
};

/** Types a snippet's word and takes it from the list, then its names in bursts, each left by Tab. */
async function snippet(workbench, word, names) {
  const { keyboard } = workbench.page;
  await keyboard.type(word, { delay: 40 });
  // The list opens by itself once the editor is ready; a person who sees none asks for it.
  await workbench.page.waitForTimeout(600);
  if ((await workbench.page.locator('.suggest-widget.visible').count()) === 0) {
    await keyboard.press('Control+Space');
  }
  await workbench.until(`the snippet ${word}`, async () => {
    const rows = await workbench.page.locator('.suggest-widget.visible .monaco-list-row.focused').allInnerTexts();
    return rows.some((row) => row.trim().split(/\s/)[0] === word);
  });
  await keyboard.press('Tab');
  for (const name of names) {
    await keyboard.type(name);
    await keyboard.press('Tab');
  }
}

async function untilText(workbench, what, wanted) {
  let lines = [];
  try {
    await workbench.until(what, async () => {
      lines = (await workbench.documentLines());
      return JSON.stringify(lines) === JSON.stringify(wanted);
    }, 45_000);
  } catch (error) {
    throw new Error(`${error.message}\nwanted:\n${wanted.join('\n')}\nfound:\n${lines.join('\n')}`);
  }
}

/** No diagnostic of any weight, and none afterwards. */
async function untilClean(workbench) {
  const marks = () => workbench.page.locator('.editor-instance [class*="squiggly"]').count();
  await workbench.until('no problems', async () => (await marks()) === 0);
  await workbench.page.waitForTimeout(400);
  if ((await marks()) > 0) {
    throw new Error(`problems: ${await workbench.problems()}`);
  }
}

async function wholeProgram(workbench) {
  const { keyboard } = workbench.page;
  await workbench.openFile('typed.lad');
  await workbench.focusEditor();
  await snippet(workbench, 'seal', ['X10', 'X11', 'Y10']);
  // All is answered when the rails stand below each other.
  await workbench.until('the rung', async () => new Set((await workbench.documentLines()).slice(0, 4).map((row) => row.length)).size === 1);
  await workbench.screenshot('11-typed-seal-in');
  await keyboard.press('Enter');
  await snippet(workbench, 'timer', ['Y10', 'T1', 'K30', 'Y11']);
  await keyboard.press('Enter');
  await snippet(workbench, 'end', []);
  // By the keys of the edit, then by hand: what is typed takes the place of wire and blanks.
  await workbench.goTo(2, 19);
  await workbench.chord('c');
  await workbench.until('the name to type over', async () => (await workbench.documentLines())[0].includes('???'));
  await keyboard.type('X2');
  await workbench.goTo(2, 28);
  await keyboard.type('| |');
  await workbench.goTo(1, 28);
  await keyboard.type('X3', { delay: 30 });
  // On a contact Enter opens a branch, whose name is typed next.
  await workbench.goTo(10, 5);
  await keyboard.press('Enter');
  await keyboard.type('X5');
  await keyboard.press('Escape');
  await untilText(workbench, 'the whole program', [...SEAL_IN, '', ...TIMER, '', END, '']);
  await untilClean(workbench);
  await workbench.screenshot('12-typed-program');
  await keyboard.press('Control+s');
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
  await entry.waitFor({ timeout: 45_000 });
  await entry.hover();
  await workbench.page.locator('.monaco-menu .action-label', { hasText: 'Insert Contact' }).first().waitFor({ timeout: 45_000 });
  await workbench.page.waitForTimeout(300);
  await workbench.screenshot('14-menu');
  await workbench.page.keyboard.press('Escape');
  await workbench.page.keyboard.press('Escape');
  await workbench.page.keyboard.press('Escape');
}
