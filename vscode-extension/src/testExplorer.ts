/** Scenario tests in the test view: files, scenarios, what failed where, what is covered. */

import * as vscode from 'vscode';
import type { ServerController } from './server';
import type { PlainRange } from './structuralEdits';
import { Covered, LIST, listed, results, RUN, type Rung, type ScenarioResult, type SuiteFile, type SuiteResult } from './testing';

const SUITES = '**/*.test.toml';
/** Files are read anew when nothing was typed for so long. */
const TYPED_MS = 300;

/** What a run is for. */
type Purpose = 'run' | 'coverage' | 'update';

export class TestExplorer implements vscode.Disposable {
  private readonly controller = vscode.tests.createTestController('rungwise', 'Rungwise');
  private readonly subscriptions: vscode.Disposable[];
  private readonly details = new WeakMap<vscode.FileCoverage, vscode.FileCoverageDetail[]>();
  private readonly runProfile: vscode.TestRunProfile;
  private typed: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly server: ServerController) {
    const { Run, Coverage } = vscode.TestRunProfileKind;
    const profile = (name: string, kind: vscode.TestRunProfileKind, purpose: Purpose, isDefault: boolean) =>
      this.controller.createRunProfile(name, kind, (request, token) => this.run(request, token, purpose), isDefault);
    this.runProfile = profile(vscode.l10n.t('Run Scenarios'), Run, 'run', true);
    const coverage = profile(vscode.l10n.t('Run Scenarios with Coverage'), Coverage, 'coverage', true);
    coverage.loadDetailedCoverage = async (_, file) => this.details.get(file) ?? [];
    profile(vscode.l10n.t('Write Golden Traces Anew'), Run, 'update', false);
    this.controller.refreshHandler = () => this.list();
    this.controller.resolveHandler = async (item) => {
      if (item === undefined) {
        await this.list();
      }
    };
    const watcher = vscode.workspace.createFileSystemWatcher(SUITES);
    const isSuite = ({ uri }: vscode.TextDocument) => uri.path.endsWith('.test.toml');
    this.subscriptions = [
      this.controller,
      watcher,
      watcher.onDidCreate(() => void this.list()),
      watcher.onDidChange(() => void this.list()),
      watcher.onDidDelete(() => void this.list()),
      server.onDidStart(() => void this.list()),
      vscode.workspace.onDidOpenTextDocument((document) => isSuite(document) && this.listSoon()),
      vscode.workspace.onDidChangeTextDocument(({ document }) => isSuite(document) && this.listSoon()),
      vscode.commands.registerCommand('rungwise.scenarios.run', (asked: unknown) => this.runAsked(asked)),
    ];
  }

  dispose(): void {
    clearTimeout(this.typed);
    vscode.Disposable.from(...this.subscriptions).dispose();
  }

  private listSoon(): void {
    clearTimeout(this.typed);
    this.typed = setTimeout(() => void this.list(), TYPED_MS);
  }

  /** Reads all files of the workspace anew. */
  private async list(): Promise<void> {
    if (!this.server.knows(LIST)) {
      return;
    }
    // A server that is being stopped answers no more; the next one is asked again.
    const answer = await this.server.executeCommand(LIST, [{}]).catch(() => undefined);
    if (answer !== undefined) {
      this.controller.items.replace(listed(answer).map((file) => this.item(file)));
    }
  }

  private item(file: SuiteFile): vscode.TestItem {
    const uri = vscode.Uri.parse(file.uri);
    const item = this.controller.createTestItem(file.uri, vscode.workspace.asRelativePath(uri), uri);
    item.error = file.problems[0]?.message;
    item.children.replace(
      file.scenarios.map(({ name, range }, number) => {
        const scenario = this.controller.createTestItem(`${file.uri}#${name}`, name, uri);
        scenario.range = toRange(range);
        // In the order of the file.
        scenario.sortText = String(number).padStart(6, '0');
        return scenario;
      }),
    );
    return item;
  }

  /** What a lens asks for: `{ uri, names? }`, where the address may be that of a program. */
  private async runAsked(asked: unknown): Promise<void> {
    const { uri, names } = asked as { uri: string; names?: string[] };
    const answer = await this.server.executeCommand(LIST, [{ uri }]);
    await this.list();
    const files = listed(answer).flatMap((file) => this.controller.items.get(file.uri) ?? []);
    const scenarios = (file: vscode.TestItem) => (names ?? []).flatMap((name) => file.children.get(`${file.id}#${name}`) ?? []);
    const include = names === undefined ? files : files.flatMap(scenarios);
    if (include.length > 0) {
      const request = new vscode.TestRunRequest(include, undefined, this.runProfile);
      await this.run(request, new vscode.CancellationTokenSource().token, 'run');
    }
  }

  private async run(request: vscode.TestRunRequest, token: vscode.CancellationToken, purpose: Purpose): Promise<void> {
    const run = this.controller.createTestRun(request);
    const covered = new Covered();
    try {
      for (const [file, scenarios] of this.chosen(request)) {
        if (token.isCancellationRequested) {
          break;
        }
        scenarios.forEach((scenario) => run.started(scenario));
        const names = scenarios.length === file.children.size ? undefined : scenarios.map(({ label }) => label);
        const asked = { uri: file.id, names, coverage: purpose === 'coverage', update: purpose === 'update' };
        try {
          const [result] = results(await this.server.executeCommand(RUN, [asked], token));
          if (result !== undefined) {
            covered.add(result);
            await writeGolden(result);
            scenarios.forEach((scenario) => tell(run, scenario, result));
          }
        } catch (error) {
          const reason = error instanceof Error ? error.message : String(error);
          scenarios.forEach((scenario) => run.errored(scenario, new vscode.TestMessage(reason)));
        }
      }
      for (const { uri, rungs } of covered.files()) {
        const details = rungs.map(statement);
        const coverage = vscode.FileCoverage.fromDetails(vscode.Uri.parse(uri), details);
        this.details.set(coverage, details);
        run.addCoverage(coverage);
      }
    } finally {
      run.end();
    }
  }

  /** The scenarios of a request, file by file. */
  private chosen({ include, exclude }: vscode.TestRunRequest): Map<vscode.TestItem, vscode.TestItem[]> {
    const chosen = new Map<vscode.TestItem, vscode.TestItem[]>();
    const add = (item: vscode.TestItem) => {
      if (exclude?.includes(item)) {
        return;
      }
      const file = item.parent;
      if (file === undefined) {
        item.children.forEach(add);
      } else if (!chosen.get(file)?.includes(item)) {
        chosen.set(file, [...(chosen.get(file) ?? []), item]);
      }
    };
    if (include === undefined) {
      this.controller.items.forEach(add);
    } else {
      include.forEach(add);
    }
    return chosen;
  }
}

/** Writes the golden traces that came back. */
async function writeGolden({ golden }: SuiteResult): Promise<void> {
  for (const { uri, text } of golden) {
    await vscode.workspace.fs.writeFile(vscode.Uri.parse(uri), new TextEncoder().encode(text));
  }
}

/** Tells what came of a scenario. */
function tell(run: vscode.TestRun, item: vscode.TestItem, { scenarios, problems }: SuiteResult): void {
  const result = scenarios.find(({ name }) => name === item.label);
  if (result?.passed === true) {
    run.passed(item);
  } else if (result !== undefined && result.failures.length > 0) {
    const messages = result.failures.map((failure, number) => failed(item, result, failure, number === 0));
    run.failed(item, messages);
  } else {
    const messages = problems.map(({ uri, range, message }) => {
      const told = new vscode.TestMessage(message);
      told.location = new vscode.Location(vscode.Uri.parse(uri), toRange(range));
      return told;
    });
    run.errored(item, messages);
  }
}

function failed(
  item: vscode.TestItem,
  { picture }: ScenarioResult,
  { message, range }: ScenarioResult['failures'][number],
  isFirst: boolean,
): vscode.TestMessage {
  const text = new vscode.MarkdownString().appendText(message);
  if (isFirst && picture !== undefined) {
    // The view of a message draws several blanks as one, and time goes by columns.
    text.appendCodeblock(picture.replaceAll(' ', '\u00a0'), 'text');
  }
  const told = new vscode.TestMessage(text);
  if (item.uri !== undefined) {
    told.location = new vscode.Location(item.uri, toRange(range));
  }
  return told;
}

/** A rung, with two branches for each contact. */
function statement({ range, evaluated, contacts }: Rung): vscode.StatementCoverage {
  const branches = contacts.flatMap((contact) => {
    const at = toRange(contact.range);
    return [
      new vscode.BranchCoverage(contact.on, at, vscode.l10n.t('{0} on', contact.name)),
      new vscode.BranchCoverage(contact.off, at, vscode.l10n.t('{0} off', contact.name)),
    ];
  });
  return new vscode.StatementCoverage(evaluated, toRange(range), branches);
}

function toRange({ start, end }: PlainRange): vscode.Range {
  return new vscode.Range(start.line, start.character, end.line, end.character);
}
