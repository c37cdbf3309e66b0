//! Judges the starts of legs: every leg as the solver solves it beside the best of twenty starts that
//! know nothing of it.
//!
//! Suites: `suite` (the 300 legs of the random suite), `published` (those of experiment C), and any
//! number of general slews of a seed, or of such with wheels near their limits:
//!
//! ```text
//! leg_starts [--cache FILE] [--legs] [--only TEXT] suite | published | general:SEED:COUNT | loaded:SEED:COUNT ...
//! ```
//!
//! `--legs` prints a line for every leg, else only those more than 0.1 % above the best. The best
//! durations are kept in the file, so that only the first run of a suite takes long; a better duration
//! that the solver finds is kept too. Processor times are those of the solver alone, bound included,
//! on one thread (Linux; 0 elsewhere).

use nalgebra::Vector3;
use slewplan_solver::model::attitude::Attitude;
use slewplan_solver::model::spec::ScenarioSpec;
use slewplan_solver::tour::planner::{GuessNode, LegAnswer, LegTrial, LegTrials};
use slewplan_tests::experiment_c_spec;
use slewplan_tests::general;
use slewplan_tests::random::Generator;
use slewplan_tests::solving::scenario_of;
use slewplan_tests::suite::{LEGS_PER_SPACECRAFT, SPACECRAFT, leg};
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};
use std::io::Write;

/// Starts of a leg.
const STARTS: usize = 20;
/// A guess lasts so many times as long as the best motion known.
const SLOWER: f64 = 1.3;
/// Relative excess over the best duration that is printed, and that of which there may be two.
const PRINTED: f64 = 1e-3;
const LARGE: f64 = 5e-3;
/// Step of the differences that give the rates of a guess, as a share of its duration.
const STEP: f64 = 1e-5;

fn main() {
    let (mut cache, mut suites, mut all, mut only) = (None, Vec::new(), false, String::new());
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--cache" => cache = Some(arguments.next().expect("a file")),
            "--legs" => all = true,
            "--only" => only = arguments.next().expect("a part of a name"),
            _ => suites.push(argument),
        }
    }
    let mut best = cache.as_deref().map(read).unwrap_or_default();
    for name in &suites {
        let mut report = Report::default();
        for (index, spec) in specs(name).into_iter().enumerate() {
            let scenario = scenario_of(&spec);
            let title = spec.name.as_deref().unwrap_or_default();
            if !title.contains(&only) {
                continue;
            }
            for trial in LegTrials::of(&scenario).legs() {
                let key = format!("{title}, {}", trial.name());
                let begin = processor_s();
                let answer = trial.answer();
                let spent = processor_s() - begin;
                let known = best.get(&key).copied();
                let known = known.unwrap_or_else(|| best_of_twenty(&trial, &answer, index as u64));
                let least = answer.duration_s.map_or(known, |ours| ours.min(known));
                if best.insert(key.clone(), least) != Some(least)
                    && let Some(cache) = &cache
                {
                    append(cache, &key, least);
                }
                report.add(&key, &answer, least, spent, all);
            }
        }
        report.print(name);
    }
}

/// The scenarios of a suite.
fn specs(name: &str) -> Vec<ScenarioSpec> {
    let mut parts = name.split(':');
    let kind = parts.next();
    let mut number = || parts.next().and_then(|text| text.parse::<u64>().ok());
    match kind {
        Some("suite") => (0..SPACECRAFT)
            .flat_map(|craft| (0..LEGS_PER_SPACECRAFT).map(move |number| leg(craft, number)))
            .collect(),
        Some("published") => vec![ScenarioSpec {
            end: None,
            ..experiment_c_spec()
        }],
        Some("general" | "loaded") => {
            let seed = number().expect("a seed");
            let count = number().expect("a count");
            let slew = if kind == Some("loaded") {
                general::loaded_slew
            } else {
                general::slew
            };
            (0..count).map(|number| slew(seed, number)).collect()
        }
        _ => panic!("suite, published, general:SEED:COUNT or loaded:SEED:COUNT, not {name}"),
    }
}

/// The best duration from twenty starts, s; infinite where none converges.
fn best_of_twenty(trial: &LegTrial<'_>, answer: &LegAnswer, seed: u64) -> f64 {
    let mut generator = Generator::new(7_000_000 + seed);
    let mut best = answer.duration_s.unwrap_or(f64::INFINITY);
    for start in 0..STARTS {
        let lasting = SLOWER * if best.is_finite() { best } else { 1000.0 };
        let nodes = guess(trial, start, lasting, &mut generator);
        best = trial
            .from_guess(&nodes)
            .map_or(best, |found| found.min(best));
    }
    best
}

/// A guess about the eigenaxis, bowed.
///
/// In the order of `start`, over and over: bowed to the side, about an axis across; bowed about any
/// axis; bowed to one side and then to the other; and, with a bow, the long way round. Each is
/// sampled at times that are evenly spaced or drawn at random.
fn guess(
    trial: &LegTrial<'_>,
    start: usize,
    lasting: f64,
    generator: &mut Generator,
) -> Vec<GuessNode> {
    let turn = Attitude::identity().signed_turn_to(&trial.target());
    let mut turn = if turn.norm() > PI {
        turn * (1.0 - TAU / turn.norm())
    } else {
        turn
    };
    let short = turn.norm();
    let axis = turn / short;
    if start % 4 == 3 {
        turn -= axis * TAU;
    }
    let any = Vector3::from(generator.direction());
    let across = axis.cross(&any).normalize();
    let size = generator.logarithmic(0.05, 1.5) * short;
    let bows = match start % 4 {
        0 => [across * size, Vector3::zeros()],
        1 => [any * size, Vector3::zeros()],
        2 => [
            across * (0.3 * size),
            Vector3::from(generator.direction()) * size,
        ],
        _ => [any * generator.between(0.0, 1.0), Vector3::zeros()],
    };
    let at = |share: f64| {
        // At rest at both ends.
        let smooth = share * share * (3.0 - 2.0 * share);
        let bow = bows[0] * (PI * smooth).sin() + bows[1] * (TAU * smooth).sin();
        Attitude::identity().retract(turn * smooth).retract(bow)
    };
    let intervals = trial.intervals();
    let mut shares: Vec<f64> = (0..=intervals)
        .map(|k| k as f64 / intervals as f64)
        .collect();
    if generator.coin() {
        for share in &mut shares[1..intervals] {
            *share = generator.between(0.02, 0.98);
        }
        shares.sort_by(f64::total_cmp);
    }
    let mut before = 0.0;
    let node = |share: f64| {
        let (back, forth) = (f64::max(share - STEP, 0.0), f64::min(share + STEP, 1.0));
        let moved = at(back).signed_turn_to(&at(forth)) / ((forth - back) * lasting);
        let ends = share <= 0.0 || share >= 1.0;
        let after_s = (share - before) * lasting;
        before = share;
        GuessNode {
            after_s,
            attitude: at(share),
            rate_rad_s: if ends { Vector3::zeros() } else { moved },
        }
    };
    shares.into_iter().map(node).collect()
}

/// What is found of a suite.
#[derive(Default)]
struct Report {
    legs: usize,
    unsolved: usize,
    excesses: Vec<f64>,
    shares: Vec<f64>,
    programs: u64,
    processor_s: f64,
}

impl Report {
    fn add(&mut self, key: &str, answer: &LegAnswer, best: f64, spent: f64, all: bool) {
        self.legs += 1;
        self.programs += answer.programs;
        self.processor_s += spent;
        let Some(duration) = answer.duration_s else {
            self.unsolved += 1;
            println!("{key}: not solved; best of twenty {best:.4} s");
            return;
        };
        let excess = duration / best - 1.0;
        self.excesses.push(excess);
        let bound = answer.certified_lower_bound_s.unwrap_or(0.0);
        self.shares.push(bound / duration);
        if all || excess > PRINTED {
            println!(
                "{key}: {duration:.4} s, best {best:.4} s, excess {:.3} %, bound {:.4}, {} programs, \
                 {:.2} ms",
                1e2 * excess,
                bound / duration,
                answer.programs,
                1e3 * spent,
            );
        }
    }

    fn print(&mut self, name: &str) {
        let above = |limit: f64| {
            self.excesses
                .iter()
                .filter(|excess| **excess > limit)
                .count()
        };
        let most = self.excesses.iter().copied().fold(0.0, f64::max);
        let counts = [above(PRINTED), above(LARGE)];
        self.shares.sort_by(f64::total_cmp);
        let median = self
            .shares
            .get(self.shares.len() / 2)
            .copied()
            .unwrap_or(0.0);
        println!(
            "{name}: {} legs, {} unsolved; {} above 0.1 %, {} above 0.5 %, at most {:.3} %; bound {median:.4} \
             of the duration in the median; {} programs, {:.3} ms of processor time in the mean",
            self.legs,
            self.unsolved,
            counts[0],
            counts[1],
            1e2 * most,
            self.programs,
            1e3 * self.processor_s / self.legs as f64,
        );
    }
}

/// Processor time of this thread so far, s.
fn processor_s() -> f64 {
    // Nanoseconds on the processor are the first number.
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let spent = text
        .split(' ')
        .next()
        .and_then(|text| text.parse::<f64>().ok());
    spent.unwrap_or(0.0) * 1e-9
}

/// Best durations by leg, s; the last one of a leg counts.
fn read(file: &str) -> BTreeMap<String, f64> {
    let text = std::fs::read_to_string(file).unwrap_or_default();
    let entries = text.lines().filter_map(|line| {
        let (key, duration) = line.rsplit_once('\t')?;
        Some((key.to_owned(), duration.parse().ok()?))
    });
    entries.collect()
}

fn append(file: &str, key: &str, duration: f64) {
    let mut open = std::fs::OpenOptions::new();
    let mut file = open.create(true).append(true).open(file).expect("a file");
    writeln!(file, "{key}\t{duration}").expect("room for the durations");
}
