/** Which scans a chart shows: zoom, pan, and following the newest one. Pure. */

/** The scans from `from` to `to`, which need not be whole. */
export interface Viewport {
  readonly from: number;
  readonly to: number;
  /** Whether the newest scan stays at the right edge. */
  readonly follows: boolean;
}

/** Fewer scans are not shown across the chart; and no more. */
const LEAST_SPAN = 8;
const MOST_SPAN = 50_000_000;

export const FIRST_VIEW: Viewport = { from: 0, to: 300, follows: true };
/** The same of a PLC, in milliseconds. */
export const PLC_VIEW: Viewport = { from: 0, to: 10_000, follows: true };

/** The same view when `last` is the newest scan. */
export function follow(view: Viewport, last: number): Viewport {
  const span = view.to - view.from;
  // A short run begins at the left edge.
  const to = Math.max(last, span);
  return view.follows ? { from: to - span, to, follows: true } : view;
}

/** Zooms by a factor, below 1 to see less more closely; the scan at `centre` stays where it is. */
export function zoom(view: Viewport, factor: number, centre: number, last: number): Viewport {
  const span = Math.min(Math.max((view.to - view.from) * factor, LEAST_SPAN), MOST_SPAN);
  if (view.follows) {
    return follow({ from: 0, to: span, follows: true }, last);
  }
  const share = (centre - view.from) / (view.to - view.from);
  return kept({ from: centre - share * span, to: centre + (1 - share) * span, follows: false }, last);
}

/** Moves by so many scans. It follows again when the newest scan is reached. */
export function pan(view: Viewport, scans: number, last: number): Viewport {
  const moved = { from: view.from + scans, to: view.to + scans, follows: false };
  return scans > 0 && moved.to >= last ? follow({ ...view, follows: true }, last) : kept(moved, last);
}

/** Everything from scan 0 on. */
export function fit(last: number): Viewport {
  return { from: 0, to: Math.max(last, LEAST_SPAN), follows: true };
}

function kept(view: Viewport, last: number): Viewport {
  const span = view.to - view.from;
  const from = Math.min(Math.max(view.from, 0), Math.max(last - LEAST_SPAN, 0));
  return { ...view, from, to: from + span };
}

/** Where lines of time stand, in scans, and what is written at them: about as many as `most`. */
export function ticks({ from, to }: Viewport, scanMs: number, most: number): { scan: number; label: string }[] {
  const stepMs = niceStep(((to - from) * scanMs) / Math.max(most, 1));
  const found: { scan: number; label: string }[] = [];
  for (let ms = Math.ceil((from * scanMs) / stepMs) * stepMs; ms <= to * scanMs; ms += stepMs) {
    found.push({ scan: ms / scanMs, label: duration(ms, stepMs) });
  }
  return found;
}

/** 1, 2 or 5 of a power of ten milliseconds; from a minute on times in which clocks are divided. */
function niceStep(ms: number): number {
  const clocks = [60, 120, 300, 600, 1800, 3600, 7200, 18_000, 43_200, 86_400].map((seconds) => seconds * 1000);
  if (ms > 50_000) {
    return clocks.find((step) => step >= ms) ?? Math.ceil(ms / 86_400_000) * 86_400_000;
  }
  const power = 10 ** Math.floor(Math.log10(Math.max(ms, 0.001)));
  return [1, 2, 5, 10].map((factor) => factor * power).find((step) => step >= ms * 0.999) ?? ms;
}

/** A time as precise as steps of `stepMs` need it: `250 ms`, `1.5 s`, `2:05`. */
export function duration(ms: number, stepMs: number): string {
  if (ms < 1000 && stepMs < 1000) {
    return `${trimmed(ms, stepMs < 1 ? 2 : 0)} ms`;
  }
  const seconds = ms / 1000;
  if (seconds < 60 || stepMs < 1000) {
    const places = stepMs >= 1000 ? 0 : Math.min(3, Math.ceil(-Math.log10(stepMs / 1000) - 1e-9));
    return `${seconds.toFixed(places)} s`;
  }
  const two = (number: number) => String(Math.floor(number)).padStart(2, '0');
  const minutes = seconds / 60;
  return minutes < 60
    ? `${Math.floor(minutes)}:${two(seconds % 60)}`
    : `${Math.floor(minutes / 60)}:${two(minutes % 60)}:${two(seconds % 60)}`;
}

function trimmed(number: number, places: number): string {
  return String(Number(number.toFixed(places)));
}
