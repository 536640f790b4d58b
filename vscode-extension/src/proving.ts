/** "Prove Equal to Another Program": picks the other one, and shows the answer as a page beside the program. */

import * as vscode from 'vscode';
import { PROVE, proofPage, selectedPair } from './proof';
import type { ServerController } from './server';
import { t } from './words';

const SCHEME = 'rungwise-proof';
/** Its name is that of the tab. */
const PAGE = vscode.Uri.from({ scheme: SCHEME, path: '/Proof.md' });
/** Programs that are offered; of more, the others can be opened. */
const OFFERED = 500;

export class ProofView implements vscode.TextDocumentContentProvider, vscode.Disposable {
  private readonly changes = new vscode.EventEmitter<vscode.Uri>();
  readonly onDidChange = this.changes.event;
  private readonly subscriptions: vscode.Disposable[];
  private page = '';

  constructor(private readonly server: ServerController) {
    this.subscriptions = [
      this.changes,
      vscode.workspace.registerTextDocumentContentProvider(SCHEME, this),
      vscode.commands.registerCommand('rungwise.proveEqual', (given?: unknown, selected?: unknown) => this.prove(given, selected)),
      server.onDidStart(() => this.offer()),
    ];
    this.offer();
  }

  dispose(): void {
    vscode.Disposable.from(...this.subscriptions).dispose();
  }

  provideTextDocumentContent(): string {
    return this.page;
  }

  /** The command is not to be seen with a server that does not prove. */
  private offer(): void {
    void vscode.commands.executeCommand('setContext', 'rungwise.proves', this.server.knows(PROVE));
  }

  /** Compares two selected files, or a program with one that is picked. Returns the page, for callers in code. */
  private async prove(given: unknown, selected: unknown): Promise<string | undefined> {
    const own = given instanceof vscode.Uri ? given : vscode.window.activeTextEditor?.document.uri;
    const pair = selectedPair<vscode.Uri>(selected);
    const left = pair?.[0] ?? own;
    const right = pair?.[1] ?? (selected instanceof vscode.Uri ? selected : left && (await pick(left)));
    if (left === undefined || right === undefined) {
      return undefined;
    }
    try {
      const [uri, other] = [this.server.protocolUri(left), this.server.protocolUri(right)];
      const page = proofPage(await this.server.executeCommand(PROVE, [{ uri, with: other }]));
      if (page !== undefined) {
        await this.show(page);
      }
      return page;
    } catch (error) {
      const reason = error instanceof Error ? error.message : String(error);
      void vscode.window.showErrorMessage(t('Rungwise: nothing was proved: {0}', reason));
      return undefined;
    }
  }

  private async show(page: string): Promise<void> {
    this.page = page;
    this.changes.fire(PAGE);
    const document = await vscode.workspace.openTextDocument(PAGE);
    await vscode.window.showTextDocument(document, { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true, preview: true });
  }
}

/** Another program of the workspace, or any file. */
async function pick(left: vscode.Uri): Promise<vscode.Uri | undefined> {
  const found = await vscode.workspace.findFiles('**/*.{lad,il}', undefined, OFFERED);
  const others = found.filter((uri) => uri.toString() !== left.toString());
  const items = others.map((uri) => ({ label: vscode.workspace.asRelativePath(uri), uri }));
  items.sort((one, other) => one.label.localeCompare(other.label));
  const browse = { label: t('Open Another File…'), uri: undefined };
  const title = t('Program to Compare With');
  const choice = await vscode.window.showQuickPick([...items, browse], { title });
  if (choice !== browse) {
    return choice?.uri;
  }
  const opened = await vscode.window.showOpenDialog({ title, filters: { Rungwise: ['lad', 'il'] } });
  return opened?.[0];
}
