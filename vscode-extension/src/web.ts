/**
 * The extension where there is no computer behind the editor, as on vscode.dev: colours and snippets work, and a sentence
 * says why nothing else does. The language server is a native program; with a host (desktop, SSH, container, code-server)
 * `extension.ts` runs there instead.
 */

import * as vscode from 'vscode';

const TOLD = 'rungwise.toldAboutWeb';

export function activate(context: vscode.ExtensionContext): void {
  const item = vscode.window.createStatusBarItem('rungwise.status', vscode.StatusBarAlignment.Right, 100);
  item.name = 'Rungwise';
  item.text = '$(circle-slash) Rungwise';
  item.tooltip = sentence();
  item.command = 'rungwise.showStatus';
  item.show();
  const show = () => vscode.window.showInformationMessage(sentence());
  context.subscriptions.push(item, vscode.commands.registerCommand('rungwise.showStatus', show));
  // The menus offer the other commands too; each says why it cannot work rather than "command not found".
  const manifest = context.extension.packageJSON as { contributes: { commands: { command: string }[] } };
  for (const { command } of manifest.contributes.commands) {
    if (command !== 'rungwise.showStatus') {
      context.subscriptions.push(vscode.commands.registerCommand(command, show));
    }
  }
  if (context.globalState.get(TOLD) !== true) {
    void context.globalState.update(TOLD, true);
    void show();
  }
}

function sentence(): string {
  return vscode.l10n.t(
    'Rungwise: this edition of VS Code runs in the browser alone, without a computer for the language server. ' +
      'Colours and snippets work; for diagnostics, completion and editing of drawings open the folder in VS Code on the ' +
      'desktop, in a codespace or in code-server.',
  );
}
