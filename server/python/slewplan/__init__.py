"""Minimum-time attitude plans for spacecraft with reaction wheels.

`solve`, `plot` and `run` use the program that is installed with this module; `Client` uses a service.
"""

from .client import (
    ENDED,
    OPERATIONS,
    Client,
    Control,
    FlownState,
    Format,
    Job,
    Leg,
    LegQuery,
    LegTable,
    LegTableJob,
    LegTime,
    Passage,
    Plan,
    Problem,
    Quaternion,
    Refused,
    Scenario,
    State,
    Trajectory,
    Verification,
)
from .program import Failed, plot, program, run, solve

__all__ = [
    "ENDED",
    "OPERATIONS",
    "Client",
    "Control",
    "Failed",
    "FlownState",
    "Format",
    "Job",
    "Leg",
    "LegQuery",
    "LegTable",
    "LegTableJob",
    "LegTime",
    "Passage",
    "Plan",
    "Problem",
    "Quaternion",
    "Refused",
    "Scenario",
    "State",
    "Trajectory",
    "Verification",
    "plot",
    "program",
    "run",
    "solve",
]
