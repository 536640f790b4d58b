// The workbench as a person sees it: keys, mouse, and what stands on the page.

import { join } from 'node:path';

// What takes so long on the slowest machine has failed.
const SHORT_MS = 45_000;
const LONG_MS = 120_000;

export class Workbench {
  constructor(page, artefacts) {
    this.page = page;
    this.artefacts = artefacts;
  }

  async load(url) {
    await this.page.goto(url, { timeout: LONG_MS });
    await this.page.waitForSelector('.monaco-workbench', { timeout: LONG_MS });
    await this.page.waitForSelector('.explorer-folders-view .monaco-list-row', { timeout: LONG_MS });
  }

  /**
   * Opens a file by a double click in the explorer, or by its name: if the list would have to be scrolled, or if it moved
   * under the mouse, as it does while tests before have files written.
   */
  async openFile(name) {
    const row = this.page.locator('.explorer-folders-view .monaco-list-row', { hasText: name }).first();
    const tab = this.page.locator(`.tab.active[data-resource-name="${name}"]`);
    if (await row.waitFor({ timeout: 1_500 }).then(() => true, () => false)) {
      await row.dblclick();
      await tab.waitFor({ timeout: 5_000 }).catch(() => this.openByName(name));
    } else {
      await this.openByName(name);
    }
    await tab.waitFor({ timeout: SHORT_MS });
    await this.page.waitForSelector('.editor-instance .view-line', { timeout: SHORT_MS });
  }

  /** Opens a file by what is typed for it, where the list shows its name. */
  async openByName(typed, name = typed) {
    // The list of files that were open lately stands there before it is filtered: Enter takes the row that is focused.
    const row = this.page.locator('.quick-input-list .monaco-list-row.focused', { hasText: name });
    const deadline = Date.now() + SHORT_MS;
    for (;;) {
      await this.page.keyboard.press('Control+p');
      await this.page.waitForSelector('.quick-input-widget:visible', { timeout: SHORT_MS });
      await this.page.keyboard.type(typed);
      if (await row.waitFor({ timeout: 5_000 }).then(() => true, () => false)) {
        break;
      }
      if (Date.now() > deadline) {
        throw new Error(`no file ${name} in the list`);
      }
      // A search that began before the file came does not find it, the next one does.
      await this.page.keyboard.press('Escape');
    }
    await this.page.keyboard.press('Enter');
  }

  /** Puts the cursor at a line and column, both from 1, by the "go to line" box. */
  async goTo(line, column) {
    await this.page.keyboard.press('Control+g');
    await this.page.waitForSelector('.quick-input-widget:visible', { timeout: SHORT_MS });
    await this.page.keyboard.type(`${line}:${column}`);
    await this.page.keyboard.press('Enter');
    await this.page.waitForSelector('.quick-input-widget', { state: 'hidden', timeout: SHORT_MS });
    await this.status(`Ln ${line}, Col ${column}`);
  }

  /** Opens the hover at the cursor and waits until what it shows has this text, in an element of the hover if one is named. */
  async hoverAtCursor(text, element = '') {
    await this.page.keyboard.press('Control+k');
    await this.page.keyboard.press('Control+i');
    const shown = this.page.locator(`.monaco-hover:visible ${element}`, { hasText: text }).first();
    await shown.waitFor({ timeout: SHORT_MS });
    return shown;
  }

  /** Runs a command by its title in the palette. */
  async command(title) {
    await this.page.keyboard.press('F1');
    await this.page.waitForSelector('.quick-input-widget:visible', { timeout: SHORT_MS });
    await this.page.keyboard.type(title);
    await this.page.locator('.quick-input-list .monaco-list-row.focused', { hasText: title }).waitFor({ timeout: SHORT_MS });
    await this.page.keyboard.press('Enter');
    await this.page.waitForSelector('.quick-input-widget', { state: 'hidden', timeout: SHORT_MS });
  }

  /** Puts the keyboard into the editor, at the start of the text. */
  async focusEditor() {
    await this.page.locator('.editor-instance .view-line').first().click();
    await this.page.keyboard.press('Control+Home');
  }

  /** Presses the keys of a command of a drawing: Alt+L, then a letter. */
  async chord(key) {
    await this.page.keyboard.press('Alt+l');
    await this.page.keyboard.press(key);
  }

  /** Waits for a text in the status bar. */
  async status(text) {
    await this.page.locator('.statusbar-item', { hasText: text }).first().waitFor({ timeout: SHORT_MS });
  }

  /** What the Problems panel lists, a line of text for each. */
  problems() {
    return this.page.locator('.markers-panel .monaco-list-row').allInnerTexts();
  }

  errorSquiggles() {
    return this.page.locator('.editor-instance .squiggly-error').count();
  }

  /** Text of the editor as it is drawn, line by line. */
  async editorLines() {
    const lines = await this.page.locator('.editor-instance .view-lines .view-line').evaluateAll((nodes) =>
      nodes.map((node) => [Number.parseFloat(node.style.top), node.textContent]).sort((a, b) => a[0] - b[0]).map((x) => x[1]));
    // The editor draws blanks as no-break spaces.
    return lines.map((line) => line.replaceAll('\u00a0', ' '));
  }

  /** The lines of the text, without the hints that the editor draws between them, as far as they are on the screen. */
  async documentLines() {
    const lines = await this.page.locator('.editor-instance .view-lines .view-line').evaluateAll((nodes) =>
      nodes.map((node) => {
        const copy = node.cloneNode(true);
        // Hints are drawn into the line with a class of their own.
        copy.querySelectorAll('[class*="dyn-rule"], [class*="inline-hint"]').forEach((hint) => hint.remove());
        return [Number.parseFloat(node.style.top), copy.textContent];
      }).sort((a, b) => a[0] - b[0]).map((x) => x[1]));
    return lines.map((line) => line.replaceAll('\u00a0', ' '));
  }

  /** Polls until `probe` gives something true. */
  async until(what, probe, timeoutMs = SHORT_MS) {
    const end = Date.now() + timeoutMs;
    let last;
    while (Date.now() < end) {
      last = await probe();
      if (last) {
        return last;
      }
      await this.page.waitForTimeout(20);
    }
    await this.screenshot('failure');
    throw new Error(`waited ${timeoutMs} ms for ${what}`);
  }

  /** Closes a tab by its cross. */
  async closeTab(name) {
    const tab = this.page.locator(`.tab[data-resource-name="${name}"]`).first();
    await tab.hover();
    await tab.locator('.codicon-close').click();
    await tab.waitFor({ state: 'detached', timeout: SHORT_MS });
  }

  /** Closes what a failed check has left open, so that the next one starts in the editor. */
  async calm() {
    for (let i = 0; i < 3; i++) {
      await this.page.keyboard.press('Escape');
    }
  }

  /** Leaves nothing open, saving nothing: a check that begins with this does not depend on those before it. */
  async clear() {
    await this.calm();
    await this.page.mouse.move(5, 5);
    const tabs = this.page.locator('.editor-group-container .tab');
    if ((await tabs.count()) > 0) {
      await this.command('View: Close All Editors');
      await this.until('no open editor', async () => {
        const refused = this.page.locator('.monaco-dialog-box .monaco-button', { hasText: "Don't Save" }).first();
        if (await refused.isVisible()) {
          await refused.click();
        }
        return (await tabs.count()) === 0;
      });
    }
    if (await this.page.locator('.part.panel').first().isVisible()) {
      await this.command('View: Hide Panel');
    }
  }

  async screenshot(name) {
    await this.page.screenshot({ path: join(this.artefacts, `vscode-${name}.png`) });
  }
}
