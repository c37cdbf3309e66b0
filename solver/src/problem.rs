//! What can be wrong with an input, said so that a caller can act on it.

use std::fmt;

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

macro_rules! codes {
    ($($(#[$doc:meta])+ $name:ident = $text:literal,)+) => {
        /// Stable codes of problems; the text form never changes its meaning.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[non_exhaustive]
        pub enum Code {
            $($(#[$doc])+ $name,)+
        }

        impl Code {
            /// All codes, for the error index.
            pub const ALL: &'static [Code] = &[$(Code::$name,)+];

            /// The stable text of the code.
            #[must_use]
            pub const fn as_str(self) -> &'static str {
                match self { $(Code::$name => $text,)+ }
            }
        }
    };
}

codes! {
    /// The document is not valid JSON.
    MalformedJson = "malformed_json",
    /// A required field is missing.
    MissingField = "missing_field",
    /// A field that the schema does not know.
    UnknownField = "unknown_field",
    /// The same key twice in one object.
    DuplicateField = "duplicate_field",
    /// A value of the wrong JSON type or shape.
    WrongType = "wrong_type",
    /// A text outside the allowed choices.
    UnknownChoice = "unknown_choice",
    /// A number that is not finite.
    NotFinite = "not_finite",
    /// A number outside its range.
    OutOfRange = "out_of_range",
    /// An array whose length does not match.
    WrongLength = "wrong_length",
    /// An attitude given in no form or in more than one.
    AttitudeForm = "attitude_form",
    /// A quaternion whose norm is too far from one.
    QuaternionNorm = "quaternion_norm",
    /// A quaternion or matrix that was off by little and has been normalised (warning).
    AttitudeNormalized = "attitude_normalized",
    /// A matrix that is not a rotation.
    MatrixNotRotation = "matrix_not_rotation",
    /// An attitude form that has no quaternion sign where the sign matters.
    SignUndefined = "sign_undefined",
    /// A direction of zero length.
    ZeroDirection = "zero_direction",
    /// An inertia matrix that is not symmetric.
    InertiaNotSymmetric = "inertia_not_symmetric",
    /// An inertia matrix that is not positive definite.
    InertiaNotPositive = "inertia_not_positive",
    /// Principal moments of inertia that no rigid body has.
    InertiaTriangle = "inertia_triangle",
    /// Wheels whose own inertia exceeds what the body has about their axes.
    WheelInertiaExceedsBody = "wheel_inertia_exceeds_body",
    /// Fewer than three enabled wheels.
    TooFewWheels = "too_few_wheels",
    /// More enabled wheels than the solver is built for.
    TooManyWheels = "too_many_wheels",
    /// Enabled wheel axes that do not span space.
    WheelAxesCoplanar = "wheel_axes_coplanar",
    /// Torque limits that do not enclose zero.
    TorqueLimits = "torque_limits",
    /// A wheel speed beyond its limit.
    WheelSpeedLimit = "wheel_speed_limit",
    /// A body rate beyond its limit.
    BodyRateLimit = "body_rate_limit",
    /// Lower bound above the upper bound.
    EmptyRange = "empty_range",
    /// Two things with the same identifier.
    DuplicateId = "duplicate_id",
    /// A name that refers to nothing.
    UnknownReference = "unknown_reference",
    /// Fields that exclude each other.
    ConflictingFields = "conflicting_fields",
    /// A place in the order that another target has already.
    PositionTaken = "position_taken",
    /// Targets that come after each other in a circle.
    OrderCycle = "order_cycle",
    /// Positions and precedences of targets that no order keeps together.
    OrderInfeasible = "order_infeasible",
    /// Wheel speeds at the end that contradict the conserved angular momentum.
    EndMomentumInconsistent = "end_momentum_inconsistent",
    /// The wheels cannot hold the stored momentum at a required rest.
    MomentumExceedsEnvelope = "momentum_exceeds_envelope",
    /// A slew for which no flyable solution was found.
    SlewNotSolved = "slew_not_solved",
    /// The finished plan failed its independent verification.
    VerificationFailed = "verification_failed",
    /// An order was flown faster than a lower bound had allowed, so that some relaxed problem ended
    /// in a local minimum and the bounds are doubtful (warning).
    BoundContradicted = "bound_contradicted",
    /// A boresight enters a keep-out cone (warning).
    KeepOutViolated = "keep_out_violated",
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}
