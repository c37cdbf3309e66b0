// Tables, forms and the sky of a new plan, with a mouse, with keys only, and on a phone.

import { tabTo } from "./acts.mjs";
import { PHONE, check, eventually, findings, fixture, openPage, picture, stars } from "./harness.mjs";

/** Of drafts that are not whole yet the service says what is missing, which the browser itself reports. */
const refused = [/^console: Failed to load resource.* 4(04|22|00) /];

export async function desk(given) {
  await withKeys(given);
  await tableAndHistory(given);
  await cellsWithProblems(given);
  await skyWithTargets(given);
  await manyNames(given);
  await storedSpacecraft(given);
  await onPhone(given);
}

const text = (page) => page.locator("#scenario").inputValue();
const scenario = async (page) => JSON.parse(await text(page));
const cell = (page, name) => page.getByLabel(name, { exact: true });
const region = (page, name) => page.getByRole("region", { name, exact: true });

/** The scenario in the field, without a request for an example. */
async function write(page, service, document) {
  await page.goto("about:blank");
  await page.goto(`${service.address}/#/new`);
  await page.locator("#scenario").fill(typeof document === "string" ? document : JSON.stringify(document, null, 2));
}

async function clean(page, name) {
  await picture(page, name);
  const found = await findings(page);
  check(found.length === 0, `${name}: ${found.join("\n")}`);
}

async function withKeys({ browser, service, must }) {
  const { page, complaints, close } = await openPage(browser, service, { expected: refused });
  const keys = page.keyboard;
  await must("keys alone: cells, rows and the history", async () => {
    await write(page, service, fixture("stars-and-sun"));
    await tabTo(page, page.getByRole("button", { name: "Choose row 1, sirius", exact: true }));
    const begin = await page.evaluate(() => document.activeElement.closest("tr").querySelector("input").value);
    await keys.press("Tab");
    await keys.press("ArrowDown");
    const below = await page.evaluate(() => document.activeElement.value);
    check(begin !== below && (await scenario(page)).targets.some(({ id }) => id === below), `${begin}, below ${below}`);
    const order = async () => (await scenario(page)).targets.map(({ id }) => id);
    const before = await order();
    await keys.press("Alt+ArrowUp");
    const moved = await order();
    check(moved.indexOf(below) === before.indexOf(below) - 1, moved.join());
    check(await page.evaluate(() => document.activeElement.value) === below, "the focus goes with the row");
    await keys.press("Control+z");
    check((await order()).join() === before.join(), "undone");
    await keys.press("Control+y");
    check((await order()).join() === moved.join(), "done again");
    await keys.press("Control+a");
    await keys.type("hello");
    check((await order()).includes("hello"), (await order()).join());
    await keys.press("Control+z");
    check((await order()).join() === moved.join(), "a word is one step");
  });
  await must("keys alone: a target is chosen and moved in the sky", async () => {
    await page.locator(".desk-sphere").focus();
    await keys.press("n");
    const [name] = (await page.locator(".sky-status").textContent()).split(":");
    const where = async () => (await scenario(page)).targets.find(({ id }) => id === name).pointing.ra_dec_deg;
    const before = await where();
    for (let press = 0; press < 3; press += 1) await keys.press("Shift+ArrowUp");
    const after = await where();
    check(Math.abs(after[1] - before[1] - 3) < 2e-3 && Math.abs(after[0] - before[0]) < 2e-3, `${before}, then ${after}`);
    return `${name} ${before} → ${after}`;
  });
  await must("no error of the console with keys", () => check(complaints.length === 0, complaints.join("\n")));
  await close();
}

/** A scenario with what no table knows, and numbers that are written in an unusual way. */
const STRANGE = `{
  "name": "strange", "spacecraft": {
    "inertia_kg_m2": [[6.630, 0, 0], [0, 8.9, 0], [0, 0, 9.63]],
    "wheels": [
      {"axis": [1, 0, 0], "inertia_kg_m2": 1.69E-4, "max_torque_nm": 0.0101},
      {"axis": [0, 1, 0], "inertia_kg_m2": 1.69E-4, "max_torque_nm": 0.0101},
      {"axis": [0, 0, 1], "inertia_kg_m2": 1.69E-4, "max_torque_nm": 0.0101}
    ]
  },
  "start": {"attitude": {"quaternion": {"x": 0, "y": 0, "z": 0, "w": 1}}},
  "targets": [
    {"id": "a", "attitude": {"roll_pitch_yaw_deg": [15, 0.0, 10.50]}, "later": {"kept": [1, 2.0]}},

    {"id": "b",   "attitude": {"matrix": [[1,0,0],[0,1,0],[0,0,1]]}, "dwell_s": 1e1}
  ],
  "options": {"seed": 12345678901234567890}
}
`;

async function tableAndHistory({ browser, service, must }) {
  const { page, close } = await openPage(browser, service, { expected: refused, permissions: ["clipboard-read", "clipboard-write"] });
  await must("a cell changes its letters in the JSON and no others", async () => {
    await write(page, service, STRANGE);
    await cell(page, "Yaw, ° of a").fill("11.25");
    check(await text(page) === STRANGE.replace("10.50", "11.25"), await text(page));
    await page.keyboard.press("Control+z");
    check(await text(page) === STRANGE, "undone to the letter");
    await page.getByRole("button", { name: "Further fields of a in the JSON: later" }).click();
    const chosen = await page.locator("#scenario").evaluate((field) => field.value.slice(field.selectionStart, field.selectionEnd));
    check(chosen === '{"kept": [1, 2.0]}', chosen);
  });
  await must("rows are moved, doubled and deleted with all that is in them", async () => {
    await page.getByRole("button", { name: "Choose row 1, a" }).click();
    await page.getByRole("button", { name: "Move the chosen targets down" }).click();
    check((await scenario(page)).targets.map(({ id }) => id).join() === "b,a", "moved");
    await page.getByRole("button", { name: "Duplicate the chosen targets" }).click();
    const { targets, options } = await scenario(page);
    check(targets.map(({ id }) => id).join() === "b,a,a-2" && targets[2].later.kept.length === 2, JSON.stringify(targets));
    check((await text(page)).includes("12345678901234567890") && options.seed, "the seed keeps its digits");
    await page.getByRole("button", { name: "Delete the chosen targets" }).click();
    for (let step = 0; step < 3; step += 1) await page.getByRole("button", { name: "Undo" }).click();
    check(await text(page) === STRANGE, "all undone");
    for (let step = 0; step < 3; step += 1) await page.getByRole("button", { name: "Redo" }).click();
    check((await scenario(page)).targets.map(({ id }) => id).join() === "b,a", "all done again");
  });
  await must("the JSON changes the table", async () => {
    await page.locator("#scenario").fill(STRANGE.replace('"id": "a"', '"id": "from-json"').replace("15,", "-7.5,"));
    check(await cell(page, "Roll, ° of from-json").inputValue() === "-7.5", "the roll");
    await page.locator("#scenario").fill("{ broken");
    await page.getByText("The JSON cannot be read").waitFor();
    await page.getByRole("button", { name: "Undo" }).click();
    await cell(page, "Roll, ° of from-json").waitFor();
  });
  await must("another kind looks where it looked", async () => {
    await write(page, service, fixture("olivares-a"));
    await page.getByLabel("Kind of a", { exact: true }).selectOption("quaternion");
    await page.getByLabel("Kind of a", { exact: true }).selectOption("ra_dec_roll");
    await page.getByLabel("Kind of a", { exact: true }).selectOption("roll_pitch_yaw");
    const { attitude } = (await scenario(page)).targets[0];
    const apart = attitude.roll_pitch_yaw_deg.map((angle, index) => Math.abs(angle - [15, 0, 10][index]));
    check(Math.max(...apart) < 1e-6, JSON.stringify(attitude));
    check((await scenario(page)).targets[0].zero_rate_axes.join() === "z", "the rest of the target");
  });
  await must("rows of a spreadsheet are pasted, more of them than there are, as one step", async () => {
    const before = await text(page);
    const last = cell(page, "Name of f");
    await last.focus();
    await page.evaluate(() => navigator.clipboard.writeText("p\t1,5\t2\t−3\nq\t4\t5\t6"));
    await page.keyboard.press("Control+v");
    const { targets } = await scenario(page);
    check(targets.length === 7 && targets[5].id === "p" && targets[6].id === "q", JSON.stringify(targets.slice(5)));
    check(JSON.stringify(targets.slice(5).map(({ attitude }) => attitude.roll_pitch_yaw_deg)) === "[[1.5,2,-3],[4,5,6]]", JSON.stringify(targets.slice(5)));
    await page.keyboard.press("Control+z");
    check(await text(page) === before, "one step");
    await page.getByRole("button", { name: "Copy the table for a spreadsheet" }).click();
    const copied = await page.evaluate(() => navigator.clipboard.readText());
    check(copied.split("\n").length === 7 && copied.startsWith("id\troll\tpitch\tyaw"), copied);
  });
  await must("a table with a head is asked about wherever it is pasted", async () => {
    await page.evaluate((table) => navigator.clipboard.writeText(table), stars(3).replaceAll(",", "\t"));
    await cell(page, "Name of f").focus();
    await page.keyboard.press("Control+v");
    await page.getByRole("dialog").getByRole("button", { name: "Replace all targets" }).click();
    check((await scenario(page)).targets.map(({ id }) => id).join() === "sirius,canopus,rigil-kentaurus", "the stars");
  });
  await close();
}

async function cellsWithProblems({ browser, service, must }) {
  const { page, close } = await openPage(browser, service, { expected: refused });
  await must("cells of a table from elsewhere that cannot be read are told before they are taken", async () => {
    await write(page, service, fixture("stars-and-sun"));
    const file = await page.evaluateHandle(() => {
      const carried = new DataTransfer();
      carried.items.add(new File(["Name;RA [deg];Dec [deg];Mag\n\"a;1\";10,5;95;1\nsirius;x;3;\n;7;;2\n"], "stars.csv", { type: "text/csv" }));
      return carried;
    });
    await page.dispatchEvent(".desk-targets", "drop", { dataTransfer: file });
    const dialog = page.getByRole("dialog");
    await dialog.getByText("5 cells with a problem").waitFor();
    const problems = await dialog.locator("td.wrong").allTextContents();
    const expected = ["95the declination is beyond a pole", "siriusanother target has this name", "xthis is no number", "the name is missing", "a number is missing"];
    check(problems.join("|") === expected.join("|"), problems.join("|"));
    check(await dialog.getByLabel("Mag is").inputValue() === "", "Mag is left out");
    await clean(page, "desk-import-problems");
    await dialog.getByLabel("Mag is").selectOption("roll_min");
    await dialog.getByRole("button", { name: "Add 3 targets" }).click();
    const { targets } = await scenario(page);
    check(targets.length === 11 && JSON.stringify(targets[8].pointing) === '{"boresight":"camera","ra_dec_deg":[10.5,95],"roll_min_deg":1}', JSON.stringify(targets[8]));
  });
  await must("the service's problems stand in their cells as one types", async () => {
    const wrong = page.locator(".desk-targets .wrong");
    await cell(page, "Dec, ° of a;1").and(page.locator(".wrong")).waitFor();
    check(await wrong.count() >= 4, `${await wrong.count()} cells`);
    await clean(page, "desk-problems");
    await write(page, service, fixture("two-targets"));
    await page.getByText("No problems").waitFor();
    await cell(page, "Settle, s of b").fill("soon");
    await cell(page, "Settle, s of b").and(page.locator("[aria-invalid]")).waitFor();
    check((await scenario(page)).targets[1].settle_s === "soon", "what was typed is in the document");
    const note = page.locator(".desk-targets .cell-note");
    await eventually(async () => check((await note.textContent()).length > 10, await note.textContent()));
    await cell(page, "J xx kg m²").fill("-1");
    await cell(page, "J xx kg m²").and(page.locator(".wrong")).waitFor();
    await page.getByRole("button", { name: "problems" }).click();
    return eventually(async () => {
      const focused = await page.evaluate(() => document.activeElement.getAttribute("aria-label") ?? document.activeElement.id);
      check(focused === "Settle, s of b" || focused === "scenario", focused);
      return note.textContent();
    });
  });
  await close();
}

async function skyWithTargets({ browser, service, must }) {
  const { page, close } = await openPage(browser, service, { expected: refused });
  await must("a target is dragged in the sky, as one step", async () => {
    await write(page, service, fixture("stars-and-sun"));
    await page.locator(".desk-sphere .place-name").first().waitFor();
    const before = await text(page);
    const mark = page.locator(".desk-sphere .place.target:not(.behind)").first();
    const index = Number(await mark.getAttribute("data-index"));
    await mark.scrollIntoViewIfNeeded();
    const box = await mark.boundingBox();
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 20, y - 30, { steps: 8 });
    await page.mouse.up();
    const after = await scenario(page);
    const from = JSON.parse(before).targets[index].pointing.ra_dec_deg;
    const to = after.targets[index].pointing.ra_dec_deg;
    check(to[0] !== from[0] && to[1] !== from[1], `${from}, then ${to}`);
    // What is dragged lies under the pointer.
    await eventually(async () => {
      const now = await page.locator(`.desk-sphere .place[data-index="${index}"]`).boundingBox();
      const apart = Math.hypot(now.x + now.width / 2 - x - 20, now.y + now.height / 2 - y + 30);
      check(apart < 2, `${apart} px beside the pointer`);
    });
    await page.getByRole("button", { name: "Undo" }).click();
    check(await text(page) === before, "one step");
    return `${from} → ${to}`;
  });
  await must("attitudes are dragged in their own form", async () => {
    await write(page, service, fixture("two-targets"));
    await page.locator(".desk-sphere .place.target").first().waitFor();
    await page.locator(".desk-sphere").focus();
    await page.keyboard.press("n");
    await page.keyboard.press("Shift+ArrowLeft");
    const [{ attitude }] = (await scenario(page)).targets;
    check(Object.keys(attitude).join() === "roll_pitch_yaw_deg" && attitude.roll_pitch_yaw_deg[0] !== 15, JSON.stringify(attitude));
  });
  await must("what is in the sky is a table too, with the distance from the Sun", async () => {
    await write(page, service, fixture("stars-and-sun"));
    await page.locator("summary", { hasText: "Directions as a table" }).click();
    const row = page.getByRole("row", { name: /^sirius/ });
    await row.waitFor();
    const cells = await row.locator("td").allTextContents();
    check(cells.slice(0, 3).join() === "camera,101.29,−16.72" && Number(cells[3]) > 0, cells.join());
    return cells.join(" ");
  });
  await close();
}

/** Sixty targets within some thirty degrees. */
function crowded() {
  const document = fixture("stars-and-sun");
  document.targets = Array.from({ length: 60 }, (_, index) => ({
    id: `field-${index + 1}`,
    pointing: { boresight: "camera", ra_dec_deg: [80 + ((index * 0.618) % 1) * 70, -40 + ((index * 0.414) % 1) * 70] },
  }));
  return document;
}

async function manyNames({ browser, service, must }) {
  for (const [size, context] of [["desktop", {}], ["phone", PHONE]]) {
    const { page, close } = await openPage(browser, service, { ...context, expected: refused });
    await must(`sixty names do not hide each other, ${size}`, async () => {
      await write(page, service, crowded());
      await eventually(async () => {
        const count = await page.locator(".desk-sphere .place-name").count();
        check(count >= 60, `${count} names`);
      });
      await clean(page, `desk-crowded-${size}`);
      const hidden = await page.locator(".desk-sphere .place-name").evaluateAll((all) => {
        const boxes = all.map((node) => node.getBoundingClientRect());
        return boxes.flatMap((a, index) => boxes.slice(index + 1).filter((b) =>
          Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1 && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 3)).length;
      });
      check(hidden === 0, `${hidden} pairs cover each other`);
    });
    await close();
  }
}

async function storedSpacecraft({ browser, service, must }) {
  const { page, close } = await openPage(browser, service, { expected: refused });
  await must("a spacecraft is stored, and another plan refers to it", async () => {
    await write(page, service, fixture("stars-and-sun"));
    await page.getByLabel("Store as").fill("desk-craft");
    await page.getByRole("button", { name: "Store", exact: true }).click();
    await page.getByText("Stored as version 1 of desk-craft.").waitFor();
    await region(page, "Spacecraft").getByLabel("Spacecraft", { exact: true }).selectOption("stored");
    const stored = region(page, "Spacecraft").getByLabel("Stored spacecraft", { exact: true });
    await stored.locator("option", { hasText: "desk-craft, version 1" }).waitFor({ state: "attached" });
    await stored.selectOption("desk-craft");
    await page.getByText("Version 1: 3 wheels, 3 boresights.").waitFor();
    await page.getByText("No problems").waitFor();
    check(JSON.stringify((await scenario(page)).spacecraft) === '{"ref":"desk-craft"}', JSON.stringify((await scenario(page)).spacecraft));
    check(await page.locator(".desk-sphere .place.target").count() === 8, "the sky knows its boresights");
    await clean(page, "desk-stored");
    await region(page, "Spacecraft").getByLabel("Spacecraft", { exact: true }).selectOption("written");
    check((await scenario(page)).spacecraft.wheels.length === 3, "a copy of it");
  });
  await close();
}

async function onPhone({ browser, service, must }) {
  const { page, complaints, close } = await openPage(browser, service, { ...PHONE, expected: refused });
  await must("a phone: open, scroll past the sky, tap a target, and write in its row", async () => {
    await write(page, service, fixture("stars-and-sun"));
    await page.locator(".desk-sphere .place-name").first().waitFor();
    const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    check(wide <= 0, `${wide} px too wide`);
    await page.evaluate(() => scrollTo(0, document.querySelector(".desk-sphere").getBoundingClientRect().top + scrollY - innerHeight / 3));
    const begin = await page.evaluate(() => scrollY);
    const pose = await page.locator(".desk-sphere").getAttribute("data-pose");
    const box = await page.locator(".desk-sphere").boundingBox();
    const session = await page.context().newCDPSession(page);
    const touch = (type, touchPoints) => session.send("Input.dispatchTouchEvent", { type, touchPoints });
    const [x, y] = [box.x + 15, box.y + box.height / 2];
    await touch("touchStart", [{ x, y }]);
    for (let step = 1; step <= 10; step += 1) await touch("touchMove", [{ x, y: y - 15 * step }]);
    await touch("touchEnd", []);
    const scrolled = await eventually(async () => {
      const by = (await page.evaluate(() => scrollY)) - begin;
      check(by > 80, `moved by ${by} px`);
      return by;
    });
    check(await page.locator(".desk-sphere").getAttribute("data-pose") === pose, "it has turned");
    const mark = page.locator(".desk-sphere .place.target:not(.behind)").first();
    await mark.scrollIntoViewIfNeeded();
    const place = await mark.boundingBox();
    await page.touchscreen.tap(place.x + place.width / 2, place.y + place.height / 2);
    await page.locator(".desk-sphere .place.target.chosen").waitFor();
    const [name] = (await page.locator(".sky-status").textContent()).split(":");
    check(await page.locator("tr.chosen input").first().inputValue() === name, name);
    await cell(page, `Dec, ° of ${name}`).tap();
    await cell(page, `Dec, ° of ${name}`).fill("5");
    await page.locator(".sky-status", { hasText: "Dec 5.000°" }).waitFor();
    await clean(page, "desk-phone");
    check(complaints.length === 0, complaints.join("\n"));
    return `${Math.round(scrolled)} px, ${name}`;
  });
  await close();
}
