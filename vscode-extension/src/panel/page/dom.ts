/** Small help with elements of the page. */

type Attributes = Readonly<Record<string, string | number | boolean | undefined>>;

/** An element with attributes and children; an attribute that is `undefined` or `false` is left out. */
export function element<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value !== undefined && value !== false) {
      node.setAttribute(name, String(value));
    }
  }
  node.append(...children);
  return node;
}

/** Writes a text if it is another one. */
export function say(node: Node, text: string): void {
  if (node.textContent !== text) {
    node.textContent = text;
  }
}

/** Sets an attribute if it is another one. */
export function put(node: Element, name: string, value: string | undefined): void {
  if (value === undefined) {
    node.removeAttribute(name);
  } else if (node.getAttribute(name) !== value) {
    node.setAttribute(name, value);
  }
}

const PATHS = {
  play: 'M4.5 2.8v10.4l8.6-5.2z',
  pause: 'M4 3h2.6v10H4zM9.4 3H12v10H9.4z',
  stop: 'M3.6 3.6h8.8v8.8H3.6z',
  step: 'M3 2.8v10.4L10 8zM11 3h2v10h-2z',
  back: 'M13 2.8v10.4L6 8zM3 3h2v10H3z',
  reset: 'M8 3a5 5 0 1 1-4.8 3.6l1.45.42A3.5 3.5 0 1 0 8 4.5v2L4.4 3.75 8 1z',
  more: 'M3.5 6.7a1.3 1.3 0 1 1 0 2.6 1.3 1.3 0 0 1 0-2.6zm4.5 0a1.3 1.3 0 1 1 0 2.6 1.3 1.3 0 0 1 0-2.6zm4.5 0a1.3 1.3 0 1 1 0 2.6 1.3 1.3 0 0 1 0-2.6z',
  chart: 'M1.5 10.5h3v-6h5v6h5V12h-6.4V6H6v6H1.5z',
  plus: 'M7.25 3h1.5v4.25H13v1.5H8.75V13h-1.5V8.75H3v-1.5h4.25z',
  minus: 'M3 7.25h10v1.5H3z',
  fit: 'M1.5 3H3v10H1.5zM13 3h1.5v10H13zM4 8l2.6-2.6v1.85h2.8V5.4L12 8l-2.6 2.6V8.75H6.6v1.85z',
  follow: 'M2 7.25h6.4L5.9 4.75 7 3.7 11.3 8 7 12.3l-1.1-1.05 2.5-2.5H2zM12.4 3h1.6v10h-1.6z',
  // The sign for a push button in drawings of ladder: a cap above two contacts.
  press: 'M4.5 2.5h7V4H8.75v3.5H14V9H2V7.5h5.25V4H4.5zM3.5 10.6a1.4 1.4 0 1 1 0 2.8 1.4 1.4 0 0 1 0-2.8zm9 0a1.4 1.4 0 1 1 0 2.8 1.4 1.4 0 0 1 0-2.8z',
  lock: 'M5 7V5a3 3 0 0 1 6 0v2h1v6.5H4V7zm1.5 0h3V5a1.5 1.5 0 0 0-3 0z',
} as const;

export type Icon = keyof typeof PATHS;

export function icon(name: Icon): SVGSVGElement {
  const space = 'http://www.w3.org/2000/svg';
  const drawing = document.createElementNS(space, 'svg');
  for (const [attribute, value] of [['viewBox', '0 0 16 16'], ['width', '16'], ['height', '16'], ['aria-hidden', 'true']] as const) {
    drawing.setAttribute(attribute, value);
  }
  const path = document.createElementNS(space, 'path');
  path.setAttribute('d', PATHS[name]);
  path.setAttribute('fill', 'currentColor');
  drawing.append(path);
  return drawing;
}

/** A button with an icon, and words for those who do not see it. */
export function iconButton(name: Icon, title: string, run: () => void): HTMLButtonElement {
  const button = element('button', { type: 'button', class: 'icon', title, 'aria-label': title });
  button.append(icon(name));
  button.addEventListener('click', run);
  return button;
}
