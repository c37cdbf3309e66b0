//! Envelopes of a spacecraft's wheels, slews within them, and the allocation of demands.
//!
//! For every turn from rest to rest, without stored momentum, the study has the slews about the
//! eigenaxis under each [limit](crate::eigenaxis::EnvelopeLimit) and, on request, the fastest ones, with
//! every torque chosen by itself and with torques allocated by the pseudo-inverse; all with their
//! paths within the envelopes (RW/CMG thesis, figures 71 to 76).

use crate::eigenaxis::{Baselines, EigenaxisBaseline};
use crate::envelope_path::EnvelopePath;
use nalgebra::Vector3;
use slewplan_solver::model::attitude::{Attitude, AttitudeContext};
use slewplan_solver::model::findings::Findings;
use slewplan_solver::model::input::{self, UpTo, input_object, optional, or, required_or};
use slewplan_solver::model::plan::Control;
use slewplan_solver::model::problem::{Code, Problem};
use slewplan_solver::model::spacecraft::Spacecraft;
use slewplan_solver::model::spec::{
    AttitudeEquivalence, AttitudeSpec, PairSpec, SpacecraftOrReference, SpacecraftSpec, StateSpec,
};
use slewplan_solver::run::pool::SolverPool;
use slewplan_solver::run::stop::StopSignal;
use slewplan_solver::slew::{
    self, FinalWheels, Slew, SlewOptionsSpec, SlewOutcome, SlewSpec, WheelAllocation,
};
use slewplan_solver::wheels::allocation::{self, DemandAllocation};
use slewplan_solver::wheels::array::{Envelopes, SpacecraftEnvelopes, authority_problems};

/// Greatest number of turns of a study, each with two optimisations at most.
pub const MAX_TURNS: usize = 100;
/// Greatest number of demands of a study, each with a linear program.
pub const MAX_DEMANDS: usize = 1000;
/// Turns below this angle, rad, count as none.
const MIN_ANGLE: f64 = 1e-9;

input_object! {
    /// What the wheels of a spacecraft can do together.
    pub struct EnvelopeStudySpec as "EnvelopeStudy" {
        /// Free text, on which nothing depends.
        pub name: Option<String> = optional(),
        /// Options of the study.
        pub options: EnvelopeOptionsSpec = or(EnvelopeOptionsSpec::default()),
        /// The spacecraft.
        pub spacecraft: SpacecraftSpec as SpacecraftOrReference
            = required_or(SpacecraftSpec::substitute()),
        /// From rest to rest, the shorter way round.
        pub turns: Vec<PairSpec> as UpTo<MAX_TURNS, PairSpec> = or(Vec::new()),
        /// Sums of the wheels' torques, body axes; the body gets the opposite.
        pub demands_nm: Vec<[f64; 3]> as UpTo<MAX_DEMANDS, [f64; 3]> = or(Vec::new()),
        /// Whether the turns are wanted in minimum time too.
        pub time_optimal: bool = or(false),
    }
}

input_object! {
    /// Options of a study of envelopes.
    pub struct EnvelopeOptionsSpec as "EnvelopeOptions" {
        /// Share of every torque limit that may be used.
        pub torque_authority: f64 = or(1.0).above(0.0).at_most(1.0),
        /// Share of every wheel speed limit that may be used.
        pub momentum_authority: f64 = or(1.0).above(0.0).at_most(1.0),
    }
}

impl Default for EnvelopeOptionsSpec {
    fn default() -> Self {
        input::left_out::<Self>()
    }
}

/// A valid study.
#[derive(Debug, Clone)]
pub struct EnvelopeStudy {
    spacecraft: Spacecraft,
    baselines: Baselines,
    turns: Vec<StudiedTurn>,
    demands: Vec<Vector3<f64>>,
}

#[derive(Debug, Clone)]
struct StudiedTurn {
    /// Axis times angle, body axes, rad.
    vector: Vector3<f64>,
    /// The slews to optimise.
    slews: Vec<Slew>,
}

/// The results of a study.
#[derive(Debug, Clone)]
pub struct EnvelopeReport {
    /// The envelopes with the usable shares of the limits.
    pub envelopes: SpacecraftEnvelopes,
    /// The turns, in their order.
    pub turns: Vec<TurnReport>,
    /// The demands, in their order.
    pub demands: Vec<DemandReport>,
    /// Whether every slew was reached before the stop signal.
    pub complete: bool,
}

impl EnvelopeReport {
    /// Number of slews in minimum time that were not solved.
    #[must_use]
    pub fn unsolved(&self) -> usize {
        let tried = self.turns.iter().flat_map(|turn| &turn.time_optimal);
        tried.filter(|slew| slew.found.is_none()).count()
    }
}

/// The slews of one turn.
#[derive(Debug, Clone)]
pub struct TurnReport {
    /// Axis times angle, body axes, rad.
    pub vector: Vector3<f64>,
    /// About the eigenaxis, in the order of [`crate::eigenaxis::EnvelopeLimit::ALL`].
    pub eigenaxis: Vec<(EigenaxisBaseline, EnvelopePath)>,
    /// The fastest slews that were asked for, as far as they were tried before a stop.
    pub time_optimal: Vec<TimeOptimalSlew>,
}

/// A slew in minimum time; null-space momentum is zero at both ends.
#[derive(Debug, Clone)]
pub struct TimeOptimalSlew {
    /// How torque is allocated.
    pub allocation: WheelAllocation,
    /// Status of the program: `converged`, or why it did not converge.
    pub status: String,
    /// Duration, s, and path within the envelopes; `None` when no verified slew was found.
    pub found: Option<(f64, EnvelopePath)>,
}

/// A demand and its two allocations.
#[derive(Debug, Clone)]
pub struct DemandReport {
    /// The demand, N m.
    pub torque: Vector3<f64>,
    /// By the pseudo-inverse.
    pub pseudo_inverse: DemandAllocation,
    /// With the least load; `None` when the linear program could not be solved.
    pub least_load: Option<DemandAllocation>,
}

impl EnvelopeStudy {
    /// Validates a description and returns warnings with the study. Pointers are those of the fields:
    /// `/spacecraft`, `/options`, `/turns`, `/demands_nm`.
    ///
    /// # Errors
    ///
    /// All problems at once.
    pub fn try_new(spec: &EnvelopeStudySpec) -> Result<(Self, Vec<Problem>), Vec<Problem>> {
        let mut findings = Findings::default();
        let spacecraft = Spacecraft::read(&spec.spacecraft, "/spacecraft", &mut findings);
        let context = AttitudeContext {
            equivalence: AttitudeEquivalence::Rotation,
            boresights: &spec.spacecraft.boresights,
        };
        let shares = &spec.options;
        let (torque, momentum) = (shares.torque_authority, shares.momentum_authority);
        let baselines = match &spacecraft {
            Some(spacecraft) => Baselines::of(spacecraft, torque, momentum),
            None => Err(authority_problems(torque, momentum)),
        };
        let baselines = baselines
            .map_err(|problems| findings.include(problems))
            .ok();
        findings.at_most("/turns", spec.turns.len(), MAX_TURNS);
        findings.at_most("/demands_nm", spec.demands_nm.len(), MAX_DEMANDS);
        let vectors: Vec<_> = spec
            .turns
            .iter()
            .enumerate()
            .map(|(i, turn)| read_turn(turn, context, &format!("/turns/{i}"), &mut findings))
            .collect();
        let demands: Vec<_> = spec
            .demands_nm
            .iter()
            .enumerate()
            .map(|(i, torque)| findings.vector(&format!("/demands_nm/{i}"), *torque))
            .collect();
        let read = (|| {
            Some((
                spacecraft?,
                baselines?,
                vectors.into_iter().collect::<Option<Vec<_>>>()?,
                demands.into_iter().collect::<Option<Vec<_>>>()?,
            ))
        })();
        let ((spacecraft, baselines, vectors, demands), warnings) = findings.conclude(read)?;
        let beyond = beyond_numbers(&baselines, &vectors, &demands);
        if !beyond.is_empty() {
            return Err(beyond);
        }
        let turns = vectors.into_iter().zip(&spec.turns).map(|(vector, turn)| {
            let slews = if spec.time_optimal {
                fastest(spec, turn)?
            } else {
                Vec::new()
            };
            Ok(StudiedTurn { vector, slews })
        });
        let study = Self {
            turns: turns.collect::<Result<_, Vec<Problem>>>()?,
            spacecraft,
            baselines,
            demands,
        };
        Ok((study, warnings))
    }

    /// Conducts the study; slews that the stop signal interrupts are left out.
    #[must_use]
    pub fn conduct(&self, pool: &SolverPool, stop: &StopSignal) -> EnvelopeReport {
        let torque = &self.baselines.envelopes().torque.array;
        let demands = self.demands.iter().map(|demand| DemandReport {
            torque: *demand,
            pseudo_inverse: allocation::pseudo_inverse(torque, demand),
            least_load: allocation::least_load(torque, demand).filter(is_finite),
        });
        EnvelopeReport {
            envelopes: self.baselines.envelopes().clone(),
            demands: demands.collect(),
            turns: pool.map(&self.turns, |turn| self.turn(turn, stop)),
            complete: !stop.is_set(),
        }
    }

    fn turn(&self, turn: &StudiedTurn, stop: &StopSignal) -> TurnReport {
        let envelopes = self.baselines.envelopes();
        let slews = self.baselines.slews(&turn.vector).into_iter().flatten();
        let mut time_optimal = Vec::new();
        for slew in &turn.slews {
            if stop.is_set() {
                break;
            }
            let outcome = slew::solve(slew, stop);
            // An interrupted solve has no result.
            if stop.is_set() && !outcome.solved {
                break;
            }
            time_optimal.push(TimeOptimalSlew {
                allocation: slew.allocation(),
                found: outcome
                    .solved
                    .then(|| (outcome.time_s, self.path_of(&outcome))),
                status: outcome.status,
            });
        }
        TurnReport {
            vector: turn.vector,
            eigenaxis: slews
                .map(|slew| (slew, EnvelopePath::of_eigenaxis_slew(envelopes, &slew)))
                .collect(),
            time_optimal,
        }
    }

    fn path_of(&self, outcome: &SlewOutcome) -> EnvelopePath {
        // Torques on intervals of free length are constant.
        let pieces = outcome.propagated.pieces.iter().map(|piece| Control {
            start_s: piece.start_s,
            duration_s: piece.duration_s,
            wheel_torque_nm: piece.torque_begin_nm.clone(),
        });
        EnvelopePath::of_flight(
            self.baselines.envelopes(),
            &self.spacecraft,
            &outcome.propagated.states,
            &pieces.collect::<Vec<_>>(),
        )
    }
}

/// Problems with results that overflow: finite limits can have volumes, durations or loads that are not
/// finite.
fn beyond_numbers(
    baselines: &Baselines,
    turns: &[Vector3<f64>],
    demands: &[Vector3<f64>],
) -> Vec<Problem> {
    let envelopes = baselines.envelopes();
    let arrays = std::iter::once(&envelopes.torque).chain(&envelopes.momentum);
    let mut polytopes = arrays.flat_map(|array| {
        let Envelopes {
            full,
            pseudo_inverse,
        } = &array.envelopes;
        [full, pseudo_inverse]
    });
    let sound = polytopes.all(|polytope| {
        let figures = polytope.size();
        figures.volume.is_normal() && figures.mean_radius.is_normal()
    });
    let problem = |pointer: String, what: &str| {
        let hint = "look for a wrong unit among the limits of the wheels and the inertia";
        Problem::new(pointer, Code::OutOfRange, what, hint)
    };
    if !sound {
        let what = "the size of the wheels' envelope overflows";
        return vec![problem("/spacecraft/wheels".to_owned(), what)];
    }
    let slow = turns.iter().enumerate().filter(|(_, turn)| {
        let slews = baselines.slews(turn).into_iter().flatten();
        let mut durations = slews.map(|slew| slew.course.duration());
        !durations.all(f64::is_normal)
    });
    let slow = slow.map(|(i, _)| {
        let what = "the duration of the turn about the eigenaxis overflows";
        problem(format!("/turns/{i}"), what)
    });
    let torque = &envelopes.torque.array;
    let heavy = demands
        .iter()
        .enumerate()
        .filter(|(_, demand)| !is_finite(&allocation::pseudo_inverse(torque, demand)));
    let heavy = heavy.map(|(i, _)| {
        let what = "the allocation of the torque to the wheels overflows";
        problem(format!("/demands_nm/{i}"), what)
    });
    slow.chain(heavy).collect()
}

fn is_finite(allocation: &DemandAllocation) -> bool {
    allocation.load.is_finite() && allocation.wheels.iter().all(|wheel| wheel.is_finite())
}

/// The rotation vector of a turn, rad.
fn read_turn(
    spec: &PairSpec,
    context: AttitudeContext<'_>,
    pointer: &str,
    findings: &mut Findings,
) -> Option<Vector3<f64>> {
    let mut read = |spec, name| {
        let pointer = format!("{pointer}/{name}");
        Attitude::read(spec, context, &pointer, findings)
    };
    let (from, to) = (read(&spec.from, "from"), read(&spec.to, "to"));
    let (from, to) = (from?, to?);
    let vector = from.signed_turn_to(&to.nearest_sign(&from));
    if vector.norm() < MIN_ANGLE {
        findings.refuse(
            pointer,
            Code::ZeroDirection,
            "both attitudes are the same, so the turn has no axis",
            "give two attitudes that differ",
        );
        return None;
    }
    Some(vector)
}

/// The slews to optimise for a valid turn.
fn fastest(spec: &EnvelopeStudySpec, turn: &PairSpec) -> Result<Vec<Slew>, Vec<Problem>> {
    let at = |attitude: &AttitudeSpec| StateSpec {
        attitude: attitude.clone(),
        ..StateSpec::default()
    };
    WheelAllocation::ALL
        .iter()
        .map(|&allocation| {
            let spec = SlewSpec {
                spacecraft: spec.spacecraft.clone(),
                start: at(&turn.from),
                end: at(&turn.to),
                final_wheels: FinalWheels::NullSpaceOfStart,
                options: SlewOptionsSpec {
                    torque_authority: spec.options.torque_authority,
                    momentum_authority: spec.options.momentum_authority,
                    ..SlewOptionsSpec::default()
                },
                allocation,
                ..SlewSpec::default()
            };
            Ok(Slew::try_new(&spec)?.slew)
        })
        .collect()
}
