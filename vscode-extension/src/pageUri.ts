/** Addresses of the pages that the server writes. */

import * as vscode from 'vscode';

/** Scheme of Markdown pages. package.json opens them in the preview. */
export const PAGE_SCHEME = 'rungwise-page';

/**
 * Address of the page of a rule or an instruction.
 *
 * The code of a diagnostic links to it: a link to a command is refused there, a document is opened.
 */
export function pageUri(word: string): vscode.Uri {
  return vscode.Uri.from({ scheme: PAGE_SCHEME, path: `/explain/${word}.md` });
}
