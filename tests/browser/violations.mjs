// A plan that the verification refuses: banner, moments, and marks of every kind of violation.

import { check, eventually, findings, fixture, openPage, picture, planned } from "./harness.mjs";

/** Two targets, and the same with less of everything than the plan for them uses. */
function tightened() {
  const scenario = fixture("two-targets");
  scenario.spacecraft.wheels[0].max_torque_nm = 0.008;
  scenario.spacecraft.wheels[1].max_speed_rad_s = 500;
  scenario.spacecraft.max_body_rate_rad_s = [0.01, 0.01, 0.01];
  scenario.keep_out[0].direction = [0, 0, 1];
  scenario.targets[1].dwell_s = 20;
  return scenario;
}

const posted = async (service, path, document) => (await fetch(`${service.address}${path}`, {
  method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(document),
})).json();

export async function violations({ browser, service, must }) {
  const id = await planned(service, fixture("two-targets"));
  const plan = await (await fetch(`${service.address}/v1/plans/${id}/result`)).json();
  const scenario = tightened();
  const { margins, ...verification } = await posted(service, "/v1/verify", { scenario, plan });
  const { page, complaints, close } = await openPage(browser, service);
  // The service gives out no such plan: the page is told of it in its place.
  await page.route(`**/v1/plans/${id}/result`, (route) => route.fulfill({ json: { ...plan, verification, margins } }));
  await page.route(`**/v1/plans/${id}/scenario`, (route) => route.fulfill({ json: scenario }));

  await must("every failure of the verification is in a banner above everything else", async () => {
    await page.goto(`${service.address}/#/plans/${id}`);
    await page.locator(".title .chip.bad", { hasText: "Optimal, but limits violated" }).waitFor();
    const banner = page.getByRole("region", { name: "Limits violated" });
    check(await page.locator(".result > *").first().evaluate((node) => node.classList.contains("alarm")), "the banner is not first");
    const texts = await banner.locator("li > span:last-child").allTextContents();
    check(JSON.stringify(texts) === JSON.stringify(verification.failures), texts.join("\n"));
    const kinds = new Set(await banner.locator("strong").allTextContents());
    for (const kind of ["Wheel torque", "Wheel speed", "Body rate", "Cone", "Target"]) check(kinds.has(kind), `${kind} is not among ${[...kinds].join()}`);
    await page.locator(".card .chip.bad", { hasText: "Not passed" }).waitFor();
    const found = await findings(page);
    check(found.length === 0, found.join("\n"));
    await picture(page, "violated-desktop-light");
    return [...kinds].join(", ");
  });
  await must("a failure leads to its moment, by keys alone", async () => {
    const [, time] = /at ([\d.]+) s/.exec(verification.failures.find((text) => text.startsWith("the speed of wheel 1")));
    await page.locator(".alarm li", { hasText: "the speed of wheel 1" }).getByRole("button").focus();
    await page.keyboard.press("Enter");
    return eventually(async () => {
      const shown = await page.locator(".moment").textContent();
      check(shown.startsWith(`${Number(time).toFixed(1)} s`), shown);
      return shown;
    });
  });
  await must("the times beyond a limit are marked, and in the table of phases", async () => {
    await page.locator(".bar.limit").first().waitFor();
    await page.locator("summary", { hasText: "Phases as a table" }).click();
    const phases = page.getByRole("region", { name: "Phases of the flight" });
    for (const name of ["speed of wheel 1 beyond its limit", "torque of wheel 0 beyond its limit", "body rate x beyond its limit"]) {
      await phases.getByText(name).first().waitFor();
    }
    const beyond = plan.trajectory.states.filter((state) => Math.abs(state.wheel_speed_rad_s[1]) > 500 * (1 + 1e-6)).map((state) => state.time_s);
    const begin = await phases.locator("tr", { hasText: "speed of wheel 1" }).first().locator("td").first().textContent();
    check(begin === beyond[0].toFixed(2), `${begin} s beside ${beyond[0]} s`);
  });
  await must("no error of the console beside a refused plan", () => check(complaints.length === 0, complaints.join("\n")));
  await close();
}
