/** Reads the answer of the server command `rungwise.check`. */

import { t } from './words';

export interface CheckSummary {
  readonly message: string;
  readonly severity: 'information' | 'warning' | 'error';
}

/** The sentence to show. An answer without one is said so: silence would look like a clean program. */
export function checkSummary(answer: unknown): CheckSummary {
  if (typeof answer === 'string' && answer.length > 0) {
    return { message: answer, severity: 'information' };
  }
  if (typeof answer !== 'object' || answer === null) {
    return { message: t('Rungwise: the server gave no result of the check.'), severity: 'error' };
  }
  const fields = answer as Record<string, unknown>;
  const summary = typeof fields['summary'] === 'object' && fields['summary'] !== null ? fields['summary'] : fields;
  const counts = summary as Record<string, unknown>;
  const errors = number(counts['errors']);
  const warnings = number(counts['warnings']);
  const message = [fields['message'], counts['message']].find((m) => typeof m === 'string' && m.length > 0);
  return {
    message: typeof message === 'string' ? message : t('Check: {0} errors, {1} warnings.', errors, warnings),
    severity: errors > 0 ? 'error' : warnings > 0 ? 'warning' : 'information',
  };
}

function number(value: unknown): number {
  return typeof value === 'number' ? value : 0;
}
