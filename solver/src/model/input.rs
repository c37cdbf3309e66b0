//! Input documents: every member is declared once.
//!
//! A declaration such as
//!
//! ```
//! use slewplan_solver::model::input::{input_object, optional, or, required};
//!
//! input_object! {
//!     /// A tank.
//!     pub struct TankSpec as "Tank" {
//!         /// What the tank is called.
//!         pub name: String = required(),
//!         /// Propellant at the start, kg.
//!         pub fill_kg: f64 = or(0.0).at_least(0.0),
//!         /// Largest pressure, Pa; no limit without it.
//!         pub max_pressure_pa: Option<f64> = optional().above(0.0),
//!     }
//! }
//! ```
//!
//! makes a plain struct, its reading from a document, and its description: a member has its name, its
//! type, its default, its bounds and its text in one place. [`input_choice!`](crate::input_choice)
//! declares one text of several, [`input_union!`](crate::input_union) an object whose member `kind`
//! says which further members it has.
//!
//! No format of documents is known here: [`InputPlace`] is what a reader of a format offers, [`Schema`]
//! what a description is made of. Bounds are described only; a value that was read may still be
//! nonsense, which is for validation to say.

#[macro_use]
mod declare;
mod forms;
mod rule;
mod schema;

pub use forms::{Unread, UpTo};
pub use rule::{
    InputMembers, MemberRule, nullable, optional, or, required, required_elsewhere, required_or,
};
pub use schema::{Literal, MemberBounds, MemberSchema, NamedSchema, Schema, text_of};
pub use {input_choice, input_object, input_union};

use super::problem::Code;

/// A place in a document, as a reader of documents sees it.
///
/// A method that returns nothing has recorded why, with the pointer of the place.
pub trait InputPlace: Sized {
    /// The JSON pointer of the place.
    fn pointer(&self) -> &str;

    /// Records a problem at the place.
    fn report(&self, code: Code, message: impl Into<String>, hint: impl Into<String>);

    /// Whether `null` stands there.
    fn is_null(&self) -> bool;

    /// Whether a number stands there; that it does not is no problem.
    fn is_number(&self) -> bool;

    /// Whether a text stands there; that it does not is no problem.
    fn is_text(&self) -> bool;

    /// Whether a list stands there; that it does not is no problem.
    fn is_list(&self) -> bool;

    /// A number.
    fn number(&self) -> Option<f64>;

    /// A whole number from zero on.
    fn integer(&self) -> Option<u64>;

    /// `true` or `false`.
    fn boolean(&self) -> Option<bool>;

    /// A text.
    fn text(&self) -> Option<&str>;

    /// The index of the text that stands there.
    fn choice(&self, texts: &[&str]) -> Option<usize>;

    /// Whether an object stands there. Members that are repeated, or not among the known ones, are
    /// recorded; without a list any member is known.
    fn is_object(&self, known: Option<&[&str]>) -> bool;

    /// A member of an object; its absence is no problem.
    fn member(&self, name: &str) -> Option<Self>;

    /// A member of an object that must have it.
    fn required(&self, name: &str) -> Option<Self>;

    /// A member of an object that must have it, or another one instead of it.
    fn required_unless(&self, name: &str, other: &str) -> Option<Self>;

    /// Number of entries of a list.
    fn entries(&self) -> Option<usize>;

    /// An entry of a list; its absence is no problem.
    fn entry(&self, index: usize) -> Option<Self>;
}

/// How a value is written in a document: how it is read, and what its description is.
///
/// Most types are their own form. Others, which implement nothing else, are a form of a type that has
/// several.
pub trait InputForm {
    /// What is read.
    type Value;

    /// Reads the value at a place, all of it even when a part cannot be read.
    fn read<P: InputPlace>(place: &P) -> Option<Self::Value>;

    /// What the value looks like.
    fn schema() -> Schema;

    /// A value as it stands in a document, where a description can tell it as a default.
    fn literal(_value: &Self::Value) -> Option<Literal> {
        None
    }
}

/// What is read where nothing is written: every member at its default.
///
/// # Panics
///
/// When a member is required.
#[must_use]
pub fn left_out<F: InputForm>() -> F::Value {
    F::read(&Nothing).expect("every member has a default")
}

/// An object without members.
struct Nothing;

impl InputPlace for Nothing {
    fn pointer(&self) -> &'static str {
        ""
    }

    fn report(&self, _: Code, _: impl Into<String>, _: impl Into<String>) {}

    fn is_null(&self) -> bool {
        false
    }

    fn is_number(&self) -> bool {
        false
    }

    fn is_text(&self) -> bool {
        false
    }

    fn is_list(&self) -> bool {
        false
    }

    fn number(&self) -> Option<f64> {
        None
    }

    fn integer(&self) -> Option<u64> {
        None
    }

    fn boolean(&self) -> Option<bool> {
        None
    }

    fn text(&self) -> Option<&str> {
        None
    }

    fn choice(&self, _: &[&str]) -> Option<usize> {
        None
    }

    fn is_object(&self, _: Option<&[&str]>) -> bool {
        true
    }

    fn member(&self, _: &str) -> Option<Self> {
        None
    }

    fn required(&self, _: &str) -> Option<Self> {
        None
    }

    fn required_unless(&self, _: &str, _: &str) -> Option<Self> {
        None
    }

    fn entries(&self) -> Option<usize> {
        None
    }

    fn entry(&self, _: usize) -> Option<Self> {
        None
    }
}

#[cfg(test)]
mod tests;
