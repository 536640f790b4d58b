// What of the I/O panel is moved with the mouse, and how it looks in the kinds of themes that there are.

import { mkdirSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { isOn, openPanel, save } from './page_panel.mjs';

/** The files of these checks, and the fixtures of which they are copies. */
export const CHART_FILES = { 'level.il': 'conveyor_fx.il', 'charted.lad': 'motor.lad', 'themed.lad': 'motor.lad' };

export const CHART_TESTS = {
  'a register follows its slider, and time the speed that is chosen': moved,
  'the timing chart is zoomed by the wheel and moved by the mouse, and its changes are saved as CSV': zoomed,
  'the panel can be read, and buttons told from lamps, in themes of each kind': themed,
};

async function moved(workbench) {
  const panel = await openPanel(workbench, 'level.il');
  const row = panel.locator('[data-name="D0"]');
  const [slider, field] = [row.locator('input[type="range"]'), row.locator('input.number')];
  const { x, y, width, height } = await slider.boundingBox();
  const { mouse } = workbench.page;
  await mouse.move(x + 8, y + height / 2);
  await mouse.down();
  await mouse.move(x + width * 0.75, y + height / 2, { steps: 6 });
  await mouse.up();
  const dragged = Number(await slider.inputValue());
  if (dragged < 60 || dragged > 90) {
    throw new Error(`three quarters of the slider are ${dragged}`);
  }
  await workbench.until('the number of the slider', async () => Number(await field.inputValue()) === dragged);
  // A picture from before the drag may put it back for a moment, and the key counts from there.
  await workbench.until('more by a key', async () => {
    const now = Number(await field.inputValue());
    if (now === dragged) {
      await slider.press('ArrowRight');
      await workbench.page.waitForTimeout(300);
    }
    return now > dragged && now < dragged + 10;
  });
  // Half a minute of the program in far less of ours.
  const time = async () => {
    const [, minutes, seconds] = /^(?:(\d+):)?([\d.]+)/.exec(await panel.locator('.all-figures .figure').nth(1).innerText()) ?? [];
    return Number(minutes ?? 0) * 60 + Number(seconds);
  };
  const [before, began] = [await time(), Date.now()];
  await panel.locator('.toolbar select').selectOption('100');
  await workbench.until('half a minute of the program', async () => (await time()) > before + 30);
  const took = (Date.now() - began) / 1000;
  if (took > 20) {
    throw new Error(`thirty seconds at a hundredfold speed took ${took} s`);
  }
  await workbench.screenshot('45-panel-slider');
  await panel.locator('.toolbar select').selectOption('1');
  await workbench.command('Rungwise: Stop Simulation');
  await workbench.clear();
}

/** The first and the last scan that the chart shows. */
async function shown(panel) {
  const [, from, to] = /from scan (\d+) to (\d+)/.exec(await panel.locator('canvas').getAttribute('aria-label')) ?? [];
  return [Number(from), Number(to)];
}

async function zoomed(workbench, workspace) {
  const panel = await openPanel(workbench, 'charted.lad');
  await panel.locator('[data-name="X0"] .push').click();
  await workbench.until('the lamp a second later', () => isOn(panel, 'Y1'));
  await panel.locator('[aria-label="Pause (G)"]').click();
  await panel.locator('.mode[data-mode="paused"]').waitFor();
  const canvas = panel.locator('canvas');
  await panel.locator('[aria-label="See all of the time"]').click();
  const all = await workbench.until('the chart from the first scan on', async () => {
    const [from, to] = await shown(panel);
    return from === 0 && to > 100 && [from, to];
  });
  const { x, y, width, height } = await canvas.boundingBox();
  const { mouse } = workbench.page;
  await mouse.move(x + width * 0.7, y + height / 2);
  for (let turn = 0; turn < 4; turn++) {
    await mouse.wheel(0, -120);
  }
  const close = await workbench.until('fewer scans, around the mouse', async () => {
    const [from, to] = await shown(panel);
    return from > 0 && to <= all[1] && to - from < (all[1] - all[0]) * 0.6 && [from, to];
  });
  // What is dragged to the right shows what was before.
  await mouse.down();
  await mouse.move(x + width * 0.9, y + height / 2, { steps: 5 });
  const earlier = await workbench.until('earlier scans', async () => {
    const [from, to] = await shown(panel);
    return from < close[0] && to < close[1] && [from, to];
  });
  if (Math.abs(earlier[1] - earlier[0] - (close[1] - close[0])) > 1) {
    throw new Error(`${earlier} after ${close}: dragging has zoomed`);
  }
  await workbench.screenshot('46-chart-zoomed');
  await mouse.up();
  // With Shift the wheel moves.
  await workbench.page.keyboard.down('Shift');
  await mouse.wheel(0, 240);
  await workbench.page.keyboard.up('Shift');
  await workbench.until('later scans', async () => (await shown(panel))[0] > earlier[0]);
  await mouse.wheel(0, 120);
  await workbench.until('more scans', async () => {
    const [from, to] = await shown(panel);
    return to - from > close[1] - close[0];
  });
  await save(workbench, panel, 'All changes, as CSV', join(workspace, 'charted.csv'), (text) => {
    const [head, ...rows] = text.trim().split('\n').map((line) => line.split(','));
    const at = (name) => head.indexOf(name);
    const first = (name) => rows.find((row) => row[at(name)] === '1');
    const [motor, lamp] = [first('Y0'), first('Y1')];
    // A second lies between the motor and the lamp.
    return head.slice(0, 2).join() === 'scan,time_ms' && motor !== undefined && lamp !== undefined
      && Number(lamp[1]) - Number(motor[1]) >= 1000 && Number(lamp[1]) - Number(motor[1]) <= 1020;
  });
  await workbench.command('Rungwise: Stop Simulation');
  await workbench.clear();
}

const THEMES = [
  ['Default Light Modern', 'vscode-light', 'light'],
  ['Default High Contrast', 'vscode-high-contrast', 'high-contrast'],
  ['Default High Contrast Light', 'vscode-high-contrast-light', 'high-contrast-light'],
  ['Default Dark Modern', 'vscode-dark', 'dark'],
];

async function themed(workbench, workspace) {
  const panel = await openPanel(workbench, 'themed.lad');
  await panel.locator('[data-name="X0"] .push').click();
  await workbench.until('the motor', () => isOn(panel, 'Y0'));
  await panel.locator('[data-name="X1"] .push').focus();
  await workbench.page.keyboard.press('f');
  await panel.locator('[data-name="X1"][data-forced]').waitFor();
  for (const [label, kind, name] of THEMES) {
    choose(workspace, label);
    await panel.locator(`body.${kind}`).waitFor({ timeout: 45_000 });
    const looks = await workbench.until(`the colours of ${label}`, async () => {
      const found = await panel.locator('body').evaluate(lookOf);
      return Object.values(found.contrasts).every((ratio) => ratio >= 3) && found;
    }).catch(async () => {
      throw new Error(`${label}: ${JSON.stringify(await panel.locator('body').evaluate(lookOf))}`);
    });
    if (looks.push.shadow === 'none' || looks.push.radius === looks.lamp.radius || looks.push.width <= looks.push.height) {
      throw new Error(`${label}: a button looks like a lamp: ${JSON.stringify(looks)}`);
    }
    await workbench.page.mouse.move(5, 5);
    await workbench.screenshot(`47-panel-${name}`);
  }
  rmSync(settings(workspace));
  await workbench.command('Rungwise: Stop Simulation');
  await workbench.clear();
}

/** Chooses a colour theme by its name, for the workspace alone. */
function choose(workspace, label) {
  mkdirSync(join(workspace, '.vscode'), { recursive: true });
  writeFileSync(settings(workspace), JSON.stringify({ 'workbench.colorTheme': label }));
}

const settings = (workspace) => join(workspace, '.vscode', 'settings.json');

/** Runs in the page: how buttons and lamps look, and the contrasts by which they are seen (WCAG 2.2, 1.4.3 and 1.4.11). */
function lookOf(body) {
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = 1;
  const context = canvas.getContext('2d', { willReadFrequently: true });
  // The colours one over the other, the last one on top, as red, green and blue from 0 to 1.
  const mixed = (...colours) => {
    context.clearRect(0, 0, 1, 1);
    for (const colour of colours) {
      context.fillStyle = colour;
      context.fillRect(0, 0, 1, 1);
    }
    return [...context.getImageData(0, 0, 1, 1).data.slice(0, 3)].map((part) => part / 255);
  };
  const light = (colour) => {
    const [r, g, b] = colour.map((part) => (part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const contrast = (one, other) => {
    const [dark, bright] = [light(one), light(other)].sort((a, b) => a - b);
    return (bright + 0.05) / (dark + 0.05);
  };
  const style = (selector) => getComputedStyle(body.querySelector(selector));
  const surface = getComputedStyle(body).backgroundColor;
  const group = mixed(surface, style('.group').backgroundColor);
  const groupColour = `rgb(${group.map((part) => part * 255).join(' ')})`;
  const [push, lamp] = [style('[data-name="X0"] .push'), style('[data-name="X0"] .lamp')];
  const lit = style('[data-name="Y0"] .lamp');
  return {
    push: { shadow: push.boxShadow, radius: push.borderRadius, width: parseFloat(push.width), height: parseFloat(push.height) },
    lamp: { radius: lamp.borderRadius },
    contrasts: {
      words: contrast(mixed(groupColour, style('.words b').color), group),
      button: contrast(mixed(groupColour, push.backgroundColor, push.color), mixed(groupColour, push.backgroundColor)),
      edge: contrast(mixed(groupColour, push.boxShadow.replace(/^((?:rgba?|color)\([^)]*\)).*$/, '$1')), group),
      dark: contrast(mixed(groupColour, lamp.borderTopColor), group),
      lit: contrast(mixed(groupColour, lit.backgroundColor), group),
      number: contrast(mixed(groupColour, style('.figure').color), mixed(surface)),
    },
  };
}
