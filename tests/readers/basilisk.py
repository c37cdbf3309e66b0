#!/usr/bin/env python3
"""Plans flown by Basilisk, and waypoints read by it.

    python3 tests/readers/basilisk.py [FIXTURE...]

Installs Basilisk (`bsk`) from PyPI first where it is not there (READERS_BASILISK_VENV names another
place). For every scenario the plan's torques drive Basilisk's spacecraft with its reaction wheel
effector, from the scenario's start on; nothing is put right on the way. At the end and at every
state of the plan, attitude, rate and wheel speeds are compared. The same plan as waypoints goes
through Basilisk's `waypointReference`. Without fixtures, experiment C with a Sun that a camera must not
see is flown too, and the attitudes that Basilisk's spacecraft reports on the way have to be clear of it.
SLEWPLAN names a built binary.
"""

import sys

from common import Environment, Files, Judge, binary

SCENARIOS = [
    "olivares-a",
    "olivares-b",
    "pyramid-momentum-bias",
    "quarter-turn",
    "gallery/cubesat-6u",
    "gallery/telescope-2t",
]
# Longest step of Basilisk's fourth-order Runge-Kutta integrator, ns.
STEP_NS = 50_000_000
# Times at which waypoints are compared.
LOOKS = 200
# The Sun of experiment C: the plan without it comes within a degree of its centre.
CAMERA, SUN, HALF_ANGLE_DEG = [1.0, 0.0, 0.0], [-0.822, -0.481, 0.305], 30.0
# Deepest intrusion, rad: the promise, and as much again for the time between two reports.
INTRUSION = 2e-6
BASILISK = Environment("basilisk", ("bsk==2.12.1",), ("Basilisk",), "READERS_BASILISK_VENV")


def nanoseconds(seconds):
    return round(seconds * 1e9)


def scalar_first(quaternion):
    """A row x y z w, or an object, as Basilisk's Euler parameters."""
    if isinstance(quaternion, dict):
        quaternion = [quaternion[name] for name in "xyzw"]
    return np.roll(np.array(quaternion, float), 1)


def angle(matrix, sigma):
    """Angle between an attitude as a matrix and one as modified Rodrigues parameters, rad."""
    return np.linalg.norm(rbk.MRP2C(np.array(sigma)) @ matrix.T - np.eye(3)) / np.sqrt(2)


class Craft:
    """The scenario's spacecraft in Basilisk."""

    def __init__(self, model, first):
        self.sim = SimulationBaseClass.SimBaseClass()
        process = self.sim.CreateNewProcess("process")
        process.addTask(self.sim.CreateNewTask("task", STEP_NS))
        craft = model["spacecraft"]
        self.body = spacecraft.Spacecraft()
        # Basilisk wants a mass; without forces it does not matter.
        self.body.hub.mHub = 100.0
        self.body.hub.r_BcB_B = [[0.0], [0.0], [0.0]]
        self.body.hub.IHubPntBc_B = craft["inertia_kg_m2"]
        parameters = scalar_first(first["quaternion"])
        self.body.hub.sigma_BNInit = rbk.EP2MRP(parameters).reshape(3, 1).tolist()
        self.body.hub.omega_BN_BInit = [[rate] for rate in first["body_rate_rad_s"]]
        self.wheels = reactionWheelStateEffector.ReactionWheelStateEffector()
        factory = simIncludeRW.rwFactory()
        for wheel, speed in zip(craft["wheels"], first["wheel_speed_rad_s"]):
            # Without limits: the plan's own are to be seen.
            made = factory.create("custom", wheel["axis"], Js=wheel["inertia_kg_m2"], useMaxTorque=False)
            made.Omega, made.Omega_max = speed, -1.0
        factory.addToSpacecraft("wheels", self.wheels, self.body)
        self.command = messaging.ArrayMotorTorqueMsg()
        self.wheels.rwMotorCmdInMsg.subscribeTo(self.command)
        self.sim.AddModelToTask("task", self.wheels)
        self.sim.AddModelToTask("task", self.body)
        self.now, self.reports = 0, []
        self.drive([0.0] * len(craft["wheels"]))
        self.sim.InitializeSimulation()

    def drive(self, torques):
        """Motor torques on the wheels, N m, from now on."""
        payload = messaging.ArrayMotorTorqueMsgPayload()
        payload.motorTorque = list(torques)
        self.command.write(payload, self.now)

    def fly(self, until):
        """Integrates to a time, ns, in equal steps."""
        parts = -(-(until - self.now) // STEP_NS)
        begin = self.now
        for part in range(1, parts + 1):
            self.wheels.UpdateState(self.now)
            self.now = begin + (until - begin) * part // parts
            self.body.UpdateState(self.now)
            self.reports.append(self.body.scStateOutMsg.read().sigma_BN)

    def state(self):
        """Attitude as modified Rodrigues parameters, rates rad/s, wheel speeds rad/s."""
        manager = self.body.dynManager
        sigma = np.ravel(manager.getStateObject(self.body.hub.nameOfHubSigma).getState())
        rate = np.ravel(manager.getStateObject(self.body.hub.nameOfHubOmega).getState())
        speed = np.ravel(manager.getStateObject("reactionWheelOmegas").getState())
        return sigma, rate, speed


def flown(files, judge, name):
    """The plan's torques through Basilisk's dynamics."""
    model, plan = files.model(), files.plan()
    states, controls = plan["trajectory"]["states"], plan["trajectory"]["controls"]
    craft = Craft(model, states[0])
    scale = np.array([wheel["max_speed_rad_s"] for wheel in model["spacecraft"]["wheels"]])
    moments = sorted(
        [(nanoseconds(control["start_s"]), 1, control) for control in controls]
        + [(nanoseconds(state["time_s"]), 0, state) for state in states],
        key=lambda moment: moment[:2],
    )
    worst = np.zeros(3)
    for time, kind, what in moments:
        craft.fly(time)
        if kind == 1:
            craft.drive(what["wheel_torque_nm"])
            continue
        sigma, rate, speed = craft.state()
        matrix = rbk.EP2C(scalar_first(what["quaternion"]))
        last = np.array(
            [
                angle(matrix, sigma),
                np.abs(rate - what["body_rate_rad_s"]).max(),
                (np.abs(speed - what["wheel_speed_rad_s"]) / scale).max(),
            ]
        )
        worst = np.maximum(worst, last)
    end = model.get("end")
    if end and "quaternion" in end["attitude"]:
        demanded = rbk.EP2C(scalar_first(end["attitude"]["quaternion"]))
        judge.compare(f"{name}: demanded end attitude", angle(demanded, sigma), 1e-4, "rad")
    for label, figures in [("at the end", last), ("worst of all states", worst)]:
        judge.compare(f"{name}: attitude {label}", figures[0], 1e-4, "rad")
        judge.compare(f"{name}: body rate {label}", figures[1], 1e-6, "rad/s")
        judge.compare(f"{name}: wheel speed {label}", figures[2], 1e-3, "of the limit")
    return craft


def off_the_sun(sigma):
    """Angle between the camera and the cone's surface, rad."""
    seen = rbk.MRP2C(np.array(sigma)) @ (np.array(SUN) / np.linalg.norm(SUN))
    return np.arctan2(np.linalg.norm(np.cross(seen, CAMERA)), seen @ CAMERA) - np.radians(HALF_ANGLE_DEG)


def sunlit(program, judge):
    """Experiment C with a Sun: what Basilisk reports on the way."""
    name, base = "olivares-c with a Sun", "olivares-c"
    without = Files.of(program, base)
    craft = without.model()["spacecraft"] | {"boresights": [{"name": "camera", "axis": CAMERA}]}
    cone = {"boresight": "camera", "direction": SUN, "half_angle_deg": HALF_ANGLE_DEG}
    rows = [state["quaternion"] for state in without.plan()["trajectory"]["states"]]
    nearest = min(off_the_sun(rbk.EP2MRP(scalar_first(row))) for row in rows)
    judge.demand(f"{name}: in the way of the plan without it", nearest < -np.radians(5))
    files = Files.of(program, base, {"spacecraft": craft, "keep_out": [cone]})
    reports = flown(files, judge, name).reports
    nearest = min(map(off_the_sun, reports))
    judge.demand(f"{name}: {len(reports)} reports", len(reports) > files.plan()["total_time_s"] * 1e9 / STEP_NS)
    judge.compare(f"{name}: deepest reported intrusion", max(0.0, -nearest), INTRUSION, "rad")
    print(f"     {name}: clear by {np.degrees(nearest):.6f} deg", flush=True)


def referenced(files, judge, name):
    """The waypoints through `waypointReference`, between and at the lines."""
    module = waypointReference.WaypointReference()
    module.dataFileName = str(files.export("basilisk"))
    module.attitudeType, module.useReferenceFrame = 2, True
    sim = SimulationBaseClass.SimBaseClass()
    sim.CreateNewProcess("process").addTask(sim.CreateNewTask("task", STEP_NS))
    sim.AddModelToTask("task", module)
    sim.InitializeSimulation()
    total = files.plan()["total_time_s"]
    truth = files.table("--step", f"{total / LOOKS:.9f}")
    worst = np.zeros(2)
    for row in truth[:-1]:
        module.UpdateState(nanoseconds(row[0]))
        told = module.attRefOutMsg.read()
        matrix = rbk.EP2C(scalar_first(row[1:5]))
        # The message has the rate in the inertial frame.
        rate = matrix @ np.array(told.omega_RN_N)
        found = [angle(matrix, told.sigma_RN), np.abs(rate - row[5:8]).max()]
        worst = np.maximum(worst, found)
    judge.demand(f"{name}: waypoints looked at {len(truth) - 1} times", len(truth) > LOOKS)
    judge.compare(f"{name}: attitude of waypointReference", worst[0], 2e-5, "rad")
    judge.compare(f"{name}: rate of waypointReference", worst[1], 2e-5, "rad/s")


def golden(judge, sigma):
    """Annex F of the standard: a frame turned by +90 degrees about z sees (1, 0, 0) as (0, -1, 0)."""
    seen = rbk.MRP2C(np.array(sigma)) @ [1.0, 0.0, 0.0]
    judge.compare("annex F: (1, 0, 0) seen as (0, -1, 0)", np.abs(seen - [0, -1, 0]).max(), 1e-6, "")


def main():
    program, judge = str(binary()), Judge()
    for name in sys.argv[1:] or SCENARIOS:
        files = Files.of(program, name)
        sigma = flown(files, judge, name).state()[0]
        referenced(files, judge, name)
        if name == "quarter-turn":
            golden(judge, sigma)
    if not sys.argv[1:]:
        sunlit(program, judge)
    judge.end()


if __name__ == "__main__":
    BASILISK.enter()
    import numpy as np
    from Basilisk.architecture import messaging
    from Basilisk.fswAlgorithms import waypointReference
    from Basilisk.simulation import reactionWheelStateEffector, spacecraft
    from Basilisk.utilities import RigidBodyKinematics as rbk
    from Basilisk.utilities import SimulationBaseClass, simIncludeRW

    main()
