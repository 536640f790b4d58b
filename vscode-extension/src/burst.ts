/**
 * A burst of keystrokes in a drawing: pure, so that it is tested without an editor.
 *
 * A person types faster than the editor can ask the server and apply what it answers, and each answer holds only for the
 * text to which the one before it was applied. So the lines of a burst are kept in two states: as the editor has them,
 * where every keystroke has pushed cells aside, and as they are when the keystrokes are answered one after another. What
 * is typed is taken over from the first into the second, keystroke by keystroke; when nothing is left to take over, the
 * difference between the two is one edit.
 *
 * Every character has a mark, the same in both states, by which a place in one is found in the other.
 */

import { cellWidth, filling, isWords } from './cells';
import type { PlainChange } from './mending';
import { comparePositions, type PlacedEdit, type PlainPosition, type PlainRange } from './structuralEdits';

export interface PlainEdit {
  readonly range: PlainRange;
  readonly newText: string;
}

/** Lines as the server is to read them, and the place in them behind a typed character. */
export interface Typed {
  readonly text: string;
  readonly position: PlainPosition;
  readonly character: string;
}

/** Asks the server what a typed character calls for; line 0 is the first one of the text. */
export type Ask = (typed: Typed) => Promise<readonly PlainEdit[]>;

/** One part of a change, with the text that it replaced if that is known. */
export interface Keystroke extends PlainChange {
  readonly removed?: string | undefined;
}

/** The name that the server gives to an element of which the person is to choose one. */
const PLACEHOLDER = '???';
/** A row of wire from rail to rail, and the cells of it before those where its first contact goes. */
const EMPTY_RUNG = /^[ \t]*[+├][-─]+[+┤]$/gm;
const FIRST_CELLS = 4;
/** More characters at once are no name. */
const MOST_TYPED = 64;

/** Whether all parts of a change are typed, deleted or put in within a line, or one is Enter; others are mended. */
export function areKeystrokes(parts: readonly PlainChange[]): boolean {
  return parts.every(({ range: { start, end }, text }) => {
    const count = end.character - start.character;
    if (isLineEnd(text)) {
      return parts.length === 1 && start.line === end.line && count === 0;
    }
    // Cells that are typed over move nothing, whatever they are.
    const isShort = [...text].length <= 1 || text.length === count || (text.length <= MOST_TYPED && isWords(text));
    return start.line === end.line && isShort && !/[\r\n]/.test(text);
  });
}

/** Where to type on after Enter: over the cells of a name that is to be chosen, or behind a cell of a new rung. */
interface Target {
  /** The mark of the line end that Enter has typed. */
  readonly enter: number;
  /** The cells to type over. */
  readonly over: readonly number[];
  /** The cell behind which they are. */
  readonly behind: number;
}

/** A part of a change that is in the editor's lines and is to be answered. */
interface Part {
  /** Where it begins in the editor's lines. */
  readonly start: number;
  readonly text: string;
  readonly marks: readonly number[];
  /** Characters that it took away, and cells that these filled. */
  readonly count: number;
  readonly width: number;
}

export class Burst {
  private readonly editor: Marked;
  private readonly answered: Marked;
  private readonly waiting: (readonly Keystroke[])[] = [];
  private lastMark: number;
  /** The change with which it began is in the editor's lines already. */
  private isFirst = true;
  private lines: number;
  /** Where the answer to Enter wants what is typed next. */
  private target: Target | undefined;
  /** Characters that were typed behind such an Enter: the marks that they have in the answered lines. */
  private readonly moved = new Map<number, number>();
  /** The mark behind which the cursor is, if such characters were typed last. */
  private cursor: number | undefined;

  /**
   * @param first number of the first line in the document
   * @param text the lines after the first change, without a line end behind the last one
   */
  constructor(
    public first: number,
    text: string,
    keystrokes: readonly Keystroke[],
  ) {
    this.lastMark = text.length;
    const marks = Array.from(text, () => 0).map((_, index) => index);
    this.editor = new Marked(text, marks);
    this.answered = new Marked(text, [...marks]);
    this.lines = text.split('\n').length;
    this.waiting.push(this.within(keystrokes));
  }

  /** Lines that it has in the document. */
  get lineCount(): number {
    return this.lines;
  }

  /** Whether all that was noted is answered. */
  get isAnswered(): boolean {
    return this.waiting.length === 0;
  }

  /** Whether a line of the document belongs to it. */
  has(line: number): boolean {
    return this.first <= line && line < this.first + this.lines;
  }

  /** Notes a change within its lines. */
  add(keystrokes: readonly Keystroke[]): void {
    this.lines += keystrokes.filter(({ text }) => isLineEnd(text)).length;
    this.waiting.push(this.within(keystrokes));
  }

  /** Answers the first change that waits. Rejects if the drawing cannot be kept whole in this way. */
  async answerNext(ask: Ask): Promise<void> {
    const keystrokes = [...(this.waiting[0] ?? [])].sort((a, b) => comparePositions(a.range.start, b.range.start));
    // One part after another, so that each is answered in a drawing that is whole.
    for (const part of this.parts(keystrokes)) {
      await this.answer(part, ask);
    }
    this.waiting.shift();
  }

  /**
   * The lines that change as one edit, and what is to be selected in its text; `undefined` if the cursor stays at what was
   * typed.
   */
  placed(): PlacedEdit | undefined {
    const { text, marks } = this.answered;
    const behind = this.cursor ?? this.target?.behind;
    const from = behind === undefined ? 0 : marks.indexOf(behind) + 1;
    if (from <= 0) {
      return undefined;
    }
    const to = from + (this.cursor === undefined ? (this.target?.over.length ?? 0) : 0);
    const [start, end] = [0, this.editor.text.length].map((offset) => this.inDocument(this.editor.position(offset))) as [
      PlainPosition,
      PlainPosition,
    ];
    return { edit: { range: { start, end }, newText: text }, from, to };
  }

  /** The edits of the document that make it what the answers say. */
  edits(): PlainEdit[] {
    const [old, wanted] = [this.editor, this.answered];
    const kept = new Set(wanted.marks);
    const edits: PlainEdit[] = [];
    let [from, to] = [0, 0];
    while (from < old.marks.length || to < wanted.marks.length) {
      const start = from;
      let newText = '';
      // Marks keep their order, so what is not the same at both places is gone here or came there.
      while ((from < old.marks.length || to < wanted.marks.length) && !this.isSame(from, to)) {
        const mark = old.marks[from];
        const isRetyped = mark !== undefined && mark === wanted.marks[to];
        newText += isRetyped || mark === undefined || kept.has(mark) ? (wanted.text[to++] ?? '') : '';
        from += isRetyped || (mark !== undefined && !kept.has(mark)) ? 1 : 0;
      }
      if (from > start || newText !== '') {
        edits.push(this.edit(start, from, newText));
      }
      from += 1;
      to += 1;
    }
    return edits;
  }

  /** Says that the document has got the edits. */
  applied(): void {
    [this.target, this.cursor] = [undefined, undefined];
    this.moved.clear();
    this.editor.become(this.answered);
    this.lines = this.editor.text.split('\n').length;
  }

  private isSame(from: number, to: number): boolean {
    const [old, wanted] = [this.editor, this.answered];
    return from < old.marks.length && old.marks[from] === wanted.marks[to] && old.text[from] === wanted.text[to];
  }

  private edit(start: number, end: number, newText: string): PlainEdit {
    // An insertion takes the next character along, for at the cursor it would move that.
    const next = this.editor.text.slice(end, end + 1);
    const along = start === end && next !== '\n' ? next : '';
    const at = (offset: number) => this.inDocument(this.editor.position(offset));
    return { range: { start: at(start), end: at(end + along.length) }, newText: newText + along };
  }

  private inDocument({ line, character }: PlainPosition): PlainPosition {
    return { line: line + this.first, character };
  }

  /** Ranges that count from its first line, which changes above may move. */
  private within(keystrokes: readonly Keystroke[]): Keystroke[] {
    const at = ({ line, character }: PlainPosition) => ({ line: line - this.first, character });
    return keystrokes.map((key) => ({ ...key, range: { start: at(key.range.start), end: at(key.range.end) } }));
  }

  /** Takes the parts of a change, in the order of the text, over into the editor's lines. */
  private parts(keystrokes: readonly Keystroke[]): Part[] {
    const { isFirst } = this;
    this.isFirst = false;
    const removed = keystrokes.map(({ range, removed: known }) => {
      const [start, end] = [range.start, range.end].map((position) => this.editor.offset(position)) as [number, number];
      return isFirst ? known : this.editor.text.slice(start, end);
    });
    for (const { range, text } of isFirst ? [] : [...keystrokes].reverse()) {
      const [start, end] = [this.editor.offset(range.start), this.editor.offset(range.end)];
      this.editor.replace(start, end, plainText(text), this.newMarks(plainText(text).length));
    }
    const parts = startsAfter(keystrokes).map((at, index) => {
      const { range, text } = keystrokes[index]!;
      const start = this.editor.offset(at);
      const count = range.end.character - range.start.character;
      const width = removed[index] === undefined ? count : cellWidth(removed[index]);
      const marks = this.editor.marks.slice(start, start + plainText(text).length);
      return { start, text: plainText(text), marks, count: isFirst ? 0 : count, width };
    });
    for (const { start, text } of isFirst ? [...parts].reverse() : []) {
      this.answered.replace(start, start + text.length, '', []);
    }
    return parts;
  }

  private async answer(part: Part, ask: Ask): Promise<void> {
    const { start, text, marks: typed } = part;
    const { marks, count, width } = this.redirected(part);
    let at = this.place(start);
    this.answered.replace(at, Math.min(at + count, this.answered.lineEnd(at)), '', []);
    let left = width;
    let taken = 0;
    const put = (character: string) => {
      this.answered.replace(at, at, character, marks.slice(taken, taken + character.length));
      [at, taken] = [at + character.length, taken + character.length];
    };
    // What replaces cells takes their places first.
    const over = [...text].findIndex((character) => (left -= cellWidth(character)) < 0);
    const characters = [...text];
    const replacing = characters.slice(0, over < 0 ? characters.length : over);
    replacing.forEach(put);
    this.fill(at, width - cellWidth(replacing.join('')));
    for (const character of characters.slice(replacing.length)) {
      // The answer to the one before may have moved it.
      at = this.place(start + taken);
      put(character);
      const known = this.lastMark;
      await this.format(at, character, ask);
      if (character === '\n') {
        this.target = this.targetOf(typed[0] ?? -1, known);
      }
    }
  }

  /**
   * What is typed right behind an Enter whose answer has a place for it goes there. In the editor's lines it stands
   * elsewhere, so it gets marks of its own.
   */
  private redirected(part: Part): Pick<Part, 'marks' | 'count' | 'width'> {
    const { target } = this;
    const before = this.editor.marks[part.start - 1] ?? -1;
    const isFirst = target !== undefined && before === target.enter && part.text !== '' && part.count === 0;
    if (part.text === '\n' || !(isFirst || this.moved.has(before))) {
      [this.target, this.cursor] = [undefined, undefined];
      return part;
    }
    const marks = this.newMarks(part.marks.length);
    part.marks.forEach((mark, index) => this.moved.set(mark, marks[index]!));
    this.target = undefined;
    if (!isFirst) {
      this.cursor = marks.at(-1) ?? this.moved.get(before);
      return { ...part, marks };
    }
    this.cursor = marks.at(-1);
    this.moved.set(target.enter, target.behind);
    return { marks, count: target.over.length, width: target.over.length };
  }

  /** Where to type on after an Enter whose answer has put the marks beyond `known` in. */
  private targetOf(enter: number, known: number): Target | undefined {
    const { text, marks } = this.answered;
    const isNew = (at: number) => (marks[at] ?? 0) > known;
    for (let at = text.indexOf(PLACEHOLDER); at >= 0; at = text.indexOf(PLACEHOLDER, at + 1)) {
      if (isNew(at)) {
        return { enter, over: marks.slice(at, at + PLACEHOLDER.length), behind: marks[at - 1] ?? -1 };
      }
    }
    const rung = [...text.matchAll(EMPTY_RUNG)].find(({ index }) => isNew(index));
    const at = rung === undefined ? -1 : rung.index + rung[0].search(/\S/) + FIRST_CELLS;
    return at < 0 ? undefined : { enter, over: [], behind: marks[at - 1] ?? -1 };
  }

  /** Puts as many cells in as a row has lost at a place. */
  private fill(at: number, missing: number): void {
    if (missing <= 0) {
      return;
    }
    const from = this.answered.lineStart(at);
    const found = filling(this.answered.text.slice(from, this.answered.lineEnd(at)), at - from);
    if (found === undefined) {
      throw new Error('the line is no row of a drawing');
    }
    this.answered.replace(from + found.at, from + found.at, found.cell.repeat(missing), this.newMarks(missing));
  }

  /** Has the server answer a character that ends at a place. */
  private async format(at: number, character: string, ask: Ask): Promise<void> {
    const behind = this.answered.text.slice(at, this.answered.lineEnd(at));
    // Where nothing stands behind, nothing was pushed.
    if (behind.trim() === '' && character !== '\n') {
      return;
    }
    const edits = await ask({ text: this.answered.text, position: this.answered.position(at), character });
    const places = edits.map(({ range, newText }) => ({
      start: this.answered.offset(range.start),
      end: this.answered.offset(range.end),
      newText: plainText(newText),
    }));
    for (const { start, end, newText } of places.sort((a, b) => b.start - a.start)) {
      this.retype(start, end, newText);
    }
  }

  /** Replaces a part of the answered lines; characters that stay keep their marks. */
  private retype(start: number, end: number, text: string): void {
    const old = this.answered.text.slice(start, end);
    let head = 0;
    while (head < Math.min(old.length, text.length) && old[head] === text[head]) {
      head += 1;
    }
    let tail = 0;
    while (tail < Math.min(old.length, text.length) - head && old.at(-1 - tail) === text.at(-1 - tail)) {
      tail += 1;
    }
    const [from, to] = [start + head, end - tail];
    const middle = text.slice(head, text.length - tail);
    // Wire that is drawn over blanks is the same cells; a name is another one.
    const isSame = middle.length === to - from && !/\w|\?/.test(middle);
    const marks = isSame ? this.answered.marks.slice(from, to) : this.newMarks(middle.length);
    this.answered.replace(from, to, middle, marks);
  }

  /** Where a place of the editor's lines is in the answered ones: behind the nearest character before it that is in both. */
  private place(start: number): number {
    for (let before = start - 1; before >= 0; before--) {
      const mark = this.editor.marks[before] ?? -1;
      const found = this.answered.marks.indexOf(this.moved.get(mark) ?? mark);
      if (found >= 0) {
        return found + 1;
      }
    }
    return 0;
  }

  private newMarks(count: number): number[] {
    return Array.from({ length: count }, () => ++this.lastMark);
  }
}

/** Lines in which every UTF-16 unit has a mark. */
class Marked {
  constructor(
    public text: string,
    public marks: number[],
  ) {}

  replace(start: number, end: number, text: string, marks: readonly number[]): void {
    this.text = this.text.slice(0, start) + text + this.text.slice(end);
    this.marks.splice(start, end - start, ...marks);
  }

  become({ text, marks }: Marked): void {
    this.text = text;
    this.marks = [...marks];
  }

  lineStart(offset: number): number {
    return offset === 0 ? 0 : this.text.lastIndexOf('\n', offset - 1) + 1;
  }

  lineEnd(offset: number): number {
    const end = this.text.indexOf('\n', offset);
    return end < 0 ? this.text.length : end;
  }

  position(offset: number): PlainPosition {
    const line = this.text.slice(0, offset).split('\n').length - 1;
    return { line, character: offset - this.lineStart(offset) };
  }

  /** Throws for a line that is not there. */
  offset({ line, character }: PlainPosition): number {
    let start = 0;
    for (let left = line; left > 0; left--) {
      start = this.text.indexOf('\n', start) + 1;
      if (start === 0) {
        throw new Error('a place outside of the lines');
      }
    }
    if (line < 0) {
      throw new Error('a place outside of the lines');
    }
    return Math.min(start + character, this.lineEnd(start));
  }
}

/** Where the parts of a change, in the order of the text, begin after it. */
function startsAfter(keystrokes: readonly Keystroke[]): PlainPosition[] {
  const shifts = new Map<number, number>();
  return keystrokes.map(({ range: { start, end }, text }) => {
    const shift = shifts.get(start.line) ?? 0;
    shifts.set(start.line, shift + text.length - (end.character - start.character));
    return { line: start.line, character: start.character + shift };
  });
}

/** Whether a change is the one that these edits make. */
export function isMadeBy(changes: readonly PlainChange[], edits: readonly PlainEdit[]): boolean {
  const key = (range: PlainRange, text: string) =>
    [range.start.line, range.start.character, range.end.line, range.end.character, plainText(text)].join(':');
  const wanted = edits.map(({ range, newText }) => key(range, newText)).sort();
  const found = changes.map(({ range, text }) => key(range, text)).sort();
  return wanted.length === found.length && wanted.every((one, index) => one === found[index]);
}

export function isLineEnd(text: string): boolean {
  return text === '\n' || text === '\r\n';
}

function plainText(text: string): string {
  return text.replace(/\r\n?/g, '\n');
}
