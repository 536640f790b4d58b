/** The status bar item as data: what the server says about a program, and how it is shown. */

import { t } from './words';

/** Parameters of the notification `rungwise/status`. */
export interface ProgramStatus {
  readonly uri: string;
  /** Model that the program is checked for, as `fx2n` or `iec`. */
  readonly target: string;
  /** `fx`, `iec` or `ladder`. */
  readonly dialect: string;
  /** Program steps used; absent when the target does not count steps. */
  readonly steps: number | undefined;
  /** Program steps that the model has; absent as above. */
  readonly capacity: number | undefined;
  readonly rungs: number | undefined;
}

export type ServerState = 'starting' | 'running' | 'stopped' | 'failed';

export interface StatusItem {
  readonly text: string;
  readonly tooltip: string;
  /** Command of a click. */
  readonly command: string;
  readonly severity: 'normal' | 'warning' | 'error';
}

/** Checks what came over the wire; `undefined` if it is not a status. */
export function parseStatus(value: unknown): ProgramStatus | undefined {
  if (typeof value !== 'object' || value === null) {
    return undefined;
  }
  const fields = value as Record<string, unknown>;
  const uri = fields['uri'];
  if (typeof uri !== 'string') {
    return undefined;
  }
  return {
    uri,
    target: text(fields['target']),
    dialect: text(fields['dialect']),
    steps: count(fields['steps']),
    capacity: count(fields['capacity']) || undefined,
    rungs: count(fields['rungs']),
  };
}

/** What the status bar shows for the active document. */
export function statusItem(state: ServerState, status: ProgramStatus | undefined): StatusItem {
  if (state !== 'running') {
    return serverStateItem(state);
  }
  if (status === undefined) {
    return item('$(circuit-board) Rungwise', t('Rungwise is running. Click to select the target PLC.'));
  }
  const parts = [status.target.toUpperCase() || 'Rungwise'];
  if (status.dialect && status.dialect !== status.target && status.dialect !== 'ladder') {
    parts.push(status.dialect.toUpperCase());
  }
  const steps = stepsText(status);
  if (steps !== undefined) {
    parts.push(steps);
  }
  const full = status.steps !== undefined && status.capacity !== undefined && status.steps > status.capacity;
  return {
    ...item(`$(circuit-board) ${parts.join(' · ')}`, tooltip(status)),
    severity: full ? 'warning' : 'normal',
  };
}

function serverStateItem(state: Exclude<ServerState, 'running'>): StatusItem {
  switch (state) {
    case 'starting':
      return { ...item('$(loading~spin) Rungwise', t('The Rungwise server is starting.')), command: 'rungwise.showOutput' };
    case 'stopped':
      return {
        text: '$(circle-slash) Rungwise',
        tooltip: t('The Rungwise server is stopped. Click to start it.'),
        command: 'rungwise.restartServer',
        severity: 'warning',
      };
    case 'failed':
      return {
        text: '$(error) Rungwise',
        tooltip: t('The Rungwise server does not run. Click for the output.'),
        command: 'rungwise.showOutput',
        severity: 'error',
      };
  }
}

function item(label: string, tip: string): StatusItem {
  return { text: label, tooltip: tip, command: 'rungwise.selectTarget', severity: 'normal' };
}

function stepsText(status: ProgramStatus): string | undefined {
  if (status.steps === undefined) {
    return undefined;
  }
  if (status.capacity === undefined) {
    return t('{0} steps', grouped(status.steps));
  }
  return t('{0}/{1} steps', grouped(status.steps), grouped(status.capacity));
}

function tooltip(status: ProgramStatus): string {
  const lines = [t('Target PLC: {0}', status.target.toUpperCase() || t('unknown'))];
  if (status.dialect) {
    lines.push(t('Dialect: {0}', status.dialect));
  }
  if (status.steps !== undefined && status.capacity) {
    const percent = ((100 * status.steps) / status.capacity).toFixed(1);
    lines.push(t('Program: {0} of {1} steps ({2} %)', grouped(status.steps), grouped(status.capacity), percent));
  }
  if (status.rungs !== undefined) {
    lines.push(t('Rungs: {0}', grouped(status.rungs)));
  }
  lines.push(t('Click to select the target PLC.'));
  return lines.join('\n');
}

/** Groups by thousands in one way everywhere; the locale of the editor would make screenshots and tests differ. */
function grouped(value: number): string {
  return String(value).replace(/\B(?=(\d{3})+$)/g, ',');
}

function text(value: unknown): string {
  return typeof value === 'string' ? value : '';
}

function count(value: unknown): number | undefined {
  return typeof value === 'number' && Number.isFinite(value) && value >= 0 ? Math.round(value) : undefined;
}
