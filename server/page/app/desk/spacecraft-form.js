// The spacecraft as a form: written out, or a stored one.

import { request } from "../api.js";
import { el, section } from "../dom.js";
import { failure } from "../failure.js";
import { fixed, significant } from "../format.js";
import { write as pretty } from "../pretty.js";
import { numberText } from "./cells.js";
import { choice, field, group } from "./field.js";
import { put, rawAt } from "./json-edit.js";
import { Selection } from "./selection.js";
import { offered, StoredSpacecraft } from "./stored.js";
import { BORESIGHTS, WHEELS } from "./tables.js";
import { ARRANGEMENTS, USUAL_ELEVATION_DEG, wheelsText } from "./wheel-presets.js";

const PATH = ["spacecraft"];
const degrees = (cell) => (numberText(cell) ? `${fixed((Number(numberText(cell)) * 180) / Math.PI, 2)} °/s` : "");

/** The section of the spacecraft. */
export function spacecraftForm(desk) {
  const isStored = () => desk.document.spacecraft?.ref !== undefined;
  const source = choice("Spacecraft", [["written", "Written here"], ["stored", "Stored before"]], (value) => {
    const text = value === "stored" ? '{"ref": ""}' : desk.spacecraft ? pretty(desk.spacecraft, "  ") : "{}";
    desk.draft.edit(put(desk.draft.text, PATH, text), "source of the spacecraft");
  });
  const status = el("p", { class: "quiet stored-status", role: "status" });
  const stored = new StoredSpacecraft(desk.signal);
  const outcome = el("div", { "aria-live": "polite" });

  const picked = choice("Stored spacecraft", [], (value) => {
    // Another spacecraft has versions of its own.
    desk.draft.edit(put(desk.draft.text, PATH, JSON.stringify({ ref: value })), "stored spacecraft");
  });
  const reference = el("div", { class: "fields" }, picked.node,
    field(desk, { title: "Version", type: "number", placeholder: "newest" }, () => (isStored() ? [...PATH, "version"] : undefined)));
  const body = el("div", { class: "written-out" }, inertia(desk), limits(desk), wheels(desk), boresights(desk), keep(desk, stored, outcome));

  const render = () => {
    if (!desk.draft.isReadable) return;
    const isRef = isStored();
    source.show(isRef ? "stored" : "written");
    body.hidden = isRef;
    reference.hidden = status.hidden = !isRef;
    const { state, version, spacecraft } = desk.stored;
    if (isRef) {
      stored.look();
      picked.offer(optionsOf(stored.list, desk.document.spacecraft.ref));
      picked.show(desk.document.spacecraft.ref);
    }
    status.textContent = !isRef ? "" : {
      none: stored.list?.length === 0 ? "No spacecraft is stored yet: write one here and store it." : "Choose the one to plan for.",
      asked: "Looking for it …",
      missing: "The service has no spacecraft of this name and version.",
      known: `Version ${version}: ${spacecraft?.wheels?.length} wheels, ${spacecraft?.boresights?.length ?? 0} boresights. `
        + "“Written here” takes a copy of it that can be changed.",
    }[state];
  };
  desk.draft.listen(render, desk.signal);
  desk.listen(render);
  stored.listen(render);
  render();
  return section("Spacecraft", { class: "desk-part" }, el("div", { class: "fields" }, source.node), reference, status, body, outcome);
}

/** What can be picked; a name that is not stored stays what it is. */
function optionsOf(list, name) {
  const known = (list ?? []).map((one) => [one.name, offered(one)]);
  const own = typeof name === "string" && name && !known.some(([value]) => value === name) ? [[name, name]] : [];
  return [["", list === null ? "looking for them …" : "choose one"], ...own, ...known];
}

/** The inertia: the entries off the diagonal are there twice. */
function inertia(desk) {
  const entry = (row, column) => {
    const path = [...PATH, "inertia_kg_m2", row, column];
    const title = `J ${"xyz"[row]}${"xyz"[column]}`;
    return field(desk, { title, type: "number", unit: "kg m²" }, () => path, {
      written: (cell) => desk.draft.edit(withEntry(desk.draft, row, column, cell), `inertia ${title}`, `inertia ${row} ${column}`),
    });
  };
  return group("Inertia of the whole, wheels locked", entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2));
}

function withEntry({ text, tree }, row, column, cell) {
  const raw = (i, j) => rawAt(text, tree, [...PATH, "inertia_kg_m2", i, j]) ?? (i === j ? "null" : "0");
  const value = cell.trim() === "" ? "null" : numberText(cell) ?? JSON.stringify(cell.trim());
  const isIt = (i, j) => (i === row && j === column) || (i === column && j === row);
  const matrix = [0, 1, 2].map((i) => `[${[0, 1, 2].map((j) => (isIt(i, j) ? value : raw(i, j))).join(", ")}]`);
  return put(text, [...PATH, "inertia_kg_m2"], `[${matrix.join(", ")}]`);
}

function limits(desk) {
  const rate = (axis, index) => field(desk,
    { title: `Rate ${axis}`, type: "number", unit: "rad/s", length: 3, placeholder: "none" },
    () => [...PATH, "max_body_rate_rad_s", index], { also: degrees });
  return group("Limits of the body rate", ["x", "y", "z"].map(rate),
    field(desk, { title: "Norm", type: "number", unit: "rad/s", placeholder: "none" }, () => [...PATH, "max_body_rate_norm_rad_s"], { also: degrees }));
}

/** The wheels, one by one or in an arrangement. */
function wheels(desk) {
  const grid = desk.grid(WHEELS, { selection: new Selection(), empty: "No wheels yet: choose an arrangement, or add one after another." });
  const arrangement = el("select", { id: "arrangement" }, ARRANGEMENTS.map(([value, title]) => el("option", { value }, title)));
  const number = (id, label, unit, value) => {
    const input = el("input", { id, type: "text", inputmode: "decimal", autocomplete: "off", value });
    return { input, node: el("div", { class: "field" }, el("label", { for: id }, label, el("span", { class: "unit" }, ` ${unit}`)), input) };
  };
  const parts = {
    elevation: number("preset-elevation", "Elevation of a pyramid", "°", significant(USUAL_ELEVATION_DEG, 8)),
    inertia_kg_m2: number("preset-inertia", "Inertia of a wheel", "kg m²", ""),
    max_torque_nm: number("preset-torque", "Torque of a wheel", "N m", ""),
    max_speed_rad_s: number("preset-speed", "Speed of a wheel", "rad/s", ""),
  };
  const set = () => {
    const { elevation, ...others } = parts;
    const first = { ...desk.document.spacecraft?.wheels?.[0] };
    for (const [name, { input }] of Object.entries(others)) {
      const text = numberText(input.value);
      if (text) first[name] = Number(text);
    }
    const angle = Number(numberText(elevation.input.value) ?? USUAL_ELEVATION_DEG);
    desk.draft.edit(put(desk.draft.text, WHEELS.path, wheelsText(arrangement.value, angle, first)), "arrangement of wheels");
  };
  const strip = el("fieldset", { class: "preset" }, el("legend", {}, "Arrangement"), el("div", { class: "fields" },
    el("div", { class: "field wide" }, el("label", { for: "arrangement" }, "Wheels stand"), arrangement),
    Object.values(parts).map(({ node }) => node),
    el("div", { class: "field" }, el("button", { type: "button", onclick: set }, "Set wheels"))));
  return el("div", {}, el("h3", {}, "Wheels"), strip, grid.node);
}

function boresights(desk) {
  const grid = desk.grid(BORESIGHTS, { selection: new Selection(), empty: "No boresights: pointings and cones refer to them by name." });
  return el("div", {}, el("h3", {}, "Boresights"), grid.node);
}

/** Stores the spacecraft under a name. */
function keep(desk, stored, outcome) {
  const name = el("input", { id: "store-name", type: "text", autocomplete: "off", spellcheck: "false" });
  const store = el("button", { type: "button", onclick: async () => {
    store.disabled = true;
    try {
      const body = rawAt(desk.draft.text, desk.draft.tree, PATH) ?? "{}";
      const answer = await request(`/v1/spacecraft/${encodeURIComponent(name.value.trim())}`,
        { method: "PUT", headers: { "Content-Type": "application/json" }, body, signal: desk.signal });
      const { version } = await answer.json();
      stored.again();
      outcome.replaceChildren(el("p", { class: "success" }, `Stored as version ${version} of ${name.value.trim()}.`));
    } catch (error) {
      if (!desk.signal.aborted) outcome.replaceChildren(failure(error));
    }
    store.disabled = false;
  } }, "Store");
  return group("Keep for other plans", el("div", { class: "field" }, el("label", { for: "store-name" }, "Store as"), name), store);
}
