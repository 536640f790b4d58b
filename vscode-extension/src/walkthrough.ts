/** "Get Started": opens the walkthrough of package.json. */

import * as vscode from 'vscode';

const WALKTHROUGH = 'rungwise.rungwise#start';

export function registerWalkthrough(): vscode.Disposable {
  return vscode.commands.registerCommand('rungwise.openWalkthrough', () =>
    vscode.commands.executeCommand('workbench.action.openWalkthrough', WALKTHROUGH, false),
  );
}
