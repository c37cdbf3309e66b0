// What a planner does on the page, from the first scenario to the files.

import { readFileSync } from "node:fs";
import { check, eventually, fixture, openPage, startService } from "./harness.mjs";

/** Duration of the best plan for experiment A, s. */
const BEST_A = 467.71;
/** The loading of an answer that the service refuses, which the browser itself reports. */
const refused = (status) => [new RegExp(`^console: Failed to load resource.* ${status} `)];

export async function journeys(given) {
  await fromExampleToFiles(given);
  await invalidScenario(given);
  await stoppedSearch(given);
  await withKeys(given);
}

async function fromExampleToFiles({ browser, service, must }) {
  const { page, complaints, close } = await openPage(browser, service);
  let plan;

  await must("experiment A is submitted on the page and finishes", async () => {
    await page.goto(service.address);
    await page.getByText("There is no plan yet").waitFor();
    await page.getByRole("link", { name: "New plan" }).first().click();
    await page.getByRole("button", { name: /Experiment A/ }).click();
    await page.waitForFunction(() => document.querySelector("#scenario").value.includes("olivares-staffetti-a"));
    await page.getByRole("button", { name: "Check" }).click();
    await page.getByText("Valid", { exact: true }).waitFor();
    await page.getByRole("button", { name: "Plan", exact: true }).click();
    await page.locator(".chip.good", { hasText: "Optimal" }).first().waitFor();
    await page.getByRole("heading", { name: "Timelines" }).waitFor();
    const id = page.url().split("/").at(-1);
    plan = await (await fetch(`${service.address}/v1/plans/${id}/result`)).json();
    const total = Number.parseFloat(await page.locator(".facts .figure").first().textContent());
    check(Math.abs(total - BEST_A) < 0.01 * BEST_A / 10, `total ${total}`);
    return `${total} s`;
  });
  await must("the order is that of the plan", async () => {
    const order = await page.locator(".order .stop-name").allTextContents();
    check(order.join() === plan.sequence.join(), order.join());
    const legs = await page.locator("section", { has: page.getByRole("heading", { name: "Legs", exact: true }) })
      .locator("tbody th").allTextContents();
    check(legs.length === plan.legs.length && legs[0] === `start → ${order[0]}`, legs.join());
    await eventually(async () => check(await page.locator(".sphere .stop").count() === order.length, "numbers on the sphere"));
    return order.join(" ");
  });
  await must("the sphere turns by dragging and by keys", async () => {
    const sphere = page.locator(".sphere");
    const pose = () => sphere.getAttribute("data-pose");
    const place = () => sphere.locator(".stop").first().getAttribute("transform");
    await page.locator(".sphere .stop").first().waitFor();
    const before = [await pose(), await place()];
    await sphere.scrollIntoViewIfNeeded();
    const box = await sphere.boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width / 2 + 90, box.y + box.height / 2 - 60, { steps: 6 });
    await page.mouse.up();
    await page.waitForFunction((old) => document.querySelector(".sphere").dataset.pose !== old, before[0]);
    const dragged = await pose();
    await eventually(async () => check(await place() !== before[1], "the targets have not moved"));
    await sphere.focus();
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("+");
    await page.waitForFunction(() => document.querySelector(".sphere").dataset.pose.endsWith(" 1.25"));
    const turned = await pose();
    await page.keyboard.press("0");
    await page.waitForFunction((old) => document.querySelector(".sphere").dataset.pose === old, before[0]);
    return `${before[0]}, dragged ${dragged}, keys ${turned}`;
  });
  await must("another axis has another trace", async () => {
    const trace = () => page.locator(".sphere .trace.front").getAttribute("d");
    const before = await trace();
    await page.getByLabel("Axis", { exact: true }).selectOption({ label: "+X body" });
    await page.waitForFunction((old) => document.querySelector(".sphere .trace.front").getAttribute("d") !== old, before);
  });
  await must("all plots share one moment", async () => {
    const plot = page.locator(".plot .u-over").nth(1);
    await plot.scrollIntoViewIfNeeded();
    const box = await plot.boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.waitForFunction(() => !document.querySelector(".moment").textContent.startsWith("0.0 s"));
    const slider = page.getByLabel("Moment");
    const text = await eventually(async () => {
      const shown = await page.locator(".moment").textContent();
      const time = Number.parseFloat(shown);
      check(Math.abs(time - plan.total_time_s / 2) < 0.02 * plan.total_time_s, shown);
      check(Math.abs(Number(await slider.inputValue()) - time) < 1, "the slider follows");
      return shown;
    });
    await page.mouse.move(5, 5);
    const shown = await page.locator(".sphere .now").evaluate((dot) => `${dot.getAttribute("cx")} ${dot.getAttribute("cy")}`);
    await slider.focus();
    await page.keyboard.press("End");
    const last = plan.trajectory.states.at(-1).wheel_speed_rad_s[0].toFixed(1);
    await eventually(async () => {
      const values = await page.locator(".chart .key .value").allTextContents();
      check(values.some((value) => Math.abs(Number(value.replace("−", "-")) - Number(last)) < 0.06), values.join());
    });
    await page.waitForFunction((old) => {
      const dot = document.querySelector(".sphere .now");
      return `${dot.getAttribute("cx")} ${dot.getAttribute("cy")}` !== old;
    }, shown);
    return text;
  });
  await must("a target leads to the moment of its arrival", async () => {
    await page.getByRole("button", { name: new RegExp(`^${plan.sequence[2]} `) }).click();
    return eventually(async () => {
      const text = await page.locator(".moment").textContent();
      check(text.startsWith(`${plan.passages[2].time_s.toFixed(1)} s`), text);
      check(await page.locator(".sphere .stop.reached").count() === 3, "three targets are reached");
      return text;
    });
  });
  await must("a part of the flight is looked at closely, in all plots", async () => {
    const bars = () => page.locator(".bar.slew:visible").count();
    const before = await bars();
    await page.getByRole("button", { name: "Show a shorter time" }).click();
    await page.getByRole("button", { name: "Show a shorter time" }).click();
    await page.waitForFunction((old) => document.querySelectorAll(".bar.slew:not([hidden])").length < old, before);
    const seen = await bars();
    const marker = await page.locator(".lane-marker").evaluate((line) => line.getBoundingClientRect().left);
    await page.waitForFunction((place) => [...document.querySelectorAll(".timelines .u-cursor-x")]
      .every((line) => Math.abs(line.getBoundingClientRect().right - place) < 3), marker);
    await page.getByRole("button", { name: "All of the flight" }).click();
    await page.waitForFunction((old) => document.querySelectorAll(".bar.slew:not([hidden])").length === old, before);
    return `${before} slews, then ${seen}`;
  });
  await must("tables have what the plots show", async () => {
    for (const name of ["Directions", "Phases", "Samples", "Progress"]) {
      await page.locator("summary", { hasText: `${name} as a table` }).click();
    }
    const samples = page.getByRole("region", { name: "Samples of the trajectory" }).locator("tbody tr");
    await eventually(async () => check(await samples.count() === plan.trajectory.states.length, `${await samples.count()} samples`));
    await page.getByRole("region", { name: "Progress of the search" }).locator("tbody tr").first().waitFor();
    return `${await samples.count()} samples`;
  });
  await must("missing legs of the matrix can be computed", async () => {
    await page.getByRole("button", { name: "Compute missing" }).click();
    await page.waitForFunction(() => !document.querySelector(".matrix .missing"));
    const cells = await page.locator(".matrix td.number").allTextContents();
    check(cells.length === 42, `${cells.length} cells`);
  });
  await must("every form can be downloaded", async () => {
    const begins = { json: "{", csv: "time_s,q_x", "aem-kvn": "CCSDS_AEM_VERS", "aem-xml": "<?xml" };
    const sizes = [];
    for (const link of await page.locator("a.download").all()) {
      const [download] = await Promise.all([page.waitForEvent("download"), link.click()]);
      check(await download.failure() === null, `${await link.textContent()}: ${await download.failure()}`);
      const name = download.suggestedFilename();
      const text = readFileSync(await download.path(), "utf8");
      const begin = begins[new URLSearchParams((await link.getAttribute("href")).split("?")[1]).get("format")];
      check(text.length > 100 && (!begin || text.startsWith(begin)), `${name}: ${text.slice(0, 60)}`);
      sizes.push(`${name} ${text.length}`);
    }
    check(sizes.length >= 3, sizes.join());
    return sizes.join(", ");
  });
  await must("the plan is in the list", async () => {
    await page.getByRole("link", { name: "Plans" }).click();
    await page.getByRole("link", { name: "olivares-staffetti-a" }).waitFor();
    await page.getByLabel("State").selectOption("running");
    await page.getByText("No plan is like this").waitFor();
  });
  await must("no error of the console and no other host on the way", () => check(complaints.length === 0, complaints.join("\n")));
  await close();
}

async function invalidScenario({ browser, service, must }) {
  const { page, complaints, close } = await openPage(browser, service, { expected: refused(422) });
  await must("problems of a dropped scenario are shown with their places", async () => {
    await page.goto(`${service.address}/#/new`);
    const scenario = fixture("olivares-a");
    scenario.targets[2].id = "a";
    scenario.spacecraft.wheels[1].max_torque_nm = -1;
    const file = await page.evaluateHandle((text) => {
      const carried = new DataTransfer();
      carried.items.add(new File([text], "scenario.json", { type: "application/json" }));
      return carried;
    }, JSON.stringify(scenario, null, 2));
    await page.dispatchEvent(".drop", "drop", { dataTransfer: file });
    await page.waitForFunction(() => document.querySelector("#scenario").value.length > 0);
    await page.getByRole("button", { name: "Plan", exact: true }).click();
    const places = page.locator(".failure .pointer");
    await places.first().waitFor();
    const pointers = await places.allTextContents();
    check(pointers.includes("/targets/2/id") && pointers.includes("/spacecraft/wheels/1/max_torque_nm"), pointers.join());
    await page.getByRole("button", { name: "/spacecraft/wheels/1/max_torque_nm" }).click();
    await eventually(async () => {
      const chosen = await page.locator("#scenario").evaluate((field) => field.value.slice(field.selectionStart, field.selectionEnd));
      check(chosen === "-1", `selected ${chosen}`);
    });
    check(complaints.length === 0, complaints.join("\n"));
    return pointers.join(" ");
  });
  await close();
}

/** Sixty targets, with which a search goes on until it is stopped. */
function long() {
  const scenario = fixture("olivares-c");
  const turn = (index, step, range) => (((index * step) % 1) - 0.5) * range;
  scenario.name = "sixty-looks";
  scenario.targets = Array.from({ length: 60 }, (_, index) => ({
    id: `look-${index + 1}`,
    attitude: { roll_pitch_yaw_deg: [turn(index, 0.618, 50), turn(index, 0.414, 50), turn(index, 0.732, 360)] },
    zero_rate_axes: ["z"],
  }));
  scenario.options = { time_limit_s: null };
  return scenario;
}

async function stoppedSearch({ browser, service, must }) {
  // Between the first event and the first plan in the database the result may not be there yet.
  const { page, complaints, close } = await openPage(browser, service, { expected: refused(409) });
  await must("a running search shows its progress, and stops with the best so far", async () => {
    await page.goto(`${service.address}/#/new`);
    await page.locator("#scenario").fill(JSON.stringify(long()));
    await page.getByRole("button", { name: "Plan", exact: true }).click();
    await page.locator(".chip.goes").waitFor();
    await page.locator(".search .uplot").waitFor();
    await page.locator(".order li").first().waitFor();
    const figure = page.locator(".facts .figure").nth(2);
    await figure.filter({ hasText: "%" }).waitFor();
    const gap = await figure.textContent();
    await page.getByRole("button", { name: "Stop with best so far" }).click();
    await page.locator(".chip.good", { hasText: "Best so far" }).waitFor();
    await page.locator(".cards .search").waitFor();
    await eventually(async () => check(await page.locator(".order li").count() === 60, "sixty stops"));
    return `gap ${gap} when it was stopped`;
  });
  await must("a job is cancelled, and deleted", async () => {
    await page.goto(`${service.address}/#/new`);
    await page.locator("#scenario").fill(JSON.stringify(long()));
    await page.getByRole("button", { name: "Plan", exact: true }).click();
    await page.getByRole("button", { name: "Cancel" }).click();
    await page.locator(".chip", { hasText: "Cancelled" }).waitFor();
    await page.getByText("There is no plan", { exact: true }).waitFor();
    await page.getByRole("button", { name: "Delete" }).click();
    await page.getByRole("dialog").getByRole("button", { name: "Delete" }).click();
    await page.getByRole("heading", { name: "Plans" }).waitFor();
  });
  await must("no other error of the console on this way", () => check(complaints.length === 0, complaints.join("\n")));
  await close();
}

async function withKeys({ browser, must }) {
  const service = await startService({ withKey: true });
  const { page, complaints, close } = await openPage(browser, service, { expected: refused(401) });
  await must("a service with keys is used with a key, which also opens downloads", async () => {
    await page.goto(service.address);
    await page.getByRole("dialog").getByLabel("Key").fill("wrong");
    await page.getByRole("button", { name: "Use key" }).click();
    await page.getByText("did not accept").waitFor();
    await page.getByRole("dialog").getByLabel("Key").fill(service.key);
    await page.keyboard.press("Enter");
    await page.getByText("There is no plan yet").waitFor();
    await page.goto(`${service.address}/#/new?example=two-targets`);
    await page.waitForFunction(() => document.querySelector("#scenario").value.length > 0);
    await page.getByRole("button", { name: "Plan", exact: true }).click();
    await page.getByRole("heading", { name: "Downloads" }).waitFor();
    await page.locator(".matrix").waitFor();
    const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("link", { name: /^CSV/ }).click()]);
    check(readFileSync(await download.path(), "utf8").startsWith("time_s"), "the file");
    check(complaints.length === 0, complaints.join("\n"));
  });
  await close();
  await service.stop();
}
