// Packs the extension with the server inside: rungwise.vsix, for the kind of computer on which this runs.
//
// Usage: node scripts/package.mjs [--server FILE] [--out FILE]
// The server is FILE, else $RUNGWISE_SERVER, else target/release/rungwise, else target/debug/rungwise.

import { chmodSync, copyFileSync, existsSync, mkdirSync, rmSync, statSync } from 'node:fs';
import { basename, dirname, join, resolve } from 'node:path';
import { execFileSync } from 'node:child_process';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';

const root = dirname(dirname(fileURLToPath(import.meta.url)));
const { values } = parseArgs({ options: { server: { type: 'string' }, out: { type: 'string' } } });
const program = process.platform === 'win32' ? 'rungwise.exe' : 'rungwise';

const server = findServer();
const target = vsceTarget();
const out = resolve(values.out ?? join(root, 'rungwise.vsix'));

const bin = join(root, 'bin');
rmSync(bin, { recursive: true, force: true });
mkdirSync(bin);
copyFileSync(server, join(bin, program));
chmodSync(join(bin, program), 0o755);

const vsce = join(root, 'node_modules', '@vscode', 'vsce', 'vsce');
const args = ['package', '--no-dependencies', '--allow-missing-repository', '--target', target, '--out', out];
execFileSync(process.execPath, [vsce, ...args], { cwd: root, stdio: 'inherit' });
console.log(`${basename(out)} for ${target}: ${(statSync(out).size / 1e6).toFixed(1)} MB, server ${server}`);

function findServer() {
  const named = values.server ?? process.env.RUNGWISE_SERVER;
  if (named) {
    if (!existsSync(named)) {
      fail(`there is no server at ${named}`);
    }
    return resolve(named);
  }
  const built = ['release', 'debug']
    .map((profile) => resolve(root, '..', 'target', profile, program))
    .filter((file) => existsSync(file));
  return built[0] ?? fail('no server is built: run "cargo build --release" first, or give --server FILE');
}

/** Name of this computer in the words of vsce: operating system, then processor. */
function vsceTarget() {
  const systems = { linux: 'linux', darwin: 'darwin', win32: 'win32' };
  const processors = { x64: 'x64', arm64: 'arm64', arm: 'armhf' };
  const system = systems[process.platform];
  const processor = processors[process.arch];
  return system && processor ? `${system}-${processor}` : fail(`no VSIX target for ${process.platform} ${process.arch}`);
}

function fail(message) {
  console.error(`package: ${message}`);
  process.exit(1);
}
