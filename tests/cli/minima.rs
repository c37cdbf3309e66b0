//! Tours with local minima that are far from the least: `fixtures/minima`.

use crate::run::{fixture, fixture_json, slewplan};
use serde_json::Value;

/// Four wheels and more without momentum and with it, and rates that are free, zero or in a range at
/// targets, which all admit rest.
const NAMES: [&str; 4] = [
    "six-wheels-momentum",
    "range-of-rates",
    "ranges-of-rates",
    "momentum-free-rates",
];

/// What a list of objects has in a field, in all; nothing where the field is missing.
fn sum(list: &Value, field: &str) -> f64 {
    let objects = list.as_array().expect("a list").iter();
    objects.filter_map(|object| object[field].as_f64()).sum()
}

/// To stop at every target is a plan of the same scenario.
#[test]
fn no_plan_takes_longer_than_its_legs_from_rest_to_rest() {
    for name in NAMES.map(|name| format!("minima/{name}.json")) {
        let plan = slewplan(&["solve", &fixture(&name)]).expect_code(0).json();
        let targets = &fixture_json(&name)["targets"];
        let services = sum(targets, "dwell_s") + sum(targets, "settle_s");
        let stopping = sum(&plan["legs"], "rest_to_rest_duration_s") + services;
        let total = plan["total_time_s"].as_f64().expect("a number");
        assert!(
            stopping > 0.0 && total <= stopping,
            "{name}: {total} s, {stopping} s"
        );
    }
}
