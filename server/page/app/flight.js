// What the plots draw: a motion together with the limits that were asked for.

import { alarmsOf, clearanceCurves, excludedBy } from "./plan/keep-out.js";
import { excessAlarms } from "./plan/violations.js";
import { quaternion, slerp } from "./rotation.js";
import { windowsByTarget, windowsUsed } from "./windows.js";

/** The flight of a plan; null when the plan has no trajectory. */
export function flightOf(plan, scenario) {
  const { states, controls } = plan.trajectory ?? {};
  if (!states?.length) return null;
  const moved = motion(states, scenario, plan);
  const wheels = scenario.spacecraft.wheels;
  const inForce = torques(moved.times, controls, wheels.length);
  const commanded = { times: moved.times, curves: wheels.map((_, wheel) => inForce.map((torque) => torque[wheel])), steps: true };
  const isPassed = plan.verification?.passed !== false;
  const stopped = stops(plan, scenario);
  return {
    ...moved,
    total: plan.total_time_s,
    torques: commanded,
    torquesAt: (time) => inForce[indexAt(moved.times, time)],
    phases: phases(plan, scenario),
    stops: stopped,
    windows: windowsUsed(stopped, windowsByTarget(scenario)),
    alarms: [...alarmsOf(plan), ...isPassed ? [] : excessAlarms({ ...moved, torques: commanded })],
  };
}

/** What every motion has, from sampled states and what was asked for, and perhaps a plan: curves with their limits. */
export function motion(states, asked, plan) {
  const times = states.map((state) => state.time_s);
  const attitudes = states.map((state) => quaternion(state.quaternion));
  const excluded = excludedBy(asked, plan);
  const rates = [0, 1, 2].map((axis) => states.map((state) => state.body_rate_rad_s[axis]));
  const speeds = asked.spacecraft.wheels.map((_, wheel) => states.map((state) => state.wheel_speed_rad_s[wheel]));
  const all = (curves) => (time) => curves.map((samples) => valueAt({ times, samples }, time));
  return {
    scenario: asked,
    total: times.at(-1),
    times,
    attitudes,
    rates,
    speeds,
    limits: limits(asked),
    phases: [],
    stops: [],
    windows: [],
    alarms: [],
    excluded,
    clearances: clearanceCurves(excluded, asked, attitudes),
    attitudeAt: (time) => attitudeAt(times, attitudes, time),
    ratesAt: all(rates),
    speedsAt: all(speeds),
  };
}

/** The torque in force from each moment on; the last interval's at the end. */
function torques(times, controls, wheels) {
  let index = 0;
  return times.map((time) => {
    while (index + 1 < controls.length && controls[index + 1].start_s <= time) index += 1;
    return controls[index]?.wheel_torque_nm ?? Array(wheels).fill(0);
  });
}

/** Lowest and highest allowed value of every curve; null where there is no limit. */
function limits(scenario) {
  const { spacecraft } = scenario;
  const options = scenario.options ?? {};
  const authority = { torque: options.torque_authority ?? 1, momentum: options.momentum_authority ?? 1 };
  const both = (limit) => (limit ? [-limit, limit] : null);
  const norm = spacecraft.max_body_rate_norm_rad_s;
  const each = spacecraft.max_body_rate_rad_s ?? [null, null, null];
  return {
    rates: each.map((limit) => both(limit ?? norm)),
    speeds: spacecraft.wheels.map((wheel) =>
      wheel.enabled === false ? null : both(wheel.max_speed_rad_s && authority.momentum * wheel.max_speed_rad_s)),
    torques: spacecraft.wheels.map((wheel) =>
      wheel.enabled === false ? null : [
        authority.torque * (wheel.min_torque_nm ?? -wheel.max_torque_nm),
        authority.torque * wheel.max_torque_nm,
      ]),
  };
}

/** Slew, settle and dwell, and what is waited between, in order of time. */
function phases(plan, scenario) {
  const waits = (plan.waits ?? []).map(({ target, from_s: begin, to_s: end }) =>
    ({ kind: "wait", name: `wait at ${target}`, label: target, begin, end }));
  return [...moved(plan, scenario), ...waits].sort((a, b) => a.begin - b.begin);
}

function moved(plan, scenario) {
  const settle = new Map(scenario.targets.map((target) => [target.id, target.settle_s ?? 0]));
  const arrivals = new Map(plan.passages.map((passage, index) => [passage.target, { passage, number: index + 1 }]));
  return plan.legs.flatMap((leg) => {
    const arrival = leg.start_s + leg.duration_s;
    const slew = { kind: "slew", name: `${leg.from} → ${leg.to}`, label: leg.to, begin: leg.start_s, end: arrival };
    const at = arrivals.get(leg.to);
    if (!at) return [slew];
    const { passage, number } = at;
    slew.number = number;
    const settled = Math.min(passage.time_s + (settle.get(leg.to) ?? 0), passage.departure_s);
    const rest = [
      { kind: "settle", begin: passage.time_s, end: settled },
      { kind: "dwell", begin: settled, end: passage.departure_s },
    ];
    const names = { settle: `settle at ${leg.to}`, dwell: `dwell at ${leg.to}` };
    return [slew, ...rest.filter((phase) => phase.end - phase.begin > 1e-9)
      .map((phase) => ({ ...phase, name: names[phase.kind], label: leg.to, number }))];
  });
}

/** The targets in visiting order. Of a boresight that is pointed, its name or axis and its roll are told. */
function stops(plan, scenario) {
  const pointed = new Map(scenario.targets.map((target) => [target.id, target.pointing?.boresight ?? null]));
  return plan.passages.map((passage, index) => ({
    number: index + 1,
    name: passage.target,
    time: passage.time_s,
    departure: passage.departure_s,
    attitude: quaternion(passage.attitude.quaternion),
    roll: passage.roll_deg ?? null,
    pointed: pointed.get(passage.target) ?? null,
  }));
}

/** The index of the last time that is not after a moment. */
export function indexAt(times, time) {
  let [low, high] = [0, times.length - 1];
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** The value of a curve at a moment: that in force (`steps`), or between two samples. */
export function valueAt({ times, samples, steps }, time) {
  const index = indexAt(times, time);
  const next = Math.min(index + 1, times.length - 1);
  const span = times[next] - times[index];
  if (steps || span <= 0) return samples[index];
  return samples[index] + ((samples[next] - samples[index]) * (time - times[index])) / span;
}

function attitudeAt(times, attitudes, time) {
  const index = indexAt(times, time);
  const next = index + 1;
  if (next >= times.length || times[next] <= times[index]) return attitudes[index];
  const fraction = Math.max(0, (time - times[index]) / (times[next] - times[index]));
  return slerp(attitudes[index], attitudes[next], fraction);
}
