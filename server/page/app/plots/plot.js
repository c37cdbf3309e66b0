// A plot over time by uPlot, with the manners that all plots share.

import { watchSize } from "../dom.js";
import { paintAgain } from "../picture/painters.js";
import { paintPlot } from "../picture/plot-again.js";
import { colour, letters, onTheme } from "./palette.js";

/** Width of the vertical axis and of the space at the right, and size of letters, px. The phases are
 * aligned with these, see `lane-rows` in the style. */
const LEFT = 62;
const RIGHT = 14;
const FONT = 12;
/** Size of the points at the cursor, px. */
export const POINT = 6;
/** Height of the horizontal axis, px. */
const BELOW = 28;

/** A plot in a place that gives it its width; `options` are those of uPlot. */
export function plot(place, options, data, signal) {
  const larger = letters();
  const axis = (more) => ({
    stroke: () => colour("muted"),
    grid: { stroke: () => colour("grid"), width: 1 },
    ticks: { show: false },
    font: `${FONT * larger}px system-ui, sans-serif`,
    gap: 5 * larger,
    ...more,
  });
  const [x, y] = options.axes ?? [{}, {}];
  const made = new uPlot(
    {
      width: Math.max(place.clientWidth, 200),
      legend: { show: false },
      padding: [10, RIGHT * larger, 0, 0],
      ...options,
      height: options.height * larger,
      cursor: {
        y: false,
        ...options.cursor,
        points: { size: POINT, ...options.cursor?.points },
        drag: { x: true, y: false, ...options.cursor?.drag },
      },
      axes: [axis({ size: BELOW * larger, space: 50 * larger, ...x }), axis({ size: LEFT * larger, ...y })],
    },
    data,
    place,
  );
  watchSize(place, signal, (width) => {
    if (width > 0 && width !== made.width) made.setSize({ width, height: made.height });
  });
  paintAgain(made.ctx.canvas, (ink) => paintPlot(ink, made, options));
  onTheme(() => made.redraw(false), signal);
  signal.addEventListener("abort", () => made.destroy());
  return made;
}
