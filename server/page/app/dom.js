// Elements from code. Text always becomes a text node, so nothing in a scenario can become markup.

const SVG = "http://www.w3.org/2000/svg";

function fill(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes ?? {})) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else if (name in node && typeof value !== "string") node[name] = value;
    else node.setAttribute(name, value === true ? "" : value);
  }
  node.append(...children.flat(3).filter((child) => child !== null && child !== undefined && child !== false));
  return node;
}

/** An HTML element; attributes that begin with "on" are listeners. */
export function el(tag, attributes, ...children) {
  return fill(document.createElement(tag), attributes, children);
}

/** An SVG element. */
export function svg(tag, attributes, ...children) {
  const node = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes ?? {})) node.setAttribute(name, value);
  node.append(...children.flat());
  return node;
}

/** A section with a heading, named by it. */
export function section(title, attributes, ...children) {
  const id = "section-" + title.toLowerCase().replace(/[^a-z]+/g, "-");
  const heading = el("h2", { id }, title);
  const { head, ...rest } = attributes ?? {};
  const bar = el("div", { class: "section-head" }, heading, head);
  return el("section", { "aria-labelledby": id, ...rest }, bar, ...children);
}

/** A table of rows of texts or nodes; columns are {title, number, head}. */
export function table(caption, columns, rows) {
  const cell = (column, content) =>
    column.head
      ? el("th", { scope: "row" }, content)
      : el("td", { class: column.number ? "number" : null }, content);
  return scroller(caption, el(
    "table",
    {},
    el("caption", { class: "unseen" }, caption),
    el("thead", {}, el("tr", {}, columns.map((column) =>
      el("th", { scope: "col", class: column.number ? "number" : null }, column.title)))),
    el("tbody", {}, rows.map((row) =>
      el("tr", {}, row.map((content, index) => cell(columns[index], content))))),
  ));
}

/** A table in a place of its own, which says when there is more of it beside what is seen. */
export function scroller(caption, content) {
  const note = el("p", { class: "wider", hidden: true }, "There is more to the right: scroll this table sideways.");
  const node = el("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": caption }, note, content);
  const watcher = new ResizeObserver(() => (note.hidden = content.offsetWidth <= node.clientWidth + 1));
  watcher.observe(node);
  watcher.observe(content);
  return node;
}

/** Tells the width and height of a node, in whole pixels, at once and whenever they change. */
export function watchSize(node, signal, listener) {
  const watcher = new ResizeObserver(([{ contentRect }]) => listener(Math.round(contentRect.width), Math.round(contentRect.height)));
  watcher.observe(node);
  signal.addEventListener("abort", () => watcher.disconnect());
}

/** Something that is made when it is opened for the first time: the data of a plot as a table. */
export function disclosure(summary, make) {
  const node = el("details", {}, el("summary", {}, summary));
  node.addEventListener("toggle", () => {
    if (node.open && node.children.length === 1) node.append(make());
  });
  return node;
}
