//! What the search of the order costs: random schedules of all sizes, solved and drawn.
//!
//! ```text
//! order_costs exact [SECONDS]                 4 to 20 targets, until proved or so long (default 120)
//! order_costs anytime [SECONDS ...]           25 to 200 targets, stopped after each of these times
//! order_costs one FAMILY TARGETS SEED SECONDS THREADS        FAMILY 0 to 3, see below
//! order_costs trace FAMILY TARGETS SEED SECONDS THREADS      order and bound as they improve
//! order_costs draw DIRECTORY                  what the two have printed, from standard input
//! ```
//!
//! Measurements are one line of comma-separated values each, so that a run can be interrupted,
//! joined with another, and drawn later.

mod drawing;

use slewplan_solver::model::plan::{Optimality, Outcome, Plan};
use slewplan_solver::model::scenario::Scenario;
use slewplan_solver::run::progress::{Observer, Progress};
use slewplan_solver::run::stop::StopSignal;
use slewplan_solver::tour::legs::NoStore;
use slewplan_solver::tour::planner::{self, Run};
use slewplan_tests::schedules::{RateConditions, Region, schedule};
use slewplan_tests::solving::pool;
use std::ops::Range;
use std::str::FromStr;
use std::sync::{Mutex, OnceLock};
use std::time::Instant;

/// Seeds of the schedules that are proved; of those that are not, the first alone.
const SEEDS: Range<u64> = 1..4;
const EXACT_SIZES: [usize; 9] = [4, 6, 8, 10, 12, 14, 16, 18, 20];
const ANYTIME_SIZES: [usize; 4] = [25, 50, 100, 200];
const FAMILIES: [(Region, RateConditions); 4] = [
    (Region::Sphere, RateConditions::AllZero),
    (Region::Strip, RateConditions::AllZero),
    (Region::Sphere, RateConditions::ZeroAboutZ),
    (Region::Strip, RateConditions::ZeroAboutZ),
];

/// Columns of the measurements.
const HEADER: &str = "mode,region,rates,targets,seed,limit_s,wall_s,first_s,total_s,bound_s,gap,\
                      status,kind,nodes,nlps";

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["draw", directory] => drawing::draw(directory),
        ["exact", limit @ ..] => {
            let limit_s = limit.first().map_or(120.0, |text| number(text));
            measure_all("exact", &EXACT_SIZES, &SEEDS, &[limit_s]);
        }
        ["anytime", limits @ ..] => {
            let limits: Vec<f64> = limits.iter().map(|text| number(text)).collect();
            measure_all(
                "anytime",
                &ANYTIME_SIZES,
                &(SEEDS.start..SEEDS.start + 1),
                &limits,
            );
        }
        ["one", family, targets, seed, limit, threads] => {
            println!("{HEADER}");
            measure(&case("one", [family, targets, seed, limit, threads]));
        }
        ["trace", family, targets, seed, limit, threads] => {
            println!("{TRACE_HEADER}");
            measure(&case("trace", [family, targets, seed, limit, threads]));
        }
        _ => eprintln!(
            "exact [SECONDS], anytime [SECONDS ...], one ..., trace ..., or draw DIRECTORY"
        ),
    }
}

/// The case that these words describe.
fn case<'a>(mode: &'a str, [family, targets, seed, limit, threads]: [&str; 5]) -> Case<'a> {
    Case {
        mode,
        family: FAMILIES[number::<usize>(family) % FAMILIES.len()],
        targets: number(targets),
        seed: number(seed),
        limit_s: number(limit),
        threads: number(threads),
    }
}

fn number<T: FromStr>(text: &str) -> T {
    text.parse().ok().expect("a number")
}

/// Columns of a trace.
const TRACE_HEADER: &str = "after_s,total_s,bound_s,gap";

/// What is measured.
struct Case<'a> {
    mode: &'a str,
    family: (Region, RateConditions),
    targets: usize,
    seed: u64,
    limit_s: f64,
    threads: usize,
}

/// Measures schedules of all families, of these sizes and seeds, with each of the limits, s.
fn measure_all(mode: &str, sizes: &[usize], seeds: &Range<u64>, limits: &[f64]) {
    println!("{HEADER}");
    for family in FAMILIES {
        for &targets in sizes {
            for seed in seeds.clone() {
                for &limit_s in limits {
                    measure(&Case {
                        mode,
                        family,
                        targets,
                        seed,
                        limit_s,
                        threads: 2,
                    });
                }
            }
        }
    }
}

/// Solves a schedule and prints what it took.
fn measure(case: &Case<'_>) {
    let (region, rates) = case.family;
    let mut spec = schedule(region, rates, case.targets, case.seed);
    spec.options.time_limit_s = Some(case.limit_s);
    spec.options.alternatives = 0;
    let scenario = Scenario::try_new(&spec).expect("valid").scenario;
    let first = FirstPlan {
        begin: Instant::now(),
        after_s: OnceLock::new(),
        traced: (case.mode == "trace").then(Mutex::default),
    };
    let run = Run {
        pool: &pool(case.threads),
        stop: &StopSignal::new(),
        observer: &first,
        legs: &NoStore,
        segments: &NoStore,
    };
    let outcome = planner::solve(&scenario, run);
    let wall = first.begin.elapsed().as_secs_f64();
    if case.mode == "trace" {
        println!("{HEADER}");
    }
    let Case {
        mode,
        targets,
        seed,
        limit_s,
        ..
    } = case;
    let row = format!("{mode},{region:?},{rates:?},{targets},{seed},{limit_s},{wall:.3}");
    let Outcome::Planned(plan) = outcome else {
        return println!("{row},,,,,none,,,");
    };
    let first = first.after_s.get().unwrap_or(&wall);
    println!("{row},{first:.3},{}", described(&plan));
}

/// The columns that tell of a plan.
fn described(plan: &Plan) -> String {
    let status = match plan.optimality {
        Optimality::Optimal => "optimal",
        Optimality::Feasible => "feasible",
    };
    format!(
        "{:.3},{:.3},{:.5},{status},{},{},{}",
        plan.total_time_s,
        plan.lower_bound_s,
        plan.relative_gap,
        plan.lower_bound_kind,
        plan.statistics.nodes_explored,
        plan.statistics.nlp_solves
    )
}

/// Notes when the first plan comes, and prints how order and bound improve where that is wanted.
struct FirstPlan {
    begin: Instant,
    after_s: OnceLock<f64>,
    /// Total and bound printed last, s.
    traced: Option<Mutex<[f64; 2]>>,
}

impl Observer for FirstPlan {
    fn progress(&self, progress: Progress) {
        let Some(traced) = &self.traced else {
            return;
        };
        let now = [progress.incumbent_s, progress.lower_bound_s].map(|value| value.unwrap_or(0.0));
        let mut last = traced.lock().expect("no panic");
        if last.map(f64::to_bits) != now.map(f64::to_bits) {
            *last = now;
            let after_s = self.begin.elapsed().as_secs_f64();
            let gap = progress.relative_gap().unwrap_or(1.0);
            println!("{after_s:.3},{:.3},{:.3},{gap:.5}", now[0], now[1]);
        }
    }

    fn incumbent(&self, _: &Plan) {
        self.after_s
            .get_or_init(|| self.begin.elapsed().as_secs_f64());
    }
}
