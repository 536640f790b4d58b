/** The sentences that a user reads when the server does not start. */

import type { ServerLocation } from './serverPath';

type Missing = Extract<ServerLocation, { kind: 'missing' }>;

/** Why the server was not found, and what to do. One paragraph, shown in a notification. */
export function missingServerMessage(location: Missing): string {
  const first = location.tried[0] ?? '';
  switch (location.origin) {
    case 'setting':
      return `Rungwise: the setting "rungwise.server.path" names ${first}, which is not a program. Correct the path or clear it.`;
    case 'environment':
      return `Rungwise: the environment variable RUNGWISE_SERVER names ${first}, which is not a program.`;
    default:
      return (
        'Rungwise: no language server for this computer is in the extension, and there is no "rungwise" on the PATH. ' +
        'Build it with "cargo build --release" and set its path.'
      );
  }
}

/** Why a server that was found does not run. */
export function brokenServerMessage(file: string, reason: string): string {
  return `Rungwise: the language server ${file} does not start: ${reason}.`;
}

/** What is said when the server ended too often to be started again. */
export function crashedServerMessage(crashes: number, minutes: number): string {
  return `Rungwise: the language server ended ${crashes} times within ${minutes} minutes and is not started again.`;
}
