//! A study of the shares of torque and speed that are left to feedback, as text.

use super::blocks::{count, reasons};
use super::numbers::{computed, decimals, percent, significant};
use super::studies::titled;
use crate::documents::plan::status;
use slewplan_solver::simulation::{ConeSpread, Spread};
use slewplan_studies::authority::{AuthorityRow, RowOutcome};

/// Pairs of shares with what they lead to.
pub(crate) fn rows(rows: &[AuthorityRow]) -> String {
    let head = [
        "plan",
        "torque",
        "wheel speed",
        "duration [s]",
        "flights",
        "within at the end",
        "within at every arrival",
        "error of 90 % [deg]",
        "clear of cones",
    ];
    // Without cones there is nothing to say about them.
    let enforces = spreads(rows).any(|(_, spread)| spread.share_clear.is_some());
    let head = &head[..head.len() - usize::from(!enforces)];
    let cells = |row: &AuthorityRow| {
        let mut cells = figures(row);
        cells.truncate(head.len());
        cells
    };
    let title = format!("{} of torque and wheel speed", count(rows.len(), "pair"));
    let mut text = titled(&title, 1, head, rows.iter().map(cells));
    text += &cones(rows);
    for row in rows {
        if let RowOutcome::NoPlan(problems) = &row.outcome {
            text += "\n";
            text += &reasons(problems, None);
        }
    }
    text
}

/// What a pair of shares leads to, in the order of the columns.
fn figures(row: &AuthorityRow) -> Vec<String> {
    let none = || "-".to_owned();
    let (plan, figures) = match &row.outcome {
        RowOutcome::Simulated {
            total_time_s,
            optimality,
            spread,
            ..
        } => (
            status(*optimality),
            [
                format!("{total_time_s:.3}"),
                format!("{} of {}", spread.runs, spread.runs_asked),
                percent(spread.share_within, 1),
                percent(spread.share_within_at_passages, 1),
                significant(spread.end_attitude_rad.p90.to_degrees()),
                spread.share_clear.map_or_else(none, |it| percent(it, 1)),
            ],
        ),
        RowOutcome::NoPlan(_) => ("no plan", [(); 6].map(|()| none())),
        RowOutcome::Stopped => ("stopped", [(); 6].map(|()| none())),
    };
    let shares = [
        percent(row.authorities.torque_authority, 1),
        percent(row.authorities.momentum_authority, 1),
    ];
    [plan.to_owned()]
        .into_iter()
        .chain(shares)
        .chain(figures)
        .collect()
}

/// What flights have in common, of every row that has any.
fn spreads(rows: &[AuthorityRow]) -> impl Iterator<Item = (&AuthorityRow, &Spread)> {
    rows.iter().filter_map(|row| match &row.outcome {
        RowOutcome::Simulated { spread, .. } => Some((row, &**spread)),
        RowOutcome::NoPlan(_) | RowOutcome::Stopped => None,
    })
}

/// How close flights come to cones; empty without cones.
fn cones(rows: &[AuthorityRow]) -> String {
    let head = [
        "cone",
        "torque",
        "wheel speed",
        "applies",
        "clear",
        "50 %",
        "90 %",
        "99 %",
        "all",
    ];
    let row = |row: &AuthorityRow, cone: &ConeSpread| {
        let least = &cone.clearance_deg;
        let mut cells = vec![
            format!("{} ({})", cone.boresight, cone.cone),
            percent(row.authorities.torque_authority, 1),
            percent(row.authorities.momentum_authority, 1),
            <&str>::from(cone.applies).replace('_', " "),
            percent(cone.share_clear, 1),
        ];
        let each = [least.p50, least.p10, least.p1, least.min];
        cells.extend(each.map(|angle| computed(angle, |angle| decimals(angle, 2))));
        cells
    };
    let of_row = |(of, spread)| {
        let spread: &Spread = spread;
        spread.cones.iter().map(move |cone| row(of, cone))
    };
    let cells: Vec<_> = spreads(rows).flat_map(of_row).collect();
    if cells.is_empty() {
        return String::new();
    }
    let title = "Clearance of cones that so many flights keep [deg]";
    format!("\n{}", titled(title, 1, &head, cells.into_iter()))
}
