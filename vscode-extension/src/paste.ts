/**
 * Pasting into a drawing as one undo step: what the paste pushes aside is put back by the edit that pastes.
 *
 * An editor that has no say of extensions in pastes (before 1.97) pastes by itself, and the drawing is mended afterwards,
 * which is an undo step of its own.
 */

import * as vscode from 'vscode';
import { isMadeBy, type PlainEdit } from './burst';
import type { PlainChange } from './mending';
import { Preview } from './preview';

const TEXT = 'text/plain';
/** What the editor notes beside a text that it copies: lines without a selection, a text for each cursor. */
const EDITOR_DATA = 'vscode-editor-data';

/** What of the editor's API is newer than the oldest editor that the extension runs in. */
interface PasteApi {
  readonly DocumentPasteEdit: new (insertText: string, title: string, kind: PasteKind) => PasteEdit;
  readonly DocumentDropOrPasteEditKind: { readonly Text: PasteKind };
  readonly languages: {
    registerDocumentPasteEditProvider?(
      selector: vscode.DocumentSelector,
      provider: DrawingPaste,
      metadata: { readonly providedPasteEditKinds: readonly PasteKind[]; readonly pasteMimeTypes: readonly string[] },
    ): vscode.Disposable;
  };
}

interface PasteKind {
  append(...parts: string[]): PasteKind;
}

interface PasteEdit {
  additionalEdit?: vscode.WorkspaceEdit;
}

/** What a paste needs of the editor of drawings. */
export interface PasteHost {
  /** Answers what was typed; resolves when the text is as it is to be. */
  settled(document: vscode.TextDocument): Promise<void>;
  /** The edits, in the text with a change, that keep the drawing whole; `undefined` where the change moves nothing. */
  edits(document: vscode.TextDocument, change: PlainChange, preview: Preview): Promise<readonly PlainEdit[] | undefined>;
}

export class DrawingPaste {
  /** The paste that the editor was given, and the plain one that a person may choose instead of it. */
  private given: { document: vscode.TextDocument; edit: PlainEdit; plain: PlainEdit; isMade: boolean } | undefined;
  private kind: PasteKind | undefined;

  constructor(
    private readonly host: PasteHost,
    private readonly output: vscode.LogOutputChannel,
  ) {}

  /** Takes pastes of a language, where the editor lets it. */
  register(language: string): vscode.Disposable {
    const { languages, DocumentDropOrPasteEditKind } = vscode as unknown as Partial<PasteApi>;
    if (languages?.registerDocumentPasteEditProvider === undefined || DocumentDropOrPasteEditKind === undefined) {
      return new vscode.Disposable(() => undefined);
    }
    this.kind = DocumentDropOrPasteEditKind.Text.append('rungwise', 'drawing');
    const metadata = { providedPasteEditKinds: [this.kind], pasteMimeTypes: [TEXT] };
    return languages.registerDocumentPasteEditProvider(language, this, metadata);
  }

  /** Answers the editor: nothing for a paste that is best made plainly. */
  async provideDocumentPasteEdits(
    document: vscode.TextDocument,
    ranges: readonly vscode.Range[],
    transfer: vscode.DataTransfer,
  ): Promise<PasteEdit[] | undefined> {
    const [range] = ranges;
    const text = (await transfer.get(TEXT)?.asString()) ?? '';
    const data = (await transfer.get(EDITOR_DATA)?.asString()) ?? '';
    // Whole lines and a text for each cursor go where the editor knows better.
    if (range === undefined || ranges.length > 1 || text === '' || isSpecial(data)) {
      return undefined;
    }
    try {
      return await this.provide(document, range, text);
    } catch (error) {
      this.output.debug(`paste: ${String(error)}`);
      return undefined;
    }
  }

  /** Whether a change is a paste that was made here, or the plain one that a person has chosen instead of it. */
  takes(document: vscode.TextDocument, changes: readonly PlainChange[], isUndone: boolean): boolean {
    const { given } = this;
    if (given?.document !== document || isUndone) {
      return false;
    }
    if (!given.isMade && isMadeBy(changes, [given.edit])) {
      given.isMade = true;
      return true;
    }
    this.given = undefined;
    // One character may as well be typed.
    return given.isMade && given.plain.newText.length > 1 && isMadeBy(changes, [given.plain]);
  }

  private async provide(
    document: vscode.TextDocument,
    range: vscode.Range,
    text: string,
  ): Promise<PasteEdit[] | undefined> {
    const { version } = document;
    await this.host.settled(document);
    if (document.version !== version) {
      // The editor drops a paste when the text changes meanwhile, here by the answer to what was typed before it.
      const editor = vscode.window.activeTextEditor;
      if (editor?.document === document) {
        await editor.edit((builder) => builder.replace(editor.selection, text));
      }
      return undefined;
    }
    const change = { range, text };
    const preview = new Preview({ lineCount: document.lineCount, lineAt: (line) => document.lineAt(line).text }, change);
    const edits = await this.host.edits(document, change, preview);
    const api = vscode as unknown as PasteApi;
    if (edits === undefined || edits.length === 0 || document.version !== version || this.kind === undefined) {
      return undefined;
    }
    const edit = preview.joined(edits);
    this.given = { document, edit, plain: { range, newText: text }, isMade: false };
    const title = vscode.l10n.t('Paste and keep the drawing whole');
    const paste = new api.DocumentPasteEdit('', title, this.kind);
    paste.additionalEdit = new vscode.WorkspaceEdit();
    paste.additionalEdit.set(document.uri, [asSnippet(edit)]);
    return [paste];
  }
}

/** A snippet brings the cursor along. */
function asSnippet({ range: { start, end }, newText, cursor }: ReturnType<Preview['joined']>): vscode.SnippetTextEdit {
  const snippet = new vscode.SnippetString().appendText(newText.slice(0, cursor));
  snippet.appendTabstop(0).appendText(newText.slice(cursor));
  const edit = new vscode.SnippetTextEdit(new vscode.Range(start.line, start.character, end.line, end.character), snippet);
  // Else the editor would indent the rows by what stands before the first one.
  return Object.assign(edit, { keepWhitespace: true });
}

function isSpecial(data: string): boolean {
  try {
    const { isFromEmptySelection, multicursorText } = JSON.parse(data) as Record<string, unknown>;
    return isFromEmptySelection === true || Array.isArray(multicursorText);
  } catch {
    return false;
  }
}
