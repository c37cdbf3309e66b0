//! `slewplan plot`: a plan as a picture.

use super::failure::Failure;
use super::output::Destination;
use super::{Exit, input};
use crate::plot::{self, Boresight, WrittenPlan};
use std::path::{Path, PathBuf};

/// What `plot` takes.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The plan in JSON, - for standard input
    plan: PathBuf,
    /// Its scenario, which knows the limits, the keep-out cones and the boresights
    #[arg(long, value_name = "SCENARIO")]
    scenario: Option<PathBuf>,
    /// What to follow on the sphere: a boresight of the scenario, x, y, z, -x, -y or -z [default:
    /// the first boresight, or x]
    #[arg(long, value_name = "NAME", allow_hyphen_values = true)]
    boresight: Option<String>,
    /// Write the SVG to this file
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: PathBuf,
}

/// Draws the plan as it was written.
pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let inputs = [Some(&arguments.plan), arguments.scenario.as_ref()];
    let inputs: Vec<&Path> = inputs.into_iter().flatten().map(PathBuf::as_path).collect();
    input::one_stream_at_most(&inputs)?;
    let destination = Destination::open(&arguments.output)?;
    let scenario = arguments.scenario.as_deref();
    let scenario = scenario
        .map(|path| input::scenario(path, None))
        .transpose()?;
    let scenario = scenario.as_ref().map(|valid| &valid.scenario);
    let wrong = |name: &'static str| move |what: String| Failure::Setting { name, what };
    let plan = WrittenPlan::read(&input::read(&arguments.plan)?).map_err(wrong("PLAN"))?;
    let boresight =
        Boresight::find(arguments.boresight.as_deref(), scenario).map_err(wrong("--boresight"))?;
    let picture = plot::svg(&plan, scenario, &boresight).map_err(wrong("--scenario"))?;
    destination.write(&picture)?;
    Ok(Exit::Complete)
}
