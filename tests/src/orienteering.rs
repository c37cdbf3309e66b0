//! Published orienteering problems with windows, as tables of distances: Solomon's instances of routes
//! (1987) with the demand of a customer as its score, one vehicle of any capacity, and 50 or 100
//! customers (Righini and Salani 2009).
//!
//! A distance is Euclidean, cut off after one decimal; a second passes for each unit of it.

use slewplan_solver::model::order_rules::OrderRules;
use slewplan_solver::tour::order::Place;
use slewplan_solver::tour::schedule::{TimedProblem, TimedTarget, TravelTimes};

/// The depot and the customers in the plane, and all windows.
const C1: &str = include_str!("../fixtures/orienteering/c1.csv");
const R1: &str = include_str!("../fixtures/orienteering/r1.csv");
const RC1: &str = include_str!("../fixtures/orienteering/rc1.csv");

/// A published instance.
#[derive(Debug, Clone, Copy)]
pub struct Instance {
    /// The name of the windows.
    pub name: &'static str,
    /// Number of customers, the first ones of the file.
    pub customers: usize,
    /// The greatest score of a route, which is proved (Righini and Salani 2009).
    pub best: f64,
    file: &'static str,
}

/// The instances whose facts are written down.
#[must_use]
pub fn instances() -> Vec<Instance> {
    let facts = [
        (C1, "c101", 270.0, 320.0),
        (C1, "c105", 300.0, 340.0),
        (R1, "r101", 126.0, 198.0),
        (R1, "r105", 159.0, 247.0),
        (RC1, "rc101", 180.0, 219.0),
    ];
    let both = |(file, name, of_50, of_100): (&'static str, &'static str, f64, f64)| {
        [(50, of_50), (100, of_100)].map(|(customers, best)| Instance {
            name,
            customers,
            best,
            file,
        })
    };
    facts.into_iter().flat_map(both).collect()
}

/// Distances between a depot and customers.
pub struct Distances(Vec<[f64; 2]>);

impl TravelTimes for Distances {
    fn travel_s(&self, from: Place, to: Place) -> f64 {
        let at = |place| match place {
            Place::Target(customer) => self.0[customer + 1],
            Place::Start | Place::End => self.0[0],
        };
        let ([x, y], [u, v]) = (at(from), at(to));
        ((x - u).hypot(y - v) * 10.0).floor() / 10.0
    }
}

impl Instance {
    /// The instance as a schedule from the depot and back.
    ///
    /// # Panics
    ///
    /// If its file is no table of numbers.
    #[must_use]
    pub fn problem(&self) -> (TimedProblem, Distances) {
        let mut lines = self.file.lines();
        let head: Vec<&str> = lines.next().expect("a head").split(',').collect();
        let from = format!("{}_from", self.name);
        let first = head.iter().position(|name| **name == from);
        let first = first.expect("a column of windows");
        let row = |line: &str| -> Vec<f64> {
            let cells = line.split(',');
            cells.map(|cell| cell.parse().expect("a number")).collect()
        };
        let rows: Vec<Vec<f64>> = lines.take(self.customers + 1).map(row).collect();
        let target = |row: &Vec<f64>| TimedTarget {
            service_s: row[3],
            // The window is that of the begin of the visit.
            windows: Some(vec![[row[first], row[first + 1] + row[3]]]),
            value: Some(row[2]),
        };
        let problem = TimedProblem {
            targets: rows[1..].iter().map(target).collect(),
            rules: OrderRules::none(self.customers),
            has_end: true,
            latest_end_s: Some(rows[0][first + 1]),
        };
        let places = rows.iter().map(|row| [row[0], row[1]]).collect();
        (problem, Distances(places))
    }
}
