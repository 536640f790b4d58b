/** What is on the panel of a program: rows in groups, as the server's `rungwise.simulate.panel` tells them. Pure. */

import type { Source } from '../simulation';
import { t } from '../words';

export type Group = 'inputs' | 'outputs' | 'timers' | 'counters' | 'states' | 'relays' | 'registers' | 'variables';
export type Value = boolean | number | string;

/** A device or variable on the panel. */
export interface Row {
  /** Its name for the server: of a timer that of its current value. */
  readonly name: string;
  /** Its name for people. */
  readonly label: string;
  readonly group: Group;
  readonly type: 'bit' | 'word';
  readonly symbol: string;
  readonly comment: string;
  readonly least?: number;
  readonly greatest?: number;
  /** The contact of a timer or counter. */
  readonly contact?: string;
  readonly preset?: number;
  /** Where the preset lies. */
  readonly presetOf?: string;
  /** What a timer counts. */
  readonly unitMs?: number;
}

/** Where a simulation is; of a PLC, scans are milliseconds from the first look on. */
export interface Moment {
  readonly source: Source;
  readonly mode: 'running' | 'paused' | 'stopped';
  readonly scan: number;
  readonly timeMs: number;
  /** How many moments the values are of. */
  readonly exchanges?: number;
  readonly edition: number;
  readonly branch: number;
  readonly firstScan?: number;
  readonly scanMs?: number;
  readonly speed?: number;
  readonly values: readonly Reading[];
}

/** What something is at a moment. */
export interface Reading {
  readonly device: string;
  readonly value: Value;
  readonly forced: boolean;
  /** What an input will be in the next scan, if that is something else. */
  readonly wired?: boolean;
}

const GROUPS: readonly Group[] = ['inputs', 'outputs', 'timers', 'counters', 'states', 'relays', 'registers', 'variables'];

export function groupTitle(group: Group): string {
  switch (group) {
    case 'inputs':
      return t('Inputs');
    case 'outputs':
      return t('Outputs');
    case 'timers':
      return t('Timers');
    case 'counters':
      return t('Counters');
    case 'states':
      return t('States');
    case 'relays':
      return t('Relays');
    case 'registers':
      return t('Registers');
    case 'variables':
      return t('Variables');
  }
}

/** A variable that can be added to the panel of a program of IEC 61131-3; a PLC with devices has those. */
export function variableToAdd(rows: readonly Row[]): string | undefined {
  const isDevice = ({ name }: Row) => /^[A-Z]{1,2}\d+$/i.test(name);
  return rows.some(isDevice) ? undefined : (rows.find(({ contact }) => contact !== undefined)?.contact ?? rows[0]?.name);
}

/** Reads the rows of an answer; what is none is left out. */
export function parseRows(answer: unknown): Row[] {
  const rows = (answer as { rows?: unknown } | null)?.rows;
  return (Array.isArray(rows) ? rows : []).flatMap((given: Record<string, unknown>) => {
    const { name, group, type } = given;
    if (typeof name !== 'string' || !GROUPS.includes(group as Group) || (type !== 'bit' && type !== 'word')) {
      return [];
    }
    const text = (member: string) => (typeof given[member] === 'string' ? (given[member] as string) : '');
    const numbers = { least: 'least', greatest: 'greatest', preset: 'preset', unitMs: 'unit_ms' } as const;
    const present = Object.entries(numbers).filter(([, member]) => typeof given[member] === 'number');
    const words = Object.entries({ contact: 'contact', presetOf: 'preset_of' }).filter(([, member]) => text(member) !== '');
    return [
      {
        name,
        label: text('label') || name,
        group: group as Group,
        type,
        symbol: text('symbol'),
        comment: text('comment'),
        ...Object.fromEntries([...present, ...words].map(([own, member]) => [own, given[member]])),
      },
    ];
  });
}

/** Reads a state or a picture of the server; `undefined` if it is none. */
export function parseMoment(given: unknown): Moment | undefined {
  const state = given as Record<string, unknown> | null;
  const mode = state?.['mode'];
  if (state === null || (mode !== 'running' && mode !== 'paused' && mode !== 'stopped')) {
    return undefined;
  }
  const number = (member: string) => Number(state[member] ?? 0);
  const optional = Object.entries({ firstScan: 'first_scan', scanMs: 'scan_ms', speed: 'speed' }).filter(
    ([, member]) => typeof state[member] === 'number',
  );
  const source = state['source'] === 'plc' ? 'plc' : 'simulator';
  return {
    source,
    mode: source === 'plc' ? 'running' : mode,
    scan: source === 'plc' ? Math.floor(number('time_ms')) : number('scan'),
    ...(source === 'plc' && { scanMs: 1 }),
    timeMs: number('time_ms'),
    ...(typeof state['exchanges'] === 'number' && { exchanges: state['exchanges'] }),
    edition: number('edition'),
    branch: number('branch'),
    values: Array.isArray(state['values']) ? (state['values'] as Reading[]) : [],
    ...Object.fromEntries(optional.map(([own, member]) => [own, state[member]])),
  };
}

/** The rows in which all words of `filter` occur, group by group in the order of panels. */
export function grouped(rows: readonly Row[], filter: string): { readonly group: Group; readonly rows: Row[] }[] {
  const words = filter.toLowerCase().split(/\s+/).filter(Boolean);
  const has = ({ label, symbol, comment }: Row) => {
    const text = `${label} ${symbol} ${comment}`.toLowerCase();
    return words.every((word) => text.includes(word));
  };
  const shown = rows.filter(has);
  return GROUPS.map((group) => ({ group, rows: shown.filter((row) => row.group === group) })).filter(
    (found) => found.rows.length > 0,
  );
}

/** How the value of a register is written: the last two take the register behind it, too. */
export const BASES = ['decimal', 'hexadecimal', 'binary', 'double', 'float'] as const;
export type Base = (typeof BASES)[number];

export function baseTitle(base: Base): string {
  switch (base) {
    case 'decimal':
      return t('Decimal');
    case 'hexadecimal':
      return t('Hexadecimal');
    case 'binary':
      return t('Binary');
    case 'double':
      return t('32 bits');
    case 'float':
      return t('Floating point');
  }
}

/** The bases in which a row can be shown. */
export function basesOf({ name, type, unitMs }: Row): readonly Base[] {
  if (type === 'bit' || unitMs !== undefined) {
    return ['decimal'];
  }
  return /^D\d+$/.test(name) ? BASES : BASES.slice(0, 3);
}

/** What is read for a row in a base: of two registers the number of 32 bits. */
export function readAs(name: string, base: Base): string {
  return base === 'double' || base === 'float' ? `${name}:32` : name;
}

/** A number as it is written in a base. */
export function written(value: Value, base: Base): string {
  if (typeof value !== 'number' || !Number.isInteger(value)) {
    return String(value);
  }
  const bits = value >= -0x8000 && value <= 0x7fff ? 16 : 32;
  const pattern = bits === 16 ? value & 0xffff : value >>> 0;
  switch (base) {
    case 'hexadecimal':
      return `H${pattern.toString(16).toUpperCase().padStart(bits / 4, '0')}`;
    case 'binary':
      return (pattern.toString(2).padStart(bits, '0').match(/.{4}/g) ?? []).join(' ');
    case 'float':
      return shortest(floatOf(value));
    default:
      return String(value);
  }
}

/** The number that was typed in a base; `undefined` for what is none. */
export function typedIn(text: string, base: Base, row: Pick<Row, 'least' | 'greatest'>): number | undefined {
  const bare = text.replaceAll(/[\s_]/g, '');
  switch (base) {
    case 'hexadecimal':
      return signed(/^(H|16#|0x)?[0-9a-f]+$/i.test(bare) ? Number.parseInt(bare.replace(/^(H|16#|0x)/i, ''), 16) : NaN, row);
    case 'binary':
      return signed(/^(2#|0b)?[01]+$/i.test(bare) ? Number.parseInt(bare.replace(/^(2#|0b)/i, ''), 2) : NaN, row);
    case 'double':
      return typedNumber(text, { least: -0x80000000, greatest: 0x7fffffff });
    case 'float': {
      const real = Number(bare);
      return bare === '' || !Number.isFinite(Math.fround(real)) ? undefined : bitsOf(real);
    }
    default:
      return typedNumber(text, row);
  }
}

/** A pattern of bits as the signed number that it is in 16 or 32 bits. */
function signed(pattern: number, { least = -0x8000 }: Pick<Row, 'least'>): number | undefined {
  const bits = least < -0x8000 ? 32 : 16;
  if (!(pattern < 2 ** bits)) {
    return undefined;
  }
  return pattern >= 2 ** (bits - 1) ? pattern - 2 ** bits : pattern;
}

const CELL = new DataView(new ArrayBuffer(4));

function floatOf(bits: number): number {
  CELL.setInt32(0, bits);
  return CELL.getFloat32(0);
}

function bitsOf(real: number): number {
  CELL.setFloat32(0, real);
  return CELL.getInt32(0);
}

/** The fewest digits that are this number of single precision. */
function shortest(real: number): string {
  for (let digits = 1; digits < 9; digits++) {
    const text = real.toPrecision(digits);
    if (Math.fround(Number(text)) === real) {
      return String(Number(text));
    }
  }
  return String(real);
}

/** All names whose values a row shows. */
export function namesOf(row: Row, base: Base = 'decimal'): string[] {
  return [row.name, readAs(row.name, base), row.contact, row.presetOf].filter((name, at, all) => name !== undefined && all.indexOf(name) === at) as string[];
}

/** What a chart shows when nobody has chosen: inputs, outputs, and timers. */
export function firstSignals(rows: readonly Row[]): string[] {
  const of = (group: Group, most: number) =>
    rows.filter((row) => row.group === group).slice(0, most).map(({ name }) => name);
  const first = [...of('inputs', 4), ...of('outputs', 4), ...of('timers', 2), ...of('counters', 1)];
  return first.length > 0 ? first : rows.slice(0, 6).map(({ name }) => name);
}

/** The number of a timer's units, or of anything else, as people read it: `1.2 s`. */
export function reading(value: Value, unitMs: number | undefined): string {
  if (typeof value !== 'number' || unitMs === undefined) {
    return String(value);
  }
  const places = unitMs >= 100 ? 1 : unitMs >= 10 ? 2 : 3;
  return `${((value * unitMs) / 1000).toFixed(places)} s`;
}

/** How much of its preset a timer or counter has, from 0 to 1; `undefined` if that is not known. */
export function progress(value: Value, preset: Value | undefined): number | undefined {
  if (typeof value !== 'number' || typeof preset !== 'number' || preset <= 0) {
    return undefined;
  }
  return Math.min(Math.max(value / preset, 0), 1);
}

/** The ends of a slider on which a value can be moved with some feeling: powers of ten within what the word can have. */
export function sliderEnds(value: number, { least = -32768, greatest = 32767 }: Pick<Row, 'least' | 'greatest'>): [number, number] {
  let end = 100;
  while (end < Math.abs(value)) {
    end *= 10;
  }
  return [value < 0 ? Math.max(-end, least) : 0, Math.min(end, greatest)];
}

/** Whether a person may switch it: the program writes outputs and contacts again in each scan. */
export function isSwitch({ type, group }: Row): boolean {
  return type === 'bit' && group !== 'outputs';
}

/** The number that was typed, within what the row takes; `undefined` for what is none. Words of the PLC are whole. */
export function typedNumber(text: string, { least, greatest }: Pick<Row, 'least' | 'greatest'>): number | undefined {
  const word = text.trim();
  const value = /^(H|16#|0x)[0-9a-f]+$/i.test(word) ? Number.parseInt(word.replace(/^(H|16#|0x)/i, ''), 16) : Number(word);
  if (word === '' || !Number.isFinite(value)) {
    return undefined;
  }
  return least === undefined || greatest === undefined || (Number.isInteger(value) && least <= value && value <= greatest) ? value : undefined;
}
