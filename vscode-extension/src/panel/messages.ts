/** What the extension and the page of a panel tell each other. */

import type { Moment, Row } from './rows';
import type { TraceAnswer, TraceQuestion } from './traces';

/** What a page may tell the simulation. */
export const VERBS = ['start', 'stop', 'pause', 'run', 'step', 'stepBack', 'reset', 'set', 'force', 'release'] as const;
export type Verb = (typeof VERBS)[number];

/** To the extension. */
export type FromPage =
  | { readonly type: 'ready' }
  | { readonly type: 'tell'; readonly verb: Verb; readonly more: Readonly<Record<string, unknown>>; readonly id: number }
  | { readonly type: 'watch'; readonly names: readonly string[] }
  /** Devices that a person wants to see, whether the program uses them or not. */
  | { readonly type: 'choose'; readonly names: readonly string[] }
  | { readonly type: 'trace'; readonly id: number; readonly question: TraceQuestion }
  | { readonly type: 'export'; readonly format: 'vcd' | 'csv'; readonly names: readonly string[] }
  | { readonly type: 'save'; readonly format: 'svg' | 'png'; readonly base64: string };

/** To the page. */
export type ToPage =
  /** The words of the display language, and the name of the program. */
  | { readonly type: 'hello'; readonly words: Readonly<Record<string, string>>; readonly language: string; readonly program: string }
  | { readonly type: 'rows'; readonly rows: readonly Row[] }
  /** Where the simulation is; `id` is that of the order that it answers. */
  | { readonly type: 'moment'; readonly moment: Moment; readonly id?: number }
  | { readonly type: 'trace'; readonly id: number; readonly answer: TraceAnswer | undefined }
  /** An order was carried out, or was not wanted; what came of it is seen in the next moment. */
  | { readonly type: 'answered'; readonly id: number; readonly isDone: boolean }
  | { readonly type: 'failed'; readonly message: string; readonly id?: number };
