// Colours as every reader of SVG knows them: styles may give them in newer forms.

const known = new Map();
let ink = null;

/** A colour as rgb(r, g, b) or rgba(r, g, b, a), whatever form a style has it in. */
export function plainColour(colour) {
  if (/^(#|none$)/.test(colour)) return colour;
  if (!known.has(colour)) known.set(colour, converted(colour));
  return known.get(colour);
}

function converted(colour) {
  const [, r, g, b, a = "1"] = /^rgba?\((\d+),? (\d+),? (\d+)(?:,? \/? ?([\d.]+))?\)$/.exec(colour) ?? [];
  if (r) return a === "1" ? `rgb(${r}, ${g}, ${b})` : `rgba(${r}, ${g}, ${b}, ${a})`;
  if (!ink) {
    const canvas = document.createElement("canvas");
    canvas.width = canvas.height = 1;
    ink = canvas.getContext("2d", { willReadFrequently: true });
  }
  ink.clearRect(0, 0, 1, 1);
  ink.fillStyle = colour;
  ink.fillRect(0, 0, 1, 1);
  const [red, green, blue, alpha] = ink.getImageData(0, 0, 1, 1).data;
  if (alpha === 255) return `rgb(${red}, ${green}, ${blue})`;
  return `rgba(${red}, ${green}, ${blue}, ${Number((alpha / 255).toFixed(3))})`;
}

/** Whether nothing of a colour can be seen. */
export const isClear = (colour) => colour === "transparent" || /^rgba\(.*, 0\)$/.test(plainColour(colour));
