/** Debugging a program with VS Code's own debugger: F5 without a launch file, a lens, forcing, why a device is on or off. */

import * as vscode from 'vscode';
import { currentLanguage } from './configuration';
import {
  configurationOf, DEBUG_LANGUAGES, DEBUG_TYPE, flat, forceLine, isEmpty, plainValue, type Reason,
} from './debugging';
import type { ServerController } from './server';
import { simulate } from './simulation';

/** What the menu of a variable hands over. */
interface VariableContext {
  readonly variable?: { readonly name?: string; readonly value?: string };
}

interface ReasonItem extends vscode.QuickPickItem {
  readonly reason: Reason;
}

export class Debuggers
  implements
    vscode.DebugConfigurationProvider,
    vscode.DebugAdapterDescriptorFactory,
    vscode.CodeLensProvider,
    vscode.Disposable
{
  private readonly subscriptions: vscode.Disposable[];

  constructor(private readonly server: ServerController) {
    const { registerCommand } = vscode.commands;
    const { registerDebugConfigurationProvider, registerDebugAdapterDescriptorFactory } = vscode.debug;
    const dynamic = vscode.DebugConfigurationProviderTriggerKind.Dynamic;
    this.subscriptions = [
      registerDebugConfigurationProvider(DEBUG_TYPE, this),
      registerDebugConfigurationProvider(DEBUG_TYPE, this, dynamic),
      registerDebugAdapterDescriptorFactory(DEBUG_TYPE, this),
      vscode.languages.registerCodeLensProvider([...DEBUG_LANGUAGES], this),
      registerCommand('rungwise.debug.start', (program?: vscode.Uri) => this.start(program)),
      registerCommand('rungwise.debug.force', (context?: VariableContext) => this.force(context)),
      registerCommand('rungwise.debug.release', (context?: VariableContext) => this.release(context)),
      registerCommand('rungwise.simulation.why', () => this.why()),
    ];
  }

  dispose(): void {
    vscode.Disposable.from(...this.subscriptions).dispose();
  }

  provideDebugConfigurations(): vscode.DebugConfiguration[] {
    const configuration = configurationOf('${file}', vscode.l10n.t('Debug the program in the editor'));
    return [configuration as vscode.DebugConfiguration];
  }

  resolveDebugConfiguration(
    _folder: vscode.WorkspaceFolder | undefined,
    configuration: vscode.DebugConfiguration,
  ): vscode.DebugConfiguration | undefined {
    const document = vscode.window.activeTextEditor?.document;
    const isProgram = document !== undefined && DEBUG_LANGUAGES.includes(document.languageId);
    if (isEmpty(configuration) && isProgram) {
      const name = vscode.l10n.t('Debug the program in the editor');
      return configurationOf(document.uri.fsPath, name) as vscode.DebugConfiguration;
    }
    if (configuration['program'] === undefined && isProgram) {
      return { ...configuration, program: document.uri.fsPath };
    }
    return configuration;
  }

  createDebugAdapterDescriptor(): vscode.DebugAdapterDescriptor {
    return new vscode.DebugAdapterExecutable(this.server.program() ?? 'rungwise', ['dap', '--lang', currentLanguage()]);
  }

  /** The way into the debugger stands above a program, beside what the server has there. */
  provideCodeLenses({ uri }: vscode.TextDocument): vscode.CodeLens[] {
    if (uri.scheme !== 'file' || !vscode.workspace.getConfiguration('rungwise', uri).get('codeLens.run', true)) {
      return [];
    }
    const command = { title: vscode.l10n.t('Debug'), command: 'rungwise.debug.start', arguments: [uri] };
    return [new vscode.CodeLens(new vscode.Range(0, 0, 0, 0), command)];
  }

  /** Starts the debugger with a program, that of the editor if none is named. */
  private async start(program = vscode.window.activeTextEditor?.document.uri): Promise<void> {
    if (program !== undefined) {
      const configuration = configurationOf(program.fsPath, vscode.l10n.t('Debug the program in the editor'));
      const folder = vscode.workspace.getWorkspaceFolder(program);
      await vscode.debug.startDebugging(folder, configuration as vscode.DebugConfiguration);
    }
  }

  /** Holds a variable of the debugger at a value. */
  private async force(context: VariableContext | undefined): Promise<void> {
    const name = context?.variable?.name;
    if (name === undefined) {
      return;
    }
    const value = await vscode.window.showInputBox({
      title: vscode.l10n.t('Hold {0} at', name),
      value: plainValue(context?.variable?.value ?? ''),
    });
    if (value !== undefined && value.trim() !== '') {
      await this.tell(forceLine(name, value));
    }
  }

  private async release(context: VariableContext | undefined): Promise<void> {
    const name = context?.variable?.name;
    if (name !== undefined) {
      await this.tell(`release ${name}`);
    }
  }

  /** Says something to the console of the debugger. */
  private async tell(expression: string): Promise<void> {
    try {
      await vscode.debug.activeDebugSession?.customRequest('evaluate', { expression, context: 'repl' });
    } catch (error) {
      showError(error);
    }
  }

  /** Why the device at the cursor is on or off: the contacts that decide, each with a way to it. */
  private async why(): Promise<void> {
    const editor = vscode.window.activeTextEditor;
    if (editor === undefined) {
      return;
    }
    const { line, character } = editor.selection.active;
    const argument = { uri: this.server.protocolUri(editor.document.uri), position: { line, character } };
    try {
      const reason = (await this.server.executeCommand(simulate('why'), [argument])) as Reason;
      await this.show(reason, editor);
    } catch (error) {
      showError(error);
    }
  }

  private async show(reason: Reason, editor: vscode.TextEditor): Promise<void> {
    const items = flat(reason).map(({ reason, depth }): ReasonItem => ({
      label: `${'\u00a0\u00a0\u00a0'.repeat(depth)}${depth > 0 ? '↳ ' : ''}${reason.text}`,
      description: reason.range === undefined ? '' : vscode.l10n.t('line {0}', reason.range.start.line + 1),
      reason,
    }));
    const before = editor.selection;
    const picker = vscode.window.createQuickPick<ReasonItem>();
    picker.title = reason.text;
    picker.placeholder = vscode.l10n.t('Enter goes to the instruction');
    picker.items = items;
    let isChosen = false;
    picker.onDidChangeActive(([item]) => void reveal(item?.reason, true));
    picker.onDidAccept(() => {
      isChosen = true;
      void reveal(picker.activeItems[0]?.reason, false);
      picker.hide();
    });
    await new Promise<void>((done) => {
      picker.onDidHide(() => {
        if (!isChosen) {
          editor.selection = before;
          editor.revealRange(before);
        }
        picker.dispose();
        done();
      });
      picker.show();
    });
  }
}

async function reveal(reason: Reason | undefined, preserveFocus: boolean): Promise<void> {
  if (reason?.uri === undefined || reason.range === undefined) {
    return;
  }
  const { start, end } = reason.range;
  const selection = new vscode.Range(start.line, start.character, end.line, end.character);
  await vscode.window.showTextDocument(vscode.Uri.parse(reason.uri), { selection, preserveFocus });
}

function showError(error: unknown): void {
  const reason = error instanceof Error ? error.message : String(error);
  void vscode.window.showErrorMessage(`Rungwise: ${reason}`);
}
