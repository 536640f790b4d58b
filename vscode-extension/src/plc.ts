/** A PLC on a line, as the server tells of it: its state, and the rows that the view shows of it. Pure. */

import type { PlainRange } from './structuralEdits';
import { t } from './words';

/** The notification of the server that has a {@link PlcState}. */
export const PLC_STATE = 'rungwise/plc';
/** The command of the server with this verb. */
export const plc = (verb: string): string => `rungwise.plc.${verb}`;

/** Documents of this scheme show both sides of a difference between PLC and editor. */
export const PLC_SCHEME = 'rungwise-plc';

/** Whether a document may be the program of a PLC. The list that was read from one is none to compare with it. */
export function isProgram(document: { readonly languageId: string; readonly uri: { readonly scheme: string } }): boolean {
  return ['ladder', 'plc-il'].includes(document.languageId) && document.uri.scheme !== PLC_SCHEME;
}

/** What the server knows of the PLC. */
export interface PlcState {
  readonly connected: boolean;
  readonly port?: string;
  readonly title?: string;
  readonly version?: string;
  readonly mode?: 'RUN' | 'STOP';
  readonly capacity?: number;
  readonly sum?: string;
  readonly scanTimeMs?: number;
  readonly errors: readonly { readonly register: string; readonly code: number }[];
  readonly monitoring?: string;
  readonly match?: 'same' | 'different' | 'unknown';
  readonly drift: readonly PlainRange[];
  /** Why the line is gone. */
  readonly reason?: string;
}

export const NO_PLC: PlcState = { connected: false, errors: [], drift: [] };

/** Reads a state; what is none says that no PLC is connected. */
export function parseState(params: unknown): PlcState {
  const given = (params ?? {}) as Partial<PlcState> & { readonly scan_time_ms?: number };
  if (given.connected !== true) {
    return typeof given.reason === 'string' ? { ...NO_PLC, reason: given.reason } : NO_PLC;
  }
  const errors = Array.isArray(given.errors) ? given.errors : [];
  const drift = Array.isArray(given.drift) ? given.drift : [];
  return { ...given, connected: true, errors, drift, ...(given.scan_time_ms === undefined ? {} : { scanTimeMs: given.scan_time_ms }) };
}

/** The notification of the server about an alarm. */
export const ALARM = 'rungwise/alarm';

/** An alarm that was raised, as the server tells of it. */
export interface Alarm {
  readonly uri: string;
  readonly source: 'plc' | 'simulator';
  readonly when: string;
  readonly message: string;
  readonly severity: 'error' | 'warning' | 'hint';
  /** When it was raised, and when it was gone: milliseconds since 1970. */
  readonly raisedAt: number;
  readonly goneAt?: number;
}

/** So many alarms are kept, the newest first. */
const MOST_ALARMS = 50;

/** The alarms with what the server tells of one; what is no such notification changes nothing. */
export function noteAlarm(alarms: readonly Alarm[], params: unknown): readonly Alarm[] {
  const given = (params ?? {}) as Partial<Alarm> & { readonly raised?: boolean; readonly at_ms?: number };
  const { uri, source, when, message, severity, raised, at_ms: at } = given;
  const isAlarm = typeof uri === 'string' && typeof when === 'string' && typeof message === 'string' && typeof at === 'number';
  if (!isAlarm || (source !== 'plc' && source !== 'simulator') || severity === undefined) {
    return alarms;
  }
  const isSame = (alarm: Alarm) => alarm.uri === uri && alarm.source === source && alarm.when === when && alarm.goneAt === undefined;
  if (raised === true) {
    const others = alarms.filter((alarm) => !isSame(alarm));
    return [{ uri, source, when, message, severity, raisedAt: at }, ...others].slice(0, MOST_ALARMS);
  }
  return alarms.map((alarm) => (isSame(alarm) ? { ...alarm, goneAt: at } : alarm));
}

/** Of the alarms in PLCs those of the program that is monitored now: what of others was there is over. */
export function alarmsOf(alarms: readonly Alarm[], monitored: string | undefined): readonly Alarm[] {
  return monitored === undefined ? alarms : alarms.filter(({ source, uri }) => source !== 'plc' || uri === monitored);
}

/** Those that are raised now. */
export function raised(alarms: readonly Alarm[]): readonly Alarm[] {
  return alarms.filter(({ goneAt }) => goneAt === undefined);
}

const BELLS = { error: 'error', warning: 'warning', hint: 'info' } as const;

/** The rows of the view about alarms; `clock` says a time as people read it. */
export function alarmRows(alarms: readonly Alarm[], clock: (at: number) => string): PlcRow[] {
  return alarms.map(({ source, when, message, severity, raisedAt, goneAt }) => {
    const span = goneAt === undefined ? t('since {0}', clock(raisedAt)) : `${clock(raisedAt)} – ${clock(goneAt)}`;
    const description = source === 'plc' ? span : `${span} · ${t('simulation')}`;
    const icon = goneAt === undefined ? BELLS[severity] : 'pass';
    return { id: `alarm ${source} ${when} ${raisedAt}`, label: message, description, icon, tooltip: when };
  });
}

/** A row of the view. */
export interface PlcRow {
  readonly id: string;
  readonly label: string;
  readonly description: string;
  readonly icon: string;
  readonly tooltip?: string;
}

/** What the view shows of a PLC; nothing while none is connected. */
export function rowsOf(state: PlcState): PlcRow[] {
  if (!state.connected) {
    return [];
  }
  const runs = state.mode === 'RUN';
  const rows = [
    { id: 'model', label: state.title ?? '', description: state.version ?? '', icon: 'circuit-board' },
    { id: 'port', label: t('Port'), description: state.port ?? '', icon: 'plug' },
    { id: 'mode', label: t('Mode'), description: state.mode ?? '', icon: runs ? 'play-circle' : 'stop-circle' },
    { id: 'match', label: t('Program'), ...match(state) },
    { id: 'memory', label: t('Memory'), description: t('{0} steps, sum {1}', state.capacity ?? 0, state.sum ?? ''), icon: 'database' },
    { id: 'scan', label: t('Scan time'), description: `${state.scanTimeMs ?? 0} ms`, icon: 'watch' },
  ];
  const errors = state.errors.map(({ register, code }) => ({ id: `error ${register}`, label: t('Error'), description: `${register} = ${code}`, icon: 'error' }));
  return [...rows, ...errors];
}

function match(state: PlcState): Pick<PlcRow, 'description' | 'icon'> {
  switch (state.match) {
    case 'same':
      return { description: t('as in the editor'), icon: 'check' };
    case 'different':
      return { description: t('not as in the editor'), icon: 'diff' };
    default:
      return { description: t('not compared yet'), icon: 'question' };
  }
}

/** What the status bar says: the model, its mode, and a sign where the program is another one. */
export function statusText(state: PlcState): string {
  const icon = state.mode === 'RUN' ? '$(play-circle)' : '$(stop-circle)';
  const drift = state.match === 'different' ? ' $(diff)' : '';
  return `${icon} ${state.title ?? 'PLC'} ${state.mode ?? ''}${drift}`;
}
