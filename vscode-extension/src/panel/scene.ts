/** The layout of a timing chart: lines, areas and words with their places, for a canvas and for files. Pure. */

import { reading, type Row, type Value } from './rows';
import type { Point, Traces } from './traces';
import { duration, ticks, type Viewport } from './viewport';

/** What a shape is, which says how it looks. */
export type Look = 'grid' | 'lane' | 'off' | 'on' | 'area' | 'word' | 'label' | 'value' | 'axis' | 'cursor' | 'cursorLabel' | 'now';

export type Shape =
  | { readonly kind: 'path'; readonly look: Look; readonly points: readonly (readonly [number, number])[]; readonly dashed?: boolean }
  | { readonly kind: 'area'; readonly look: Look; readonly x: number; readonly y: number; readonly width: number; readonly height: number }
  | { readonly kind: 'text'; readonly look: Look; readonly x: number; readonly y: number; readonly text: string; readonly anchor: Anchor };

type Anchor = 'start' | 'middle' | 'end';

/** What is drawn, in the order of drawing, and how high it is. */
export interface Scene {
  readonly width: number;
  readonly height: number;
  readonly shapes: readonly Shape[];
}

export interface SceneWish {
  readonly width: number;
  readonly rows: readonly Row[];
  readonly traces: Traces;
  readonly view: Viewport;
  readonly scanMs: number;
  /** The scan that the cursor is at. */
  readonly cursor: number | undefined;
}

export const LABEL_WIDTH = 148;
const AXIS_HEIGHT = 22;
const BIT_HEIGHT = 28;
const WORD_HEIGHT = 48;
const RIGHT_EDGE = 10;

/** How high a chart of these rows is. */
export function sceneHeight(rows: readonly Row[]): number {
  return AXIS_HEIGHT + rows.reduce((sum, row) => sum + laneHeight(row), 0);
}

/** The scan at a place of the chart; it may lie outside of what is shown. */
export function scanAt(x: number, width: number, view: Viewport): number {
  return view.from + ((x - LABEL_WIDTH) / plotWidth(width)) * (view.to - view.from);
}

/** The row at a height of the chart. */
export function rowAt(y: number, rows: readonly Row[]): Row | undefined {
  let top = AXIS_HEIGHT;
  return rows.find((row) => {
    top += laneHeight(row);
    return y >= AXIS_HEIGHT && y < top;
  });
}

export function plotWidth(width: number): number {
  return Math.max(width - LABEL_WIDTH - RIGHT_EDGE, 1);
}

function laneHeight({ type }: Row): number {
  return type === 'bit' ? BIT_HEIGHT : WORD_HEIGHT;
}

export function scene({ width, rows, traces, view, scanMs, cursor }: SceneWish): Scene {
  const shapes: Shape[] = [];
  const height = sceneHeight(rows);
  const plot = plotWidth(width);
  const x = (scan: number) => LABEL_WIDTH + ((scan - view.from) / (view.to - view.from)) * plot;
  const times = ticks(view, scanMs, plot / 84);
  const hasCursor = cursor !== undefined && cursor >= view.from && cursor <= view.to;
  for (const { scan, label } of times) {
    shapes.push({ kind: 'path', look: 'grid', points: [[x(scan), AXIS_HEIGHT], [x(scan), height]] });
    // What would stand out at an edge, or under the time of the cursor, is left out.
    const isCovered = hasCursor && Math.abs(x(scan) - x(cursor)) < 84;
    if (x(scan) > LABEL_WIDTH + 18 && x(scan) < width - 18 && !isCovered) {
      shapes.push({ kind: 'text', look: 'axis', x: x(scan), y: 14, text: label, anchor: 'middle' });
    }
  }
  let top = AXIS_HEIGHT;
  const newest = traces.lastScan;
  const shown = cursor ?? Math.min(newest, view.to);
  for (const row of rows) {
    const lane = { top: top + 6, bottom: top + laneHeight(row) - 6 };
    shapes.push({ kind: 'path', look: 'lane', points: [[0, top + laneHeight(row)], [width, top + laneHeight(row)]] });
    const columns = pixels(traces.points(row.name, Math.floor(view.from), Math.ceil(view.to)), x, x(Math.min(newest, view.to)));
    const value = shown < 0 ? undefined : traces.value(row.name, Math.floor(shown));
    const middle = top + laneHeight(row) / 2 + 4;
    shapes.push({ kind: 'text', look: 'label', x: 10, y: middle, text: cut(`${row.label} ${row.symbol}`.trim(), 14), anchor: 'start' });
    if (value !== undefined) {
      const words = typeof value === 'boolean' ? (value ? '1' : '0') : reading(value, row.unitMs);
      shapes.push({ kind: 'text', look: 'value', x: LABEL_WIDTH - 10, y: middle, text: cut(words, 8), anchor: 'end' });
    }
    shapes.push(...(row.type === 'bit' ? bitShapes(columns, lane) : wordShapes(columns, lane, row.preset ?? 0)));
    top += laneHeight(row);
  }
  if (newest >= view.from && newest < view.to) {
    shapes.push({ kind: 'path', look: 'now', points: [[x(newest), AXIS_HEIGHT], [x(newest), height]], dashed: true });
  }
  if (hasCursor) {
    const at = x(cursor);
    const label = `${Math.round(cursor)} · ${duration(Math.round(cursor) * scanMs, 1)}`;
    const anchor = at > width - 70 ? 'end' : at < LABEL_WIDTH + 70 ? 'start' : 'middle';
    shapes.push({ kind: 'path', look: 'cursor', points: [[at, AXIS_HEIGHT - 4], [at, height]] });
    shapes.push({ kind: 'text', look: 'cursorLabel', x: at, y: 14, text: label, anchor });
  }
  return { width, height, shapes };
}

/** What a column of pixels shows: the value when it begins and when it ends, and the extremes within. */
interface Column {
  readonly x: number;
  readonly end: number;
  readonly least: number;
  readonly greatest: number;
  readonly last: number;
}

/** Changes as columns: one for each stretch without a change, one for all changes of a pixel. */
function pixels(points: readonly Point[], x: (scan: number) => number, right: number): Column[] {
  const columns: { x: number; end: number; least: number; greatest: number; last: number }[] = [];
  for (const [scan, value] of points) {
    const size = sizeOf(value);
    const at = Math.max(x(scan), LABEL_WIDTH);
    const before = columns.at(-1);
    if (before !== undefined && at - before.x < 1) {
      before.least = Math.min(before.least, size);
      before.greatest = Math.max(before.greatest, size);
      before.last = size;
    } else {
      if (before !== undefined) {
        before.end = at;
      }
      columns.push({ x: at, end: at, least: size, greatest: size, last: size });
    }
  }
  const last = columns.at(-1);
  if (last !== undefined) {
    last.end = Math.max(right, last.x);
  }
  return columns;
}

function sizeOf(value: Value): number {
  return typeof value === 'string' ? 0 : Number(value);
}

interface Lane {
  readonly top: number;
  readonly bottom: number;
}

/** Off is a line below, on a line above with an area under it: height tells it as well as colour. */
function bitShapes(columns: readonly Column[], lane: Lane): Shape[] {
  const shapes: Shape[] = [];
  const path: [number, number][] = [];
  for (const { x, end, least, greatest, last } of columns) {
    const y = last > 0 ? lane.top : lane.bottom;
    if (least !== greatest) {
      // Several changes in a pixel: a bar from below to above.
      path.push([x, lane.bottom], [x, lane.top]);
    }
    path.push([x, y], [end, y]);
    if (last > 0 || least !== greatest) {
      const width = last > 0 ? end - x : 1;
      shapes.push({ kind: 'area', look: 'area', x, y: lane.top, width, height: lane.bottom - lane.top });
    }
  }
  if (path.length > 1) {
    shapes.push({ kind: 'path', look: 'on', points: path });
  }
  return shapes;
}

/** Steps between the least and the greatest value that is shown, with 0 and the preset among them. */
function wordShapes(columns: readonly Column[], lane: Lane, preset: number): Shape[] {
  if (columns.length === 0) {
    return [];
  }
  const least = columns.reduce((found, column) => Math.min(found, column.least), 0);
  const greatest = columns.reduce((found, column) => Math.max(found, column.greatest), Math.max(preset, 0));
  const y = (value: number) =>
    greatest === least ? lane.bottom - 1 : lane.bottom - ((value - least) / (greatest - least)) * (lane.bottom - lane.top);
  const path: [number, number][] = [];
  for (const column of columns) {
    if (column.least !== column.greatest) {
      path.push([column.x, y(column.least)], [column.x, y(column.greatest)]);
    }
    path.push([column.x, y(column.last)], [column.end, y(column.last)]);
  }
  return [
    { kind: 'path', look: 'off', points: [[LABEL_WIDTH, lane.bottom], [columns.at(-1)?.end ?? LABEL_WIDTH, lane.bottom]] },
    { kind: 'path', look: 'word', points: path },
  ];
}

function cut(text: string, most: number): string {
  return text.length > most ? `${text.slice(0, most - 1)}…` : text;
}
