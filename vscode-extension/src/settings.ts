/**
 * The settings that the language server gets, in one shape for every editor.
 *
 * The same object is sent as `initializationOptions` and, inside `{"settings": {"rungwise": …}}`, by
 * `workspace/didChangeConfiguration`, so that Neovim or Helix users can write it in their configuration as it stands.
 */

export type FormatStyle = 'iec' | 'brackets' | 'unicode';
export type DiagnosticsScope = 'project' | 'open';

/** What the server is told. `null` means that the server decides from `rungwise.toml` and the program. */
export interface ServerSettings {
  /** PLC model in lower case (`fx1s`, `fx1n`, `fx2n`, `fx3u`, `iec`). */
  readonly target: string | null;
  /** Dialect of `.il` files (`fx` or `iec`). */
  readonly dialect: string | null;
  readonly format: {
    readonly style: FormatStyle | null;
    /** Least width of a rung in cells, rails included. */
    readonly width: number | null;
  };
  /** Language of messages (`en` or `zh-CN`); `null` leaves it to the locale of the client. */
  readonly language: string | null;
  /** `comments`: symbols and comments of the project behind devices. */
  readonly inlayHints: { readonly enabled: boolean; readonly comments: boolean };
  readonly codeLens: { readonly steps: boolean; readonly references: boolean; readonly nextFree: boolean; readonly run: boolean };
  /** `open` leaves out the programs of a project that are not open. */
  readonly diagnostics: { readonly scope: DiagnosticsScope };
}

/** Reads one setting below `rungwise.` by its name; `undefined` when the user did not set it. */
export type ReadSetting = (name: string) => unknown;

export const TARGETS = ['fx1s', 'fx1n', 'fx2n', 'fx3u', 'iec'] as const;
const DIALECTS: readonly string[] = ['fx', 'iec'];
const LANGUAGES: readonly string[] = ['en', 'zh-CN'];
const STYLES: readonly FormatStyle[] = ['iec', 'brackets', 'unicode'];
const SCOPES: readonly DiagnosticsScope[] = ['project', 'open'];
const MIN_WIDTH_CELLS = 24;
const MAX_WIDTH_CELLS = 400;

/** Collects the settings. A value of the wrong type counts as unset: the settings editor already underlines it. */
export function readServerSettings(read: ReadSetting): ServerSettings {
  const isOn = (name: string) => read(name) !== false;
  return {
    target: oneOf(read('target'), TARGETS),
    dialect: oneOf(read('dialect'), DIALECTS),
    format: { style: oneOf(read('format.style'), STYLES), width: width(read('format.width')) },
    language: oneOf(read('language'), LANGUAGES),
    inlayHints: { enabled: isOn('inlayHints.enabled'), comments: isOn('inlayHints.comments') },
    codeLens: {
      steps: isOn('codeLens.steps'),
      references: isOn('codeLens.references'),
      nextFree: isOn('codeLens.nextFree'),
      run: isOn('codeLens.run'),
    },
    diagnostics: { scope: oneOf(read('diagnostics.scope'), SCOPES) ?? 'project' },
  };
}

/** The parameters of `workspace/didChangeConfiguration`. */
export function configurationChange(settings: ServerSettings): { settings: { rungwise: ServerSettings } } {
  return { settings: { rungwise: settings } };
}

/** The arguments of the server process: `lsp`, then what the user adds. */
export function serverArguments(extraArguments: unknown): string[] {
  const extra = Array.isArray(extraArguments) ? extraArguments.filter((a): a is string => typeof a === 'string') : [];
  return ['lsp', ...extra];
}

function oneOf<Word extends string>(value: unknown, allowed: readonly Word[]): Word | null {
  if (typeof value !== 'string') {
    return null;
  }
  const word = value.trim().toLowerCase();
  return allowed.find((candidate) => candidate.toLowerCase() === word) ?? null;
}

function width(value: unknown): number | null {
  if (typeof value !== 'number' || !Number.isFinite(value)) {
    return null;
  }
  return Math.min(MAX_WIDTH_CELLS, Math.max(MIN_WIDTH_CELLS, Math.round(value)));
}
