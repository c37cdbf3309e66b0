// The leg times between two hundred targets: a picture of which a cell is chosen.

import { readFileSync } from "node:fs";
import { check, eventually, findings, fixture, openPage, picture, planned } from "./harness.mjs";

function twoHundred() {
  const scenario = fixture("olivares-c");
  const turn = (index, step, range) => (((index * step) % 1) - 0.5) * range;
  scenario.name = "two-hundred-legs";
  scenario.targets = Array.from({ length: 200 }, (_, index) => ({
    id: `look-${index + 1}`,
    attitude: { roll_pitch_yaw_deg: [turn(index, 0.618, 50), turn(index, 0.414, 50), turn(index, 0.732, 360)] },
  }));
  scenario.options = { time_limit_s: 15 };
  return scenario;
}

export async function matrix({ browser, service, must }) {
  const scenario = twoHundred();
  const id = await planned(service, scenario);
  const plan = await (await fetch(`${service.address}/v1/plans/${id}/result`)).json();
  const { page, complaints, close } = await openPage(browser, service);
  const heat = page.locator("canvas.heat");
  const said = page.locator(".cell");
  const attitude = (name) => scenario.targets.find((target) => target.id === name).attitude;

  await must("proved bounds between 200 targets are a picture, of which keys choose a cell", async () => {
    await page.goto(`${service.address}/#/plans/${id}`);
    await heat.waitFor();
    await page.getByLabel("Times", { exact: true }).selectOption("certified");
    await eventually(async () => check(/ s$/.test(await said.textContent()), await said.textContent()));
    await heat.focus();
    for (const key of ["Shift+ArrowDown", "ArrowRight", "Shift+ArrowRight", "Shift+ArrowRight"]) await page.keyboard.press(key);
    const [from, to] = [plan.sequence[9], plan.sequence[21]];
    const answer = await fetch(`${service.address}/v1/legs/query`, {
      method: "POST", headers: { "Content-Type": "application/json" },
      body: JSON.stringify({ spacecraft: scenario.spacecraft, kind: "certified", mode: "compute", pairs: [{ from: attitude(from), to: attitude(to) }] }),
    });
    const bound = (await answer.json()).legs[0].certified_lower_bound_s;
    const wanted = `${from} → ${to}: ${bound.toFixed(2)} s`;
    await eventually(async () => check(await said.textContent() === wanted, `${await said.textContent()}, not ${wanted}`));
    return wanted;
  });
  await must("it is looked at closely around the chosen cell, and wholly again", async () => {
    const view = () => heat.getAttribute("data-view");
    const before = await heat.evaluate((canvas) => canvas.toDataURL());
    await page.keyboard.press("+");
    await page.keyboard.press("+");
    await page.keyboard.press("+");
    await page.keyboard.press("+");
    await eventually(async () => check((await view()).endsWith(" 16.00"), await view()));
    check(await heat.evaluate((canvas) => canvas.toDataURL()) !== before, "the picture is the same");
    await picture(page, "matrix-desktop-light");
    await page.getByRole("button", { name: "All of the matrix" }).click();
    await eventually(async () => check((await view()).endsWith(" 1.00"), await view()));
  });
  await must("the legs of the chosen row are a table", async () => {
    await page.locator("summary", { hasText: "Legs of the chosen row" }).click();
    const rows = page.getByRole("region", { name: `Legs from ${plan.sequence[9]}` }).locator("tbody tr");
    await eventually(async () => check(await rows.count() === plan.sequence.length, `${await rows.count()} rows`));
    const shown = await rows.filter({ has: page.getByText(plan.sequence[21], { exact: true }) }).locator("td").textContent();
    check((await said.textContent()).endsWith(`${shown} s`), shown);
    const found = await findings(page);
    check(found.length === 0, found.join("\n"));
  });
  await must("the matrix is saved as a picture", async () => {
    const sizes = [];
    for (const kind of ["SVG", "PNG"]) {
      const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: `Save leg times as ${kind}` }).click()]);
      const bytes = readFileSync(await download.path());
      const begins = kind === "SVG" ? "<?xml" : "\u0089PNG";
      check(bytes.toString("latin1").startsWith(begins), download.suggestedFilename());
      // The cells are pixels in it, their frames are lines.
      if (kind === "SVG") check(/<image [^>]*href="data:image\/png/.test(bytes.toString("utf8")), "no cells");
      sizes.push(`${download.suggestedFilename()} ${bytes.length}`);
    }
    return sizes.join(", ");
  });
  // What keeps the page busy is told and not judged: it depends on what else the machine does.
  await must("a pointer moves across it", async () => {
    await page.locator("summary", { hasText: "Legs of the chosen row" }).click();
    await page.evaluate(() => {
      window.tasks = [];
      new PerformanceObserver((list) => window.tasks.push(...list.getEntries().map((entry) => entry.duration))).observe({ entryTypes: ["longtask"] });
    });
    await heat.scrollIntoViewIfNeeded();
    const box = await heat.boundingBox();
    const first = await said.textContent();
    for (let step = 1; step <= 60; step += 1) await page.mouse.move(box.x + (step / 61) * box.width, box.y + (step / 90) * box.height);
    await eventually(async () => check(await said.textContent() !== first, "no other cell is chosen"));
    check(complaints.length === 0, complaints.join("\n"));
    return `longest task ${await page.evaluate(() => Math.round(Math.max(0, ...window.tasks)))} ms`;
  });
  await close();
}
