// The page's own geometry and text scanner, in the browser that they are for.

import { check, openPage } from "./harness.mjs";

export async function modules({ browser, service, must }) {
  const { page, close } = await openPage(browser, service);
  await page.goto(service.address);
  const folder = (await page.locator("script[type=module]").getAttribute("src")).replace("/app/main.js", "");
  const inPage = (act) => page.evaluate(act, folder);

  await must("a cap is drawn where it is", async () => {
    const wrong = await inPage(capsThatDiffer);
    check(wrong.count > 50_000, `only ${wrong.count} points were compared`);
    check(wrong.list.length === 0, JSON.stringify(wrong.list.slice(0, 3)));
    return `${wrong.count} points`;
  });
  await must("a curve is in front where it faces the viewer", async () => {
    const share = await inPage(async (folder) => {
      const { paths, viewOn } = await import(`${folder}/app/sphere/projection.js`);
      const circle = Array.from({ length: 721 }, (_, index) => viewOn(index / 2, 0).ahead);
      const length = (path) => path.split("M").slice(1).map((part) => part.split("L").map((pair) => pair.split(" ").map(Number)))
        .reduce((total, points) => total + points.slice(1).reduce((sum, point, index) =>
          sum + Math.hypot(point[0] - points[index][0], point[1] - points[index][1]), 0), 0);
      const { front, back } = paths(viewOn(30, 0), circle, ([x, y]) => `${x} ${y}`);
      return [length(front), length(back)];
    });
    check(share.every((length) => Math.abs(length - 2) < 1e-3), String(share));
  });
  await must("attitudes between samples are on the way", async () => {
    const errors = await inPage(async (folder) => {
      const { rotate, slerp } = await import(`${folder}/app/rotation.js`);
      const about = (angle) => [0, 0, Math.sin(angle / 2), Math.cos(angle / 2)];
      return [1, -1].map((sign) => {
        const found = rotate(slerp(about(0.2), about(1.2).map((value) => sign * value), 0.25), [1, 0, 0]);
        return Math.hypot(found[0] - Math.cos(0.45), found[1] - Math.sin(0.45), found[2]);
      });
    });
    check(errors.every((error) => error < 1e-12), String(errors));
  });
  await must("up is across the boresight and towards the body's +Z", async () => {
    const errors = await inPage(async (folder) => {
      const { dot, unit, upward } = await import(`${folder}/app/rotation.js`);
      const boresights = [[1, 0, 0], [0.3, -0.8, 0.2], [0, 0, 1], [0, 0, -1]].map(unit);
      return boresights.map((boresight, index) => {
        const up = upward(boresight);
        const towards = index < 2 ? up[2] : up[0];
        return Math.abs(dot(up, boresight)) + Math.abs(Math.hypot(...up) - 1) + (towards > 0.9 ? 0 : 1);
      });
    });
    check(errors.every((error) => error < 1e-12), String(errors));
  });
  await must("clearances are angles to what cones exclude", async () => {
    const found = await inPage(async (folder) => {
      const { clearanceCurves, excludedBy } = await import(`${folder}/app/plan/keep-out.js`);
      const cone = (direction) => ({ boresight: "camera", direction, half_angle_deg: 30 });
      const scenario = {
        spacecraft: { boresights: [{ name: "camera", axis: [2, 0, 0] }] },
        keep_out: [cone([0, 3, 0]), cone({ ra_dec_deg: [180, 0] })], keep_in: [cone({ body: "sun" })],
      };
      const known = { boresight: "camera", cone: "/keep_in/0", direction: [0, 0, 1] };
      const plan = { margins: { keep_out_clearance_deg: [known] } };
      const about = (angle) => [0, 0, Math.sin(angle / 2), Math.cos(angle / 2)];
      const curves = clearanceCurves(excludedBy(scenario, plan), scenario, [about(0), about(Math.PI / 3)]);
      return [curves.map(({ name, values }) => [name, ...values.map(Math.round)].join(" ")), excludedBy(scenario).length];
    });
    // Nearest first; where the Sun is, only a plan tells.
    const expected = [["camera /keep_in/0 -60 -60", "camera /keep_out/0 60 0", "camera /keep_out/1 150 90"], 2];
    check(JSON.stringify(found) === JSON.stringify(expected), JSON.stringify(found));
  });
  await must("pointers lead to their place in a text", async () => {
    const found = await inPage(async (folder) => {
      const { locate } = await import(`${folder}/app/pointer.js`);
      const text = '{"a": [1, {"b/c": "x\\"}", "d": [ ]}], "e": null}';
      const at = (pointer) => { const range = locate(text, pointer); return range && text.slice(...range); };
      return [at("/a/0"), at("/a/1/b~1c"), at("/a/1/d"), at("/e"), at("/a/1/missing"), locate("{oops", "/a")];
    });
    const expected = ["1", '"x\\"}"', "[ ]", "null", '{"b/c": "x\\"}", "d": [ ]}', null];
    check(JSON.stringify(found) === JSON.stringify(expected), JSON.stringify(found));
  });
  await must("lines and columns in bytes lead to their letter", async () => {
    const found = await inPage(async (folder) => {
      const { characterAt, nameAt, placeInText } = await import(`${folder}/app/pointer.js`);
      const text = '{\n  "ä": x,\n}';
      const at = (message) => { const place = placeInText({ code: "malformed_json", message }); return place && text.slice(...characterAt(text, place)); };
      const document = { targets: [{ id: "a" }, { id: 7 }], scenario: { targets: [{ id: "s" }] } };
      return [at("line 2, column 9: expected value"), at("line 3, column 1: trailing comma"), at("elsewhere"),
        ...["/targets/0/attitude", "/scenario/targets/0", "/targets/1", "/targets/9", "/start"].map((one) => nameAt(one, document))];
    });
    const expected = ["x", "}", null, "target a", "target s", null, null, null];
    check(JSON.stringify(found) === JSON.stringify(expected), JSON.stringify(found));
  });
  await must("a stream that broke after the last event comes to its end", async () => {
    const [known, events] = await inPage(async (folder) => {
      const { follow } = await import(`${folder}/app/stream.js`);
      const [known, events] = [[], []];
      const pieces = ["id: 7\nevent: state\ndata: {\"state\": \"succeeded\"}\n\n"];
      const body = () => new ReadableStream({
        async pull(controller) {
          if (pieces.length) return controller.enqueue(new TextEncoder().encode(pieces.pop()));
          await new Promise((resolve) => setTimeout(resolve, 100));
          controller.error(new Error("the connection broke"));
        },
      });
      const fetch = window.fetch;
      window.fetch = async (_, { headers }) => {
        known.push(headers["Last-Event-ID"] ?? null);
        return known.length === 1 ? new Response(body()) : new Response(null, { status: 204 });
      };
      await follow("any", (event) => events.push(event.state), new AbortController().signal);
      window.fetch = fetch;
      return [known, events];
    });
    check(JSON.stringify(known) === '[null,"7"]', JSON.stringify(known));
    check(JSON.stringify(events) === '["succeeded"]', JSON.stringify(events));
  });
  await must("any study is shown as tables, whatever is in it", async () => {
    const found = await inPage(async (folder) => {
      const { generic } = await import(`${folder}/app/studies/generic.js`);
      const row = (share, errors) => ({ torque_authority: share, plan: { total_time_s: 12.5, order: ["a", "b"] }, errors });
      const document = {
        complete: true, none: null, bound: { peak_rate_rad_s: 2e-7 },
        rows: [row(1, [{ target: "a", error_rad: 0.25 }]), row(0.5, [{ target: "b", error_rad: 1 }])],
      };
      const node = generic({ document });
      globalThis.document.body.append(node);
      for (const one of node.querySelectorAll("details")) one.open = true;
      await new Promise((resolve) => setTimeout(resolve, 50));
      for (const one of node.querySelectorAll("details")) one.open = true;
      await new Promise((resolve) => setTimeout(resolve, 50));
      const texts = (list) => [...list].map((item) => item.textContent);
      const tables = [...node.querySelectorAll("table")].map((table) =>
        [...table.rows].map((row) => texts(row.cells).join(" | ")));
      const labels = [...node.querySelectorAll("[role=region]")].map((region) => region.getAttribute("aria-label"));
      node.remove();
      return { tables, labels };
    });
    const expected = [
      ["Figure | Value", "complete | yes", "none | –", "bound, peak rate, rad/s | 2·10⁻⁷"],
      ["No. | torque authority | plan, total time, s | plan, order", "1 | 1 | 12.5 | a, b", "2 | 0.5 | 12.5 | a, b"],
      ["No. | target | error, rad", "1 | a | 0.25"],
      ["No. | target | error, rad", "1 | b | 1"],
    ];
    check(JSON.stringify(found.tables) === JSON.stringify(expected), JSON.stringify(found.tables));
    check(new Set(found.labels).size === found.labels.length, found.labels.join("; "));
  });
  await close();
}

/** Points of the disc that are in the outline of a cap but not in the cap, or the reverse. */
async function capsThatDiffer(folder) {
  const { front } = await import(`${folder}/app/sphere/cap.js`);
  const { seen, viewOn } = await import(`${folder}/app/sphere/projection.js`);
  const inside = (outline, [x, y]) => {
    let odd = false;
    outline.forEach((a, index) => {
      const b = outline.at(index - 1);
      if (a[1] > y !== b[1] > y && x < a[0] + ((y - a[1]) * (b[0] - a[0])) / (b[1] - a[1])) odd = !odd;
    });
    return odd;
  };
  const list = [];
  let count = 0;
  for (let longitude = 0; longitude < 360; longitude += 40) {
    for (let latitude = -80; latitude <= 80; latitude += 40) {
      for (const degrees of [5, 30, 60, 89, 110, 150]) {
        const view = viewOn(20, 15);
        const direction = viewOn(longitude, latitude).ahead;
        const half = (degrees * Math.PI) / 180;
        const centre = seen(view, direction);
        const outline = front(view, direction, half);
        for (let x = -0.95; x < 1; x += 0.1) {
          for (let y = -0.95; y < 1; y += 0.1) {
            if (x * x + y * y > 0.96) continue;
            const ahead = Math.sqrt(1 - x * x - y * y);
            const away = Math.acos(Math.max(-1, Math.min(1, centre[0] * x + centre[1] * y + centre[2] * ahead))) - half;
            // The outline is a polygon: its edges leave out a little.
            if (Math.abs(away) < 0.04) continue;
            count += 1;
            if (inside(outline, [x, y]) !== away < 0) list.push({ longitude, latitude, degrees, x, y });
          }
        }
      }
    }
  }
  return { list, count };
}
