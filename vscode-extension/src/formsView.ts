/** "Show Forms of This Rung": a read-only document beside the program, which follows the cursor. */

import * as vscode from 'vscode';
import { FormsFollower, TRANSLATE, formsArgument, type Asking, type FormsPlace } from './forms';
import type { ServerController } from './server';

const SCHEME = 'rungwise-forms';
/** Its name is that of the tab; its ending gives it the colours of the forms, and long rows that are not folded. */
const PAGE = vscode.Uri.from({ scheme: SCHEME, path: '/Rung.rungwise-forms' });
const LANGUAGES = ['ladder', 'plc-il'];

export class FormsView implements vscode.TextDocumentContentProvider, vscode.Disposable {
  private readonly changes = new vscode.EventEmitter<vscode.Uri>();
  readonly onDidChange = this.changes.event;
  private readonly subscriptions: vscode.Disposable[];
  private readonly follower = new FormsFollower((place) => this.ask(place), (page) => this.put(page));
  private page = '';

  constructor(private readonly server: ServerController) {
    this.subscriptions = [
      this.changes,
      vscode.workspace.registerTextDocumentContentProvider(SCHEME, this),
      vscode.commands.registerCommand('rungwise.showForms', () => this.show()),
      vscode.window.onDidChangeTextEditorSelection(({ textEditor }) => this.follow(textEditor)),
      vscode.window.onDidChangeActiveTextEditor((editor) => this.follow(editor)),
      vscode.workspace.onDidChangeTextDocument(({ document }) => {
        const editor = vscode.window.activeTextEditor;
        this.follow(editor?.document === document ? editor : undefined);
      }),
      server.onDidStart(() => this.offer()),
    ];
    this.offer();
  }

  dispose(): void {
    this.follower.stop();
    vscode.Disposable.from(...this.subscriptions).dispose();
  }

  provideTextDocumentContent(): string {
    return this.page;
  }

  /** A server that does not translate has nothing to show, and the command is not to be seen. */
  private offer(): void {
    void vscode.commands.executeCommand('setContext', 'rungwise.translates', this.server.knows(TRANSLATE));
  }

  private async show(): Promise<void> {
    const editor = vscode.window.activeTextEditor;
    if (!this.server.knows(TRANSLATE) || editor === undefined || !LANGUAGES.includes(editor.document.languageId)) {
      return;
    }
    const document = await vscode.workspace.openTextDocument(PAGE);
    await vscode.window.showTextDocument(document, { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true, preview: false });
    this.follow(editor);
  }

  /** Asks for the forms at the cursor of `editor`, if it is that of a program and somebody sees them. */
  private follow(editor: vscode.TextEditor | undefined): void {
    const isShown = vscode.window.visibleTextEditors.some(({ document }) => document.uri.toString() === PAGE.toString());
    if (!isShown) {
      this.follower.stop();
    } else if (editor !== undefined && LANGUAGES.includes(editor.document.languageId)) {
      const { start, end, active, isEmpty } = editor.selection;
      const uri = this.server.protocolUri(editor.document.uri);
      this.follower.moved(isEmpty ? { uri, position: point(active) } : { uri, range: { start: point(start), end: point(end) } });
    }
  }

  private ask(place: FormsPlace): Asking {
    const source = new vscode.CancellationTokenSource();
    const answer = this.server.executeCommand(TRANSLATE, [formsArgument(place)], source.token);
    return { answer, cancel: () => source.cancel() };
  }

  private put(page: string): void {
    if (page !== this.page) {
      this.page = page;
      this.changes.fire(PAGE);
    }
  }
}

const point = ({ line, character }: vscode.Position) => ({ line, character });
