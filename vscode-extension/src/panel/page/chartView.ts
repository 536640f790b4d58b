/** The timing chart on the page: a canvas that is drawn when there is something new, with mouse and keyboard. */

import { t } from '../../words';
import type { FromPage } from '../messages';
import { reading, type Row } from '../rows';
import { plotWidth, rowAt, scanAt, scene, sceneHeight, type Scene } from '../scene';
import { FONT_SIZE, styleOf, svg, type Palette } from '../svg';
import { Traces, type TraceAnswer, type TraceQuestion } from '../traces';
import { FIRST_VIEW, PLC_VIEW, fit, follow, pan, zoom, type Viewport } from '../viewport';
import { element, iconButton, put, say } from './dom';
import { showMenu } from './menu';
import { host, type Plc } from './plc';

/** The server is asked for changes no more often. */
const ASK_MS = 66;
/** A view that is moved is looked at closely when it stands still. */
const STILL_MS = 120;
const ZOOM = 1.25;

export class ChartView {
  readonly node = element('section', { class: 'chart-area', 'aria-label': t('Timing chart') });
  private readonly canvas = element('canvas', { tabindex: 0, role: 'img' });
  private readonly scroller = element('div', { class: 'scroller' }, this.canvas);
  private readonly told = element('div', { class: 'told', 'aria-live': 'polite' });
  private readonly followButton: HTMLButtonElement;
  private readonly traces = new Traces();
  private view: Viewport;
  private rows: readonly Row[] = [];
  private cursor: number | undefined;
  private asked: { readonly id: number; readonly question: TraceQuestion } | undefined;
  private askedAt = 0;
  private questions = 0;
  private frame = 0;
  private still: ReturnType<typeof setTimeout> | undefined;
  private later: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly plc: Plc,
    view: Viewport | undefined,
    private readonly changed: (view: Viewport) => void,
    private readonly remove: (name: string) => void,
  ) {
    this.view = view ?? FIRST_VIEW;
    this.followButton = iconButton('follow', t('Follow the newest scan'), () => this.look({ ...this.view, follows: !this.view.follows }));
    const save = element('button', { type: 'button', class: 'text', 'aria-haspopup': 'menu' }, t('Save…'));
    save.addEventListener('click', () => this.openSaveMenu(save));
    const tools = element(
      'div',
      { class: 'tools', role: 'toolbar', 'aria-label': t('Timing chart') },
      element('h2', {}, t('Timing chart')),
      iconButton('minus', t('See more of the time'), () => this.zoomBy(ZOOM * ZOOM)),
      iconButton('plus', t('See less of the time more closely'), () => this.zoomBy(1 / ZOOM / ZOOM)),
      iconButton('fit', t('See all of the time'), () => this.look(fit(this.last))),
      this.followButton,
      save,
    );
    this.node.append(tools, this.scroller, this.told);
    this.listen();
    new ResizeObserver(() => this.draw()).observe(this.scroller);
    // Colours come from the theme.
    new MutationObserver(() => this.draw()).observe(document.body, { attributes: true, attributeFilter: ['class'] });
  }

  private get last(): number {
    return Math.max(this.traces.lastScan, 0);
  }

  private get scanMs(): number {
    return this.plc.moment?.scanMs ?? 10;
  }

  /** Shows other rows. */
  show(rows: readonly Row[]): void {
    this.rows = rows;
    put(this.node, 'data-empty', rows.length === 0 ? 'true' : undefined);
    this.ask();
    this.draw();
  }

  /** A simulation that begins anew has no past. */
  forget(): void {
    this.traces.clear();
    this.asked = undefined;
    this.cursor = undefined;
    // Of a PLC, what are scans elsewhere are milliseconds.
    if (this.plc.isReal) {
      this.view = PLC_VIEW;
    }
    this.draw();
  }

  /** Asks for what has happened since, unless an answer is still awaited. */
  ask(): void {
    const { moment } = this.plc;
    if (moment === undefined || moment.mode === 'stopped' || this.asked !== undefined || this.rows.length === 0) {
      return;
    }
    const wait = this.askedAt + ASK_MS - performance.now();
    if (wait > 0) {
      this.later ??= setTimeout(() => {
        this.later = undefined;
        this.ask();
      }, wait);
      return;
    }
    this.send(this.traces.question(this.names(), moment.branch));
  }

  /** Takes an answer; `undefined` if there was none. */
  take(id: number, answer: TraceAnswer | undefined): void {
    const { asked } = this;
    if (asked?.id !== id) {
      return;
    }
    this.asked = undefined;
    if (answer !== undefined) {
      this.traces.take(asked.question, answer);
      this.view = follow(this.view, this.last);
      this.draw();
      if (answer.branch !== this.plc.moment?.branch || this.traces.lastScan < (this.plc.moment?.scan ?? 0)) {
        this.ask();
      } else if (this.plc.moment.mode === 'paused') {
        this.lookClosely();
      }
    }
  }

  private send(question: TraceQuestion): void {
    this.asked = { id: ++this.questions, question };
    this.askedAt = performance.now();
    host.postMessage({ type: 'trace', id: this.questions, question });
  }

  private names(): string[] {
    return this.rows.map(({ name }) => name);
  }

  private look(view: Viewport): void {
    this.view = follow(view, this.last);
    this.changed(this.view);
    this.draw();
    this.lookClosely();
  }

  /** Asks for what was left out of the scans that are shown, once they stand still. */
  private lookClosely(): void {
    clearTimeout(this.still);
    this.still = setTimeout(() => {
      const question = this.traces.closer(this.names(), Math.floor(this.view.from), Math.ceil(this.view.to));
      if (question !== undefined && this.asked === undefined) {
        this.send(question);
      }
    }, STILL_MS);
  }

  private zoomBy(factor: number, centre = this.cursor ?? (this.view.from + this.view.to) / 2): void {
    this.look(zoom(this.view, factor, centre, this.last));
  }

  private panBy(share: number): void {
    this.look(pan(this.view, (this.view.to - this.view.from) * share, this.last));
  }

  /** Moves the cursor, and says what is there. */
  private pointTo(scan: number | undefined, says: boolean): void {
    const within = scan === undefined ? undefined : Math.min(Math.max(Math.round(scan), 0), this.last);
    this.cursor = within;
    if (within !== undefined && says) {
      if (within < this.view.from || within > this.view.to) {
        this.look(pan(this.view, within - (this.view.from + this.view.to) / 2, this.last));
      }
      const values = this.rows.map((row) => {
        const value = this.traces.value(row.name, within);
        return value === undefined ? '' : `${row.label} ${typeof value === 'boolean' ? Number(value) : reading(value, row.unitMs)}`;
      });
      say(this.told, `${t('scan {0}', within)}: ${values.filter(Boolean).join(', ')}`);
    }
    this.draw();
  }

  private listen(): void {
    const { canvas } = this;
    let dragged: { x: number; view: Viewport } | undefined;
    canvas.addEventListener('wheel', (event) => {
      if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY)) {
        event.preventDefault();
        this.panBy(Math.sign(event.deltaX || event.deltaY) * 0.1);
      } else if (event.ctrlKey || this.scroller.scrollHeight <= this.scroller.clientHeight) {
        event.preventDefault();
        this.zoomBy(event.deltaY > 0 ? ZOOM : 1 / ZOOM, scanAt(event.offsetX, canvas.clientWidth, this.view));
      }
    }, { passive: false });
    canvas.addEventListener('pointerdown', (event) => {
      if (event.button === 0) {
        dragged = { x: event.offsetX, view: this.view };
        canvas.setPointerCapture(event.pointerId);
      }
    });
    canvas.addEventListener('pointermove', (event) => {
      if (dragged !== undefined && Math.abs(event.offsetX - dragged.x) > 3) {
        const scans = ((dragged.x - event.offsetX) / plotWidth(canvas.clientWidth)) * (this.view.to - this.view.from);
        this.look(pan(dragged.view, scans, this.last));
        canvas.classList.add('dragged');
      } else {
        this.pointTo(scanAt(event.offsetX, canvas.clientWidth, this.view), false);
      }
    });
    canvas.addEventListener('pointerup', () => {
      dragged = undefined;
      canvas.classList.remove('dragged');
    });
    canvas.addEventListener('pointerleave', () => this.pointTo(undefined, false));
    canvas.addEventListener('contextmenu', (event) => {
      event.preventDefault();
      const row = rowAt(event.offsetY, this.rows);
      if (row !== undefined) {
        showMenu([{ label: t('Leave {0} out of the chart', row.label), run: () => this.remove(row.name) }], event.clientX, event.clientY);
      }
    });
    canvas.addEventListener('keydown', (event) => this.keyDown(event));
  }

  private keyDown(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) {
      return;
    }
    const at = this.cursor ?? Math.min(this.last, Math.floor(this.view.to));
    const change = (forward: boolean) => this.pointTo(this.traces.change(this.names(), at, forward) ?? at, true);
    const keys: Readonly<Record<string, () => void>> = {
      ArrowLeft: () => (event.shiftKey ? this.panBy(-0.2) : this.pointTo(at - 1, true)),
      ArrowRight: () => (event.shiftKey ? this.panBy(0.2) : this.pointTo(at + 1, true)),
      PageUp: () => this.panBy(-0.8),
      PageDown: () => this.panBy(0.8),
      Home: () => this.look(pan(this.view, -this.view.from, this.last)),
      End: () => this.look({ ...this.view, follows: true }),
      '+': () => this.zoomBy(1 / ZOOM),
      '=': () => this.zoomBy(1 / ZOOM),
      '-': () => this.zoomBy(ZOOM),
      '0': () => this.look(fit(this.last)),
      n: () => change(true),
      p: () => change(false),
      Escape: () => this.pointTo(undefined, false),
    };
    const run = keys[event.key];
    if (run !== undefined) {
      event.preventDefault();
      run();
    }
  }

  private makeScene(width: number): Scene {
    return scene({ width, rows: this.rows, traces: this.traces, view: this.view, scanMs: this.scanMs, cursor: this.cursor });
  }

  /** Draws in the next frame of the screen, once. */
  draw(): void {
    this.frame ||= requestAnimationFrame(() => {
      this.frame = 0;
      const width = this.scroller.clientWidth;
      const height = sceneHeight(this.rows);
      paint(this.canvas, this.makeScene(width), palette(), devicePixelRatio);
      this.canvas.style.height = `${height}px`;
      put(this.followButton, 'aria-pressed', String(this.view.follows));
      const [from, to] = [Math.max(0, Math.floor(this.view.from)), Math.ceil(this.view.to)];
      put(this.canvas, 'aria-label', t('{0} signals from scan {1} to {2}; keys: arrows, +, -, 0, N, P', this.rows.length, from, to));
    });
  }

  private openSaveMenu(at: HTMLElement): void {
    const { left, bottom } = at.getBoundingClientRect();
    const drawn = () => this.makeScene(Math.max(this.scroller.clientWidth, 640));
    const save = (message: FromPage) => host.postMessage(message);
    const title = t('Timing chart');
    const asSvg = () => save({ type: 'save', format: 'svg', base64: base64(new TextEncoder().encode(svg(drawn(), palette(), title))) });
    const asPng = () => {
      const canvas = document.createElement('canvas');
      paint(canvas, drawn(), palette(), 2);
      save({ type: 'save', format: 'png', base64: canvas.toDataURL('image/png').replace(/^[^,]*,/, '') });
    };
    const changes = (format: 'vcd' | 'csv') => () => save({ type: 'export', format, names: this.names() });
    const items = [
      { label: t('What is seen, as SVG'), run: asSvg },
      { label: t('What is seen, as PNG'), run: asPng },
      { label: t('All changes, as VCD'), run: changes('vcd') },
      { label: t('All changes, as CSV'), run: changes('csv') },
    ];
    showMenu(items, left, bottom);
  }
}

function base64(bytes: Uint8Array): string {
  return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(''));
}

/** The colours of the theme. */
function palette(): Palette {
  const style = getComputedStyle(document.body);
  const colour = (name: string) => style.getPropertyValue(name).trim();
  return {
    background: colour('--surface'),
    foreground: colour('--text'),
    dim: colour('--dim'),
    line: colour('--line'),
    on: colour('--on'),
    word: colour('--number'),
    font: style.fontFamily,
  };
}

function paint(canvas: HTMLCanvasElement, { width, height, shapes }: Scene, colours: Palette, scale: number): void {
  const [across, down] = [Math.round(width * scale), Math.round(height * scale)];
  if (canvas.width !== across || canvas.height !== down) {
    [canvas.width, canvas.height] = [across, down];
  }
  const context = canvas.getContext('2d');
  if (context === null) {
    return;
  }
  context.setTransform(scale, 0, 0, scale, 0, 0);
  context.globalAlpha = 1;
  context.fillStyle = colours.background;
  context.fillRect(0, 0, width, height);
  for (const shape of shapes) {
    const { stroke, width: pen, opacity, bold } = styleOf(shape.look, colours);
    context.globalAlpha = opacity;
    if (shape.kind === 'path') {
      context.strokeStyle = stroke;
      context.lineWidth = pen;
      context.setLineDash(shape.dashed === true ? [3, 3] : []);
      context.beginPath();
      for (const [x, y] of shape.points) {
        context.lineTo(x, y);
      }
      context.stroke();
    } else if (shape.kind === 'area') {
      context.fillStyle = stroke;
      context.fillRect(shape.x, shape.y, shape.width, shape.height);
    } else {
      context.fillStyle = stroke;
      context.font = `${bold ? 'bold ' : ''}${FONT_SIZE}px ${colours.font}`;
      context.textAlign = shape.anchor === 'middle' ? 'center' : shape.anchor;
      context.fillText(shape.text, shape.x, shape.y);
    }
  }
}
