// Uses VS Code as a person does: opens files, types, points with the mouse, and looks at the page.

import { copyFileSync, mkdirSync, readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { openBrowser } from './browser.mjs';
import { CHART_FILES, CHART_TESTS } from './page_chart.mjs';
import { DEBUGGING_FILES, DEBUGGING_TESTS } from './page_debugging.mjs';
import { DEVICE_FILES, DEVICE_TESTS } from './page_devices.mjs';
import { DRAWING_TESTS } from './page_drawing.mjs';
import { EXAMPLE_TESTS } from './page_examples.mjs';
import { LINE_TESTS } from './page_line.mjs';
import { PANEL_FILES, PANEL_TESTS } from './page_panel.mjs';
import { PLC_FILES, PLC_TESTS } from './page_plc.mjs';
import { SIMULATION_FILES, SIMULATION_TESTS } from './page_simulation.mjs';
import { TESTING_FILES, TESTING_TESTS } from './page_testing.mjs';
import { TRANSLATION_FILES, TRANSLATION_TESTS } from './page_translation.mjs';
import { VIEW_FILES, VIEW_TESTS } from './page_views.mjs';
import { Workbench } from './workbench.mjs';

/** A keystroke that repairs has to be seen at once; this is what the page may take on a busy machine. */
const REPAIR_LIMIT_MS = 20_000;

export async function runPageTests(server, workspace, home, report, artefacts) {
  for (const [name, fixture] of Object.entries({ ...VIEW_FILES, ...DEVICE_FILES, ...TRANSLATION_FILES, ...SIMULATION_FILES, ...PLC_FILES, ...PANEL_FILES, ...CHART_FILES, ...TESTING_FILES, ...DEBUGGING_FILES })) {
    mkdirSync(dirname(join(workspace, name)), { recursive: true });
    copyFileSync(join(workspace, fixture), join(workspace, name));
  }
  await server.start(workspace);
  const browser = await openBrowser(home);
  try {
    const workbench = new Workbench(await browser.newPage(), artefacts);
    await report.check('page: the workbench opens', () => workbench.load(`http://${server.authority}/?folder=${workspace}`));
    // The last one leaves VS Code without a server.
    const tests = { ...FIRST_TESTS, ...DRAWING_TESTS, ...VIEW_TESTS, ...DEVICE_TESTS, ...TRANSLATION_TESTS, ...SIMULATION_TESTS, ...PLC_TESTS, ...LINE_TESTS, ...EXAMPLE_TESTS, ...PANEL_TESTS, ...CHART_TESTS, ...TESTING_TESTS, ...DEBUGGING_TESTS, ...LAST_TESTS };
    const chosen = new RegExp(process.env.RUNGWISE_TESTS_NAMED ?? '');
    for (const [name, test] of Object.entries(tests).filter(([name]) => chosen.test(name))) {
      await report.check(`page: ${name}`, async () => {
        try {
          await test(workbench, workspace, server);
        } catch (error) {
          await workbench.screenshot(`failed-${test.name || name.replaceAll(/\W+/g, '-')}`);
          await workbench.calm();
          throw error;
        }
      });
    }
  } finally {
    await browser.close();
    server.stop();
  }
}

const FIRST_TESTS = {
  'three mistakes are underlined and listed with their codes': squiggles,
  'typing the missing wire clears that error and no other': repair,
  'pointing at an instruction opens its page': hover,
  'typing two letters opens the list of instructions': suggest,
  'Format Document straightens a ladder, and saving keeps it': format,
  'words of a program have different colours': colours,
};

const LAST_TESTS = {
  'a click on the status bar changes the target': target,
  'a wrong path of the server is told in a message with ways out': failureMessage,
};

const CODES = ['short-circuit', 'open-circuit', 'mixed-connection'];

async function listed(workbench) {
  const rows = await workbench.problems();
  return CODES.filter((code) => rows.some((row) => row.includes(code)));
}

async function squiggles(workbench) {
  await workbench.openFile('three_mistakes.lad');
  await workbench.until('squiggles', async () => (await workbench.errorSquiggles()) >= 3);
  await workbench.page.keyboard.press('Control+Shift+M');
  await workbench.until('three problems', async () => (await listed(workbench)).length === 3);
  await workbench.screenshot('1-three-mistakes');
}

async function repair(workbench) {
  await workbench.openFile('three_mistakes.lad');
  await workbench.goTo(13, 17);
  // In overtype mode a typed cell replaces a cell, and nothing to the right of it moves.
  await workbench.page.keyboard.press('Insert');
  await workbench.status('OVR');
  await workbench.page.keyboard.type('---', { delay: 60 });
  const start = performance.now();
  await workbench.page.keyboard.type('-');
  await workbench.page.keyboard.press('Insert');
  await workbench.until('the open circuit to go', async () => !(await listed(workbench)).includes('open-circuit'), REPAIR_LIMIT_MS);
  console.log(`        the error went ${Math.round(performance.now() - start)} ms after the keystroke`);
  const left = await listed(workbench);
  if (left.length !== 2) {
    throw new Error(`left are: ${left}`);
  }
  const lines = await workbench.editorLines();
  if (!lines.includes('+---| |-------------+                          |')) {
    throw new Error(`the line is not as typed:\n${lines.join('\n')}`);
  }
  await workbench.screenshot('2-repaired');
}

async function hover(workbench) {
  await workbench.openFile('conveyor_fx.il');
  // Lenses move the lines below them.
  await workbench.page.locator('.codelens-decoration', { hasText: 'steps' }).first().waitFor({ timeout: 45_000 });
  const word = workbench.page.locator('.editor-instance .view-line span span', { hasText: /^MOV$/ }).first();
  await word.hover();
  const text = await workbench.until('a hover', async () => {
    const shown = workbench.page.locator('.monaco-hover:visible').first();
    const content = (await shown.count()) > 0 ? await shown.innerText() : '';
    if (content !== '' && !content.includes('MOV')) {
      await workbench.page.mouse.move(5, 5);
      await word.hover();
    }
    return content.includes('MOV') && content;
  });
  if (/Loading/.test(text)) {
    throw new Error(text);
  }
  await workbench.screenshot('3-hover');
  await workbench.page.mouse.move(5, 5);
}

async function suggest(workbench) {
  await workbench.openFile('conveyor_fx.il');
  await workbench.goTo(10, 1);
  await workbench.page.keyboard.press('End');
  await workbench.page.keyboard.press('Enter');
  await workbench.page.keyboard.type('MO', { delay: 80 });
  await workbench.until('a suggestion', async () => {
    const rows = await workbench.page.locator('.suggest-widget.visible .monaco-list-row').allInnerTexts();
    return rows.some((row) => /^MOV\b/.test(row.trim()));
  });
  await workbench.screenshot('4-suggest');
  await workbench.page.keyboard.press('Escape');
  for (let i = 0; i < 3; i++) {
    await workbench.page.keyboard.press('Control+z');
  }
}

async function format(workbench, workspace) {
  await workbench.openFile('ragged.lad');
  await workbench.screenshot('5-before-format');
  await workbench.page.locator('.editor-instance .view-line').first().click();
  await workbench.command('Format Document');
  const rails = async () => {
    const rows = (await workbench.editorLines()).filter((line) => /^[|+]/.test(line));
    // A hint such as "= 5 s" is drawn in the line and is no part of the text.
    return new Set(rows.map((row) => row.replace(/= [\d.]+ m?s/, '').length));
  };
  await workbench.until('one column of rails', async () => (await rails()).size === 1);
  await workbench.screenshot('6-after-format');
  await workbench.page.keyboard.press('Control+s');
  await workbench.until('the saved file', () => {
    const saved = readFileSync(join(workspace, 'ragged.lad'), 'utf8');
    return new Set(saved.split('\n').filter((line) => /^[|+]/.test(line)).map((row) => row.length)).size === 1;
  });
}

/** Opens a file and gives how many different colours its text has. */
async function colourCount(workbench, file) {
  await workbench.openFile(file);
  return workbench.until(`colours in ${file}`, async () => {
    const colours = await workbench.page.locator('.editor-instance .view-line span span').evaluateAll((spans) =>
      spans.filter((span) => span.textContent.trim() !== '').map((span) => getComputedStyle(span).color));
    const count = new Set(colours).size;
    return count >= 3 && count;
  });
}

async function colours(workbench) {
  for (const file of ['mixer_iec.il', 'three_mistakes.lad', 'conveyor_fx.il']) {
    await colourCount(workbench, file);
    await workbench.screenshot(`7-colours-${file.replace(/\W/g, '-')}`);
  }
}

async function target(workbench, workspace) {
  await workbench.openFile('conveyor_fx.il');
  await workbench.status('FX2N');
  await workbench.page.locator('.statusbar-item', { hasText: 'FX2N' }).first().click();
  await workbench.page.waitForSelector('.quick-input-widget:visible', { timeout: 45_000 });
  await workbench.page.waitForTimeout(300); // The list fades in.
  await workbench.screenshot('8-select-target');
  await workbench.page.keyboard.type('FX3U');
  await workbench.page.keyboard.press('Enter');
  await workbench.status('FX3U');
  await workbench.until('the setting', () =>
    readFileSync(join(workspace, '.vscode', 'settings.json'), 'utf8').includes('"rungwise.target": "fx3u"'));
}

async function failureMessage(workbench) {
  // By its name: what other tests left in the folder may have moved its row out of sight.
  await workbench.openByName('settings.json');
  await workbench.page.locator('.tab.active', { hasText: 'settings.json' }).first().waitFor({ timeout: 45_000 });
  await workbench.page.waitForSelector('.editor-instance .view-line', { timeout: 45_000 });
  await workbench.goTo(1, 2);
  await workbench.page.keyboard.insertText('"rungwise.server.path": "/nowhere/rungwise",');
  await workbench.page.keyboard.press('Control+s');
  const toast = workbench.page.locator('.notification-toast', { hasText: '/nowhere/rungwise' }).first();
  await toast.waitFor({ timeout: 45_000 });
  for (const button of ['Open Settings', 'Show Log', 'Try Again']) {
    await toast.locator('.monaco-button', { hasText: button }).waitFor({ timeout: 45_000 });
  }
  await workbench.page.waitForTimeout(500); // The message slides in.
  await workbench.screenshot('9-server-missing');
  await toast.locator('.monaco-button', { hasText: 'Show Log' }).click();
  await workbench.page.locator('.output-view, .panel .view-lines').first().waitFor({ timeout: 45_000 });
  await workbench.screenshot('10-log');
}
