/** The page of a panel: rows in groups, the timing chart below them, and what keeps them up to date. */

import { t, useTranslations } from '../../words';
import type { ToPage } from '../messages';
import { firstSignals, groupTitle, grouped, namesOf, variableToAdd, type Base, type Moment, type Reading, type Row } from '../rows';
import type { Viewport } from '../viewport';
import { ChartView } from './chartView';
import { element, put, say } from './dom';
import { host, Plc } from './plc';
import { RowView } from './rowView';
import { Toolbar } from './toolbar';

/** A panel with more rows has a search field. */
const SEARCHED_FROM = 12;
/** What is seen is told to the extension when it stands still. */
const STILL_MS = 60;

/** What is kept when the window is loaded anew. */
interface Kept {
  readonly program?: string;
  readonly filter?: string;
  readonly signals?: readonly string[];
  readonly view?: Viewport;
  readonly closed?: readonly string[];
  readonly chartHeight?: number;
  /** How registers are written that are not decimal. */
  readonly bases?: Readonly<Record<string, Base>>;
  /** What is shown although the program does not use it. */
  readonly chosen?: readonly string[];
}

class Page {
  private readonly plc = new Plc();
  private readonly toolbar: Toolbar;
  private readonly chart: ChartView;
  private readonly search = element('input', { type: 'search', class: 'search', placeholder: t('Search name, symbol or comment') });
  private readonly chosen = element('input', { type: 'text', class: 'search', spellcheck: false });
  private readonly groups = element('main', { class: 'groups' });
  private readonly note = element('p', { class: 'note', role: 'status' });
  private readonly divider = element('div', { class: 'divider', role: 'separator', tabindex: 0, 'aria-orientation': 'horizontal', 'aria-label': t('Height of the chart') });
  private kept = (host.getState() ?? {}) as Kept;
  private rows: readonly Row[] = [];
  private views = new Map<string, RowView>();
  private readonly readings = new Map<string, Reading>();
  private readonly seen = new Set<RowView>();
  private readonly watcher: IntersectionObserver;
  private still: ReturnType<typeof setTimeout> | undefined;
  private frame = 0;
  private wasStopped: boolean | undefined;

  constructor(program: string) {
    this.keep({ program });
    this.toolbar = new Toolbar(this.plc);
    this.chart = new ChartView(this.plc, this.kept.view, (view) => this.keep({ view }), (name) => this.chartRow(name, false));
    this.search.value = this.kept.filter ?? '';
    this.search.setAttribute('aria-label', t('Search name, symbol or comment'));
    this.search.addEventListener('input', () => {
      this.keep({ filter: this.search.value });
      this.build();
    });
    this.watcher = new IntersectionObserver((entries) => this.look(entries), { root: this.groups, rootMargin: '100px' });
    this.chosen.value = (this.kept.chosen ?? []).join(' ');
    this.suggest();
    this.chosen.addEventListener('change', () => this.choose());
    document.body.replaceChildren(this.toolbar.node, element('div', { class: 'fields' }, this.search, this.chosen), this.note, this.groups, this.divider, this.chart.node);
    if (this.kept.chosen !== undefined) {
      this.choose();
    }
    this.makeDivider();
    addEventListener('keydown', (event) => this.keyDown(event));
    this.show();
  }

  takeRows(rows: readonly Row[]): void {
    // The keyboard stays where it is if nothing is new.
    if (rows.length > 0 && JSON.stringify(rows) === JSON.stringify(this.rows)) {
      return;
    }
    this.rows = rows;
    this.suggest();
    const names = new Set(rows.map(({ name }) => name));
    const signals = this.kept.signals?.filter((name) => names.has(name)) ?? [];
    this.keep({ signals: signals.length > 0 || this.kept.signals?.length === 0 ? signals : firstSignals(rows) });
    this.build();
  }

  takeMoment(moment: Moment | undefined, id?: number): void {
    moment?.values.forEach((reading) => this.readings.set(reading.device, reading));
    const wasStopped = this.plc.isStopped;
    this.plc.take(moment, id);
    // What was stopped can still be looked at; what begins anew has no past.
    if (wasStopped && !this.plc.isStopped) {
      this.chart.forget();
    }
    this.chart.ask();
    this.frame ||= requestAnimationFrame(() => {
      this.frame = 0;
      this.show();
    });
  }

  /** An order to a PLC was carried out, or not. */
  answered(id: number, isDone: boolean): void {
    this.plc.take(isDone ? this.plc.moment : undefined, id);
    this.show();
  }

  fail(message: string, id?: number): void {
    this.plc.take(undefined, id);
    say(this.note, message);
    put(this.note, 'data-kind', 'error');
  }

  takeTrace(message: Extract<ToPage, { type: 'trace' }>): void {
    this.chart.take(message.id, message.answer);
  }

  /** Says what can be added, in the names that this program has. */
  private suggest(): void {
    const variable = variableToAdd(this.rows);
    const words = variable === undefined ? t('Add devices: D100 M5') : t('Add variables: {0}', variable);
    this.chosen.placeholder = words;
    put(this.chosen, 'aria-label', words);
  }

  private choose(): void {
    const names = this.chosen.value.toUpperCase().split(/[\s,;]+/).filter(Boolean);
    this.keep({ chosen: names });
    host.postMessage({ type: 'choose', names });
  }

  private keep(more: Partial<Kept>): void {
    this.kept = { ...this.kept, ...more };
    host.setState(this.kept);
  }

  /** Makes the rows that the filter leaves, with what was made before. */
  private build(): void {
    const before = this.views;
    this.views = new Map();
    this.watcher.disconnect();
    this.seen.clear();
    const around = {
      plc: this.plc,
      isCharted: (name: string) => this.kept.signals?.includes(name) ?? false,
      chart: (name: string, on: boolean) => this.chartRow(name, on),
      base: (name: string) => this.kept.bases?.[name] ?? 'decimal',
      write: (name: string, base: Base) => {
        this.keep({ bases: { ...this.kept.bases, [name]: base } });
        this.watch();
      },
    };
    const sections = grouped(this.rows, this.search.value).map(({ group, rows }) => {
      const nodes = rows.map((row) => {
        const known = before.get(row.name);
        const view = known !== undefined && same(known.row, row) ? known : new RowView(row, around);
        this.views.set(row.name, view);
        this.watcher.observe(view.node);
        return view.node;
      });
      const title = element('summary', {}, element('h2', {}, groupTitle(group)), element('span', { class: 'count' }, String(rows.length)));
      const section = element('details', { class: 'group', open: !(this.kept.closed ?? []).includes(group) }, title);
      section.append(element('div', { class: 'rows' }, ...nodes));
      section.addEventListener('toggle', () => {
        const closed = (this.kept.closed ?? []).filter((name) => name !== group);
        this.keep({ closed: section.open ? closed : [...closed, group] });
      });
      return section;
    });
    this.groups.replaceChildren(...sections);
    this.search.hidden = this.rows.length <= SEARCHED_FROM && this.search.value === '';
    this.wasStopped = undefined;
    this.showChart();
    this.show();
  }

  private chartRow(name: string, on: boolean): void {
    const others = (this.kept.signals ?? []).filter((known) => known !== name);
    this.keep({ signals: on ? [...others, name] : others });
    this.showChart();
  }

  private showChart(): void {
    const signals = this.kept.signals ?? [];
    this.chart.show(signals.flatMap((name) => this.rows.find((row) => row.name === name) ?? []));
    this.views.forEach((view) => view.showChart());
  }

  /** Only what is seen is asked for and kept up to date. */
  private look(entries: readonly IntersectionObserverEntry[]): void {
    for (const { target, isIntersecting } of entries) {
      const view = this.views.get((target as HTMLElement).dataset['name'] ?? '');
      if (view !== undefined && isIntersecting) {
        this.seen.add(view);
        view.update(this.readings);
      } else if (view !== undefined) {
        this.seen.delete(view);
      }
    }
    this.watch();
  }

  /** Tells what is seen, once it stands still. */
  private watch(): void {
    clearTimeout(this.still);
    this.still = setTimeout(() => {
      const names = [...this.seen].flatMap(({ row }) => namesOf(row, this.kept.bases?.[row.name]));
      host.postMessage({ type: 'watch', names: [...new Set(names)] });
    }, STILL_MS);
  }

  private show(): void {
    this.toolbar.update();
    const { isStopped } = this.plc;
    document.body.classList.toggle('real', this.plc.isReal);
    if (isStopped !== this.wasStopped) {
      this.wasStopped = isStopped;
      document.body.classList.toggle('stopped', isStopped);
      this.views.forEach((view) => view.enable(!isStopped));
      put(this.note, 'data-kind', undefined);
      const words = this.rows.length === 0 ? t('Start the simulation to operate the program.') : t('The simulation is stopped.');
      say(this.note, isStopped ? words : this.rows.length === 0 ? t('The program uses no devices.') : '');
    }
    this.seen.forEach((view) => view.update(this.readings));
  }

  private makeDivider(): void {
    const { divider } = this;
    const setHeight = (height: number) => {
      const within = Math.min(Math.max(height, 90), innerHeight - 160);
      document.body.style.setProperty('--chart-height', `${within}px`);
      this.keep({ chartHeight: within });
    };
    if (this.kept.chartHeight !== undefined) {
      setHeight(this.kept.chartHeight);
    }
    divider.addEventListener('pointerdown', (event) => divider.setPointerCapture(event.pointerId));
    divider.addEventListener('pointermove', (event) => {
      if (divider.hasPointerCapture(event.pointerId)) {
        setHeight(innerHeight - event.clientY);
      }
    });
    divider.addEventListener('keydown', (event) => {
      const step = { ArrowUp: 24, ArrowDown: -24 }[event.key];
      if (step !== undefined) {
        event.preventDefault();
        setHeight(this.chart.node.offsetHeight + step);
      }
    });
  }

  private keyDown(event: KeyboardEvent): void {
    const isTyping = event.target instanceof HTMLInputElement && event.target.type !== 'range';
    const isMenu = event.target instanceof Element && event.target.closest('.menu, select') !== null;
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey || isTyping || isMenu) {
      return;
    }
    const keys: Readonly<Record<string, () => void>> = {
      g: () => this.toolbar.startOrPause(),
      s: () => void (this.plc.isStopped || this.plc.isReal || this.plc.tell('step')),
      b: () => void (this.plc.isStopped || this.plc.isReal || this.plc.tell('stepBack')),
      '/': () => this.search.focus(),
    };
    const run = keys[event.key];
    if (run !== undefined) {
      event.preventDefault();
      run();
    }
  }
}

function same(one: Row, other: Row): boolean {
  return JSON.stringify(one) === JSON.stringify(other);
}

let page: Page | undefined;

addEventListener('message', ({ data }: MessageEvent<ToPage>) => {
  switch (data.type) {
    case 'hello':
      useTranslations((message, ...args) => (data.words[message] ?? message).replace(/\{(\d+)\}/g, (place, at: string) => String(args[Number(at)] ?? place)));
      document.documentElement.lang = data.language;
      page ??= new Page(data.program);
      return;
    case 'rows':
      return page?.takeRows(data.rows);
    case 'moment':
      return page?.takeMoment(data.moment, data.id);
    case 'answered':
      return page?.answered(data.id, data.isDone);
    case 'trace':
      return page?.takeTrace(data);
    case 'failed':
      return page?.fail(data.message, data.id);
  }
});
host.postMessage({ type: 'ready' });
