// What a request is swept over.

const SWEPT = {
  weights: { title: "Weight", unit: "s per N²m²s" },
  durations_s: { title: "Given duration", unit: "s" },
  energies_j: { title: "Given energy", unit: "J" },
};

/** The sweep of a request: kind, title, unit and values; null without one. */
export function sweepOf({ sweep }) {
  const [kind, values] = Object.entries(sweep ?? {}).find(([, values]) => values) ?? [];
  return kind ? { kind, values, ...SWEPT[kind] } : null;
}
