// Where the Sun stands at an epoch, to 0.01 degrees, for what is drawn before a plan tells it.
//
// The low-precision series of Meeus (Astronomical Algorithms, 2nd edition, 1998, chapter 25) of date,
// and the precession of Lieske et al. (Astronomy and Astrophysics 58, 1977) to the equator of J2000.

import { turn } from "./orientation.js";
import { rotate } from "../rotation.js";

const CENTURY_MS = 36525 * 86400e3;
const J2000_MS = Date.UTC(2000, 0, 1, 12);
/** Terrestrial time minus the time systems, s; the coordinate times differ by less than a minute. */
const TO_TT = { UTC: 69.184, UT1: 69.184, TAI: 32.184, GPS: 51.184 };
/** Frames whose axes are those of the series, or so near that it cannot be seen. */
const FRAMES = ["EME2000", "J2000", "GCRF", "ICRF", "ICRF2", "ICRF3"];
const EPOCH = /^(\d{4})-(\d\d)-(\d\d)T(\d\d):(\d\d):(\d\d)(\.\d{1,9})?Z?$/;

const radians = (degrees) => (degrees * Math.PI) / 180;
const polynomial = (x, parts) => parts.reduceRight((sum, part) => part + x * sum, 0);

/** The unit vector to the Sun in EME2000 axes; null without an epoch or in another frame. */
export function sunOf({ epoch, time_system: system, reference_frame: frame } = {}) {
  const parts = EPOCH.exec(epoch ?? "");
  if (!parts || !FRAMES.includes(frame ?? "EME2000")) return null;
  const [year, month, day, hour, minute, second] = parts.slice(1, 7).map(Number);
  const time = Date.UTC(year, month - 1, day, hour, minute, second) + 1000 * (TO_TT[system ?? "UTC"] ?? 0);
  return direction((time - J2000_MS) / CENTURY_MS);
}

function direction(t) {
  const angle = (...parts) => radians(polynomial(t, parts));
  const anomaly = angle(357.52911, 35999.05029, -0.0001537);
  const centre = angle(1.914602, -0.004817) * Math.sin(anomaly)
    + angle(0.019993, -0.000101) * Math.sin(2 * anomaly) + angle(0.000289) * Math.sin(3 * anomaly);
  const longitude = angle(280.46646, 36000.76983, 0.0003032) + centre - angle(0.00569);
  const obliquity = angle(23.439291, -0.0130042);
  const [up, along] = [Math.sin(longitude), Math.cos(longitude)];
  const ofDate = [along, Math.cos(obliquity) * up, Math.sin(obliquity) * up];
  const seconds = (...parts) => polynomial(t, [0, ...parts]) / 3600;
  const zeta = seconds(2306.2181, 0.30188, 0.017998);
  const z = seconds(2306.2181, 1.09468, 0.018203);
  const theta = seconds(2004.3109, -0.42665, -0.041833);
  const about = (axis, degrees, vector) => rotate(turn(axis, degrees), vector);
  return about([0, 0, 1], -zeta, about([0, 1, 0], theta, about([0, 0, 1], -z, ofDate)));
}
