//! What a document looks like, for its description.

use super::{InputForm, MemberRule};

/// What stands at a place.
#[derive(Debug, Clone, PartialEq)]
pub enum Schema {
    /// A number.
    Number,
    /// A whole number of at least zero, with the format by which OpenAPI tells its width.
    Integer(&'static str),
    /// `true` or `false`.
    Boolean,
    /// A text.
    Text,
    /// One of these texts, each with what it means.
    Choice(Vec<(&'static str, String)>),
    /// A list with at least and at most so many entries.
    List {
        /// What every entry is.
        of: Box<Schema>,
        /// Least number of entries.
        at_least: Option<usize>,
        /// Largest number of entries.
        at_most: Option<usize>,
    },
    /// The same, or `null`.
    Nullable(Box<Schema>),
    /// An object with these members and no others.
    Object(Vec<MemberSchema>),
    /// An object with these members and perhaps others.
    OpenObject(Vec<MemberSchema>),
    /// An object with a member `kind`, and what else belongs to each kind, with a text.
    Kinds(Vec<(&'static str, String, Vec<MemberSchema>)>),
    /// Any of these, each with a text.
    OneOf(Vec<(String, Schema)>),
    /// Something that stands under a name of its own in a description.
    Named(NamedSchema),
}

/// A schema with a name.
#[derive(Debug, Clone, Copy)]
pub struct NamedSchema {
    /// The name.
    pub name: &'static str,
    /// The text, as the lines of a comment.
    pub doc: &'static str,
    /// The schema; made where it is wanted, since schemas contain each other.
    pub schema: fn() -> Schema,
}

impl PartialEq for NamedSchema {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

/// A member of an object.
#[derive(Debug, Clone, PartialEq)]
pub struct MemberSchema {
    /// Its name.
    pub name: &'static str,
    /// What it is.
    pub text: String,
    /// Whether it must be there.
    pub required: bool,
    /// The member that may stand instead; one of the two must be there.
    pub unless: Option<&'static str>,
    /// What it looks like.
    pub schema: Schema,
    /// What leaving it out means.
    pub default: Option<Literal>,
    /// Between what its value lies.
    pub bounds: MemberBounds,
}

impl MemberSchema {
    /// The description of a member of this form, under this name, with the lines of its comment.
    #[must_use]
    pub fn of<F: InputForm>(name: &'static str, doc: &str, rule: &MemberRule<F::Value>) -> Self {
        Self {
            name,
            text: text_of(doc),
            required: rule.is_required(),
            unless: rule.unless,
            schema: F::schema(),
            default: rule.described_default::<F>(),
            bounds: rule.bounds,
        }
    }
}

/// Between what a value lies; as far as a description tells it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct MemberBounds {
    /// A number is at least this.
    pub minimum: Option<f64>,
    /// A number is above this.
    pub exclusive_minimum: Option<f64>,
    /// A number is at most this.
    pub maximum: Option<f64>,
    /// A number is below this.
    pub exclusive_maximum: Option<f64>,
    /// A list has, or a text is, at least so long.
    pub min_length: Option<usize>,
    /// A list has at most so many entries.
    pub max_length: Option<usize>,
    /// A text matches this regular expression.
    pub pattern: Option<&'static str>,
    /// An integer has this format.
    pub format: Option<&'static str>,
}

/// A value in a document.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Literal {
    /// A number.
    Number(f64),
    /// A whole number.
    Integer(u64),
    /// `true` or `false`.
    Boolean(bool),
}

impl From<f64> for Literal {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}

impl From<u64> for Literal {
    fn from(value: u64) -> Self {
        Self::Integer(value)
    }
}

impl From<bool> for Literal {
    fn from(value: bool) -> Self {
        Self::Boolean(value)
    }
}

/// The text of the lines of a comment: without the space before each.
#[must_use]
pub fn text_of(doc: &str) -> String {
    let lines: Vec<&str> = doc.lines().map(str::trim).collect();
    lines.join("\n").trim().to_owned()
}
