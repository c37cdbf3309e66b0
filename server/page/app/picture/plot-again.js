// A plot of the library drawn again: axes, curves, and what its hooks draw.

import { colour, letters } from "../plots/palette.js";

const FONT = 12;

/** Draws a plot that was made with these options of the library on a context, in px of the page. */
export function paintPlot(ink, plot, options) {
  const ratio = devicePixelRatio;
  const whole = plot.bbox;
  const bbox = Object.fromEntries(["left", "top", "width", "height"].map((name) => [name, whole[name] / ratio]));
  const along = (scale) => (value) => plot.valToPos(value, scale) + (scale === "x" ? bbox.left : bbox.top);
  const [x, y] = [along("x"), along("y")];
  // The hooks of the page draw in pixels of the screen.
  const drawn = { ctx: inPixels(ink, ratio), bbox: whole, valToPos: (value, scale) => along(scale)(value) * ratio, scales: plot.scales };
  for (const hook of options.hooks?.drawClear ?? []) hook(drawn);
  axes(ink, plot, bbox, [x, y]);
  ink.save();
  ink.beginPath();
  ink.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ink.clip();
  options.series.forEach((series, index) => index && curve(ink, series, [plot.data[0], plot.data[index]], [x, y]));
  ink.restore();
  options.series.forEach((series, index) => index && points(ink, series, [plot.data[0], plot.data[index]], [x, y]));
  for (const hook of options.hooks?.draw ?? []) hook(drawn);
}

/** A context that takes pixels of the screen. */
function inPixels(ink, ratio) {
  if (ratio === 1) return ink;
  const scaled = ["moveTo", "lineTo", "rect", "fillRect", "strokeRect"];
  const font = (text) => text.replace(/[\d.]+(?=px)/, (size) => String(Number(size) / ratio));
  return new Proxy(ink, {
    get: (target, name) => {
      const value = target[name];
      if (typeof value !== "function") return value;
      if (scaled.includes(name)) return (...places) => value.apply(target, places.map((place) => place / ratio));
      if (name === "fillText") return (text, x, y) => target.fillText(text, x / ratio, y / ratio);
      if (name === "setLineDash") return (dash) => target.setLineDash(dash.map((part) => part / ratio));
      return value.bind(target);
    },
    set: (target, name, value) => {
      target[name] = name === "lineWidth" ? value / ratio : name === "font" ? font(value) : value;
      return true;
    },
  });
}

function axes(ink, plot, bbox, places) {
  const larger = letters();
  const [right, bottom] = [bbox.left + bbox.width, bbox.top + bbox.height];
  plot.axes.forEach((axis, which) => {
    const at = places[which];
    ink.font = `${FONT * larger}px system-ui, sans-serif`;
    ink.lineWidth = 1;
    (axis._splits ?? []).forEach((value, index) => {
      const place = Math.round(at(value)) + 0.5;
      ink.strokeStyle = colour("grid");
      ink.beginPath();
      ink.moveTo(...(which ? [bbox.left, place] : [place, bbox.top]));
      ink.lineTo(...(which ? [right, place] : [place, bottom]));
      ink.stroke();
      const text = axis._values?.[index];
      if (text === null || text === undefined || text === "") return;
      ink.fillStyle = colour("muted");
      ink.textAlign = which ? "right" : "center";
      ink.textBaseline = which ? "middle" : "top";
      ink.fillText(String(text), ...(which ? [bbox.left - 5 * larger, place] : [place, bottom + 5 * larger]));
    });
    const label = typeof axis.label === "function" ? null : axis.label;
    if (label && !which) {
      ink.fillStyle = colour("muted");
      [ink.textAlign, ink.textBaseline] = ["center", "bottom"];
      ink.fillText(label, bbox.left + bbox.width / 2, plot.height);
    }
  });
}

const isKnown = (value) => value !== null && value !== undefined;

/** A curve with gaps where it has no value, as steps where the plot has them so. */
function curve(ink, { stroke, width, isStepped, spanGaps }, [times, values], [x, y]) {
  ink.strokeStyle = stroke();
  ink.lineWidth = width;
  ink.lineJoin = "round";
  ink.beginPath();
  let former = null;
  values.forEach((value, index) => {
    const point = isKnown(value) ? [x(times[index]), y(value)] : null;
    if (point && former && isStepped) ink.lineTo(point[0], former[1]);
    if (point && former) ink.lineTo(...point);
    else if (point) ink.moveTo(...point);
    if (point || !spanGaps) former = point;
  });
  if (width) ink.stroke();
}

function points(ink, { points: shown }, [times, values], [x, y]) {
  if (!shown?.show) return;
  ink.fillStyle = shown.fill();
  values.forEach((value, index) => {
    if (!isKnown(value)) return;
    ink.beginPath();
    ink.arc(x(times[index]), y(value), shown.size / 2, 0, 2 * Math.PI);
    ink.fill();
  });
}
