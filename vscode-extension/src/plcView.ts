/** The view "PLC", and the commands for a PLC on a line. Nothing is said to a PLC but what a command asks for. */

import * as vscode from 'vscode';
import { ALARM, alarmRows, alarmsOf, isProgram, NO_PLC, noteAlarm, parseState, plc, PLC_SCHEME, PLC_STATE, raised, rowsOf, statusText, type Alarm, type PlcRow, type PlcState } from './plc';
import type { ServerController } from './server';
import type { SimulationView } from './simulationView';
import type { PlainRange } from './structuralEdits';
import { t } from './words';

const VIEW = 'rungwise.plc';
/** The port of the last connection, for the next one. */
const LAST_PORT = 'rungwise.plc.port';
/** What differs from the PLC is asked for once in each pause of typing. */
const PAUSE_MS = 500;

interface Plan {
  readonly same: boolean;
  readonly bytes: number;
  readonly steps: number;
  /** That of the program in the PLC. */
  readonly sum: string;
  readonly before: string;
  readonly after: string;
  /** What both sides are: drawings, or instruction lists. */
  readonly form?: 'ladder' | 'fx';
  /** What changes in the parameters, a sentence each. */
  readonly parameters?: readonly string[];
}

export class PlcView implements vscode.TreeDataProvider<PlcRow>, vscode.TextDocumentContentProvider, vscode.Disposable {
  private readonly changes = new vscode.EventEmitter<void>();
  readonly onDidChangeTreeData = this.changes.event;
  private readonly documents = new vscode.EventEmitter<vscode.Uri>();
  readonly onDidChange = this.documents.event;
  private readonly status = vscode.window.createStatusBarItem('rungwise.plc', vscode.StatusBarAlignment.Left, 4);
  private readonly drifted = vscode.window.createTextEditorDecorationType({
    isWholeLine: true,
    borderStyle: 'dotted',
    borderWidth: '0 0 0 3px',
    borderColor: new vscode.ThemeColor('editorGutter.modifiedBackground'),
    overviewRulerColor: new vscode.ThemeColor('editorOverviewRuler.modifiedForeground'),
  });
  private readonly subscriptions: vscode.Disposable[];
  private readonly view = vscode.window.createTreeView(VIEW, { treeDataProvider: this });
  private state: PlcState = NO_PLC;
  private alarms: readonly Alarm[] = [];
  private lists = { before: '', after: '' };
  /** What the names of both sides end with. */
  private extension = 'il';
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly server: ServerController,
    private readonly simulation: SimulationView,
    private readonly memory: vscode.Memento,
  ) {
    const register = (command: string, run: () => Promise<unknown>) => vscode.commands.registerCommand(command, () => this.run(run));
    this.status.name = 'Rungwise PLC';
    this.status.command = `${VIEW}.focus`;
    this.subscriptions = [
      this.changes,
      this.documents,
      this.status,
      this.drifted,
      this.view,
      vscode.workspace.registerTextDocumentContentProvider(PLC_SCHEME, this),
      register('rungwise.controller.connect', () => this.connect()),
      register('rungwise.controller.disconnect', () => this.tell('disconnect')),
      register('rungwise.controller.download', () => this.download()),
      register('rungwise.controller.upload', () => this.upload()),
      register('rungwise.controller.verify', () => this.verify()),
      register('rungwise.controller.start', () => this.start()),
      register('rungwise.controller.stop', () => this.tell('stop')),
      register('rungwise.controller.monitor', () => this.monitor()),
      register('rungwise.controller.write', () => this.write()),
      register('rungwise.controller.devices', () => this.showDevices()),
      vscode.commands.registerCommand('rungwise.controller.clearAlarms', () => this.showAlarms(raised(this.alarms))),
      server.onNotification(PLC_STATE, (params) => this.take(params)),
      server.onNotification(ALARM, (params) => this.showAlarms(noteAlarm(this.alarms, params))),
      server.onDidStart(() => this.forget()),
      vscode.workspace.onDidChangeTextDocument(({ document }) => isProgram(document) && this.compareSoon()),
      vscode.window.onDidChangeActiveTextEditor(() => this.compareSoon()),
    ];
    this.show();
  }

  dispose(): void {
    clearTimeout(this.timer);
    vscode.Disposable.from(...this.subscriptions).dispose();
  }

  getTreeItem({ id, label, description, icon, tooltip }: PlcRow): vscode.TreeItem {
    const item = new vscode.TreeItem(label);
    return Object.assign(item, { id, description, iconPath: new vscode.ThemeIcon(icon), contextValue: id, ...(tooltip !== undefined && { tooltip }) });
  }

  getChildren(row?: PlcRow): PlcRow[] {
    const clock = (at: number) => new Date(at).toLocaleTimeString(vscode.env.language);
    return row === undefined ? [...rowsOf(this.state), ...alarmRows(this.alarms, clock)] : [];
  }

  provideTextDocumentContent(uri: vscode.Uri): string {
    return uri.path.startsWith('/before') ? this.lists.before : this.lists.after;
  }

  /** The program in the editor. */
  private program(): vscode.Uri {
    const document = vscode.window.activeTextEditor?.document ?? vscode.window.visibleTextEditors[0]?.document;
    if (document === undefined || !isProgram(document)) {
      throw new Error(t('open the program (.lad or .il) first'));
    }
    return document.uri;
  }

  private async run(run: () => Promise<unknown>): Promise<void> {
    if (!vscode.workspace.isTrusted) {
      void vscode.window.showErrorMessage(t('Rungwise: nothing is done with a PLC in a workspace that is not trusted.'));
      return;
    }
    try {
      await run();
    } catch (error) {
      if (!(error instanceof vscode.CancellationError)) {
        const reason = error instanceof Error ? error.message : String(error);
        void vscode.window.showErrorMessage(`Rungwise: ${reason}`);
      }
    }
  }

  private async tell(verb: string, more: object = {}): Promise<unknown> {
    return this.server.executeCommand(plc(verb), [more]);
  }

  /** The same for what takes long, with a notification that can cancel it. */
  private async long(verb: string, title: string, more: object = {}): Promise<unknown> {
    return this.server.executeShown(title, plc(verb), [more]);
  }

  private async connect(): Promise<void> {
    const shown = vscode.window.activeTextEditor?.document;
    const about = shown !== undefined && isProgram(shown) ? { uri: this.server.protocolUri(shown.uri) } : {};
    const found = (await this.tell('ports', about)) as { ports: { name: string; description: string }[]; project?: string | null };
    const project = found.project ?? undefined;
    const ports = found.ports.filter(({ name }) => name !== project);
    const last = this.memory.get<string>(LAST_PORT);
    const other = { label: t('Another port…'), description: 'tcp://HOST:PORT, /dev/ttyUSB0, COM3' };
    const named = project === undefined ? [] : [{ label: project, description: 'rungwise.toml' }];
    const isListed = last === undefined || last === project || ports.some(({ name }) => name === last);
    const known = isListed ? [] : [{ label: last, description: t('as before') }];
    const items = [...named, ...known, ...ports.map(({ name, description }) => ({ label: name, description })), other];
    const chosen = await vscode.window.showQuickPick(items, { title: t('Port of the PLC') });
    const typed = () => vscode.window.showInputBox({ title: t('Port of the PLC'), value: last ?? 'tcp://127.0.0.1:5551' });
    const port = chosen === other ? await typed() : chosen?.label;
    if (port !== undefined && port.trim() !== '') {
      await this.tell('connect', { port: port.trim() });
      await this.memory.update(LAST_PORT, port.trim());
      this.compareSoon();
    }
  }

  private async plan(verb: string): Promise<{ plan: Plan; uri: string }> {
    const uri = this.server.protocolUri(this.program());
    const plan = (await this.long(verb, t('Reading the program of the PLC'), { uri })) as Plan;
    this.lists = { before: plan.before, after: plan.after };
    this.extension = plan.form === 'ladder' ? 'lad' : 'il';
    for (const side of ['before', 'after']) {
      this.documents.fire(this.sideOf(side));
    }
    return { plan, uri };
  }

  private sideOf(side: string): vscode.Uri {
    return vscode.Uri.from({ scheme: PLC_SCHEME, path: `/${side}.${this.extension}` });
  }

  private async showDifference(): Promise<void> {
    await vscode.commands.executeCommand('vscode.diff', this.sideOf('before'), this.sideOf('after'), t('PLC ↔ editor'), { preview: true });
  }

  private async verify(): Promise<void> {
    const { plan } = await this.plan('verify');
    if (plan.same) {
      void vscode.window.showInformationMessage(t('The program in the PLC is the same.'));
    } else {
      await this.showDifference();
    }
  }

  private async download(): Promise<void> {
    const { plan, uri } = await this.plan('plan');
    if (!plan.same) {
      await this.showDifference();
    }
    const write = t('Download');
    const start = t('Download and Start');
    const stops = t('The PLC stops. What is in it now is kept in .rungwise/backup. After a start the machine may move.');
    const detail = [stops, ...(plan.parameters ?? [])].join('\n');
    const question = t('Write {0} bytes ({1} steps) into the {2} at {3}?', plan.bytes, plan.steps, this.state.title ?? 'PLC', this.state.port ?? '');
    // What Enter chooses is what does nothing.
    const chosen = await vscode.window.showWarningMessage(question, { modal: true, detail }, t('Only Look'), write, start);
    if (chosen !== write && chosen !== start) {
      return;
    }
    const more = { uri, confirmed: true, start: chosen === start, sum: plan.sum };
    const done = (await this.long('download', t('Downloading'), more)) as { written: number; compared: number; mode: string };
    void vscode.window.showInformationMessage(t('{0} bytes written, {1} read back and compared; the PLC is in {2}.', done.written, done.compared, done.mode));
  }

  private async upload(): Promise<void> {
    const { text } = (await this.long('upload', t('Reading the program of the PLC'))) as { text: string };
    const document = await vscode.workspace.openTextDocument({ language: 'plc-il', content: text });
    await vscode.window.showTextDocument(document);
  }

  private async start(): Promise<void> {
    const start = t('Start');
    const chosen = await vscode.window.showWarningMessage(t('Start the PLC?'), { modal: true, detail: t('The machine may move.') }, t('Leave It Stopped'), start);
    if (chosen === start) {
      await this.tell('start', { confirmed: true });
    }
  }

  private async monitor(): Promise<void> {
    const program = this.program();
    if (this.state.monitoring === this.server.protocolUri(program)) {
      this.simulation.unfollow(program);
      await this.tell('unmonitor');
    } else {
      await this.simulation.followPlc(program);
    }
  }

  /** The table of the program's devices with what they are in the PLC, which is monitored for it. */
  private async showDevices(): Promise<void> {
    const program = this.program();
    if (this.state.monitoring !== this.server.protocolUri(program)) {
      await this.simulation.followPlc(program);
    }
    await vscode.commands.executeCommand('rungwise.simulation.panel', program);
  }

  private async write(): Promise<void> {
    const value = t('DEVICE=VALUE: X0=1, D0=25, D2:32=100000');
    const setting = await vscode.window.showInputBox({ title: t('Write into the PLC'), prompt: value });
    const [name, word] = (setting ?? '').split('=', 2);
    if (name !== undefined && word !== undefined) {
      await this.tell('write', { name: name.trim(), value: word.trim() });
    }
  }

  /** A server that was started anew knows no PLC and no alarm. */
  private forget(): void {
    this.take(undefined);
    this.showAlarms([]);
  }

  private showAlarms(alarms: readonly Alarm[]): void {
    this.alarms = alarms;
    const count = raised(alarms).length;
    this.view.badge = count === 0 ? undefined : { value: count, tooltip: t('{0} alarms', count) };
    void vscode.commands.executeCommand('setContext', 'rungwise.plc.alarms', alarms.length > 0);
    this.changes.fire();
  }

  private take(params: unknown): void {
    const before = this.state;
    const state = parseState(params);
    // What was compared stays so until something else is said of it.
    this.state = state.connected && state.match === undefined ? { ...state, ...(before.match && { match: before.match }), drift: before.drift } : state;
    const { reason } = state;
    if (before.connected && reason !== undefined) {
      void vscode.window.showErrorMessage(`Rungwise: ${reason}`);
    }
    if (before.monitoring !== undefined && state.monitoring === undefined) {
      this.simulation.unfollowAll();
    }
    if (state.connected) {
      this.showAlarms(alarmsOf(this.alarms, state.monitoring));
    }
    this.show();
  }

  /** Asks what of the program in the editor is not in the PLC. */
  private compareSoon(): void {
    clearTimeout(this.timer);
    const document = vscode.window.activeTextEditor?.document;
    if (!this.state.connected || document === undefined || !isProgram(document)) {
      return;
    }
    this.timer = setTimeout(() => {
      const uri = this.server.protocolUri(document.uri);
      this.tell('state', { uri }).then((state) => this.take(state), () => undefined);
    }, PAUSE_MS);
  }

  private show(): void {
    this.changes.fire();
    void vscode.commands.executeCommand('setContext', 'rungwise.plc.connected', this.state.connected);
    if (this.state.connected) {
      this.status.text = statusText(this.state);
      this.status.tooltip = `${this.state.title ?? ''} ${this.state.version ?? ''} · ${this.state.port ?? ''}`;
      this.status.show();
    } else {
      this.status.hide();
    }
    for (const editor of vscode.window.visibleTextEditors.filter(({ document }) => isProgram(document))) {
      const drift = editor === vscode.window.activeTextEditor ? this.state.drift : [];
      const hoverMessage = t('This is not so in the PLC.');
      editor.setDecorations(this.drifted, drift.map((range) => ({ range: toRange(range), hoverMessage })));
    }
  }
}

function toRange({ start, end }: PlainRange): vscode.Range {
  return new vscode.Range(start.line, start.character, end.line, end.character);
}
