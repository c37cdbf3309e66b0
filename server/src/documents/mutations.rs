//! Documents that are almost right: whatever is read, validated and flown, nothing panics and
//! nothing goes on for ever.
//!
//! The fixtures and a plan are taken apart and put together wrongly: numbers replaced, parts left
//! out, doubled and exchanged, bytes changed. What is still a scenario is read as one; a plan is
//! flown as far as it can be. `SLEWPLAN_MUTATIONS` says how many documents of each kind there are,
//! `SLEWPLAN_SEED` begins elsewhere.

use super::study::envelopes::{self, EnvelopeAnswerDocument};
use super::unknown_members::documents;
use super::{flight, plan, scenario, slew};
use fastrand::Rng;
use serde_json::json;
use slewplan_solver::checker;
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::run::pool::SolverPool;
use slewplan_solver::run::progress::Silent;
use slewplan_solver::run::stop::StopSignal;
use slewplan_solver::tour::legs::NoStore;
use slewplan_solver::tour::planner::{self, Run};
use std::collections::HashMap;
use std::num::NonZeroUsize;
use std::ops::Range;
use std::path::Path;
use std::time::{Duration, Instant};

const USUAL: u64 = 300;
/// Most changes of a document.
const CHANGES: usize = 4;
/// What numbers are replaced by.
const NUMBERS: [&str; 20] = [
    "0",
    "-0",
    "1",
    "-1",
    "1e-300",
    "-1e-300",
    "5e-324",
    "1e300",
    "-1e300",
    "1.7976931348623157e308",
    "1e400",
    "1e-12",
    "0.999999",
    "1.000001",
    "3.14159265358979",
    "180",
    "360",
    "null",
    "\"1\"",
    "[]",
];

fn setting(name: &str, usual: u64) -> u64 {
    std::env::var(name).map_or(usual, |text| text.parse().expect("a number"))
}

/// The texts of a folder of the fixtures.
fn fixtures(folder: &str) -> Vec<Vec<u8>> {
    let read = |path| std::fs::read(path).expect("a fixture can be read");
    documents(folder).into_iter().map(read).collect()
}

/// The parts of a text between the signs of JSON.
fn tokens(text: &[u8]) -> Vec<Range<usize>> {
    let mut tokens = Vec::new();
    let mut begin = 0;
    for (place, byte) in text.iter().enumerate() {
        if b"{}[],:\n ".contains(byte) {
            if begin < place {
                tokens.push(begin..place);
            }
            begin = place + 1;
        }
    }
    tokens
}

fn is_number(token: &[u8]) -> bool {
    token
        .first()
        .is_some_and(|byte| byte.is_ascii_digit() || *byte == b'-')
}

/// A document with some changes.
fn mutated(seed: &[u8], rng: &mut Rng) -> Vec<u8> {
    let mut text = seed.to_vec();
    for _ in 0..rng.usize(1..=CHANGES) {
        let all = tokens(&text);
        let (Some(token), Some(other)) = (rng.choice(&all), rng.choice(&all)) else {
            return text;
        };
        match rng.u8(0..8) {
            0..=3 => {
                let numbers: Vec<_> = all
                    .iter()
                    .filter(|t| is_number(&text[(*t).clone()]))
                    .collect();
                if let (Some(token), Some(number)) = (rng.choice(numbers), rng.choice(NUMBERS)) {
                    text.splice(token.clone(), number.bytes());
                }
            }
            // Exchanged, doubled and left out, with what is between.
            4 => {
                let copy = text[other.clone()].to_vec();
                text.splice(token.clone(), copy);
            }
            5 => {
                let span = token.start.min(other.start)..token.end.max(other.end);
                let copy = text[span.clone()].to_vec();
                text.splice(span.end..span.end, [b",".to_vec(), copy].concat());
            }
            6 => {
                text.drain(token.start.min(other.start)..token.end.max(other.end));
            }
            _ => {
                let place = rng.usize(0..text.len());
                text[place] ^= 1 << rng.u8(0..8);
            }
        }
    }
    text
}

/// Reads many mutated documents; says how many were taken and how long the slowest took.
fn read_many(name: &str, seeds: &[Vec<u8>], read: impl Fn(&[u8]) -> bool) {
    let count = setting("SLEWPLAN_MUTATIONS", USUAL);
    let mut rng = Rng::with_seed(setting("SLEWPLAN_SEED", 1));
    let (mut taken, mut slowest) = (0, Duration::ZERO);
    for _ in 0..count {
        let seed = rng.choice(seeds).expect("there are seeds");
        let text = mutated(seed, &mut rng);
        let begin = Instant::now();
        taken += u64::from(read(&text));
        slowest = slowest.max(begin.elapsed());
    }
    println!(
        "{name}: {count} documents, {taken} taken, slowest {:.1} ms",
        slowest.as_secs_f64() * 1e3
    );
    assert!(taken < count, "not one document of {name} was refused");
    assert!(taken > 0, "every document of {name} was refused");
}

#[test]
fn scenarios_that_are_almost_right_are_read_or_refused() {
    read_many("scenarios", &fixtures("."), |text| {
        match scenario::read(text, None) {
            Ok(valid) => {
                let _ = planner::feasibility_problems(&valid.scenario);
                true
            }
            Err(problems) => {
                assert!(!problems.is_empty(), "refused without a reason");
                false
            }
        }
    });
}

#[test]
fn slews_that_are_almost_right_are_read_or_refused() {
    read_many("slews", &fixtures("slews"), |text| {
        slew::read(text).map_or_else(
            |problems| {
                assert!(!problems.is_empty(), "refused without a reason");
                false
            },
            |_| true,
        )
    });
}

#[test]
fn studies_of_envelopes_that_are_almost_right_are_answered_or_refused() {
    let pool = SolverPool::new(None).expect("threads");
    let stop = StopSignal::new();
    // Envelopes and eigenaxis slews only.
    stop.cancel();
    read_many(
        "studies of envelopes",
        &fixtures("studies"),
        |text| match envelopes::read(text) {
            Ok(request) => {
                let report = request.study.conduct(&pool, &stop);
                let answer = EnvelopeAnswerDocument::new(&request, &report);
                let written = serde_json::to_vec(&answer);
                assert!(written.is_ok(), "{written:?}");
                true
            }
            Err(problems) => {
                assert!(!problems.is_empty(), "refused without a reason");
                false
            }
        },
    );
}

/// The plan of a scenario as it is written, as far as it is flown.
fn written(scenario: &Scenario) -> Vec<u8> {
    let pool = SolverPool::new(NonZeroUsize::new(1)).expect("a thread");
    let outcome = planner::solve(
        scenario,
        Run {
            pool: &pool,
            stop: &StopSignal::new(),
            observer: &Silent,
            legs: &NoStore,
            segments: &NoStore,
        },
    );
    let document = serde_json::to_value(plan::document(&outcome, &[], &[])).expect("a plan");
    let parts = ["total_time_s", "sequence", "passages"].map(|name| (name, &document[name]));
    let controls = json!({"controls": &document["trajectory"]["controls"]});
    let flown: HashMap<_, _> = parts
        .into_iter()
        .chain([("trajectory", &controls)])
        .collect();
    serde_json::to_vec(&flown).expect("a flight")
}

#[test]
fn plans_that_are_almost_right_are_flown_or_refused() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/fixtures");
    let text = std::fs::read(folder.join("two-targets.json")).expect("the fixture is there");
    let scenario = scenario::read(&text, None).expect("valid").scenario;
    let plans = [written(&scenario)];
    let whole = flight::read(&plans[0], &scenario).expect("a flight");
    assert!(checker::verify(&scenario, &whole).verification.passed);
    read_many("plans", &plans, |text| {
        match flight::read(text, &scenario) {
            Ok(flight) => {
                let report = checker::verify(&scenario, &flight).verification;
                assert!(
                    report.passed || !report.failures.is_empty(),
                    "failed without a reason"
                );
                true
            }
            Err(problems) => {
                assert!(!problems.is_empty(), "refused without a reason");
                false
            }
        }
    });
}
