import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { configurationChange, readServerSettings, serverArguments, TARGETS } from '../src/settings';

interface Property {
  default: unknown;
  enum?: string[];
  minimum?: number;
  maximum?: number;
}

const manifest = JSON.parse(readFileSync('package.json', 'utf8')) as {
  contributes: { configuration: { properties: Record<string, Property> } };
};
const properties = manifest.contributes.configuration.properties;
/** What is shown unless the user says no. */
const SHOWN = {
  inlayHints: { enabled: true, comments: true },
  codeLens: { steps: true, references: true, nextFree: true, run: true },
  diagnostics: { scope: 'project' },
};

test('what the user did not set is left to rungwise.toml', () => {
  assert.deepEqual(readServerSettings(() => undefined), {
    target: null,
    dialect: null,
    format: { style: null, width: null },
    language: null,
    ...SHOWN,
  });
});

test('a default of package.json, set by hand, means what it says', () => {
  const settings = readServerSettings((name) => properties[`rungwise.${name}`]?.default);
  assert.deepEqual(settings, {
    target: null,
    dialect: null,
    format: { style: 'iec', width: 48 },
    language: null,
    ...SHOWN,
  });
});

test('values are passed on', () => {
  const values: Record<string, unknown> = {
    target: 'fx3u',
    dialect: 'iec',
    'format.style': 'unicode',
    'format.width': 60,
    language: 'zh-cn',
    'inlayHints.enabled': false,
    'inlayHints.comments': false,
    'codeLens.steps': false,
    'codeLens.references': false,
    'codeLens.nextFree': false,
    'codeLens.run': false,
    'diagnostics.scope': 'open',
  };
  assert.deepEqual(readServerSettings((name) => values[name]), {
    target: 'fx3u',
    dialect: 'iec',
    format: { style: 'unicode', width: 60 },
    language: 'zh-CN',
    inlayHints: { enabled: false, comments: false },
    codeLens: { steps: false, references: false, nextFree: false, run: false },
    diagnostics: { scope: 'open' },
  });
});

test('wrong values count as unset, widths are kept in range', () => {
  const read = (values: Record<string, unknown>) => readServerSettings((name) => values[name]);
  assert.equal(read({ target: 'S7' }).target, null);
  assert.equal(read({ target: 7 }).target, null);
  assert.equal(read({ target: 'FX2N' }).target, 'fx2n');
  assert.equal(read({ 'format.style': 'ascii' }).format.style, null);
  assert.equal(read({ 'diagnostics.scope': 'file' }).diagnostics.scope, 'project');
  assert.deepEqual(read({ 'codeLens.steps': null }).codeLens, SHOWN.codeLens);
  assert.equal(read({ 'format.width': 3 }).format.width, 24);
  assert.equal(read({ 'format.width': 1e9 }).format.width, 400);
  assert.equal(read({ 'format.width': Number.NaN }).format.width, null);
});

test('the choices and bounds of package.json are those of the code', () => {
  assert.deepEqual(properties['rungwise.target']?.enum, ['auto', ...TARGETS]);
  const width = properties['rungwise.format.width'];
  const read = (value: unknown) => readServerSettings((name) => (name === 'format.width' ? value : undefined)).format.width;
  assert.equal(read(-1), width?.minimum);
  assert.equal(read(100_000), width?.maximum);
});

test('every setting of package.json reaches the server or the start of it', () => {
  const asked = new Set<string>();
  readServerSettings((name) => {
    asked.add(name);
    return undefined;
  });
  // The client library reads the trace itself; path and arguments are for starting the program.
  const elsewhere = ['server.path', 'server.extraArgs', 'trace.server'];
  const names = Object.keys(properties).map((name) => name.replace(/^rungwise\./, ''));
  assert.deepEqual(names.filter((name) => !elsewhere.includes(name)).sort(), [...asked].sort());
});

test('a change is wrapped as the protocol asks', () => {
  const settings = readServerSettings(() => undefined);
  assert.deepEqual(configurationChange(settings), { settings: { rungwise: settings } });
});

test('extra arguments follow the verb, what is no text is left out', () => {
  assert.deepEqual(serverArguments(['--lang', 'en', 3]), ['lsp', '--lang', 'en']);
  assert.deepEqual(serverArguments('--lang'), ['lsp']);
});
