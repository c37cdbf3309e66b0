//! Examples that are really answered with success.

use crate::documents::{document, legs};
use serde_json::{Value, json};

fn parsed(text: &str) -> Value {
    serde_json::from_str(text).expect("an embedded fixture is JSON")
}

/// A small scenario with most features.
pub(in crate::api) fn two_targets() -> Value {
    parsed(include_str!("../../../../tests/fixtures/two-targets.json"))
}

/// The published experiment A.
pub(in crate::api) fn experiment_a() -> Value {
    parsed(include_str!("../../../../tests/fixtures/olivares-a.json"))
}

/// The spacecraft of the published experiments.
pub(in crate::api) fn spacecraft() -> Value {
    experiment_a()["spacecraft"].take()
}

/// A query for a full matrix.
pub(in crate::api) fn leg_matrix() -> Value {
    json!({
        "spacecraft": spacecraft(),
        "attitudes": [
            {"roll_pitch_yaw_deg": [0, 0, 0]},
            {"roll_pitch_yaw_deg": [15, 0, 10]},
            {"roll_pitch_yaw_deg": [25, 0, 50]},
        ],
        "kind": "rest_to_rest",
        "mode": "compute",
    })
}

/// A query for one leg.
pub(in crate::api) fn leg_pair() -> Value {
    json!({
        "spacecraft": spacecraft(),
        "pairs": [{
            "from": {"roll_pitch_yaw_deg": [15, 0, 10]},
            "to": {"quaternion": {"x": 0, "y": 0, "z": 0, "w": 1}},
        }],
        "mode": "cached_only",
    })
}

/// A file of legs whose run had nothing to solve.
pub(in crate::api) fn leg_file() -> Value {
    let scenario = json!({
        "spacecraft": spacecraft(),
        "start": {"attitude": {"roll_pitch_yaw_deg": [0, 0, 0]}},
        "targets": [{"id": "a", "attitude": {"roll_pitch_yaw_deg": [15, 0, 10]}}],
    });
    let node = document::parse(scenario.to_string().as_bytes());
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "kind": "rest_to_rest",
        "scenario_key": legs::scenario_key(&node.expect("an example is JSON")),
        "shard": {"index": 1, "of": 1},
        "complete": true,
        "scenario": scenario,
        "legs": [],
        "trajectories": [],
    })
}

/// Two pairs of shares, a few flights each.
pub(in crate::api) fn authority_study() -> Value {
    json!({
        "scenario": two_targets(),
        "simulation": {"errors": {"inertia_3_sigma": 0.02}, "runs": 20},
        "authorities": [
            {"torque_authority": 1.0, "momentum_authority": 1.0},
            {"torque_authority": 0.95, "momentum_authority": 0.95},
        ],
    })
}

/// A quarter turn in all its ways, and a torque that only two wheels of three are for.
pub(in crate::api) fn envelope_study() -> Value {
    json!({
        "spacecraft": spacecraft(),
        "turns": [{
            "from": {"roll_pitch_yaw_deg": [0, 0, 0]},
            "to": {"roll_pitch_yaw_deg": [0, 0, 90]},
        }],
        "demands_nm": [[0.01, 0.005, 0.0]],
        "time_optimal": true,
    })
}

/// The published study for one size, in few slews and coarse surfaces.
pub(in crate::api) fn comparison_study() -> Value {
    json!({
        "momenta_nms": [0.01],
        "angles_rad": [0.1, 0.5, 1.0, 2.0, 3.0],
        "radii": {"kind": "computed"},
        "surface_rows": 4,
    })
}

/// A flight with an inertia that is not quite as believed.
pub(in crate::api) fn flight_study() -> Value {
    json!({
        "scenario": two_targets(),
        "simulation": {"errors": {"inertia_3_sigma": 0.02}, "seed": 1},
        "keep_every": 10,
    })
}

/// A quarter turn.
pub(in crate::api) fn quarter_slew() -> Value {
    parsed(include_str!(
        "../../../../tests/fixtures/slews/quarter-turn.json"
    ))
}

/// A quarter turn for time and effort.
pub(in crate::api) fn effort_sweep() -> Value {
    json!({
        "spacecraft": spacecraft(),
        "start": {"attitude": {"roll_pitch_yaw_deg": [0, 0, 0]}},
        "end": {"attitude": {"roll_pitch_yaw_deg": [0, 0, 90]}},
        "objective": {"kind": "time_and_effort"},
        "command": {"kind": "smooth", "intervals": 20},
        "sweep": {"weights": [10_000.0, 100_000.0, 1_000_000.0]},
    })
}

/// A plan that does nothing for a second, and so misses its target: the verification says so.
pub(in crate::api) fn verify_request() -> Value {
    let scenario = json!({
        "spacecraft": spacecraft(),
        "start": {"attitude": {"roll_pitch_yaw_deg": [0, 0, 0]}},
        "targets": [{"id": "a", "attitude": {"roll_pitch_yaw_deg": [15, 0, 10]}}],
    });
    let plan = json!({
        "total_time_s": 1.0,
        "sequence": ["a"],
        "passages": [{"target": "a", "time_s": 1.0, "departure_s": 1.0}],
        "trajectory": {
            "controls": [{"start_s": 0.0, "duration_s": 1.0, "wheel_torque_nm": [0.0, 0.0, 0.0]}],
        },
    });
    json!({"scenario": scenario, "plan": plan})
}
