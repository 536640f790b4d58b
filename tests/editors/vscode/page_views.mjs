// What the extension shows beside and inside other documents.

export const VIEW_TESTS = {
  'a drawing in a fence of a Markdown file has its errors': fences,
};

async function fences(workbench) {
  await workbench.openFile('notes.md');
  await workbench.until('a squiggle', async () => (await workbench.errorSquiggles()) >= 1);
  await workbench.screenshot('19-fence');
}
