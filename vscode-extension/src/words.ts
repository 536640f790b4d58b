/**
 * Words for users in the display language of the editor. Modules that the tests run without an editor take them from
 * here; in the editor `vscode.l10n.t` puts them into its language, with `l10n/bundle.l10n.<language>.json`.
 */

type Translate = (message: string, ...args: (string | number)[]) => string;

let translate: Translate = fill;

/** Takes the translations of the editor; until then, and in tests, words are English. */
export function useTranslations(own: Translate): void {
  translate = own;
}

/** The words `message`, with `{0}`, `{1}` … standing for `args`. */
export function t(message: string, ...args: (string | number)[]): string {
  return translate(message, ...args);
}

function fill(message: string, ...args: (string | number)[]): string {
  return message.replace(/\{(\d+)\}/g, (place, number: string) => String(args[Number(number)] ?? place));
}
