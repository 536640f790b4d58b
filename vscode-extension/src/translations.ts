/** The commands of the server's code actions that show a translation: as a new document beside, or on the clipboard. */

import * as vscode from 'vscode';
import { ANOTHER_DOCUMENT, translationOf, type Translated } from './translated';
import { TRANSLATE } from './forms';
import type { ServerController } from './server';
import { t } from './words';

export function registerTranslations(server: ServerController): vscode.Disposable[] {
  const { registerCommand } = vscode.commands;
  return [
    registerCommand(ANOTHER_DOCUMENT.open, (asked: unknown) => withTranslation(server, asked, open)),
    registerCommand(ANOTHER_DOCUMENT.copy, (asked: unknown) => withTranslation(server, asked, copy)),
  ];
}

/** Asks for what a code action stands for; what is wrong with it is said. */
async function withTranslation(server: ServerController, asked: unknown, use: (translated: Translated) => Promise<void>): Promise<void> {
  try {
    const translated = translationOf(await server.executeCommand(TRANSLATE, [asked]));
    if (translated === undefined) {
      void vscode.window.showInformationMessage(t('There is no rung at the cursor.'));
      return;
    }
    await use(translated);
    if (translated.notes.length > 0) {
      void vscode.window.showWarningMessage(t('Rungwise: not everything was translated: {0}', translated.notes.join('; ')));
    }
  } catch (error) {
    const reason = error instanceof Error ? error.message : String(error);
    void vscode.window.showErrorMessage(t('Rungwise: nothing was translated: {0}', reason));
  }
}

async function open({ text, language }: Translated): Promise<void> {
  const document = await vscode.workspace.openTextDocument({ language, content: text });
  await vscode.window.showTextDocument(document, { viewColumn: vscode.ViewColumn.Beside, preview: false });
}

async function copy({ text }: Translated): Promise<void> {
  await vscode.env.clipboard.writeText(text);
  vscode.window.setStatusBarMessage(t('Rungwise: the translation is on the clipboard.'), 5_000);
}
