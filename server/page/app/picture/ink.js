// A drawing context that has the members of a canvas's which the page uses, and writes SVG.

/** Smaller differences cannot be seen, px. */
const DIGITS = 2;
const FULL = 2 * Math.PI;

export const short = (value) => String(Number(value.toFixed(DIGITS)));

/** Text as it stands in a document. */
export const escaped = (text) => String(text).replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll('"', "&quot;");

/** An element; attributes that are null are left out. */
export function element(name, attributes, content = "") {
  const written = Object.entries(attributes).filter(([, value]) => value !== null && value !== undefined)
    .map(([key, value]) => ` ${key}="${escaped(typeof value === "number" ? short(value) : value)}"`);
  return content ? `<${name}${written.join("")}>${content}</${name}>` : `<${name}${written.join("")}/>`;
}

const ANCHORS = { center: "middle", right: "end", end: "end" };
/** How far below its point a text has its base line, in sizes of its letters. */
const BASES = { middle: 0.35, top: 0.8, hanging: 0.8, bottom: -0.2, alphabetic: 0 };
const MEASURES = document.createElement("canvas").getContext("2d");
let regions = 0;

const PLAIN = {
  fillStyle: "#000", strokeStyle: "#000", lineWidth: 1, globalAlpha: 1, font: "12px sans-serif", textAlign: "left",
  textBaseline: "alphabetic", lineJoin: "miter", lineCap: "butt", dash: [], shift: [0, 0], region: null,
};

/** Elements collect in `written`, with `plain` giving colours that every reader of SVG knows. */
export class SvgInk {
  written = [];
  #former = [];
  #path = "";
  #plain;

  constructor(plain) {
    this.#plain = plain;
    Object.assign(this, PLAIN);
  }

  save() {
    this.#former.push(Object.fromEntries(Object.keys(PLAIN).map((name) => [name, this[name]])));
  }

  restore() {
    Object.assign(this, this.#former.pop() ?? {});
  }

  translate(x, y) {
    this.shift = [this.shift[0] + x, this.shift[1] + y];
  }

  setLineDash(dash) {
    this.dash = [...dash];
  }

  beginPath() {
    this.#path = "";
  }

  moveTo(x, y) {
    this.#path += `M${this.#at(x, y)}`;
  }

  lineTo(x, y) {
    this.#path += `${this.#path ? "L" : "M"}${this.#at(x, y)}`;
  }

  closePath() {
    this.#path += "Z";
  }

  rect(x, y, width, height) {
    this.#path += `M${this.#at(x, y)}h${short(width)}v${short(height)}h${short(-width)}Z`;
  }

  arc(x, y, radius, from, to) {
    const end = Math.abs(to - from) >= FULL - 1e-9 ? from + FULL : to;
    const at = (angle) => this.#at(x + radius * Math.cos(angle), y + radius * Math.sin(angle));
    // Ends that are the same have no arc between them: a circle is two halves.
    const middle = (from + end) / 2;
    const round = short(radius);
    this.#path += `${this.#path ? "L" : "M"}${at(from)}A${round} ${round} 0 0 1 ${at(middle)}A${round} ${round} 0 0 1 ${at(end)}`;
  }

  clip() {
    regions += 1;
    this.written.push(element("clipPath", { id: `region-${regions}` }, element("path", { d: this.#path })));
    this.region = `url(#region-${regions})`;
  }

  fill() {
    this.#put("path", { d: this.#path }, { fill: true });
  }

  stroke() {
    this.#put("path", { d: this.#path }, { stroke: true });
  }

  fillRect(x, y, width, height) {
    this.#put("rect", { ...this.#box(x, y), width, height }, { fill: true });
  }

  strokeRect(x, y, width, height) {
    this.#put("rect", { ...this.#box(x, y), width, height }, { stroke: true });
  }

  /** What is written begins empty. */
  clearRect() {}

  fillText(text, x, y) {
    this.#text(text, x, y, { fill: true });
  }

  strokeText(text, x, y) {
    this.#text(text, x, y, { stroke: true });
  }

  measureText(text) {
    MEASURES.font = this.font;
    return MEASURES.measureText(text);
  }

  /** A picture in pixels that stay pixels: (image, x, y, width, height). */
  drawImage(image, x, y, width, height) {
    this.#put("image", {
      ...this.#box(x, y), width, height, href: image.toDataURL("image/png"), preserveAspectRatio: "none", style: "image-rendering: pixelated",
    }, {});
  }

  #at(x, y) {
    return `${short(x + this.shift[0])} ${short(y + this.shift[1])}`;
  }

  #box(x, y) {
    return { x: x + this.shift[0], y: y + this.shift[1] };
  }

  #put(name, attributes, inks, content = "") {
    this.written.push(element(name, { ...attributes, ...this.#inked(inks), "clip-path": this.region }, content));
  }

  #inked({ fill = false, stroke = false }) {
    const lines = stroke ? {
      stroke: this.#plain(this.strokeStyle), "stroke-width": this.lineWidth,
      "stroke-dasharray": this.dash.length ? this.dash.map(short).join(" ") : null,
      "stroke-linejoin": this.lineJoin === "miter" ? null : this.lineJoin,
      "stroke-linecap": this.lineCap === "butt" ? null : this.lineCap,
    } : {};
    return {
      fill: fill ? this.#plain(this.fillStyle) : stroke ? "none" : null, ...lines,
      opacity: this.globalAlpha < 1 ? this.globalAlpha : null,
    };
  }

  #text(text, x, y, inks) {
    MEASURES.font = this.font;
    const [, weight, size, family] = /^(?:(\d+|bold|normal)\s+)?([\d.]+)px\s+(.+)$/.exec(MEASURES.font) ?? [null, null, "12", "sans-serif"];
    const below = (BASES[this.textBaseline] ?? 0) * Number(size);
    this.#put("text", {
      ...this.#box(x, y + below), "font-size": Number(size), "font-family": family,
      "font-weight": weight && weight !== "normal" ? weight : null, "text-anchor": ANCHORS[this.textAlign] ?? null,
    }, inks, escaped(text));
  }
}
