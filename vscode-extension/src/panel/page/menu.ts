/** A menu of the page, opened by a button, by the right button of the mouse, or by the menu key. */

import { element } from './dom';

export interface MenuItem {
  readonly label: string;
  /** The key that does the same on the row. */
  readonly key?: string;
  readonly isChecked?: boolean;
  run(): void;
}

let close: () => void = () => undefined;

/** Shows a menu at a place of the page; the keyboard goes into it, and back to where it was. */
export function showMenu(items: readonly MenuItem[], x: number, y: number): void {
  close();
  const before = document.activeElement;
  const menu = element('div', { class: 'menu', role: 'menu' });
  for (const { label, key, isChecked, run } of items) {
    const button = element(
      'button',
      {
        type: 'button',
        tabindex: -1,
        role: isChecked === undefined ? 'menuitem' : 'menuitemcheckbox',
        'aria-checked': isChecked === undefined ? undefined : String(isChecked),
      },
      element('span', { class: 'check', 'aria-hidden': 'true' }, isChecked === true ? '✓' : ''),
      element('span', {}, label),
      element('kbd', {}, key ?? ''),
    );
    button.addEventListener('click', () => {
      close();
      run();
    });
    menu.append(button);
  }
  document.body.append(menu);
  const { width, height } = menu.getBoundingClientRect();
  menu.style.left = `${Math.max(4, Math.min(x, innerWidth - width - 4))}px`;
  menu.style.top = `${Math.max(4, Math.min(y, innerHeight - height - 4))}px`;
  const outside = (event: Event) => {
    if (!menu.contains(event.target as Node)) {
      close();
    }
  };
  close = () => {
    close = () => undefined;
    menu.remove();
    removeEventListener('pointerdown', outside, true);
    removeEventListener('blur', close);
    if (before instanceof HTMLElement) {
      before.focus();
    }
  };
  addEventListener('pointerdown', outside, true);
  addEventListener('blur', close);
  menu.addEventListener('keydown', (event) => {
    const buttons = [...menu.querySelectorAll('button')];
    const at = buttons.indexOf(document.activeElement as HTMLButtonElement);
    const to = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: -1 }[event.key];
    if (event.key === 'Escape' || event.key === 'Tab') {
      close();
    } else if (to !== undefined) {
      buttons.at(to % buttons.length)?.focus();
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  });
  menu.querySelector('button')?.focus();
}
