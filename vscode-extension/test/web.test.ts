import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { isBuiltin } from 'node:module';
import { test } from 'node:test';
import { runInNewContext } from 'node:vm';

// `npm test` builds it anew.
const bundle = readFileSync('dist/web.js', 'utf8');
const manifest = JSON.parse(readFileSync('package.json', 'utf8'));

interface Shown {
  readonly messages: string[];
  readonly commands: Map<string, () => unknown>;
  readonly tooltips: string[];
}

/** Runs the edition for the browser as a web worker does, which has no modules but `vscode`, and activates it. */
function activated(toldBefore: boolean): Shown {
  const shown: Shown = { messages: [], commands: new Map(), tooltips: [] };
  const item = {
    set tooltip(text: string) {
      shown.tooltips.push(text);
    },
    show: () => undefined,
  };
  const vscode = {
    StatusBarAlignment: { Left: 1, Right: 2 },
    commands: { registerCommand: (name: string, run: () => unknown) => shown.commands.set(name, run) },
    l10n: { t: (message: string) => message },
    window: {
      createStatusBarItem: () => item,
      showInformationMessage: (message: string) => Promise.resolve(void shown.messages.push(message)),
    },
  };
  const require = (name: string) => (name === 'vscode' ? vscode : assert.fail(`there is no module "${name}" in a browser`));
  const module = { exports: {} as { activate?: (context: unknown) => void } };
  runInNewContext(bundle, { module, exports: module.exports, require, self: {}, console });
  const state = new Map<string, unknown>(toldBefore ? [['rungwise.toldAboutWeb', true]] : []);
  assert.ok(module.exports.activate, 'it has no `activate`');
  module.exports.activate({
    subscriptions: [],
    extension: { packageJSON: manifest },
    globalState: { get: (key: string) => state.get(key), update: (key: string, value: unknown) => state.set(key, value) },
  });
  return shown;
}

test('the edition for the browser needs no module but the editor', () => {
  const required = [...bundle.matchAll(/\b(?:require|import)\(\s*["'`]([^"'`]+)["'`]\s*\)/g)].map(([, name]) => name!);
  assert.deepEqual([...new Set(required)], ['vscode']);
  assert.ok(!required.some((name) => isBuiltin(name)));
  assert.doesNotMatch(bundle, /child_process|\bprocess\.(?:env|platform)|\b__dirname\b/);
});

test('in the browser it says once, and on every command, what has to be behind the editor', () => {
  const first = activated(false);
  assert.equal(first.messages.length, 1);
  assert.match(first.messages[0]!, /browser alone, without a computer for the language server.*desktop.*codespace/);
  assert.deepEqual(first.tooltips, first.messages);
  assert.deepEqual(activated(true).messages, []);
  const commands: string[] = manifest.contributes.commands.map(({ command }: { command: string }) => command);
  assert.deepEqual([...first.commands.keys()].sort(), [...commands].sort());
  first.commands.get('rungwise.insertContact')!();
  assert.deepEqual(first.messages, [first.messages[0], first.messages[0]]);
});

test('languages, colours and snippets are there without any code, in the browser too', () => {
  const { languages, grammars, snippets } = manifest.contributes;
  assert.deepEqual(languages.map(({ id, extensions }: any) => [id, extensions]), [
    ['ladder', ['.lad']], ['plc-il', ['.il']], ['rungwise-forms', ['.rungwise-forms']],
  ]);
  for (const { id } of languages) {
    assert.ok(grammars.some(({ language }: any) => language === id), id);
    // The page of forms is read, not written.
    assert.ok(id === 'rungwise-forms' || snippets.some(({ language }: any) => language === id), id);
  }
  assert.equal(manifest.browser, './dist/web.js');
  // Neither the kind of the extension nor a virtual file system may keep it out of the browser.
  assert.ok(!manifest.extensionKind.includes('-web'));
  assert.notEqual(manifest.capabilities.virtualWorkspaces.supported, false);
});
