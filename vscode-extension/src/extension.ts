/** Entry of the extension: wires settings, status bar, commands and the language server together. */

import * as vscode from 'vscode';
import { registerCommands } from './commands';
import { currentSettings } from './configuration';
import { Debuggers } from './debuggers';
import { DevicesView } from './devicesView';
import { DrawingEditor } from './drawing';
import { registerExample } from './example';
import { FormsView } from './formsView';
import { ProofView } from './proving';
import { Pages } from './pages';
import { PanelView } from './panel/panelView';
import { PlcView } from './plcView';
import { ServerController } from './server';
import type { ProgramStatus, ServerState } from './status';
import { SimulationView } from './simulationView';
import { StatusBar } from './statusBar';
import { TestExplorer } from './testExplorer';
import { RungwiseTasks } from './tasks';
import { registerTranslations } from './translations';
import { UsageView } from './usageView';
import { registerWalkthrough } from './walkthrough';
import { useTranslations } from './words';

/** What other extensions and the tests may use. */
export interface RungwiseApi {
  /** Version of the running server; `undefined` while there is none. */
  serverVersion(): string | undefined;
  serverState(): ServerState;
  /** Last status of a program by its URI. */
  programStatus(uri: string): ProgramStatus | undefined;
  /** Text of the status bar item. */
  statusBarText(): string;
}

let server: ServerController | undefined;

export async function activate(context: vscode.ExtensionContext): Promise<RungwiseApi> {
  useTranslations(vscode.l10n.t);
  const output = vscode.window.createOutputChannel('Rungwise', { log: true });
  const statusBar = new StatusBar();
  const controller = new ServerController(context, output, statusBar);
  const simulation = new SimulationView(controller);
  server = controller;
  context.subscriptions.push(
    output,
    statusBar,
    controller,
    ...registerCommands(controller, output, statusBar),
    new DrawingEditor(controller, output),
    new Pages(controller, statusBar),
    new UsageView(controller),
    new DevicesView(controller),
    new FormsView(controller),
    new ProofView(controller),
    simulation,
    new PanelView(context.extensionUri, simulation),
    new PlcView(controller, simulation, context.workspaceState),
    new TestExplorer(controller),
    new Debuggers(controller),
    RungwiseTasks.register(controller),
    registerExample(context),
    registerWalkthrough(),
    ...registerTranslations(controller),
  );
  context.subscriptions.push(
    vscode.workspace.onDidChangeConfiguration(async (event) => {
      if (event.affectsConfiguration('rungwise.server')) {
        await controller.restart();
      } else if (event.affectsConfiguration('rungwise')) {
        await controller.sendSettings(currentSettings());
      }
    }),
  );
  await controller.start();
  return {
    serverVersion: () => controller.version,
    serverState: () => statusBar.serverState,
    programStatus: (uri) => statusBar.programStatus(uri),
    statusBarText: () => statusBar.text,
  };
}

export async function deactivate(): Promise<void> {
  await server?.stop();
  server = undefined;
}
