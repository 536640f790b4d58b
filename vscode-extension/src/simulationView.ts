/** Running a program on the simulated PLC: commands, and power in the text. */

import * as vscode from 'vscode';
import type { ServerController } from './server';
import { clock, deviceAt, MONITOR, parsePicture, simulate, type Mode, type Picture } from './simulation';
import type { PlainRange } from './structuralEdits';

const LANGUAGES = ['ladder', 'plc-il'];
/** The visible lines are told when they stand still for so long. */
const SCROLL_MS = 50;

export class SimulationView implements vscode.Disposable {
  private readonly subscriptions: vscode.Disposable[];
  // Weight and a line under the cells tell as much as colours.
  private readonly energised = vscode.window.createTextEditorDecorationType({
    backgroundColor: new vscode.ThemeColor('rungwise.energisedBackground'),
    color: new vscode.ThemeColor('rungwise.energisedForeground'),
    fontWeight: 'bold',
  });
  private readonly ready = vscode.window.createTextEditorDecorationType({
    textDecoration: 'underline dotted',
  });
  private readonly value = vscode.window.createTextEditorDecorationType({
    after: { color: new vscode.ThemeColor('editorInlayHint.foreground'), margin: '0 0 0 0.3em' },
  });
  private readonly error = vscode.window.createTextEditorDecorationType({
    textDecoration: 'underline wavy',
    overviewRulerColor: new vscode.ThemeColor('editorOverviewRuler.errorForeground'),
  });
  private readonly status = vscode.window.createStatusBarItem('rungwise.simulation', vscode.StatusBarAlignment.Left, 5);
  /** Programs that are simulated, by the server's address. */
  private readonly running = new Map<string, { uri: vscode.Uri; mode: Mode }>();
  private readonly pictures = new vscode.EventEmitter<{ readonly document: vscode.Uri; readonly params: unknown }>();
  private readonly changes = new vscode.EventEmitter<vscode.Uri>();
  /** The server's pictures of a program. */
  readonly onDidPicture = this.pictures.event;
  /** A program that is simulated from now on, or no longer. */
  readonly onDidChange = this.changes.event;
  private scrolled: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly server: ServerController) {
    const { registerCommand } = vscode.commands;
    const here = (run: (editor: vscode.TextEditor) => Promise<unknown>) => () => this.run(run);
    const tells = (verb: string) => here(({ document }) => this.tell(document.uri, verb));
    this.status.name = 'Rungwise';
    this.subscriptions = [
      this.energised,
      this.ready,
      this.value,
      this.error,
      this.status,
      this.pictures,
      this.changes,
      registerCommand('rungwise.simulation.start', here((editor) => this.start(editor.document.uri))),
      registerCommand('rungwise.simulation.stop', here((editor) => this.stop(editor.document.uri))),
      registerCommand('rungwise.simulation.pause', here((editor) => this.pause(editor))),
      registerCommand('rungwise.simulation.step', tells('step')),
      registerCommand('rungwise.simulation.stepBack', tells('stepBack')),
      registerCommand('rungwise.simulation.reset', tells('reset')),
      registerCommand('rungwise.simulation.toggle', here((editor) => this.toggle(editor))),
      registerCommand('rungwise.simulation.setValue', here((editor) => this.setValue(editor))),
      vscode.window.onDidChangeTextEditorVisibleRanges(() => this.scroll()),
      vscode.window.onDidChangeVisibleTextEditors(() => this.scroll()),
      vscode.window.onDidChangeActiveTextEditor(() => this.showContext()),
      vscode.workspace.onDidCloseTextDocument((document) => void this.stop(document.uri)),
      server.onNotification(MONITOR, (params) => this.take(params)),
      server.onDidStart(() => this.forgetAll()),
    ];
  }

  dispose(): void {
    clearTimeout(this.scrolled);
    vscode.Disposable.from(...this.subscriptions).dispose();
  }

  private async run(run: (editor: vscode.TextEditor) => Promise<unknown>): Promise<void> {
    const editor = vscode.window.activeTextEditor;
    if (editor === undefined || !LANGUAGES.includes(editor.document.languageId)) {
      void vscode.window.showInformationMessage(vscode.l10n.t('Rungwise: open a .lad or .il file to simulate it.'));
      return;
    }
    try {
      await run(editor);
    } catch (error) {
      const reason = error instanceof Error ? error.message : String(error);
      void vscode.window.showErrorMessage(`Rungwise: ${reason}`);
    }
  }

  isRunning(document: vscode.Uri): boolean {
    return this.running.has(this.server.protocolUri(document));
  }

  async start(document: vscode.Uri): Promise<void> {
    const uri = this.server.protocolUri(document);
    await this.tell(document, 'start');
    this.running.set(uri, { uri: document, mode: 'running' });
    this.showContext();
    this.changes.fire(document);
    await this.watch();
  }

  /** Lets pictures tell the values of these names. */
  async watchNames(document: vscode.Uri, names: readonly string[]): Promise<void> {
    if (this.isRunning(document)) {
      await this.tell(document, 'watch', { names });
    }
  }

  async stop(document: vscode.Uri): Promise<void> {
    if (this.forget(document)) {
      await this.tell(document, 'stop');
    }
  }

  /** Shows nothing more of it; whether it was simulated. */
  private forget(document: vscode.Uri): boolean {
    if (!this.running.delete(this.server.protocolUri(document))) {
      return false;
    }
    this.clear(document);
    this.showContext();
    this.changes.fire(document);
    return true;
  }

  private async pause({ document }: vscode.TextEditor): Promise<void> {
    const running = this.running.get(this.server.protocolUri(document.uri));
    await this.tell(document.uri, running?.mode === 'paused' ? 'run' : 'pause');
  }

  /** Turns the relay or input at the cursor over. */
  private async toggle(editor: vscode.TextEditor): Promise<void> {
    const name = nameAt(editor);
    if (name === undefined) {
      return;
    }
    const state = (await this.tell(editor.document.uri, 'state', { names: [name] })) as State;
    const before = state.values?.[0]?.wired ?? state.values?.[0]?.value;
    if (typeof before === 'boolean') {
      await this.tell(editor.document.uri, 'set', { name, value: !before });
    } else {
      await this.setValue(editor);
    }
  }

  private async setValue(editor: vscode.TextEditor): Promise<void> {
    const name = nameAt(editor);
    if (name === undefined) {
      return;
    }
    const value = await vscode.window.showInputBox({ title: vscode.l10n.t('Value of {0}', name) });
    if (value !== undefined && value.trim() !== '') {
      await this.tell(editor.document.uri, 'set', { name, value });
    }
  }

  async tell(document: vscode.Uri, verb: string, more: object = {}): Promise<unknown> {
    return this.server.executeCommand(simulate(verb), [{ ...more, uri: this.server.protocolUri(document) }]);
  }

  /** Tells the server what is on the screen, once it stands still. */
  private scroll(): void {
    clearTimeout(this.scrolled);
    if (this.running.size > 0) {
      this.scrolled = setTimeout(() => void this.watch().catch(() => undefined), SCROLL_MS);
    }
  }

  private async watch(): Promise<void> {
    const watched = [...this.running.values()].map(({ uri }) => {
      const editors = editorsOf(uri);
      const ranges = editors.flatMap(({ visibleRanges }) => visibleRanges.map(({ start, end }) => ({ start, end })));
      return this.tell(uri, 'watch', { ranges });
    });
    await Promise.all(watched);
  }

  private take(params: unknown): void {
    const picture = parsePicture(params);
    const running = picture && this.running.get(picture.uri);
    if (picture !== undefined && running !== undefined) {
      if (picture.mode === 'stopped') {
        // Its document was closed.
        this.forget(running.uri);
        return;
      }
      this.paint(picture, running);
      this.pictures.fire({ document: running.uri, params });
    }
  }

  private paint(picture: Picture, running: { readonly uri: vscode.Uri; mode: Mode }): void {
    if (running.mode !== picture.mode) {
      running.mode = picture.mode;
      this.showContext();
    }
    for (const editor of editorsOf(running.uri)) {
      // What was painted of another version stands in other places.
      if (editor.document.version === picture.version) {
        editor.setDecorations(this.energised, picture.energised.map(toRange));
        editor.setDecorations(this.ready, picture.ready.map(toRange));
        editor.setDecorations(
          this.value,
          placedValues(editor.document, picture.values).map(({ range, text }) => ({
            range,
            renderOptions: { after: { contentText: text } },
          })),
        );
        editor.setDecorations(
          this.error,
          picture.errors.map(({ range, message }) => ({ range: toRange(range), hoverMessage: message })),
        );
      }
    }
    const icon = picture.mode === 'paused' ? '$(debug-pause)' : '$(play)';
    this.status.text = `${icon} ${vscode.l10n.t('scan {0}', picture.scan)} · ${clock(picture.timeMs)}`;
    this.status.command = 'rungwise.simulation.pause';
    this.status.show();
  }

  private clear(document: vscode.Uri): void {
    for (const editor of editorsOf(document)) {
      [this.energised, this.ready, this.value, this.error].forEach((type) => editor.setDecorations(type, []));
    }
  }

  /** A server that was started anew simulates nothing. */
  private forgetAll(): void {
    const before = [...this.running.values()];
    this.running.clear();
    before.forEach(({ uri }) => {
      this.clear(uri);
      this.changes.fire(uri);
    });
    this.showContext();
  }

  private showContext(): void {
    const document = vscode.window.activeTextEditor?.document;
    const mode = document && this.running.get(this.server.protocolUri(document.uri))?.mode;
    void vscode.commands.executeCommand('setContext', 'rungwise.simulation', mode ?? 'stopped');
    if (this.running.size === 0) {
      this.status.hide();
    }
  }
}

interface State {
  readonly values?: readonly { readonly value?: unknown; readonly wired?: boolean }[];
}

function editorsOf(uri: vscode.Uri): readonly vscode.TextEditor[] {
  return vscode.window.visibleTextEditors.filter(({ document }) => document.uri.toString() === uri.toString());
}

/** Beside the words of a list; in a drawing at the end of the row, lest its columns move. */
function placedValues(
  document: vscode.TextDocument,
  values: Picture['values'],
): { range: vscode.Range; text: string }[] {
  if (document.languageId !== 'ladder') {
    return values.map(({ range, value }) => ({ range: toRange(range), text: `= ${value}` }));
  }
  const rows = new Map<number, string[]>();
  for (const { range, value } of values) {
    const row = rows.get(range.start.line) ?? [];
    rows.set(range.start.line, [...row, `${document.getText(toRange(range))} = ${value}`]);
  }
  return [...rows].map(([line, words]) => ({ range: document.lineAt(line).range, text: `  ${words.join(', ')}  ` }));
}

function nameAt({ document, selection }: vscode.TextEditor): string | undefined {
  return deviceAt(document.lineAt(selection.active.line).text, selection.active.character);
}

function toRange({ start, end }: PlainRange): vscode.Range {
  return new vscode.Range(start.line, start.character, end.line, end.character);
}
