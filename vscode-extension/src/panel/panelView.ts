/** "I/O Panel": a page beside a program with its inputs, outputs and a timing chart, while it is simulated. */

import * as vscode from 'vscode';
import type { SimulationView } from '../simulationView';
import { t } from '../words';
import { newNonce, pageDocument } from './document';
import { VERBS, type FromPage, type ToPage, type Verb } from './messages';
import { parseMoment, parseRows, type Moment } from './rows';
import type { TraceAnswer } from './traces';

const TYPE = 'rungwise.panel';
const LANGUAGES = ['ladder', 'plc-il'];
/** What a panel may tell a PLC, and how its server calls that. */
const PLC_VERBS: Readonly<Partial<Record<Verb, string>>> = { set: 'write', force: 'hold', release: 'release' };
const STOPPED: Moment = { source: 'simulator', mode: 'stopped', scan: 0, timeMs: 0, edition: 0, branch: 0, values: [] };

/** The panels of all programs. */
export class PanelView implements vscode.WebviewPanelSerializer, vscode.Disposable {
  private readonly panels = new Map<string, Panel>();
  private readonly subscriptions: vscode.Disposable[];

  constructor(
    private readonly extension: vscode.Uri,
    private readonly simulation: SimulationView,
  ) {
    this.subscriptions = [
      vscode.commands.registerCommand('rungwise.simulation.panel', (uri?: unknown) => this.show(uri)),
      vscode.window.registerWebviewPanelSerializer(TYPE, this),
      simulation.onDidPicture(({ document, params }) => this.panels.get(document.toString())?.takePicture(params)),
      simulation.onDidChange((document) => unlessGone(this.panels.get(document.toString())?.simulationChanged())),
    ];
  }

  dispose(): void {
    this.panels.forEach((panel) => panel.view.dispose());
    vscode.Disposable.from(...this.subscriptions).dispose();
  }

  /** Opens a panel again that was open when the window was closed. */
  async deserializeWebviewPanel(view: vscode.WebviewPanel, state: unknown): Promise<void> {
    const program = (state as { program?: unknown } | null)?.program;
    if (typeof program === 'string') {
      this.open(vscode.Uri.parse(program), view);
    } else {
      view.dispose();
    }
  }

  private show(given: unknown): void {
    const uri = given instanceof vscode.Uri ? given : vscode.window.activeTextEditor?.document.uri;
    const program = vscode.workspace.textDocuments.find((document) => document.uri.toString() === uri?.toString());
    if (program === undefined || !LANGUAGES.includes(program.languageId)) {
      void vscode.window.showInformationMessage(t('Rungwise: open a .lad or .il file to simulate it.'));
      return;
    }
    const known = this.panels.get(program.uri.toString());
    if (known !== undefined) {
      known.view.reveal(undefined, true);
      return;
    }
    const title = t('I/O: {0}', program.uri.path.replace(/^.*\//, ''));
    const place = { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true };
    this.open(program.uri, vscode.window.createWebviewPanel(TYPE, title, place, { retainContextWhenHidden: true }));
  }

  private open(program: vscode.Uri, view: vscode.WebviewPanel): void {
    const key = program.toString();
    this.panels.set(key, new Panel(program, view, this.extension, this.simulation));
    view.onDidDispose(() => {
      this.panels.delete(key);
      this.simulation.operate(undefined);
      unlessGone(this.simulation.watchNames(program, []));
    });
  }
}

/** The panel of a program. */
class Panel {
  private names: readonly string[] = [];
  private chosen: readonly string[] = [];
  private edition: number | undefined;
  /** Whether somebody has said that this panel may write into the PLC. */
  private isUnlocked = false;

  constructor(
    private readonly program: vscode.Uri,
    readonly view: vscode.WebviewPanel,
    extension: vscode.Uri,
    private readonly simulation: SimulationView,
  ) {
    const { webview } = view;
    const file = (...path: string[]) => webview.asWebviewUri(vscode.Uri.joinPath(extension, ...path)).toString();
    webview.options = {
      enableScripts: true,
      localResourceRoots: ['dist', 'styles'].map((folder) => vscode.Uri.joinPath(extension, folder)),
    };
    const image = (name: string) => vscode.Uri.joinPath(extension, 'images', name);
    view.iconPath = { light: image('panel-light.svg'), dark: image('panel-dark.svg') };
    webview.onDidReceiveMessage((message: FromPage) => void this.take(message));
    view.onDidChangeViewState(() => this.viewChanged());
    webview.html = pageDocument({
      source: webview.cspSource,
      script: file('dist', 'panel.js'),
      style: file('styles', 'panel.css'),
      title: view.title,
      nonce: newNonce(),
    });
  }

  /** What the server shows, if anybody sees it. */
  takePicture(params: unknown): void {
    const moment = parseMoment(params);
    if (moment === undefined || !this.view.visible) {
      return;
    }
    this.tellPage({ type: 'moment', moment });
    if (moment.edition !== this.edition) {
      // It is read once for each edition, whatever pictures come meanwhile.
      this.edition = moment.edition;
      unlessGone(this.readRows());
    }
  }

  /** It was started, or stopped. */
  async simulationChanged(): Promise<void> {
    if (this.simulation.source(this.program) !== undefined) {
      await this.readRows();
      await this.watch();
    } else {
      this.edition = undefined;
      this.isUnlocked = false;
      this.tellPage({ type: 'moment', moment: STOPPED });
    }
  }

  private viewChanged(): void {
    this.simulation.operate(this.view.active ? this.program : undefined);
    unlessGone(this.watch());
  }

  private tellPage(message: ToPage): void {
    void this.view.webview.postMessage(message);
  }

  private async take(message: FromPage): Promise<void> {
    try {
      await this.obey(message);
    } catch (error) {
      const id = message.type === 'tell' ? message.id : undefined;
      const reason = error instanceof Error ? error.message : String(error);
      if (message.type === 'trace') {
        this.tellPage({ type: 'trace', id: message.id, answer: undefined });
      } else {
        this.tellPage({ type: 'failed', message: reason, ...(id !== undefined && { id }) });
      }
    }
  }

  private async obey(message: FromPage): Promise<void> {
    switch (message.type) {
      case 'ready':
        this.tellPage({ type: 'hello', words: words(), language: vscode.env.language, program: this.program.toString() });
        return this.simulationChanged();
      case 'watch':
        this.names = message.names;
        return this.watch();
      case 'choose':
        this.chosen = message.names;
        return this.readRows();
      case 'tell':
        return this.isPlc ? this.orderPlc(message) : this.order(message);
      case 'trace': {
        const answer = await this.ask('trace', message.question);
        return this.tellPage({ type: 'trace', id: message.id, answer: answer as TraceAnswer });
      }
      case 'export': {
        const { format, names } = message;
        const answer = (await this.ask('export', { format, names })) as { text: string };
        return this.save(format, new TextEncoder().encode(answer.text));
      }
      case 'save':
        return this.save(message.format, Buffer.from(message.base64, 'base64'));
    }
  }

  private async order({ verb, more, id }: Extract<FromPage, { type: 'tell' }>): Promise<void> {
    if (!VERBS.includes(verb)) {
      return;
    }
    if (verb === 'start') {
      await vscode.workspace.openTextDocument(this.program);
      await this.simulation.start(this.program);
    } else if (verb === 'stop') {
      await this.simulation.stop(this.program);
    }
    const moment = verb === 'start' || verb === 'stop' ? await this.state() : parseMoment(await this.simulation.tell(this.program, verb, more));
    this.tellPage({ type: 'moment', moment: moment ?? STOPPED, id });
  }

  private get isPlc(): boolean {
    return this.simulation.source(this.program) === 'plc';
  }

  /** Asks who shows the program. */
  private ask(verb: string, more: object): Promise<unknown> {
    return this.isPlc ? this.simulation.tellPlc(this.program, verb, more) : this.simulation.tell(this.program, verb, more);
  }

  /** Writes into the PLC what the page wants, once a person has agreed that it may. */
  private async orderPlc({ verb, more, id }: Extract<FromPage, { type: 'tell' }>): Promise<void> {
    const own = PLC_VERBS[verb];
    const isDone = own !== undefined && (own === 'release' || (await this.unlock()));
    if (isDone) {
      await this.simulation.tellPlc(this.program, own, more);
    }
    this.tellPage({ type: 'answered', id, isDone });
  }

  private async unlock(): Promise<boolean> {
    if (!this.isUnlocked) {
      const operate = t('Operate');
      const detail = t('The machine may move. What is held is written again with each look; the program may write in between.');
      this.isUnlocked = (await vscode.window.showWarningMessage(t('Let this panel write into the PLC?'), { modal: true, detail }, operate)) === operate;
    }
    return this.isUnlocked;
  }

  private async state(): Promise<Moment | undefined> {
    return this.simulation.isRunning(this.program) ? parseMoment(await this.simulation.tell(this.program, 'state')) : STOPPED;
  }

  private async readRows(): Promise<void> {
    if (this.simulation.source(this.program) === undefined) {
      return;
    }
    const answer = await this.ask('panel', { names: this.chosen });
    const moment = parseMoment(answer);
    this.edition = moment?.edition ?? this.edition;
    this.tellPage({ type: 'rows', rows: parseRows(answer) });
    if (moment !== undefined) {
      this.tellPage({ type: 'moment', moment });
    }
  }

  /** Nothing is watched for a page that is hidden. */
  private async watch(): Promise<void> {
    await this.simulation.watchNames(this.program, this.view.visible ? this.names : []);
  }

  private async save(format: string, bytes: Uint8Array): Promise<void> {
    const name = this.program.path.replace(/^.*\//, '').replace(/\.[^.]*$/, '');
    const defaultUri = vscode.Uri.joinPath(this.program, '..', `${name}.${format}`);
    const chosen = await vscode.window.showSaveDialog({ defaultUri, filters: { [format.toUpperCase()]: [format] } });
    if (chosen !== undefined) {
      await vscode.workspace.fs.writeFile(chosen, bytes);
    }
  }
}

/** A simulation that ends meanwhile answers nothing, and nobody waits for it. */
function unlessGone(work: Promise<void> | undefined): void {
  work?.catch(() => undefined);
}

/** The sentences of the display language; none where it is that of the sources. */
function words(): Record<string, string> {
  return Object.fromEntries(Object.entries(vscode.l10n.bundle ?? {}).filter(([, text]) => typeof text === 'string')) as Record<string, string>;
}
