/** "Open Getting-Started Example": a small project that is copied into a folder, or opened without saving it. */

import * as vscode from 'vscode';

const PROJECT_NAME = 'rungwise-example';
const FIRST_FILE = 'first-steps.lad';

/** What a caller in code may give, so that nothing is asked. */
interface ExampleOptions {
  readonly folder?: vscode.Uri;
  readonly scratch?: boolean;
}

export function registerExample(context: vscode.ExtensionContext): vscode.Disposable {
  return vscode.commands.registerCommand('rungwise.openExample', (options?: ExampleOptions) => open(context, options));
}

/** Gives the document that is shown; `undefined` if the user thought better of it. */
async function open(context: vscode.ExtensionContext, options?: ExampleOptions): Promise<vscode.Uri | undefined> {
  const source = vscode.Uri.joinPath(context.extensionUri, 'examples', exampleFolder(vscode.env.language));
  const choice = options?.folder ?? (options?.scratch ? 'scratch' : await choose());
  if (choice === undefined) {
    return undefined;
  }
  if (choice === 'scratch') {
    const content = await vscode.workspace.fs.readFile(vscode.Uri.joinPath(source, FIRST_FILE));
    const document = await vscode.workspace.openTextDocument({
      language: 'ladder',
      content: new TextDecoder().decode(content),
    });
    await vscode.window.showTextDocument(document);
    return document.uri;
  }
  const project = await freeFolder(choice);
  await vscode.workspace.fs.copy(source, project);
  const file = vscode.Uri.joinPath(project, FIRST_FILE);
  await vscode.window.showTextDocument(file);
  if (options === undefined && vscode.workspace.getWorkspaceFolder(project) === undefined) {
    void offerFolder(project);
  }
  return file;
}

async function choose(): Promise<vscode.Uri | 'scratch' | undefined> {
  const { t } = vscode.l10n;
  const copy = { label: t('Copy into a Folder…'), description: t('a project with rungwise.toml, to keep') };
  const scratch = { label: t('Open without Saving'), description: t('a ladder to play with') };
  const choice = await vscode.window.showQuickPick([copy, scratch], { title: t('Getting-started example') });
  if (choice !== copy) {
    return choice === scratch ? 'scratch' : undefined;
  }
  const folders = await vscode.window.showOpenDialog({
    canSelectFiles: false,
    canSelectFolders: true,
    openLabel: t('Copy Example Here'),
  });
  return folders?.[0];
}

/** A folder inside `parent` that does not exist yet: an example never overwrites anything. */
async function freeFolder(parent: vscode.Uri): Promise<vscode.Uri> {
  for (let count = 1; ; count++) {
    const candidate = vscode.Uri.joinPath(parent, count === 1 ? PROJECT_NAME : `${PROJECT_NAME}-${count}`);
    const taken = await vscode.workspace.fs.stat(candidate).then(
      () => true,
      () => false,
    );
    if (!taken) {
      return candidate;
    }
  }
}

async function offerFolder(project: vscode.Uri): Promise<void> {
  const openFolder = vscode.l10n.t('Open Folder');
  const question = vscode.l10n.t('The example is in {0}.', project.fsPath);
  if ((await vscode.window.showInformationMessage(question, openFolder)) === openFolder) {
    await vscode.commands.executeCommand('vscode.openFolder', project);
  }
}

function exampleFolder(language: string): string {
  return language.toLowerCase().startsWith('zh') ? 'getting-started-zh-cn' : 'getting-started';
}
