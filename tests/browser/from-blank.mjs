// The whole work of a planner who writes no JSON: from a blank form to two plans, their comparison and the files,
// once with a mouse and once with keys alone; then the plan is read on a phone, by touch and by keys.

import { readFileSync } from "node:fs";
import { byKeys, byMouse, tabTo } from "./acts.mjs";
import { PHONE, check, eventually, findings, openPage, picture, stars } from "./harness.mjs";

/** Of drafts that are not whole yet the service says what is missing, which the browser itself reports. */
const REFUSED = [/^console: Failed to load resource.* 4(00|04|09|22) /];
const INERTIA = { "J xx kg m²": "6.63", "J yy kg m²": "8.9", "J zz kg m²": "9.63" };
const WHEEL = { "Inertia of a wheel kg m²": "0.000169", "Torque of a wheel N m": "0.0101", "Speed of a wheel rad/s": "710" };
const EPOCH = "2026-11-25T00:00:00Z";
const COUNT = 12;

export async function fromBlank(given) {
  let id;
  for (const way of [byMouse, byKeys]) id = await journey(given, way);
  await onPhone(given, id);
}

const answer = async (service, path) => (await fetch(`${service.address}${path}`)).json();
const moment = (page) => page.locator("#moment").inputValue().then(Number);

/** The identifier of the first of the two plans. */
async function journey({ browser, service, must }, way) {
  const { page, complaints, close } = await openPage(browser, service, { expected: REFUSED });
  const button = (name) => page.getByRole("button", { name, exact: true });
  const link = (name) => page.getByRole("link", { name, exact: true });
  const cell = (name) => page.getByLabel(name, { exact: true });
  const scenario = async () => JSON.parse(await page.locator("#scenario").inputValue());
  const title = `twelve stars, ${way.name}`;
  const step = (what, act) => must(`${way.name}: ${what}`, act);
  const isPlanned = async () => {
    await page.getByText("No problems").waitFor();
    await way.press(page, button("Plan"));
    await page.getByRole("heading", { name: "Timelines" }).waitFor();
    return page.url().split("/").at(-1);
  };
  const clean = async (name) => {
    if (way === byMouse) await picture(page, name);
    const found = await findings(page);
    check(found.length === 0, found.join("\n"));
  };
  let first;
  let second;

  await step("a spacecraft by form", async () => {
    await page.goto(`${service.address}/#/new`);
    await page.getByRole("heading", { name: "Spacecraft" }).waitFor();
    await clean("desk-blank");
    await way.write(page, cell("Name"), title);
    for (const [label, value] of Object.entries(INERTIA)) await way.write(page, cell(label), value);
    await way.choose(page, page.getByLabel("Wheels stand"), "Pyramid about Z, 4 wheels between X and Y");
    for (const [label, value] of Object.entries(WHEEL)) await way.write(page, cell(label), value);
    await way.press(page, button("Set wheels"));
    await way.press(page, button("Add boresight"));
    for (const axis of ["x", "y", "z"]) await way.write(page, cell(`Rate ${axis} rad/s`).first(), "0.04");
    const { spacecraft } = await scenario();
    const sizes = spacecraft.wheels.map(({ axis }) => Math.hypot(...axis));
    check(sizes.length === 4 && sizes.every((size) => Math.abs(size - 1) < 1e-8), JSON.stringify(spacecraft.wheels));
    check(spacecraft.inertia_kg_m2[1].join() === "0,8.9,0" && spacecraft.boresights[0].name === "camera", JSON.stringify(spacecraft));
    return `${spacecraft.wheels.length} wheels`;
  });
  await step(`${COUNT} stars of a catalogue, its columns shown before`, async () => {
    await way.press(page, button("Take targets from a table"));
    const dialog = page.getByRole("dialog");
    await way.table(page, dialog, stars(COUNT));
    await dialog.getByText(`${COUNT} rows, every cell can be read.`).waitFor();
    check(await dialog.getByLabel("ra_deg is").inputValue() === "ra" && await dialog.getByLabel("dec_deg is").inputValue() === "dec", "the columns");
    await clean("desk-import");
    await way.press(page, dialog.getByRole("button", { name: `Add ${COUNT} targets` }));
    // A dialog is hidden before its event `close` takes the table into the draft.
    const { targets } = await eventually(async () => {
      const taken = await scenario();
      check(taken.targets?.length === COUNT, `${taken.targets?.length} targets`);
      return taken;
    });
    check(JSON.stringify(targets[3]) === JSON.stringify({ id: "arcturus", pointing: { boresight: "camera", ra_dec_deg: [213.915, 19.182] } }), JSON.stringify(targets[3]));
    await eventually(async () => check(await page.locator(".desk-sphere .place.target").count() === COUNT, "targets in the sky"));
  });
  await step("a cone around the Sun and an epoch, and the plan keeps to it", async () => {
    await way.press(page, button("Add cone").first());
    await way.write(page, cell("Half angle, ° of cone 1"), "30");
    for (const [label, value] of Object.entries({ Epoch: EPOCH, "Gap to stop at": "0.1", "Time limit s": "300" })) await way.write(page, cell(label), value);
    await page.locator(".desk-sphere .sun").waitFor({ state: "attached" });
    const written = await scenario();
    check(JSON.stringify(written.keep_out) === '[{"boresight":"camera","direction":{"body":"sun"},"half_angle_deg":30}]', JSON.stringify(written.keep_out));
    await clean("desk-stars");
    const drawn = await page.evaluate(async (document) => {
      const folder = globalThis.document.querySelector("script[type=module]").getAttribute("src").replace("/app/main.js", "");
      const { sunOf } = await import(`${folder}/app/desk/sun.js`);
      return sunOf(document);
    }, written);
    first = await isPlanned();
    const plan = await answer(service, `/v1/plans/${first}/result`);
    const [{ direction, clearance_deg: clearance }] = plan.margins.keep_out_clearance_deg;
    check(clearance > -1e-6, `clearance ${clearance}`);
    const apart = Math.hypot(...direction.map((part, index) => part - drawn[index]));
    check(apart < 1e-6, `the Sun is drawn ${apart} rad beside where the service has it`);
    check(plan.sequence.length === COUNT, plan.sequence.join());
    return `${plan.total_time_s.toFixed(1)} s, clearance ${clearance.toFixed(1)}°`;
  });
  await step("the plan is edited and planned again", async () => {
    await way.press(page, link("Edit and plan again"));
    await page.getByText("No problems").waitFor();
    await way.write(page, cell("Name"), `less torque, ${way.name}`);
    await way.write(page, cell("Torque authority"), "0.5");
    await eventually(async () => check((await scenario()).options.torque_authority === 0.5, "it is not written"));
    second = await isPlanned();
    const [one, other] = await Promise.all([first, second].map((job) => answer(service, `/v1/plans/${job}/result`)));
    check(other.total_time_s > one.total_time_s + 1, `${one.total_time_s} s, then ${other.total_time_s} s`);
    return `${one.total_time_s.toFixed(1)} s, then ${other.total_time_s.toFixed(1)} s`;
  });
  await step("both plans are compared and played", async () => {
    await way.press(page, link("Compare"));
    const field = page.getByLabel("Second plan");
    await field.locator("option").nth(1).waitFor({ state: "attached" });
    const labels = await field.locator("option").allTextContents();
    await way.choose(page, field, labels.find((text) => text.startsWith(title)));
    if (way === byKeys) await page.keyboard.press("Tab");
    await page.getByRole("heading", { name: "Order and times" }).waitFor();
    await eventually(async () => check(await moment(page) === 0, "it does not begin at the start"));
    await way.press(page, button("Play"));
    await eventually(async () => check(await moment(page) > 1, "nothing moves"));
    await way.press(page, button("Pause"));
    await clean("compare-stars");
    return `until ${(await moment(page)).toFixed(1)} s`;
  });
  await step("the plan is taken as a table and as a picture", async () => {
    await page.goto(`${service.address}/#/plans/${second}`);
    await page.locator(".timelines .uplot").first().waitFor();
    const files = [];
    for (const node of [page.getByRole("link", { name: /^CSV/ }), button("Save timelines as PNG")]) {
      const [download] = await Promise.all([page.waitForEvent("download"), way.press(page, node)]);
      files.push([download.suggestedFilename(), readFileSync(await download.path())]);
    }
    check(files[0][1].toString("utf8").startsWith("time_s"), files[0][0]);
    check(files[1][1].subarray(1, 4).toString() === "PNG", files[1][0]);
    return files.map(([name, bytes]) => `${name} ${bytes.length}`).join(", ");
  });
  await step("the draft is still there, and no error of the console on the way", async () => {
    await way.press(page, link("New plan").first());
    await cell("Name of sirius").waitFor();
    check(complaints.length === 0, complaints.join("\n"));
  });
  await close();
  return first;
}

async function onPhone({ browser, service, must }, id) {
  const plan = await answer(service, `/v1/plans/${id}/result`);
  const { name } = await answer(service, `/v1/plans/${id}/scenario`);
  const ways = {
    touch: (page, node) => node.tap(),
    async keys(page, node) {
      await tabTo(page, node);
      await page.keyboard.press("Enter");
    },
  };
  for (const [means, press] of Object.entries(ways)) {
    const { page, complaints, close } = await openPage(browser, service, PHONE);
    await must(`a phone, by ${means}: the list, a plan, scrolled, chosen and read`, async () => {
      await page.goto(service.address);
      await press(page, page.getByRole("link", { name, exact: true }));
      await page.locator(".timelines .uplot").first().waitFor();
      check(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "the page is too wide");
      const before = await page.evaluate(() => scrollY);
      await page.locator(".timelines").scrollIntoViewIfNeeded();
      check(await page.evaluate(() => scrollY) > before, "it is not scrolled");
      await press(page, page.getByRole("button", { name: new RegExp(`^${plan.sequence[1]} `) }));
      await eventually(async () => {
        const shown = await page.locator(".moment").textContent();
        check(shown.startsWith(`${plan.passages[1].time_s.toFixed(1)} s`), shown);
      });
      const speeds = page.locator(".chart", { hasText: "Wheel speeds" }).locator(".key .value");
      const text = (await speeds.allTextContents()).join(" ");
      await press(page, page.getByRole("button", { name: "Play", exact: true }));
      await eventually(async () => check((await speeds.allTextContents()).join(" ") !== text, "the values stay"));
      const found = await findings(page);
      check(found.length === 0, found.join("\n"));
      check(complaints.length === 0, complaints.join("\n"));
      return text;
    });
    await close();
  }
}
