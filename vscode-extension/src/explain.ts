/** Addresses of pages, and what the program says when there is no page. */

/** The word of a page's path: `/explain/open-circuit.md` is `open-circuit`. */
export function pageWord(path: string): string {
  return path.replace(/^.*\//, '').replace(/\.md$/, '');
}

/** The sentence in what `rungwise explain` wrote to standard error; `undefined` if it wrote nothing. */
export function explainable(stderr: string): string | undefined {
  const line = stderr.split('\n').find((text) => text.trim() !== '');
  return line?.replace(/^error\[[^\]]*\]:\s*/, '').trim();
}
