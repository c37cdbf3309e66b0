//! The forms of plain values and of lists.

use super::{InputForm, InputPlace, Literal, NamedSchema, Schema};
use crate::model::problem::{Code, Problem};
use std::marker::PhantomData;

impl InputForm for f64 {
    type Value = Self;

    fn read<P: InputPlace>(place: &P) -> Option<Self> {
        place.number()
    }

    fn schema() -> Schema {
        Schema::Number
    }

    fn literal(value: &Self) -> Option<Literal> {
        Some(Literal::Number(*value))
    }
}

impl InputForm for u64 {
    type Value = Self;

    fn read<P: InputPlace>(place: &P) -> Option<Self> {
        place.integer()
    }

    fn schema() -> Schema {
        Schema::Integer("uint64")
    }

    fn literal(value: &Self) -> Option<Literal> {
        Some(Literal::Integer(*value))
    }
}

/// A number of things; one that does not fit is more than there can be.
impl InputForm for usize {
    type Value = Self;

    fn read<P: InputPlace>(place: &P) -> Option<Self> {
        let count = place.integer()?;
        Some(Self::try_from(count).unwrap_or(Self::MAX))
    }

    fn schema() -> Schema {
        Schema::Integer("int64")
    }

    fn literal(value: &Self) -> Option<Literal> {
        Some(Literal::Integer(u64::try_from(*value).ok()?))
    }
}

impl InputForm for bool {
    type Value = Self;

    fn read<P: InputPlace>(place: &P) -> Option<Self> {
        place.boolean()
    }

    fn schema() -> Schema {
        Schema::Boolean
    }

    fn literal(value: &Self) -> Option<Literal> {
        Some(Literal::Boolean(*value))
    }
}

impl InputForm for String {
    type Value = Self;

    fn read<P: InputPlace>(place: &P) -> Option<Self> {
        place.text().map(str::to_owned)
    }

    fn schema() -> Schema {
        Schema::Text
    }
}

/// The same, or `null`.
impl<F: InputForm> InputForm for Option<F> {
    type Value = Option<F::Value>;

    fn read<P: InputPlace>(place: &P) -> Option<Self::Value> {
        if place.is_null() {
            return Some(None);
        }
        F::read(place).map(Some)
    }

    fn schema() -> Schema {
        Schema::Nullable(Box::new(F::schema()))
    }

    fn literal(value: &Self::Value) -> Option<Literal> {
        F::literal(value.as_ref()?)
    }
}

/// A list of any length.
impl<F: InputForm> InputForm for Vec<F> {
    type Value = Vec<F::Value>;

    fn read<P: InputPlace>(place: &P) -> Option<Self::Value> {
        let length = place.entries()?;
        each::<F, P>(place, length)
    }

    fn schema() -> Schema {
        list::<F>(None, None)
    }
}

/// A list of at most so many entries; a longer one is not looked into.
#[derive(Debug)]
pub struct UpTo<const MOST: usize, F>(PhantomData<F>);

impl<const MOST: usize, F: InputForm> InputForm for UpTo<MOST, F> {
    type Value = Vec<F::Value>;

    fn read<P: InputPlace>(place: &P) -> Option<Self::Value> {
        let length = place.entries()?;
        if length > MOST {
            let problem = Problem::too_long(place.pointer(), length, MOST);
            place.report(problem.code, problem.message, problem.hint);
            return None;
        }
        each::<F, P>(place, length)
    }

    fn schema() -> Schema {
        list::<F>(None, Some(MOST))
    }
}

/// What is described as a form, and left to others to read.
#[derive(Debug)]
pub struct Unread<F>(PhantomData<F>);

impl<F: InputForm> InputForm for Unread<F> {
    type Value = ();

    fn read<P: InputPlace>(_: &P) -> Option<()> {
        Some(())
    }

    fn schema() -> Schema {
        F::schema()
    }
}

/// Two angles.
impl InputForm for [f64; 2] {
    type Value = Self;

    fn read<P: InputPlace>(place: &P) -> Option<Self> {
        array::<f64, 2, P>(place)
    }

    fn schema() -> Schema {
        list::<f64>(Some(2), Some(2))
    }
}

/// A vector in body or reference axes.
impl InputForm for [f64; 3] {
    type Value = Self;

    fn read<P: InputPlace>(place: &P) -> Option<Self> {
        array::<f64, 3, P>(place)
    }

    fn schema() -> Schema {
        named("Vector", || list::<f64>(Some(3), Some(3)))
    }
}

/// Three numbers of which each may be `null`.
impl InputForm for [Option<f64>; 3] {
    type Value = Self;

    fn read<P: InputPlace>(place: &P) -> Option<Self> {
        array::<Option<f64>, 3, P>(place)
    }

    fn schema() -> Schema {
        list::<Option<f64>>(Some(3), Some(3))
    }
}

/// Three rows of three numbers.
impl InputForm for [[f64; 3]; 3] {
    type Value = Self;

    fn read<P: InputPlace>(place: &P) -> Option<Self> {
        array::<[f64; 3], 3, P>(place)
    }

    fn schema() -> Schema {
        named("Matrix", || Schema::List {
            of: Box::new(list::<f64>(Some(3), Some(3))),
            at_least: Some(3),
            at_most: Some(3),
        })
    }
}

/// The components x, y, z, w of a quaternion.
impl InputForm for [f64; 4] {
    type Value = Self;

    fn read<P: InputPlace>(place: &P) -> Option<Self> {
        array::<f64, 4, P>(place)
    }

    fn schema() -> Schema {
        named("Components", || list::<f64>(Some(4), Some(4)))
    }
}

fn named(name: &'static str, schema: fn() -> Schema) -> Schema {
    let doc = "";
    Schema::Named(NamedSchema { name, doc, schema })
}

fn list<F: InputForm>(at_least: Option<usize>, at_most: Option<usize>) -> Schema {
    Schema::List {
        of: Box::new(F::schema()),
        at_least,
        at_most,
    }
}

/// All entries of a list or nothing, but never before every entry has been read and its problems
/// recorded.
fn each<F: InputForm, P: InputPlace>(place: &P, length: usize) -> Option<Vec<F::Value>> {
    // One place at a time: all of them would take more memory than what they say.
    let entry = |index| F::read(&place.entry(index)?);
    let read: Vec<Option<F::Value>> = (0..length).map(entry).collect();
    read.into_iter().collect()
}

fn array<F: InputForm, const N: usize, P: InputPlace>(place: &P) -> Option<[F::Value; N]> {
    let length = place.entries()?;
    if length != N {
        place.report(
            Code::WrongLength,
            format!("expected {N} entries, found {length}"),
            format!("write exactly {N} entries"),
        );
        return None;
    }
    each::<F, P>(place, length)?.try_into().ok()
}
