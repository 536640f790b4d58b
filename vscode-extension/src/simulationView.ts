/** Running a program on the simulated PLC: commands, and power in the text. */

import * as vscode from 'vscode';
import { plc } from './plc';
import type { ServerController } from './server';
import { clock, deviceAt, lookText, MONITOR, parsePicture, simulate, type Mode, type Picture, type Source } from './simulation';
import type { PlainRange } from './structuralEdits';
import { freeName } from './testing';

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
    after: { color: new vscode.ThemeColor('editorInlayHint.foreground'), margin: '0 0.4em 0 0.3em' },
  });
  // A frame of dashes and a letter: neither takes a column from a drawing.
  private readonly forced = vscode.window.createTextEditorDecorationType({
    border: '1px dashed',
    borderColor: new vscode.ThemeColor('rungwise.forcedForeground'),
    overviewRulerColor: new vscode.ThemeColor('rungwise.forcedForeground'),
    overviewRulerLane: vscode.OverviewRulerLane.Left,
    after: {
      contentText: 'F',
      color: new vscode.ThemeColor('rungwise.forcedForeground'),
      fontWeight: 'bold',
      textDecoration: 'none; position: absolute; font-size: 65%; line-height: 1; margin-left: 1px',
    },
  });
  private readonly error = vscode.window.createTextEditorDecorationType({
    textDecoration: 'underline wavy',
    overviewRulerColor: new vscode.ThemeColor('editorOverviewRuler.errorForeground'),
  });
  private readonly status = vscode.window.createStatusBarItem('rungwise.simulation', vscode.StatusBarAlignment.Left, 5);
  /** Files of programs that run, by the server's address. */
  private readonly running = new Map<string, Running>();
  private readonly pictures = new vscode.EventEmitter<{ readonly document: vscode.Uri; readonly params: unknown }>();
  private readonly changes = new vscode.EventEmitter<vscode.Uri>();
  /** The server's pictures of a program. */
  readonly onDidPicture = this.pictures.event;
  /** A program that is simulated from now on, or no longer. */
  readonly onDidChange = this.changes.event;
  private readonly painted = new WeakMap<vscode.TextEditor, Map<vscode.TextEditorDecorationType, string>>();
  private operated: vscode.Uri | undefined;
  private scrolled: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly server: ServerController) {
    const { registerCommand } = vscode.commands;
    const here = (run: (program: vscode.Uri) => Promise<unknown>) => () => this.run(run);
    const tells = (verb: string) => here((program) => this.tell(program, verb));
    const atCursor = (run: (editor: vscode.TextEditor) => Promise<void>) =>
      here(async () => {
        const editor = vscode.window.activeTextEditor;
        await (editor && run(editor));
      });
    this.status.name = 'Rungwise';
    this.subscriptions = [
      this.energised,
      this.ready,
      this.value,
      this.forced,
      this.error,
      this.status,
      this.pictures,
      this.changes,
      registerCommand('rungwise.simulation.start', here((program) => this.start(program))),
      registerCommand('rungwise.simulation.stop', here((program) => this.stop(program))),
      registerCommand('rungwise.simulation.pause', here((program) => this.pause(program))),
      registerCommand('rungwise.simulation.step', tells('step')),
      registerCommand('rungwise.simulation.stepBack', tells('stepBack')),
      registerCommand('rungwise.simulation.reset', tells('reset')),
      registerCommand('rungwise.simulation.toggle', atCursor((editor) => this.toggle(editor))),
      registerCommand('rungwise.simulation.record', here((program) => this.record(program))),
      registerCommand('rungwise.simulation.setValue', atCursor((editor) => this.setValue(editor))),
      vscode.window.onDidChangeTextEditorVisibleRanges(() => this.scroll()),
      vscode.window.onDidChangeVisibleTextEditors(() => void this.join().catch(() => undefined)),
      vscode.window.onDidChangeActiveTextEditor(() => this.showContext()),
      vscode.workspace.onDidCloseTextDocument((document) => void this.close(document.uri)),
      server.onNotification(MONITOR, (params) => this.take(params)),
      server.onDidStart(() => this.forgetAll()),
    ];
  }

  dispose(): void {
    clearTimeout(this.scrolled);
    vscode.Disposable.from(...this.subscriptions).dispose();
  }

  /** A panel that has the keyboard is about this program; without one the program is that of the editor. */
  operate(program: vscode.Uri | undefined): void {
    this.operated = program;
    this.showContext();
  }

  private get program(): vscode.Uri | undefined {
    const document = vscode.window.activeTextEditor?.document;
    return this.operated ?? (document && LANGUAGES.includes(document.languageId) ? document.uri : undefined);
  }

  private async run(run: (program: vscode.Uri) => Promise<unknown>): Promise<void> {
    const { program } = this;
    if (program === undefined) {
      void vscode.window.showInformationMessage(vscode.l10n.t('Rungwise: open a .lad or .il file to simulate it.'));
      return;
    }
    try {
      await run(program);
    } catch (error) {
      const reason = error instanceof Error ? error.message : String(error);
      void vscode.window.showErrorMessage(`Rungwise: ${reason}`);
    }
  }

  isRunning(document: vscode.Uri): boolean {
    return this.source(document) === 'simulator';
  }

  /** What shows the program: its simulation, a PLC that is monitored, or nothing. */
  source(document: vscode.Uri): Source | undefined {
    return this.running.get(this.server.protocolUri(document))?.source;
  }

  async start(document: vscode.Uri): Promise<void> {
    this.add(document, (await this.tell(document, 'start')) as State);
    await this.join();
    await this.watch();
  }

  private add(document: vscode.Uri, { mode, files }: State): void {
    const own = this.server.protocolUri(document);
    this.running.set(own, { uri: document, mode: mode === 'paused' ? mode : 'running', source: 'simulator', files: files ?? [own] });
    this.showContext();
    this.changes.fire(document);
  }

  /** Shows what runs also in other files of its program that are on the screen. */
  private async join(): Promise<void> {
    const isSimulating = [...this.running.values()].some(({ source }) => source === 'simulator');
    const shown = vscode.window.visibleTextEditors.map(({ document }) => document);
    const others = shown.filter(({ uri, languageId }) => LANGUAGES.includes(languageId) && this.source(uri) === undefined);
    for (const { uri } of isSimulating ? others : []) {
      const state = (await this.tell(uri, 'state')) as State;
      if (state.mode !== 'stopped' && this.source(uri) === undefined) {
        this.add(uri, state);
      }
    }
    this.scroll();
  }

  /** Shows what a program does in the PLC that is connected. */
  async followPlc(document: vscode.Uri): Promise<void> {
    await this.stop(document);
    this.unfollowAll();
    this.running.set(this.server.protocolUri(document), { uri: document, mode: 'running', source: 'plc', files: [] });
    await this.watch();
    this.changes.fire(document);
  }

  /** Shows no more of what it does there. */
  unfollow(document: vscode.Uri): void {
    if (this.running.get(this.server.protocolUri(document))?.source === 'plc') {
      this.forget(document);
    }
  }

  unfollowAll(): void {
    [...this.running.values()].forEach(({ uri }) => this.unfollow(uri));
  }

  /** Lets pictures tell the values of these names. */
  async watchNames(document: vscode.Uri, names: readonly string[]): Promise<void> {
    if (this.source(document) === 'plc') {
      await this.tellPlc(document, 'monitor', { names });
    } else if (this.isRunning(document)) {
      await this.tell(document, 'watch', { names });
    }
  }

  async stop(document: vscode.Uri): Promise<void> {
    if (this.isRunning(document)) {
      this.forgetAllOf(document);
      await this.tell(document, 'stop');
    }
  }

  /** What is closed is shown no more; the simulation goes on while another file of the program is open. */
  private async close(document: vscode.Uri): Promise<void> {
    const files = this.running.get(this.server.protocolUri(document))?.files ?? [];
    const isLast = !vscode.workspace.textDocuments.some(({ uri }) => files.includes(this.server.protocolUri(uri)));
    await (isLast ? this.stop(document) : this.forget(document));
  }

  /** Shows nothing more of any file of a program. */
  private forgetAllOf(document: vscode.Uri): void {
    const files = this.running.get(this.server.protocolUri(document))?.files ?? [];
    this.forget(document);
    const others = files.map((file) => this.running.get(file)).filter((running) => running?.source === 'simulator');
    others.forEach((running) => running && this.forget(running.uri));
  }

  /** Shows nothing more of a file. */
  private forget(document: vscode.Uri): void {
    if (this.running.delete(this.server.protocolUri(document))) {
      this.clear(document);
      this.showContext();
      this.changes.fire(document);
    }
  }

  private async pause(program: vscode.Uri): Promise<void> {
    const running = this.running.get(this.server.protocolUri(program));
    await this.tell(program, running?.mode === 'paused' ? 'run' : 'pause');
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

  /** Opens what was done so far as a scenario test in a file that is not saved yet. */
  private async record(program: vscode.Uri): Promise<void> {
    const { name, text } = (await this.tell(program, 'record')) as { name: string; text: string };
    const at = (file: string) => vscode.Uri.joinPath(program, '..', file);
    const exists = async (file: string) => {
      const isOpen = vscode.workspace.textDocuments.some(({ uri }) => uri.path === at(file).path);
      return isOpen || vscode.workspace.fs.stat(at(file)).then(() => true, () => false);
    };
    const uri = at(await freeName(name, exists)).with({ scheme: 'untitled' });
    const recorded = await vscode.workspace.openTextDocument(uri);
    const edit = new vscode.WorkspaceEdit();
    edit.insert(uri, new vscode.Position(0, 0), text);
    await vscode.workspace.applyEdit(edit);
    await vscode.window.showTextDocument(recorded);
  }

  /** Gives the simulation of a program an order, and its answer. */
  async tell(document: vscode.Uri, verb: string, more: object = {}): Promise<unknown> {
    return this.server.executeCommand(simulate(verb), [{ ...more, uri: this.server.protocolUri(document) }]);
  }

  /** The same for the PLC in which the program is monitored. */
  async tellPlc(document: vscode.Uri, verb: string, more: object = {}): Promise<unknown> {
    return this.server.executeCommand(plc(verb), [{ ...more, uri: this.server.protocolUri(document) }]);
  }

  /** Tells the server what is on the screen, once it stands still. */
  private scroll(): void {
    clearTimeout(this.scrolled);
    if (this.running.size > 0) {
      this.scrolled = setTimeout(() => void this.watch().catch(() => undefined), SCROLL_MS);
    }
  }

  private async watch(): Promise<void> {
    const watched = [...this.running.values()].map(({ uri, source }) => {
      const editors = editorsOf(uri);
      const ranges = editors.flatMap(({ visibleRanges }) => visibleRanges.map(({ start, end }) => ({ start, end })));
      return source === 'plc' ? this.tellPlc(uri, 'monitor', { ranges }) : this.tell(uri, 'watch', { ranges }).catch(() => this.forget(uri));
    });
    await Promise.all(watched);
  }

  private take(params: unknown): void {
    const picture = parsePicture(params);
    const running = picture && this.running.get(picture.uri);
    if (picture !== undefined && running !== undefined) {
      if (picture.source !== running.source) {
        return;
      }
      if (picture.mode === 'stopped' && picture.source === 'simulator') {
        // The last of its documents was closed.
        this.forgetAllOf(running.uri);
        return;
      }
      this.paint(picture, running);
      this.pictures.fire({ document: running.uri, params });
    }
  }

  private paint(picture: Picture, running: Running): void {
    if (running.mode !== picture.mode) {
      running.mode = picture.mode;
      this.showContext();
    }
    for (const editor of editorsOf(running.uri)) {
      // What was painted of another version stands in other places.
      if (editor.document.version === picture.version) {
        this.decorate(editor, this.energised, picture.energised);
        this.decorate(editor, this.ready, picture.ready);
        this.decorate(editor, this.value, placedValues(editor.document, picture.values));
        this.decorate(editor, this.forced, picture.forced.map(held));
        this.decorate(editor, this.error, picture.errors);
      }
    }
    if (picture.source === 'plc') {
      this.status.text = lookText(picture);
      this.status.command = 'rungwise.controller.monitor';
      this.status.show();
      return;
    }
    const icon = picture.mode === 'paused' ? '$(debug-pause)' : '$(play)';
    this.status.text = `${icon} ${vscode.l10n.t('scan {0}', picture.scan)} · ${clock(picture.timeMs)}`;
    this.status.command = 'rungwise.simulation.pause';
    this.status.show();
  }

  /** Paints what is another than before: most of a screen stays as it is from picture to picture. */
  private decorate(editor: vscode.TextEditor, type: vscode.TextEditorDecorationType, painted: readonly Painted[]): void {
    const before = this.painted.get(editor) ?? new Map<vscode.TextEditorDecorationType, string>();
    this.painted.set(editor, before);
    const now = `${editor.document.version} ${JSON.stringify(painted)}`;
    if (before.get(type) !== now) {
      before.set(type, now);
      editor.setDecorations(type, painted.map(toDecoration));
    }
  }

  private clear(document: vscode.Uri): void {
    for (const editor of editorsOf(document)) {
      this.painted.delete(editor);
      const types = [this.energised, this.ready, this.value, this.forced, this.error];
      types.forEach((type) => editor.setDecorations(type, []));
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
    const { program } = this;
    const running = program && this.running.get(this.server.protocolUri(program));
    const mode = running?.source === 'simulator' ? running.mode : undefined;
    void vscode.commands.executeCommand('setContext', 'rungwise.simulation', mode ?? 'stopped');
    if (this.running.size === 0) {
      this.status.hide();
    }
  }
}

/** A file of a program that runs. */
interface Running {
  readonly uri: vscode.Uri;
  mode: Mode;
  readonly source: Source;
  /** All files of the program, where it is simulated. */
  readonly files: readonly string[];
}

interface State {
  readonly mode?: Mode;
  readonly files?: readonly string[];
  readonly values?: readonly { readonly value?: unknown; readonly wired?: boolean }[];
}

function editorsOf(uri: vscode.Uri): readonly vscode.TextEditor[] {
  return vscode.window.visibleTextEditors.filter(({ document }) => document.uri.toString() === uri.toString());
}

/** A piece of text that is painted, or one with words of its own. */
type Painted = PlainRange | { readonly range: PlainRange; readonly text: string } | Picture['errors'][number];

function toDecoration(painted: Painted): vscode.DecorationOptions {
  if (!('range' in painted)) {
    return { range: toRange(painted) };
  }
  const range = toRange(painted.range);
  return 'text' in painted ? { range, renderOptions: { after: { contentText: painted.text } } } : { range, hoverMessage: painted.message };
}

/** Beside the words of a list; in a drawing at the end of the row, lest its columns move. */
function placedValues(document: vscode.TextDocument, values: Picture['values']): { range: PlainRange; text: string }[] {
  if (document.languageId !== 'ladder') {
    return values.map(({ range, value }) => ({ range, text: `= ${value}` }));
  }
  const rows = new Map<number, string[]>();
  for (const { range, value } of values) {
    const row = rows.get(range.start.line) ?? [];
    rows.set(range.start.line, [...row, `${document.getText(toRange(range))} = ${value}`]);
  }
  // In brackets, since hints of the row follow: `[T0 = 3] = 1 s`.
  return [...rows].map(([line, words]) => {
    const { start, end } = document.lineAt(line).range;
    return { range: { start, end }, text: `  [${words.join(', ')}]  ` };
  });
}

/** What is forced, with what the hover says of it. */
function held({ range, value }: Picture['forced'][number]): Painted {
  return { range, message: vscode.l10n.t('forced to {0}', value) };
}

function nameAt({ document, selection }: vscode.TextEditor): string | undefined {
  return deviceAt(document.lineAt(selection.active.line).text, selection.active.character);
}

function toRange({ start, end }: PlainRange): vscode.Range {
  return new vscode.Range(start.line, start.character, end.line, end.character);
}
