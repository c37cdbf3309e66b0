//! Problems of an input, with what the caller can do about them.

use std::fmt;

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

macro_rules! codes {
    ($($(#[doc = $doc:literal])+ $name:ident = $text:literal, $remedy:literal;)+) => {
        /// Stable codes of problems; the text form never changes its meaning.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[non_exhaustive]
        pub enum Code {
            $($(#[doc = $doc])+ $name,)+
        }

        impl Code {
            /// All codes, for the error index.
            pub const ALL: &'static [Code] = &[$(Code::$name,)+];

            /// The stable text of the code.
            #[must_use]
            pub const fn as_str(self) -> &'static str {
                match self { $(Code::$name => $text,)+ }
            }

            /// The meaning of the code, as a sentence.
            #[must_use]
            pub fn meaning(self) -> &'static str {
                match self { $(Code::$name => concat!($($doc),+).trim(),)+ }
            }

            /// What to do about it, as a sentence.
            #[must_use]
            pub const fn remedy(self) -> &'static str {
                match self { $(Code::$name => $remedy,)+ }
            }
        }
    };
}

codes! {
    /// The document is not valid JSON.
    MalformedJson = "malformed_json",
        "Correct the syntax at the line and column of the message.";
    /// A required field is missing.
    MissingField = "missing_field",
        "Add the field.";
    /// A field that the schema does not know.
    UnknownField = "unknown_field",
        "Correct its name or remove it; unknown fields are refused so that a misspelt limit is not \
         silently none.";
    /// The same key twice in one object.
    DuplicateField = "duplicate_field",
        "Keep the one that is meant.";
    /// A value of the wrong JSON type or shape.
    WrongType = "wrong_type",
        "Write the value in the form that the message asks for.";
    /// A text outside the allowed choices.
    UnknownChoice = "unknown_choice",
        "Take one of the choices of the hint.";
    /// A number that is not finite.
    NotFinite = "not_finite",
        "Write a finite number, or null where no limit is meant.";
    /// A number outside its range.
    OutOfRange = "out_of_range",
        "Take a number of the range in the message; look for a wrong unit.";
    /// An array whose length does not match.
    WrongLength = "wrong_length",
        "Write as many entries as the message asks for; lists of wheels have the order of \
         `wheels`.";
    /// An attitude given in no form or in more than one.
    AttitudeForm = "attitude_form",
        "Give exactly one of quaternion, roll_pitch_yaw_deg, mrp, matrix, or ra_dec_roll_deg \
         together with boresight.";
    /// A quaternion whose norm is too far from one.
    QuaternionNorm = "quaternion_norm",
        "Normalise the quaternion; look for a wrong order of its components.";
    /// A quaternion or matrix that was off by little and has been normalised (warning).
    AttitudeNormalized = "attitude_normalized",
        "Write more digits, if the attitude is to be met as written.";
    /// A matrix that is not a rotation.
    MatrixNotRotation = "matrix_not_rotation",
        "Write the body axes in the reference frame as orthonormal columns, right-handed.";
    /// An attitude form that has no quaternion sign where the sign matters.
    SignUndefined = "sign_undefined",
        "Write the attitude as a quaternion, or set attitude_equivalence to rotation.";
    /// A direction of zero length.
    ZeroDirection = "zero_direction",
        "Give a direction of any length but zero.";
    /// An inertia matrix that is not symmetric.
    InertiaNotSymmetric = "inertia_not_symmetric",
        "Write the same product of inertia on both sides of the diagonal.";
    /// An inertia matrix that is not positive definite.
    InertiaNotPositive = "inertia_not_positive",
        "Look for a wrong sign of the products of inertia, or a wrong unit.";
    /// Principal moments of inertia that no rigid body has.
    InertiaTriangle = "inertia_triangle",
        "Look for a wrong unit: no principal moment exceeds the sum of the other two.";
    /// Wheels whose own inertia exceeds what the body has about their axes.
    WheelInertiaExceedsBody = "wheel_inertia_exceeds_body",
        "Give the inertia of the whole spacecraft with its wheels locked, and that of the wheels \
         about their own axes.";
    /// Fewer than three enabled wheels.
    TooFewWheels = "too_few_wheels",
        "Enable at least three wheels.";
    /// More enabled wheels than the solver is built for.
    TooManyWheels = "too_many_wheels",
        "Disable wheels.";
    /// Enabled wheel axes that do not span space.
    WheelAxesCoplanar = "wheel_axes_coplanar",
        "Enable wheels whose axes are not in one plane.";
    /// Torque limits that do not enclose zero.
    TorqueLimits = "torque_limits",
        "Write min_torque_nm below zero and max_torque_nm above.";
    /// A wheel speed beyond its limit.
    WheelSpeedLimit = "wheel_speed_limit",
        "Lower the speed, or raise the limit or momentum_authority.";
    /// A body rate beyond its limit.
    BodyRateLimit = "body_rate_limit",
        "Lower the rate or raise the limit.";
    /// Lower bound above the upper bound.
    EmptyRange = "empty_range",
        "Exchange the bounds, or remove one.";
    /// Two things with the same identifier.
    DuplicateId = "duplicate_id",
        "Give every one a name of its own.";
    /// A name that refers to nothing.
    UnknownReference = "unknown_reference",
        "Correct the name, or define what it stands for.";
    /// Fields that exclude each other.
    ConflictingFields = "conflicting_fields",
        "Make the fields agree, or keep one of them.";
    /// A place in the order that another target has already.
    PositionTaken = "position_taken",
        "Give every position to one target.";
    /// Targets that come after each other in a circle.
    OrderCycle = "order_cycle",
        "Remove one of the demands of the circle.";
    /// Positions and precedences of targets that no order keeps together.
    OrderInfeasible = "order_infeasible",
        "Relax the positions or the precedences that the message names.";
    /// Wheel speeds at the end that contradict the conserved angular momentum.
    EndMomentumInconsistent = "end_momentum_inconsistent",
        "Leave the wheel speeds at the end out, or compute them from the momentum of the start.";
    /// The wheels cannot hold the stored momentum at a required rest.
    MomentumExceedsEnvelope = "momentum_exceeds_envelope",
        "Unload momentum first, raise momentum_authority, enable more wheels, or leave a rate \
         component free.";
    /// A leg for which no solution was found that meets all conditions.
    SlewNotSolved = "slew_not_solved",
        "Check that the wheels can hold the stored momentum along the way, or relax the conditions \
         at the ends.";
    /// The solve was stopped, by its time limit or on request, before there was a first plan.
    StoppedWithoutPlan = "stopped_without_plan",
        "Allow more time, or plan fewer targets at once.";
    /// The solve needed more memory than a job of the service may take before there was a first
    /// plan.
    MemoryLimit = "memory_limit",
        "Plan fewer targets at once, or raise --job-memory of the service.";
    /// The finished plan failed its independent verification.
    VerificationFailed = "verification_failed",
        "Report it with the scenario, and do not use the plan.";
    /// A tour is faster than a lower bound allows, so some relaxed problem ended in a local minimum
    /// and the bounds are doubtful (warning).
    BoundContradicted = "bound_contradicted",
        "Take the bound as doubtful; the plan itself is verified.";
    /// A boresight enters a keep-out cone (warning).
    KeepOutViolated = "keep_out_violated",
        "Look at time and depth, and move targets or demand another order if the plan cannot be \
         used so.";
    /// A file of another version of the program.
    VersionMismatch = "version_mismatch",
        "Make the file again with this version.";
    /// A part of another table of legs than the parts before it.
    ShardMismatch = "shard_mismatch",
        "Join only files of slewplan legs that differ in --shard alone.";
    /// A part of a table of legs that is given twice.
    ShardRepeated = "shard_repeated",
        "Name every part once.";
    /// A part of a table of legs that is missing.
    ShardMissing = "shard_missing",
        "Solve the part that the message names.";
    /// A table of legs, or a part of one, that lacks legs.
    TableIncomplete = "table_incomplete",
        "Solve the part again and let it end.";
    /// A leg that does not meet its conditions when it is propagated, or is slower than the
    /// eigenaxis slew.
    LegRefused = "leg_refused",
        "Solve it again with slewplan legs.";
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}
