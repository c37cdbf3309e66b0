// A part of the page as an SVG document: boxes, texts, pictures and canvases where they stand, in the
// colours and fonts that they are seen with.

import { element, escaped, short, SvgInk } from "./ink.js";
import { painterOf } from "./painters.js";
import { isClear, plainColour } from "./plain-colour.js";

/** What is only there to be used, or not to be seen. */
const LEFT_OUT = "button, input, textarea, details, summary, script, .unseen, .units, .wider, .not-drawn";
/** Properties of shapes that a style may give. */
const SHAPE = ["fill", "stroke", "stroke-width", "stroke-dasharray", "stroke-linejoin", "opacity", "paint-order"];
const LETTERS = ["font-family", "font-size", "font-weight", "text-anchor"];
/** Room around what is taken, px. */
const ROOM = 14;

/** The document of a part of the page; `title` is for those who listen. */
export function taken(node, title) {
  const box = node.getBoundingClientRect();
  const reach = { right: 0, bottom: 0 };
  const content = new Part(box, reach).children(node);
  const { width, height } = { width: Math.ceil(reach.right) + ROOM, height: Math.ceil(reach.bottom) + ROOM };
  const ground = plainColour(getComputedStyle(node).backgroundColor);
  const text = element("svg", { xmlns: "http://www.w3.org/2000/svg", width, height, viewBox: `0 0 ${width} ${height}`, role: "img" },
    `${element("title", {}, escaped(title))}${element("rect", { width: "100%", height: "100%", fill: ground })}${content}`);
  return { text, width, height };
}

class Part {
  #origin;
  #reach;

  constructor(origin, reach) {
    this.#origin = origin;
    this.#reach = reach;
  }

  children(node) {
    return [...node.childNodes].map((child) =>
      (child.nodeType === Node.TEXT_NODE ? this.#text(child) : child.nodeType === Node.ELEMENT_NODE ? this.#element(child) : "")).join("");
  }

  #element(node) {
    if (node.matches(LEFT_OUT) || !node.checkVisibility({ opacityProperty: true, visibilityProperty: true })) return "";
    const style = getComputedStyle(node);
    const place = this.#placed(node.getBoundingClientRect());
    const content = node instanceof SVGSVGElement ? this.#picture(node, place)
      : node instanceof HTMLCanvasElement ? this.#canvas(node, place)
        : node instanceof HTMLSelectElement ? this.#line(node.selectedOptions[0]?.text ?? "", place, style, 0.3)
          : boxOf(place, style) + this.children(node);
    const isFaint = !(node instanceof SVGElement) && Number(style.opacity) < 1;
    return isFaint && content ? element("g", { opacity: style.opacity }, content) : content;
  }

  #placed({ left, top, width, height }) {
    return { x: left - this.#origin.left, y: top - this.#origin.top, width, height };
  }

  #grow({ x, y, width, height }) {
    this.#reach.right = Math.max(this.#reach.right, x + width);
    this.#reach.bottom = Math.max(this.#reach.bottom, y + height);
  }

  /** A text, line by line as it is broken. */
  #text(node) {
    if (!node.data.trim()) return "";
    const style = getComputedStyle(node.parentElement);
    const range = document.createRange();
    const lines = [];
    for (const { 0: word, index } of node.data.matchAll(/\S+\s?/g)) {
      range.setStart(node, index);
      range.setEnd(node, index + word.trimEnd().length);
      const place = range.getBoundingClientRect();
      const last = lines.at(-1);
      if (last && Math.abs(last.place.top - place.top) < place.height / 2) {
        last.text += word.replace(/\s$/, " ");
        last.right = place.right;
      } else lines.push({ text: word.replace(/\s$/, " "), place, right: place.right });
    }
    return lines.map(({ text, place, right }) =>
      this.#line(text.trimEnd(), this.#placed({ left: place.left, top: place.top, width: right - place.left, height: place.height }), style)).join("");
  }

  /** A line of text in a box; `indent` are letters that stay free before it. */
  #line(text, place, style, indent = 0) {
    if (!text || place.width === 0) return "";
    this.#grow(place);
    const size = Number.parseFloat(style.fontSize);
    return element("text", {
      x: place.x + indent * size, y: place.y + place.height / 2 + 0.35 * size, fill: plainColour(style.color), "font-family": style.fontFamily,
      "font-size": size, "font-weight": style.fontWeight === "400" ? null : style.fontWeight,
      textLength: indent ? null : place.width, lengthAdjust: indent ? null : "spacingAndGlyphs",
    }, escaped(text));
  }

  #picture(node, place) {
    this.#grow(place);
    const copy = node.cloneNode(true);
    const [shapes, copies] = [node, copy].map((one) => [...one.querySelectorAll("*")]);
    shapes.forEach((shape, index) => {
      const [style, own] = [getComputedStyle(shape), copies[index]];
      const isText = shape instanceof SVGTextElement;
      for (const name of [...SHAPE, ...isText ? LETTERS : []]) {
        const value = style.getPropertyValue(name);
        if (value && !USUAL[name]?.includes(value)) own.setAttribute(name, /fill|stroke$/.test(name) ? plainColour(value) : value);
      }
      own.removeAttribute("class");
    });
    copy.querySelectorAll("title").forEach((title) => title.remove());
    const written = [...copy.childNodes].map((child) => new XMLSerializer().serializeToString(child).replaceAll(' xmlns="http://www.w3.org/2000/svg"', "")).join("");
    return element("svg", { x: place.x, y: place.y, width: place.width, height: place.height, viewBox: node.getAttribute("viewBox") }, written);
  }

  #canvas(node, place) {
    this.#grow(place);
    const ink = new SvgInk(plainColour);
    const paint = painterOf(node);
    ink.translate(place.x, place.y);
    if (paint) paint(ink);
    else ink.drawImage(node, 0, 0, place.width, place.height);
    return ink.written.join("");
  }
}

/** Values that need not be written. */
const USUAL = {
  stroke: ["none"], "stroke-width": ["1px"], "stroke-dasharray": ["none"], "stroke-linejoin": ["miter"], opacity: ["1"],
  "paint-order": ["normal"], "text-anchor": ["start"], "font-weight": ["400"],
};

/** Ground, frame and edges of a box. */
function boxOf({ x, y, width, height }, style) {
  if (width === 0 || height === 0) return boxEdges({ x, y, width, height }, style);
  const ground = isClear(style.backgroundColor) ? ""
    : element("rect", { x, y, width, height, rx: Number.parseFloat(style.borderTopLeftRadius) || null, fill: plainColour(style.backgroundColor) });
  return ground + boxEdges({ x, y, width, height }, style) + inset({ x, y, width, height }, style);
}

function boxEdges({ x, y, width, height }, style) {
  const edge = (side, d) => {
    const thick = Number.parseFloat(style.getPropertyValue(`border-${side}-width`));
    const colour = style.getPropertyValue(`border-${side}-color`);
    const kind = style.getPropertyValue(`border-${side}-style`);
    if (!thick || kind === "none" || isClear(colour)) return "";
    return element("path", {
      d: d(thick / 2), fill: "none", stroke: plainColour(colour), "stroke-width": thick,
      "stroke-dasharray": kind === "dashed" ? "4 3" : kind === "dotted" ? "1 2" : null,
    });
  };
  const [right, bottom] = [x + width, y + height];
  return edge("top", (half) => `M${short(x)} ${short(y + half)}H${short(right)}`)
    + edge("bottom", (half) => `M${short(x)} ${short(bottom - half)}H${short(right)}`)
    + edge("left", (half) => `M${short(x + half)} ${short(y)}V${short(bottom)}`)
    + edge("right", (half) => `M${short(right - half)} ${short(y)}V${short(bottom)}`);
}

/** The frame that a shadow draws inside of a box. */
function inset({ x, y, width, height }, style) {
  const [, colour, size] = /^(.+) 0px 0px 0px ([\d.]+)px inset$/.exec(style.boxShadow) ?? [];
  if (!colour) return "";
  const thick = Number(size);
  return element("rect", {
    x: x + thick / 2, y: y + thick / 2, width: width - thick, height: height - thick, fill: "none", stroke: plainColour(colour), "stroke-width": thick,
  });
}
