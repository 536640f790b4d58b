/** The sentences that a user reads when the server does not start. */

import type { ServerLocation } from './serverPath';
import { t } from './words';

type Missing = Extract<ServerLocation, { kind: 'missing' }>;

/** Why the server was not found, and what to do. One paragraph, shown in a notification. */
export function missingServerMessage(location: Missing): string {
  const first = location.tried[0] ?? '';
  switch (location.origin) {
    case 'setting':
      return t(
        'Rungwise: the setting "rungwise.server.path" names {0}, which is not a program. Correct the path or clear it.',
        first,
      );
    case 'environment':
      return t('Rungwise: the environment variable RUNGWISE_SERVER names {0}, which is not a program.', first);
    default:
      return t(
        'Rungwise: no language server for this computer is in the extension, and there is no "rungwise" on the PATH. ' +
          'Build it with "cargo build --release" and set its path.',
      );
  }
}

/** Why a server that was found does not run. */
export function brokenServerMessage(file: string, reason: string): string {
  return t('Rungwise: the language server {0} does not start: {1}.', file, reason);
}

/** What is said when the server ended too often to be started again. */
export function crashedServerMessage(crashes: number, minutes: number): string {
  return t(
    'Rungwise: the language server ended {0} times within {1} minutes and is not started again.',
    crashes,
    minutes,
  );
}
