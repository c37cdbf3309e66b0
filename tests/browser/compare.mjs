// Another order as a plan of its own, and two plans beside each other.

import { check, eventually, findings, fixture, openPage, planned } from "./harness.mjs";

export async function compare({ browser, service, must }) {
  const id = await planned(service, fixture("stars-and-sun"));
  const result = async (one) => (await fetch(`${service.address}/v1/plans/${one}/result`)).json();
  const plan = await result(id);
  const [alternative] = plan.alternatives;
  const { page, complaints, close } = await openPage(browser, service);
  let other;

  await must("another order is planned and compared, by keys alone", async () => {
    await page.goto(`${service.address}/#/plans/${id}`);
    await page.getByRole("button", { name: "Plan and compare order 1" }).focus();
    await page.keyboard.press("Enter");
    await page.getByRole("heading", { name: "Compare plans" }).waitFor();
    await page.getByRole("heading", { name: "Order and times" }).waitFor();
    other = await result(page.url().split("/").at(-1));
    check(other.sequence.join() === alternative.sequence.join(), other.sequence.join());
    const totals = await page.getByRole("region", { name: "Figures of both plans" }).locator("tr", { hasText: "Total time" }).locator("td").allTextContents();
    const difference = other.total_time_s - plan.total_time_s;
    check(totals.join() === [plan.total_time_s.toFixed(2), other.total_time_s.toFixed(2), `+${difference.toFixed(2)}`].join(), totals.join());
    return totals.join(" ");
  });
  await must("places and times of the targets are those of both plans", async () => {
    const rows = page.getByRole("region", { name: /^Places and arrivals/ }).locator("tbody tr");
    const cells = await rows.evaluateAll((all) => all.map((row) => [...row.cells].map((cell) => cell.textContent)));
    const expected = plan.passages.map(({ target, time_s: time }, index) => {
      const place = other.sequence.indexOf(target);
      const text = (value) => value.toFixed(2).replace("-", "−");
      const later = other.passages[place].time_s - time;
      const shown = text(later).replace("−0.00", "0.00");
      return [target, String(index + 1), text(time), String(place + 1), text(other.passages[place].time_s), later > 0.005 ? `+${shown}` : shown];
    });
    check(JSON.stringify(cells) === JSON.stringify(expected), JSON.stringify([cells, expected]));
    const bold = await page.locator("td strong").count();
    check(bold === plan.sequence.filter((target, index) => other.sequence[index] !== target).length, `${bold} bold places`);
  });
  await must("one moment moves both tracks", async () => {
    const dots = () => page.locator(".sphere .now").evaluateAll((all) => all.map((dot) => `${dot.getAttribute("cx")} ${dot.getAttribute("cy")}`));
    await eventually(async () => check((await dots()).length === 2, "two dots"));
    const before = await dots();
    await page.getByLabel("Moment").focus();
    await page.keyboard.press("PageUp");
    await eventually(async () => {
      const after = await dots();
      check(after.every((dot, index) => dot !== before[index]), "a dot has not moved");
    });
    await page.getByRole("button", { name: "Play" }).click();
    await page.locator('.playback[data-playing="yes"]').waitFor();
    await page.getByRole("button", { name: "Pause" }).click();
    const found = await findings(page);
    check(found.length === 0, found.join("\n"));
  });
  await must("a plan is chosen to be compared, and leads back", async () => {
    await page.goto(`${service.address}/#/plans/${id}`);
    await page.getByRole("link", { name: "Compare" }).click();
    await page.getByText("Choose two plans.").waitFor();
    const found = await findings(page);
    check(found.length === 0, found.join("\n"));
    await page.getByLabel("Second plan").selectOption(id);
    await page.getByText("Both plans have the same order.").waitFor();
    await page.getByRole("link", { name: "Stars with the Sun (second)" }).click();
    await page.locator(".timelines .uplot").first().waitFor();
  });
  await must("differences have a sign unless they are nothing", async () => {
    const folder = (await page.locator("script[type=module]").getAttribute("src")).replace("/app/main.js", "");
    const found = await page.evaluate(async (folder) => {
      const { signed } = await import(`${folder}/app/format.js`);
      return ["0.00", "0.10", "−0.10", "12 %", "–", "0.00 %"].map(signed);
    }, folder);
    check(found.join() === "0.00,+0.10,−0.10,+12 %,–,0.00 %", found.join());
  });
  await must("no error of the console while comparing", () => check(complaints.length === 0, complaints.join("\n")));
  await close();
}
