import assert from 'node:assert/strict';
import { test } from 'node:test';
import { locateServer, type ServerPathInputs } from '../src/serverPath';

function inputs(files: string[], change: Partial<ServerPathInputs> = {}): ServerPathInputs {
  return {
    setting: '',
    environment: { PATH: '/usr/bin:/opt/plc/bin' },
    extensionFolder: '/ext',
    workspaceFolder: '/plant',
    homeFolder: '/home/ana',
    platform: 'linux',
    isExecutable: (file) => files.includes(file),
    ...change,
  };
}

const EVERYWHERE = ['/set/rungwise', '/env/rungwise', '/ext/bin/rungwise', '/opt/plc/bin/rungwise'];

test('the order is setting, environment, bundled, PATH', () => {
  const environment = { PATH: '/usr/bin:/opt/plc/bin', RUNGWISE_SERVER: '/env/rungwise' };
  const all = inputs(EVERYWHERE, { setting: '/set/rungwise', environment });
  assert.deepEqual(locateServer(all), { kind: 'found', file: '/set/rungwise', origin: 'setting' });
  assert.deepEqual(locateServer({ ...all, setting: '' }), { kind: 'found', file: '/env/rungwise', origin: 'environment' });
  assert.deepEqual(locateServer(inputs(EVERYWHERE)), { kind: 'found', file: '/ext/bin/rungwise', origin: 'bundled' });
  assert.deepEqual(locateServer(inputs(['/opt/plc/bin/rungwise'])), {
    kind: 'found',
    file: '/opt/plc/bin/rungwise',
    origin: 'path',
  });
});

test('a wrong setting is an error although other servers exist', () => {
  const location = locateServer(inputs(EVERYWHERE, { setting: '/wrong/rungwise' }));
  assert.deepEqual(location, { kind: 'missing', origin: 'setting', tried: ['/wrong/rungwise'] });
});

test('a wrong environment variable is an error although a bundled server exists', () => {
  const location = locateServer(inputs(EVERYWHERE, { environment: { RUNGWISE_SERVER: '/wrong' } }));
  assert.deepEqual(location, { kind: 'missing', origin: 'environment', tried: ['/wrong'] });
});

test('when there is none, all places that were tried are named in order', () => {
  const location = locateServer(inputs([]));
  assert.deepEqual(location, {
    kind: 'missing',
    origin: 'none',
    tried: ['/ext/bin/rungwise', '/usr/bin/rungwise', '/opt/plc/bin/rungwise'],
  });
});

test('home, workspace and environment are put into a setting', () => {
  const file = (setting: string) => {
    const location = locateServer(inputs([], { setting, environment: { TOOLS: '/tools' } }));
    return location.kind === 'missing' ? location.tried[0] : location.file;
  };
  assert.equal(file('~/bin/rungwise'), '/home/ana/bin/rungwise');
  assert.equal(file('${workspaceFolder}/rungwise'), '/plant/rungwise');
  assert.equal(file('${userHome}/rungwise'), '/home/ana/rungwise');
  assert.equal(file('${env:TOOLS}/rungwise'), '/tools/rungwise');
  assert.equal(file('bin/rungwise'), '/plant/bin/rungwise');
});

test('on Windows the program ends in .exe and the variable may be spelled Path', () => {
  const location = locateServer(
    inputs(['C:\\plc\\rungwise.exe'], {
      platform: 'win32',
      extensionFolder: 'C:\\ext',
      environment: { Path: 'C:\\Windows;C:\\plc' },
    }),
  );
  assert.deepEqual(location, { kind: 'found', file: 'C:\\plc\\rungwise.exe', origin: 'path' });
});
