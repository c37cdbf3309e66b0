// The moment that is shown in numbers: boresights, cones, body rates and wheels.

import { el } from "../dom.js";
import { fixed } from "../format.js";
import { settings } from "../settings.js";
import { rateUnit, speedUnit } from "../units.js";
import { dot, longitudeLatitude, rotate } from "../rotation.js";

const DEGREES = 180 / Math.PI;
/** Numbers that change faster cannot be read, ms. */
const PAUSE_MS = 100;

/** A table that follows the cursor while it is open. */
export function readings(flight, parts, cursor, signal) {
  const body = el("tbody", {});
  const node = el("details", {}, el("summary", {}, "Readings as a table"),
    el("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": "Body now" },
      el("table", {}, el("caption", { class: "unseen" }, "Body now"),
        el("thead", {}, el("tr", {}, el("th", { scope: "col" }, "Quantity"), el("th", { scope: "col", class: "number" }, "Value"))), body)));
  let waiting = false;
  const renew = () => {
    waiting = false;
    if (!node.open) return;
    body.replaceChildren(...rowsAt(flight, parts, cursor.time ?? 0).map(([name, value]) =>
      el("tr", {}, el("th", { scope: "row" }, name), el("td", { class: "number" }, value))));
  };
  node.addEventListener("toggle", renew);
  settings.listen(renew, signal);
  cursor.listen(() => {
    if (waiting || !node.open) return;
    waiting = true;
    setTimeout(renew, PAUSE_MS);
  }, signal);
  return node;
}

/** Names and values at a moment. */
export function rowsAt(flight, parts, time) {
  const attitude = flight.attitudeAt(time);
  const rates = flight.ratesAt(time);
  const speeds = flight.speedsAt(time);
  const torques = flight.torquesAt?.(time);
  const [rate, speed] = [rateUnit(), speedUnit()];
  return [
    ["time, s", fixed(time, 2)],
    ["quaternion x, y, z, w", attitude.map((part) => fixed(part, 5)).join(", ")],
    [`body rate x, y, z, ${rate.unit}`, rates.map((value) => fixed(value * rate.factor, rate.digits)).join(", ")],
    ...parts.boresights.flatMap(({ name, direction, cones }) => {
      const pointing = rotate(attitude, direction);
      return [
        [`${name} points to, longitude, latitude, °`, longitudeLatitude(pointing).map((angle) => fixed(angle, 2)).join(", ")],
        ...cones.map((cone) => [`${name} from ${cone.cone}, °`, fixed(clearance(cone, pointing), 2)]),
      ];
    }),
    ...parts.wheels.map(({ name, full, limited }, index) => [name, [
      `${fixed(speed.factor * speeds[index], speed.shown)} ${speed.unit}`, limited ? `${fixed((100 * speeds[index]) / full, 1)} % of its limit` : null,
      torques ? `${fixed(1000 * torques[index], 3)} mN m` : null,
    ].filter(Boolean).join(", ")]),
  ];
}

/** Degrees to the rim of a cone, negative on the wrong side. */
function clearance({ direction, halfAngle, inward }, pointing) {
  const angle = Math.acos(Math.max(-1, Math.min(1, dot(direction, pointing))));
  return DEGREES * (inward ? halfAngle - angle : angle - halfAngle);
}
