/** Editing a drawing in the editor: structural edits by command, answers to keystrokes, and mending after pastes. */

import * as vscode from 'vscode';
import { areKeystrokes, Burst, isLineEnd, isMadeBy, type Typed } from './burst';
import { joinStretches, linesToMend, MOST_LINES, rungPlaces, type PlainChange, type Stretch } from './mending';
import type { ServerController } from './server';
import {
  operandOf,
  parseEditAnswer,
  placedEdit,
  STRUCTURAL_EDITS,
  type EditAnswer,
  type PlacedEdit,
  type PlainRange,
  type StructuralEdit,
} from './structuralEdits';

const LANGUAGE = 'ladder';
const EDIT_REQUEST = 'rungwise/edit';
const TYPED_REQUEST = 'rungwise/typed';
/** An answer that came too late is asked for again, this many times. */
const MOST_ATTEMPTS = 8;
/** How long the text may be ahead of what the server or the editor knows, in steps of `STEP_MS`. */
const MOST_STEPS = 500;
const STEP_MS = 10;
/** Cursors that type at the same time. */
const MOST_CURSORS = 16;
/** Error code of the protocol for a request about a text that is not the current one. */
const CONTENT_MODIFIED = -32801;

interface UndoStops {
  readonly undoStopBefore: boolean;
  readonly undoStopAfter: boolean;
}

export class DrawingEditor implements vscode.Disposable {
  /** Edits run one after another: each one must see the text that the one before it left. */
  private queue: Promise<unknown> = Promise.resolve();
  /** The edits that this class is making in a document, to know its own change from one of the person's. */
  private readonly making = new Map<vscode.TextDocument, EditAnswer['edits']>();
  /** The burst whose edits are being made. */
  private applying: Burst | undefined;
  /** Keystrokes that are not yet answered, in the rungs in which they were typed. */
  private readonly bursts = new Map<vscode.TextDocument, Burst[]>();
  /** The lines of the cursors before a change, by number: a change does not tell what it replaced. */
  private before: { document: vscode.TextDocument; rows: Map<number, string> } | undefined;
  private readonly dirty = new Map<vscode.TextDocument, Stretch>();
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
      vscode.window.onDidChangeTextEditorSelection(({ textEditor }) => this.remember(textEditor)),
      vscode.workspace.onDidCloseTextDocument((document) => {
        this.dirty.delete(document);
        this.bursts.delete(document);
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
        await this.settle(editor);
        const version = editor.document.version;
        const isCurrent = () => editor.document.version === version;
        const answer = await this.ask(editor.document, edit, editor.selection, operand).catch((error: unknown) => {
          // What was wrong with a text that has changed meanwhile may not be so any more.
          if (isCurrent()) {
            throw error;
          }
          return undefined;
        });
        if (answer !== undefined && isCurrent() && (await this.applyAnswer(editor, answer))) {
          return true;
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
    document: vscode.TextDocument,
    edit: StructuralEdit,
    range: vscode.Range,
    operand?: string,
  ): Promise<EditAnswer> {
    const answer = parseEditAnswer(
      await this.current(EDIT_REQUEST, document, () => ({
        range: { start: plain(range.start), end: plain(range.end) },
        edit,
        ...(operand === undefined ? {} : { operand }),
      })),
    );
    if (answer === undefined) {
      throw new Error(vscode.l10n.t('the server gave no answer to the edit.'));
    }
    return answer;
  }

  /** Makes the edits of an answer as one undo step, and selects what it names. */
  private async applyAnswer(editor: vscode.TextEditor, { edits, selection }: EditAnswer): Promise<boolean> {
    const undo = { undoStopBefore: true, undoStopAfter: true };
    const { document } = editor;
    if (selection === undefined || !vscode.window.visibleTextEditors.includes(editor)) {
      return this.apply(document, edits, undo);
    }
    const { start, end } = toRange(selection);
    if (edits.length === 0) {
      editor.selection = new vscode.Selection(start, end);
    } else if (!(await this.place(editor, placedEdit((line) => document.lineAt(line).text, edits, selection), undo))) {
      return false;
    }
    editor.revealRange(new vscode.Range(start, end));
    return true;
  }

  private async apply(document: vscode.TextDocument, edits: EditAnswer['edits'], undo: UndoStops): Promise<boolean> {
    this.making.set(document, edits);
    const shown = vscode.window.visibleTextEditors.find((other) => other.document === document);
    try {
      return (
        edits.length === 0 ||
        // A person may have gone to another file in a hurry; then it is an undo step of its own.
        (await (shown
          ? shown.edit((builder) => edits.forEach((edit) => builder.replace(toRange(edit.range), edit.newText)), undo)
          : applied(document, edits)))
      );
    } finally {
      this.making.delete(document);
    }
  }

  /** Makes an edit and selects in its text at once: a key that came before a cursor set afterwards would go elsewhere. */
  private async place(editor: vscode.TextEditor, { edit, from, to }: PlacedEdit, undo: UndoStops): Promise<boolean> {
    const text = edit.newText;
    // A snippet brings its cursor along.
    const snippet = new vscode.SnippetString().appendText(text.slice(0, from));
    snippet.appendPlaceholder(text.slice(from, to), 0).appendText(text.slice(to));
    this.making.set(editor.document, [edit]);
    try {
      return await editor.insertSnippet(snippet, toRange(edit.range), undo);
    } finally {
      this.making.delete(editor.document);
    }
  }

  /** A keystroke, a deletion, a paste or an accepted completion has moved cells: what it moved is put back. */
  private changed(event: vscode.TextDocumentChangeEvent): void {
    const { document, contentChanges, reason } = event;
    const editor = vscode.window.activeTextEditor;
    if (document.languageId !== LANGUAGE || contentChanges.length === 0) {
      return;
    }
    const changes = contentChanges.map(({ range, text }) => ({ range, text }));
    if (isMadeBy(changes, this.making.get(document) ?? [])) {
      this.made(document, changes);
      return;
    }
    const follows = editor?.document === document && mendsWhileTyping(document);
    // What undo and redo bring back has been mended before.
    if (reason !== undefined) {
      this.bursts.delete(document);
    } else if (!follows) {
      this.dropped(document, changes);
    } else if (changes.length <= MOST_CURSORS && areKeystrokes(changes)) {
      this.typed(editor, changes);
    } else {
      const unanswered = this.dropped(document, changes);
      const stretch = linesToMend(changes) ?? unanswered;
      if (stretch !== undefined) {
        this.mark(editor, unanswered === undefined ? stretch : joinStretches(unanswered, stretch));
      }
    }
  }

  /** The editor has made edits of ours: the lines of a burst are as it wanted them, or are no longer what it thinks. */
  private made(document: vscode.TextDocument, changes: readonly PlainChange[]): void {
    const done = this.bursts.get(document)?.find((burst) => burst === this.applying);
    const more = changes.reduce((sum, change) => sum + addedLines(change), 0);
    if (done === undefined) {
      this.dropped(document, changes);
      return;
    }
    done.applied();
    for (const burst of this.bursts.get(document) ?? []) {
      burst.first += burst.first > done.first ? more : 0;
    }
  }

  /** Notes keystrokes, each in the burst of its rung. */
  private typed(editor: vscode.TextEditor, changes: readonly PlainChange[]): void {
    const { document } = editor;
    const bursts = this.bursts.get(document) ?? [];
    this.bursts.set(document, bursts);
    const keystrokes = changes.map((change) => ({ ...change, removed: this.replaced(document, change) }));
    const added = keystrokes.reduce((sum, key) => sum + addedLines(key), 0);
    const left = new Set(keystrokes);
    const take = (burst: { has(line: number): boolean }) => {
      const own = [...left].filter(({ range }) => burst.has(range.start.line));
      own.forEach((key) => left.delete(key));
      return own;
    };
    for (const burst of bursts) {
      const own = take(burst);
      if (own.length > 0) {
        burst.add(own);
      } else if (keystrokes[0]!.range.start.line < burst.first) {
        burst.first += added;
      }
    }
    for (const key of left) {
      const { first, last } = rungLines(document, key.range.start.line, added, bursts);
      const own = take({ has: (line) => first <= line && line <= last });
      const text = Array.from({ length: last - first + 1 }, (_, index) => document.lineAt(first + index).text).join('\n');
      bursts.push(new Burst(first, text, own));
    }
    void this.enqueue(() => this.settle(editor));
  }

  /** Answers all that was typed, as a part of the undo step of the last keystroke. */
  private async settle(editor: vscode.TextEditor): Promise<void> {
    const { document } = editor;
    for (;;) {
      const [burst] = this.bursts.get(document) ?? [];
      if (burst === undefined) {
        return;
      }
      const stands = () => this.bursts.get(document)?.includes(burst) === true;
      try {
        await this.settleBurst(editor, burst, stands);
      } catch (error) {
        // Its rung is mended as a whole instead.
        this.output.debug(`typing: ${String(error)}`);
        if (stands() && !document.isClosed) {
          this.mark(editor, stretchOf(burst));
        }
      }
      const others = (this.bursts.get(document) ?? []).filter((other) => other !== burst);
      if (others.length > 0) {
        this.bursts.set(document, others);
      } else {
        this.bursts.delete(document);
      }
    }
  }

  /** Answers what was typed in one rung, until nothing more comes. */
  private async settleBurst(editor: vscode.TextEditor, burst: Burst, stands: () => boolean): Promise<void> {
    const { document } = editor;
    for (let step = 0; step < MOST_STEPS && stands(); step++) {
      while (!burst.isAnswered && stands()) {
        await burst.answerNext((typed) => this.askTyped(document, burst, typed));
        step = 0;
      }
      const edits = stands() ? burst.edits() : [];
      if (edits.length === 0) {
        return;
      }
      if (!(await this.applyBurst(editor, burst, edits)) && burst.isAnswered) {
        // The editor has a keystroke of which no event has come yet.
        await pause();
      }
    }
    if (stands()) {
      throw new Error('the text did not stand still');
    }
  }

  /** Makes the edits of a burst, as a part of the undo step of the last keystroke. */
  private async applyBurst(editor: vscode.TextEditor, burst: Burst, edits: EditAnswer['edits']): Promise<boolean> {
    const undo = { undoStopBefore: false, undoStopAfter: false };
    this.applying = burst;
    try {
      const placed = burst.placed();
      return await (placed === undefined ? this.apply(editor.document, edits, undo) : this.place(editor, placed, undo));
    } finally {
      this.applying = undefined;
    }
  }

  /** What the server makes of a character typed into lines of a burst; line 0 is its first one. */
  private async askTyped(
    document: vscode.TextDocument,
    burst: Burst,
    { text, position, character }: Typed,
  ): Promise<EditAnswer['edits']> {
    let { first } = burst;
    const answer = await this.current(TYPED_REQUEST, document, () => {
      const { lineCount } = burst;
      ({ first } = burst);
      const isLast = first + lineCount >= document.lineCount;
      return {
        lines: { first, end: first + lineCount, text: isLast ? text : `${text}\n` },
        position: { line: first + position.line, character: position.character },
        ch: character,
      };
    });
    const edits = parseEditAnswer({ edits: answer ?? [] })?.edits ?? [];
    return edits.map(({ range, newText }) => ({ range: lowered(range, first), newText }));
  }

  /** Sends a request about a document as it is now, again while the server has not got its last change yet. */
  private async current(method: string, document: vscode.TextDocument, more: () => object): Promise<unknown> {
    for (let step = 0; ; step++) {
      const textDocument = { uri: this.server.protocolUri(document.uri), version: document.version };
      try {
        return await this.server.request(method, { textDocument, ...more() });
      } catch (error) {
        if ((error as { code?: unknown }).code !== CONTENT_MODIFIED || step >= MOST_STEPS) {
          throw error;
        }
        await pause();
      }
    }
  }

  /** Forgets the bursts in whose lines something else has changed, and gives their lines; the others move. */
  private dropped(document: vscode.TextDocument, changes: readonly PlainChange[]): Stretch | undefined {
    let unanswered: Stretch | undefined;
    const left: Burst[] = [];
    for (const burst of this.bursts.get(document) ?? []) {
      const end = burst.first + burst.lineCount;
      if (changes.some(({ range }) => range.start.line < end && burst.first <= range.end.line)) {
        unanswered = joinStretches(unanswered, stretchOf(burst));
      } else {
        const above = changes.filter(({ range }) => range.end.line < burst.first);
        burst.first += above.reduce((sum, change) => sum + addedLines(change), 0);
        left.push(burst);
      }
    }
    this.bursts.set(document, left);
    return unanswered;
  }

  /** Keeps the lines of the cursors, for the next change. */
  private remember({ document, selections }: vscode.TextEditor): void {
    if (document.languageId === LANGUAGE && selections.length <= MOST_CURSORS) {
      const lines = selections.map(({ active }) => active.line).filter((line) => line < document.lineCount);
      this.before = { document, rows: new Map(lines.map((line) => [line, document.lineAt(line).text])) };
    }
  }

  /** The text that a change in one line has replaced, if the line is known as it was. */
  private replaced(document: vscode.TextDocument, { range: { start, end }, text }: PlainChange): string | undefined {
    const row = this.before?.document === document ? this.before.rows.get(start.line) : undefined;
    const now = isLineEnd(text) ? undefined : document.lineAt(start.line).text;
    const isBefore = row !== undefined && row.slice(0, start.character) + text + row.slice(end.character) === now;
    return isBefore ? row.slice(start.character, end.character) : undefined;
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
        await this.settle(editor);
        const lines = this.dirty.get(document);
        if (lines === undefined || document.isClosed) {
          return;
        }
        const version = document.version;
        const edits = await this.mendingEdits(document, lines);
        if (document.version === version) {
          this.dirty.delete(document);
          // The cursor stays where the person left it, so no selection.
          await this.apply(document, edits, { undoStopBefore: false, undoStopAfter: false });
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

/** Makes edits of a document that no editor shows. */
function applied(document: vscode.TextDocument, edits: EditAnswer['edits']): Thenable<boolean> {
  const all = new vscode.WorkspaceEdit();
  edits.forEach((edit) => all.replace(document.uri, toRange(edit.range), edit.newText));
  return vscode.workspace.applyEdit(all);
}

function lowered({ start, end }: PlainRange, by: number): PlainRange {
  return {
    start: { line: start.line - by, character: start.character },
    end: { line: end.line - by, character: end.character },
  };
}

function pause(): Promise<void> {
  return new Promise((resolve) => setTimeout(resolve, STEP_MS));
}

/** How many lines a change adds. */
function addedLines({ range, text }: PlainChange): number {
  return text.split(/\r\n|\r|\n/).length - 1 - (range.end.line - range.start.line);
}

/**
 * The lines without a blank one around a line, those that a change has added to it, and the one below, where the answer to
 * Enter may put others; no line of another burst.
 */
function rungLines(
  document: vscode.TextDocument,
  line: number,
  added: number,
  bursts: readonly Burst[],
): { first: number; last: number } {
  let [first, last] = [line, line + added];
  const isOpen = (at: number) =>
    at >= 0 && at < document.lineCount && !document.lineAt(at).isEmptyOrWhitespace && !bursts.some((burst) => burst.has(at));
  while (last - first < MOST_LINES && isOpen(first - 1)) {
    first -= 1;
  }
  while (last - first < MOST_LINES && isOpen(last + 1)) {
    last += 1;
  }
  const isFree = last + 1 < document.lineCount && !bursts.some((burst) => burst.has(last + 1));
  return { first, last: isFree ? last + 1 : last };
}

function stretchOf({ first, lineCount }: Burst): Stretch {
  return { first, last: first + lineCount - 1, places: [] };
}

function toRange({ start, end }: { start: { line: number; character: number }; end: { line: number; character: number } }): vscode.Range {
  return new vscode.Range(start.line, start.character, end.line, end.character);
}
