// Which cells the problems of the draft belong to.

/** Whether a problem at a pointer is one of the value at a path: there, above it or inside it. */
export function concerns(pointer, path) {
  const own = `/${path.map((part) => String(part).replaceAll("~", "~0").replaceAll("/", "~1")).join("/")}`;
  return own === pointer || own.startsWith(`${pointer}/`) || pointer.startsWith(`${own}/`);
}

/**
 * Problems by row of a table: a map from indices to lists. Those of the table as a whole are nobody's.
 */
export function byRow(problems, path) {
  const begin = `/${path.join("/")}/`;
  const found = new Map();
  for (const problem of problems) {
    if (!problem.pointer?.startsWith(begin)) continue;
    const index = Number(problem.pointer.slice(begin.length).split("/")[0]);
    if (Number.isInteger(index)) found.set(index, [...(found.get(index) ?? []), problem]);
  }
  return found;
}

/** The problem of a row that belongs to one of its cells; undefined where none does. */
export function problemAt(problems, path) {
  return problems?.find(({ pointer }) => concerns(pointer, path));
}
