import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { after, test } from 'node:test';
import { parseStatus, statusItem } from '../src/status';
import { targetChoices } from '../src/targets';
import { t, useTranslations } from '../src/words';

const json = (file: string): Record<string, string> => JSON.parse(readFileSync(file, 'utf8'));
const bundle = json('l10n/bundle.l10n.zh-cn.json');
const places = (words: string) => [...words.matchAll(/\{\d+\}/g)].map((match) => match[0]).sort();

/** The first argument of every call of `t(`, with the parts of a long one joined. */
function calls(source: string): string[] {
  const found: string[] = [];
  for (const match of source.matchAll(/\bt\(\s*((?:(?:'(?:[^'\\]|\\.)*'|"(?:[^"\\]|\\.)*")\s*\+?\s*)+)/g)) {
    const parts = [...(match[1] ?? '').matchAll(/'((?:[^'\\]|\\.)*)'|"((?:[^"\\]|\\.)*)"/g)];
    found.push(parts.map((part) => (part[1] ?? part[2] ?? '').replace(/\\(.)/g, '$1')).join(''));
  }
  return found;
}

const sources = readdirSync('src', { recursive: true, encoding: 'utf8' }).filter((name) => name.endsWith('.ts'));
const used = new Set(sources.flatMap((name) => calls(readFileSync(`src/${name}`, 'utf8'))));

after(() => useTranslations((message) => message));

test('every sentence of the extension is translated, with the same places, and no translation is left over', () => {
  assert.ok(used.size > 60, `only ${used.size} sentences`);
  for (const words of used) {
    const chinese = bundle[words];
    assert.ok(chinese, `no translation: ${words}`);
    assert.deepEqual(places(chinese), places(words), words);
  }
  assert.deepEqual(Object.keys(bundle).filter((words) => !used.has(words)), []);
});

test('every contribution is translated and every key is used', () => {
  const english = json('package.nls.json');
  const chinese = json('package.nls.zh-cn.json');
  assert.deepEqual(Object.keys(chinese).sort(), Object.keys(english).sort());
  for (const [key, words] of Object.entries(chinese)) {
    assert.match(words, /[\u4e00-\u9fff]/, key);
  }
  const manifest = readFileSync('package.json', 'utf8');
  const keys = [...manifest.matchAll(/"%([^%"]+)%"/g)].map((match) => match[1] ?? '');
  assert.deepEqual([...new Set(keys)].sort(), Object.keys(english).sort());
});

/** Where words for users stand in package.json; names such as `Rungwise` and drawings need no translation. */
test('no sentence in package.json bypasses the translations', () => {
  const manifest = JSON.parse(readFileSync('package.json', 'utf8'));
  const plain: string[] = [];
  const visit = (value: unknown, key: string): void => {
    if (typeof value === 'string') {
      const forUsers = /^(title|description|markdownDescription|enumDescriptions|label|displayName|alt)$/.test(key);
      if (forUsers && /[a-z] [a-z]/i.test(value) && !value.startsWith('%')) {
        plain.push(value);
      }
    } else if (Array.isArray(value)) {
      value.forEach((item) => visit(item, key));
    } else if (typeof value === 'object' && value !== null) {
      Object.entries(value).forEach(([name, item]) => visit(item, name));
    }
  };
  visit({ contributes: manifest.contributes, capabilities: manifest.capabilities }, '');
  assert.deepEqual(plain, []);
});

test('messages of VS Code are given in words that can be translated', () => {
  for (const name of sources) {
    const source = readFileSync(`src/${name}`, 'utf8');
    for (const call of source.matchAll(/show(?:Information|Warning|Error)Message\(\s*(['"`])/g)) {
      assert.match(source.slice(call.index, call.index + 60), /Rungwise: \$\{reason\}/, `${name}: ${source.slice(call.index, call.index + 80)}`);
    }
  }
});

test('words follow the editor', () => {
  assert.equal(t('{0} of {1}', 1, 'x'), '1 of x');
  useTranslations((message, ...args) => (bundle[message] ?? message).replace(/\{(\d)\}/g, (_, n) => String(args[Number(n)])));
  const status = parseStatus({ uri: 'file:///a.il', target: 'fx2n', dialect: 'fx', steps: 42, capacity: 8000, rungs: 7 });
  const item = statusItem('running', status);
  assert.equal(item.text, '$(circuit-board) FX2N · FX · 42/8,000 步');
  assert.match(item.tooltip, /程序：8,000 步中用了 42 步（0\.5 %）\n梯级：7\n/);
  assert.equal(targetChoices(null, 'fx3u')[0]?.description, '取自 rungwise.toml，否则由程序判断（已选: FX3U）');
});
