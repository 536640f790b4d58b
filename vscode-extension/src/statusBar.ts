/** The status bar item of the active program. */

import * as vscode from 'vscode';
import { statusItem, type ProgramStatus, type ServerState } from './status';

const LANGUAGES = ['ladder', 'plc-il'];

export class StatusBar implements vscode.Disposable {
  private readonly item = vscode.window.createStatusBarItem('rungwise.status', vscode.StatusBarAlignment.Right, 100);
  private readonly programs = new Map<string, ProgramStatus>();
  private readonly subscriptions: vscode.Disposable[];
  private state: ServerState = 'starting';

  constructor() {
    this.item.name = 'Rungwise';
    this.subscriptions = [
      vscode.window.onDidChangeActiveTextEditor(() => this.refresh()),
      vscode.workspace.onDidCloseTextDocument((document) => this.programs.delete(key(document.uri.toString()))),
    ];
    this.refresh();
  }

  get serverState(): ServerState {
    return this.state;
  }

  get text(): string {
    return this.item.text;
  }

  programStatus(uri: string): ProgramStatus | undefined {
    return this.programs.get(key(uri));
  }

  /** The last status of every open program. */
  allPrograms(): ProgramStatus[] {
    return [...this.programs.values()];
  }

  setServerState(state: ServerState): void {
    this.state = state;
    this.refresh();
  }

  setProgramStatus(status: ProgramStatus): void {
    this.programs.set(key(status.uri), status);
    this.refresh();
  }

  clearPrograms(): void {
    this.programs.clear();
    this.refresh();
  }

  dispose(): void {
    this.item.dispose();
    vscode.Disposable.from(...this.subscriptions).dispose();
  }

  private refresh(): void {
    const document = vscode.window.activeTextEditor?.document;
    if (document === undefined || !LANGUAGES.includes(document.languageId)) {
      // A dead server is worth knowing in every file; all else only beside a program.
      if (this.state !== 'failed') {
        this.item.hide();
        return;
      }
    }
    const shown = statusItem(this.state, document && this.programs.get(key(document.uri.toString())));
    this.item.text = shown.text;
    this.item.tooltip = shown.tooltip;
    this.item.command = shown.command;
    this.item.backgroundColor =
      shown.severity === 'normal' ? undefined : new vscode.ThemeColor(`statusBarItem.${shown.severity}Background`);
    this.item.show();
  }
}

/** VS Code and servers escape URIs differently (`%3A` and `:`), so both go through one parser. */
function key(uri: string): string {
  return vscode.Uri.parse(uri).toString();
}
