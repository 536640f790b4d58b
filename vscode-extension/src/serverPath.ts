/** Where the server program is: setting, environment variable, inside the extension, `PATH`, in this order. */

import * as path from 'node:path';

export type ServerOrigin = 'setting' | 'environment' | 'bundled' | 'path';

/** Everything that decides the path, handed in so that tests need neither an editor nor a file system. */
export interface ServerPathInputs {
  /** Value of `rungwise.server.path`; blank when unset. */
  readonly setting: string;
  readonly environment: Readonly<Record<string, string | undefined>>;
  /** Folder of the installed extension. */
  readonly extensionFolder: string;
  readonly workspaceFolder: string | undefined;
  readonly homeFolder: string;
  readonly platform: NodeJS.Platform;
  /** Whether a file exists and may be run. */
  readonly isExecutable: (file: string) => boolean;
}

export type ServerLocation =
  | { readonly kind: 'found'; readonly file: string; readonly origin: ServerOrigin }
  | { readonly kind: 'missing'; readonly origin: ServerOrigin | 'none'; readonly tried: readonly string[] };

/**
 * Finds the server.
 *
 * A path that the user gave by setting or environment is final: when it is wrong the answer is `missing`, because
 * another server than the one asked for would hide the mistake.
 */
export function locateServer(inputs: ServerPathInputs): ServerLocation {
  const named: [ServerOrigin, string | undefined][] = [
    ['setting', inputs.setting],
    ['environment', inputs.environment['RUNGWISE_SERVER']],
  ];
  for (const [origin, value] of named) {
    const given = value?.trim();
    if (given) {
      const file = expandPath(given, inputs);
      return inputs.isExecutable(file) ? { kind: 'found', file, origin } : { kind: 'missing', origin, tried: [file] };
    }
  }
  const paths = pathModule(inputs.platform);
  const program = inputs.platform === 'win32' ? 'rungwise.exe' : 'rungwise';
  const bundled = paths.join(inputs.extensionFolder, 'bin', program);
  if (inputs.isExecutable(bundled)) {
    return { kind: 'found', file: bundled, origin: 'bundled' };
  }
  const onPath = searchFolders(inputs).map((folder) => paths.join(folder, program));
  const file = onPath.find((candidate) => inputs.isExecutable(candidate));
  if (file !== undefined) {
    return { kind: 'found', file, origin: 'path' };
  }
  return { kind: 'missing', origin: 'none', tried: [bundled, ...onPath] };
}

/** Replaces `~`, `${workspaceFolder}`, `${userHome}` and `${env:NAME}`, and makes the path absolute. */
export function expandPath(value: string, inputs: ServerPathInputs): string {
  const paths = pathModule(inputs.platform);
  const expanded = value
    .replace(/^~(?=$|[\\/])/, () => inputs.homeFolder)
    .replaceAll('${workspaceFolder}', () => inputs.workspaceFolder ?? '')
    .replaceAll('${userHome}', () => inputs.homeFolder)
    .replace(/\$\{env:([^}]+)\}/g, (_, name: string) => inputs.environment[name] ?? '');
  if (paths.isAbsolute(expanded)) {
    return paths.normalize(expanded);
  }
  return paths.resolve(inputs.workspaceFolder ?? inputs.homeFolder, expanded);
}

function searchFolders(inputs: ServerPathInputs): string[] {
  // Windows spells the variable `Path` and compares names of variables without case.
  const key = Object.keys(inputs.environment).find((name) => name.toUpperCase() === 'PATH');
  const value = key === undefined ? '' : (inputs.environment[key] ?? '');
  return value.split(pathModule(inputs.platform).delimiter).filter((folder) => folder.length > 0);
}

function pathModule(platform: NodeJS.Platform): path.PlatformPath {
  return platform === 'win32' ? path.win32 : path.posix;
}
