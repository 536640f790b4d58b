/** The commands of the palette. */

import * as vscode from 'vscode';
import { checkSummary } from './checkResult';
import type { ServerController } from './server';
import type { StatusBar } from './statusBar';
import { targetChoices } from './targets';
import { t } from './words';

export function registerCommands(
  server: ServerController,
  output: vscode.LogOutputChannel,
  statusBar: StatusBar,
): vscode.Disposable[] {
  const register = vscode.commands.registerCommand;
  return [
    register('rungwise.restartServer', () => server.restart()),
    register('rungwise.showOutput', () => output.show()),
    register('rungwise.checkProgram', (uri?: vscode.Uri) => checkProgram(server, uri)),
    register('rungwise.formatDocument', () => vscode.commands.executeCommand('editor.action.formatDocument')),
    register('rungwise.selectTarget', () => selectTarget(statusBar)),
    register('rungwise.serverVersion', () => showVersion(server, output)),
  ];
}

/** Runs the batch check on a program and shows its summary. Returns the sentence, for callers in code. */
async function checkProgram(server: ServerController, given?: vscode.Uri): Promise<string | undefined> {
  const uri = given ?? vscode.window.activeTextEditor?.document.uri;
  if (uri === undefined) {
    void vscode.window.showInformationMessage(t('Rungwise: open a .lad or .il file to check it.'));
    return undefined;
  }
  try {
    const answer = await server.executeCommand('rungwise.check', [uri.toString()]);
    const { message, severity } = checkSummary(answer);
    showSummary(message, severity);
    return message;
  } catch (error) {
    const reason = error instanceof Error ? error.message : String(error);
    void vscode.window.showErrorMessage(t('Rungwise: the program was not checked: {0}', reason));
    return undefined;
  }
}

function showSummary(message: string, severity: 'information' | 'warning' | 'error'): void {
  const problems = t('Show Problems');
  const shown =
    severity === 'error'
      ? vscode.window.showErrorMessage(message, problems)
      : severity === 'warning'
        ? vscode.window.showWarningMessage(message, problems)
        : vscode.window.showInformationMessage(message);
  void shown.then((choice) => {
    if (choice === problems) {
      void vscode.commands.executeCommand('workbench.actions.view.problems');
    }
  });
}

async function selectTarget(statusBar: StatusBar): Promise<void> {
  const uri = vscode.window.activeTextEditor?.document.uri;
  const section = vscode.workspace.getConfiguration('rungwise');
  const used = uri && statusBar.programStatus(uri.toString())?.target;
  const choice = await vscode.window.showQuickPick(targetChoices(section.get<string>('target') ?? null, used), {
    title: t('Target PLC'),
    placeHolder: t('PLC model that programs are checked for'),
  });
  if (choice !== undefined) {
    const inWorkspace = vscode.workspace.workspaceFolders !== undefined;
    const place = inWorkspace ? vscode.ConfigurationTarget.Workspace : vscode.ConfigurationTarget.Global;
    // Automatic is the default, so the setting is removed rather than written.
    await section.update('target', choice.value === 'auto' ? undefined : choice.value, place);
  }
}

async function showVersion(server: ServerController, output: vscode.LogOutputChannel): Promise<string | undefined> {
  const log = t('Show Log');
  const version = server.version;
  const message = version === undefined ? t('Rungwise: the server is not running.') : t('Rungwise server {0}', version);
  void vscode.window.showInformationMessage(message, log).then((choice) => {
    if (choice === log) {
      output.show();
    }
  });
  return version;
}
