/** Decides whether a server that ended by itself is started again. */

export const CRASH_WINDOW_MS = 3 * 60_000;
const MAX_CRASHES = 5;
const FIRST_DELAY_MS = 100;
const MAX_DELAY_MS = 5_000;

export type CrashDecision =
  | { readonly kind: 'restart'; readonly delayMs: number }
  | { readonly kind: 'give-up'; readonly crashes: number };

/** Counts crashes in a sliding window. The delay doubles, so a server that dies at once does not spin. */
export class CrashPolicy {
  private crashes: number[] = [];

  /** Notes one crash at `nowMs` (any steady clock) and says what to do. */
  decide(nowMs: number): CrashDecision {
    this.crashes = this.crashes.filter((time) => nowMs - time < CRASH_WINDOW_MS);
    this.crashes.push(nowMs);
    if (this.crashes.length >= MAX_CRASHES) {
      return { kind: 'give-up', crashes: this.crashes.length };
    }
    return { kind: 'restart', delayMs: Math.min(MAX_DELAY_MS, FIRST_DELAY_MS * 2 ** (this.crashes.length - 1)) };
  }

  /** Forgets the crashes, after the user asked for a restart. */
  reset(): void {
    this.crashes = [];
  }
}
