/** Reads the answer of the server command `rungwise.usage`. */

/** The table; what comes without one is shown as it is, for silence would look like a program without devices. */
export function usageText(answer: unknown): string {
  if (typeof answer === 'string') {
    return answer;
  }
  const text = typeof answer === 'object' && answer !== null ? (answer as Record<string, unknown>)['text'] : undefined;
  return typeof text === 'string' ? text : JSON.stringify(answer ?? null, null, 2);
}
