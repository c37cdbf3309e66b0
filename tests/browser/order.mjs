// The order of a plan changed by hand, with keys and with a mouse, and planned again.

import { check, eventually, findings, fixture, openPage, picture, planned } from "./harness.mjs";

const job = async (service, path) => (await fetch(`${service.address}/v1/plans/${path}`)).json();
const shown = (page) => page.locator(".order-edit .stop-name").allTextContents();

export async function order({ browser, service, must }) {
  const id = await planned(service, fixture("olivares-a"));
  const { sequence } = await job(service, `${id}/result`);
  const { page, complaints, close } = await openPage(browser, service);
  const open = async () => {
    await page.goto("about:blank");
    await page.goto(`${service.address}/#/plans/${id}`);
    await page.getByText("Change the order").focus();
    await page.keyboard.press("Enter");
    await page.getByRole("button", { name: `Move ${sequence[0]}`, exact: true }).waitFor();
  };

  await must("a target is moved with keys, and keeps its place in the next plan", async () => {
    await open();
    await page.getByRole("button", { name: `Move ${sequence[0]}`, exact: true }).focus();
    await page.keyboard.press("ArrowDown");
    await page.keyboard.press("ArrowDown");
    const moved = [sequence[1], sequence[2], sequence[0], ...sequence.slice(3)];
    await eventually(async () => check((await shown(page)).join() === moved.join(), (await shown(page)).join()));
    check(await page.getByRole("button", { name: `Move ${sequence[0]}`, exact: true }).evaluate((node) => node === document.activeElement), "the focus is lost");
    check(await page.getByRole("checkbox", { name: `Keep the place of ${sequence[0]}` }).isChecked(), "it is not kept");
    await page.getByText(`${sequence[0]} has place 3. 1 place of 6 kept.`).waitFor();
    const found = await findings(page);
    check(found.length === 0, found.join("\n"));
    await picture(page, "order-desktop-light");
    await page.getByRole("button", { name: "Plan again and compare" }).focus();
    await page.keyboard.press("Enter");
    await page.getByRole("heading", { name: "Order and times" }).waitFor();
    const other = page.url().split("/").at(-1);
    const [scenario, plan] = await Promise.all([job(service, `${other}/scenario`), job(service, `${other}/result`)]);
    const places = Object.fromEntries(scenario.targets.filter((target) => target.position).map((target) => [target.id, target.position]));
    check(JSON.stringify(places) === JSON.stringify({ [sequence[0]]: 3 }), JSON.stringify(places));
    check(plan.sequence[2] === sequence[0], plan.sequence.join());
    return `${sequence.join(" ")}, then ${plan.sequence.join(" ")}`;
  });
  await must("a target is dragged, and all places are kept", async () => {
    await open();
    const row = async (target) => page.locator(".order-edit li", { has: page.getByText(target, { exact: true }) }).boundingBox();
    const handle = page.getByRole("button", { name: `Move ${sequence[5]}`, exact: true });
    await handle.scrollIntoViewIfNeeded();
    const [from, to] = [await handle.boundingBox(), await row(sequence[1])];
    await page.mouse.move(from.x + from.width / 2, from.y + from.height / 2);
    await page.mouse.down();
    await page.mouse.move(to.x + to.width / 2, to.y + to.height / 2, { steps: 8 });
    await page.mouse.up();
    const moved = [sequence[0], sequence[5], ...sequence.slice(1, 5)];
    await eventually(async () => check((await shown(page)).join() === moved.join(), (await shown(page)).join()));
    await page.getByRole("button", { name: "Keep all places" }).click();
    await page.getByText("6 places of 6 kept.").waitFor();
    await page.getByRole("button", { name: "Plan again and compare" }).click();
    await page.getByRole("heading", { name: "Order and times" }).waitFor();
    const plan = await job(service, `${page.url().split("/").at(-1)}/result`);
    check(plan.sequence.join() === moved.join(), plan.sequence.join());
    return moved.join(" ");
  });
  await must("no error of the console while the order is changed", () => check(complaints.length === 0, complaints.join("\n")));
  await close();
}
