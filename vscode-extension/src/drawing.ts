/** Editing a drawing in the editor: structural edits by command, and mending after deletions and pastes. */

import * as vscode from 'vscode';
import { joinLines, linesToMend } from './mending';
import type { ServerController } from './server';
import { operandOf, parseEditAnswer, STRUCTURAL_EDITS, type EditAnswer, type StructuralEdit } from './structuralEdits';

const LANGUAGE = 'ladder';
const EDIT_REQUEST = 'rungwise/edit';
/** A person who types faster than the server answers has stopped after this many answers that came too late. */
const MOST_ATTEMPTS = 8;

type Lines = { first: number; last: number };

export class DrawingEditor implements vscode.Disposable {
  /** Edits run one after another: each one must see the text that the one before it left. */
  private queue: Promise<unknown> = Promise.resolve();
  /** Documents that are being changed by this class, whose change events are its own. */
  private readonly busy = new Set<vscode.TextDocument>();
  private readonly dirty = new Map<vscode.TextDocument, Lines>();
  private readonly subscriptions: vscode.Disposable[];

  constructor(
    private readonly server: ServerController,
    private readonly output: vscode.LogOutputChannel,
  ) {
    this.subscriptions = [
      ...STRUCTURAL_EDITS.map((edit) =>
        vscode.commands.registerCommand(`rungwise.${edit}`, (args?: unknown) => this.command(edit, args)),
      ),
      vscode.workspace.onDidChangeTextDocument((event) => this.changed(event)),
      vscode.workspace.onDidCloseTextDocument((document) => this.dirty.delete(document)),
    ];
  }

  dispose(): void {
    vscode.Disposable.from(...this.subscriptions).dispose();
  }

  /** Runs one structural edit at the cursor as one undo step. Gives whether it was done. */
  private command(edit: StructuralEdit, args: unknown): Promise<boolean> {
    const editor = vscode.window.activeTextEditor;
    if (editor === undefined || editor.document.languageId !== LANGUAGE) {
      void vscode.window.showInformationMessage(vscode.l10n.t('Rungwise: put the cursor into a ladder drawing first.'));
      return Promise.resolve(false);
    }
    return this.enqueue(() => this.run(editor, edit, operandOf(args)));
  }

  private async run(editor: vscode.TextEditor, edit: StructuralEdit, operand: string | undefined): Promise<boolean> {
    try {
      for (let attempt = 0; attempt < MOST_ATTEMPTS; attempt++) {
        const version = editor.document.version;
        const isCurrent = () => editor.document.version === version;
        const answer = await this.ask(editor, edit, editor.selection, operand).catch((error: unknown) => {
          // The server refuses an edit of a text that has changed meanwhile; it is asked again.
          if (isCurrent()) {
            throw error;
          }
          return undefined;
        });
        if (answer !== undefined && isCurrent()) {
          return await this.apply(editor, answer, { undoStopBefore: true, undoStopAfter: true });
        }
      }
      return false;
    } catch (error) {
      const reason = error instanceof Error ? error.message : String(error);
      void vscode.window.showWarningMessage(`Rungwise: ${reason}`);
      return false;
    }
  }

  private async ask(
    editor: vscode.TextEditor,
    edit: StructuralEdit,
    range: vscode.Range,
    operand?: string,
  ): Promise<EditAnswer> {
    const { uri, version } = editor.document;
    const answer = parseEditAnswer(
      await this.server.request(EDIT_REQUEST, {
        textDocument: { uri: this.server.protocolUri(uri), version },
        range: { start: plain(range.start), end: plain(range.end) },
        edit,
        ...(operand === undefined ? {} : { operand }),
      }),
    );
    if (answer === undefined) {
      throw new Error(vscode.l10n.t('the server gave no answer to the edit.'));
    }
    return answer;
  }

  private async apply(
    editor: vscode.TextEditor,
    answer: EditAnswer,
    undo: { undoStopBefore: boolean; undoStopAfter: boolean },
  ): Promise<boolean> {
    const { document } = editor;
    this.busy.add(document);
    try {
      const done =
        answer.edits.length === 0 ||
        (await editor.edit((builder) => {
          for (const edit of answer.edits) {
            builder.replace(toRange(edit.range), edit.newText);
          }
        }, undo));
      if (done && answer.selection !== undefined) {
        const { start, end } = toRange(answer.selection);
        editor.selection = new vscode.Selection(start, end);
        editor.revealRange(editor.selection);
      }
      return done;
    } finally {
      this.busy.delete(document);
    }
  }

  /** A deletion, a paste or an accepted completion has moved cells: what it moved is put back. */
  private changed(event: vscode.TextDocumentChangeEvent): void {
    const { document, contentChanges, reason } = event;
    const editor = vscode.window.activeTextEditor;
    if (document.languageId !== LANGUAGE || editor?.document !== document || this.busy.has(document)) {
      return;
    }
    // What undo and redo bring back has been mended before.
    const lines = reason === undefined && mendsWhileTyping(document) ? linesToMend(contentChanges) : undefined;
    if (lines === undefined) {
      return;
    }
    const waiting = this.dirty.has(document);
    this.dirty.set(document, joinLines(this.dirty.get(document), lines));
    if (!waiting) {
      void this.enqueue(() => this.mend(editor));
    }
  }

  /** Mends the lines that are marked, as a part of the undo step of the change before it. */
  private async mend(editor: vscode.TextEditor): Promise<void> {
    const { document } = editor;
    try {
      for (let attempt = 0; attempt < MOST_ATTEMPTS; attempt++) {
        const lines = this.dirty.get(document);
        if (lines === undefined || document.isClosed) {
          return;
        }
        const version = document.version;
        const range = document.validateRange(new vscode.Range(lines.first, 0, lines.last, Number.MAX_SAFE_INTEGER));
        const answer = await this.ask(editor, 'mend', range).catch((error: unknown) => {
          if (document.version === version) {
            throw error;
          }
          return undefined;
        });
        if (answer !== undefined && document.version === version) {
          const { edits } = answer;
          this.dirty.delete(document);
          // The cursor stays where the person left it, so no selection.
          await this.apply(editor, { edits, selection: undefined }, { undoStopBefore: false, undoStopAfter: false });
          return;
        }
      }
    } catch (error) {
      // A drawing that cannot be mended is left as it was typed; its diagnostics say what is wrong with it.
      this.output.debug(`mend: ${String(error)}`);
    } finally {
      this.dirty.delete(document);
    }
  }

  private enqueue<T>(step: () => Promise<T>): Promise<T> {
    const result = this.queue.then(step);
    this.queue = result.catch(() => undefined);
    return result;
  }
}

/** Mending is on-type formatting for what is not typed, so the same setting switches it. */
function mendsWhileTyping(document: vscode.TextDocument): boolean {
  return vscode.workspace.getConfiguration('editor', document).get<boolean>('formatOnType', false);
}

function plain(position: vscode.Position): { line: number; character: number } {
  return { line: position.line, character: position.character };
}

function toRange({ start, end }: { start: { line: number; character: number }; end: { line: number; character: number } }): vscode.Range {
  return new vscode.Range(start.line, start.character, end.line, end.character);
}
