/** What of debugging needs no editor: configurations, and the words of the console. Pure. */

/** The type of the debugger. */
export const DEBUG_TYPE = 'rungwise';

/** The programs that can be debugged. */
export const DEBUG_LANGUAGES: readonly string[] = ['ladder', 'plc-il'];

/** A launch configuration, as far as it is looked at here. */
export interface LaunchConfiguration {
  readonly type?: string;
  readonly request?: string;
  readonly name?: string;
  readonly program?: unknown;
  readonly stopOnEntry?: unknown;
}

/** The configuration of F5 without a launch file: the program in the editor, stopped at its first instruction. */
export function configurationOf(program: string, name: string): LaunchConfiguration {
  return { type: DEBUG_TYPE, request: 'launch', name, program, stopOnEntry: true };
}

/** Whether it is what F5 gives without a launch file. */
export function isEmpty(configuration: LaunchConfiguration): boolean {
  return !configuration.type && !configuration.request && !configuration.name;
}

/** The line of the console that holds a device at a value. */
export function forceLine(name: string, value: string): string {
  return `force ${name}=${value.trim()}`;
}

/** The value of a variable without what the debugger says of it: `1` of `1 (forced)`. */
export function plainValue(shown: string): string {
  return /^-?[\w.#]+/.exec(shown)?.[0] ?? shown;
}

/** A reason as `rungwise.simulate.why` answers it. */
export interface Reason {
  readonly text: string;
  readonly uri?: string;
  readonly range?: { readonly start: Position; readonly end: Position };
  readonly because: readonly Reason[];
}

interface Position {
  readonly line: number;
  readonly character: number;
}

/** The reasons one below the other, with how deep each stands. */
export function flat(reason: Reason, depth = 0): { readonly reason: Reason; readonly depth: number }[] {
  return [{ reason, depth }, ...reason.because.flatMap((behind) => flat(behind, depth + 1))];
}
