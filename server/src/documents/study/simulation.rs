//! Reading how a plan is flown: control law, clocks, drives, errors.

use crate::documents::drives;
use crate::documents::reader::{Cursor, Fields};
use slewplan_solver::simulation::{
    ControllerSpec, ErrorsSpec, FeedForwardMode, GainsSpec, PidGainsSpec, SimulationSpec,
};

/// Damping where none is given.
const DEFAULT_DAMPING: f64 = 0.7;

/// Reads a simulation; what is left out has its usual value.
pub(super) fn read(cursor: &Cursor<'_>) -> SimulationSpec {
    let known = &[
        "controller",
        "feed_forward",
        "on_board_rate_hz",
        "wheel_loop_rate_hz",
        "delay_samples",
        "settle_s",
        "max_step_s",
        "drives",
        "errors",
        "seed",
        "runs",
        "tolerance_deg",
    ];
    let Some(fields) = cursor.object(known) else {
        return SimulationSpec::default();
    };
    let number = |name| fields.optional(name).and_then(|it| it.number());
    let count = |name| {
        let asked = fields.optional(name).and_then(|it| it.integer());
        asked.map(|count| usize::try_from(count).unwrap_or(usize::MAX))
    };
    let ways = [
        ("averaged", FeedForwardMode::Averaged),
        ("time_tagged", FeedForwardMode::TimeTagged),
    ];
    SimulationSpec {
        controller: fields
            .optional("controller")
            .and_then(|it| controller(&it))
            .unwrap_or_default(),
        feed_forward: fields
            .optional("feed_forward")
            .and_then(|it| it.choice(&ways)),
        on_board_rate_hz: number("on_board_rate_hz"),
        wheel_loop_rate_hz: number("wheel_loop_rate_hz"),
        delay_samples: count("delay_samples"),
        settle_s: number("settle_s"),
        max_step_s: number("max_step_s"),
        drives: fields
            .optional("drives")
            .map(|it| drives::read(&it))
            .unwrap_or_default(),
        errors: fields
            .optional("errors")
            .map(|it| errors(&it))
            .unwrap_or_default(),
        seed: fields.optional("seed").and_then(|it| it.integer()),
        runs: count("runs"),
        tolerance_deg: number("tolerance_deg"),
    }
}

fn controller(cursor: &Cursor<'_>) -> Option<ControllerSpec> {
    const KINDS: [(&str, usize); 4] = [
        ("feed_forward", 0),
        ("quaternion", 1),
        ("step_input", 2),
        ("geometric_pid", 3),
    ];
    let kind = cursor.kind(&KINDS)?;
    let known: &[&str] = match kind {
        0 => &["kind"],
        3 => &["kind", "gains", "anti_windup"],
        _ => &["kind", "gains", "gyroscopic"],
    };
    let fields = cursor.object(known)?;
    let gyroscopic = fields.optional("gyroscopic").and_then(|it| it.boolean());
    let gyroscopic = gyroscopic.unwrap_or(false);
    Some(match kind {
        0 => ControllerSpec::FeedForward,
        1 => ControllerSpec::Quaternion {
            gains: gains(&fields.required("gains")?)?,
            gyroscopic,
        },
        2 => ControllerSpec::StepInput {
            gains: gains(&fields.required("gains")?)?,
            gyroscopic,
        },
        _ => ControllerSpec::GeometricPid {
            gains: pid_gains(&fields.required("gains")?)?,
            anti_windup: fields
                .optional("anti_windup")
                .and_then(|it| it.boolean())
                .unwrap_or(true),
        },
    })
}

fn gains(cursor: &Cursor<'_>) -> Option<GainsSpec> {
    let kinds = [("bandwidth", 0), ("settling_time", 1), ("given", 2)];
    match cursor.kind(&kinds)? {
        0 => {
            let fields = cursor.object(&["kind", "bandwidth_rad_s", "damping"])?;
            Some(GainsSpec::Bandwidth {
                bandwidth_rad_s: fields.required("bandwidth_rad_s")?.number()?,
                damping: damping(&fields),
            })
        }
        1 => {
            let fields = cursor.object(&["kind", "settling_time_s", "damping"])?;
            Some(GainsSpec::SettlingTime {
                settling_time_s: fields.required("settling_time_s")?.number()?,
                damping: damping(&fields),
            })
        }
        _ => {
            let fields = cursor.object(&["kind", "attitude_per_s2", "rate_per_s"])?;
            let required = |name| fields.required(name).and_then(|it| it.number());
            let (attitude, rate) = (required("attitude_per_s2"), required("rate_per_s"));
            Some(GainsSpec::Given {
                attitude_per_s2: attitude?,
                rate_per_s: rate?,
            })
        }
    }
}

fn pid_gains(cursor: &Cursor<'_>) -> Option<PidGainsSpec> {
    let kinds = [("bandwidth", 0), ("given", 1)];
    if cursor.kind(&kinds)? == 0 {
        let known = &["kind", "bandwidth_rad_s", "damping", "integral_rad_s"];
        let fields = cursor.object(known)?;
        let integral = fields.optional("integral_rad_s").map(|it| it.number());
        return Some(PidGainsSpec::Bandwidth {
            bandwidth_rad_s: fields.required("bandwidth_rad_s")?.number()?,
            damping: damping(&fields),
            integral_rad_s: integral.unwrap_or(Some(0.0))?,
        });
    }
    let fields = cursor.object(&[
        "kind",
        "attitude_nm",
        "rate_nms",
        "integral_nm",
        "attitude_weight_per_s",
    ])?;
    let required = |name| fields.required(name).and_then(|it| it.number());
    let (attitude, rate) = (required("attitude_nm"), required("rate_nms"));
    let (integral, weight) = (required("integral_nm"), required("attitude_weight_per_s"));
    Some(PidGainsSpec::Given {
        attitude_nm: attitude?,
        rate_nms: rate?,
        integral_nm: integral?,
        attitude_weight_per_s: weight?,
    })
}

fn damping(fields: &Fields<'_>) -> f64 {
    let asked = fields.optional("damping").and_then(|it| it.number());
    asked.unwrap_or(DEFAULT_DAMPING)
}

fn errors(cursor: &Cursor<'_>) -> ErrorsSpec {
    let known = &[
        "inertia_3_sigma",
        "alignment_3_sigma_rad",
        "friction_3_sigma",
        "initial_attitude_3_sigma_rad",
        "attitude_noise_rad",
        "rate_noise_rad_s",
        "disturbance_torque_nm",
    ];
    let Some(fields) = cursor.object(known) else {
        return ErrorsSpec::default();
    };
    let number = |name| fields.optional(name).and_then(|it| it.number());
    ErrorsSpec {
        inertia_3_sigma: number("inertia_3_sigma"),
        alignment_3_sigma_rad: number("alignment_3_sigma_rad"),
        friction_3_sigma: number("friction_3_sigma"),
        initial_attitude_3_sigma_rad: number("initial_attitude_3_sigma_rad"),
        attitude_noise_rad: number("attitude_noise_rad"),
        rate_noise_rad_s: number("rate_noise_rad_s"),
        disturbance_torque_nm: fields
            .optional("disturbance_torque_nm")
            .and_then(|it| it.numbers()),
    }
}
