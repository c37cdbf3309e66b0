//! What many flights of one plan have in common, as JSON.

use crate::documents::number::Number;
use serde::Serialize;
use slewplan_solver::simulation::{
    ConeSpread, LowPercentiles, PassageSpread, Percentiles, SaturationSpread, Spread,
};
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
    /// Share of the flights that stay clear of all enforced cones, while each applies; a flight that
    /// broke off does not. `null` where the scenario enforces none.
    #[schema(required)]
    share_clear: Option<Number>,
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
    /// How close the flights come to each cone of `keep_out` and `keep_in` that applies at some time.
    keep_out_clearance_deg: Vec<ConeSpreadDocument>,
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

/// How close flights come to a cone.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = ConeSpread)]
struct ConeSpreadDocument {
    boresight: String,
    /// JSON pointer of the cone in the scenario, such as `/keep_out/0`.
    cone: String,
    /// Unit vector along the cone's axis in the reference frame: where the Sun was taken to be.
    direction: [Number; 3],
    /// When it is enforced: `always`, `at_targets`, or never, `report`.
    applies: &'static str,
    /// Share of the flights that stay on the right side of this cone while it applies.
    share_clear: Number,
    /// Least angle of a flight between boresight and surface while the cone applied, negative on the
    /// wrong side: at the samples of the on-board computer, at arrivals and at the end.
    clearance_deg: LowPercentilesDocument,
}

/// What 50, 90, 99 and 100 % of the flights have at least; `null` where these include flights that broke
/// off.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = LowPercentiles)]
struct LowPercentilesDocument {
    #[schema(required)]
    p50: Option<Number>,
    #[schema(required)]
    p10: Option<Number>,
    #[schema(required)]
    p1: Option<Number>,
    #[schema(required)]
    min: Option<Number>,
}

impl<'a> From<&'a Spread> for SpreadDocument<'a> {
    fn from(spread: &'a Spread) -> Self {
        Self {
            runs: spread.runs,
            runs_asked: spread.runs_asked,
            tolerance_rad: Number(spread.tolerance_rad),
            share_within: Number(spread.share_within),
            share_within_at_passages: Number(spread.share_within_at_passages),
            share_clear: spread.share_clear.map(Number),
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
            keep_out_clearance_deg: spread.cones.iter().map(ConeSpreadDocument::from).collect(),
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

impl From<&ConeSpread> for ConeSpreadDocument {
    fn from(spread: &ConeSpread) -> Self {
        Self {
            boresight: spread.boresight.clone(),
            cone: spread.cone.clone(),
            direction: <[f64; 3]>::from(spread.direction).map(Number),
            applies: spread.applies.into(),
            share_clear: Number(spread.share_clear),
            clearance_deg: (&spread.clearance_deg).into(),
        }
    }
}

impl From<&LowPercentiles> for LowPercentilesDocument {
    fn from(values: &LowPercentiles) -> Self {
        Self {
            p50: Number::computed(values.p50),
            p10: Number::computed(values.p10),
            p1: Number::computed(values.p1),
            min: Number::computed(values.min),
        }
    }
}
