import assert from 'node:assert/strict';
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { test } from 'node:test';
import { STRUCTURAL_EDITS } from '../src/structuralEdits';

interface Snippet {
  prefix: string;
  body: string | string[];
}

/** The sources, by their names below `src`. */
const SOURCES = readdirSync('src', { recursive: true, encoding: 'utf8' }).filter((name) => name.endsWith('.ts'));

const json = (file: string): any => JSON.parse(readFileSync(file, 'utf8'));
const manifest = json('package.json');

/** Text that a snippet inserts when nothing is typed over. */
function expand(snippet: Snippet): string {
  const body = Array.isArray(snippet.body) ? snippet.body.join('\n') : snippet.body;
  return body
    .replace(/\$\{\d+\|([^,|]*)[^|]*\|\}/g, '$1')
    .replace(/\$\{\d+:([^}]*)\}/g, '$1')
    .replace(/\$\d+/g, '');
}

function words(language: string, line: string): string[] {
  const { pattern, flags } = json(`language-configuration.${language}.json`).wordPattern;
  return [...line.matchAll(new RegExp(pattern, `${flags}g`))].map((match) => match[0]);
}

test('every rung among the ladder snippets is a drawing of equal width with both rails', () => {
  const snippets: Record<string, Snippet> = json('snippets/ladder.json');
  let rungs = 0;
  for (const [title, snippet] of Object.entries(snippets)) {
    if (!title.startsWith('Rung:') && !title.startsWith('Rungs:')) {
      continue;
    }
    const rows = expand(snippet).split('\n').filter((row) => row !== '');
    for (const row of rows) {
      assert.equal(row.length, 48, `${title}: ${row}`);
      assert.match(row, /^[|+].*[|+]$/, `${title}: ${row}`);
    }
    rungs += 1;
  }
  assert.ok(rungs >= 15, `only ${rungs} rungs`);
});

test('the snippets have prefixes of their own and the same placeholder for the same name', () => {
  for (const file of ['ladder', 'plc-il']) {
    const snippets: Snippet[] = Object.values(json(`snippets/${file}.json`));
    const prefixes = snippets.map((snippet) => snippet.prefix);
    assert.equal(new Set(prefixes).size, prefixes.length, `${file}: a prefix occurs twice`);
    for (const snippet of snippets) {
      const names = new Map<string, string>();
      for (const [, number = '', name = ''] of [snippet.body].flat().join('\n').matchAll(/\$\{(\d+):([^}]*)\}/g)) {
        assert.equal(names.get(number) ?? name, name, `${snippet.prefix}: placeholder ${number} has two names`);
        names.set(number, name);
      }
    }
  }
});

test('devices, comparisons, addresses and literals are words', () => {
  const all = ['X001', 'LD=', 'ANDD>=', '%IX0.0', 'K4M0', 'T#1h30m', '16#FF', 'INT#5', 'D0.3', 'LD', 'Förderband'];
  for (const language of ['ladder', 'plc-il']) {
    assert.deepEqual(words(language, all.join(' ')), all);
    assert.deepEqual(words(language, 'LD= D0 K10'), ['LD=', 'D0', 'K10']);
    assert.deepEqual(words(language, '---[MOV K10 D0]---( )'), ['MOV', 'K10', 'D0']);
    assert.deepEqual(words(language, '+---| |---|/|---( )-+'), []);
  }
  assert.deepEqual(words('plc-il', 'BOARD=1'), ['BOARD', '1']);
  assert.deepEqual(words('plc-il', 'LD Delay.Q'), ['LD', 'Delay', 'Q']);
  assert.deepEqual(words('plc-il', '&N A'), ['&N', 'A']);
});

test('all files that package.json names exist', () => {
  const { languages, grammars, snippets, walkthroughs, tomlValidation } = manifest.contributes;
  const files = [manifest.icon, ...[...languages, ...grammars, ...snippets].flatMap((c: any) => [c.configuration, c.path])];
  files.push(manifest.main, manifest.browser, ...manifest.contributes['markdown.previewStyles'], ...tomlValidation.map((c: any) => c.url));
  files.push(...manifest.contributes.viewsContainers.activitybar.map((container: any) => container.icon));
  for (const language of languages) {
    files.push(language.icon.light, language.icon.dark);
  }
  for (const step of walkthroughs.flatMap((walkthrough: any) => walkthrough.steps)) {
    files.push(step.media.svg);
  }
  for (const file of files.filter(Boolean)) {
    assert.ok(existsSync(file), `${file} is missing`);
  }
});

test('both languages of package.json have every key, and no other', () => {
  const used = [...readFileSync('package.json', 'utf8').matchAll(/"%([^%"]+)%"/g)].map(([, key]) => key).sort();
  for (const file of ['package.nls.json', 'package.nls.zh-cn.json']) {
    assert.deepEqual(Object.keys(json(file)).sort(), [...new Set(used)], file);
  }
});

test('every sentence of the sources has a translation', () => {
  const translated = json('l10n/bundle.l10n.zh-cn.json');
  // A sentence may be written as several strings with + between them.
  const call = /\bt\(\s*((?:'(?:[^'\\]|\\.)*'\s*\+?\s*)+)/g;
  for (const name of SOURCES) {
    for (const [, strings = ''] of readFileSync(`src/${name}`, 'utf8').matchAll(call)) {
      const sentence = [...strings.matchAll(/'((?:[^'\\]|\\.)*)'/g)].map(([, text]) => text).join('');
      assert.ok(sentence in translated, `${name}: "${sentence}" has no translation`);
      const places = (text: string) => [...text.matchAll(/\{\d+\}/g)].map(String).sort();
      assert.deepEqual(places(translated[sentence]), places(sentence), sentence);
    }
  }
});

test('no two commands have the same keys, and all keys are for programs only', () => {
  const { keybindings } = manifest.contributes;
  for (const system of ['key', 'mac']) {
    const keys = keybindings.map((binding: any) => binding[system]);
    assert.equal(new Set(keys).size, keys.length, `${system}: the same keys twice`);
  }
  for (const binding of keybindings) {
    assert.match(binding.when, /editorTextFocus && .*editorLangId == ladder/, binding.command);
  }
});

test('links of the walkthrough are commands that there are', () => {
  const commands = manifest.contributes.commands.map((entry: any) => entry.command);
  for (const file of ['package.nls.json', 'package.nls.zh-cn.json']) {
    const links = [...readFileSync(file, 'utf8').matchAll(/\(command:([\w.]+)\)/g)].map(([, command]) => command);
    assert.ok(links.length >= 6);
    assert.deepEqual(links.filter((command) => !commands.includes(command)), [], file);
  }
});

test('each keyword entry of the grammar is one pattern, longest word first', () => {
  const grammar = json('syntaxes/rungwise-il.tmLanguage.json');
  for (const key of ['fx-mnemonics', 'iec-operators', 'iec-functions', 'iec-blocks', 'iec-keywords', 'iec-types']) {
    const entry = grammar.repository[key];
    const parts = /^\(\?i\)\(\?<!\[\\w\.%#\]\)\(\?:(.+)\)\(\?!\[\\w#\]\)$/.exec(entry.match);
    const list = (parts?.[1] ?? '').split('|').map((word) => word.replace(/\\(.)/g, '$1'));
    assert.ok(list.length > 5, `${key}: the form of the pattern`);
    // A last alternative may be a pattern for a whole family of words, such as the conversions.
    if (list.at(-1)?.includes('[')) {
      list.pop();
    }
    const sorted = [...new Set(list)].sort((a, b) => b.length - a.length || (a < b ? -1 : 1));
    assert.deepEqual(list, sorted, `${key}: order`);
  }
});

test('the commands of the palette are all implemented', () => {
  const sources = SOURCES.filter((name) => name !== 'web.ts').map((name) => readFileSync(`src/${name}`, 'utf8')).join('\n');
  for (const { command } of manifest.contributes.commands) {
    const edit = STRUCTURAL_EDITS.some((name) => `rungwise.${name}` === command);
    assert.ok(edit || sources.includes(`register('${command}'`) || sources.includes(`registerCommand('${command}'`), command);
  }
  for (const edit of STRUCTURAL_EDITS) {
    const has = (list: any[]) => list.some(({ command }) => command === `rungwise.${edit}`);
    const { commands, keybindings, menus } = manifest.contributes;
    assert.ok(has(commands) && has(keybindings) && has(menus['rungwise.drawing']), `${edit} has no command, key or menu entry`);
  }
});
