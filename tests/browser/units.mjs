// Units that the reader chooses, and the time of day on the axes where a scenario has an epoch.

import { check, eventually, findings, fixture, openPage, planned } from "./harness.mjs";

const EPOCH = "2026-11-24T23:58:30";

export async function units(given) {
  await kept(given);
  await withoutEpoch(given);
}

const numbers = (texts) => texts.map((text) => Number(text.replace("−", "-")));
const values = async (page, title) => numbers(await page.locator(".chart", { hasText: title }).locator(".key .value").allTextContents());

async function kept({ browser, service, must }) {
  const id = await planned(service, { ...fixture("two-targets"), epoch: EPOCH });
  const plan = await (await fetch(`${service.address}/v1/plans/${id}/result`)).json();
  const { page, complaints, close } = await openPage(browser, service);
  const open = async () => {
    await page.goto("about:blank");
    await page.goto(`${service.address}/#/plans/${id}`);
    await page.locator(".timelines .uplot").first().waitFor();
  };
  await open();
  const { body_rate_rad_s: rates, wheel_speed_rad_s: speeds } = plan.trajectory.states.at(-1);
  const last = async () => {
    await page.getByLabel("Moment").focus();
    await page.keyboard.press("End");
  };

  await must("rates and wheel speeds are shown in the unit that is chosen by keys", async () => {
    await page.getByLabel("Rates", { exact: true }).focus();
    await page.keyboard.type("rad");
    await page.getByLabel("Wheel speeds", { exact: true }).focus();
    await page.keyboard.type("rpm");
    await last();
    return eventually(async () => {
      const [rate, speed] = [await values(page, "Body rates rad/s"), await values(page, "Wheel speeds rpm")];
      check(rate.every((value, axis) => Math.abs(value - rates[axis]) < 1e-5), rate.join());
      check(speed.every((value, wheel) => Math.abs(value - (speeds[wheel] * 30) / Math.PI) < 0.51), speed.join());
      check(await page.locator(".timelines .uplot").count() === 4, `${await page.locator(".timelines .uplot").count()} plots`);
      return `${speed.join(" ")} rpm`;
    });
  });
  await must("moments, arrivals and the axis have the time of day, across midnight", async () => {
    await page.getByLabel("Time", { exact: true }).selectOption("clock");
    const at = new Date(Date.parse(`${EPOCH}Z`) + Math.round(1000 * plan.total_time_s)).toISOString();
    await last();
    await eventually(async () => {
      const text = await page.locator(".moment").textContent();
      check(text.includes(`${at.slice(0, 10)} ${at.slice(11, 21)} UTC`), `${text}, not ${at}`);
    });
    const arrival = new Date(Date.parse(`${EPOCH}Z`) + Math.round(1000 * plan.passages[0].time_s)).toISOString().slice(11, 21);
    const shown = await page.locator(".order .stop-time").first().textContent();
    check(shown === arrival, `${shown}, not ${arrival}`);
    await page.locator("summary", { hasText: "Samples as a table" }).click();
    // The table is made when it is opened; reading texts does not wait for it.
    const row = page.getByRole("region", { name: "Samples of the trajectory" }).locator("tbody tr").first();
    await row.waitFor();
    const cells = await row.locator("td").allTextContents();
    check(cells[1] === "23:58:30.000", cells.join());
    return `${shown} at ${plan.passages[0].target}`;
  });
  await must("marks of the clock stand at full times of day", async () => {
    const folder = (await page.locator("script[type=module]").getAttribute("src")).replace("/app/main.js", "");
    const found = await page.evaluate(async (folder) => {
      const { clockAxis } = await import(`${folder}/app/plots/chart.js`);
      const { clockOf } = await import(`${folder}/app/units.js`);
      const axis = clockAxis(clockOf({ epoch: "2026-11-24T23:58:30" }));
      const splits = axis.splits(null, 0, 0, 200, 60);
      return [splits, axis.values(null, splits, 0, 0, 60), axis.values(null, [30.5], 0, 0, 0.5)];
    }, folder);
    const expected = [[30, 90, 150], ["23:59", "00:00", "00:01"], ["23:59:00.5"]];
    check(JSON.stringify(found) === JSON.stringify(expected), JSON.stringify(found));
  });
  await must("what is looked at closely stays so in another unit", async () => {
    await page.getByRole("button", { name: "Show a shorter time" }).click();
    const hidden = () => page.locator(".bar.slew[hidden]").count();
    await eventually(async () => check(await hidden() > 0, "nothing is out of sight"));
    await page.getByLabel("Rates", { exact: true }).selectOption("deg/s");
    await page.locator(".chart", { hasText: "Body rates deg/s" }).locator(".uplot").waitFor();
    await eventually(async () => check(await hidden() > 0, "all is in sight again"));
  });
  await must("the choice is kept, and axe-core finds nothing", async () => {
    await open();
    await page.locator(".chart", { hasText: "Wheel speeds rpm" }).waitFor();
    check(await page.getByLabel("Time", { exact: true }).inputValue() === "clock", "the time of day is forgotten");
    const found = await findings(page);
    check(found.length === 0, found.join("\n"));
    check(complaints.length === 0, complaints.join("\n"));
  });
  await close();
}

async function withoutEpoch({ browser, service, must }) {
  const id = await planned(service, fixture("olivares-a"));
  const { page, close } = await openPage(browser, service);
  await must("without an epoch there is no time of day, whatever was kept", async () => {
    await page.addInitScript(() => localStorage.setItem("slewplan-units", '{"time": "clock", "speed": "furlongs"}'));
    await page.goto(`${service.address}/#/plans/${id}`);
    await page.locator(".chart", { hasText: "Wheel speeds rad/s" }).waitFor();
    check(await page.getByLabel("Time", { exact: true }).count() === 0, "the time can be chosen");
    check((await page.locator(".order .stop-time").first().textContent()).endsWith(" s"), "seconds");
  });
  await close();
}
