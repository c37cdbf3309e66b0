"""Documents that are almost right, and text that is no document: what each is refused with."""

import copy
import json

from questions import KINDS

from generated import places  # noqa: E402
from service import fixture  # noqa: E402

# What stands in the place of a value. Numbers that JSON has and programs do not like are written out.
STRANGE = ["null", "true", '"x"', '""', "[]", "{}", "[1]", "-1", "0", "0.5", "1e-300", "1e300", "1e999", "5e-324", "9007199254740993",
           "[1, 2, 3, 4, 5]", "[0, 0, 0]", '{"x": 1}', '"\\u0000"', "NaN"]
TEXTS = [b"", b"  ", b"{", b"nonsense", b'{"name": "x",}', b"[1 2]", b"{} {}", b"[" * 3000, b"\xff\xfe{}", b'{"name": "\xff"}', b'{"name": NaN}',
         b"[]", b"null", b"7", b'"x"', b"{}", b'{"name": "a", "name": "b"}', b'{"a": 1, "b": 2}', b'{"targets": ' + b"[1," * 900 + b"1" + b"]" * 900 + b"}"]
HOLE = "@hole@"


def replaced(document, path, value):
    document = copy.deepcopy(document)
    parent = document
    for key in path[:-1]:
        parent = parent[key]
    parent[path[-1]] = value
    return document


def spoilt(document):
    """Every value of a document replaced, left out, doubled, renamed or accompanied, one at a time."""
    for path in places(document):
        if not path:
            continue
        name = "/" + "/".join(map(str, path))
        hollow = json.dumps(replaced(document, path, HOLE))
        for strange in STRANGE:
            yield f"{name} = {strange}", hollow.replace(f'"{HOLE}"', strange).encode()
        parent = document
        for key in path[:-1]:
            parent = parent[key]
        less = copy.deepcopy(parent)
        del less[path[-1]]
        more = copy.deepcopy(parent)
        if isinstance(parent, dict):
            more["extra"] = 1
        else:
            more.append(parent[path[-1]])
        for what, changed in (("without", less), ("with more", more)):
            whole = changed if len(path) == 1 else replaced(document, path[:-1], changed)
            yield f"{what} {name}", json.dumps(whole).encode()
        if isinstance(parent, dict):
            member = json.dumps({path[-1]: parent[path[-1]]})[1:-1]
            twice = json.dumps(parent)[:-1] + ", " + member + "}"
            text = twice if len(path) == 1 else json.dumps(replaced(document, path[:-1], HOLE)).replace(f'"{HOLE}"', twice)
            yield f"twice {name}", text.encode()


def full_scenario():
    """A scenario in which everything is given that can be given."""
    document = fixture("two-targets")
    document.update({"epoch": "2026-01-01T00:00:00Z", "time_system": "UTC", "reference_frame": "EME2000"})
    craft = document["spacecraft"]
    craft.update({"max_body_rate_rad_s": [0.04, 0.04, None], "max_body_rate_norm_rad_s": 0.05,
                  "boresights": [{"name": "camera", "axis": [0, 0, 1]}]})
    craft["wheels"][0].update({"min_torque_nm": -0.01, "enabled": True, "normalize_axis": True})
    document["start"].update({"body_rate_rad_s": [0, 0, 0], "wheel_speed_rad_s": [0, 0, 0]})
    document["targets"][0].update({"zero_rate_axes": ["x", "z"], "dwell_s": 0.0, "settle_s": 0.0, "position": 1})
    document["targets"][1].update({"rate_min_rad_s": [None, -0.01, 0], "rate_max_rad_s": [0.01, None, 0], "after": [document["targets"][0]["id"]]})
    document["targets"][1].pop("zero_rate_axes", None)
    document["keep_out"] = [{"boresight": "camera", "direction": [1, 0, 0], "half_angle_deg": 20}]
    document["options"] = {"attitude_equivalence": "rotation", "time_limit_s": 60, "node_limit": 5, "relative_gap": 0.0, "alternatives": 1,
                           "torque_authority": 1.0, "momentum_authority": 1.0, "seed": 0}
    return document


def bodies(plan):
    """What is posted where, before it is spoilt."""
    plain = fixture("two-targets")
    attitudes = [{"quaternion": {"x": 0, "y": 0, "z": 0, "w": 1}}, {"mrp": [0.1, 0, 0.2]}, {"matrix": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]},
                 {"ra_dec_roll_deg": [10, 20, 30], "boresight": [1, 0, 0]}]
    matrix = {"spacecraft": plain["spacecraft"], "attitudes": attitudes, "kind": KINDS[2], "mode": "compute"}
    pairs = {"spacecraft": plain["spacecraft"], "pairs": [{"from": attitudes[0], "to": attitudes[1]}], "mode": "cached_only"}
    small = copy.deepcopy(plan)
    small["trajectory"] = {key: value[:3] for key, value in small["trajectory"].items()}
    # One small step of a study that would take its time.
    authority = fixture("studies/authority")
    authority["authorities"], authority["simulation"]["runs"] = authority["authorities"][:1], 1
    return {
        ("POST", "/v1/plans?validate_only=true"): [full_scenario()],
        ("POST", "/v1/verify"): [{"scenario": plain, "plan": small}],
        ("POST", "/v1/legs/query"): [matrix, pairs],
        ("PUT", "/v1/spacecraft/name"): [plain["spacecraft"]],
        ("POST", "/v1/slews"): [fixture(f"slews/{name}") for name in ("quarter-turn", "olrac-four-wheels")],
        ("POST", "/v1/studies/envelopes"): [fixture("studies/pyramid-envelopes")],
        ("POST", "/v1/studies/authority"): [authority],
        ("POST", "/v1/studies/flight"): [fixture("studies/flight")],
        ("POST", "/v1/studies/comparison"): [{"momenta_nms": [0.1], "surface_rows": 2}],
    }


def everything(plan):
    """Name, method, path and body of every request."""
    for (method, path), documents in bodies(plan).items():
        for text in TEXTS:
            yield f"{method} {path} text {text[:40]}", method, path, text
        for number, document in enumerate(documents):
            for name, body in spoilt(document):
                yield f"{method} {path} {number} {name}", method, path, body
