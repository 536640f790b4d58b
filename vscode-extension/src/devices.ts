/** The tree of devices in use: kinds, their devices with the free ones between them, and the uses of a device. */

import { t } from './words';

/** A use of a device; line and column count from 1, columns in Unicode scalar values. */
export interface DeviceUse {
  readonly uri: string;
  readonly file: string;
  readonly line: number;
  readonly column: number;
  readonly rung: number | undefined;
  readonly access: string;
  readonly text: string;
}

export type DeviceNode =
  | { readonly type: 'kind'; readonly word: string; readonly name: string; readonly used: number; readonly next: string }
  | {
      readonly type: 'device';
      readonly name: string;
      readonly symbol: string;
      readonly comment: string;
      readonly preset: string;
      readonly latched: boolean;
      readonly reads: number;
      readonly writes: number;
    }
  | { readonly type: 'gap'; readonly first: string; readonly last: string; readonly count: number }
  | {
      readonly type: 'use';
      readonly use: DeviceUse;
      readonly device: string;
      readonly number: number;
      readonly showsFile: boolean;
    };

export type KindNode = Extract<DeviceNode, { type: 'kind' }>;
export type UsedDeviceNode = Extract<DeviceNode, { type: 'device' }>;
type GapNode = Extract<DeviceNode, { type: 'gap' }>;

/** A node as it is shown. */
export interface DeviceItem {
  /** The same for the same thing in a newer list, so that what is open stays open. */
  readonly id: string;
  readonly label: string;
  readonly description: string;
  readonly tooltip: string;
  /** Name of a product icon of VS Code. */
  readonly icon: string;
  readonly state: 'leaf' | 'closed' | 'open';
}

/** The list of a program or project; devices come in reading order. */
export class DeviceList {
  private constructor(
    private readonly kinds: readonly KindNode[],
    private readonly rows: ReadonlyMap<string, readonly { device: UsedDeviceNode; gaps: readonly GapNode[] }[]>,
    /** How many files the program has. */
    readonly files: number,
  ) {}

  /** Reads the answer of the server command `rungwise.usage`; `undefined` if it is none. */
  static of(answer: unknown): DeviceList | undefined {
    const { kinds, devices, files } = record(answer);
    if (!Array.isArray(kinds) || !Array.isArray(devices)) {
      return undefined;
    }
    const rows = new Map<string, { device: UsedDeviceNode; gaps: GapNode[] }[]>();
    for (const row of devices.map(record)) {
      const kind = text(row['kind']);
      const own = rows.get(kind) ?? [];
      own.push({ device: deviceOf(row), gaps: list(row['gaps']).map(record).map(gapOf) });
      rows.set(kind, own);
    }
    return new DeviceList(kinds.map(record).map(kindOf), rows, list(files).length);
  }

  /** How many devices there are, and how many of them match. */
  count(filter: string): { all: number; matching: number } {
    const all = [...this.rows.values()].flat();
    return { all: all.length, matching: all.filter(({ device }) => matches(device, filter)).length };
  }

  /** The kinds with a device that matches. */
  roots(filter: string): KindNode[] {
    return this.kinds.filter((kind) => this.rowsOf(kind).some(({ device }) => matches(device, filter)));
  }

  /** The devices of a kind that match; without a filter the free ones between them, too. */
  children(kind: KindNode, filter: string): DeviceNode[] {
    const rows = this.rowsOf(kind);
    return filter === ''
      ? rows.flatMap(({ device, gaps }) => [device, ...gaps])
      : rows.map(({ device }) => device).filter((device) => matches(device, filter));
  }

  private rowsOf(kind: KindNode): readonly { device: UsedDeviceNode; gaps: readonly GapNode[] }[] {
    return this.rows.get(kind.word) ?? [];
  }
}

/** The uses in an answer of `rungwise.usage` that was asked about one device. */
export function usesOf(answer: unknown, device: string): DeviceNode[] {
  const { devices, files } = record(answer);
  const showsFile = list(files).length > 1;
  const uses = list(devices).flatMap((row) => list(record(row)['uses'])).map(record).map(useOf);
  return uses.map((use, number) => ({ type: 'use', use, device, number, showsFile }));
}

/** Whether the name, the symbol or the comment of a device has all the words of `filter`. */
function matches(device: UsedDeviceNode, filter: string): boolean {
  const said = `${device.name} ${device.symbol} ${device.comment}`.toLowerCase();
  return filter.toLowerCase().split(/\s+/).every((word) => said.includes(word));
}

/** How a node is shown; `filter` is what it was found with. */
export function itemOf(node: DeviceNode, filter: string): DeviceItem {
  switch (node.type) {
    case 'kind':
      return {
        // What a person has opened or closed while looking for something says nothing of the whole list.
        id: `kind:${node.word}${filter === '' ? '' : ':found'}`,
        label: node.word.length === 1 ? `${node.word} ${node.name}` : node.name,
        description: [t('{0} used', node.used), node.next && t('next free: {0}', node.next)].filter(Boolean).join(' · '),
        tooltip: '',
        icon: KIND_ICONS[node.word] ?? 'symbol-misc',
        state: filter === '' ? 'closed' : 'open',
      };
    case 'device': {
      const counts = t('read {0} ×, written {1} ×', node.reads, node.writes);
      const said = [node.symbol, node.comment].filter((words) => words !== '');
      return {
        id: `device:${node.name}`,
        label: node.name,
        description: [...said, node.preset, counts].filter((words) => words !== '').join(' · '),
        tooltip: [[node.name, ...said].join(' · '), node.preset, counts, node.latched ? t('keeps its value without power') : '']
          .filter((line) => line !== '')
          .join('\n'),
        icon: ACCESS_ICONS[accessOf(node)] ?? '',
        state: 'closed',
      };
    }
    case 'gap':
      return {
        id: `gap:${node.first}`,
        label: node.first === node.last ? node.first : `${node.first}–${node.last}`,
        description: t('{0} free', node.count),
        tooltip: t('Not used between devices in use'),
        icon: 'dash',
        state: 'leaf',
      };
    case 'use': {
      const { file, line, rung, access } = node.use;
      const place = node.showsFile ? `${file}:${line}` : t('line {0}', line);
      return {
        // A place alone does not tell uses apart: one word may stand for two of them.
        id: `use:${node.device}:${node.number}`,
        label: node.use.text,
        description: rung === undefined ? place : `${place} · ${t('rung {0}', rung)}`,
        tooltip: accessWords(access),
        icon: ACCESS_ICONS[access] ?? 'circle-small',
        state: 'leaf',
      };
    }
  }
}

const KIND_ICONS: Readonly<Record<string, string>> = {
  X: 'sign-in', Y: 'sign-out', M: 'circle-outline', S: 'list-ordered', T: 'watch', C: 'symbol-numeric', D: 'database',
  R: 'database', V: 'list-selection', Z: 'list-selection', P: 'bookmark', I: 'zap', N: 'list-tree', address: 'location',
  variable: 'symbol-variable',
};

const ACCESS_ICONS: Readonly<Record<string, string>> = {
  read: 'eye', write: 'edit', 'read-write': 'arrow-swap', define: 'symbol-constant', jump: 'debug-step-over',
};

/** What all uses of a device together do. */
function accessOf({ reads, writes }: UsedDeviceNode): string {
  if (reads > 0) {
    return writes > 0 ? 'read-write' : 'read';
  }
  return writes > 0 ? 'write' : 'define';
}

function accessWords(access: string): string {
  switch (access) {
    case 'read':
      return t('read');
    case 'write':
      return t('written');
    case 'read-write':
      return t('read and written');
    case 'define':
      return t('defined');
    default:
      return t('jumped to');
  }
}

function kindOf(row: Record<string, unknown>): KindNode {
  return { type: 'kind', word: text(row['kind']), name: text(row['name']), used: count(row['used']), next: text(row['next']) };
}

function deviceOf(row: Record<string, unknown>): UsedDeviceNode {
  return {
    type: 'device',
    name: text(row['device']),
    symbol: text(row['symbol']),
    comment: text(row['comment']),
    preset: text(row['preset']),
    latched: row['latched'] === true,
    reads: count(row['reads']),
    writes: count(row['writes']),
  };
}

function gapOf(row: Record<string, unknown>): GapNode {
  return { type: 'gap', first: text(row['first']), last: text(row['last']), count: count(row['count']) };
}

function useOf(row: Record<string, unknown>): DeviceUse {
  return {
    uri: text(row['uri']),
    file: text(row['file']),
    line: count(row['line']),
    column: count(row['column']),
    rung: typeof row['rung'] === 'number' ? row['rung'] : undefined,
    access: text(row['access']),
    text: text(row['text']),
  };
}

const record = (value: unknown): Record<string, unknown> =>
  typeof value === 'object' && value !== null ? (value as Record<string, unknown>) : {};
const list = (value: unknown): unknown[] => (Array.isArray(value) ? value : []);
const text = (value: unknown): string => (typeof value === 'string' ? value : '');
const count = (value: unknown): number => (typeof value === 'number' ? value : 0);
