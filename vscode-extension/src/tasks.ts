/** Tasks of the type `rungwise`: check a project, and check that its files are in canonical form. */

import * as vscode from 'vscode';
import type { ServerController } from './server';
import { taskArguments, taskName, type TaskVerb } from './taskDefinition';

const TASK_TYPE = 'rungwise';

export class RungwiseTasks implements vscode.TaskProvider {
  constructor(private readonly server: ServerController) {}

  static register(server: ServerController): vscode.Disposable {
    return vscode.tasks.registerTaskProvider(TASK_TYPE, new RungwiseTasks(server));
  }

  provideTasks(): vscode.Task[] {
    const folders = vscode.workspace.workspaceFolders ?? [];
    const verbs: readonly TaskVerb[] = ['check', 'fmt'];
    return folders.flatMap((folder) =>
      verbs.map((command) => this.task({ type: TASK_TYPE, command }, folder)).filter((task) => task !== undefined),
    );
  }

  /** Completes a task of tasks.json, which has its definition only. */
  resolveTask(task: vscode.Task): vscode.Task | undefined {
    return this.task(task.definition, task.scope);
  }

  private task(
    definition: vscode.TaskDefinition,
    scope: vscode.WorkspaceFolder | vscode.TaskScope | undefined,
  ): vscode.Task | undefined {
    const args = taskArguments(definition);
    if (args === undefined) {
      return undefined;
    }
    const folder = typeof scope === 'object' ? scope : vscode.workspace.workspaceFolders?.[0];
    const execution = new vscode.ProcessExecution(this.server.program() ?? 'rungwise', args, {
      ...(folder === undefined ? {} : { cwd: folder.uri.fsPath }),
      // Colours would stand between the words that the problem matcher reads.
      env: { NO_COLOR: '1' },
    });
    const task = new vscode.Task(
      definition,
      scope ?? vscode.TaskScope.Workspace,
      taskName(definition),
      TASK_TYPE,
      execution,
      definition['command'] === 'check' ? ['$rungwise'] : [],
    );
    if (definition['command'] === 'check') {
      task.group = vscode.TaskGroup.Build;
    }
    task.presentationOptions = { reveal: vscode.TaskRevealKind.Silent, clear: true };
    return task;
  }
}
