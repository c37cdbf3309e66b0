// What holds for the whole plan: name, epoch, start, end and options of the solve.

import { el, section } from "../dom.js";
import { choice, field, group } from "./field.js";
import { drop, put, rawAt } from "./json-edit.js";
import { KIND_TITLES, kindOfOrientation } from "./kinds.js";
import { rekinded } from "./rows.js";
import { lengthIn, ORIENTATION, pathIn } from "./tables.js";

const MEMBERS = ["attitude", "pointing"];
const AT_REST = '{"attitude": {"quaternion": {"x": 0, "y": 0, "z": 0, "w": 1}}}';
const FRAMES = ["EME2000", "J2000", "GCRF", "ICRF", "TEME", "TOD", "MCI"];
const SYSTEMS = ["UTC", "TAI", "TT", "GPS", "TDB", "TCB", "TCG", "UT1"];
const asOptions = (list) => list.map((value) => [JSON.stringify(value), value]);

/** The section of start and end. */
export function statesForm(desk) {
  return section("Start and end", { class: "desk-part" }, stateForm(desk, "start", "Start"), stateForm(desk, "end", "End"));
}

/** The section of everything else that a plan may be told. */
export function optionsForm(desk) {
  const text = (title, path, more) => field(desk, { title, type: "text", ...more }, () => path);
  const number = (title, name, more) => field(desk, { title, type: "number", ...more }, () => ["options", name]);
  return section("Epoch and options", { class: "desk-part" },
    group("Plan",
      text("Name", ["name"], { wide: true }),
      text("Epoch", ["epoch"], { wide: true, placeholder: "2026-01-31T12:00:00Z", hint: "needed where the Sun or dates count" }),
      field(desk, { title: "Latest end", type: "number", unit: "s", placeholder: "any", hint: "from the start" }, () => ["latest_end_s"]),
      field(desk, { title: "Time system", type: "choice", unset: "UTC", options: asOptions(SYSTEMS) }, () => ["time_system"]),
      field(desk, { title: "Frame", type: "choice", unset: "EME2000", options: asOptions(FRAMES) }, () => ["reference_frame"])),
    group("Solve",
      number("Time limit", "time_limit_s", { unit: "s", placeholder: "60" }),
      number("Gap to stop at", "relative_gap", { placeholder: "0" }),
      number("Torque authority", "torque_authority", { placeholder: "1" }),
      number("Momentum authority", "momentum_authority", { placeholder: "1" }),
      number("Alternatives", "alternatives", { placeholder: "1" }),
      field(desk, {
        title: "q and −q", type: "choice", wide: true, unset: "as usual",
        options: [['"rotation"', "the same attitude"], ['"quaternion"', "two attitudes"]],
      }, () => ["options", "attitude_equivalence"])));
}

/** The fields of a state; the end may be left out. */
function stateForm(desk, name, title) {
  const state = () => desk.document[name];
  const exists = () => state() !== undefined && state() !== null;
  const kinds = [...(name === "end" ? [["", "none: at the last target"]] : [["", "not given"]]), ...KIND_TITLES.orientation];
  const kind = choice("Given as", kinds, (value) => {
    const { draft } = desk;
    if (value === "") return draft.edit(drop(draft.text, [name]), `no ${name}`);
    const like = exists() ? draft.text : put(draft.text, [name], rawAt(draft.text, draft.tree, ["start"]) ?? AT_REST);
    const document = exists() ? desk.document : JSON.parse(like);
    const context = { draft: { text: like }, document, spacecraft: desk.spacecraft, sun: desk.sun };
    return draft.edit(rekinded(context, { path: [], members: MEMBERS }, name, value), `kind of the ${name}`);
  });
  const orientation = ORIENTATION.flatMap((column) => {
    const variants = new Set(Object.keys(column.at).map((key) => lengthIn(column, key)));
    return [...variants].map((length) => field(desk, { ...column, length }, () => {
      const now = kindOfOrientation(state() ?? {});
      const path = pathIn(column, now);
      return exists() && path && lengthIn(column, now) === length ? [name, ...path] : undefined;
    }));
  });
  const more = [
    field(desk, { title: "Body rate", type: "vector", unit: "rad/s", wide: true, placeholder: "0 0 0", hint: "x y z" },
      () => (exists() ? [name, "body_rate_rad_s"] : undefined)),
    field(desk, { title: "Wheel speeds", type: "vector", unit: "rad/s", wide: true, placeholder: name === "start" ? "zero" : "free", hint: "one for each wheel" },
      () => (exists() ? [name, "wheel_speed_rad_s"] : undefined)),
  ];
  const render = () => {
    if (!desk.draft.isReadable) return;
    const now = kindOfOrientation(state() ?? {});
    kind.show(exists() ? (now === "pointing_sky" ? "pointing" : now) : "");
  };
  desk.draft.listen(render, desk.signal);
  render();
  return el("div", { class: "state" }, group(title, kind.node, orientation, more));
}
