/** What a simulation shows in the text: the server's pictures, sorted by how they are painted. Pure. */

import type { PlainRange } from './structuralEdits';
import { t } from './words';

/** The notification of the server that has a {@link Picture}. */
export const MONITOR = 'rungwise/monitor';
/** The command of the server with this verb. */
export const simulate = (verb: string): string => `rungwise.simulate.${verb}`;

/** Where a program runs. */
export type Source = 'simulator' | 'plc';

export type Mode = 'running' | 'paused' | 'stopped';

/** What of a program is on the screen, in one scan. */
export interface Picture {
  readonly uri: string;
  readonly version: number;
  readonly source: Source;
  readonly mode: Mode;
  readonly scan: number;
  readonly timeMs: number;
  /** How many moments the values are of: exchanges on the line to a PLC. */
  readonly exchanges: number;
  /** Wires and contacts that power comes through, outputs that have it, lines behind which the result is on. */
  readonly energised: readonly PlainRange[];
  /** Contacts that conduct without power. */
  readonly ready: readonly PlainRange[];
  /** Values beside the words that name them. */
  readonly values: readonly { readonly range: PlainRange; readonly value: string }[];
  /** Names of what is forced, with what it is held at. */
  readonly forced: readonly { readonly range: PlainRange; readonly value: string }[];
  readonly errors: readonly { readonly range: PlainRange; readonly message: string }[];
}

interface Element {
  readonly range: PlainRange;
  readonly kind: string;
  readonly energised: boolean;
  readonly conducts?: boolean;
  readonly value?: unknown;
}

/** Reads a notification; `undefined` if it is none. */
export function parsePicture(params: unknown): Picture | undefined {
  const given = params as Partial<Record<keyof Picture | 'time_ms' | 'elements', unknown>> | null;
  if (typeof given?.uri !== 'string' || typeof given.version !== 'number' || !Array.isArray(given.elements)) {
    return undefined;
  }
  const elements = given.elements as readonly Element[];
  const valued = (wanted: string) =>
    elements.filter(({ kind }) => kind === wanted).map(({ range, value }) => ({ range, value: String(value) }));
  return {
    uri: given.uri,
    version: given.version,
    source: given.source === 'plc' ? 'plc' : 'simulator',
    mode: given.mode === 'paused' || given.mode === 'stopped' ? given.mode : 'running',
    scan: Number(given.scan),
    timeMs: Number(given.time_ms),
    exchanges: Number(given.exchanges ?? 1),
    energised: elements.filter(({ energised }) => energised).map(({ range }) => range),
    ready: elements.filter(({ energised, conducts }) => !energised && conducts === true).map(({ range }) => range),
    values: valued('value'),
    forced: valued('forced'),
    errors: (Array.isArray(given.errors) ? given.errors : []) as Picture['errors'],
  };
}

/** What the status bar says of a look at a PLC. */
export function lookText({ scan, timeMs, exchanges }: Pick<Picture, 'scan' | 'timeMs' | 'exchanges'>): string {
  const several = exchanges > 1 ? ` · ${t('values of up to {0} scans', exchanges)}` : '';
  return `$(plug) ${t('PLC, look {0}', scan)} · ${clock(timeMs)}${several}`;
}

/** A time as people read it: `0.35 s`, `12 min 5 s`. */
export function clock(timeMs: number): string {
  const seconds = timeMs / 1000;
  const minutes = Math.floor(seconds / 60);
  return minutes === 0 ? `${seconds.toFixed(2)} s` : `${minutes} min ${Math.floor(seconds % 60)} s`;
}

/** The device at a place of a line: a letter of a bit device and its number, as in `X0` or `M8000`. */
export function deviceAt(line: string, character: number): string | undefined {
  const words = [...line.matchAll(/[A-Za-z_][A-Za-z0-9_.]*/g)];
  return words.find(({ 0: word, index }) => index <= character && character <= index + word.length)?.[0];
}
