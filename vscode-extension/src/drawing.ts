/** Editing a drawing in the editor: structural edits by command, and mending after deletions and pastes. */

import * as vscode from 'vscode';
import { filling, joinStretches, linesToMend, rungPlaces, typedOverSelection, type Stretch } from './mending';
import type { ServerController } from './server';
import { operandOf, parseEditAnswer, STRUCTURAL_EDITS, type EditAnswer, type StructuralEdit } from './structuralEdits';

const LANGUAGE = 'ladder';
const EDIT_REQUEST = 'rungwise/edit';
/** A person who types faster than the server answers has stopped after this many answers that came too late. */
const MOST_ATTEMPTS = 8;

export class DrawingEditor implements vscode.Disposable {
  /** Edits run one after another: each one must see the text that the one before it left. */
  private queue: Promise<unknown> = Promise.resolve();
  /** Documents that are being changed by this class, whose change events are its own. */
  private readonly busy = new Set<vscode.TextDocument>();
  private readonly dirty = new Map<vscode.TextDocument, Stretch>();
  /** Where a character was last typed over a selection, and in which version. */
  private readonly typedOver = new WeakMap<vscode.TextDocument, { version: number; stretch: Stretch; filled: boolean }>();
  private readonly subscriptions: vscode.Disposable[];

  constructor(
    private readonly server: ServerController,
    private readonly output: vscode.LogOutputChannel,
  ) {
    server.typed = (document) => this.typed(document);
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
        const answer = await this.ask(editor.document, edit, editor.selection, operand).catch((error: unknown) => {
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
    { uri, version }: vscode.TextDocument,
    edit: StructuralEdit,
    range: vscode.Range,
    operand?: string,
  ): Promise<EditAnswer> {
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
    if (reason !== undefined || !mendsWhileTyping(document)) {
      return;
    }
    const row = document.lineAt(Math.min(contentChanges[0]?.range.start.line ?? 0, document.lineCount - 1)).text;
    const fill = filling(contentChanges, row);
    const over = typedOverSelection(contentChanges);
    if (over !== undefined) {
      this.typedOver.set(document, { version: document.version, stretch: over, filled: fill !== undefined });
    }
    const stretch = linesToMend(contentChanges) ?? (fill && over);
    if (fill !== undefined) {
      void this.fill(editor, fill).then((done) => done || stretch === undefined || this.mark(editor, stretch));
    } else if (stretch !== undefined) {
      this.mark(editor, stretch);
    }
  }

  /** Puts cells where others went away, at once; gives whether the text was still the same. */
  private fill(editor: vscode.TextEditor, { at, text }: NonNullable<ReturnType<typeof filling>>): Promise<boolean> {
    const range = { start: at, end: at };
    const selection = editor.selections.length === 1 ? { start: at, end: at } : undefined;
    const answer = { edits: [{ range, newText: text }], selection };
    return this.apply(editor, answer, { undoStopBefore: false, undoStopAfter: false });
  }

  /** Marks lines that the server has to mend. */
  private mark(editor: vscode.TextEditor, stretch: Stretch): void {
    const { document } = editor;
    const waiting = this.dirty.has(document);
    this.dirty.set(document, joinStretches(this.dirty.get(document), stretch));
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
        const edits = await this.mendingEdits(document, lines);
        if (document.version === version) {
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

  /** The edits that mend the rungs in a stretch of lines. A rung that cannot be mended is left as it is. */
  private async mendingEdits(document: vscode.TextDocument, stretch: Stretch): Promise<EditAnswer['edits']> {
    const last = Math.min(stretch.last, document.lineCount - 1);
    const places = rungPlaces((line) => document.lineAt(line).text, { ...stretch, last });
    const asked = places.map(({ line, character }) => {
      const at = document.validatePosition(new vscode.Position(line, character));
      return this.ask(document, 'mend', new vscode.Range(at, at)).catch((error: unknown) => {
        this.output.debug(`mend, line ${line + 1}: ${String(error)}`);
        return undefined;
      });
    });
    return (await Promise.all(asked)).flatMap((answer) => answer?.edits ?? []);
  }

  /**
   * Stands in for on-type formatting where that would be misled: after a character that was typed over a selection the
   * drawing is mended. `undefined` leaves it to on-type formatting.
   */
  private async typed(document: vscode.TextDocument): Promise<vscode.TextEdit[] | undefined> {
    const over = this.typedOver.get(document);
    if (over === undefined || over.version !== document.version) {
      return undefined;
    }
    if (over.filled) {
      return [];
    }
    const edits = await this.mendingEdits(document, over.stretch);
    return edits.map((edit) => vscode.TextEdit.replace(toRange(edit.range), edit.newText));
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
