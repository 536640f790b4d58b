/** A row of the panel: its lamp, its words, and what it is operated with. Made once, then only changed. */

import { baseTitle, basesOf, isSwitch, progress, readAs, reading, sliderEnds, typedIn, typedNumber, written, type Base, type Reading, type Row, type Value } from '../rows';
import { t } from '../../words';
import { element, icon, iconButton, put, say } from './dom';
import { showMenu, type MenuItem } from './menu';
import type { Plc } from './plc';

/** What a row can ask of the page. */
export interface Around {
  readonly plc: Plc;
  isCharted(name: string): boolean;
  chart(name: string, on: boolean): void;
  /** How the value of a row is written. */
  base(name: string): Base;
  write(name: string, base: Base): void;
}

export class RowView {
  readonly node: HTMLElement;
  private readonly lamp = element('span', { class: 'lamp', 'aria-hidden': 'true' });
  private readonly forcedMark = element('span', { class: 'forced', title: t('Forced') }, icon('lock'));
  private readonly valueText = element('span', { class: 'value' });
  private readonly chartButton: HTMLButtonElement;
  private readonly switch: HTMLButtonElement | undefined;
  private readonly field: HTMLInputElement | undefined;
  private readonly slider: HTMLInputElement | undefined;
  private readonly bar: HTMLElement | undefined;
  private value: Value = false;
  private inBase: Value = false;
  private isForced = false;
  private release: (() => void) | undefined;

  constructor(
    readonly row: Row,
    private readonly around: Around,
  ) {
    const { label, symbol, comment } = row;
    const title = [label, symbol, comment].filter(Boolean).join(' · ');
    this.node = element('div', { class: `row ${row.type}`, role: 'group', 'aria-label': title, 'data-name': row.name });
    const words = element('span', { class: 'words', title }, element('b', {}, label));
    if (symbol !== '') {
      words.append(element('span', { class: 'symbol' }, symbol));
    }
    if (comment !== '') {
      words.append(element('span', { class: 'comment' }, comment));
    }
    const controls = element('span', { class: 'controls' });
    this.chartButton = iconButton('chart', t('Show in the chart'), () => this.toggleChart());
    this.chartButton.classList.add('chart');
    const more = iconButton('more', t('More for {0}', label), () => this.openMenu(more));
    more.setAttribute('aria-haspopup', 'menu');
    if (isSwitch(row)) {
      controls.append(this.pushButton(label));
      this.switch = element('button', { type: 'button', class: 'switch', role: 'switch', 'aria-checked': 'false', 'aria-label': label });
      this.switch.append(element('span', { class: 'knob' }));
      this.switch.addEventListener('click', () => this.turnOver());
      controls.append(this.switch);
    } else if (row.type === 'word') {
      this.bar = row.contact === undefined ? undefined : this.progressBar(label);
      this.slider = this.bar === undefined && row.least !== undefined ? this.makeSlider(label) : undefined;
      // A time is read, not typed in units.
      this.field = row.unitMs === undefined ? this.makeField(label) : undefined;
      controls.append(...[this.bar, this.slider, this.field].filter((node) => node !== undefined));
    }
    const hasLamp = row.type === 'bit' || row.contact !== undefined;
    this.node.append(hasLamp ? this.lamp : element('span', { class: 'lamp none' }), words, this.forcedMark, this.valueText);
    this.node.append(controls, this.chartButton, more);
    this.node.addEventListener('keydown', (event) => this.keyDown(event));
    this.node.addEventListener('contextmenu', (event) => {
      event.preventDefault();
      this.openMenu(this.node, event);
    });
    this.showChart();
  }

  /** Shows what it is now, of all that it shows. */
  update(readings: ReadonlyMap<string, Reading>): void {
    const { row } = this;
    const own = readings.get(row.name);
    if (own === undefined) {
      return;
    }
    this.value = own.forced ? own.value : (own.wired ?? own.value);
    const contact = row.contact === undefined ? undefined : readings.get(row.contact);
    const isOn = row.type === 'bit' ? own.value === true : contact?.value === true;
    this.isForced = own.forced || contact?.forced === true;
    put(this.node, 'data-on', String(isOn));
    put(this.node, 'data-forced', this.isForced ? 'true' : undefined);
    if (this.switch !== undefined) {
      // A lamp is what the program sees, a switch how it stands.
      put(this.switch, 'aria-checked', String(this.value === true));
      put(this.switch, 'aria-label', this.isForced ? t('{0}, forced', row.label) : row.label);
    }
    const preset = row.presetOf === undefined ? row.preset : readings.get(row.presetOf)?.value;
    if (row.type === 'bit') {
      say(this.valueText, isOn ? '1' : '0');
    } else if (this.bar !== undefined) {
      const share = progress(own.value, preset);
      const words = [own.value, preset].filter((value) => value !== undefined).map((value) => reading(value, row.unitMs));
      say(this.valueText, words.join(' / '));
      put(this.bar, 'aria-valuenow', String(Math.round((share ?? 0) * 100)));
      put(this.bar, 'aria-valuetext', words.join(' / '));
      this.bar.style.setProperty('--share', String(share ?? 0));
    }
    this.showNumber(readings.get(readAs(row.name, this.base))?.value ?? own.value, own.value);
  }

  private get base(): Base {
    return this.around.base(this.row.name);
  }

  /** Whether it is among the signals of the chart. */
  showChart(): void {
    const isCharted = this.around.isCharted(this.row.name);
    put(this.chartButton, 'aria-pressed', String(isCharted));
  }

  enable(on: boolean): void {
    this.node.querySelectorAll<HTMLInputElement | HTMLButtonElement>('.controls button, .controls input').forEach((control) => {
      control.disabled = !on;
    });
  }

  /** Shows what is read in the base of the row, and on the slider the word by itself. */
  private showNumber(inBase: Value, value: Value): void {
    const { field, slider, row } = this;
    this.inBase = inBase;
    const text = written(inBase, this.base);
    // What is being typed or dragged is not written over.
    if (field !== undefined && document.activeElement !== field && field.value !== text) {
      field.value = text;
    }
    if (slider !== undefined && typeof value === 'number' && !slider.matches(':active') && slider.value !== String(value)) {
      const [least, greatest] = sliderEnds(value, row);
      slider.min = String(Math.min(least, Number(slider.min)));
      slider.max = String(Math.max(greatest, Number(slider.max)));
      slider.value = String(value);
    }
  }

  private pushButton(label: string): HTMLButtonElement {
    const title = t('Hold to switch {0}', label);
    const button = element('button', { type: 'button', class: 'push', title, 'aria-label': title }, icon('press'));
    const press = () => {
      if (this.release === undefined && !button.disabled) {
        this.release = this.around.plc.press(this.row.name, this.value === true);
        button.classList.add('pressed');
      }
    };
    const letGo = () => {
      this.release?.();
      this.release = undefined;
      button.classList.remove('pressed');
    };
    button.addEventListener('pointerdown', (event) => {
      if (event.button === 0) {
        button.setPointerCapture(event.pointerId);
        press();
      }
    });
    ['pointerup', 'pointercancel', 'lostpointercapture', 'blur'].forEach((name) => button.addEventListener(name, letGo));
    button.addEventListener('keydown', (event) => {
      if (event.key === ' ' || event.key === 'Enter') {
        event.preventDefault();
        if (!event.repeat) {
          press();
        }
      }
    });
    button.addEventListener('keyup', (event) => {
      if (event.key === ' ' || event.key === 'Enter') {
        event.preventDefault();
        letGo();
      }
    });
    return button;
  }

  private progressBar(label: string): HTMLElement {
    const bar = element('span', {
      class: 'bar',
      role: 'progressbar',
      'aria-label': label,
      'aria-valuemin': 0,
      'aria-valuemax': 100,
    });
    bar.append(element('span', { class: 'fill' }));
    return bar;
  }

  private makeSlider(label: string): HTMLInputElement {
    const [min, max] = sliderEnds(0, this.row);
    const slider = element('input', { type: 'range', min, max, value: 0, 'aria-label': label });
    slider.addEventListener('input', () => void this.around.plc.set(this.row.name, Number(slider.value)));
    return slider;
  }

  private makeField(label: string): HTMLInputElement {
    const field = element('input', { type: 'text', class: 'number', spellcheck: false, 'aria-label': t('Value of {0}', label) });
    const take = () => {
      // What a variable of IEC 61131-3 takes, the server knows: `T#2s`, a text, a name.
      const isFree = this.row.least === undefined && field.value.trim() !== '';
      const value = typedIn(field.value, this.base, this.row) ?? (isFree ? field.value.trim() : undefined);
      put(field, 'aria-invalid', value === undefined ? 'true' : undefined);
      if (value !== undefined && value !== this.inBase) {
        void this.around.plc.set(readAs(this.row.name, this.base), value);
      }
    };
    field.addEventListener('change', take);
    field.addEventListener('focus', () => field.select());
    field.addEventListener('keydown', (event) => {
      const step = { ArrowUp: 1, ArrowDown: -1, PageUp: 10, PageDown: -10 }[event.key];
      if (event.key === 'Enter') {
        take();
        field.select();
      } else if (event.key === 'Escape') {
        field.value = written(this.inBase, this.base);
        put(field, 'aria-invalid', undefined);
        field.select();
      } else if (step !== undefined && this.base === 'decimal' && typedNumber(field.value, this.row) !== undefined) {
        field.value = String(Number(typedNumber(field.value, this.row)) + step);
        take();
      } else {
        return;
      }
      event.preventDefault();
    });
    return field;
  }

  private keyDown(event: KeyboardEvent): void {
    const isTyping = event.target instanceof HTMLInputElement && event.target.type === 'text';
    if (event.ctrlKey || event.metaKey || event.altKey || isTyping) {
      return;
    }
    const keys: Readonly<Record<string, () => void>> = {
      f: () => this.force(),
      r: () => this.letGo(),
      v: () => this.nextBase(),
      c: () => this.toggleChart(),
      ArrowDown: () => this.goTo(1),
      ArrowUp: () => this.goTo(-1),
      ContextMenu: () => this.openMenu(this.node),
      F10: () => this.openMenu(this.node),
    };
    const run = event.key === 'F10' && !event.shiftKey ? undefined : keys[event.key];
    const isSlider = event.target === this.slider && event.key.startsWith('Arrow');
    if (run !== undefined && !isSlider) {
      event.preventDefault();
      run();
    }
  }

  /** Puts the keyboard on the same control of another row. */
  private goTo(step: number): void {
    const rows = [...document.querySelectorAll<HTMLElement>('.row')].filter((row) => row.offsetParent !== null);
    const to = rows[rows.indexOf(this.node) + step];
    const kind = [...(document.activeElement?.classList ?? [])].find((name) => ['push', 'switch', 'number', 'chart'].includes(name));
    (to?.querySelector<HTMLElement>(kind === undefined ? 'button' : `.${kind}`) ?? to?.querySelector('button'))?.focus();
  }

  /** What is forced stays forced, at the other value. */
  private turnOver(): void {
    const verb = this.isForced ? 'force' : 'set';
    void this.around.plc.tell(verb, { name: this.row.name, value: this.value !== true });
  }

  /** Holds it at the value that it has; a bit that is held already is turned over. */
  private force(value: Value = this.isForced && typeof this.value === 'boolean' ? !this.value : this.value): void {
    void this.around.plc.tell('force', { name: this.row.name, value });
  }

  private letGo(): void {
    void this.around.plc.tell('release', { name: this.row.name });
    if (this.row.contact !== undefined) {
      void this.around.plc.tell('release', { name: this.row.contact });
    }
  }

  /** The key for what the menu offers. */
  private nextBase(): void {
    const bases = basesOf(this.row);
    const next = bases[(bases.indexOf(this.base) + 1) % bases.length];
    if (next !== undefined && bases.length > 1) {
      this.write(next);
    }
  }

  private write(base: Base): void {
    this.around.write(this.row.name, base);
    this.showNumber(this.inBase, this.value);
  }

  private toggleChart(): void {
    this.around.chart(this.row.name, !this.around.isCharted(this.row.name));
  }

  private openMenu(at: HTMLElement, event?: MouseEvent): void {
    const { row, around } = this;
    const items: MenuItem[] = [];
    const forceAt = (name: string, value: Value) => () => void around.plc.tell('force', { name, value });
    if (!around.plc.isStopped) {
      const bit = row.type === 'bit' ? row.name : row.contact;
      if (bit !== undefined) {
        items.push({ label: t('Force {0} on', bit), run: forceAt(bit, true) }, { label: t('Force {0} off', bit), run: forceAt(bit, false) });
      }
      if (row.type === 'word') {
        items.push({ label: t('Hold {0} at {1}', row.label, String(this.value)), key: 'F', run: () => this.force() });
      }
      if (this.isForced) {
        items.push({ label: t('Release {0}', row.label), key: 'R', run: () => this.letGo() });
      }
      const changeOf = bit ?? row.name;
      const isReal = around.plc.isReal;
      items.push(...(isReal ? [] : [{ label: t('Back to before its last change'), run: () => void around.plc.tell('stepBack', { changeOf }) }]));
    }
    const bases = basesOf(row);
    if (bases.length > 1) {
      items.push(...bases.map((base) => ({ label: baseTitle(base), isChecked: base === this.base, run: () => this.write(base) })));
    }
    const isChecked = around.isCharted(row.name);
    items.push({ label: t('Show in the chart'), key: 'C', isChecked, run: () => this.toggleChart() });
    const { left, bottom } = at.getBoundingClientRect();
    showMenu(items, event?.clientX ?? left, event?.clientY ?? bottom);
  }
}
