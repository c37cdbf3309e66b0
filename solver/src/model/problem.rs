//! Problems of an input, with what the caller can do about them.

use std::fmt;
use strum::EnumMessage as _;

/// Limit of the reported problems of one input, for memory.
pub const MAX_KEPT: usize = 1000;
/// Limits of the names that a hint lists, and of the characters of each.
const NAMES_IN_A_HINT: usize = 10;
const CHARACTERS_OF_A_NAME: usize = 40;

/// One thing that is wrong, or doubtful, with an input.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// JSON pointer (RFC 6901) to the offending value in the scenario.
    pub pointer: String,
    /// Stable code.
    pub code: Code,
    /// What is wrong, with the numbers.
    pub message: String,
    /// What to do about it.
    pub hint: String,
}

impl Problem {
    /// Builds a problem at a pointer.
    pub fn new(
        pointer: impl Into<String>,
        code: Code,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) -> Self {
        Self {
            pointer: pointer.into(),
            code,
            message: message.into(),
            hint: hint.into(),
        }
    }

    /// A list at a pointer that has more entries than it may have.
    #[must_use]
    pub fn too_long(pointer: &str, entries: usize, most: usize) -> Self {
        Self::new(
            pointer,
            Code::WrongLength,
            format!("the list has {entries} entries, it may have {most}"),
            format!("list at most {most}"),
        )
    }

    /// The problem in a document that contains this one at a pointer.
    #[must_use]
    pub fn under(mut self, place: &str) -> Self {
        self.pointer.insert_str(0, place);
        self
    }

    /// All problems in a document that contains theirs at a pointer.
    #[must_use]
    pub fn all_under(place: &str, problems: Vec<Self>) -> Vec<Self> {
        let moved = |problem: Self| problem.under(place);
        problems.into_iter().map(moved).collect()
    }
}

/// Everything that was found in an input that is refused.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Faults {
    /// Why it is refused.
    pub problems: Vec<Problem>,
    /// Warnings, which alone would not refuse it.
    pub warnings: Vec<Problem>,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let pointer = if self.pointer.is_empty() {
            "(document)"
        } else {
            &self.pointer
        };
        write!(f, "{pointer}: {} [{}]", self.message, self.code)?;
        if !self.hint.is_empty() {
            write!(f, "\n    hint: {}", self.hint)?;
        }
        Ok(())
    }
}

/// The first of many names, in quotation marks and shortened, for a hint of limited length.
pub(crate) fn quoted<'a>(names: impl ExactSizeIterator<Item = &'a str>) -> String {
    let more = names.len().saturating_sub(NAMES_IN_A_HINT);
    let quote = |name: &str| match name.char_indices().nth(CHARACTERS_OF_A_NAME) {
        Some((end, _)) => format!("\"{}...\"", &name[..end]),
        None => format!("\"{name}\""),
    };
    let mut listed: Vec<String> = names.take(NAMES_IN_A_HINT).map(quote).collect();
    if more > 0 {
        listed.push(format!("or {more} others"));
    }
    listed.join(", ")
}

/// Stable codes of problems; the text form never changes its meaning.
///
/// The documentation of a code is its meaning in the error index, and its message the remedy there.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Hash,
    PartialOrd,
    Ord,
    strum::Display,
    strum::EnumMessage,
    strum::IntoStaticStr,
    strum::VariantArray,
)]
#[strum(serialize_all = "snake_case")]
#[non_exhaustive]
pub enum Code {
    /// The document is not valid JSON.
    #[strum(message = "Correct the syntax at the line and column of the message.")]
    MalformedJson,
    /// A required field is missing.
    #[strum(message = "Add the field.")]
    MissingField,
    /// A field that the schema does not know.
    #[strum(
        message = "Correct its name or remove it; unknown fields are refused so that a \
        misspelt limit is not silently none."
    )]
    UnknownField,
    /// The same key twice in one object.
    #[strum(message = "Keep the one that is meant.")]
    DuplicateField,
    /// A value of the wrong JSON type or shape.
    #[strum(message = "Write the value in the form that the message asks for.")]
    WrongType,
    /// A text outside the allowed choices.
    #[strum(message = "Take one of the choices of the hint.")]
    UnknownChoice,
    /// A number that is not finite.
    #[strum(message = "Write a finite number, or null where no limit is meant.")]
    NotFinite,
    /// A number outside its range.
    #[strum(message = "Take a number of the range in the message; look for a wrong unit.")]
    OutOfRange,
    /// An array whose length does not match.
    #[strum(
        message = "Write as many entries as the message asks for; lists of wheels have the \
        order of `wheels`."
    )]
    WrongLength,
    /// An attitude given in no form or in more than one.
    #[strum(
        message = "Give exactly one of quaternion, roll_pitch_yaw_deg, mrp, matrix, or \
        ra_dec_roll_deg together with boresight."
    )]
    AttitudeForm,
    /// A quaternion whose norm is too far from one.
    #[strum(message = "Normalise the quaternion; look for a wrong order of its components.")]
    QuaternionNorm,
    /// A quaternion or matrix that was off by little and has been normalised (warning).
    #[strum(message = "Write more digits, if the attitude is to be met as written.")]
    AttitudeNormalized,
    /// A matrix that is not a rotation.
    #[strum(
        message = "Write the body axes in the reference frame as orthonormal columns, \
        right-handed."
    )]
    MatrixNotRotation,
    /// An attitude form that has no quaternion sign where the sign matters.
    #[strum(
        message = "Write the attitude as a quaternion, or set attitude_equivalence to \
        rotation."
    )]
    SignUndefined,
    /// A direction of zero length.
    #[strum(message = "Give a direction of any length but zero.")]
    ZeroDirection,
    /// An inertia matrix that is not symmetric.
    #[strum(message = "Write the same product of inertia on both sides of the diagonal.")]
    InertiaNotSymmetric,
    /// An inertia matrix that is not positive definite.
    #[strum(message = "Look for a wrong sign of the products of inertia, or a wrong unit.")]
    InertiaNotPositive,
    /// Principal moments of inertia that no rigid body has.
    #[strum(
        message = "Look for a wrong unit: no principal moment exceeds the sum of the other \
        two."
    )]
    InertiaTriangle,
    /// Wheels whose own inertia exceeds what the body has about their axes.
    #[strum(
        message = "Give the inertia of the whole spacecraft with its wheels locked, and that \
        of the wheels about their own axes."
    )]
    WheelInertiaExceedsBody,
    /// Fewer than three enabled wheels.
    #[strum(message = "Enable at least three wheels.")]
    TooFewWheels,
    /// More enabled wheels than the solver is built for.
    #[strum(message = "Disable wheels.")]
    TooManyWheels,
    /// Enabled wheel axes that do not span space.
    #[strum(message = "Enable wheels whose axes are not in one plane.")]
    WheelAxesCoplanar,
    /// Torque limits that do not enclose zero.
    #[strum(message = "Write min_torque_nm below zero and max_torque_nm above.")]
    TorqueLimits,
    /// A wheel speed beyond its limit.
    #[strum(message = "Lower the speed, or raise the limit or momentum_authority.")]
    WheelSpeedLimit,
    /// A body rate beyond its limit.
    #[strum(message = "Lower the rate or raise the limit.")]
    BodyRateLimit,
    /// Lower bound above the upper bound.
    #[strum(message = "Exchange the bounds, or remove one.")]
    EmptyRange,
    /// Two things with the same identifier.
    #[strum(message = "Give every one a name of its own.")]
    DuplicateId,
    /// A name that refers to nothing.
    #[strum(message = "Correct the name, or define what it stands for.")]
    UnknownReference,
    /// Fields that exclude each other.
    #[strum(message = "Make the fields agree, or keep one of them.")]
    ConflictingFields,
    /// A place in the order that another target has already.
    #[strum(message = "Give every position to one target.")]
    PositionTaken,
    /// Targets that come after each other in a circle.
    #[strum(message = "Remove one of the demands of the circle.")]
    OrderCycle,
    /// Positions and precedences of targets that no order keeps together.
    #[strum(message = "Relax the positions or the precedences that the message names.")]
    OrderInfeasible,
    /// Wheel speeds at the end that contradict the conserved angular momentum.
    #[strum(
        message = "Leave the wheel speeds at the end out, or compute them from the momentum of \
        the start."
    )]
    EndMomentumInconsistent,
    /// The wheels cannot hold the stored momentum at a required rest.
    #[strum(
        message = "Unload momentum first, raise momentum_authority, enable more wheels, or \
        leave a rate component free."
    )]
    MomentumExceedsEnvelope,
    /// A leg for which no solution was found that meets all conditions.
    #[strum(
        message = "Check that the wheels can hold the stored momentum along the way, or relax \
        the conditions at the ends."
    )]
    SlewNotSolved,
    /// No way around the cones was found between two attitudes, or there is none.
    #[strum(
        message = "Narrow the cones, move an attitude, or put a target where the way leads around."
    )]
    NoClearPath,
    /// The solve was stopped, by its time limit or on request, before there was a first plan.
    #[strum(message = "Allow more time, or plan fewer targets at once.")]
    StoppedWithoutPlan,
    /// The solve needed more memory than a job of the service may take before there was a first plan.
    #[strum(message = "Plan fewer targets at once, or raise --job-memory of the service.")]
    MemoryLimit,
    /// The finished plan failed its independent verification.
    #[strum(message = "Report it with the scenario, and do not use the plan.")]
    VerificationFailed,
    /// An order takes less time than a lower bound allowed: the bounds are doubtful (warning).
    #[strum(message = "Take the bound as doubtful; the plan itself is verified.")]
    BoundContradicted,
    /// An epoch that is no calendar date with a time.
    #[strum(message = "Write it like 2026-01-31T12:00:00Z, in the scenario's time system.")]
    InvalidEpoch,
    /// A document of another kind than was asked for.
    #[strum(message = "Give the document that the message asks for.")]
    WrongDocument,
    /// A reference frame that turns, although plans are computed in inertial axes (warning).
    #[strum(message = "Name the inertial frame in which the attitudes are given.")]
    RotatingFrame,
    /// A limit of the body rate far beyond what the wheels reach, as of degrees for radians (warning).
    #[strum(message = "Write the limit in rad/s, or null where no limit is meant.")]
    RateLimitUnreachable,
    /// Large wheels that turn at thousands of rad/s, as of rpm for rad/s (warning).
    #[strum(message = "Write the speed in rad/s: rpm times 0.10472.")]
    WheelSpeedImplausible,
    /// Wheels that accelerate the body as no spacecraft does, as of g mm2 for kg m2 (warning).
    #[strum(message = "Write inertias in kg m2 and torques in N m.")]
    AccelerationImplausible,
    /// A scenario with an end and without targets (warning).
    #[strum(message = "List targets, unless a single slew to the end is meant.")]
    NoTargets,
    /// A plan takes less time than its own lower bound, so that one of them is false.
    #[strum(message = "Make the plan again, and do not trust what it says of itself.")]
    BoundAboveTime,
    /// A boresight enters a keep-out cone, or leaves a keep-in cone, that is only reported (warning).
    #[strum(
        message = "Look at time and depth, and move targets or demand another order if the \
        plan cannot be flown so."
    )]
    KeepOutViolated,
    /// An attitude of the scenario points a boresight to the wrong side of a cone that is only
    /// reported (warning).
    #[strum(
        message = "Turn the attitude about another axis or move it, or change the cone; every plan \
        through this attitude violates it."
    )]
    AttitudeInKeepOut,
    /// An attitude of the scenario points a boresight to the wrong side of a cone that is enforced
    /// there, so that there is no plan.
    #[strum(
        message = "Turn the attitude about another axis or move it, change the cone, or only have \
        it reported."
    )]
    AttitudeViolatesCone,
    /// A boresight is to be pointed, but limits of the roll about it and enforced cones leave no roll,
    /// so that there is no plan.
    #[strum(
        message = "Widen the limits of the roll, move the direction, change the cones, or only have \
        them reported."
    )]
    NoRollLeft,
    /// A free roll where the computation needs a given one.
    #[strum(message = "Give equal limits of the roll, or an attitude.")]
    RollNotFree,
    /// A direction of a body of the sky in a scenario without an epoch.
    #[strum(message = "Give the epoch of time zero, or the direction as a vector.")]
    EpochRequired,
    /// Windows of one target that have some time in common.
    #[strum(message = "Join the windows.")]
    WindowsOverlap,
    /// A window in which no visit fits, whatever the plan (warning).
    #[strum(
        message = "Look for a wrong unit or epoch, for settle and dwell longer than the window, or for \
        a latest end before it."
    )]
    WindowUnusable,
    /// A target that has to be visited and can be reached in none of its windows.
    #[strum(
        message = "Give the target a value, so that it may be left out, or another window; or begin \
        the schedule earlier."
    )]
    WindowUnreachable,
    /// Targets that all have to be visited, and that no order visits inside their windows.
    #[strum(
        message = "Give one of the targets of the message a value, so that it may be left out, or \
        widen a window or latest_end_s."
    )]
    WindowsConflict,
    /// A scenario with windows, values or a latest end in a form that cannot be planned yet.
    #[strum(message = "Let every target be visited at rest, or leave windows and values out.")]
    ClockNotPlanned,
    /// A file of another version of the program.
    #[strum(message = "Make the file again with this version.")]
    VersionMismatch,
    /// A part of another table of legs than the parts before it.
    #[strum(message = "Join only files of slewplan legs that differ in --shard alone.")]
    ShardMismatch,
    /// A part of a table of legs that is given twice.
    #[strum(message = "Name every part once.")]
    ShardRepeated,
    /// A part of a table of legs that is missing.
    #[strum(message = "Solve the part that the message names.")]
    ShardMissing,
    /// A table of legs, or a part of one, that lacks legs.
    #[strum(message = "Solve the part again and let it end.")]
    TableIncomplete,
    /// A leg that does not meet its conditions when it is propagated, or is slower than the
    /// eigenaxis slew.
    #[strum(message = "Solve it again with slewplan legs.")]
    LegRefused,
}

impl Code {
    /// What it says about an input, as a sentence.
    #[must_use]
    pub fn meaning(self) -> &'static str {
        self.get_documentation().unwrap_or_default()
    }

    /// What to do about it, as a sentence.
    #[must_use]
    pub fn remedy(self) -> &'static str {
        self.get_message().unwrap_or_default()
    }
}
