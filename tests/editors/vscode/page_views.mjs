// What the extension draws beside the program.

export const VIEW_TESTS = {
  'hints are drawn into the program': hints,
};

async function hints(workbench) {
  await workbench.openFile('conveyor_fx.il');
  await workbench.until('the hint', async () => (await workbench.editorLines()).some((line) => /K50.*5\ss/.test(line)));
  await workbench.screenshot('18-hints');
}
