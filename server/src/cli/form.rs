//! Format of a written plan, and its options.

use super::failure::Failure;
use crate::render::export::{
    self, ExportError, ExportOptions, Form, Format, PERIOD_S, Spacing, TOLERANCE,
};
use clap::ValueEnum;
use clap::builder::PossibleValue;
use slewplan_solver::model::plan::Flight;
use slewplan_solver::model::scenario::Scenario;
use strum::VariantArray as _;

/// Maximum number of samples of a file: a week at three per second.
const MAX_SAMPLES: usize = 2_000_000;

impl ValueEnum for Form {
    fn value_variants<'a>() -> &'a [Self] {
        &Self::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.name()).help(self.summary()))
    }
}

impl ValueEnum for Format {
    fn value_variants<'a>() -> &'a [Self] {
        Self::VARIANTS
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.name()).help(self.summary()))
    }
}

/// Options of the formats.
#[derive(Debug, Default, clap::Args)]
#[command(next_help_heading = "Formats other than json")]
pub(super) struct FormatOptions {
    #[arg(long, value_name = "S", value_parser = step, conflicts_with = "tolerance",
        help = format!("Sample at multiples of this time, s, and at every switch; the period of \
            wheel-rpm [default there: {PERIOD_S}]"))]
    step: Option<f64>,
    #[arg(long, value_name = "X", value_parser = tolerance,
        help = format!("Sample so that linear interpolation is within this angle, rad, and rates \
            within the same, rad/s [default: {TOLERANCE:e}]"))]
    tolerance: Option<f64>,
    /// Leave body rates out of AEM and STK files
    #[arg(long)]
    no_rates: bool,
    /// Commands of this wheel only, counted from 0 (wheel-rpm)
    #[arg(long, value_name = "N")]
    wheel: Option<usize>,
    /// Name of the spacecraft in an AEM [default: UNKNOWN]
    #[arg(long, value_name = "NAME")]
    object_name: Option<String>,
    /// International designator of the spacecraft in an AEM [default: UNKNOWN]
    #[arg(long, value_name = "ID")]
    object_id: Option<String>,
}

/// A step, s, as clap reads it.
fn step(text: &str) -> Result<f64, &'static str> {
    Spacing::checked_step(text.parse().unwrap_or(f64::NAN))
}

/// A tolerance as clap reads it.
fn tolerance(text: &str) -> Result<f64, &'static str> {
    Spacing::checked_tolerance(text.parse().unwrap_or(f64::NAN))
}

impl FormatOptions {
    /// Whether no option is set.
    pub(super) fn are_default(&self) -> bool {
        self.step.is_none()
            && self.tolerance.is_none()
            && !self.no_rates
            && self.wheel.is_none()
            && self.object_name.is_none()
            && self.object_id.is_none()
    }

    /// Tests whether plans of a scenario can be written with these options.
    pub(super) fn check(&self, format: Format, scenario: &Scenario) -> Result<(), Failure> {
        export::check(format, scenario, &self.options()).map_err(failed(format))
    }

    /// A flight in a format with these options.
    pub(super) fn write(
        &self,
        format: Format,
        scenario: &Scenario,
        flight: &Flight,
    ) -> Result<String, Failure> {
        export::write(format, scenario, flight, &self.options()).map_err(failed(format))
    }

    fn options(&self) -> ExportOptions {
        let step = self.step.map(Spacing::Step);
        ExportOptions {
            spacing: step.or(self.tolerance.map(Spacing::Tolerance)),
            rates: !self.no_rates,
            wheel: self.wheel,
            object_name: self.object_name.clone(),
            object_id: self.object_id.clone(),
            ..ExportOptions::new(MAX_SAMPLES)
        }
    }
}

fn failed(format: Format) -> impl Fn(ExportError) -> Failure {
    move |error| match error {
        ExportError::NotFinite => Failure::Unspeakable(error.to_string()),
        _ => Failure::Setting {
            name: format.name(),
            what: error.to_string(),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_and_tolerances_are_positive_and_finite() {
        for read in [step, tolerance] {
            assert_eq!(read("0.25").map(f64::to_bits), Ok(0.25_f64.to_bits()));
            for wrong in ["0", "-1", "NaN", "inf", "x", "", "1e-9999"] {
                assert!(read(wrong).is_err(), "{wrong}");
            }
        }
    }
}
