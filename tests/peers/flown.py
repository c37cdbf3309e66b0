"""slewplan's plans of scenarios with cones, judged by the scripts' own integration."""

import json
import os
import subprocess
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from cones import PROMISE, attitude, cones, spelled
from motion import fly, least_clearance
from slewplan import PLANNED

# What our integration and the numbers of a plan leave open beside the promise, rad.
FLOOR = 1e-8
# How far a flight may miss its goal by the integration, rad.
MOST_MISS = 1e-5


@dataclass
class Run:
    """A process `slewplan solve`, and what became of its plan."""

    code: int
    said: str
    wall: float
    cpu: float
    plan: dict | None = None
    # By cone: least clearance, rad, and its time, s.
    clearances: list = field(default_factory=list)
    miss: float = 0.0
    verified: bool = False

    @property
    def planned(self):
        return self.plan is not None

    @property
    def duration(self):
        return self.plan["total_time_s"] if self.plan else None

    @property
    def clearance(self):
        """The least of all cones, rad."""
        return min((angle for angle, _ in self.clearances), default=np.inf)

    @property
    def clear(self):
        return self.planned and self.clearance >= -PROMISE - FLOOR and self.miss < MOST_MISS

    def complaint(self):
        """What is wrong with it, as text; empty when nothing is."""
        if not self.planned:
            return f"ended with {self.code}: {self.said.strip()[:300]}"
        found = [] if self.clear else [
            f"clearance {np.degrees(self.clearance):.6f} deg, goal missed by {self.miss:.1e} rad"
        ]
        return "; ".join(found + ([] if self.verified else ["verify: not passed"]))


def answered(line):
    """Code, what it said on standard error, and seconds on the clock and of processors."""
    with tempfile.TemporaryFile() as errors:
        begin = time.perf_counter()
        process = subprocess.Popen(line, stdout=subprocess.DEVNULL, stderr=errors)
        # The resources of this one process, whatever others run at the same time.
        _, status, used = os.wait4(process.pid, 0)
        wall = time.perf_counter() - begin
        process.returncode = os.waitstatus_to_exitcode(status)
        errors.seek(0)
        said = errors.read().decode(errors="replace")
    return process.returncode, said, wall, used.ru_utime + used.ru_stime


def ends(scenario):
    """The last attitude of a plan: that of `end`, or of its only target."""
    return attitude(scenario.get("end") or scenario["targets"][-1])


def run(program, scenario, *arguments, limits=None, judge=True):
    """Solves, integrates and verifies; `limits` are judged in place of the scenario's cones."""
    with tempfile.TemporaryDirectory() as folder:
        given, answer = Path(folder, "scenario.json"), Path(folder, "plan.json")
        given.write_text(json.dumps(spelled(program, scenario)), encoding="utf-8")
        line = [program, "solve", given, "-o", answer, "--progress", "none", *arguments]
        found = Run(*answered(line))
        if found.code not in PLANNED:
            return found
        found.plan = json.loads(answer.read_text(encoding="utf-8"))
        if not judge:
            return found
        found.verified = answered([program, "verify", given, answer, "--strict"])[0] == 0
    times, states = fly(scenario, found.plan)
    limits = cones(scenario) if limits is None else limits
    found.clearances = [least_clearance(cone, times, states) for cone in limits]
    if scenario.get("end") or len(scenario["targets"]) == 1:
        reached = states[-1, :4] / np.linalg.norm(states[-1, :4])
        sign = 1 if reached @ ends(scenario) >= 0 else -1
        found.miss = 2 * np.linalg.norm(reached - sign * ends(scenario))
    return found
