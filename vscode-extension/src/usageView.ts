/** "Show Devices in Use": the table of devices of a program as a read-only document that follows the program. */

import * as vscode from 'vscode';
import type { ServerController } from './server';
import { usageText } from './usage';

const SCHEME = 'rungwise-usage';
const LANGUAGES = ['ladder', 'plc-il'];
/** A table that changes at every keystroke is unreadable. */
const REFRESH_DELAY_MS = 400;

export class UsageView implements vscode.TextDocumentContentProvider, vscode.Disposable {
  private readonly changes = new vscode.EventEmitter<vscode.Uri>();
  readonly onDidChange = this.changes.event;
  private readonly subscriptions: vscode.Disposable[];
  private timer: NodeJS.Timeout | undefined;

  constructor(private readonly server: ServerController) {
    this.subscriptions = [
      this.changes,
      vscode.workspace.registerTextDocumentContentProvider(SCHEME, this),
      vscode.commands.registerCommand('rungwise.showUsage', (uri?: unknown) => this.show(uri)),
      vscode.workspace.onDidChangeTextDocument(({ document }) => this.programChanged(document)),
    ];
  }

  dispose(): void {
    clearTimeout(this.timer);
    vscode.Disposable.from(...this.subscriptions).dispose();
  }

  async provideTextDocumentContent(uri: vscode.Uri): Promise<string> {
    try {
      return usageText(await this.server.executeCommand('rungwise.usage', [uri.query, { uses: false }]));
    } catch (error) {
      // The document stays open while the server restarts, so the reason stands in it and goes with the next change.
      return error instanceof Error ? error.message : String(error);
    }
  }

  private async show(given: unknown): Promise<vscode.TextDocument | undefined> {
    const uri = given instanceof vscode.Uri ? given : vscode.window.activeTextEditor?.document.uri;
    const program = vscode.workspace.textDocuments.find((document) => document.uri.toString() === uri?.toString());
    if (program === undefined || !LANGUAGES.includes(program.languageId)) {
      void vscode.window.showInformationMessage(vscode.l10n.t('Rungwise: open a .lad or .il file first.'));
      return undefined;
    }
    const view = this.viewOf(program.uri);
    const shown = await vscode.workspace.openTextDocument(view);
    this.changes.fire(view);
    await vscode.window.showTextDocument(shown, { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true, preview: true });
    return shown;
  }

  /** Its address: the name is for the tab, the query says which program. */
  private viewOf(program: vscode.Uri): vscode.Uri {
    const name = program.path.replace(/^.*\//, '');
    return vscode.Uri.from({ scheme: SCHEME, path: `/${name}.usage`, query: this.server.protocolUri(program) });
  }

  private programChanged(document: vscode.TextDocument): void {
    const isProgram = LANGUAGES.includes(document.languageId);
    const views = isProgram ? vscode.workspace.textDocuments.filter(({ uri }) => uri.scheme === SCHEME) : [];
    if (views.length > 0) {
      clearTimeout(this.timer);
      // Programs of one project share their devices, so every open table is read again.
      this.timer = setTimeout(() => views.forEach(({ uri }) => this.changes.fire(uri)), REFRESH_DELAY_MS);
    }
  }
}
