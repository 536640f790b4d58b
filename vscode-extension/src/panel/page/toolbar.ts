/** The row of buttons at the top: run, pause, step, and where the simulation is. */

import { t } from '../../words';
import { clock } from '../../simulation';
import { element, icon, iconButton, put, say } from './dom';
import type { Plc } from './plc';

/** How fast simulated time goes; 0 is without a limit. */
const SPEEDS = [0.1, 1, 10, 100, 0] as const;

export class Toolbar {
  readonly node = element('header', { class: 'toolbar', role: 'toolbar', 'aria-label': t('Simulation') });
  private readonly run = element('button', { type: 'button', class: 'run' });
  private readonly mode = element('span', { class: 'mode' });
  private readonly scan = element('output', { class: 'figure' });
  private readonly time = element('output', { class: 'figure' });
  private readonly scanTime = element('output', { class: 'figure' });
  private readonly speed = element('select', { 'aria-label': t('Speed'), title: t('Speed') });
  private readonly others: HTMLButtonElement[];
  private readonly figures: HTMLElement[];
  private shownMode = '';
  private wasReal = false;

  constructor(private readonly plc: Plc) {
    this.run.addEventListener('click', () => this.startOrPause());
    const tells = (verb: 'step' | 'stepBack' | 'reset' | 'stop') => () => void plc.tell(verb);
    this.others = [
      iconButton('back', t('Step Back (B)'), tells('stepBack')),
      iconButton('step', t('Step (S)'), tells('step')),
      iconButton('reset', t('Reset'), tells('reset')),
      iconButton('stop', t('Stop'), tells('stop')),
    ];
    for (const speed of SPEEDS) {
      const words = speed === 0 ? t('as fast as possible') : speed === 1 ? t('real time') : `× ${speed}`;
      this.speed.append(element('option', { value: speed }, words));
    }
    this.speed.addEventListener('change', () => void plc.tell('run', { speed: Number(this.speed.value) }));
    const figure = (name: string, output: HTMLElement) => element('label', { class: 'figures' }, element('span', {}, name), output);
    const figures = element('span', { class: 'all-figures' });
    // Of a PLC nothing is known of its scans.
    this.figures = [figure(t('Scan'), this.scan), figure(t('Scan time'), this.scanTime)];
    figures.append(...this.figures.slice(0, 1), figure(t('Time'), this.time), ...this.figures.slice(1));
    this.node.append(element('span', { class: 'buttons' }, this.run, ...this.others), this.speed, this.mode, figures);
    this.update();
  }

  update(): void {
    const { moment, isReal } = this.plc;
    const mode = moment?.mode ?? 'stopped';
    if (isReal !== this.wasReal) {
      this.wasReal = isReal;
      this.shownMode = '';
      [this.run, ...this.others, this.speed].forEach((control) => (control.hidden = isReal));
      this.figures.forEach((figure) => (figure.hidden = isReal));
    }
    if (mode !== this.shownMode) {
      this.shownMode = mode;
      const words = { running: t('Pause (G)'), paused: t('Run (G)'), stopped: t('Start Simulation') }[mode];
      this.run.replaceChildren(icon(mode === 'running' ? 'pause' : 'play'), mode === 'stopped' ? words : '');
      put(this.run, 'title', words);
      put(this.run, 'aria-label', words);
      put(this.run, 'class', mode === 'stopped' ? 'run primary' : 'run icon');
      put(this.mode, 'data-mode', mode);
      [...this.others, this.speed].forEach((control) => (control.disabled = mode === 'stopped'));
    }
    const exchanges = moment?.exchanges ?? 1;
    const real = exchanges > 1 ? `${t('PLC')} · ${t('values of up to {0} scans', exchanges)}` : t('PLC');
    say(this.mode, isReal ? real : { running: t('Running'), paused: t('Paused'), stopped: t('Stopped') }[mode]);
    say(this.scan, mode === 'stopped' ? '–' : String(moment?.scan ?? 0));
    say(this.time, mode === 'stopped' ? '–' : clock(moment?.timeMs ?? 0));
    say(this.scanTime, mode === 'stopped' ? '–' : `${moment?.scanMs ?? 10} ms`);
    const speed = String(moment?.speed ?? 1);
    if (document.activeElement !== this.speed && this.speed.value !== speed) {
      this.speed.value = speed;
    }
  }

  startOrPause(): void {
    if (this.plc.isReal) {
      return;
    }
    const mode = this.plc.moment?.mode ?? 'stopped';
    void this.plc.tell(mode === 'running' ? 'pause' : mode === 'paused' ? 'run' : 'start');
  }
}
