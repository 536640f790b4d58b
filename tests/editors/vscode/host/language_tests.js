// Hover, completion, formatting, navigation, rename, symbols, hints.

const assert = require('node:assert/strict');
const vscode = require('vscode');
const { completionLabels, find, hoverText, open, openText, replace, revert, until, untilCodes } = require('./support');

const provide = (command, ...args) => vscode.commands.executeCommand(`vscode.${command}`, ...args);

/** Formats as the key does, and gives the text afterwards. */
async function formatted(document) {
  await vscode.window.showTextDocument(document);
  await vscode.commands.executeCommand('editor.action.formatDocument');
  return document.getText();
}

/** Columns of the right rail over all lines of the drawing. */
function railColumns(text) {
  const rows = text.split('\n').filter((line) => /^[|+│├└]/.test(line));
  return [...new Set(rows.map((row) => [...row].length))];
}

module.exports = [
  ['hover explains an instruction, a device of a list and a device of a ladder', async () => {
    const list = await open('conveyor_fx.il');
    assert.match(await hoverText(list, find(list, 'MOV')), /MOV/);
    assert.match(await hoverText(list, find(list, 'T0 K50')), /T0/);
    const ladder = await open('three_mistakes.lad');
    assert.match(await hoverText(ladder, find(ladder, 'X11')), /X11/);
  }],
  ['completion offers instructions', async () => {
    const document = await openText('plc-il', '// dialect: fx\nLD X0\nMO\nEND\n');
    const labels = await completionLabels(document, new vscode.Position(2, 2));
    assert.ok(labels.includes('MOV'), `no MOV in ${labels.slice(0, 20)}`);
    const iec = await openText('plc-il', 'PROGRAM P\nVAR\n a : BOOL;\nEND_VAR\n LD a\n S\nEND_PROGRAM\n');
    assert.ok((await completionLabels(iec, new vscode.Position(5, 2))).includes('ST'), 'no ST');
  }],
  ['completion offers instructions in the box of a ladder', async () => {
    const document = await open('ragged.lad');
    await replace(document, 10, 17, 28, 'M          ');
    const labels = await completionLabels(document, new vscode.Position(10, 18));
    assert.ok(labels.includes('MOV'), `no MOV in ${labels.slice(0, 20)}`);
    await revert(document);
  }],
  ['a manifest is checked as it is typed, completed and explained', async () => {
    const file = vscode.Uri.joinPath(vscode.workspace.workspaceFolders[0].uri, 'manifest', 'rungwise.toml');
    await vscode.workspace.fs.writeFile(file, Buffer.from(''));
    // The extension starts for a folder with a manifest or with a program; this one has become the former only now.
    await open('ragged.lad');
    const document = await vscode.workspace.openTextDocument(file);
    await replace(document, 0, 0, 0, 'target = "fx9"');
    await until('the mistake', () => vscode.languages.getDiagnostics(file).some(({ message, range }) =>
      message.includes('fx9') && range.start.character === 10 && range.end.character === 13));
    await replace(document, 0, 10, 13, 'fx2n');
    await until('no mistake', () => vscode.languages.getDiagnostics(file).length === 0);
    assert.ok((await completionLabels(document, new vscode.Position(0, 12))).includes('fx3u'), 'no fx3u');
    assert.match(await hoverText(document, new vscode.Position(0, 2)), /PLC model/);
    await revert(document);
    await vscode.workspace.fs.delete(vscode.Uri.joinPath(file, '..'), { recursive: true });
  }],
  ['completion offers the variables of the program', async () => {
    const document = await open('mixer_iec.il');
    const at = find(document, 'ST Motor', 0, 3);
    assert.ok((await completionLabels(document, at)).includes('Motor'), 'no Motor');
  }],
  ['formatting straightens a ladder, once and for all', async () => {
    const document = await open('ragged.lad');
    assert.ok(railColumns(document.getText()).length > 1, 'the input is not ragged');
    const once = await formatted(document);
    assert.equal(railColumns(once).length, 1, once);
    for (const name of ['X0', 'X1', 'X2', 'Y0', 'T0', 'K50', 'MOV K10 D0', 'END', 'Start and stop with seal-in']) {
      assert.ok(once.includes(name), `${name} is lost:\n${once}`);
    }
    await untilCodes(document, []);
    assert.equal(await formatted(document), once, 'a second run changes something');
    await revert(document);
  }],
  ['the style of the formatter follows the setting', async () => {
    const section = vscode.workspace.getConfiguration('rungwise');
    const document = await open('ragged.lad');
    try {
      await section.update('format.style', 'unicode', vscode.ConfigurationTarget.Global);
      await until('a drawing with box characters', async () => /┤ ├/.test(await formatted(document)));
    } finally {
      await section.update('format.style', undefined, vscode.ConfigurationTarget.Global);
      await revert(document);
    }
  }],
  ['rename changes every use of a variable', async () => {
    const document = await open('mixer_iec.il');
    const uses = document.getText().split(/\bMotor\b/).length - 1;
    const edit = await provide('executeDocumentRenameProvider', document.uri, find(document, 'ST Motor', 0, 4), 'Pump');
    const edits = edit.get(document.uri);
    assert.equal(edits.length, uses);
    assert.ok(edits.every((e) => e.newText === 'Pump' && document.getText(e.range) === 'Motor'));
  }],
  ['definition and references of a variable', async () => {
    const document = await open('mixer_iec.il');
    const at = find(document, 'ST Motor', 0, 4);
    const [definition] = await provide('executeDefinitionProvider', document.uri, at);
    const range = definition.targetSelectionRange ?? definition.targetRange ?? definition.range;
    assert.equal(range.start.line, find(document, 'Motor AT').line);
    const references = await provide('executeReferenceProvider', document.uri, at);
    assert.ok(references.length >= 4, `${references.length} references`);
  }],
  ['symbols, folding and semantic tokens are there', async () => {
    for (const name of ['mixer_iec.il', 'three_mistakes.lad']) {
      const { uri } = await open(name);
      await until(`symbols of ${name}`, async () => (await provide('executeDocumentSymbolProvider', uri))?.length > 0);
      await until(`folding of ${name}`, async () => (await provide('executeFoldingRangeProvider', uri))?.length > 0);
      await until(`tokens of ${name}`, async () => (await provide('provideDocumentSemanticTokens', uri))?.data.length > 0);
    }
  }],
  ['a preset is translated into seconds, unless the setting says no', async () => {
    const document = await open('conveyor_fx.il');
    const everything = new vscode.Range(0, 0, document.lineCount, 0);
    const hints = async () => {
      const found = await provide('executeInlayHintProvider', document.uri, everything);
      return (found ?? []).map((hint) => (typeof hint.label === 'string' ? hint.label : hint.label.map((p) => p.value).join('')));
    };
    await until('the hint 5 s', async () => (await hints()).some((label) => /\b5\s*s\b/.test(label)));
    const section = vscode.workspace.getConfiguration('rungwise');
    try {
      await section.update('inlayHints.enabled', false, vscode.ConfigurationTarget.Global);
      await until('no hints', async () => (await hints()).length === 0);
    } finally {
      await section.update('inlayHints.enabled', undefined, vscode.ConfigurationTarget.Global);
    }
  }],
];
