// Long work, which is told of when nobody looks, and plans that are looked for.

import { check, eventually, findings, fixture, openPage, picture, planned } from "./harness.mjs";

/** Between the first event and the first plan in the database the result may not be there yet. */
const REFUSED = [/^console: Failed to load resource.* 409 /];

const answer = async (service, path) => (await fetch(`${service.address}${path}`)).json();

export async function longWork(given) {
  await planned(given.service, { ...fixture("two-targets"), name: "first-of-two" });
  await running(given);
  await searched(given);
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

async function running({ browser, service, must }) {
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
