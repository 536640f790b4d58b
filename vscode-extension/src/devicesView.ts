/** The view "Devices": a tree of the devices in use of the program that is looked at, or of its project. */

import * as vscode from 'vscode';
import { DeviceList, itemOf, usesOf, type DeviceNode, type DeviceUse } from './devices';
import type { ServerController } from './server';
import { t } from './words';

const VIEW = 'rungwise.devices';
const LANGUAGES = ['ladder', 'plc-il'];
/** The server is asked once in each pause of typing. */
const PAUSE_MS = 400;
/** The server reads changed files of a project in the background. */
const READ_MS = 1_500;
const STATES = {
  leaf: vscode.TreeItemCollapsibleState.None,
  closed: vscode.TreeItemCollapsibleState.Collapsed,
  open: vscode.TreeItemCollapsibleState.Expanded,
};

export class DevicesView implements vscode.TreeDataProvider<DeviceNode>, vscode.Disposable {
  private readonly changes = new vscode.EventEmitter<void>();
  readonly onDidChangeTreeData = this.changes.event;
  private readonly view: vscode.TreeView<DeviceNode>;
  private readonly subscriptions: vscode.Disposable[];
  private timer: NodeJS.Timeout | undefined;
  private asking: vscode.CancellationTokenSource | undefined;
  private program: vscode.TextDocument | undefined;
  private list: DeviceList | undefined;
  private filter = '';
  /** Whether something has changed since the list was asked for. Nobody asks while the view is hidden. */
  private isStale = true;

  constructor(private readonly server: ServerController) {
    this.view = vscode.window.createTreeView(VIEW, { treeDataProvider: this, showCollapseAll: true });
    const files = vscode.workspace.createFileSystemWatcher('**/{rungwise.toml,*.lad,*.il,*.csv,*.tsv}');
    const read = () => this.schedule(READ_MS);
    const register = vscode.commands.registerCommand;
    this.subscriptions = [
      this.changes,
      this.view,
      files,
      files.onDidCreate(read),
      files.onDidChange(read),
      files.onDidDelete(read),
      this.view.onDidChangeVisibility(() => this.isStale && this.schedule(0)),
      server.onDidStart(() => this.schedule(0)),
      vscode.window.onDidChangeActiveTextEditor(() => this.follow()),
      vscode.workspace.onDidCloseTextDocument(() => this.follow()),
      vscode.workspace.onDidChangeTextDocument(({ document }) => isProgram(document) && this.schedule(PAUSE_MS)),
      register('rungwise.filterDevices', () => this.askFilter()),
      register('rungwise.clearDeviceFilter', () => this.setFilter('')),
      register('rungwise.openUse', (use: DeviceUse) => openUse(use)),
    ];
    void vscode.commands.executeCommand('setContext', 'rungwise.active', true);
    this.follow();
  }

  dispose(): void {
    clearTimeout(this.timer);
    this.asking?.cancel();
    vscode.Disposable.from(...this.subscriptions).dispose();
  }

  getTreeItem(node: DeviceNode): vscode.TreeItem {
    const { id, label, description, tooltip, icon, state } = itemOf(node, this.filter);
    const item = new vscode.TreeItem(label, STATES[state]);
    const colour = node.type === 'gap' ? new vscode.ThemeColor('disabledForeground') : undefined;
    Object.assign(item, { id, description, tooltip, iconPath: new vscode.ThemeIcon(icon, colour), contextValue: node.type });
    if (node.type === 'use') {
      item.command = { command: 'rungwise.openUse', title: t('Go to the Place'), arguments: [node.use] };
    }
    return item;
  }

  async getChildren(node?: DeviceNode): Promise<DeviceNode[]> {
    if (node === undefined) {
      return this.list?.roots(this.filter) ?? [];
    }
    switch (node.type) {
      case 'kind':
        return this.list?.children(node, this.filter) ?? [];
      case 'device':
        return this.uses(node.name);
      default:
        return [];
    }
  }

  /** The uses are asked for when a device is opened: a program may have a hundred thousand of them. */
  private async uses(device: string): Promise<DeviceNode[]> {
    if (this.program === undefined) {
      return [];
    }
    const wish = { text: false, devices: [device] };
    // Without a server the list says so; a device that stays empty needs no words of its own.
    const ask = this.server.executeCommand('rungwise.usage', [this.server.protocolUri(this.program.uri), wish]);
    return ask.then((answer) => usesOf(answer, device), () => []);
  }

  /** Turns to the program in the editor; while something else is there, to the one before. */
  private follow(): void {
    const shown = vscode.window.activeTextEditor?.document;
    const isOpen = this.program !== undefined && !this.program.isClosed;
    const program = shown !== undefined && isProgram(shown) ? shown : isOpen ? this.program : undefined;
    if (program !== this.program) {
      this.program = program;
      // Nothing is known of it before its list is there.
      void vscode.commands.executeCommand('setContext', 'rungwise.devices.listed', false);
      this.schedule(0);
    }
  }

  private schedule(delayMs: number): void {
    this.isStale = true;
    clearTimeout(this.timer);
    if (this.view.visible) {
      this.timer = setTimeout(() => void this.refresh(), delayMs);
    }
  }

  private async refresh(): Promise<void> {
    this.asking?.cancel();
    const asking = new vscode.CancellationTokenSource();
    this.asking = asking;
    this.isStale = false;
    const { program } = this;
    try {
      this.list = program && (await this.ask(program, asking.token));
      this.say();
    } catch (error) {
      if (asking.token.isCancellationRequested) {
        return;
      }
      this.list = undefined;
      this.view.message = this.server.isStarting ? '' : error instanceof Error ? error.message : String(error);
    }
    if (!asking.token.isCancellationRequested) {
      void vscode.commands.executeCommand('setContext', 'rungwise.devices.program', program !== undefined);
      void vscode.commands.executeCommand('setContext', 'rungwise.devices.listed', this.list !== undefined);
      this.changes.fire();
    }
  }

  private async ask(program: vscode.TextDocument, token: vscode.CancellationToken): Promise<DeviceList | undefined> {
    const wish = { text: false, uses: false };
    const answer = await this.server.executeCommand('rungwise.usage', [this.server.protocolUri(program.uri), wish], token);
    if (token.isCancellationRequested) {
      throw new vscode.CancellationError();
    }
    return DeviceList.of(answer);
  }

  /** Says above the tree what it is of. */
  private say(): void {
    const file = this.program?.uri.path.replace(/^.*\//, '') ?? '';
    this.view.description = (this.list?.files ?? 0) > 1 ? t('{0} and its project', file) : file;
    const { all, matching } = this.list?.count(this.filter) ?? { all: 0, matching: 0 };
    this.view.message = this.filter === '' ? '' : t('"{0}": {1} of {2} devices', this.filter, matching, all);
  }

  /** Asks for words that devices must have; the tree follows while they are typed. */
  private askFilter(): void {
    const before = this.filter;
    const box = vscode.window.createInputBox();
    box.title = t('Filter Devices');
    box.placeholder = t('Part of a name, a symbol or a comment');
    box.value = before;
    box.onDidChangeValue((value) => this.setFilter(value));
    let isAccepted = false;
    box.onDidAccept(() => {
      isAccepted = true;
      box.hide();
    });
    box.onDidHide(() => {
      this.setFilter(isAccepted ? box.value : before);
      box.dispose();
    });
    void vscode.commands.executeCommand(`${VIEW}.focus`).then(() => box.show());
  }

  private setFilter(words: string): void {
    const filter = words.trim();
    if (filter !== this.filter) {
      this.filter = filter;
      void vscode.commands.executeCommand('setContext', 'rungwise.devices.filtered', filter !== '');
      this.say();
      this.changes.fire();
    }
  }
}

function isProgram(document: vscode.TextDocument): boolean {
  return LANGUAGES.includes(document.languageId) && ['file', 'untitled'].includes(document.uri.scheme);
}

/** Puts the cursor on a use. */
async function openUse(use: DeviceUse): Promise<void> {
  const document = await vscode.workspace.openTextDocument(vscode.Uri.parse(use.uri));
  const line = document.lineAt(Math.min(use.line, document.lineCount) - 1);
  const column = [...line.text].slice(0, use.column - 1).join('').length;
  const at = new vscode.Position(line.lineNumber, column);
  const selection = document.getWordRangeAtPosition(at) ?? new vscode.Range(at, at);
  await vscode.window.showTextDocument(document, { selection, preview: true });
}
