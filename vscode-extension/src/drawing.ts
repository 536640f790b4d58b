/** Editing a drawing in the editor: structural edits by command, answers to keystrokes, and mending after pastes. */

import * as vscode from 'vscode';
import { joinStretches, linesToMend, rungPlaces, type PlainChange, type Stretch } from './mending';
import { burstEnd, isMadeBy, moved, oneCellLess, owedFor, type Owed } from './owed';
import type { ServerController } from './server';
import { operandOf, parseEditAnswer, STRUCTURAL_EDITS, type EditAnswer, type StructuralEdit } from './structuralEdits';

const LANGUAGE = 'ladder';
const EDIT_REQUEST = 'rungwise/edit';
const TYPED_REQUEST = 'textDocument/onTypeFormatting';
/** A person who types faster than the server answers has stopped after this many answers that came too late. */
const MOST_ATTEMPTS = 8;
/** Keystrokes of one burst that are still answered; what is more comes from no keyboard. */
const MOST_OWED = 256;
/** Cursors that type at the same time. */
const MOST_CURSORS = 16;

/** A note of what is owed, which stays the same one while it moves. */
type Noted = Owed & { readonly id: number };

export class DrawingEditor implements vscode.Disposable {
  /** Edits run one after another: each one must see the text that the one before it left. */
  private queue: Promise<unknown> = Promise.resolve();
  /** The edits that this class is making in a document, to know its own change from one of the person's. */
  private readonly making = new Map<vscode.TextDocument, readonly PlainChange[]>();
  /** Keystrokes that are not yet answered. */
  private readonly owed = new Map<vscode.TextDocument, Noted[]>();
  private lastNote = 0;
  /** Versions to which the editor itself applies an answer to Enter. */
  private readonly enters = new WeakMap<vscode.TextDocument, number>();
  private readonly dirty = new Map<vscode.TextDocument, Stretch>();
  private readonly subscriptions: vscode.Disposable[];

  constructor(
    private readonly server: ServerController,
    private readonly output: vscode.LogOutputChannel,
  ) {
    server.typed = (document, character, next) => this.typed(document, character, next);
    this.subscriptions = [
      ...STRUCTURAL_EDITS.map((edit) =>
        vscode.commands.registerCommand(`rungwise.${edit}`, (args?: unknown) => this.command(edit, args)),
      ),
      vscode.workspace.onDidChangeTextDocument((event) => this.changed(event)),
      vscode.workspace.onDidCloseTextDocument((document) => {
        this.dirty.delete(document);
        this.owed.delete(document);
      }),
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
    this.making.set(document, answer.edits.map((edit) => ({ range: edit.range, text: edit.newText })));
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
      this.making.delete(document);
    }
  }

  /** A keystroke, a deletion, a paste or an accepted completion has moved cells: what it moved is put back. */
  private changed(event: vscode.TextDocumentChangeEvent): void {
    const { document, contentChanges, reason } = event;
    const editor = vscode.window.activeTextEditor;
    if (document.languageId !== LANGUAGE || editor?.document !== document || contentChanges.length === 0) {
      return;
    }
    const changes = contentChanges.map(({ range, text }) => ({ range, text }));
    const { notes, undone } = moved(this.owed.get(document) ?? [], changes);
    const answered = this.enters.get(document) === document.version - 1;
    this.owed.set(document, notes);
    // What undo and redo bring back has been mended before.
    if (reason !== undefined || !mendsWhileTyping(document)) {
      this.owed.delete(document);
      return;
    }
    if (answered || isMadeBy(changes, this.making.get(document) ?? [])) {
      return;
    }
    const rowAt = (line: number) => (line < document.lineCount ? document.lineAt(line).text : '');
    const owed = changes.length <= MOST_CURSORS ? owedFor(changes, rowAt, undone) : undefined;
    if (owed === undefined) {
      const stretch = linesToMend(changes);
      if (stretch !== undefined) {
        this.mark(editor, stretch);
      }
    } else if (notes.length + owed.length <= MOST_OWED) {
      this.owed.set(document, [...notes, ...owed.map((note) => ({ ...note, id: ++this.lastNote }))]);
      owed.forEach(() => void this.enqueue(() => this.answer(editor)));
    }
  }

  /** Gives the drawing the first thing that is owed to it, as a part of the undo step of the keystroke. */
  private async answer(editor: vscode.TextEditor): Promise<void> {
    const { document } = editor;
    try {
      // A person may type on while the server thinks; what is owed has moved then, and the server is asked again.
      for (let attempt = 0; attempt < MOST_ATTEMPTS; attempt++) {
        const [first] = this.owed.get(document) ?? [];
        if (first === undefined || document.isClosed) {
          return;
        }
        const version = document.version;
        const edits = first.kind === 'cells' ? [inserted(document, first)] : await this.answerTo(editor, first);
        if (document.version !== version) {
          continue;
        }
        const undo = { undoStopBefore: false, undoStopAfter: false };
        if (edits.length === 0 || (await this.apply(editor, { edits, selection: undefined }, undo))) {
          this.owed.set(document, (this.owed.get(document) ?? []).filter(({ id }) => id !== first.id));
          return;
        }
      }
      throw new Error('the text did not stand still');
    } catch (error) {
      // What is left is mended as a whole; it would be owed for ever otherwise.
      this.output.debug(`answer: ${String(error)}`);
      const places = (this.owed.get(document) ?? []).map(({ at }) => at);
      this.owed.delete(document);
      if (places.length > 0) {
        const lines = places.map(({ line }) => line);
        this.mark(editor, { first: Math.min(...lines), last: Math.max(...lines), places });
      }
    }
  }

  /** The edits for a typed character. In a burst the cells behind it give way for all but the last one. */
  private async answerTo(editor: vscode.TextEditor, first: Owed): Promise<EditAnswer['edits']> {
    const { document } = editor;
    const end = burstEnd(this.owed.get(document) ?? []);
    if (end === undefined) {
      return this.askTyped(document, first);
    }
    const less = oneCellLess(document.lineAt(end.line).text, end);
    if (less === undefined) {
      this.mark(editor, { first: end.line, last: end.line, places: [end] });
      return [];
    }
    return [{ range: less.range, newText: less.text }];
  }

  /** What the server makes of a typed character. */
  private async askTyped({ uri }: vscode.TextDocument, { at, text }: Owed): Promise<EditAnswer['edits']> {
    const answer = await this.server.request(TYPED_REQUEST, {
      textDocument: { uri: this.server.protocolUri(uri) },
      position: at,
      ch: text,
      options: { tabSize: 8, insertSpaces: true },
    });
    return parseEditAnswer({ edits: answer ?? [] })?.edits ?? [];
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
   * Stands in for on-type formatting by the editor, which would answer some keystrokes only. Enter, which moves no cell
   * sideways, is left to it.
   */
  private async typed(
    document: vscode.TextDocument,
    character: string,
    next: () => vscode.ProviderResult<vscode.TextEdit[]>,
  ): Promise<vscode.TextEdit[] | null | undefined> {
    if (document.languageId === LANGUAGE && character !== '\n') {
      return [];
    }
    const version = document.version;
    const edits = await next();
    if (edits?.length && document.version === version) {
      this.enters.set(document, version);
    }
    return edits;
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

/** The edit that puts cells in. It takes the next character along, for an insertion at the cursor would move that. */
function inserted(document: vscode.TextDocument, { at, text }: Owed): EditAnswer['edits'][number] {
  const [next = ''] = document.lineAt(at.line).text.slice(at.character);
  return { range: { start: at, end: { line: at.line, character: at.character + next.length } }, newText: text + next };
}

function toRange({ start, end }: { start: { line: number; character: number }; end: { line: number; character: number } }): vscode.Range {
  return new vscode.Range(start.line, start.character, end.line, end.character);
}
