/**
 * Pages that the server writes and the editor shows: the page of a rule or an instruction, the devices of a program, and
 * the state of the extension. They are read-only documents with a scheme of their own.
 */

import { execFile } from 'node:child_process';
import * as vscode from 'vscode';
import { currentLanguage } from './configuration';
import { explainable, pageWord } from './explain';
import { PAGE_SCHEME, pageUri } from './pageUri';
import type { ServerController } from './server';
import { statusPage } from './statusPage';
import type { StatusBar } from './statusBar';

const EXPLAIN_TIMEOUT_MS = 10_000;

const STATUS_URI = vscode.Uri.from({ scheme: PAGE_SCHEME, path: '/Rungwise.md' });

export class Pages implements vscode.TextDocumentContentProvider, vscode.Disposable {
  private readonly changes = new vscode.EventEmitter<vscode.Uri>();
  readonly onDidChange = this.changes.event;
  private readonly subscriptions: vscode.Disposable[];

  constructor(
    private readonly server: ServerController,
    private readonly statusBar: StatusBar,
  ) {
    const register = vscode.commands.registerCommand;
    this.subscriptions = [
      this.changes,
      vscode.workspace.registerTextDocumentContentProvider(PAGE_SCHEME, this),
      register('rungwise.explain', (word?: unknown) => this.explain(word)),
      register('rungwise.showStatus', () => this.showStatus()),
    ];
  }

  dispose(): void {
    vscode.Disposable.from(...this.subscriptions).dispose();
  }

  async provideTextDocumentContent(uri: vscode.Uri): Promise<string> {
    if (uri.path === STATUS_URI.path) {
      return statusPage(this.server.report(), this.statusBar.allPrograms());
    }
    return this.page(pageWord(uri.path));
  }

  /** Shows the page of a word; without one, of what is at the cursor, else it asks. */
  private async explain(given: unknown): Promise<string | undefined> {
    const word = typeof given === 'string' && given !== '' ? given : (atCursor() ?? (await ask()));
    if (word === undefined) {
      return undefined;
    }
    let page: string;
    try {
      page = await this.page(word);
    } catch (error) {
      const reason = error instanceof Error ? error.message : String(error);
      void vscode.window.showWarningMessage(`Rungwise: ${reason}`);
      return undefined;
    }
    await show(pageUri(word));
    return page;
  }

  private async showStatus(): Promise<string> {
    this.changes.fire(STATUS_URI);
    await show(STATUS_URI);
    return statusPage(this.server.report(), this.statusBar.allPrograms());
  }

  private page(word: string): Promise<string> {
    const program = this.server.program();
    if (program === undefined) {
      return Promise.reject(new Error(vscode.l10n.t('the language server is not installed.')));
    }
    return new Promise((resolve, reject) => {
      const args = ['explain', '--lang', currentLanguage(), word];
      execFile(program, args, { timeout: EXPLAIN_TIMEOUT_MS, windowsHide: true }, (error, stdout, stderr) => {
        if (error) {
          reject(new Error(explainable(stderr) ?? error.message));
        } else {
          resolve(stdout);
        }
      });
    });
  }
}

async function show(uri: vscode.Uri): Promise<void> {
  await vscode.commands.executeCommand('vscode.open', uri, { preview: true, viewColumn: vscode.ViewColumn.Beside });
}

/** The code of a diagnostic at the cursor, else the word there. */
function atCursor(): string | undefined {
  const editor = vscode.window.activeTextEditor;
  if (editor === undefined) {
    return undefined;
  }
  const position = editor.selection.active;
  const here = vscode.languages
    .getDiagnostics(editor.document.uri)
    .filter((diagnostic) => diagnostic.source === 'rungwise' && diagnostic.range.contains(position))
    .sort((a, b) => a.severity - b.severity)
    .map(({ code }) => (typeof code === 'object' ? code.value : code))
    .find((code) => typeof code === 'string');
  if (here !== undefined) {
    return here;
  }
  const range = editor.document.getWordRangeAtPosition(position);
  return range && editor.document.getText(range);
}

function ask(): Thenable<string | undefined> {
  return vscode.window.showInputBox({
    title: vscode.l10n.t('Explain a rule or an instruction'),
    prompt: vscode.l10n.t('For example open-circuit, MOV or TON'),
  });
}
