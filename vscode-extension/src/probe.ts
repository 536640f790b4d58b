/** Runs `rungwise --version` before the server proper, so that a broken program gets a sentence, not a dead client. */

import { execFile } from 'node:child_process';
import { t } from './words';

const PROBE_TIMEOUT_MS = 10_000;

export type ProbeResult =
  | { readonly kind: 'ok'; readonly version: string }
  | { readonly kind: 'failed'; readonly reason: string };

/** Starts `file --version` and reads its answer. Never rejects. */
export function probeServer(file: string, timeoutMs: number = PROBE_TIMEOUT_MS): Promise<ProbeResult> {
  return new Promise((resolve) => {
    execFile(file, ['--version'], { timeout: timeoutMs, windowsHide: true }, (error, stdout, stderr) => {
      if (error) {
        resolve({ kind: 'failed', reason: failureReason(error, stderr, timeoutMs) });
        return;
      }
      const version = parseVersion(stdout);
      resolve(
        version === undefined
          ? { kind: 'failed', reason: t('it is not Rungwise: --version printed "{0}"', firstLine(stdout)) }
          : { kind: 'ok', version },
      );
    });
  });
}

/** Takes `0.1.0` out of `rungwise 0.1.0` or `rungwise 0.1.0 (abc123)`; `undefined` for another program. */
export function parseVersion(output: string): string | undefined {
  return /^rungwise\s+v?(\d+\.\d+\.\d+\S*)/.exec(output.trim())?.[1];
}

/** Says in words why a program did not answer. The codes are those of the operating system. */
export function failureReason(
  error: { code?: string | number | null | undefined; killed?: boolean; signal?: string | null; message: string },
  stderr: string,
  timeoutMs: number,
): string {
  if (error.killed) {
    return t('it gave no answer within {0} s', timeoutMs / 1000);
  }
  switch (error.code) {
    case 'ENOENT':
      return t('there is no such file, or a library that it needs is missing');
    case 'EACCES':
    case 'EPERM':
      return t('it may not be run (no permission to execute)');
    case 'ENOEXEC':
    case 'UNKNOWN':
      return t('it is not a program for this kind of computer');
    default: {
      const said = firstLine(stderr);
      const how = typeof error.code === 'number' ? t('it ended with exit code {0}', error.code) : error.message;
      return said ? `${how}: ${said}` : how;
    }
  }
}

function firstLine(text: string): string {
  return (text.trim().split('\n', 1)[0] ?? '').trim().slice(0, 200);
}
