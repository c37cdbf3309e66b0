//! The documents that callers write.

use crate::documents::leg_query::LegQuerySpec;
use crate::documents::legs::read::LegFileSpec;
use crate::documents::schema::Described;
use crate::documents::study::flight::FlightStudySpec;
use crate::documents::verification::VerifySpec;
use slewplan_solver::model::spec::{ScenarioSpec, SpacecraftSpec};
use slewplan_solver::slew::SlewSpec;
use slewplan_studies::authority::AuthorityStudySpec;
use slewplan_studies::comparison::ComparisonStudySpec;
use slewplan_studies::envelope_study::EnvelopeStudySpec;

pub(in crate::api) type Scenario = Described<ScenarioSpec>;
pub(in crate::api) type Spacecraft = Described<SpacecraftSpec>;
pub(in crate::api) type LegQueryBody = Described<LegQuerySpec>;
pub(in crate::api) type LegFileBody = Described<LegFileSpec>;
pub(in crate::api) type SlewBody = Described<SlewSpec>;
pub(in crate::api) type AuthorityBody = Described<AuthorityStudySpec>;
pub(in crate::api) type ComparisonBody = Described<ComparisonStudySpec>;
pub(in crate::api) type EnvelopeBody = Described<EnvelopeStudySpec>;
pub(in crate::api) type FlightBody = Described<FlightStudySpec>;
pub(in crate::api) type VerifyBody = Described<VerifySpec>;
