// What is drawn in a section as a picture of its own.

import { el } from "../dom.js";
import { taken } from "./taken.js";

/** A picture in pixels has so many for each of the page, so that it can be printed. */
const SHARP = 2;
/** Pixels that browsers have room for in one picture. */
const MOST_PIXELS = 100_000_000;

/** Two buttons that save the section in which they stand; `name` names the drawing, `of` tells what is drawn. */
export function pictureButtons(name, of = () => null) {
  const save = (kind, make) => el("button", {
    type: "button", class: "small", "aria-label": `Save ${name} as ${kind}`,
    onclick: async ({ currentTarget }) => {
      const names = [of(), name].filter(Boolean);
      const file = await make(taken(currentTarget.closest("section"), names.join(", ")));
      offer(file, `${names.join("-").replaceAll(/[^\w.-]+/g, "-").toLowerCase()}.${kind.toLowerCase()}`);
    },
  }, kind);
  return el("span", { class: "saves" }, save("SVG", svgFile), save("PNG", pngFile));
}

const svgFile = ({ text }) => new Blob([`<?xml version="1.0" encoding="UTF-8"?>\n${text}\n`], { type: "image/svg+xml" });

async function pngFile(picture) {
  const address = URL.createObjectURL(svgFile(picture));
  try {
    const image = new Image();
    image.src = address;
    await image.decode();
    const sharp = Math.min(SHARP, Math.sqrt(MOST_PIXELS / (picture.width * picture.height)));
    const canvas = el("canvas", { width: Math.round(sharp * picture.width), height: Math.round(sharp * picture.height) });
    canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
    return await new Promise((resolve) => { canvas.toBlob(resolve, "image/png"); });
  } finally {
    URL.revokeObjectURL(address);
  }
}

/** Gives a file to the browser to be kept. */
function offer(file, name) {
  const content = URL.createObjectURL(file);
  el("a", { href: content, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(content), 60_000);
}
