/** The forms of a rung: ladder, both instruction lists and boolean, as a page that follows the cursor. */

import { t } from './words';

/** Where the cursor is, as the language server counts: lines and UTF-16 units from 0. */
export interface FormsPlace {
  readonly uri: string;
  readonly position?: Point;
  /** What is selected, if something is. */
  readonly range?: { readonly start: Point; readonly end: Point };
}

interface Point {
  readonly line: number;
  readonly character: number;
}

/** The cursor is not followed at each step, but soon enough to be felt as at once. */
export const FOLLOW_MS = 100;

/** The command of the server that answers {@link formsArgument} with what {@link formsPage} shows. */
export const TRANSLATE = 'rungwise.translate';

export function formsArgument(place: FormsPlace): object {
  return { ...place, to: 'all' };
}

/** The answer `{"forms": [{"to", "text", "certificate", "notes"}]}` as headings, programs in fences, and notes. */
export function formsPage(answer: unknown): string {
  const forms = (answer as { forms?: unknown } | null)?.forms;
  const sections = (Array.isArray(forms) ? forms : []).map((form) => section(form as Record<string, unknown>));
  return sections.length > 0 ? sections.join('\n') : `${t('There is no rung at the cursor.')}\n`;
}

function section(form: Record<string, unknown>): string {
  const text = typeof form['text'] === 'string' ? form['text'].replace(/\n+$/, '') : '';
  const to = String(form['to']);
  const title = [formTitle(to), certificateWords(form['certificate'])].filter(Boolean).join(' — ');
  const notes = (Array.isArray(form['notes']) ? form['notes'] : []).map((note) => `- ${String(note)}\n`).join('');
  // A fence is longer than any row of backticks in the program.
  const longest = Math.max(2, ...[...text.matchAll(/`+/g)].map(([row]) => row.length));
  const fence = '`'.repeat(longest + 1);
  return `## ${title}\n\n${fence}${FENCES[to] ?? ''}\n${text}\n${fence}\n${notes === '' ? '' : `\n${notes}`}`;
}

const FENCES: Readonly<Record<string, string>> = { ladder: 'ladder', fx: 'il', iec: 'il' };

function formTitle(to: string): string {
  switch (to) {
    case 'ladder':
      return t('Ladder diagram');
    case 'fx':
      return t('Instruction list, FX');
    case 'iec':
      return t('Instruction list, IEC 61131-3');
    case 'boolean':
      return t('Boolean form');
    default:
      return to;
  }
}

function certificateWords(certificate: unknown): string {
  switch (certificate) {
    case 'proved':
      return t('proved equal');
    case 'construction':
      return t('equal by construction');
    case 'undecided':
      return t('not decided');
    default:
      return '';
  }
}

/** Tells an ongoing question that nobody waits for its answer any more. */
export interface Asking {
  cancel(): void;
  readonly answer: Promise<unknown>;
}

/** Asks for the forms wherever the cursor comes to rest, the newest place only, and shows what is answered. */
export class FormsFollower {
  private place: FormsPlace | undefined;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private asking: Asking | undefined;

  constructor(
    private readonly ask: (place: FormsPlace) => Asking,
    private readonly show: (page: string) => void,
    private readonly delayMs: number = FOLLOW_MS,
  ) {}

  /** The cursor is at `place`, or the text there has changed. A cursor that runs on is followed, too. */
  moved(place: FormsPlace): void {
    this.place = place;
    this.timer ??= setTimeout(() => void this.follow(), this.delayMs);
  }

  stop(): void {
    clearTimeout(this.timer);
    this.timer = undefined;
    this.asking?.cancel();
    this.asking = undefined;
  }

  private async follow(): Promise<void> {
    this.timer = undefined;
    this.asking?.cancel();
    if (this.place === undefined) {
      return;
    }
    const asking = this.ask(this.place);
    this.asking = asking;
    const failed = (error: unknown) => `${error instanceof Error ? error.message : String(error)}\n`;
    const page = await asking.answer.then(formsPage, failed);
    if (this.asking === asking) {
      this.asking = undefined;
      this.show(page);
    }
  }
}
