// The spacecraft in three dimensions, the flight played, and how long 200 targets keep the page busy.

import { check, eventually, findings, fixture, openPage, picture, planned } from "./harness.mjs";

export async function body(given) {
  await geometry(given);
  await played(given);
  await lessMotion(given);
  await intoTheCone(given);
  await many(given);
}

const moment = (page) => page.locator("#moment").inputValue().then(Number);
const shownBody = (page) => page.locator("canvas.body");
/** The picture as a text, to be compared. */
const pixels = (page) => shownBody(page).evaluate((canvas) => canvas.toDataURL());

async function geometry({ browser, service, must }) {
  const { page, close } = await openPage(browser, service);
  await page.goto(service.address);
  const folder = (await page.locator("script[type=module]").getAttribute("src")).replace("/app/main.js", "");
  await must("the box of an inertia has the edges of the box that has this inertia", async () => {
    const found = await page.evaluate(async (folder) => {
      const { boxOf, reachOf, sidesOf } = await import(`${folder}/app/body/solid.js`);
      const [a, b, c] = [1, 2, 3];
      // A turn about z by 20 degrees, so that the inertia has products.
      const [cos, sin] = [Math.cos(Math.PI / 9), Math.sin(Math.PI / 9)];
      const [x, y, z] = [b * b + c * c, a * a + c * c, a * a + b * b];
      const product = (x - y) * cos * sin;
      const box = boxOf([[x * cos * cos + y * sin * sin, product, 0], [product, x * sin * sin + y * cos * cos, 0], [0, 0, z]]);
      const { half, axes } = box;
      const corners = sidesOf(box).flatMap((side) => side.corners.map((corner) => Math.hypot(...corner)));
      return { ratios: [half[1] / half[0], half[2] / half[0]], axis: [Math.abs(axes[0][0]), Math.abs(axes[0][1])],
        corners, reach: reachOf(box, axes[2]) / half[2] };
    }, folder);
    const near = (value, wanted) => Math.abs(value - wanted) < 1e-9;
    check(near(found.ratios[0], 2) && near(found.ratios[1], 3), String(found.ratios));
    check(near(found.axis[0], Math.cos(Math.PI / 9)) && near(found.axis[1], Math.sin(Math.PI / 9)), String(found.axis));
    check(found.corners.length === 24 && found.corners.every((length) => near(length, 1)) && near(found.reach, 1), JSON.stringify(found));
  });
  await must("the hull of a cone as it is seen goes around all of its points", async () => {
    const missed = await page.evaluate(async (folder) => {
      const { hull } = await import(`${folder}/app/body/paint.js`);
      const points = Array.from({ length: 200 }, (_, i) => [((i * 0.618) % 1) - 0.5, ((i * 0.414) % 1) - 0.5, 0]);
      const around = hull(points);
      return points.filter(([x, y]) => around.some(([ax, ay], i) => {
        const [bx, by] = around[(i + 1) % around.length];
        return (bx - ax) * (y - ay) - (by - ay) * (x - ax) < -1e-12;
      })).length + (around.length < 4 || around.length > 60 ? 1000 : 0);
    }, folder);
    check(missed === 0, `${missed} points are outside`);
  });
  await close();
}

async function played({ browser, service, must }) {
  const id = await planned(service, fixture("stars-and-sun"));
  const plan = await (await fetch(`${service.address}/v1/plans/${id}/result`)).json();
  const { page, complaints, close } = await openPage(browser, service);
  await page.goto(`${service.address}/#/plans/${id}`);
  await shownBody(page).waitFor();
  await page.locator(".timelines .uplot").first().waitFor();

  await must("the flight is played to its end, faster at a greater speed, and all views follow", async () => {
    await eventually(async () => check(await moment(page) === 0, "it begins at the start"));
    const before = await pixels(page);
    await page.getByLabel("Speed", { exact: true }).selectOption("1");
    await page.getByRole("button", { name: "Play" }).click();
    const slow = await eventually(async () => {
      const time = await moment(page);
      check(time > 0, "it does not move");
      return time;
    });
    check(slow < 60, `${slow} s at once`);
    await page.getByLabel("Speed", { exact: true }).selectOption("200");
    await eventually(async () => check(Math.abs(await moment(page) - plan.total_time_s) < 0.5, "it has not ended"));
    await page.getByRole("button", { name: "Play" }).waitFor();
    check(await pixels(page) !== before, "the body has not moved");
    check(await page.locator(".sphere .stop:not(.reached)").count() === 0, "not every target is reached");
    return `${plan.total_time_s.toFixed(1)} s`;
  });
  await must("it is played, stepped and turned by keys alone", async () => {
    const canvas = shownBody(page);
    await canvas.focus();
    await page.keyboard.press(" ");
    await page.locator('.playback[data-playing="yes"]').waitFor();
    await eventually(async () => check(await moment(page) < plan.total_time_s / 2, "it does not begin again"));
    await page.keyboard.press(" ");
    await page.locator('.playback[data-playing="no"]').waitFor();
    const stopped = await moment(page);
    const next = plan.passages.find((passage) => passage.time_s > stopped + 1e-6);
    await page.getByRole("button", { name: "To the next arrival" }).focus();
    await page.keyboard.press("Enter");
    await eventually(async () => check(Math.abs(await moment(page) - next.time_s) < 0.2, `${await moment(page)} s`));
    const pose = await canvas.getAttribute("data-pose");
    await canvas.focus();
    for (const key of ["ArrowRight", "ArrowUp", "+"]) await page.keyboard.press(key);
    await eventually(async () => check(await canvas.getAttribute("data-pose") === "40.0 27.0 1.25", await canvas.getAttribute("data-pose")));
    await page.keyboard.press("0");
    await eventually(async () => check(await canvas.getAttribute("data-pose") === pose, "0 does not reset"));
    return `stopped at ${stopped.toFixed(1)} s, then ${next.target}`;
  });
  await must("seen from the body the frame turns", async () => {
    const fromFrame = await pixels(page);
    await page.getByLabel("Seen from").selectOption("body");
    await eventually(async () => check(await pixels(page) !== fromFrame, "the picture is the same"));
  });
  await must("a table has what the body shows", async () => {
    await page.locator("summary", { hasText: "Readings as a table" }).click();
    const table = page.getByRole("region", { name: "Body now" });
    await page.getByRole("button", { name: new RegExp(`^${plan.sequence[3]} `) }).click();
    const wanted = plan.passages[3].time_s.toFixed(2);
    await eventually(async () => check(await table.locator("tr", { hasText: "time, s" }).locator("td").textContent() === wanted, wanted));
    const shown = (await table.locator("tr", { hasText: "quaternion" }).locator("td").textContent()).split(", ").map((text) => Number(text.replace("−", "-")));
    const { x, y, z, w } = plan.passages[3].attitude.quaternion;
    const same = Math.abs(shown.reduce((total, part, index) => total + part * [x, y, z, w][index], 0));
    check(Math.abs(same - 1) < 1e-4, shown.join());
    return shown.join(" ");
  });
  await must("nothing that axe-core finds while it is played", async () => {
    await page.getByLabel("Speed", { exact: true }).selectOption("0.5");
    await page.getByRole("button", { name: "Play" }).click();
    const found = await findings(page);
    check(found.length === 0, found.join("\n"));
    await picture(page, "body-played");
    check(complaints.length === 0, complaints.join("\n"));
  });
  await close();
}

async function lessMotion({ browser, service, must }) {
  const id = await planned(service, fixture("two-targets"));
  const { page, close } = await openPage(browser, service, { reducedMotion: "reduce" });
  await must("with reduced motion the flight goes on in few steps", async () => {
    await page.goto(`${service.address}/#/plans/${id}`);
    await page.locator(".timelines .uplot").first().waitFor();
    await page.evaluate(() => {
      window.moments = new Set();
      new MutationObserver(() => window.moments.add(document.querySelector(".playback-moment").textContent))
        .observe(document.querySelector(".playback-moment"), { childList: true, characterData: true, subtree: true });
    });
    await page.getByLabel("Speed", { exact: true }).selectOption("1");
    await page.getByRole("button", { name: "Play" }).click();
    await eventually(async () => check(await moment(page) > 2.5, "it does not move"));
    const seen = await page.evaluate(() => window.moments.size);
    const time = await moment(page);
    check(seen <= time + 1, `${seen} moments in ${time} s`);
    return `${seen} moments in ${time.toFixed(1)} s`;
  });
  await close();
}

async function intoTheCone({ browser, service, must }) {
  const scenario = fixture("two-targets");
  const [roll, yaw] = [25, 50].map((degrees) => (degrees * Math.PI) / 180);
  scenario.keep_out[0] = { boresight: "camera", half_angle_deg: 5, applies: "report",
    direction: [Math.sin(roll) * Math.sin(yaw), -Math.sin(roll) * Math.cos(yaw), Math.cos(roll)] };
  const id = await planned(service, scenario);
  const { page, close } = await openPage(browser, service);
  await must("a boresight is red while it is inside of a cone, and only then", async () => {
    await page.goto(`${service.address}/#/plans/${id}`);
    await page.locator(".timelines .uplot").first().waitFor();
    // The colour of limits, as it is in a boresight's arrow.
    const red = () => shownBody(page).evaluate((canvas) => {
      const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
      let count = 0;
      for (let at = 0; at < data.length; at += 4) count += data[at] === 196 && data[at + 1] === 72 && data[at + 2] === 60 ? 1 : 0;
      return count;
    });
    check(await red() === 0, "red at the start");
    await page.getByRole("button", { name: /^b / }).click();
    return eventually(async () => {
      const count = await red();
      check(count > 20, `${count} red pixels at the target`);
      return `${count} pixels`;
    });
  });
  await close();
}

/** Two hundred targets, of which some order is flown. */
function twoHundred() {
  const scenario = fixture("olivares-c");
  const turn = (index, step, range) => (((index * step) % 1) - 0.5) * range;
  scenario.name = "two-hundred";
  scenario.targets = Array.from({ length: 200 }, (_, index) => ({
    id: `look-${index + 1}`,
    attitude: { roll_pitch_yaw_deg: [turn(index, 0.618, 50), turn(index, 0.414, 50), turn(index, 0.732, 360)] },
  }));
  scenario.options = { time_limit_s: 15 };
  return scenario;
}

/** What keeps the page busy is told and not judged: it depends on what else the machine does. */
async function many({ browser, service, must }) {
  const id = await planned(service, twoHundred());
  const { page, complaints, close } = await openPage(browser, service);
  await must("200 targets: the moment is dragged, and the flight is played", async () => {
    await page.goto(`${service.address}/#/plans/${id}`);
    await page.locator(".timelines .uplot").first().waitFor();
    await eventually(async () => check(await page.locator(".sphere .stop").count() === 200, "200 marks"));
    await page.waitForLoadState("networkidle");
    await page.evaluate(() => {
      window.tasks = [];
      new PerformanceObserver((list) => window.tasks.push(...list.getEntries().map((entry) => entry.duration))).observe({ entryTypes: ["longtask"] });
    });
    const longest = async () => page.evaluate(() => {
      const most = Math.max(0, ...window.tasks);
      window.tasks.length = 0;
      return `${Math.round(most)} ms`;
    });
    const slider = page.locator("#moment");
    await slider.scrollIntoViewIfNeeded();
    const box = await slider.boundingBox();
    const at = (share) => [box.x + 8 + share * (box.width - 16), box.y + box.height / 2];
    await page.mouse.move(...at(0));
    await page.mouse.down();
    for (let step = 1; step <= 60; step += 1) await page.mouse.move(...at(step / 60));
    await page.mouse.up();
    await eventually(async () => check(await page.locator(".sphere .stop:not(.reached)").count() <= 2, "the targets are not reached"));
    const dragged = await longest();
    const plot = await page.locator(".timelines .plot .u-over").first();
    await plot.scrollIntoViewIfNeeded();
    const over = await plot.boundingBox();
    for (let step = 0; step <= 60; step += 1) await page.mouse.move(over.x + (step / 60) * (over.width - 2), over.y + over.height / 2);
    const hovered = await longest();
    await page.mouse.move(5, 5);
    await page.getByRole("button", { name: "Play" }).click();
    await eventually(async () => check(await page.locator('.playback[data-playing="yes"]').count() === 0 || await moment(page) > 300, "it is not played"));
    const played = await longest();
    check(complaints.length === 0, complaints.join("\n"));
    return `longest task while the slider is dragged ${dragged}, while a plot is pointed at ${hovered}, while it is played ${played}`;
  });
  await close();
}
