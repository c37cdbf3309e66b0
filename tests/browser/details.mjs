// What a first user stumbles over: plans that are not quite good, syntax errors, fingers, narrow screens.

import { check, eventually, fixture, openPage, planned, findings } from "./harness.mjs";

const PHONE = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };
/** The loading of an answer that the service refuses, which the browser itself reports. */
const refused = (status) => [new RegExp(`^console: Failed to load resource.* ${status} `)];

export async function details(given) {
  await violatedKeepOut(given);
  await infeasible(given);
  await cancelled(given);
  await syntaxError(given);
  await unitsAndColumns(given);
  await fingers(given);
  await narrow(given);
  await fieldsAndDates(given);
}

/** Two targets with a cone about where the camera looks at the second one. */
function violating() {
  const scenario = fixture("two-targets");
  const [roll, yaw] = [25, 50].map((degrees) => (degrees * Math.PI) / 180);
  scenario.name = "into-the-cone";
  scenario.keep_out[0].direction = [Math.sin(roll) * Math.sin(yaw), -Math.sin(roll) * Math.cos(yaw), Math.cos(roll)];
  scenario.keep_out[0].half_angle_deg = 5;
  scenario.keep_out[0].applies = "report";
  return scenario;
}

/** Two targets of which one asks for a rest that the wheels cannot hold. */
function tooMuchMomentum() {
  const scenario = fixture("two-targets");
  scenario.name = "too-much-momentum";
  scenario.start.body_rate_rad_s = [0.04, 0, 0];
  scenario.start.wheel_speed_rad_s = [700, 0, 0];
  delete scenario.end;
  return scenario;
}

const fillScenario = (page, text) => page.getByLabel("Scenario", { exact: true }).fill(text);

async function violatedKeepOut({ browser, service, must }) {
  const id = await planned(service, violating());
  const { page, complaints, close } = await openPage(browser, service);
  await must("a violated keep-out is amber, with a banner and its hint above everything else", async () => {
    await page.goto(`${service.address}/#/plans/${id}`);
    await page.locator(".title .chip.waits", { hasText: "Optimal, but keep-out violated" }).waitFor();
    await page.locator(".card .chip.waits", { hasText: "Passed, but keep-out violated" }).waitFor();
    check(await page.locator(".chip.good").count() === 0, "something is green");
    const banner = page.getByRole("region", { name: "Keep-out violated" });
    const first = await page.locator(".result > *").first().evaluate((node) => node.className);
    check(first === "alarm", `first is ${first}`);
    check(await banner.getByText("target b", { exact: true }).count() === 1, "the target's name");
    check(await banner.locator(".hint").count() >= 2, "hints");
    const found = await findings(page);
    check(found.length === 0, found.join("\n"));
  });
  await must("the time inside the cone is marked on every timeline", async () => {
    const bar = page.locator(".bar.cone");
    await bar.waitFor();
    const begin = await bar.evaluate((node) => node.getBoundingClientRect().left + node.getBoundingClientRect().width / 2);
    await page.locator(".timelines").scrollIntoViewIfNeeded();
    // The mark is a line of one colour at the upper edge of each plot.
    const colours = await page.locator(".timelines .uplot canvas").evaluateAll((all, x) => all.map((canvas) => {
      const box = canvas.getBoundingClientRect();
      const across = Math.round(((x - box.left) * canvas.width) / box.width);
      const column = canvas.getContext("2d").getImageData(across, 0, 1, canvas.height).data;
      const reds = Array.from({ length: canvas.height }, (_, y) => column.slice(4 * y, 4 * y + 3).join());
      return reds.filter((pixel) => pixel === "196,72,60").length;
    }), begin);
    // Rates, speeds, torques and clearance.
    check(colours.length === 4 && colours.every((count) => count >= 3), colours.join());
    await page.locator("summary", { hasText: "Phases as a table" }).click();
    await page.getByRole("region", { name: "Phases of the flight" }).getByText("camera inside /keep_out/0").waitFor();
  });
  await must("the list marks the plan too", async () => {
    await page.goto(`${service.address}/#/`);
    const row = page.getByRole("row").filter({ has: page.locator(`a[href="#/plans/${id}"]`) });
    await row.locator(".chip.waits", { hasText: "Optimal, but keep-out violated" }).waitFor();
  });
  await must("a check names the target that is inside", async () => {
    await page.goto(`${service.address}/#/new`);
    await fillScenario(page, JSON.stringify(violating(), null, 2));
    await page.getByRole("button", { name: "Check" }).click();
    await page.locator(".success.doubtful .named-place", { hasText: "target b" }).waitFor();
    check(complaints.length === 0, complaints.join("\n"));
  });
  await close();
}

async function infeasible({ browser, service, must }) {
  const id = await planned(service, tooMuchMomentum());
  const { page, complaints, close } = await openPage(browser, service);
  await must("an infeasible plan offers what there is, and names the target", async () => {
    await page.goto(`${service.address}/#/plans/${id}`);
    await page.getByRole("heading", { name: "Why there is no plan" }).waitFor();
    await page.locator(".problems .named-place", { hasText: /^target [ab]$/ }).first().waitFor();
    const offered = await page.locator("a.download strong").allTextContents();
    check(offered.join() === "JSON,Scenario", offered.join());
    for (const link of await page.locator("a.download").all()) {
      const [download] = await Promise.all([page.waitForEvent("download"), link.click()]);
      check(await download.failure() === null, await download.failure());
    }
    check(complaints.length === 0, complaints.join("\n"));
    return offered.join();
  });
  await close();
}

async function cancelled({ browser, service, must }) {
  const { page, close } = await openPage(browser, service, { expected: refused(409) });
  await must("a cancelled job offers its scenario", async () => {
    const scenario = fixture("olivares-c");
    scenario.name = "given-up";
    scenario.targets = Array.from({ length: 60 }, (_, index) => ({
      id: `look-${index}`, attitude: { roll_pitch_yaw_deg: [(7 * index) % 50, (11 * index) % 50, (37 * index) % 360] },
    }));
    const answer = await fetch(`${service.address}/v1/plans`, {
      method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(scenario),
    });
    const { id } = await answer.json();
    await fetch(`${service.address}/v1/plans/${id}/cancel`, { method: "POST" });
    await page.goto(`${service.address}/#/plans/${id}`);
    await page.getByText("There is no plan", { exact: true }).waitFor();
    const offered = await page.locator("a.download strong").allTextContents();
    check(offered.join() === "Scenario", offered.join());
  });
  await must("a file that cannot be written says why", async () => {
    const id = await planned(service, fixture("two-targets"));
    await page.goto(`${service.address}/#/plans/${id}`);
    await page.getByRole("heading", { name: "Downloads" }).waitFor();
    await page.route("**/result?format=csv", (route) => route.fulfill({
      status: 422, contentType: "application/problem+json",
      body: JSON.stringify({ title: "Cannot be written", detail: "the epoch is missing", status: 422 }),
    }));
    await page.getByRole("link", { name: /^CSV/ }).click();
    await page.getByRole("alert").getByText("the epoch is missing").waitFor();
  });
  await close();
}

async function syntaxError({ browser, service, must }) {
  for (const [size, context] of [["desktop", {}], ["phone", PHONE]]) {
    const { page, close } = await openPage(browser, service, { ...context, expected: refused("4\\d\\d") });
    const field = page.locator("#scenario");
    const seen = () => field.evaluate((text) => {
      const line = text.value.slice(0, text.selectionStart).split("\n").length - 1;
      const style = getComputedStyle(text);
      const top = text.getBoundingClientRect().top + Number.parseFloat(style.paddingTop)
        + line * Number.parseFloat(style.lineHeight) - text.scrollTop;
      const box = text.getBoundingClientRect();
      return {
        chosen: text.value.slice(text.selectionStart, text.selectionEnd), line: line + 1,
        inField: top >= box.top - 1 && top < box.bottom, inWindow: top >= 0 && top < innerHeight,
      };
    });
    await must(`a syntax error leads to its line and column, ${size}`, async () => {
      await page.goto(`${service.address}/#/new`);
      const lines = JSON.stringify(fixture("olivares-c"), null, 2).split("\n");
      lines[150] = `${lines[150]} §`;
      await field.fill(lines.join("\n"));
      await page.getByRole("button", { name: "Plan", exact: true }).click();
      const link = page.locator(".failure .pointer");
      await link.waitFor();
      const text = await link.textContent();
      check(/^line 151, column \d+$/.test(text), text);
      await link.click();
      await eventually(async () => {
        const found = await seen();
        check(found.line === 151 && found.chosen === "§", JSON.stringify(found));
        check(found.inField && found.inWindow, JSON.stringify(found));
      });
      return text;
    });
    await must(`selecting a problem scrolls field and page to it, ${size}`, async () => {
      const scenario = fixture("olivares-c");
      scenario.targets[14].zero_rate_axes = ["w"];
      await field.fill(JSON.stringify(scenario, null, 2));
      await page.getByRole("button", { name: "Plan", exact: true }).click();
      const link = page.locator(".failure .pointer", { hasText: "/targets/14" });
      await link.waitFor();
      check(await page.locator(".failure .named-place").first().textContent() === `target ${scenario.targets[14].id}`, "the name");
      await link.click();
      await eventually(async () => {
        const found = await seen();
        check(found.chosen === '"w"' && found.inField && found.inWindow, JSON.stringify(found));
      });
    });
    await must(`lines have numbers that go with the text, ${size}`, async () => {
      // The numbers follow with the event of the scroll, which a busy machine delays.
      await eventually(async () => {
        const found = await field.evaluate((text) => {
          const lines = document.querySelector(".lines");
          const numbers = lines.textContent.split("\n");
          return {
            same: numbers.length === text.value.split("\n").length && numbers[150] === "151",
            apart: Math.abs(lines.scrollTop - text.scrollTop), scrolled: text.scrollTop,
            heights: [lines.clientHeight, text.offsetHeight],
          };
        });
        check(found.same && found.scrolled > 0 && found.apart <= 1, JSON.stringify(found));
        check(Math.abs(found.heights[0] - found.heights[1]) <= 2, JSON.stringify(found));
      });
    });
    await close();
  }
}

async function unitsAndColumns({ browser, service, must }) {
  const id = await planned(service, fixture("two-targets"));
  const { page, close } = await openPage(browser, service);
  await must("plots have the units of the pictures", async () => {
    await page.goto(`${service.address}/#/plans/${id}`);
    const titles = page.locator(".timelines h3");
    await titles.first().waitFor();
    const texts = (await titles.allTextContents()).join("; ");
    check(texts.includes("Body rates deg/s") && texts.includes("Wheel torques mN m"), texts);
    const plan = await (await fetch(`${service.address}/v1/plans/${id}/result`)).json();
    await page.locator("summary", { hasText: "Samples as a table" }).click();
    const row = page.getByRole("region", { name: "Samples of the trajectory" }).locator("tbody tr").nth(1);
    // The table is made when it is opened; reading texts does not wait for it.
    await row.waitFor();
    const cells = await row.locator("td").allTextContents();
    const number = (text) => Number(text.replace("−", "-"));
    const [state, control] = [plan.trajectory.states[1], plan.trajectory.controls[0]];
    check(Math.abs(number(cells[1]) - (state.body_rate_rad_s[0] * 180) / Math.PI) < 1e-4, cells.join());
    check(Math.abs(number(cells[7]) - 1000 * control.wheel_torque_nm[0]) < 1e-3, cells.join());
    return texts;
  });
  await must("settle and dwell have columns", async () => {
    const legs = page.getByRole("region", { name: /^Legs in flying order/ });
    const head = await legs.locator("thead th").allTextContents();
    const row = await legs.locator("tbody tr", { hasText: "→ b" }).locator("td, th").allTextContents();
    const at = (title) => row[head.indexOf(title)];
    check(at("Settle, s") === "1.00" && at("Dwell, s") === "2.00", row.join());
  });
  await close();
}

async function fingers({ browser, service, must }) {
  const id = await planned(service, fixture("two-targets"));
  const { page, complaints, close } = await openPage(browser, service, PHONE);
  await page.goto(`${service.address}/#/plans/${id}`);
  await page.locator(".timelines .u-over").first().waitFor();
  await must("a tap on a plot moves the cursors of all plots", async () => {
    const plot = page.locator(".timelines .u-over").nth(1);
    await plot.scrollIntoViewIfNeeded();
    const box = await plot.boundingBox();
    await page.touchscreen.tap(box.x + 0.6 * box.width, box.y + box.height / 2);
    return eventually(async () => {
      const lines = await page.locator(".timelines .u-cursor-x").evaluateAll((all) => all.map((line) => line.getBoundingClientRect().right));
      const marker = await page.locator(".lane-marker").evaluate((line) => line.getBoundingClientRect().left);
      const wanted = box.x + 0.6 * box.width;
      check(lines.length === 4 && [...lines, marker].every((x) => Math.abs(x - wanted) < 3), [...lines, marker, wanted].join());
      const text = await page.locator(".moment").textContent();
      check(!text.startsWith("0.0 s"), text);
      return text;
    });
  });
  const sphere = page.locator(".sphere");
  const pose = () => sphere.getAttribute("data-pose");
  const swipe = async (dx, dy) => {
    await page.evaluate(() => scrollTo(0, document.querySelector(".sphere").getBoundingClientRect().top + scrollY - innerHeight / 3));
    const begin = await page.evaluate(() => scrollY);
    const box = await sphere.boundingBox();
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    const session = await page.context().newCDPSession(page);
    const touch = (type, touchPoints) => session.send("Input.dispatchTouchEvent", { type, touchPoints });
    await touch("touchStart", [{ x, y }]);
    for (let step = 1; step <= 10; step += 1) {
      await touch("touchMove", [{ x: x + (dx * step) / 10, y: y + (dy * step) / 10 }]);
    }
    await touch("touchEnd", []);
    return async () => (await page.evaluate(() => scrollY)) - begin;
  };
  await must("a finger that goes sideways turns the sphere, and does not scroll the page", async () => {
    const before = await pose();
    const scrolled = await swipe(120, 4);
    await eventually(async () => check(await pose() !== before, "it has not turned"));
    check(await scrolled() === 0, `moved by ${await scrolled()} px`);
  });
  await must("a finger that goes up over the sphere scrolls the page, and does not turn it", async () => {
    const before = await pose();
    const scrolled = await swipe(0, -150);
    const moved = await eventually(async () => {
      check(await scrolled() > 80, `moved by ${await scrolled()} px`);
      return scrolled();
    });
    check(await pose() === before, `${before}, then ${await pose()}`);
    check(complaints.length === 0, complaints.join("\n"));
    return `${Math.round(moved)} px`;
  });
  await close();
  const desktop = await openPage(browser, service);
  await must("a drag leaves no box about the sphere, keys do", async () => {
    const { page } = desktop;
    await page.goto(`${service.address}/#/plans/${id}`);
    const sphere = page.locator(".sphere");
    await page.locator(".sphere .stop").first().waitFor();
    const outline = () => sphere.evaluate((node) => getComputedStyle(node).outlineStyle);
    const drag = async () => {
      const box = await sphere.boundingBox();
      const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
      await page.mouse.move(x, y);
      await page.mouse.down();
      await page.mouse.move(x + 60, y + 20, { steps: 4 });
      await page.mouse.up();
    };
    await drag();
    check(await outline() === "none", `after a drag: ${await outline()}`);
    await page.keyboard.press("ArrowLeft");
    await eventually(async () => check(await outline() === "solid", `after a key: ${await outline()}`));
    await drag();
    check(await outline() === "none", `after another drag: ${await outline()}`);
  });
  await desktop.close();
}

async function narrow({ browser, service, must }) {
  const id = await planned(service, fixture("olivares-a"));
  const note = (page) => page.getByRole("region", { name: /^Legs in flying order/ }).locator(".wider");
  await must("a table that is wider than the screen says so, and only then", async () => {
    const phone = await openPage(browser, service, PHONE);
    await phone.page.goto(`${service.address}/#/plans/${id}`);
    await note(phone.page).waitFor({ state: "visible" });
    await phone.close();
    const desktop = await openPage(browser, service);
    await desktop.page.goto(`${service.address}/#/plans/${id}`);
    await desktop.page.locator(".matrix").waitFor();
    check(await note(desktop.page).isHidden(), "it is said on a desktop");
    await desktop.close();
  });
}

async function fieldsAndDates({ browser, service, must }) {
  const { page, close } = await openPage(browser, service, { expected: [/./] });
  await must("all fields lead to the schema of what is written", async () => {
    for (const [view, operation, field] of [
      ["new", "plans-create_plan", "time_system"], ["slew", "slews-solve_slew", "sweep"],
      ["studies/envelopes", "studies-study_envelopes", "demands_nm"],
    ]) {
      await page.goto(`${service.address}/#/${view}`);
      await page.getByRole("link", { name: "All fields" }).click();
      const block = page.locator(`#operations-${operation}.is-open`);
      await block.waitFor();
      await block.locator(".opblock-section-request-body").getByText(field, { exact: true }).first().waitFor();
    }
  });
  await must("the list of plans shows dates, on a phone too", async () => {
    await planned(service, fixture("two-targets"));
    const year = String(new Date().getFullYear());
    await page.goto(`${service.address}/#/`);
    const time = page.locator("tbody tr time:visible").first();
    await time.waitFor();
    check((await time.textContent()).includes(year), await time.textContent());
    await page.setViewportSize(PHONE.viewport);
    await eventually(async () => {
      check(await page.locator("tbody tr time:visible").count() > 0, "no date");
      check((await time.textContent()).includes(year), await time.textContent());
    });
    return time.textContent();
  });
  await close();
}
