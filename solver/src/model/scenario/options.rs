//! The options of a solve.

use crate::model::findings::Findings;
use crate::model::problem::Code;
use crate::model::spec::OptionsSpec;

/// Limit of the further orders, each of which has to be proved.
pub(crate) const MAX_ALTERNATIVES: usize = 100;
/// Largest time limit, s: thirty years, well within the range of clocks.
const MAX_TIME_LIMIT: f64 = 1e9;

/// Checks every option; `false` after a fault.
pub(super) fn check(options: &OptionsSpec, findings: &mut Findings) -> bool {
    let time = check_time_limit(options.time_limit_s, findings);
    let nodes = options.node_limit != Some(0);
    if !nodes {
        refuse("node_limit", "0", "at least 1", findings);
    }
    let gap = check_gap(options.relative_gap, findings);
    let alternatives = options.alternatives <= MAX_ALTERNATIVES;
    if !alternatives {
        let allowed = format!("at most {MAX_ALTERNATIVES}");
        refuse(
            "alternatives",
            &options.alternatives.to_string(),
            &allowed,
            findings,
        );
    }
    let torque = check_share("torque_authority", options.torque_authority, findings);
    let momentum = check_share("momentum_authority", options.momentum_authority, findings);
    time && nodes && gap && alternatives && torque && momentum
}

fn check_time_limit(limit: Option<f64>, findings: &mut Findings) -> bool {
    let Some(limit) = limit else {
        return true;
    };
    let Some(limit) = findings.finite("/options/time_limit_s", limit) else {
        return false;
    };
    let valid = limit > 0.0 && limit <= MAX_TIME_LIMIT;
    if !valid {
        let allowed = format!("above 0 s and at most {MAX_TIME_LIMIT:e} s, or null for none");
        refuse("time_limit_s", &limit.to_string(), &allowed, findings);
    }
    valid
}

fn check_gap(gap: f64, findings: &mut Findings) -> bool {
    let Some(gap) = findings.finite("/options/relative_gap", gap) else {
        return false;
    };
    let valid = (0.0..1.0).contains(&gap);
    if !valid {
        refuse(
            "relative_gap",
            &gap.to_string(),
            "at least 0 and below 1",
            findings,
        );
    }
    valid
}

fn check_share(name: &str, share: f64, findings: &mut Findings) -> bool {
    let Some(share) = findings.finite(&format!("/options/{name}"), share) else {
        return false;
    };
    let valid = share > 0.0 && share <= 1.0;
    if !valid {
        refuse(name, &share.to_string(), "above 0 and at most 1", findings);
    }
    valid
}

fn refuse(name: &str, value: &str, allowed: &str, findings: &mut Findings) {
    findings.refuse(
        format!("/options/{name}"),
        Code::OutOfRange,
        format!("{name} is {value}, it must be {allowed}"),
        format!("give a value {allowed}, or leave the option out for its default"),
    );
}
