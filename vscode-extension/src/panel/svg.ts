/** A timing chart as an SVG file. Pure. */

import type { Look, Scene, Shape } from './scene';

/** The colours of a theme, as CSS has them. */
export interface Palette {
  readonly background: string;
  readonly foreground: string;
  readonly dim: string;
  readonly line: string;
  readonly on: string;
  readonly word: string;
  readonly font: string;
}

interface Style {
  readonly stroke: string;
  readonly width: number;
  readonly opacity: number;
  readonly bold: boolean;
}

/** How a shape is drawn, on a canvas as in a file. */
export function styleOf(look: Look, colours: Palette): Style {
  const plain = { width: 1, opacity: 1, bold: false };
  switch (look) {
    case 'grid':
      return { ...plain, stroke: colours.line, opacity: 0.55 };
    case 'lane':
      return { ...plain, stroke: colours.line, opacity: 0.8 };
    case 'off':
      return { ...plain, stroke: colours.dim, opacity: 0.5 };
    case 'on':
      return { ...plain, stroke: colours.on, width: 1.75 };
    case 'area':
      return { ...plain, stroke: colours.on, opacity: 0.28 };
    case 'word':
      return { ...plain, stroke: colours.word, width: 1.75 };
    case 'axis':
      return { ...plain, stroke: colours.dim };
    case 'label':
      return { ...plain, stroke: colours.foreground };
    case 'value':
    case 'cursorLabel':
      return { ...plain, stroke: colours.foreground, bold: true };
    case 'now':
      return { ...plain, stroke: colours.dim };
    case 'cursor':
      return { ...plain, stroke: colours.foreground, width: 1.25 };
  }
}

export const FONT_SIZE = 11;

export function svg({ width, height, shapes }: Scene, colours: Palette, title: string): string {
  const body = shapes.map((shape) => element(shape, colours)).join('\n');
  return [
    '<?xml version="1.0" encoding="UTF-8"?>',
    `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}" role="img">`,
    `<title>${escaped(title)}</title>`,
    `<rect width="100%" height="100%" fill="${escaped(colours.background)}"/>`,
    `<g font-family="${escaped(colours.font)}" font-size="${FONT_SIZE}">`,
    body,
    '</g>',
    '</svg>',
    '',
  ].join('\n');
}

function element(shape: Shape, colours: Palette): string {
  const { stroke, width, opacity, bold } = styleOf(shape.look, colours);
  const colour = escaped(stroke);
  switch (shape.kind) {
    case 'path': {
      const points = shape.points.map(([x, y]) => `${short(x)},${short(y)}`).join(' ');
      const dashes = shape.dashed === true ? ' stroke-dasharray="3 3"' : '';
      return `<polyline points="${points}" fill="none" stroke="${colour}" stroke-width="${width}" stroke-opacity="${opacity}"${dashes}/>`;
    }
    case 'area':
      return (
        `<rect x="${short(shape.x)}" y="${short(shape.y)}" width="${short(shape.width)}" height="${short(shape.height)}"` +
        ` fill="${colour}" fill-opacity="${opacity}"/>`
      );
    case 'text': {
      const weight = bold ? ' font-weight="bold"' : '';
      return `<text x="${short(shape.x)}" y="${short(shape.y)}" fill="${colour}" text-anchor="${shape.anchor}"${weight}>${escaped(shape.text)}</text>`;
    }
  }
}

function short(number: number): string {
  return String(Math.round(number * 100) / 100);
}

function escaped(text: string): string {
  const entities: Readonly<Record<string, string>> = { '&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;' };
  return text.replace(/[&<>"]/g, (sign) => entities[sign] ?? sign);
}
