//! The rule of a member: what its absence means, and what its description tells beside its type.

use super::schema::{Literal, MemberBounds};
use super::{InputForm, InputPlace};
use crate::model::problem::Code;

/// The rule of a member with a value of this type.
#[derive(Debug, Clone)]
pub struct MemberRule<T> {
    absence: Absence<T>,
    means: Option<Literal>,
    pub(super) unless: Option<&'static str>,
    pub(super) bounds: MemberBounds,
}

/// What is taken for a member that is not there, or cannot be read.
#[derive(Debug, Clone)]
enum Absence<T> {
    /// There is no object without it.
    Required,
    /// It must be there; this stands in for it, so that the rest can be looked at.
    RequiredOr(T),
    /// It must be there; what stands in for it is made of the pointer of the object.
    RequiredOrPlace(fn(&str) -> T),
    /// This, also where it is `null`.
    Default(T),
    /// The first where it is not there, the second where it is `null`.
    Nullable(T, T),
    /// This, which stands for a member that must be there; the reader of the document tells so.
    Elsewhere(T),
}

/// A member that must be there; without it there is no object.
#[must_use]
pub fn required<T>() -> MemberRule<T> {
    MemberRule::of(Absence::Required)
}

/// A member that must be there. Where it cannot be read, the harmless `substitute` stands in for it,
/// so that the rest of the document can be validated.
#[must_use]
pub fn required_or<T>(substitute: T) -> MemberRule<T> {
    MemberRule::of(Absence::RequiredOr(substitute))
}

/// A member that may be left out or `null`.
#[must_use]
pub fn or<T>(default: T) -> MemberRule<T> {
    MemberRule::of(Absence::Default(default))
}

/// A member that is nothing when it is left out or `null`.
#[must_use]
pub fn optional<T>() -> MemberRule<Option<T>> {
    or(None)
}

/// A member for which `null` is not the same as leaving it out: it lifts a limit that holds without.
#[must_use]
pub fn nullable<T>(default: T) -> MemberRule<Option<T>> {
    MemberRule::of(Absence::Nullable(Some(default), None))
}

/// A member that must be there, unless something else in the document stands for it: `placeholder` is
/// taken where it is not, and whoever reads the document has to say whether that is wrong.
#[must_use]
pub fn required_elsewhere<T>(placeholder: T) -> MemberRule<T> {
    MemberRule::of(Absence::Elsewhere(placeholder))
}

impl MemberRule<String> {
    /// A name that must be there. Where it cannot be read the pointer of its object stands in for it,
    /// which is unique.
    #[must_use]
    pub fn required_or_pointer() -> Self {
        Self::of(Absence::RequiredOrPlace(str::to_owned))
    }
}

impl<T> MemberRule<T> {
    const fn of(absence: Absence<T>) -> Self {
        Self {
            absence,
            means: None,
            unless: None,
            bounds: MemberBounds {
                minimum: None,
                exclusive_minimum: None,
                maximum: None,
                exclusive_maximum: None,
                min_length: None,
                max_length: None,
                pattern: None,
                format: None,
            },
        }
    }

    /// Describes what leaving the member out means, where validation decides it.
    #[must_use]
    pub fn means(mut self, value: impl Into<Literal>) -> Self {
        self.means = Some(value.into());
        self
    }

    /// Another member of the object may stand instead, but not both of them; the rule's substitute is
    /// taken where it does.
    #[must_use]
    pub fn unless(mut self, other: &'static str) -> Self {
        self.unless = Some(other);
        self
    }

    /// Describes the smallest value.
    #[must_use]
    pub fn at_least(mut self, value: f64) -> Self {
        self.bounds.minimum = Some(value);
        self
    }

    /// Describes a value that is too small.
    #[must_use]
    pub fn above(mut self, value: f64) -> Self {
        self.bounds.exclusive_minimum = Some(value);
        self
    }

    /// Describes the largest value.
    #[must_use]
    pub fn at_most(mut self, value: f64) -> Self {
        self.bounds.maximum = Some(value);
        self
    }

    /// Describes a value that is too large.
    #[must_use]
    pub fn below(mut self, value: f64) -> Self {
        self.bounds.exclusive_maximum = Some(value);
        self
    }

    /// Describes the least length of a list or text.
    #[must_use]
    pub fn min_length(mut self, length: usize) -> Self {
        self.bounds.min_length = Some(length);
        self
    }

    /// Describes the largest length of a list; [`UpTo`](super::UpTo) refuses a longer one.
    #[must_use]
    pub fn max_length(mut self, length: usize) -> Self {
        self.bounds.max_length = Some(length);
        self
    }

    /// Describes the regular expression that a text matches.
    #[must_use]
    pub fn pattern(mut self, pattern: &'static str) -> Self {
        self.bounds.pattern = Some(pattern);
        self
    }

    /// Describes the format of an integer, where it is not that of its type.
    #[must_use]
    pub fn format(mut self, format: &'static str) -> Self {
        self.bounds.format = Some(format);
        self
    }

    pub(super) fn is_required(&self) -> bool {
        let left_out = matches!(self.absence, Absence::Default(_) | Absence::Nullable(..));
        !left_out && self.unless.is_none()
    }

    pub(super) fn described_default<F: InputForm<Value = T>>(&self) -> Option<Literal> {
        match &self.absence {
            Absence::Default(value) => self.means.or_else(|| F::literal(value)),
            _ => self.means,
        }
    }
}

/// The members of an object while it is read.
#[derive(Debug)]
pub struct InputMembers<'p, P> {
    place: &'p P,
    is_object: bool,
}

impl<'p, P: InputPlace> InputMembers<'p, P> {
    /// The members of what stands at a place; all are as good as unreadable where that is no object.
    #[must_use]
    pub fn of(place: &'p P, known: Option<&[&str]>) -> Self {
        Self {
            place,
            is_object: place.is_object(known),
        }
    }

    /// Reads a member; `None` when there is no object without it.
    #[must_use]
    pub fn read<F: InputForm>(&self, name: &str, rule: MemberRule<F::Value>) -> Option<F::Value> {
        let required = || {
            let it = self.is_object.then(|| match rule.unless {
                Some(other) if self.given(other).is_some() => self.replaced(name, other),
                Some(other) => self.place.required_unless(name, other),
                None => self.place.required(name),
            });
            F::read(&it.flatten()?)
        };
        let member = || {
            let it = self.is_object.then(|| self.place.member(name));
            it.flatten()
        };
        match rule.absence {
            Absence::Required => required(),
            Absence::RequiredOr(substitute) => required().or(Some(substitute)),
            Absence::RequiredOrPlace(substitute) => {
                required().or_else(|| Some(substitute(self.place.pointer())))
            }
            Absence::Default(default) => {
                let given = member().filter(|it| !it.is_null());
                given.and_then(|it| F::read(&it)).or(Some(default))
            }
            Absence::Nullable(default, none) => match member() {
                None => Some(default),
                Some(it) => F::read(&it).or(Some(none)),
            },
            Absence::Elsewhere(placeholder) => {
                let read = member().map_or(Some(None), |it| F::read(&it).map(Some));
                Some(read?.unwrap_or(placeholder))
            }
        }
    }

    /// A member that is neither left out nor `null`.
    fn given(&self, name: &str) -> Option<P> {
        let member = self.place.member(name);
        member.filter(|it| !it.is_null())
    }

    /// A member in whose place another one stands: it must not be given too.
    fn replaced(&self, name: &str, other: &str) -> Option<P> {
        self.given(name)?.report(
            Code::ConflictingFields,
            format!("both {name} and {other} are given"),
            format!("give {name} or {other}"),
        );
        None
    }
}
