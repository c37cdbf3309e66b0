//! Plans in the formats of other tools, one file each.
//!
//! Every format is written from the sampled trajectory and the labels of the scenario. The
//! quaternion that maps body vectors to reference vectors has the components of the rotation from
//! the reference frame to the body frame, which CCSDS, STK and Basilisk expect; no component is
//! converted.

use crate::base::clock;
use slewplan_solver::checker::PropagatedMotion;
use slewplan_solver::model::plan::Flight;
use slewplan_solver::model::scenario::Scenario;

mod aem;
mod basilisk;
mod calendar;
mod csv;
mod form;
mod open_mct;
mod phases;
mod sampling;
mod stk;
#[cfg(test)]
mod tests;
mod trajectory;
mod wheel_rpm;

pub(crate) use form::Form;
use sampling::Sampling;
pub(crate) use sampling::Spacing;
use trajectory::SampledFlight;

/// Default maximum error of interpolation between two samples, rad of attitude and rad/s of body
/// rate: two arc seconds, the resolution of star trackers.
pub(crate) const TOLERANCE: f64 = 1e-5;
/// Default period of wheel speed commands, s.
pub(crate) const PERIOD_S: f64 = 0.1;

/// A format for other tools.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::VariantArray)]
pub(crate) enum Format {
    /// A table of everything, one row per sample.
    Csv,
    /// CCSDS Attitude Ephemeris Message, keywords and values.
    AemKvn,
    /// CCSDS Attitude Ephemeris Message, XML.
    AemXml,
    /// Waypoints for Basilisk's `waypointReference`.
    Basilisk,
    /// The schedule as a plan of Open MCT.
    OpenMct,
    /// An attitude file of STK.
    Stk,
    /// Wheel speed commands at a fixed period.
    WheelRpm,
}

impl Format {
    /// The stable name.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::AemKvn => "aem-kvn",
            Self::AemXml => "aem-xml",
            Self::Basilisk => "basilisk",
            Self::OpenMct => "open-mct",
            Self::Stk => "stk",
            Self::WheelRpm => "wheel-rpm",
        }
    }

    /// The description, in a line.
    pub(crate) const fn summary(self) -> &'static str {
        match self {
            Self::Csv => "The sampled trajectory with rates, wheel speeds and torques",
            Self::AemKvn => "CCSDS Attitude Ephemeris Message 2.0 in keywords and values",
            Self::AemXml => "CCSDS Attitude Ephemeris Message 2.0 in XML",
            Self::Basilisk => "Waypoints for Basilisk's waypointReference (attitudeType 2)",
            Self::OpenMct => "The schedule as a plan of Open MCT",
            Self::Stk => "STK attitude file (.a)",
            Self::WheelRpm => "Wheel speed commands, rpm, at a fixed period",
        }
    }

    /// The media type; only those of CSV and tab-separated values are registered.
    pub(crate) const fn media_type(self) -> &'static str {
        match self {
            Self::Csv => "text/csv",
            Self::AemKvn => "text/x.ccsds.aem.kvn",
            Self::AemXml => "application/x.ccsds.aem+xml",
            Self::Basilisk => "text/x.basilisk.waypoints",
            Self::OpenMct => "application/x.open-mct.plan+json",
            Self::Stk => "text/x.stk.attitude",
            Self::WheelRpm => "text/tab-separated-values",
        }
    }

    /// The extension of a file's name.
    pub(crate) const fn extension(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::AemKvn => "aem",
            Self::AemXml => "aem.xml",
            Self::Basilisk => "waypoints.csv",
            Self::OpenMct => "open-mct.json",
            Self::Stk => "a",
            Self::WheelRpm => "tsv",
        }
    }
}

/// Options of an export.
#[derive(Debug, Clone)]
pub(crate) struct ExportOptions {
    /// Spacing of the samples; `None` selects the default of the format.
    pub(crate) spacing: Option<Spacing>,
    /// Maximum number of samples.
    pub(crate) most_samples: usize,
    /// Whether to write body rates, where the format leaves the choice.
    pub(crate) rates: bool,
    /// Write commands of this wheel only, counted from 0.
    pub(crate) wheel: Option<usize>,
    /// Name of the spacecraft, where the format has a place for it.
    pub(crate) object_name: Option<String>,
    /// International designator of the spacecraft, where the format has a place for it.
    pub(crate) object_id: Option<String>,
    /// Creation time, microseconds since 1970.
    pub(crate) created_us: i64,
}

impl ExportOptions {
    /// The defaults, with at most this many samples.
    pub(crate) fn new(most_samples: usize) -> Self {
        Self {
            spacing: None,
            most_samples,
            rates: true,
            wheel: None,
            object_name: None,
            object_id: None,
            created_us: clock::now_us(),
        }
    }
}

/// Errors of an export.
#[derive(Debug, thiserror::Error)]
pub(crate) enum ExportError {
    /// The controls do not define a motion.
    #[error("the plan cannot be propagated: {0}")]
    NotFlown(String),
    /// An option that the format does not have, or that exceeds a limit.
    #[error("{0}")]
    Choice(String),
    /// A label of the scenario that the format cannot represent.
    #[error("{pointer} of the scenario: {what}")]
    Label {
        /// Its JSON pointer in the scenario.
        pointer: &'static str,
        /// What is wrong with it.
        what: String,
    },
    /// A number that is not finite.
    #[error("a number of the trajectory is not finite")]
    NotFinite,
}

/// Writes the flight of a scenario in a format.
///
/// # Errors
///
/// The errors of [`check`], and those of propagating and sampling the flight.
pub(crate) fn write(
    format: Format,
    scenario: &Scenario,
    flight: &Flight,
    options: &ExportOptions,
) -> Result<String, ExportError> {
    check(format, scenario, options)?;
    let motion = || {
        PropagatedMotion::of(scenario, flight).map_err(|why| ExportError::NotFlown(why.join("; ")))
    };
    let spacing = options.spacing.unwrap_or(Spacing::Tolerance(TOLERANCE));
    let sampling = Sampling {
        spacing,
        most: options.most_samples,
    };
    let sampled = || SampledFlight::of(scenario, flight, &motion()?, sampling);
    match format {
        Format::Csv => Ok(csv::table(&sampled()?, scenario.has_clock())),
        Format::AemKvn => Ok(aem::message(scenario, &sampled()?, options)?.kvn()),
        Format::AemXml => Ok(aem::message(scenario, &sampled()?, options)?.xml()),
        Format::Basilisk => Ok(basilisk::waypoints(&sampled()?)),
        Format::OpenMct => open_mct::plan(scenario, flight),
        Format::Stk => stk::attitude_file(scenario, &sampled()?, options.rates),
        Format::WheelRpm => wheel_rpm::commands(&motion()?, flight.total_time_s, options),
    }
}

/// Tests whether plans of a scenario can be written in a format, as far as that is known without a
/// plan.
///
/// # Errors
///
/// An option that the format does not have, or a label of the scenario that it cannot represent.
pub(crate) fn check(
    format: Format,
    scenario: &Scenario,
    options: &ExportOptions,
) -> Result<(), ExportError> {
    check_choices(format, options)?;
    match format {
        Format::Csv | Format::Basilisk | Format::AemKvn | Format::AemXml => Ok(()),
        Format::OpenMct => open_mct::epoch(scenario).map(drop),
        Format::Stk => stk::labels(scenario).map(drop),
        Format::WheelRpm => wheel_rpm::check_wheel(scenario, options.wheel),
    }
}

/// Refuses options that a format does not have instead of ignoring them.
fn check_choices(format: Format, options: &ExportOptions) -> Result<(), ExportError> {
    use Format::{AemKvn, AemXml, OpenMct, Stk, WheelRpm};
    let message = matches!(format, AemKvn | AemXml);
    let refused = [
        (
            options.wheel.is_some() && format != WheelRpm,
            "a wheel is chosen for wheel-rpm only",
        ),
        (
            !options.rates && !message && format != Stk,
            "rates can be left out of aem-kvn, aem-xml and stk only",
        ),
        (
            !message && (options.object_name.is_some() || options.object_id.is_some()),
            "only aem-kvn and aem-xml name the object",
        ),
        (
            options.spacing.is_some() && format == OpenMct,
            "open-mct has the schedule only and no samples",
        ),
        (
            matches!(options.spacing, Some(Spacing::Tolerance(_))) && format == WheelRpm,
            "wheel-rpm has a fixed period, which is the step",
        ),
    ];
    match refused.iter().find(|(is_so, _)| *is_so) {
        Some((_, why)) => Err(ExportError::Choice((*why).to_owned())),
        None => Ok(()),
    }
}
