/** What the server answers about one form of a program. */

/** Commands of the client that the server may put into code actions; it learns of them in `initialize`. */
export const ANOTHER_DOCUMENT = { open: 'rungwise.openTranslation', copy: 'rungwise.copyTranslation' } as const;

export interface Translated {
  readonly text: string;
  /** The language of a document with this text. */
  readonly language: string;
  readonly notes: readonly string[];
}

const LANGUAGES: Readonly<Record<string, string>> = { ladder: 'ladder', fx: 'plc-il', iec: 'plc-il' };

/** The first form of an answer of `rungwise.translate`; nothing if there is none. */
export function translationOf(answer: unknown): Translated | undefined {
  const forms = (answer as { forms?: unknown } | null)?.forms;
  const form = Array.isArray(forms) ? (forms[0] as Record<string, unknown> | undefined) : undefined;
  if (form === undefined || typeof form['text'] !== 'string') {
    return undefined;
  }
  const notes = Array.isArray(form['notes']) ? form['notes'].map(String) : [];
  return { text: form['text'], language: LANGUAGES[String(form['to'])] ?? 'plaintext', notes };
}
