/** The page "Show Status": everything that one wants to know before one looks for a fault. */

import * as vscode from 'vscode';
import type { ProgramStatus, ServerState } from './status';

/** What is known about the server. */
export interface ServerReport {
  readonly state: ServerState;
  readonly version: string | undefined;
  /** Path of the program and where it came from; the places that were tried if there is none. */
  readonly program: string | undefined;
  readonly origin: string;
  readonly tried: readonly string[];
  readonly arguments: readonly string[];
  /** Settings as the server gets them. */
  readonly settings: unknown;
  readonly extensionVersion: string;
}

/** The page in Markdown. */
export function statusPage(report: ServerReport, programs: readonly ProgramStatus[]): string {
  const { t } = vscode.l10n;
  const lines = [
    '# Rungwise',
    '',
    '| | |',
    '|---|---|',
    row(t('Server'), report.state),
    row(t('Version'), report.version ?? '–'),
    row(t('Program'), report.program ?? `– (${report.tried.join(', ')})`),
    row(t('Found through'), report.origin),
    row(t('Arguments'), report.arguments.join(' ')),
    row(t('Extension'), report.extensionVersion),
    row('VS Code', vscode.version),
    row(t('Trusted workspace'), vscode.workspace.isTrusted ? t('yes') : t('no: paths of the workspace are not used')),
    '',
    `## ${t('Programs')}`,
    '',
    `| ${t('File')} | ${t('Target')} | ${t('Dialect')} | ${t('Steps')} | ${t('Rungs')} |`,
    '|---|---|---|---|---|',
    ...programs.map((program) => {
      const steps = [program.steps, program.capacity].filter((count) => count !== undefined).join(' / ');
      const file = vscode.workspace.asRelativePath(vscode.Uri.parse(program.uri));
      return `| ${[file, program.target, program.dialect, steps, program.rungs ?? ''].map(cell).join(' | ')} |`;
    }),
    '',
    `## ${t('Settings')}`,
    '',
    '```json',
    JSON.stringify(report.settings, null, 2),
    '```',
    '',
  ];
  return lines.join('\n');
}

function row(name: string, value: string): string {
  return `| ${cell(name)} | ${cell(value)} |`;
}

function cell(value: unknown): string {
  return String(value).replaceAll('|', '\\|').replaceAll('\n', ' ');
}
