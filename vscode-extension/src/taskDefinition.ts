/** What stands in tasks.json as `{"type": "rungwise", …}`, and the command line that it means. */

export type TaskVerb = 'check' | 'fmt';

/** Arguments of the program; `undefined` if the definition is none of a task that there is. */
export function taskArguments(definition: Readonly<Record<string, unknown>>): string[] | undefined {
  const command = definition['command'];
  if (command !== 'check' && command !== 'fmt') {
    return undefined;
  }
  const paths = strings(definition['paths']);
  const extra = strings(definition['args']);
  // A task never changes files: `fmt` without `--check` is what Format Document is for.
  const fixed = command === 'fmt' ? ['fmt', '--check'] : ['check'];
  return [...fixed, ...extra.filter((word) => !fixed.includes(word)), ...(paths.length > 0 ? paths : ['.'])];
}

/** Name of the task in the list. */
export function taskName(definition: Readonly<Record<string, unknown>>): string {
  const paths = strings(definition['paths']);
  const verb = definition['command'] === 'fmt' ? 'fmt --check' : 'check';
  return paths.length > 0 ? `${verb} ${paths.join(' ')}` : verb;
}

function strings(value: unknown): string[] {
  return Array.isArray(value) ? value.filter((word): word is string => typeof word === 'string') : [];
}
