// Windows and values: written in the table of targets, and what a plan shows of them.

import { check, eventually, findings, fixture, openPage, picture, planned } from "./harness.mjs";

const EPOCH = "2026-01-01T00:00:00Z";
const refused = [/^console: Failed to load resource.* 4(04|22|00) /];
const TABLE = "id,roll,pitch,yaw,dwell,windows,value\n"
  + "a,15,0,10,10,2026-01-01T00:03:20Z..2026-01-01T00:04:00Z,\nb,25,0,50,5,,2\nc,0,0,90,0,0..3 500/600,1\n";

/** Three targets at rest: "a" waits for its window, "c" cannot be reached in time. */
function schedule() {
  const { targets: _, ...scenario } = fixture("two-targets");
  const look = (id, angles, more) => ({ id, attitude: { roll_pitch_yaw_deg: angles }, ...more });
  return {
    ...scenario, name: "schedule", epoch: EPOCH, latest_end_s: 400,
    targets: [
      look("a", [15, 0, 10], { dwell_s: 10, windows: [{ from: "2026-01-01T00:03:20Z", to: "2026-01-01T00:04:00Z" }] }),
      look("b", [25, 0, 50], { dwell_s: 5, value: 2 }),
      look("c", [0, 0, 90], { value: 1, windows: [{ from_s: 0, to_s: 3 }] }),
    ],
  };
}

export async function clock(given) {
  await written(given);
  await shown(given);
  await listed(given);
}

async function written({ browser, service, must }) {
  const { page, complaints, close } = await openPage(browser, service, { expected: refused });
  const document = async () => JSON.parse(await page.locator("#scenario").inputValue());
  const cell = (name) => page.getByLabel(name, { exact: true });
  await must("windows and values come with a table of targets", async () => {
    const { targets: _, ...bare } = fixture("two-targets");
    await page.goto(`${service.address}/#/new`);
    await page.locator("#scenario").fill(JSON.stringify({ ...bare, epoch: EPOCH, targets: [] }));
    await page.getByRole("button", { name: "Take targets from a table" }).click();
    const dialog = page.getByRole("dialog");
    await dialog.getByLabel("Or its rows, pasted").fill(TABLE);
    await dialog.getByText("3 rows, every cell can be read.").waitFor();
    await dialog.getByRole("button", { name: "Add 3 targets" }).click();
    const { targets } = await document();
    check(JSON.stringify(targets[0].windows) === '[{"from":"2026-01-01T00:03:20Z","to":"2026-01-01T00:04:00Z"}]', JSON.stringify(targets[0]));
    check(JSON.stringify(targets[2].windows) === '[{"from_s":0,"to_s":3},{"from_s":500,"to_s":600}]' && targets[1].value === 2, JSON.stringify(targets));
    check(await cell("Windows of c").inputValue() === "0..3 500..600", await cell("Windows of c").inputValue());
  });
  await must("cells of windows and the latest end are written, and told what is wrong", async () => {
    await cell("Latest end s").fill("400");
    await cell("Windows of b").fill("30..20");
    await cell("Windows of b").and(page.locator(".wrong")).waitFor();
    await cell("Windows of b").fill("20..390");
    await cell("Windows of b").and(page.locator(":not(.wrong)")).waitFor();
    const { latest_end_s: latest, targets } = await document();
    check(latest === 400 && JSON.stringify(targets[1].windows) === '[{"from_s":20,"to_s":390}]', JSON.stringify(targets[1]));
    await picture(page, "clock-desk");
    const found = await findings(page);
    check(found.length === 0, found.join("\n"));
    check(complaints.length === 0, complaints.join("\n"));
  });
  await close();
}

async function shown({ browser, service, must }) {
  const id = await planned(service, schedule());
  const plan = await (await fetch(`${service.address}/v1/plans/${id}/result`)).json();
  const { page, complaints, close } = await openPage(browser, service);
  await page.goto(`${service.address}/#/plans/${id}`);
  await page.locator(".timelines .uplot").first().waitFor();
  await must("windows stand behind the phases, and waits are phases", async () => {
    check(await page.locator(".lane-window").count() === 1, `${await page.locator(".lane-window").count()} windows`);
    check(await page.locator(".bar.wait").count() === plan.waits.length && plan.waits.length > 0, `${plan.waits.length} waits`);
    const [window, visit] = await Promise.all([".lane-window", ".bar.dwell"].map((part) => page.locator(part).first().boundingBox()));
    const dwell = plan.passages.findIndex(({ target }) => target === "a");
    const bars = await page.locator(".bar.dwell").all();
    const own = await bars[dwell].boundingBox();
    check(own.x >= window.x - 2 && own.x + own.width <= window.x + window.width + 2, `${JSON.stringify([window, visit, own])}`);
    return `${plan.waits.length} waits`;
  });
  await must("value, bound, and what is left out with the reason", async () => {
    const facts = await page.locator(".facts").first().textContent();
    check(facts.includes("Value2no plan has more"), facts);
    const row = page.getByRole("region", { name: "Targets that are left out" }).locator("tbody tr");
    check(await row.count() === 1 && (await row.textContent()).startsWith("c1no window can be reached"), await row.textContent());
  });
  await must("windows and visits have a row for each target, in seconds and by the clock", async () => {
    const rows = page.getByRole("region", { name: "Windows and visits of the targets" }).locator("tbody tr");
    check(await rows.count() === 3, `${await rows.count()} rows`);
    const own = rows.filter({ hasText: /^a/ });
    check((await own.textContent()).includes("200.0–240.0"), await own.textContent());
    await page.getByLabel("Time", { exact: true }).selectOption("clock");
    await eventually(async () => check((await own.textContent()).includes("00:03:20–00:04:00"), await own.textContent()));
  });
  await must("nothing that axe-core finds, and a silent console", async () => {
    await picture(page, "clock-plan");
    const found = await findings(page);
    check(found.length === 0, found.join("\n"));
    check(complaints.length === 0, complaints.join("\n"));
  });
  await must("a picture of windows and visits is saved", async () => {
    const saved = page.waitForEvent("download");
    await page.getByRole("region", { name: "Windows and visits", exact: true }).getByRole("button", { name: "Save windows as SVG" }).click();
    const stream = await (await saved).createReadStream();
    let text = "";
    for await (const part of stream) text += part;
    check(text.includes("<svg") && text.includes(">left out<"), text.slice(0, 200));
  });
  await close();
  await onPhone({ browser, service, must }, id);
}

/** The plan on a phone, in the dark. */
async function onPhone({ browser, service, must }, id) {
  const { page, close } = await openPage(browser, service, { viewport: { width: 390, height: 844 }, hasTouch: true, colorScheme: "dark" });
  await must("a phone in the dark has all of it", async () => {
    await page.goto(`${service.address}/#/plans/${id}`);
    await page.locator(".timelines .uplot").first().waitFor();
    await page.getByRole("heading", { name: "Windows and visits" }).scrollIntoViewIfNeeded();
    await picture(page, "clock-phone-dark");
    const found = await findings(page);
    check(found.length === 0, found.join("\n"));
    const wide = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
    check(wide <= 0, `${wide} px beyond the edge`);
  });
  await close();
}

/** What the service tells of a job with values. */
async function listed({ service, must }) {
  await must("jobs and events have value and bound", async () => {
    const id = await planned(service, schedule());
    const job = await (await fetch(`${service.address}/v1/plans/${id}`)).json();
    check(job.value === 2 && job.value_bound === 2, JSON.stringify(job));
    const events = await (await fetch(`${service.address}/v1/plans/${id}/events`)).text();
    check(/"value":2(\.0)?[,}]/.test(events), events.slice(-300));
  });
}
