// What a planner does after the first plan: plans again, compares, plays and takes files, with a mouse, with
// keys only and on a phone; and long work, which is told of when nobody looks.

import { readFileSync } from "node:fs";
import { check, eventually, findings, fixture, openPage, picture, planned } from "./harness.mjs";

const PHONE = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };
/** Between the first event and the first plan in the database the result may not be there yet. */
const REFUSED = [/^console: Failed to load resource.* 409 /];

const answer = async (service, path) => (await fetch(`${service.address}${path}`)).json();
const moment = (page) => page.locator("#moment").inputValue().then(Number);

export async function planner(given) {
  const id = await planned(given.service, { ...fixture("two-targets"), name: "first-of-two" });
  for (const way of [byMouse, byKeys]) await again(given, id, way);
  await onPhone(given, id);
  await longWork(given);
  await searched(given);
}

/** Acts by pointing. */
const byMouse = {
  name: "a mouse",
  press: (page, node) => node.click(),
  write: (page, node, text) => node.fill(text),
  choose: (page, node, label) => node.selectOption({ label }),
};

/** The same acts with keys: whatever is used gets the focus by Tab. */
const byKeys = {
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
};

async function tabTo(page, node) {
  await node.waitFor();
  for (let presses = 0; presses < 400; presses += 1) {
    if (await node.evaluate((one) => one === document.activeElement)) return;
    await page.keyboard.press("Tab");
  }
  throw new Error(`Tab does not come to ${node}`);
}

async function again({ browser, service, must }, id, way) {
  const { page, complaints, close } = await openPage(browser, service, { expected: REFUSED });
  const button = (name) => page.getByRole("button", { name, exact: true });
  const link = (name) => page.getByRole("link", { name, exact: true });
  let second;
  await must(`${way.name}: a plan is edited without JSON and planned again`, async () => {
    await page.goto(`${service.address}/#/plans/${id}`);
    await page.locator(".timelines .uplot").first().waitFor();
    await way.press(page, link("Edit and plan again"));
    await page.getByText("No problems").waitFor();
    await way.write(page, page.getByLabel("Name", { exact: true }), `less torque, ${way.name}`);
    await way.write(page, page.getByLabel("Torque authority", { exact: true }), "0.8");
    await eventually(async () => check(JSON.parse(await page.locator("#scenario").inputValue()).options.torque_authority === 0.8, "it is not written"));
    await way.press(page, button("Plan"));
    await page.getByRole("heading", { name: "Timelines" }).waitFor();
    await page.locator(".chip.good").first().waitFor();
    second = page.url().split("/").at(-1);
    const [one, other] = await Promise.all([id, second].map((job) => answer(service, `/v1/plans/${job}/result`)));
    check(other.total_time_s > one.total_time_s + 1, `${one.total_time_s} s, then ${other.total_time_s} s`);
    return `${one.total_time_s.toFixed(1)} s, then ${other.total_time_s.toFixed(1)} s`;
  });
  await must(`${way.name}: it is compared with the first one, and both are played`, async () => {
    await way.press(page, link("Compare"));
    const field = page.getByLabel("Second plan");
    await field.locator("option").nth(1).waitFor({ state: "attached" });
    const labels = await field.locator("option").allTextContents();
    await way.choose(page, field, labels.find((text) => text.startsWith("first-of-two")));
    if (way === byKeys) await page.keyboard.press("Tab");
    await page.getByRole("heading", { name: "Order and times" }).waitFor();
    await eventually(async () => check(await moment(page) === 0, "it does not begin at the start"));
    await way.press(page, button("Play"));
    await eventually(async () => check(await moment(page) > 1, "nothing moves"));
    await way.press(page, button("Pause"));
    const found = await findings(page);
    check(found.length === 0, found.join("\n"));
    return `until ${(await moment(page)).toFixed(1)} s`;
  });
  await must(`${way.name}: the plan is taken as a table and as a picture`, async () => {
    await page.goto(`${service.address}/#/plans/${second}`);
    await page.locator(".timelines .uplot").first().waitFor();
    const files = [];
    for (const node of [page.getByRole("link", { name: /^CSV/ }), button("Save timelines as PNG")]) {
      const [download] = await Promise.all([page.waitForEvent("download"), way.press(page, node)]);
      files.push([download.suggestedFilename(), readFileSync(await download.path())]);
    }
    check(files[0][1].toString("utf8").startsWith("time_s"), files[0][0]);
    check(files[1][1].subarray(1, 4).toString() === "PNG", files[1][0]);
    check(complaints.length === 0, complaints.join("\n"));
    return files.map(([name, bytes]) => `${name} ${bytes.length}`).join(", ");
  });
  await close();
}

async function onPhone({ browser, service, must }, id) {
  const { page, complaints, close } = await openPage(browser, service, PHONE);
  await must("a phone: the list, a plan, scrolled, tapped and read", async () => {
    const plan = await answer(service, `/v1/plans/${id}/result`);
    await page.goto(service.address);
    await page.getByRole("link", { name: "first-of-two", exact: true }).tap();
    await page.locator(".timelines .uplot").first().waitFor();
    check(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "the page is too wide");
    const before = await page.evaluate(() => scrollY);
    await page.locator(".timelines").scrollIntoViewIfNeeded();
    check(await page.evaluate(() => scrollY) > before, "it is not scrolled");
    await page.getByRole("button", { name: new RegExp(`^${plan.sequence[1]} `) }).tap();
    await eventually(async () => {
      const shown = await page.locator(".moment").textContent();
      check(shown.startsWith(`${plan.passages[1].time_s.toFixed(1)} s`), shown);
    });
    const speeds = page.locator(".chart", { hasText: "Wheel speeds" }).locator(".key .value");
    const text = (await speeds.allTextContents()).join(" ");
    await page.getByRole("button", { name: "Play", exact: true }).tap();
    await eventually(async () => check((await speeds.allTextContents()).join(" ") !== text, "the values stay"));
    const found = await findings(page);
    check(found.length === 0, found.join("\n"));
    check(complaints.length === 0, complaints.join("\n"));
    return text;
  });
  await close();
}

/** Sixty targets, with which a search goes on to its limit. */
function long() {
  const scenario = fixture("olivares-c");
  const turn = (index, step, range) => (((index * step) % 1) - 0.5) * range;
  scenario.name = "long-work";
  scenario.targets = Array.from({ length: 60 }, (_, index) => ({
    id: `look-${index + 1}`, zero_rate_axes: ["z"],
    attitude: { roll_pitch_yaw_deg: [turn(index, 0.618, 50), turn(index, 0.414, 50), turn(index, 0.732, 360)] },
  }));
  scenario.options = { time_limit_s: 300 };
  return scenario;
}

/** In place of the browser's notices: what would be shown, and how often permission was asked for. */
function watchNotices() {
  globalThis.notices = [];
  globalThis.asked = 0;
  globalThis.isHidden = false;
  Object.defineProperty(Document.prototype, "hidden", { get: () => globalThis.isHidden });
  globalThis.Notification = class extends EventTarget {
    static permission = "default";

    static requestPermission() {
      globalThis.asked += 1;
      this.permission = "granted";
      return Promise.resolve("granted");
    }

    constructor(title, { body }) {
      super();
      globalThis.notices.push(`${title} ${body}`);
    }
  };
}

async function longWork({ browser, service, must }) {
  const { page, complaints, close } = await openPage(browser, service, { expected: REFUSED });
  await page.addInitScript(watchNotices);
  const answered = await fetch(`${service.address}/v1/plans`, {
    method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(long()),
  });
  const { id } = await answered.json();
  await must("a running search tells the time that is left of its limit", async () => {
    await page.goto(`${service.address}/#/plans/${id}`);
    await page.locator(".chip.goes").waitFor();
    const figure = page.locator(".facts > div", { has: page.getByText("Time left", { exact: true }) });
    const left = async () => Number.parseFloat(await figure.locator(".figure").textContent());
    await figure.waitFor();
    const first = await left();
    check(first > 0 && first <= 300 && (await figure.locator(".note").textContent()) === "of the limit of 300 s", `${first} s`);
    await eventually(async () => check(await left() < first - 1, "it does not become less"));
    const elapsed = Number.parseFloat(await page.locator(".facts > div", { has: page.getByText("Elapsed", { exact: true }) }).locator(".figure").textContent());
    check(Math.abs(elapsed + await left() - 300) < 3, `${elapsed} s and ${await left()} s`);
    return `${await left()} s`;
  });
  await must("permission for notices is asked for at a press, and the end is told of in a hidden tab", async () => {
    check(await page.evaluate(() => globalThis.asked) === 0, "asked before anybody wanted it");
    const found = await findings(page);
    check(found.length === 0, found.join("\n"));
    await picture(page, "running-desktop-light");
    const box = page.getByLabel("Notify me when it is done and this tab is hidden");
    await box.focus();
    await page.keyboard.press(" ");
    await eventually(async () => check(await box.isChecked() && await page.evaluate(() => globalThis.asked) === 1, "not asked"));
    await page.locator(".order li").first().waitFor();
    await page.evaluate(() => { globalThis.isHidden = true; });
    await fetch(`${service.address}/v1/plans/${id}/stop`, { method: "POST" });
    const told = await eventually(async () => {
      const notices = await page.evaluate(() => globalThis.notices);
      check(notices.length === 1, `${notices.length} notices`);
      return notices[0];
    });
    const { incumbent_s: total } = await answer(service, `/v1/plans/${id}`);
    check(told === `long-work: Best so far A plan of ${total.toFixed(2)} s.`, told);
    check(await box.isHidden(), "the choice is still offered");
    check(complaints.length === 0, complaints.join("\n"));
    return told;
  });
  await close();
}

async function searched({ browser, service, must }) {
  const { page, complaints, close } = await openPage(browser, service);
  await must("plans are found by a part of their name, with their dates", async () => {
    await page.goto(`${service.address}/#/`);
    await page.locator("tbody tr").first().waitFor();
    await page.getByLabel("Search").focus();
    await page.keyboard.type("OF-TWO");
    await eventually(async () => {
      const names = await page.locator("tbody th a").allTextContents();
      check(names.join() === "first-of-two", names.join());
    });
    const date = await page.locator("tbody td time").first().textContent();
    check(/^\d{1,2} \w{3} \d{4}, \d\d:\d\d:\d\d$/.test(date), date);
    await page.getByLabel("Search").fill("nothing is called so");
    await page.getByText("No plan is like this.").waitFor();
    const found = await findings(page);
    check(found.length === 0, found.join("\n"));
    check(complaints.length === 0, complaints.join("\n"));
    return date;
  });
  await close();
}
