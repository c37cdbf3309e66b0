// A large matrix as a picture: one cell is chosen, by pointing or with keys, and can be looked at closely.

import { el, watchSize } from "../dom.js";
import { fixed } from "../format.js";
import { paintAgain } from "../picture/painters.js";
import { colour, letters, onTheme } from "../plots/palette.js";

const ZOOM_STEP = 2;
/** Cells of this size have their numbers, px. */
const LEGIBLE = 42;
const FAR = 10;

/** The place that is chosen and the part that is seen of a matrix with so many rows. */
class View {
  constructor(count) {
    this.count = count;
    [this.row, this.column, this.zoom, this.left, this.top] = [0, 1, 1, 0, 0];
  }

  /** Number of cells that are seen across. */
  get span() {
    return this.count / this.zoom;
  }

  choose(row, column) {
    const within = (index) => Math.max(0, Math.min(this.count - 1, index));
    [this.row, this.column] = [within(row), within(column)];
    this.left = this.#seen(this.left, this.column);
    this.top = this.#seen(this.top, this.row);
  }

  /** Looks closer, or less, at the chosen cell. */
  look(factor) {
    this.zoom = Math.max(1, Math.min(this.count / 4, this.zoom * factor));
    this.left = this.#bounded(this.column + 0.5 - this.span / 2);
    this.top = this.#bounded(this.row + 0.5 - this.span / 2);
  }

  pan(columns, rows) {
    this.left = this.#bounded(this.left + columns);
    this.top = this.#bounded(this.top + rows);
  }

  #bounded(begin) {
    return Math.max(0, Math.min(this.count - this.span, begin));
  }

  #seen(begin, index) {
    return this.#bounded(Math.max(index + 1 - this.span, Math.min(index, begin)));
  }
}

/**
 * The picture of `times`, rows of values of which `null` are unknown; `isFlown(row, column)` tells which
 * are framed, and `chosen` is called with the row and column of the chosen cell.
 */
export function heatMap({ label, times, isFlown, chosen }, signal) {
  const view = new View(times.length);
  const canvas = el("canvas", {
    class: "heat", tabindex: "0", role: "application",
    "aria-label": `${label}. Arrow keys choose a cell, with Shift ten further, plus and minus zoom, 0 shows all.`,
  });
  let ground = null;
  let size = 0;
  let asked = false;
  const renew = () => {
    if (!asked) requestAnimationFrame(draw);
    asked = true;
  };
  function draw() {
    asked = false;
    if (!size || signal.aborted) return;
    const pixels = Math.round(size * devicePixelRatio);
    if (canvas.width !== pixels) canvas.width = canvas.height = pixels;
    ground ??= cells(times);
    const ctx = canvas.getContext("2d");
    ctx.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
    ctx.imageSmoothingEnabled = false;
    ctx.drawImage(ground, view.left, view.top, view.span, view.span, 0, 0, size, size);
    marks(ctx, view, size, { times, isFlown });
    canvas.dataset.view = `${view.row} ${view.column} ${view.zoom.toFixed(2)}`;
  }
  paintAgain(canvas, (ink) => {
    const seen = el("canvas", {});
    seen.width = seen.height = Math.round(2 * size);
    const pixels = seen.getContext("2d");
    pixels.imageSmoothingEnabled = false;
    pixels.drawImage(ground, view.left, view.top, view.span, view.span, 0, 0, seen.width, seen.height);
    ink.drawImage(seen, 0, 0, size, size);
    marks(ink, view, size, { times, isFlown });
  });
  const choose = (row, column) => {
    const before = [view.row, view.column].join();
    view.choose(row, column);
    if ([view.row, view.column].join() !== before) chosen(view.row, view.column);
    renew();
  };
  const look = (factor) => {
    view.look(factor);
    renew();
  };
  listen(canvas, view, { choose, look, renew, size: () => size });
  onTheme(() => {
    ground = null;
    renew();
  }, signal);
  watchSize(canvas, signal, (width) => {
    size = width;
    renew();
  });
  const button = (text, name, act) => el("button", { type: "button", class: "small", "aria-label": name, onclick: act }, text);
  chosen(view.row, view.column);
  return {
    node: canvas,
    buttons: [button("−", "See more of the matrix", () => look(1 / ZOOM_STEP)),
      button("+", "Look closer at the matrix", () => look(ZOOM_STEP)), button("All", "All of the matrix", () => look(0))],
  };
}

/** A picture with one pixel for each cell. */
function cells(times) {
  const count = times.length;
  const canvas = el("canvas", {});
  canvas.width = canvas.height = count;
  const ctx = canvas.getContext("2d");
  const picture = ctx.createImageData(count, count);
  let [low, high] = [Infinity, -Infinity];
  for (const time of times.flat()) {
    if (time === null) continue;
    low = Math.min(low, time);
    high = Math.max(high, time);
  }
  const [least, most, unknown, self] = ["surface", "accent", "ground", "mark"].map((name) => parts(colour(name)));
  times.forEach((row, from) => row.forEach((time, to) => {
    const share = high > low ? (time - low) / (high - low) : 0;
    const ink = from === to ? self : time === null ? unknown
      : least.map((part, index) => part + (0.1 + 0.9 * share) * (most[index] - part));
    picture.data.set([...ink.map(Math.round), 255], 4 * (from * count + to));
  }));
  ctx.putImageData(picture, 0, 0);
  return canvas;
}

/** Red, green and blue of "#rrggbb". */
const parts = (hex) => [1, 3, 5].map((at) => Number.parseInt(hex.slice(at, at + 2), 16));

/** Frames, numbers where there is room for them, and the chosen cell. */
function marks(ctx, view, size, { times, isFlown }) {
  const cell = size / view.span;
  const at = (index, begin) => (index - begin) * cell;
  const range = (begin) => [Math.floor(begin), Math.min(view.count, Math.ceil(begin + view.span))];
  const [rows, columns] = [range(view.top), range(view.left)];
  const [text, surface, chosen] = ["text", "surface", "bound"].map(colour);
  const legible = cell >= LEGIBLE * letters();
  ctx.font = `${11 * letters()}px system-ui, sans-serif`;
  ctx.textAlign = "center";
  ctx.textBaseline = "middle";
  for (let row = rows[0]; row < rows[1]; row += 1) {
    for (let column = columns[0]; column < columns[1]; column += 1) {
      const [x, y] = [at(column, view.left), at(row, view.top)];
      if (isFlown(row, column)) frame(ctx, [x, y], cell, text, Math.min(2, cell / 4));
      if (!legible || row === column) continue;
      const time = fixed(times[row][column], 1);
      // Readable on every colour of a cell.
      ctx.lineWidth = 3;
      ctx.strokeStyle = surface;
      ctx.strokeText(time, x + cell / 2, y + cell / 2);
      ctx.fillStyle = text;
      ctx.fillText(time, x + cell / 2, y + cell / 2);
    }
  }
  const [x, y] = [at(view.column, view.left), at(view.row, view.top)];
  ctx.fillStyle = chosen;
  ctx.globalAlpha = 0.35;
  ctx.fillRect(0, y + cell / 2 - 0.5, size, 1);
  ctx.fillRect(x + cell / 2 - 0.5, 0, 1, size);
  ctx.globalAlpha = 1;
  frame(ctx, [x - 1, y - 1], cell + 2, chosen, 2);
}

function frame(ctx, [x, y], size, ink, width) {
  ctx.strokeStyle = ink;
  ctx.lineWidth = width;
  ctx.strokeRect(x + width / 2, y + width / 2, size - width, size - width);
}

function listen(canvas, view, { choose, look, renew, size }) {
  const move = (rows, columns) => (event) => {
    const far = event.shiftKey ? FAR : 1;
    choose(view.row + far * rows, view.column + far * columns);
  };
  const acts = {
    ArrowLeft: move(0, -1), ArrowRight: move(0, 1), ArrowUp: move(-1, 0), ArrowDown: move(1, 0),
    "+": () => look(ZOOM_STEP), "=": () => look(ZOOM_STEP), "-": () => look(1 / ZOOM_STEP), 0: () => look(0),
  };
  canvas.addEventListener("keydown", (event) => {
    const act = !event.ctrlKey && !event.metaKey && !event.altKey && acts[event.key];
    if (!act) return;
    event.preventDefault();
    act(event);
  });
  const cellAt = (event) => {
    const box = canvas.getBoundingClientRect();
    const share = (place, begin, length) => ((place - begin) / length) * view.span;
    return [Math.floor(view.top + share(event.clientY, box.top, box.height)), Math.floor(view.left + share(event.clientX, box.left, box.width))];
  };
  let from = null;
  canvas.addEventListener("pointerdown", (event) => {
    from = event;
    choose(...cellAt(event));
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!from) {
      if (event.pointerType === "mouse") choose(...cellAt(event));
      return;
    }
    if (view.zoom === 1) return;
    const cell = size() / view.span;
    view.pan((from.clientX - event.clientX) / cell, (from.clientY - event.clientY) / cell);
    from = event;
    renew();
  });
  for (const kind of ["pointerup", "pointercancel"]) canvas.addEventListener(kind, () => (from = null));
  canvas.addEventListener("dblclick", () => look(ZOOM_STEP));
}
