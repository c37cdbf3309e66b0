"""Cones that bound where boresights point, in plain numpy: the scripts' own geometry.

Attitudes are rows x y z w that map body vectors to reference vectors. Nothing here is slewplan's.
"""

import subprocess
from dataclasses import dataclass

import numpy as np

from legs import quaternion

# What a flown motion may be inside a cone, rad: the service's promise.
PROMISE = 1e-6


@dataclass(frozen=True)
class Cone:
    """A cone about a reference direction that a boresight stays out of, or within."""

    pointer: str
    axis: np.ndarray
    direction: np.ndarray
    half_angle: float
    inside: bool

    def clearance(self, attitudes):
        """Angle to the surface, rad, negative on the wrong side."""
        looks = rotated(attitudes, self.axis)
        across = np.linalg.norm(np.cross(looks, self.direction), axis=-1)
        angle = np.arctan2(across, looks @ self.direction)
        return self.half_angle - angle if self.inside else angle - self.half_angle


def unit(vector):
    vector = np.asarray(vector, float)
    return vector / np.linalg.norm(vector)


def rotated(attitudes, vector):
    """A body vector in reference components, for every row of attitudes."""
    part, scalar = attitudes[..., :3], attitudes[..., 3:]
    twice = 2 * np.cross(part, vector)
    return vector + scalar * twice + np.cross(part, twice)


def product(p, q):
    """Hamilton product."""
    part = p[..., 3:] * q[..., :3] + q[..., 3:] * p[..., :3] + np.cross(p[..., :3], q[..., :3])
    scalar = p[..., 3] * q[..., 3] - np.sum(p[..., :3] * q[..., :3], axis=-1)
    return np.concatenate([part, scalar[..., None]], axis=-1)


def turn(vector):
    """The rotation about a vector by its length, rad."""
    angle = np.linalg.norm(vector)
    return np.append(np.sinc(angle / 2 / np.pi) / 2 * np.asarray(vector, float), np.cos(angle / 2))


def between(start, goal, count):
    """Attitudes of the turn about the eigenaxis by the shorter way."""
    shares = np.linspace(0, 1, count)[:, None]
    goal = goal if start @ goal >= 0 else -goal
    arc = np.arctan2(np.linalg.norm(goal - start), np.linalg.norm(goal + start)) * 2
    if arc < 1e-9:
        return start + shares * (goal - start)
    return (np.sin((1 - shares) * arc) * start + np.sin(shares * arc) * goal) / np.sin(arc)


def attitude(place):
    """That of a start, target or end."""
    return unit(quaternion(place["attitude"]))


def cones(scenario):
    """All cones of a scenario whose directions are vectors."""
    named = {each["name"]: unit(each["axis"]) for each in scenario["spacecraft"].get("boresights", [])}
    return [
        Cone(
            f"/{name}/{index}",
            named[cone["boresight"]],
            unit(cone["direction"]),
            np.radians(cone["half_angle_deg"]),
            name == "keep_in",
        )
        for name in ("keep_out", "keep_in")
        for index, cone in enumerate(scenario.get(name, []))
    ]


def least(limits, attitudes):
    """Least clearance of some attitudes from any of the cones, rad."""
    return min(float(np.min(cone.clearance(attitudes))) for cone in limits)


def all_out(scenario):
    """The same cones as `keep_out` only: within a cone is outside of the opposite one."""
    opposite = [
        {
            **cone,
            "direction": [-component for component in cone["direction"]],
            "half_angle_deg": 180 - cone["half_angle_deg"],
        }
        for cone in scenario.get("keep_in", [])
    ]
    rest = {name: value for name, value in scenario.items() if name != "keep_in"}
    return rest | {"keep_out": scenario.get("keep_out", []) + opposite}


def spelled(program, scenario):
    """The scenario as this program reads it: older ones know `keep_out` only."""
    described = subprocess.run([program, "openapi"], stdout=subprocess.PIPE, check=True, text=True).stdout
    return scenario if "keep_in:" in described else all_out(scenario)


def free(scenario):
    """The same without its cones."""
    return {name: value for name, value in scenario.items() if name not in ("keep_out", "keep_in")}
