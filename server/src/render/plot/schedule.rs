//! What a clock adds to the picture of a plan: windows, waits, times of day, targets left out.

use super::canvas::{Canvas, Ink, LINE, Pen, PlotArea};
use super::written::WrittenPlan;
use jiff::SignedDuration;
use jiff::civil::DateTime;
use slewplan_solver::model::scenario::Scenario;

/// Height of the row of times of day, and of a line of text.
pub(super) const CLOCK_ROW: f64 = 18.0;
const LINE_HEIGHT: f64 = 17.0;
/// Characters of a line of targets that are left out, and its lines.
const LINE_LENGTH: usize = 165;
const MAX_LINES: usize = 6;
const WINDOW: &str = "#E4EFD9";
const WINDOW_EDGE: &str = "#8DB36B";
const WAIT: &str = "#9AA6B2";
/// Width per mark of the row of times of day, and distances of marks, s.
const MARK: f64 = 110.0;
const STEPS: [f64; 20] = [
    0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 60.0, 120.0, 300.0, 600.0, 900.0, 1800.0,
    3600.0, 7200.0, 10_800.0, 21_600.0, 43_200.0,
];
const DAY_S: f64 = 86_400.0;

/// The windows that the visits of a plan lie in, behind its phases.
pub(super) fn windows(
    canvas: &mut Canvas,
    frame: PlotArea,
    plan: &WrittenPlan,
    scenario: &Scenario,
) {
    let times = frame.times(plan.total_time_s);
    for passage in &plan.passages {
        let target = scenario.targets().iter().find(|t| t.id == passage.target);
        let windows = target.and_then(|target| target.windows.as_deref());
        let holds = |from: f64, to: f64| from <= passage.time_s && passage.time_s <= to;
        let used = windows
            .unwrap_or_default()
            .iter()
            .find(|window| holds(window.from, window.to));
        let Some(window) = used else { continue };
        let (from, to) = (window.from.max(0.0), window.to.min(plan.total_time_s));
        let (left, right) = (times.at(from), times.at(to));
        let area = PlotArea {
            left,
            width: right - left,
            ..frame
        };
        canvas.rectangle(area, WINDOW, 0.0);
        for x in [left, right] {
            let (top, bottom) = (frame.top, frame.top + frame.height);
            canvas.line((x, top), (x, bottom), Pen::new(WINDOW_EDGE, 0.75));
        }
    }
}

/// The waits of a plan as lines at half the height of a row.
pub(super) fn waits(canvas: &mut Canvas, row: PlotArea, plan: &WrittenPlan) {
    let times = row.times(plan.total_time_s);
    let y = row.top + 0.5 * row.height;
    for wait in &plan.waits {
        let pen = Pen::new(WAIT, 2.0).dashed();
        canvas.line((times.at(wait.from_s), y), (times.at(wait.to_s), y), pen);
    }
}

/// A row of times of day below the phases, in the time system of the scenario.
pub(super) fn clock(canvas: &mut Canvas, frame: PlotArea, total_s: f64, scenario: &Scenario) {
    let Some(epoch) = scenario.epoch() else {
        return;
    };
    let system = scenario.time_system().unwrap_or_default().name();
    let times = frame.times(total_s);
    let baseline = frame.top + 13.0;
    // Beside the text of the first mark, which is centred.
    canvas.text(frame.left - 32.0, baseline, Ink::SMALL.end(), system);
    for (time, words) in marks(epoch, total_s, frame.width / MARK) {
        let x = times.at(time);
        let pen = Pen::new(LINE, 1.0);
        canvas.line((x, frame.top - 1.0), (x, frame.top + 3.0), pen);
        canvas.text(x, baseline, Ink::SMALL.middle(), &words);
    }
}

/// Times, s, at full times of day, about as many as asked for, with their texts.
fn marks(epoch: DateTime, total_s: f64, about: f64) -> Vec<(f64, String)> {
    let fits = |step: &f64| total_s / step <= about;
    let step = STEPS.into_iter().find(fits);
    let step = step.unwrap_or_else(|| DAY_S * (total_s / (DAY_S * about)).ceil());
    let midnight = epoch.date().to_datetime(jiff::civil::Time::midnight());
    let offset = epoch.duration_since(midnight).as_secs_f64();
    let format = match step {
        ..1.0 => "%H:%M:%S%.1f",
        ..60.0 => "%H:%M:%S",
        ..DAY_S => "%H:%M",
        _ => "%Y-%m-%d",
    };
    let mut marks = Vec::new();
    let mut number = (offset / step - 1e-9).ceil();
    while number * step - offset <= total_s {
        let time = number * step - offset;
        // By rounding a full minute may come out a little before it.
        let rounded = SignedDuration::try_from_secs_f64(number * step + 1e-6);
        let moment = rounded.ok().and_then(|it| midnight.checked_add(it).ok());
        marks.extend(moment.map(|it| (time, it.strftime(format).to_string())));
        number += 1.0;
    }
    marks
}

/// Height of the list of targets that are left out.
pub(super) fn height(plan: &WrittenPlan) -> f64 {
    match lines(plan).len() {
        0 => 0.0,
        lines => LINE_HEIGHT * (lines as f64 + 1.0) + 8.0,
    }
}

/// The targets that are left out, with the reasons.
pub(super) fn left_out(canvas: &mut Canvas, frame: PlotArea, plan: &WrittenPlan) {
    let lines = lines(plan);
    if lines.is_empty() {
        return;
    }
    let mut baseline = frame.top + 14.0;
    let title = format!("Left out: {}", plan.skipped.len());
    canvas.text(frame.left, baseline, Ink::HEADING, &title);
    for line in lines {
        baseline += LINE_HEIGHT;
        canvas.text(frame.left, baseline, Ink::SMALL, &line);
    }
}

fn lines(plan: &WrittenPlan) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for (index, skipped) in plan.skipped.iter().enumerate() {
        let words = format!("{} ({})", skipped.target, skipped.reason.replace('_', " "));
        let room = |line: &&mut String| line.chars().count() + words.chars().count() < LINE_LENGTH;
        if let Some(line) = lines.last_mut().filter(room) {
            *line += ", ";
            *line += &words;
        } else if lines.len() == MAX_LINES {
            let more = plan.skipped.len() - index;
            lines.push(format!("and {more} more"));
            break;
        } else {
            lines.push(words);
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use slewplan_solver::model::epoch;

    fn texts(begin: &str, total_s: f64) -> Vec<String> {
        let begin = epoch::parse(begin).expect("an epoch");
        let marks = marks(begin, total_s, 6.0).into_iter();
        marks.map(|(_, words)| words).collect()
    }

    #[test]
    fn marks_are_at_full_times_of_day() {
        assert_eq!(
            texts("2026-01-31T23:58:30", 300.0),
            ["23:59", "00:00", "00:01", "00:02", "00:03"]
        );
        assert_eq!(
            texts("2026-01-31T12:00:00.25", 2.0),
            ["12:00:00.5", "12:00:01.0", "12:00:01.5", "12:00:02.0"]
        );
        assert_eq!(texts("2026-01-31T12:00:00", 4.0 * DAY_S).len(), 4);
        let begin = epoch::parse("2026-01-31T23:58:30").expect("an epoch");
        assert_eq!(marks(begin, 300.0, 6.0)[0].0.to_bits(), 30.0_f64.to_bits());
    }
}
