// The pure parts of a new plan, in the browser that they are for.

import { check, openPage } from "./harness.mjs";

const same = (found, expected) => check(JSON.stringify(found) === JSON.stringify(expected), JSON.stringify(found));

export async function deskModules({ browser, service, must }) {
  const { page, close } = await openPage(browser, service);
  await page.goto(service.address);
  const folder = (await page.locator("script[type=module]").getAttribute("src")).replace("/app/main.js", "");
  const inPage = (act) => page.evaluate(act, folder);

  await must("a change of a JSON text leaves its other letters", async () => {
    same(await inPage(async (folder) => {
      const { arrange, drop, insert, put, replaceItems } = await import(`${folder}/app/desk/json-edit.js`);
      const text = '{ "a": 1.50,\n  "b": [ {"x":1},  {"x": 2}, 3 ], "a~/": {} }';
      return [
        put(text, ["b", 1, "x"], "7"), put(text, ["b", "0", "y", "z"], "8"), put(text, ["a~/", "k"], "[]"),
        drop(text, ["a"]), drop(text, ["b", 2]), drop(text, ["none"]),
        arrange(text, ["b"], [2, 0, 1]), arrange(text, ["b"], []), insert(text, ["b"], 1, ["4", "5"]),
        replaceItems(text, ["b"], new Map([[0, "9"], [2, "{}"]])), put("", ["a", "b"], "1"), insert("{\n}", ["t"], 0, ["{}", "1"]),
      ];
    }), [
      '{ "a": 1.50,\n  "b": [ {"x":1},  {"x": 7}, 3 ], "a~/": {} }',
      '{ "a": 1.50,\n  "b": [ {"x":1, "y": {"z": 8}},  {"x": 2}, 3 ], "a~/": {} }',
      '{ "a": 1.50,\n  "b": [ {"x":1},  {"x": 2}, 3 ], "a~/": {"k": []} }',
      '{ "b": [ {"x":1},  {"x": 2}, 3 ], "a~/": {} }',
      '{ "a": 1.50,\n  "b": [ {"x":1},  {"x": 2} ], "a~/": {} }',
      '{ "a": 1.50,\n  "b": [ {"x":1},  {"x": 2}, 3 ], "a~/": {} }',
      '{ "a": 1.50,\n  "b": [ 3,  {"x":1}, {"x": 2} ], "a~/": {} }',
      '{ "a": 1.50,\n  "b": [], "a~/": {} }',
      '{ "a": 1.50,\n  "b": [ {"x":1},  4,  5,  {"x": 2}, 3 ], "a~/": {} }',
      '{ "a": 1.50,\n  "b": [ 9,  {"x": 2}, {} ], "a~/": {} }',
      '{\n  "a": {"b": 1}\n}\n', '{\n  "t": [\n    {},\n    1\n  ]\n}',
    ]);
  });
  await must("cells are read and written as people write numbers, and lose nothing", async () => {
    same(await inPage(async (folder) => {
      const { numberText, shown, written } = await import(`${folder}/app/desk/cells.js`);
      return [
        ["1.50", "−2", "+3", ".5", "1,25", "1e−3", "1,000.5", "x", "1e999"].map(numberText),
        [["number", "soon"], ["vector", "1 – 0.1"], ["vector", "1 x"], ["names", "a, b;c"], ["boresight", "0 0 1"], ["boresight", "camera"], ["number", " "]]
          .map(([type, cell]) => written(type, cell)),
        [["number", "1.50"], ["number", '"soon"'], ["vector", "[1, null, 0.1]"], ["names", '["a"]'], ["text", "7"], ["number", "null"]]
          .map(([type, raw]) => shown(type, raw)),
      ];
    }), [
      ["1.50", "-2", "3", "0.5", "1.25", "1e-3", null, null, "1e999"],
      ['"soon"', "[1, null, 0.1]", '"1 x"', '["a","b","c"]', "[0, 0, 1]", '"camera"', null],
      ["1.50", "soon", "1 – 0.1", "a", "7", ""],
    ]);
  });
  await must("windows are read in seconds and in dates, and come back as they were", async () => {
    same(await inPage(async (folder) => {
      const { shown, written } = await import(`${folder}/app/desk/cells.js`);
      const cells = ["60..120 300.5 .. 360", "0/60; 90/1e2", "2026-01-01T00:01:00Z..2026-01-01T00:02:00.5Z, 300..400", "60-120", "1..2..3", "soon..later"];
      const raw = cells.map((cell) => written("windows", cell));
      return [raw, raw.map((text) => shown("windows", text)), shown("windows", '[{"from_s": 1}]')];
    }), [
      ['[{"from_s": 60, "to_s": 120}, {"from_s": 300.5, "to_s": 360}]', '[{"from_s": 0, "to_s": 60}, {"from_s": 90, "to_s": 100}]',
        '[{"from": "2026-01-01T00:01:00Z", "to": "2026-01-01T00:02:00.5Z"}, {"from_s": 300, "to_s": 400}]',
        '"60-120"', '"1..2..3"', '"soon..later"'],
      ["60..120 300.5..360", "0..60 90..100", "2026-01-01T00:01:00Z..2026-01-01T00:02:00.5Z 300..400", "60-120", "1..2..3", "soon..later"],
      '[{"from_s": 1}]',
    ]);
  });
  await must("tables of any separator are read, with quotes and lines in cells", async () => {
    same(await inPage(async (folder) => {
      const { parse } = await import(`${folder}/app/desk/csv.js`);
      return ['\ufeffid,ra\r\n"a ""b"", c" , 1\n\n"two\nlines",2', "id;ra\nx;1,5", "id\tra\nx\t\t"].map((text) => parse(text));
    }), [
      { rows: [["id", "ra"], ['a "b", c', "1"], ["two\nlines", "2"]], lines: [1, 2, 4] },
      { rows: [["id", "ra"], ["x", "1,5"]], lines: [1, 2] }, { rows: [["id", "ra"], ["x", "", ""]], lines: [1, 2] },
    ]);
  });
  await must("columns are found by the names that the command line knows", async () => {
    same(await inPage(async (folder) => {
      const { guess } = await import(`${folder}/app/desk/mapping.js`);
      return [["Name", "RA [deg]", "Dec (deg)", "Mag"], ["id", "roll", "pitch", "yaw", "dwell_s"], ["target", "q_x", "q_y", "q_z", "q_w"],
        ["id", "ra", "dec", "roll_deg"], ["sirius", "101.2", "-16.7"], ["id", "ra", "dec", "Window", "value"]].map((head) => guess([head]));
    }), [
      { head: true, keys: ["id", "ra", "dec", null], kind: "pointing" },
      { head: true, keys: ["id", "roll", "pitch", "yaw", "dwell"], kind: "roll_pitch_yaw" },
      { head: true, keys: ["id", "qx", "qy", "qz", "qw"], kind: "quaternion" },
      { head: true, keys: ["id", "ra", "dec", "roll"], kind: "ra_dec_roll" },
      { head: false, keys: ["id", "ra", "dec"], kind: "pointing" },
      { head: true, keys: ["id", "ra", "dec", "windows", "value"], kind: "pointing" },
    ]);
  });
  await must("every form of an attitude becomes every other and looks the same", async () => {
    const worst = await inPage(async (folder) => {
      const { orientationOf, product, turn, written } = await import(`${folder}/app/desk/orientation.js`);
      const spacecraft = { boresights: [{ name: "camera", axis: [0.2, -0.5, 0.8] }] };
      const axis = orientationOf({ pointing: { boresight: "camera", ra_dec_deg: [0, 0] } }, spacecraft).axis;
      let worst = 0;
      for (let step = 0; step < 200; step += 1) {
        const q = product(turn([1, step % 7, -2], 37 * step), turn([0, 1, step % 3], 11 * step));
        for (const form of ["ra_dec_roll", "roll_pitch_yaw", "quaternion", "mrp", "matrix"]) {
          const read = orientationOf(written(form, q, { boresight: "camera", axis }), spacecraft).attitude;
          worst = Math.max(worst, 1 - Math.abs(read.reduce((sum, part, index) => sum + part * q[index], 0)));
        }
      }
      return worst;
    });
    check(worst < 1e-12, `one less the cosine of half the angle: ${worst}`);
  });
  await must("the Sun stands where the almanac says", async () => {
    const apart = await inPage(async (folder) => {
      const { sunOf } = await import(`${folder}/app/desk/sun.js`);
      // Apparent directions by astropy 7 (`get_sun`), as in the tests of the solver.
      const almanac = [["2000-01-01T12:00:00", [0.1800520312, -0.9024893898, -0.3912724977]],
        ["1985-07-04T06:30:00Z", [-0.2153021924, 0.8959535619, 0.3884741701]], ["2045-10-30T18:00:00", [-0.7978405173, -0.5531494407, -0.2397419534]]];
      const angles = almanac.map(([epoch, expected]) => {
        const found = sunOf({ epoch });
        return Math.hypot(...found.map((part, index) => part - expected[index]));
      });
      return [Math.max(...angles), sunOf({ epoch: "soon" }), sunOf({ epoch: "2026-01-01T00:00:00", reference_frame: "TEME" })];
    });
    check(apart[0] < (0.0105 * Math.PI) / 180 && apart[1] === null && apart[2] === null, String(apart));
  });
  await must("names have places apart from each other", async () => {
    const { missing, pairs } = await inPage(async (folder) => {
      const { placeLabels } = await import(`${folder}/app/sphere/labels.js`);
      const points = Array.from({ length: 60 }, (_, index) =>
        ({ x: 90 + ((index * 0.618) % 1) * 160, y: 90 + ((index * 0.414) % 1) * 160, width: 60, height: 13, radius: 5 }));
      const boxes = placeLabels(points, 340);
      const isOver = (a, b) => a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
      const pairs = boxes.flatMap((a, index) => boxes.slice(index + 1).filter((b) => a && b && isOver(a, b)));
      return { missing: boxes.filter((box) => !box).length, pairs: pairs.length };
    });
    check(missing === 0 && pairs === 0, `${missing} without a place, ${pairs} pairs over each other`);
  });
  await must("what is done is undone to the letter, letters of a group as one step", async () => {
    same(await inPage(async (folder) => {
      const { Draft } = await import(`${folder}/app/desk/draft.js`);
      const draft = new Draft();
      draft.edit('{"a": 1}', "first");
      for (const value of ["2", "23", "234"]) draft.edit(`{"a": ${value}}`, "a", "cell a");
      draft.settle();
      draft.edit("{", "JSON", "cell a");
      const broken = [draft.isReadable, draft.document.a];
      draft.undo();
      const back = [draft.text, draft.undoable, draft.redoable];
      draft.undo();
      const first = draft.text;
      draft.redo();
      draft.edit("{}", "other");
      return [broken, back, first, draft.redoable];
    }), [[false, 234], ['{"a": 234}', "a", "JSON"], '{"a": 1}', null]);
  });
  await close();
}
