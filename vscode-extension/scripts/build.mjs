// Bundles the extension into dist/extension.js and dist/web.js, the page of a panel into dist/panel.js, and copies the grammars and the example in.
//
// Usage: node scripts/build.mjs [--production] [--tests]
//   --production  minified, no source map
//   --tests       also bundles every test/*.test.ts into out/test for `node --test`

import { cpSync, mkdirSync, readdirSync, rmSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const root = dirname(dirname(fileURLToPath(import.meta.url)));
const production = process.argv.includes('--production');
const common = { absWorkingDir: root, bundle: true, platform: 'node', target: 'node20', logLevel: 'warning' };

// Everything that package.json names has to lie inside the extension, while the grammars serve other editors too.
rmSync(join(root, 'syntaxes'), { recursive: true, force: true });
mkdirSync(join(root, 'syntaxes'));
for (const name of readdirSync(join(root, '..', 'syntaxes'))) {
  if (name.endsWith('.tmLanguage.json')) {
    cpSync(join(root, '..', 'syntaxes', name), join(root, 'syntaxes', name));
  }
}

rmSync(join(root, 'examples'), { recursive: true, force: true });
for (const name of ['getting-started', 'getting-started-zh-cn']) {
  cpSync(join(root, '..', 'examples', name), join(root, 'examples', name), { recursive: true });
}

rmSync(join(root, 'dist'), { recursive: true, force: true });
const bundle = { ...common, format: 'cjs', external: ['vscode'], minify: production, sourcemap: !production };
await build({ ...bundle, entryPoints: ['src/extension.ts'], outfile: 'dist/extension.js' });
// The edition for the browser alone, which has no Node.
await build({ ...bundle, platform: 'browser', target: 'es2022', entryPoints: ['src/web.ts'], outfile: 'dist/web.js' });
const page = { ...common, platform: 'browser', target: 'es2022', format: 'iife', minify: production, sourcemap: production ? false : 'inline' };
await build({ ...page, entryPoints: ['src/panel/page/main.ts'], outfile: 'dist/panel.js' });

if (process.argv.includes('--tests')) {
  rmSync(join(root, 'out'), { recursive: true, force: true });
  const tests = readdirSync(join(root, 'test')).filter((name) => name.endsWith('.test.ts'));
  await build({
    ...common,
    entryPoints: tests.map((name) => join('test', name)),
    outdir: 'out/test',
    outExtension: { '.js': '.mjs' },
    format: 'esm',
    sourcemap: 'inline',
  });
}
