// The same acts with a mouse and with keys alone, so that one journey is made in both ways.

/** Acts by pointing. */
export const byMouse = {
  name: "a mouse",
  press: (page, node) => node.click(),
  write: (page, node, text) => node.fill(text),
  choose: (page, node, label) => node.selectOption({ label }),
  /** A table of rows and columns, as a file. */
  table: (page, dialog, rows) => dialog.getByLabel("File").setInputFiles({ name: "table.csv", mimeType: "text/csv", buffer: Buffer.from(rows) }),
};

/** Acts with keys: whatever is used gets the focus by Tab. */
export const byKeys = {
  name: "keys alone",
  async press(page, node) {
    await tabTo(page, node);
    await page.keyboard.press("Enter");
  },
  async write(page, node, text) {
    await tabTo(page, node);
    await page.keyboard.press("Control+a");
    await page.keyboard.type(text);
  },
  async choose(page, node, label) {
    await tabTo(page, node);
    const index = await node.locator("option").evaluateAll((all, wanted) => all.findIndex((option) => option.text === wanted), label);
    const now = await node.evaluate((select) => select.selectedIndex);
    for (let step = 0; step < Math.abs(index - now); step += 1) await page.keyboard.press(index > now ? "ArrowDown" : "ArrowUp");
  },
  /** The rows pasted: the choice of a file is a window of the system. */
  async table(page, dialog, rows) {
    await tabTo(page, dialog.getByLabel("Or its rows, pasted"));
    await page.keyboard.insertText(rows);
  },
};

/** Goes on with Tab until a part of the page has the focus. */
export async function tabTo(page, node) {
  await node.waitFor();
  for (let presses = 0; presses < 400; presses += 1) {
    if (await node.evaluate((one) => one === document.activeElement)) return;
    await page.keyboard.press("Tab");
  }
  throw new Error(`Tab does not come to ${node}`);
}
