// Names of fields as people read them.

/** Endings of names, the longest first, and the units that they stand for. */
const UNITS = [
  ["kg_m2", "kg m²"], ["rad_s", "rad/s"], ["rad_s2", "rad/s²"], ["deg_s", "°/s"], ["nm2_s", "N²m²s"], ["per_s", "1/s"],
  ["nms", "N m s"], ["rad", "rad"], ["deg", "°"], ["nm", "N m"], ["hz", "Hz"], ["s", "s"], ["j", "J"], ["w", "W"],
].sort(([a], [b]) => b.length - a.length);

/** "flights.end_attitude_rad.p50" as "flights, end attitude, p50, rad". */
export function named(path) {
  let unit = null;
  const parts = path.split(".").map((part) => {
    const [ending, sign] = UNITS.find(([ending]) => part.endsWith(`_${ending}`)) ?? [];
    if (!ending) return part;
    unit = sign;
    return part.slice(0, -ending.length - 1);
  });
  return [...parts.map((part) => part.replaceAll("_", " ")), unit].filter(Boolean).join(", ");
}
