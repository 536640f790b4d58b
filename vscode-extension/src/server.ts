/** The life of the language server: finding, probing, starting, crashes, restarts and the end. */

import * as fs from 'node:fs';
import * as os from 'node:os';
import * as vscode from 'vscode';
import {
  CloseAction,
  ErrorAction,
  ExecuteCommandRequest,
  LanguageClient,
  RevealOutputChannelOn,
  TransportKind,
  WorkDoneProgress,
  type CloseHandlerResult,
  type Executable,
  type LanguageClientOptions,
} from 'vscode-languageclient/node';
import { currentServerArguments, currentSettings, serverPathSetting } from './configuration';
import { CRASH_WINDOW_MS, CrashPolicy } from './crashPolicy';
import { brokenServerMessage, crashedServerMessage, missingServerMessage } from './failure';
import { pageUri } from './pageUri';
import { probeServer } from './probe';
import { locateServer, type ServerLocation } from './serverPath';
import { configurationChange, type ServerSettings } from './settings';
import { parseStatus } from './status';
import type { ServerReport } from './statusPage';
import type { StatusBar } from './statusBar';
import { ANOTHER_DOCUMENT } from './translated';

const STOP_TIMEOUT_MS = 2_000;
const DOCUMENTS = [
  { scheme: 'file', language: 'ladder' },
  { scheme: 'file', language: 'plc-il' },
  { scheme: 'untitled', language: 'ladder' },
  { scheme: 'untitled', language: 'plc-il' },
  // For the programs in its fences.
  { scheme: 'file', language: 'markdown' },
  { scheme: 'untitled', language: 'markdown' },
  // Its language is that of whatever extension for TOML there is.
  { scheme: 'file', pattern: '**/rungwise.toml' },
  { scheme: 'file', pattern: '**/*.test.toml' },
  { scheme: 'untitled', pattern: '**/*.test.toml' },
];

/** Lenses stand for commands that every client has; here the extension's own show more. */
const OWN_COMMANDS: Readonly<Record<string, string>> = {
  'rungwise.simulate.start': 'rungwise.simulation.start',
  'rungwise.test.run': 'rungwise.scenarios.run',
};

export class ServerController implements vscode.Disposable {
  private client: LanguageClient | undefined;
  private readonly started = new vscode.EventEmitter<void>();
  /** The server has been started, for the first time or anew. */
  readonly onDidStart = this.started.event;
  private readonly watcher = vscode.workspace.createFileSystemWatcher('**/{rungwise.toml,*.lad,*.il}');
  private readonly crashes = new CrashPolicy();
  /** How many notifications have shown how far something is. */
  private shown = 0;
  private readonly handlers = new Map<string, Set<(params: unknown) => void>>();
  /** Starts and stops run one after another; two restarts in a row must not leave two servers. */
  private queue: Promise<void> = Promise.resolve();
  private runningVersion: string | undefined;

  constructor(
    private readonly context: vscode.ExtensionContext,
    private readonly output: vscode.LogOutputChannel,
    private readonly statusBar: StatusBar,
  ) {}

  /** Version of the running server; `undefined` while there is none. */
  get version(): string | undefined {
    return this.runningVersion;
  }

  /** Whether the server is being started: it will run, or a message says why not. */
  get isStarting(): boolean {
    return this.statusBar.serverState === 'starting';
  }

  /** Starts the server. Never rejects: failures are shown to the user. */
  start(): Promise<void> {
    return this.enqueue(() => this.startNow());
  }

  stop(): Promise<void> {
    return this.enqueue(() => this.stopNow());
  }

  restart(): Promise<void> {
    return this.enqueue(async () => {
      this.output.info('restarting the server');
      this.crashes.reset();
      await this.stopNow();
      await this.startNow();
    });
  }

  /** Sends changed settings; without a server there is nothing to do, as a start sends them anyway. */
  async sendSettings(settings: ServerSettings): Promise<void> {
    await this.client?.sendNotification('workspace/didChangeConfiguration', configurationChange(settings));
  }

  /** Whether the running server has a command. */
  knows(command: string): boolean {
    return this.client?.initializeResult?.capabilities.executeCommandProvider?.commands.includes(command) ?? false;
  }

  /**
   * Runs a command of the server. Rejects when there is no server, when it answers with an error, and when `token`
   * cancels it.
   */
  async executeCommand(command: string, args: readonly unknown[], token?: vscode.CancellationToken): Promise<unknown> {
    if (this.client === undefined || !this.client.isRunning()) {
      throw new Error(vscode.l10n.t('the language server is not running'));
    }
    return this.client.sendRequest(ExecuteCommandRequest.type, { command, arguments: [...args] }, token);
  }

  /** The same with a notification that shows how far it is, as the server says, and can cancel it. */
  async executeShown(title: string, command: string, args: readonly unknown[]): Promise<unknown> {
    const { client } = this;
    if (client === undefined || !client.isRunning()) {
      throw new Error(vscode.l10n.t('the language server is not running'));
    }
    this.shown += 1;
    const workDoneToken = `rungwise-shown-${this.shown}`;
    const options = { location: vscode.ProgressLocation.Notification, title, cancellable: true };
    return vscode.window.withProgress(options, async (bar, cancelled) => {
      let before = 0;
      const heard = client.onProgress(WorkDoneProgress.type, workDoneToken, (told) => {
        if (told.kind === 'report') {
          const percentage = told.percentage ?? before;
          bar.report({ increment: percentage - before, ...(told.message !== undefined && { message: told.message }) });
          before = percentage;
        }
      });
      try {
        return await client.sendRequest(ExecuteCommandRequest.type, { command, arguments: [...args], workDoneToken }, cancelled);
      } catch (error) {
        // Who has ended it knows; what has become of it is told by the server.
        throw cancelled.isCancellationRequested ? new vscode.CancellationError() : error;
      } finally {
        heard.dispose();
      }
    });
  }

  /** Hears notifications of the server's own kind, of this server and of those that follow it. */
  onNotification(method: string, handler: (params: unknown) => void): vscode.Disposable {
    const handlers = this.handlers.get(method) ?? new Set();
    this.handlers.set(method, handlers.add(handler));
    return new vscode.Disposable(() => handlers.delete(handler));
  }

  /** Sends a request of the server's own kind. Rejects as `executeCommand` does. */
  async request(method: string, params: unknown): Promise<unknown> {
    if (this.client === undefined || !this.client.isRunning()) {
      throw new Error(vscode.l10n.t('the language server is not running'));
    }
    return this.client.sendRequest(method, params);
  }

  /** A document's address as it was given to the server. */
  protocolUri(uri: vscode.Uri): string {
    return this.client?.code2ProtocolConverter.asUri(uri) ?? uri.toString();
  }

  /** Path of the program; `undefined` if there is none. */
  program(): string | undefined {
    const location = this.locate();
    return location.kind === 'found' ? location.file : undefined;
  }

  /** What the page "Show Status" says about the server. */
  report(): ServerReport {
    const location = this.locate();
    return {
      state: this.statusBar.serverState,
      version: this.runningVersion,
      program: location.kind === 'found' ? location.file : undefined,
      origin: location.origin,
      tried: location.kind === 'found' ? [] : location.tried,
      arguments: currentServerArguments(),
      settings: currentSettings(),
      extensionVersion: String((this.context.extension.packageJSON as { version?: unknown }).version),
    };
  }

  dispose(): void {
    this.watcher.dispose();
    this.started.dispose();
    void this.stop();
  }

  private enqueue(step: () => Promise<void>): Promise<void> {
    this.queue = this.queue.then(step).catch((error: unknown) => {
      this.output.error(String(error));
    });
    return this.queue;
  }

  private async startNow(): Promise<void> {
    this.statusBar.setServerState('starting');
    const location = this.locate();
    if (location.kind === 'missing') {
      this.fail(missingServerMessage(location), `tried: ${location.tried.join(', ')}`);
      return;
    }
    const probe = await probeServer(location.file);
    if (probe.kind === 'failed') {
      this.fail(brokenServerMessage(location.file, probe.reason), probe.reason);
      return;
    }
    this.output.info(`server ${location.file} (${location.origin}), version ${probe.version}`);
    const client = this.createClient(location.file);
    this.client = client;
    try {
      await client.start();
      this.runningVersion = probe.version;
      this.statusBar.setServerState('running');
      this.started.fire();
    } catch (error) {
      this.client = undefined;
      const reason = error instanceof Error ? error.message : String(error);
      this.fail(brokenServerMessage(location.file, reason), reason);
    }
  }

  private async stopNow(): Promise<void> {
    const client = this.client;
    this.client = undefined;
    this.runningVersion = undefined;
    if (client !== undefined) {
      // A server that hangs must not keep the user from a new one, hence the bound; an error here is the old server's.
      await client.dispose(STOP_TIMEOUT_MS).catch((error: unknown) => this.output.warn(`stopping: ${String(error)}`));
    }
    this.statusBar.clearPrograms();
    this.statusBar.setServerState('stopped');
  }

  private locate(): ServerLocation {
    return locateServer({
      setting: serverPathSetting(),
      environment: process.env,
      extensionFolder: this.context.extensionPath,
      workspaceFolder: vscode.workspace.workspaceFolders?.[0]?.uri.fsPath,
      homeFolder: os.homedir(),
      platform: process.platform,
      isExecutable,
    });
  }

  private createClient(file: string): LanguageClient {
    const program: Executable = { command: file, args: currentServerArguments(), transport: TransportKind.stdio };
    const options: LanguageClientOptions = {
      documentSelector: DOCUMENTS,
      outputChannel: this.output,
      traceOutputChannel: this.output,
      revealOutputChannelOn: RevealOutputChannelOn.Never,
      initializationOptions: currentSettings,
      synchronize: { fileEvents: this.watcher },
      middleware: {
        handleDiagnostics: (uri, diagnostics, next) => next(uri, diagnostics.map(linkCode)),
        provideCodeLenses: async (document, token, next) => (await next(document, token))?.map(withOwnCommand),
        resolveCodeLens: async (lens, token, next) => {
          const resolved = await next(lens, token);
          return resolved && withOwnCommand(resolved);
        },
        // The editor would answer some keystrokes in a drawing only; `DrawingEditor` answers them all.
        provideOnTypeFormattingEdits: (document, position, character, format, token, next) =>
          document.languageId === 'ladder' ? [] : next(document, position, character, format, token),
      },
      errorHandler: {
        error: () => ({ action: ErrorAction.Continue, handled: true }),
        closed: () => this.serverClosed(),
      },
      // The failure is shown once, by `startNow`.
      initializationFailedHandler: () => false,
    };
    // The identifier makes the client read the setting `rungwise.trace.server`.
    const client = new LanguageClient('rungwise', 'Rungwise', program, options);
    client.registerFeature({
      fillClientCapabilities: (capabilities) => {
        capabilities.experimental = { commands: { commands: Object.values(ANOTHER_DOCUMENT) } };
      },
      initialize: () => undefined,
      getState: () => ({ kind: 'static' }),
      clear: () => undefined,
    });
    for (const [method, handlers] of this.handlers) {
      client.onNotification(method, (params: unknown) => handlers.forEach((handler) => handler(params)));
    }
    client.onNotification('rungwise/status', (value: unknown) => {
      const status = parseStatus(value);
      if (status !== undefined) {
        this.statusBar.setProgramStatus(status);
      }
    });
    return client;
  }

  /**
   * The server ended without being asked to. The client is never told to restart by itself: a start of our own looks
   * for the program anew and can say why it does not run, for instance after it was deleted or replaced.
   */
  private serverClosed(): CloseHandlerResult {
    const ended: CloseHandlerResult = { action: CloseAction.DoNotRestart, handled: true };
    if (this.runningVersion === undefined) {
      // It ended while it was starting, which `startNow` reports.
      return ended;
    }
    this.runningVersion = undefined;
    const decision = this.crashes.decide(performance.now());
    if (decision.kind === 'give-up') {
      this.fail(crashedServerMessage(decision.crashes, CRASH_WINDOW_MS / 60_000));
      return ended;
    }
    this.output.warn(`the server ended unexpectedly, starting it again in ${decision.delayMs} ms`);
    this.statusBar.setServerState('starting');
    void this.enqueue(async () => {
      await new Promise((resolve) => setTimeout(resolve, decision.delayMs));
      await this.stopNow();
      await this.startNow();
    });
    return ended;
  }

  private fail(message: string, detail: string = message): void {
    this.runningVersion = undefined;
    this.statusBar.setServerState('failed');
    this.output.error(detail);
    void this.showFailure(message);
  }

  private async showFailure(message: string): Promise<void> {
    const settings = vscode.l10n.t('Open Settings');
    const log = vscode.l10n.t('Show Log');
    const retry = vscode.l10n.t('Try Again');
    const choice = await vscode.window.showErrorMessage(message, settings, log, retry);
    if (choice === settings) {
      await vscode.commands.executeCommand('workbench.action.openSettings', 'rungwise.server');
    } else if (choice === log) {
      this.output.show();
    } else if (choice === retry) {
      await this.restart();
    }
  }
}

/** Makes the code of a diagnostic a link to the page of its rule, unless the server gave another address. */
function linkCode(diagnostic: vscode.Diagnostic): vscode.Diagnostic {
  if (typeof diagnostic.code === 'string' && diagnostic.source === 'rungwise') {
    diagnostic.code = { value: diagnostic.code, target: pageUri(diagnostic.code) };
  }
  return diagnostic;
}

function withOwnCommand(lens: vscode.CodeLens): vscode.CodeLens {
  const own = lens.command && OWN_COMMANDS[lens.command.command];
  if (lens.command !== undefined && own !== undefined) {
    lens.command = { ...lens.command, command: own };
  }
  return lens;
}

function isExecutable(file: string): boolean {
  try {
    fs.accessSync(file, fs.constants.X_OK);
    return fs.statSync(file).isFile();
  } catch {
    return false;
  }
}
