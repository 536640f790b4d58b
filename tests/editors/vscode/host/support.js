// What the tests inside the extension host share: waiting, opening, comparing diagnostics.

const assert = require('node:assert/strict');
const fs = require('node:fs');
const path = require('node:path');
const vscode = require('vscode');

const WORKSPACE = process.env.RUNGWISE_TEST_WORKSPACE;
const TIMEOUT_MS = 45_000;
const EXPECTED = JSON.parse(fs.readFileSync(path.join(WORKSPACE, 'expected.json'), 'utf8'));

const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/** Waits until `probe` gives something true, and gives that. A probe that throws counts as not yet. */
async function until(what, probe, timeoutMs = TIMEOUT_MS) {
  const end = Date.now() + timeoutMs;
  let last;
  for (;;) {
    try {
      last = await probe();
      if (last) {
        return last;
      }
    } catch (error) {
      last = error;
    }
    if (Date.now() > end) {
      throw new Error(`waited ${timeoutMs} ms for ${what}; last: ${last instanceof Error ? last.message : last}`);
    }
    await sleep(25);
  }
}

/** Shows a file of the workspace as it is on the disk. */
async function open(name) {
  const document = await vscode.workspace.openTextDocument(path.join(WORKSPACE, name));
  await vscode.window.showTextDocument(document);
  return document;
}

/** Shows a text that has no file. */
async function openText(language, content) {
  const document = await vscode.workspace.openTextDocument({ language, content });
  await vscode.window.showTextDocument(document);
  return document;
}

/** Replaces from column to column in one line, as one edit. */
async function replace(document, line, from, to, text) {
  const editor = await vscode.window.showTextDocument(document);
  const range = new vscode.Range(line, from, line, to);
  assert.ok(await editor.edit((edit) => edit.replace(range, text)), 'the edit was refused');
}

/** Takes all edits back that a test made. */
async function revert(document) {
  await vscode.window.showTextDocument(document);
  await vscode.commands.executeCommand('workbench.action.files.revert');
}

const codeOf = (diagnostic) => (typeof diagnostic.code === 'object' ? diagnostic.code.value : diagnostic.code);

function errors(document) {
  return vscode.languages
    .getDiagnostics(document.uri)
    .filter((diagnostic) => diagnostic.severity === vscode.DiagnosticSeverity.Error);
}

const errorCodes = (document) => errors(document).map(codeOf).sort();

function describe(document) {
  return vscode.languages
    .getDiagnostics(document.uri)
    .map((d) => `${codeOf(d)} ${d.range.start.line}:${d.range.start.character}-${d.range.end.line}:${d.range.end.character} ${d.message}`)
    .join(' | ');
}

/** Waits until the errors of a document have exactly these codes, each once. */
async function untilCodes(document, codes) {
  const wanted = [...codes].sort();
  const same = () => JSON.stringify(errorCodes(document)) === JSON.stringify(wanted);
  await until(`exactly the errors ${wanted.join(', ') || '(none)'}`, () => {
    if (!same()) {
      throw new Error(describe(document) || 'no diagnostics');
    }
    return true;
  });
  // Diagnostics may come in two waves; a result that does not last is no result.
  await sleep(200);
  assert.ok(same(), `the errors changed afterwards: ${describe(document)}`);
}

/** Compares each error with the cells of expected.json. */
function assertCells(document, name) {
  for (const diagnostic of errors(document)) {
    const cells = EXPECTED[name][codeOf(diagnostic)];
    assert.ok(cells, `not expected: ${codeOf(diagnostic)}`);
    const { line, character } = diagnostic.range.start;
    const inside = line >= cells.lines[0] && line <= cells.lines[1] && character >= cells.columns[0] && character <= cells.columns[1];
    assert.ok(inside, `${codeOf(diagnostic)} at ${line}:${character}, expected in ${JSON.stringify(cells)}`);
    assert.ok(!diagnostic.range.isEmpty, `${codeOf(diagnostic)} marks no cell`);
  }
}

/** Position of the `nth` occurrence (from 0) of a text, `offset` characters into it. */
function find(document, text, nth = 0, offset = 1) {
  let index = -1;
  for (let i = 0; i <= nth; i++) {
    index = document.getText().indexOf(text, index + 1);
    assert.ok(index >= 0, `"${text}" is not in the document`);
  }
  return document.positionAt(index + offset);
}

async function hoverText(document, position) {
  const hovers = await vscode.commands.executeCommand('vscode.executeHoverProvider', document.uri, position);
  return hovers
    .flatMap((hover) => hover.contents)
    .map((content) => (typeof content === 'string' ? content : content.value))
    .join('\n');
}

async function completionLabels(document, position) {
  const list = await vscode.commands.executeCommand('vscode.executeCompletionItemProvider', document.uri, position);
  return list.items.map((item) => (typeof item.label === 'string' ? item.label : item.label.label));
}

module.exports = {
  EXPECTED, WORKSPACE, assertCells, codeOf, completionLabels, describe, errorCodes, errors, find, hoverText, open, openText,
  replace, revert, sleep, until, untilCodes,
};
