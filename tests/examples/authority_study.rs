//! Flies the published experiment A a thousand times for each of some shares of torque and momentum
//! that the plan may use, and prints the table from which a planner chooses them.
//!
//! Inertia known to 2 % (three standard deviations), quaternion feedback of 0.1 rad/s at 10 Hz.
//! Arguments: seconds under control after the end (default 0), and shares as `torque/momentum`.

use slewplan_solver::simulation::{ErrorsSpec, SimulationSpec, Spread};
use slewplan_studies::authority::{Authorities, AuthorityStudySpec, RowOutcome, study};
use slewplan_tests::experiment_a_spec;
use slewplan_tests::solving::on_threads;

/// Shares of torque and momentum when none are given.
const SHARES: [(f64, f64); 7] = [
    (1.0, 1.0),
    (0.95, 1.0),
    (1.0, 0.95),
    (0.98, 0.98),
    (0.95, 0.95),
    (0.9, 0.9),
    (0.8, 0.8),
];

fn main() {
    let mut arguments = std::env::args().skip(1);
    let settle_s = arguments
        .next()
        .map(|text| text.parse().expect("seconds after the end"));
    let mut shares: Vec<_> = arguments.map(|text| pair(&text)).collect();
    if shares.is_empty() {
        shares = SHARES.into();
    }
    let spec = AuthorityStudySpec {
        scenario: experiment_a_spec(),
        simulation: SimulationSpec {
            settle_s,
            errors: ErrorsSpec {
                inertia_3_sigma: Some(0.02),
                ..ErrorsSpec::default()
            },
            ..SimulationSpec::default()
        },
        authorities: shares
            .into_iter()
            .map(|(torque_authority, momentum_authority)| Authorities {
                torque_authority,
                momentum_authority,
            })
            .collect(),
    };
    let rows = on_threads(2, |run| study(&spec, "", run));
    println!("torque momentum    time  | end: within  50 %  99 %   max | targets: within");
    println!("                      s  |      0.1 deg      deg         |    all 0.1 deg");
    for row in rows.expect("a valid study") {
        let Authorities {
            torque_authority: torque,
            momentum_authority: momentum,
        } = row.authorities;
        print!("{torque:6.2} {momentum:8.2} ");
        match row.outcome {
            RowOutcome::Simulated {
                total_time_s,
                spread,
                ..
            } => report(total_time_s, &spread),
            other => println!("{other:?}"),
        }
    }
}

fn pair(text: &str) -> (f64, f64) {
    let share = |text: &str| text.parse().expect("a share");
    let (torque, momentum) = text.split_once('/').expect("shares as torque/momentum");
    (share(torque), share(momentum))
}

fn report(total_time_s: f64, spread: &Spread) {
    let end = spread.end_attitude_rad;
    println!(
        "{total_time_s:7.2}  | {:11.3} {:5.3} {:5.3} {:5.3} | {:11.3}",
        spread.share_within,
        end.p50.to_degrees(),
        end.p99.to_degrees(),
        end.max.to_degrees(),
        spread.share_within_at_passages,
    );
    for passage in &spread.passages {
        let found = passage.attitude_rad;
        println!(
            "    {:>8} {:7.2}  |             {:5.3} {:5.3} {:5.3} |",
            passage.target,
            passage.time_s,
            found.p50.to_degrees(),
            found.p99.to_degrees(),
            found.max.to_degrees(),
        );
    }
    for (wheel, found) in spread.saturation.iter().enumerate() {
        println!(
            "    wheel {wheel} at a limit: torque {:.4} of the time ({:.4} at most), speed {:.4} ({:.4})",
            found.torque_mean, found.torque_max, found.speed_mean, found.speed_max,
        );
    }
}
