/** What the server answers about two programs. */

/** The command of the server: whether two programs do the same. */
export const PROVE = 'rungwise.prove';

/** The page of an answer of {@link PROVE}, Markdown; nothing if there is none. */
export function proofPage(answer: unknown): string | undefined {
  const page = (answer as { page?: unknown } | null)?.page;
  return typeof page === 'string' && page !== '' ? page : undefined;
}

/** The two programs that are meant by what a menu gives: the selected files, if there are two. */
export function selectedPair<T>(selected: unknown): readonly [T, T] | undefined {
  return Array.isArray(selected) && selected.length === 2 ? [selected[0] as T, selected[1] as T] : undefined;
}
