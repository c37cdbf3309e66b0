#!/usr/bin/env python3
"""Relations between the plans of related scenarios, for scenarios that nobody has chosen.

    python3 tests/relations/run.py [--seeds FIRST END] [--targets MOST] [--time-limit S]

The program is that of $SLEWPLAN, or one built now.

What must not change a plan's duration: another frame of reference, other orders of the targets and of the
wheels, windows that are always open, a latest end far away. What must not make it longer: no cones, no
limits of the rate. What must not make it shorter: rest at every target. And a plan must not be longer than
its own legs from rest to rest, unless rolls or cones make those another problem.

Programs are solved locally, so differences up to ACCEPTED are told and not judged; with free rolls all are.
"""

import argparse
import copy
import math
import random
import sys
from pathlib import Path

from scenarios import Generator, quaternion, unit

sys.path.append(str(Path(__file__).resolve().parents[1] / "peers"))
import slewplan  # noqa: E402

# Exit codes with a plan, or with the reasons why there is none.
ANSWERED = (0, 1, 3, 4)
# Relative differences that are told, and those that fail.
TOLD, ACCEPTED = 1e-3, 2e-2
ALWAYS_S = 1e7
FREE_RATES = ("zero_rate_axes", "rate_min_rad_s", "rate_max_rad_s")
RATE_LIMITS = ("max_body_rate_rad_s", "max_body_rate_norm_rad_s")


def product(p, q):
    x, y, z, w = p
    a, b, c, d = q
    return [w * a + x * d + y * c - z * b, w * b - x * c + y * d + z * a, w * c + x * b - y * a + z * d, w * d - x * a - y * b - z * c]


def turned(rotation, vector):
    x, y, z, w = rotation
    return product(product(rotation, [*vector, 0]), [-x, -y, -z, w])[:3]


def in_another_frame(scenario, state):
    rotation = unit(state, 4)
    for place in [scenario["start"], *([scenario["end"]] if "end" in scenario else []), *scenario["targets"]]:
        if "attitude" in place:
            place["attitude"] = quaternion(product(rotation, list(place["attitude"]["quaternion"].values())))
        else:
            # Rolls are measured from the north of the frame.
            if "roll_min_deg" in place["pointing"]:
                return False
            place["pointing"]["direction"] = turned(rotation, place["pointing"]["direction"])
    for cone in scenario.get("keep_out", []):
        cone["direction"] = turned(rotation, cone["direction"])
    return True


def with_targets_in_another_order(scenario, state):
    state.shuffle(scenario["targets"])
    return True


def with_wheels_in_another_order(scenario, state):
    order = list(range(len(scenario["spacecraft"]["wheels"])))
    state.shuffle(order)
    for of, field in ((scenario["spacecraft"], "wheels"), (scenario["start"], "wheel_speed_rad_s")):
        if field in of:
            of[field] = [of[field][number] for number in order]
    return True


def with_open_windows(scenario, _):
    for target in scenario["targets"]:
        target["windows"] = [{"from_s": 0, "to_s": ALWAYS_S}]
    return True


def with_a_late_end(scenario, _):
    scenario["latest_end_s"] = ALWAYS_S
    return True


def without_cones(scenario, _):
    return scenario.pop("keep_out", None) is not None


def without_rate_limits(scenario, _):
    return any([scenario["spacecraft"].pop(field, None) is not None for field in RATE_LIMITS])


def at_rest(scenario, _):
    fields = [target.pop(field, None) is not None for target in scenario["targets"] for field in FREE_RATES]
    return any(fields)


# Relations, and the sign of the difference that breaks them; 0 for both.
RELATIONS = [
    (in_another_frame, 0),
    (with_targets_in_another_order, 0),
    (with_wheels_in_another_order, 0),
    (with_open_windows, 0),
    (with_a_late_end, 0),
    (without_cones, 1),
    (without_rate_limits, 1),
    (at_rest, -1),
]


def plan_of(program, scenario):
    """The plan, or the answer that says why there is none."""
    plan, _ = slewplan.run(program, "solve", scenario, (), ANSWERED)
    return plan


def services_s(scenario):
    return sum(target.get(field, 0) for target in scenario["targets"] for field in ("dwell_s", "settle_s"))


def difference(sign, ratio):
    """By how much a relation is broken; negative where it is kept with room to spare."""
    excess = ratio - 1
    return abs(excess) if sign == 0 else sign * excess


def has_rolls(scenario):
    return any("pointing" in target for target in scenario["targets"])


def broken(scenario, plan, program, seed):
    """By how much every relation that applies is broken, and the other plan."""
    if not (has_rolls(scenario) or "keep_out" in scenario or "body_rate_rad_s" in scenario["start"]):
        stopping = [leg["rest_to_rest_duration_s"] for leg in plan["legs"]]
        if None not in stopping:
            yield "its legs from rest to rest", difference(1, plan["total_time_s"] / (sum(stopping) + services_s(scenario))), plan
    for change, sign in RELATIONS:
        related = copy.deepcopy(scenario)
        if change(related, random.Random(seed)):
            other = plan_of(program, related)
            total = other.get("total_time_s")
            ratio = total / plan["total_time_s"] if total else math.inf
            yield change.__name__.replace("_", " "), difference(sign, ratio), other


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", nargs=2, type=int, default=[0, 20], metavar=("FIRST", "END"))
    parser.add_argument("--targets", type=int, default=5)
    parser.add_argument("--time-limit", type=float, default=20.0)
    options = parser.parse_args()
    program, table, failures, planned = slewplan.binary(), {}, [], 0
    for seed in range(*options.seeds):
        scenario = Generator(seed).scenario(options.targets)
        scenario["options"] = {"time_limit_s": options.time_limit}
        plan = plan_of(program, scenario)
        if plan["status"] == "failed":
            failures.append(f"seed {seed}: {plan['reasons']}")
        if plan["status"] != "optimal":
            continue
        planned += 1
        rolls = has_rolls(scenario)
        for name, excess, other in broken(scenario, plan, program, seed):
            table.setdefault(name, []).append(excess)
            if excess > TOLD:
                print(f"    seed {seed}: {name}: {100 * excess:.2f} %, {other['status']}{', free rolls' if rolls else ''}", flush=True)
            if not math.isfinite(excess) or excess > ACCEPTED and not rolls:
                failures.append(f"seed {seed}: {name}: {100 * excess:.2f} %, {other['status']}")
    print(f"{planned} of {options.seeds[1] - options.seeds[0]} scenarios planned and proved\n")
    print(f"{'relation':32} {'pairs':>6} {'told':>5} {'worst, %':>9}")
    for name, excesses in table.items():
        print(f"{name:32} {len(excesses):6} {sum(e > TOLD for e in excesses):5} {100 * max(excesses):9.3f}")
    for failure in failures:
        print(f"FAIL {failure}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
