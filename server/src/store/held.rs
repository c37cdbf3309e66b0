//! What statements on leased jobs have in common: whether the lease is held, and which bound remains.

use super::JobRow;
use super::database::statement::Value;

/// Whether a process holds the lease with the fence `held` of the job `leased`: the job has not ended, and
/// was neither given back nor taken over.
macro_rules! is_held {
    () => {
        "sequence = leased AND fence = held AND boot_id IS NOT NULL"
    };
}

/// Job and fence of a lease, as the row of `leased` and `held`.
pub(super) fn held(lease: &JobRow) -> [Value<'static>; 2] {
    [lease.sequence.into(), lease.fence.into()]
}

/// The greater of the lower bound of a job and of that of a report (`told_bound_s`); either may be null.
macro_rules! greater_bound {
    () => {
        "(CASE WHEN lower_bound_s >= told_bound_s THEN lower_bound_s \
         ELSE coalesce(told_bound_s, lower_bound_s) END)"
    };
}

/// The lower bound of a job after a report: the greater one, but no more than the duration of the
/// plan.
macro_rules! bound_beside {
    ($incumbent:expr) => {
        concat!(
            "CASE WHEN ",
            greater_bound!(),
            " > ",
            $incumbent,
            " THEN ",
            $incumbent,
            " ELSE ",
            greater_bound!(),
            " END"
        )
    };
}

/// What is said of the better plan: that of a report (`plan_s` its duration, `told_value` its value) if it
/// is worth more than that of the job, or as much and is shorter, else that of the job. Values are null
/// where no target has one.
macro_rules! better_of {
    ($reported:literal, $kept:literal) => {
        concat!(
            "(CASE WHEN incumbent_s IS NULL OR told_value > value \
             OR ((told_value = value OR value IS NULL) AND plan_s < incumbent_s) THEN ",
            $reported,
            " ELSE ",
            $kept,
            " END)"
        )
    };
}

/// The less of the upper bound on the value of a job and of that of a report; either may be null.
macro_rules! least_value_bound {
    () => {
        "CASE WHEN value_bound <= told_value_bound THEN value_bound \
         ELSE coalesce(told_value_bound, value_bound) END"
    };
}
