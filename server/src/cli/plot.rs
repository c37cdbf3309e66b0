//! `slewplan plot`: draws plans and other answers as SVG.

use super::failure::Failure;
use super::output::Destination;
use super::{Exit, input};
use crate::documents;
use crate::documents::kind::Kind;
use crate::documents::slew;
use crate::render::plot::{
    self, DrawableDocument, DrawnBoresight, Marks, WrittenComparison, WrittenEnvelopes,
    WrittenFlight, WrittenPlan, WrittenSlews,
};
use slewplan_solver::model::scenario::Scenario;
use std::path::{Path, PathBuf};

/// Arguments of `plot`.
#[derive(Debug, clap::Args)]
pub(super) struct PlotArguments {
    /// What to draw, - for standard input: a plan, the answer to a slew, to a study of a flight or
    /// of wheels, or answers to slews with a sweep, which are drawn as trade curves in one picture
    #[arg(required = true, value_name = "DOCUMENT")]
    documents: Vec<PathBuf>,
    /// The scenario of the plan or flight, for limits, keep-out cones and boresights; for a single
    /// slew its request
    #[arg(long, value_name = "SCENARIO")]
    scenario: Option<PathBuf>,
    /// Direction drawn on the sphere of a plan: a boresight of the scenario, x, y, z, -x, -y or -z
    /// [default: the first boresight, or x]
    #[arg(long, value_name = "NAME", allow_hyphen_values = true)]
    boresight: Option<String>,
    /// Which turn of a study of envelopes, counted from 0 [default: 0]
    #[arg(long, value_name = "N")]
    turn: Option<usize>,
    /// Mark this value of the swept quantity in a trade curve; may be given several times
    #[arg(long, value_name = "VALUE")]
    mark: Vec<f64>,
    /// Mark this cost in a trade curve, and where curves cross it; may be given several times
    #[arg(long, value_name = "VALUE")]
    level: Vec<f64>,
    /// Write the SVG to this file
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: PathBuf,
}

/// Draws the documents.
pub(super) fn run(arguments: &PlotArguments) -> Result<Exit, Failure> {
    let inputs = arguments.documents.iter().chain(&arguments.scenario);
    let inputs: Vec<&Path> = inputs.map(PathBuf::as_path).collect();
    input::one_stream_at_most(&inputs)?;
    let destination = Destination::open(&arguments.output)?;
    let documents: Result<Vec<DrawableDocument>, Failure> = arguments
        .documents
        .iter()
        .map(|path| drawable(path))
        .collect();
    let mut documents = documents?;
    let picture = if documents.iter().all(DrawableDocument::is_swept) || documents.len() > 1 {
        trade(documents, arguments)
    } else {
        // The list has exactly one document.
        match documents.pop() {
            Some(DrawableDocument::Plan(plan)) => draw_plan(&plan, arguments),
            Some(DrawableDocument::Slews(slew)) => draw_slew(&slew, arguments),
            Some(DrawableDocument::Comparison(study)) => draw_comparison(&study, arguments),
            Some(DrawableDocument::Envelopes(study)) => draw_envelopes(&study, arguments),
            Some(DrawableDocument::Flight(flight)) => draw_flight(&flight, arguments),
            None => Err(wrong("DOCUMENT")("there is none".to_owned())),
        }
    };
    destination.write(&picture?)?;
    Ok(Exit::Complete)
}

fn drawable(path: &Path) -> Result<DrawableDocument, Failure> {
    let bytes = input::read(path)?;
    let name = input::name(path);
    let other = match documents::document::parse(&bytes) {
        Ok(node) => Kind::Plan
            .mismatch(&node)
            .filter(|_| Kind::of(&node) != Some(Kind::SlewAnswer)),
        Err(malformed) => Some(malformed),
    };
    if let Some(problem) = other {
        let problems = vec![problem];
        return Err(Failure::Invalid { name, problems });
    }
    let named = |what| wrong("DOCUMENT")(format!("{name}: {what}"));
    DrawableDocument::read(&bytes).map_err(named)
}

fn wrong(name: &'static str) -> impl Fn(String) -> Failure {
    move |what| Failure::Setting { name, what }
}

fn draw_plan(plan: &WrittenPlan, arguments: &PlotArguments) -> Result<String, Failure> {
    arguments.refuse_marks()?;
    arguments.refuse_turn()?;
    let scenario = arguments.scenario()?;
    let scenario = scenario.as_ref();
    let boresight = DrawnBoresight::find(arguments.boresight.as_deref(), scenario)
        .map_err(wrong("--boresight"))?;
    plot::plan(plan, scenario, &boresight).map_err(wrong("--scenario"))
}

fn draw_slew(answer: &WrittenSlews, arguments: &PlotArguments) -> Result<String, Failure> {
    arguments.refuse_marks()?;
    arguments.refuse_turn()?;
    arguments.refuse_boresight()?;
    let request = arguments.scenario.as_deref().map(|path| {
        slew::read(&input::read(path)?).map_err(|problems| Failure::Invalid {
            name: input::name(path),
            problems,
        })
    });
    let request = request.transpose()?;
    let scenario = request.as_ref().map(|it| it.slew.scenario());
    plot::slew(answer, scenario).map_err(wrong("DOCUMENT"))
}

fn draw_flight(flight: &WrittenFlight, arguments: &PlotArguments) -> Result<String, Failure> {
    arguments.refuse_marks()?;
    arguments.refuse_turn()?;
    arguments.refuse_boresight()?;
    let scenario = arguments.scenario()?;
    plot::flight(flight, scenario.as_ref()).map_err(wrong("DOCUMENT"))
}

fn draw_comparison(
    study: &WrittenComparison,
    arguments: &PlotArguments,
) -> Result<String, Failure> {
    arguments.refuse_marks()?;
    arguments.refuse_turn()?;
    arguments.refuse_boresight()?;
    arguments.refuse_scenario()?;
    plot::comparison(study).map_err(wrong("DOCUMENT"))
}

fn draw_envelopes(study: &WrittenEnvelopes, arguments: &PlotArguments) -> Result<String, Failure> {
    arguments.refuse_marks()?;
    arguments.refuse_boresight()?;
    arguments.refuse_scenario()?;
    plot::envelopes(study, arguments.turn.unwrap_or(0)).map_err(wrong("--turn"))
}

fn trade(documents: Vec<DrawableDocument>, arguments: &PlotArguments) -> Result<String, Failure> {
    arguments.refuse_turn()?;
    arguments.refuse_boresight()?;
    arguments.refuse_scenario()?;
    let answers: Option<Vec<WrittenSlews>> = documents
        .into_iter()
        .map(|document| match document {
            DrawableDocument::Slews(answer) => Some(answer),
            _ => None,
        })
        .collect();
    let together = "only answers to slews with a sweep can be drawn together";
    let answers = answers.ok_or_else(|| wrong("DOCUMENT")(together.to_owned()))?;
    let marks = Marks {
        swept: arguments.mark.clone(),
        cost: arguments.level.clone(),
    };
    plot::trade(&answers, &marks).map_err(wrong("DOCUMENT"))
}

impl PlotArguments {
    fn scenario(&self) -> Result<Option<Scenario>, Failure> {
        let path = self.scenario.as_deref();
        path.map(|path| Ok(input::scenario(path, None)?.scenario))
            .transpose()
    }

    fn refuse_marks(&self) -> Result<(), Failure> {
        if self.mark.is_empty() && self.level.is_empty() {
            return Ok(());
        }
        Err(wrong("--mark and --level")(
            "only trade curves have marks".to_owned(),
        ))
    }

    fn refuse_turn(&self) -> Result<(), Failure> {
        match self.turn {
            None => Ok(()),
            Some(_) => Err(wrong("--turn")(
                "only a study of envelopes has turns".to_owned(),
            )),
        }
    }

    fn refuse_scenario(&self) -> Result<(), Failure> {
        match self.scenario {
            None => Ok(()),
            Some(_) => Err(wrong("--scenario")(
                "this picture has no limits to draw".to_owned(),
            )),
        }
    }

    fn refuse_boresight(&self) -> Result<(), Failure> {
        match self.boresight {
            None => Ok(()),
            Some(_) => Err(wrong("--boresight")(
                "only the picture of a plan has a sphere".to_owned(),
            )),
        }
    }
}
