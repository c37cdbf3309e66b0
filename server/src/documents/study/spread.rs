//! What many flights of one plan have in common, as JSON.

use crate::documents::number::Number;
use serde::Serialize;
use slewplan_solver::simulation::{PassageSpread, Percentiles, SaturationSpread, Spread};
use utoipa::ToSchema;

/// Flights with errors.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = FlightSpread)]
pub(super) struct SpreadDocument<'a> {
    runs: usize,
    runs_asked: usize,
    tolerance_rad: Number,
    /// Share of the flights that end within the tolerance.
    share_within: Number,
    /// Share of the flights that are within the tolerance at every arrival.
    share_within_at_passages: Number,
    /// At the end of the flight, after the time to settle.
    end_attitude_rad: PercentilesDocument,
    end_rate_rad_s: PercentilesDocument,
    /// At the end of the plan.
    plan_end_attitude_rad: PercentilesDocument,
    /// The largest on the way.
    peak_attitude_rad: PercentilesDocument,
    passages: Vec<PassageSpreadDocument<'a>>,
    /// One entry per wheel.
    saturation: Vec<SaturationDocument>,
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = Percentiles)]
struct PercentilesDocument {
    p50: Number,
    p90: Number,
    p99: Number,
    max: Number,
}

#[derive(Debug, Serialize, ToSchema)]
#[schema(as = PassageSpread)]
struct PassageSpreadDocument<'a> {
    target: &'a str,
    time_s: Number,
    attitude_rad: PercentilesDocument,
    rate_rad_s: PercentilesDocument,
}

/// Shares of the time of flight at a limit: the mean over the flights, and the largest.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = SaturationSpread)]
struct SaturationDocument {
    torque_mean: Number,
    torque_max: Number,
    speed_mean: Number,
    speed_max: Number,
}

impl<'a> From<&'a Spread> for SpreadDocument<'a> {
    fn from(spread: &'a Spread) -> Self {
        Self {
            runs: spread.runs,
            runs_asked: spread.runs_asked,
            tolerance_rad: Number(spread.tolerance_rad),
            share_within: Number(spread.share_within),
            share_within_at_passages: Number(spread.share_within_at_passages),
            end_attitude_rad: (&spread.end_attitude_rad).into(),
            end_rate_rad_s: (&spread.end_rate_rad_s).into(),
            plan_end_attitude_rad: (&spread.plan_end_attitude_rad).into(),
            peak_attitude_rad: (&spread.peak_attitude_rad).into(),
            passages: spread
                .passages
                .iter()
                .map(PassageSpreadDocument::from)
                .collect(),
            saturation: spread
                .saturation
                .iter()
                .map(SaturationDocument::from)
                .collect(),
        }
    }
}

impl From<&Percentiles> for PercentilesDocument {
    fn from(values: &Percentiles) -> Self {
        Self {
            p50: Number(values.p50),
            p90: Number(values.p90),
            p99: Number(values.p99),
            max: Number(values.max),
        }
    }
}

impl<'a> From<&'a PassageSpread> for PassageSpreadDocument<'a> {
    fn from(passage: &'a PassageSpread) -> Self {
        Self {
            target: &passage.target,
            time_s: Number(passage.time_s),
            attitude_rad: (&passage.attitude_rad).into(),
            rate_rad_s: (&passage.rate_rad_s).into(),
        }
    }
}

impl From<&SaturationSpread> for SaturationDocument {
    fn from(saturation: &SaturationSpread) -> Self {
        Self {
            torque_mean: Number(saturation.torque_mean),
            torque_max: Number(saturation.torque_max),
            speed_mean: Number(saturation.speed_mean),
            speed_max: Number(saturation.speed_max),
        }
    }
}
