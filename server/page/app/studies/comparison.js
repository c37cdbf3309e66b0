// Reaction wheels against control moment gyroscopes: slew times, advantage angles, devices and masses.

import { disclosure, el, section, table } from "../dom.js";
import { fixed, significant } from "../format.js";
import { pictureButtons } from "../picture/save.js";
import { curveChart } from "../plots/curves.js";
import { merged } from "../plots/merged.js";
import { generic } from "./generic.js";

const DEGREES = 180 / Math.PI;
/** Controls with their names and colours. */
const CONTROLS = {
  rw_eigenaxis: ["wheels, eigenaxis", 6], rw_pseudo_optimal: ["wheels, pseudo-inverse optimal", 1],
  rw_optimal: ["wheels, optimal", 3], cmg: ["gyroscopes", 2],
};
const [WHEELS, GYROSCOPES] = [3, 2];
/** Slews of at most a half turn. */
const LARGEST_RAD = Math.PI;

/** The nodes of an answer. */
export function comparison(answer, signal) {
  const { document } = answer;
  const chart = (options) => curveChart(options, signal).node;
  const saves = (name) => ({ class: "wide", head: el("div", { class: "tools" }, pictureButtons(name)) });
  const times = document.sizes.map((size) => chart(slewTimes(document, size)));
  return [
    section("Slew times", saves("slew times"), el("div", { class: "curves" }, times),
      disclosure("Slew times as tables", () => el("div", {}, document.sizes.map((size) => timesTable(document, size))))),
    section("Where gyroscopes are faster", saves("advantage"), el("div", { class: "curves" }, chart(advantage(document))),
      el("p", { class: "quiet" }, "Beyond the angle of a curve gyroscopes turn faster than these wheels. Dots are published angles."),
      advantageTable(document)),
    section("Devices and their masses", saves("devices"), el("div", { class: "curves" },
      chart(devices(document)),
      chart(overMass(document, "Torque of four", "N m", "torque_nm", document.mass.crossover_kg)),
      chart(overMass(document, "Momentum of four", "N m s", "momentum_nms", null))),
      el("p", { class: "quiet" }, "Pyramids of four wheels and of four gyroscopes turn the same spacecraft. Dots are devices on the market, lines the laws through them; "
        + "from the marked mass on gyroscopes give more torque."),
      massTable(document)),
    el("div", { class: "result-more" }, disclosure("All figures as tables", () => generic(answer))),
  ];
}

const nameOf = (control) => CONTROLS[control]?.[0] ?? control;
const colourOf = (control) => CONTROLS[control]?.[1] ?? 5;

function slewTimes({ angles_rad: angles }, size) {
  return {
    title: `Devices of ${significant(size.momentum_nms)} N m s: slew time`, unit: "s", linear: true, from: 0,
    against: { title: "angle", unit: "°", values: angles.map((angle) => DEGREES * angle) },
    curves: size.controls.map(({ control, durations_s: values }) => ({ name: nameOf(control), colour: colourOf(control), values, shown: "line" })),
  };
}

function advantage({ advantage: { momenta_nms: momenta, curves, published } }) {
  const lines = curves.map(({ control, angles_rad: angles }) => ({
    control, shown: "line", points: momenta.map((momentum, index) => [momentum, angles[index]]).filter(([, angle]) => angle !== null && angle <= LARGEST_RAD),
  }));
  const dots = published.map(({ control, momentum_nms: momentum, angle_rad: angle }) => ({ control, shown: "dots", points: [[momentum, angle]] }));
  return scattered({
    title: "Advantage angle", unit: "°", across: ["momentum of a device", "N m s"],
    curves: [...lines, ...dots].map(({ control, shown, points }) => ({
      name: shown === "line" ? nameOf(control) : null, colour: colourOf(control), shown, points: points.map(([x, angle]) => [x, DEGREES * angle]),
    })),
  });
}

function devices({ market }) {
  const kinds = [[market.wheel, "wheels", WHEELS], [market.gyroscope, "gyroscopes", GYROSCOPES]];
  return scattered({
    title: "Torque of a device", unit: "N m", across: ["its momentum", "N m s"],
    curves: kinds.flatMap(([fit, name, colour]) => {
      const momenta = fit.devices.map((device) => device.momentum_nms).sort((a, b) => a - b);
      const law = momenta.filter((value, index) => value !== momenta[index - 1]).map((value) => [value, fit.used.factor * value ** fit.used.exponent]);
      return [{ name, colour, shown: "line", points: law },
        { name: null, colour, shown: "dots", points: fit.devices.map((device) => [device.momentum_nms, device.torque_nm]) }];
    }),
  });
}

function overMass({ mass }, title, unit, figure, crossover) {
  return {
    title, unit, marks: crossover === null ? [] : [crossover],
    against: { title: "mass of a device", unit: "kg", values: mass.points.map((point) => point.device_mass_kg) },
    curves: [["wheels", "wheel", WHEELS], ["gyroscopes", "gyroscope", GYROSCOPES]].map(([name, kind, colour]) =>
      ({ name, colour, shown: "line", values: mass.points.map((point) => point[`${kind}_${figure}`]) })),
  };
}

/** A chart whose curves have values at places of their own. */
function scattered({ title, unit, across: [name, of], curves }) {
  const { values, curves: lists } = merged(curves.map(({ points }) => points));
  return { title, unit, against: { title: name, unit: of, values }, curves: curves.map((one, index) => ({ ...one, values: lists[index] })) };
}

function timesTable({ angles_rad: angles }, { momentum_nms: momentum, controls }) {
  const columns = [{ title: "Angle, °", head: true }, ...controls.map(({ control }) => ({ title: `${nameOf(control)}, s`, number: true }))];
  return table(`Slew times with devices of ${significant(momentum)} N m s`, columns, angles.map((angle, index) =>
    [fixed(DEGREES * angle, 1), ...controls.map((one) => fixed(one.durations_s[index]))]));
}

function advantageTable({ sizes }) {
  const controls = sizes[0]?.advantages.map(({ control }) => control) ?? [];
  const columns = [{ title: "Device, N m s", head: true }, ...controls.map((control) => ({ title: `${nameOf(control)}, °`, number: true }))];
  const degrees = (angle) => (angle === null || angle === undefined ? "–" : fixed(DEGREES * angle, 1));
  return table("Angles from which on gyroscopes are faster", columns, sizes.map((size) => [significant(size.momentum_nms),
    ...controls.map((control) => degrees(size.advantages.find((one) => one.control === control)?.angle_rad))]));
}

function massTable({ mass }) {
  const columns = [{ title: "Mass of a device, kg", head: true }, ...["Wheels, N m", "Gyroscopes, N m", "Wheels, N m s", "Gyroscopes, N m s"].map((title) => ({ title, number: true }))];
  return table("Torque and momentum of four devices", columns, mass.points.map((point) => [significant(point.device_mass_kg),
    ...["wheel_torque_nm", "gyroscope_torque_nm", "wheel_momentum_nms", "gyroscope_momentum_nms"].map((name) => significant(point[name]))]));
}
