// Curves with values at places of their own, on one axis.

/**
 * The values of curves {points: [[x, y], ...]} on a common axis: {values, curves}, where a curve has
 * `null` at the places of others. Places that a curve has twice, where it jumps, are there twice.
 */
export function merged(lists) {
  const places = new Map();
  lists.forEach((points, curve) => {
    const seen = new Map();
    for (const [x, y] of points) {
      const nth = seen.get(x) ?? 0;
      seen.set(x, nth + 1);
      if (!places.has(x)) places.set(x, []);
      (places.get(x)[nth] ??= Array(lists.length).fill(null))[curve] = y;
    }
  });
  const rows = [...places].sort(([a], [b]) => a - b).flatMap(([x, list]) => list.map((row) => [x, row]));
  return { values: rows.map(([x]) => x), curves: lists.map((_, curve) => rows.map(([, row]) => row[curve])) };
}
