/** The simulation as the page sees it: orders to the extension, and their answers. */

import type { FromPage, Verb } from '../messages';
import type { Moment, Value } from '../rows';

interface Host {
  postMessage(message: FromPage): void;
  getState(): unknown;
  setState(state: unknown): void;
}

declare function acquireVsCodeApi(): Host;

export const host = acquireVsCodeApi();

export class Plc {
  private orders = 0;
  private readonly waiting = new Map<number, (moment: Moment | undefined) => void>();
  /** What is to be done once a scan has been run, by what it is about. */
  private readonly later = new Map<string, { readonly after: number; readonly run: () => void }>();
  moment: Moment | undefined;

  get isStopped(): boolean {
    return this.moment === undefined || this.moment.mode === 'stopped';
  }

  /** Whether this is a real PLC, or one at the other end of a line at least. */
  get isReal(): boolean {
    return this.moment?.source === 'plc';
  }

  /** Tells the simulation something; gives where it was then, or nothing if it was refused. */
  tell(verb: Verb, more: Readonly<Record<string, unknown>> = {}): Promise<Moment | undefined> {
    const id = ++this.orders;
    host.postMessage({ type: 'tell', verb, more, id });
    return new Promise((resolve) => this.waiting.set(id, resolve));
  }

  set(name: string, value: Value): Promise<Moment | undefined> {
    return this.tell('set', { name, value });
  }

  /** Takes an answer, or a new moment. */
  take(moment: Moment | undefined, id?: number): void {
    if (moment !== undefined) {
      // Only states say these.
      const { scanMs, speed, firstScan } = { ...this.moment, ...moment };
      this.moment = { ...moment, ...(scanMs !== undefined && { scanMs }), ...(speed !== undefined && { speed }), ...(firstScan !== undefined && { firstScan }) };
    }
    if (id !== undefined) {
      this.waiting.get(id)?.(moment);
      this.waiting.delete(id);
    }
    for (const [name, { after, run }] of this.later) {
      if (this.moment !== undefined && (this.moment.scan > after || this.moment.mode === 'stopped')) {
        this.later.delete(name);
        run();
      }
    }
  }

  /** Presses a push button. What this gives lets it go, though not before a scan has seen it. */
  press(name: string, rest: boolean): () => void {
    const pressed = this.set(name, !rest);
    return () => {
      void pressed.then((moment) => {
        if (moment !== undefined) {
          this.later.set(name, { after: moment.scan, run: () => void this.set(name, rest) });
          this.take(undefined);
        }
      });
    };
  }
}
