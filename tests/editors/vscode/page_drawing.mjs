// Draws as a person does, in the page: a whole rung from nothing, edits by their keys, deletions and pastes.

const SEAL_IN = [
  '|   X10       X2      X11                  Y10 |',
  '+---| |---+---| |-----|/|------------------( )-+',
  '|   Y10   |                                    |',
  '+---| |---+                                    |',
];
const TIMER = [
  '|   Y10                                 T0 K100|',
  '+---| |------------------------------------( )-+',
  '',
  '|   T0                                     Y1  |',
  '+---| |------------------------------------( )-+',
];
const END = '+--[END]---------------------------------------+';

export const DRAWING_TESTS = {
  'a program is typed from nothing: snippets, names longer than their places, a contact by its keys': wholeProgram,
  'a contact, a branch and a coil are inserted by their keys and taken back': editsByKeys,
  'deleting cells keeps the columns, and is undone at once': deletion,
  'a pasted rung is aligned': paste,
  'the context menu has the edits': contextMenu,
};

/** Types a snippet's word and takes it from the list, then its names, each left by Tab. */
async function snippet(workbench, word, names) {
  const { keyboard } = workbench.page;
  await keyboard.type(word, { delay: 40 });
  await workbench.until(`the snippet ${word}`, async () => {
    const rows = await workbench.page.locator('.suggest-widget.visible .monaco-list-row.focused').allInnerTexts();
    return rows.some((row) => row.trim().split(/\s/)[0] === word);
  });
  await keyboard.press('Tab');
  for (const name of names) {
    await workbench.page.waitForTimeout(80);
    await keyboard.type(name, { delay: 60 });
    await keyboard.press('Escape'); // The list of names, if it is open, would take the Tab.
    await keyboard.press('Tab');
  }
}

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

async function untilClean(workbench) {
  await workbench.page.waitForTimeout(300);
  await workbench.until('no problems', async () => (await workbench.errorSquiggles()) === 0);
}

async function wholeProgram(workbench) {
  await workbench.openFile('typed.lad');
  await workbench.focusEditor();
  await snippet(workbench, 'seal', ['X10', 'X11', 'Y10']);
  await workbench.screenshot('11-typed-seal-in');
  await workbench.page.keyboard.press('Enter');
  await snippet(workbench, 'timer', ['Y10', 'T0', 'K100', 'Y1']);
  await workbench.page.keyboard.press('Enter');
  await snippet(workbench, 'end', []);
  await workbench.goTo(1, 15);
  await workbench.chord('c');
  await workbench.until('the name to type over', async () => (await workbench.documentLines())[0].includes('???'));
  await workbench.page.keyboard.type('X2', { delay: 60 });
  await workbench.page.keyboard.press('Escape');
  await untilText(workbench, 'the whole program', [...SEAL_IN, '', ...TIMER, '', END, '']);
  await untilClean(workbench);
  await workbench.screenshot('12-typed-program');
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
  await workbench.goTo(2, 25);
  for (let i = 0; i < 3; i++) {
    await workbench.page.keyboard.press('Backspace');
    await workbench.page.waitForTimeout(40);
  }
  const gap = [...before];
  gap[1] = `${before[1].slice(0, 21)}   ${before[1].slice(24)}`;
  await untilText(workbench, 'blank cells where the wire was', gap);
  await workbench.page.keyboard.press('Control+z');
  await untilText(workbench, 'the wire again', before);
}

async function paste(workbench) {
  await workbench.openFile('edited.lad');
  const before = await workbench.documentLines();
  await workbench.goTo(1, 5);
  await workbench.page.keyboard.press('Shift+ArrowRight');
  await workbench.page.keyboard.press('Shift+ArrowRight');
  await workbench.page.keyboard.insertText('X17');
  const wanted = [...before];
  wanted[0] = `${before[0].slice(0, 4)}X17${before[0].slice(7)}`;
  await untilText(workbench, 'the name in its place', wanted);
  await workbench.page.keyboard.press('Control+z');
  await untilText(workbench, 'the name before', before);
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
