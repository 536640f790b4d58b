/** What variables were over time, as far as it is known here: answers of `rungwise.simulate.trace` put together. Pure. */

import type { Value } from './rows';

export type Point = readonly [scan: number, value: Value];

/** The answer of the server. */
export interface TraceAnswer {
  readonly from: number;
  readonly to: number;
  readonly branch: number;
  readonly signals: readonly { readonly name: string; readonly known_from: number; readonly points: readonly Point[] }[];
}

/** A question to the server. */
export interface TraceQuestion {
  readonly names: readonly string[];
  readonly from: number;
  readonly to?: number;
  readonly most: number;
}

interface Signal {
  knownFrom: number;
  points: Point[];
}

/** More points than this are asked for anew, thinned by the server. */
const MOST_KEPT = 16_000;
/** So many points show more than a screen has pixels. */
export const MOST_ASKED = 4_000;
/** The newest scans are known one by one, whatever was left out before them. */
const TAIL = MOST_ASKED / 2;

export class Traces {
  private signals = new Map<string, Signal>();
  private branch = -1;
  private last = -1;
  /** What is known of a stretch of the past more closely than of all. */
  private close: { from: number; to: number; signals: Map<string, Signal> } | undefined;
  /** Up to this scan some changes were left out. */
  private thinnedTo = -1;

  /** The last scan that is known. */
  get lastScan(): number {
    return this.last;
  }

  /** What is to be asked so that `names` are known up to now. */
  question(names: readonly string[], branch: number): TraceQuestion {
    const isNew = names.some((name) => !this.signals.has(name));
    const isFull = [...this.signals.values()].some(({ points }) => points.length > MOST_KEPT);
    const isUnknown = names.some((name) => (this.signals.get(name)?.knownFrom ?? 0) > 0 && this.isSearching);
    const from = isNew || isFull || isUnknown || branch !== this.branch ? 0 : Math.max(this.last, 0);
    return { names, from, most: MOST_ASKED };
  }

  /** Whether the server may still find more of the past. */
  private isSearching = false;

  /** What is to be asked so that a stretch is known closely; `undefined` if it is. */
  closer(names: readonly string[], from: number, to: number): TraceQuestion | undefined {
    if (from > this.thinnedTo || (this.close !== undefined && this.close.from <= from && to <= this.close.to)) {
      return undefined;
    }
    const margin = Math.ceil((to - from) / 2);
    return { names, from: Math.max(0, from - margin), to: Math.min(to + margin, Math.max(this.last, 0)), most: MOST_ASKED };
  }

  /** Takes an answer. */
  take(question: TraceQuestion, answer: TraceAnswer): void {
    const signals = new Map(
      answer.signals.map(({ name, known_from: knownFrom, points }) => [name, { knownFrom, points: [...points] }]),
    );
    if (question.to !== undefined) {
      this.close = answer.branch === this.branch ? { from: answer.from, to: answer.to, signals } : undefined;
      return;
    }
    // A thinned answer has a quarter of the points at least, and one that is not thinned says so with fewer scans.
    const isThinned =
      answer.to - answer.from >= question.most && answer.signals.some(({ points }) => points.length > question.most / 4);
    this.last = answer.to;
    if (question.from === 0) {
      const known = Math.max(0, ...[...signals.values()].map(({ knownFrom }) => knownFrom));
      const before = Math.max(0, ...[...this.signals.values()].map(({ knownFrom }) => knownFrom));
      // Whoever finds no more in two questions has found all.
      this.isSearching = known > 0 && (this.branch !== answer.branch || known !== before);
      [this.signals, this.branch, this.close] = [signals, answer.branch, undefined];
      this.thinnedTo = isThinned ? answer.to - TAIL : -1;
      if (isThinned) {
        this.last = answer.to - TAIL;
        signals.forEach(({ points }) => points.splice(Math.max(behind(points, this.last), 1)));
      }
    } else {
      this.thinnedTo = isThinned ? answer.to : this.thinnedTo;
      for (const [name, { points }] of signals) {
        const known = this.signals.get(name);
        if (known !== undefined) {
          append(known.points, points);
        }
      }
    }
  }

  /** Forgets everything. */
  clear(): void {
    [this.signals, this.branch, this.last, this.close, this.thinnedTo] = [new Map(), -1, -1, undefined, -1];
  }

  /** The value at the start of a stretch, or the earliest one in it, and the changes in it. */
  points(name: string, from: number, to: number): readonly Point[] {
    const { close } = this;
    const isClose = close !== undefined && close.from <= from && to <= close.to;
    const points = ((isClose ? close.signals : this.signals).get(name) ?? this.signals.get(name))?.points ?? [];
    const begin = Math.max(behind(points, from) - 1, 0);
    return points.slice(begin, behind(points, to));
  }

  /** The value after a scan; `undefined` if it is not known. */
  value(name: string, scan: number): Value | undefined {
    const points = this.points(name, scan, scan);
    const last = points.at(-1);
    return last !== undefined && last[0] <= scan ? last[1] : undefined;
  }

  /** The scan of the next change behind `scan`, or of the last one before it, in any of `names`. */
  change(names: readonly string[], scan: number, forward: boolean): number | undefined {
    const found = names.flatMap((name) => {
      const points = this.signals.get(name)?.points ?? [];
      const point = forward ? points[behind(points, scan)] : points[behind(points, scan - 1) - 1];
      return point === undefined ? [] : [point[0]];
    });
    return found.length === 0 ? undefined : forward ? Math.min(...found) : Math.max(...found);
  }
}

/** Puts later points behind the known ones; the first one repeats what was there. */
function append(known: Point[], later: readonly Point[]): void {
  const first = later[0];
  if (first === undefined) {
    return;
  }
  while (known.length > 0 && (known.at(-1)?.[0] ?? 0) > first[0]) {
    known.pop();
  }
  known.push(...(known.at(-1)?.[1] === first[1] ? later.slice(1) : later));
}

/** How many points are not behind a scan. */
function behind(points: readonly Point[], scan: number): number {
  let [low, high] = [0, points.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((points[middle]?.[0] ?? Infinity) <= scan) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}
