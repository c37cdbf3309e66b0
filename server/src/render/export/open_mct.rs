//! The schedule as a plan of Open MCT: groups of activities, times in milliseconds since 1970.

use super::ExportError;
use super::calendar::{self, CalendarTime};
use super::phases::{SegmentKind, phases};
use serde::Serialize;
use slewplan_solver::model::plan::Flight;
use slewplan_solver::model::scenario::Scenario;

/// Groups of activities, whose `type` is the name of the group; waits are there where there are any.
#[derive(Debug, Serialize)]
struct OpenMctPlan {
    #[serde(rename = "Slews")]
    slews: Vec<Activity>,
    #[serde(rename = "Waits", skip_serializing_if = "Vec::is_empty")]
    waits: Vec<Activity>,
    #[serde(rename = "Targets")]
    targets: Vec<Activity>,
}

#[derive(Debug, Serialize)]
#[serde(rename_all = "camelCase")]
struct Activity {
    name: String,
    start: i64,
    end: i64,
    r#type: &'static str,
    color: &'static str,
    text_color: &'static str,
}

/// The time from which the flight counts.
pub(super) fn epoch(scenario: &Scenario) -> Result<CalendarTime, ExportError> {
    calendar::utc_epoch(scenario, "Open MCT")
}

/// The plan; activities of targets without rest begin and end at the same time.
pub(super) fn plan(scenario: &Scenario, flight: &Flight) -> Result<String, ExportError> {
    let epoch = epoch(scenario)?;
    let activity = |name, (begin, end): (f64, f64), group, color| -> Result<_, ExportError> {
        Ok(Activity {
            name,
            start: epoch.plus(begin)?.unix_ms(),
            end: epoch.plus(end)?.unix_ms(),
            r#type: group,
            color,
            text_color: "white",
        })
    };
    let (mut slews, mut waits) = (Vec::new(), Vec::new());
    for (kind, begin, end) in phases(scenario, flight) {
        match kind {
            SegmentKind::Slew(from, to) => {
                let name = format!("{from} \u{2192} {to}");
                slews.push(activity(name, (begin, end), "Slews", "#0b6e99")?);
            }
            SegmentKind::Wait(place) => {
                waits.push(activity(
                    place.to_owned(),
                    (begin, end),
                    "Waits",
                    "#5b6672",
                )?);
            }
            SegmentKind::Rest(_) => {}
        }
    }
    let targets = flight.passages.iter().map(|passage| {
        let stay = (passage.time_s, passage.departure_s);
        activity(passage.target.clone(), stay, "Targets", "#a8480f")
    });
    let plan = OpenMctPlan {
        slews,
        waits,
        targets: targets.collect::<Result<_, _>>()?,
    };
    let text = serde_json::to_string_pretty(&plan).map_err(|_| ExportError::NotFinite)?;
    Ok(text + "\n")
}
