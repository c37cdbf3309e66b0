#!/usr/bin/env python3
"""Slews of ordinary spacecraft, with momentum in their wheels and a rate limit, beside CasADi and IPOPT.

Four families (three orthogonal wheels, a pyramid, four large wheels on a body of tonnes, five wheels
in random directions), limits of 0.1 to 1 degree a second, stored momentum of 5 to 70 % of what the
wheels hold in every direction, rest to rest; and the spacecraft of fixtures/gallery, from their start to
each of their targets at rest. Durations are compared with the peer of general.py on
100 intervals, the best of three starts; the time of a leg, with all its starts and its flight, with
one start of the peer on 40 intervals.

    cargo build --release
    python3 tests/peers/ordinary.py [SLEWS-PER-CASE [SHARE]]

SHARE n runs every nth slew of the families. Prints a line for each slew and the figures of all; ends with code 1 when
a slew is not solved or slower than the peer by more than 0.2 %.
"""

import itertools
import json
import os
import subprocess
import sys
import time

import environment

environment.enter()

import numpy as np  # noqa: E402
from general import by_peer, posed  # noqa: E402
from slewplan import FIXTURES  # noqa: E402

LIMITS_DEG_S = (0.1, 0.2, 0.5, 1.0)
MOMENTA = (0.05, 0.15, 0.3, 0.5, 0.7)
WORST_RATIO = 1.002
BODY = [[100, 3, 2], [3, 120, -4], [2, -4, 80]]


def pyramid(count, height):
    turns = 2 * np.pi * np.arange(count) / count
    return np.c_[np.cos(turns), np.sin(turns), np.full(count, height)]


def family(name, generator):
    """Inertia, axes as rows, and momentum, torque and speed of each wheel."""
    if name == "orthogonal":
        return BODY, np.eye(3), (4.0, 0.1, 600.0)
    if name == "pyramid":
        return BODY, pyramid(4, np.sqrt(0.5)), (4.0, 0.1, 600.0)
    if name == "tonnes":
        inertia = [[2500, 60, -30], [60, 1800, 20], [-30, 20, 2900]]
        return inertia, pyramid(4, np.sqrt(0.5)), (80.0, 0.16, 400.0)
    while True:
        axes = generator.normal(size=(5, 3))
        axes /= np.linalg.norm(axes, axis=1)[:, None]
        if np.linalg.svd(axes)[1][-1] > 0.8:
            break
    moments = np.sort(generator.uniform(8, 20, 3))
    moments[2] = min(moments[2], 0.9 * (moments[0] + moments[1]))
    turn = np.linalg.qr(generator.normal(size=(3, 3)))[0]
    inertia = turn @ np.diag(moments) @ turn.T
    return ((inertia + inertia.T) / 2).tolist(), axes, (1.0, 0.025, 650.0)


def held_everywhere(axes, momentum):
    """Momentum, N m s, that the wheels hold in every direction: the least width of their zonotope."""
    widths = []
    for one, other in itertools.combinations(axes, 2):
        across = np.cross(one, other)
        if np.linalg.norm(across) > 1e-9:
            widths.append(np.abs(axes @ across).sum() * momentum / np.linalg.norm(across))
    return min(widths)


def slews(per_case):
    """The slews as scenarios."""
    generator = np.random.default_rng(19)
    names = ("orthogonal", "pyramid", "tonnes", "random")
    for name, limit, share, number in itertools.product(names, LIMITS_DEG_S, MOMENTA, range(per_case)):
        inertia, axes, (momentum, torque, speed) = family(name, generator)
        axes = axes / np.linalg.norm(axes, axis=1)[:, None]
        while True:
            stored = generator.normal(size=3)
            stored *= share * held_everywhere(axes, momentum) / np.linalg.norm(stored)
            wheels = np.linalg.pinv(axes.T) @ stored
            if np.abs(wheels).max() < 0.98 * momentum:
                break
        axis, angle = generator.normal(size=3), generator.uniform(0.3, np.pi)
        vector = np.sin(angle / 2) * axis / np.linalg.norm(axis)
        yield {
            "name": f"{name}, {limit} deg/s, {share:.0%}, {number}",
            "spacecraft": {
                "inertia_kg_m2": inertia,
                "max_body_rate_rad_s": [float(np.radians(limit))] * 3,
                "wheels": [
                    {"axis": list(map(float, axis)), "inertia_kg_m2": momentum / speed,
                     "max_torque_nm": torque, "max_speed_rad_s": speed}
                    for axis in axes
                ],
            },
            "start": {
                "attitude": {"quaternion": {"x": 0, "y": 0, "z": 0, "w": 1}},
                "wheel_speed_rad_s": list(map(float, wheels * speed / momentum)),
            },
            "targets": [{"id": "there", "attitude": {"quaternion": dict(
                zip("xyzw", map(float, [*vector, np.cos(angle / 2)])))}}],
        }


def gallery():
    """The slews from the start of each spacecraft of the gallery to its targets."""
    for path in sorted((FIXTURES / "gallery").glob("*.json")):
        scenario = json.loads(path.read_text(encoding="utf-8"))
        for target in scenario.pop("targets"):
            resting = {"id": target["id"], "attitude": target["attitude"]}
            yield {**scenario, "name": f"{path.stem}, {target['id']}", "targets": [resting]}


def by_slewplan(binary, slew):
    """The leg from start to target with free wheels at its end, as the tables of a plan have it."""
    run = subprocess.run(
        [binary, "legs", "-", "--kind", "lower_bound", "--shard", "1/2", "--threads", "1",
         "--progress", "none"],
        input=json.dumps(slew), capture_output=True, text=True, check=False,
    )
    if run.returncode != 0:
        sys.exit(f"{slew['name']}: slewplan ended with {run.returncode}: {run.stderr}")
    return json.loads(run.stdout)["legs"][0]


def main(per_case, share):
    binary = os.environ.get("SLEWPLAN", "target/release/slewplan")
    ratios, mine_ms, peer_ms, failed = [], [], [], 0
    families = itertools.islice(slews(per_case), 0, None, share)
    for slew in itertools.chain(families, gallery()):
        leg = by_slewplan(binary, slew)
        peer, _ = by_peer(slew, 100, 3)
        model, asked = posed(slew)
        begin = time.perf_counter()
        model.best(*asked, np.random.default_rng(0), 1)
        peer_ms.append(1e3 * (time.perf_counter() - begin))
        mine_ms.append(1e3 * leg["solve_time_s"])
        if leg["status"] != "converged":
            failed += 1
            print(f"{slew['name']}: {leg['status']}, peer {peer:.3f} s", flush=True)
            continue
        ratios.append(leg["duration_s"] / peer)
        print(
            f"{slew['name']}: {leg['duration_s']:.3f} s, peer {peer:.3f} s, ratio {ratios[-1]:.5f}, "
            f"{mine_ms[-1]:.1f} ms, peer {peer_ms[-1]:.0f} ms", flush=True,
        )
    print(
        f"{len(mine_ms)} slews, {failed} not solved: worst ratio {max(ratios):.5f}, median "
        f"{np.median(ratios):.5f}; mean time {np.mean(mine_ms):.1f} ms against "
        f"{np.mean(peer_ms):.0f} ms, one {np.mean(peer_ms) / np.mean(mine_ms):.1f}th"
    )
    return failed > 0 or max(ratios) > WORST_RATIO


if __name__ == "__main__":
    counts = [int(count) for count in sys.argv[1:3]]
    sys.exit(int(main(*(counts + [2, 1][len(counts):]))))
