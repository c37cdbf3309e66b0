// Arrangements of wheels by their names.

import { flat } from "../pretty.js";
import { rounded } from "./orientation.js";

const RADIANS = Math.PI / 180;
/** The cosines of a pyramid's axes with the three body axes are equal in the mean at this elevation. */
export const USUAL_ELEVATION_DEG = 35.264389683;

/** Arrangements as [name, title]. */
export const ARRANGEMENTS = [
  ["orthogonal", "Orthogonal, 3 wheels"],
  ["pyramid", "Pyramid about Z, 4 wheels over X and Y"],
  ["pyramid-between", "Pyramid about Z, 4 wheels between X and Y"],
];

/** The axes of an arrangement; `elevation` is the angle of a pyramid's axes from the XY plane, degrees. */
export function axesOf(name, elevation) {
  if (name === "orthogonal") return [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  const [flatPart, up] = [Math.cos(elevation * RADIANS), Math.sin(elevation * RADIANS)];
  const first = name === "pyramid" ? 0 : 45;
  return [0, 90, 180, 270].map((step) => (first + step) * RADIANS)
    .map((turn) => [flatPart * Math.cos(turn), flatPart * Math.sin(turn), up].map(rounded));
}

/** The wheels of an arrangement as a JSON text, with everything else of a first wheel, which is a JSON object. */
export function wheelsText(name, elevation, { axis: _, ...others }) {
  const wheels = axesOf(name, elevation).map((axis) => `\n      ${flat({ axis, ...others })}`);
  return `[${wheels.join(",")}\n    ]`;
}
