//! API keys of clients: their form and their scopes.
//!
//! A key has 256 random bits, so that its plain SHA-256 can be stored: a slow hash protects secrets
//! that can be guessed, which these cannot.

use crate::base::digest;
use std::fmt::{self, Display};
use std::str::FromStr;

/// Prefix of every key, by which scanners find leaked ones.
const PREFIX: &str = "slewplan_";
const SECRET_BYTES: usize = 32;
const ID_BYTES: usize = 6;

/// A permission that a key grants.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    clap::ValueEnum,
    strum::EnumString,
    strum::IntoStaticStr,
)]
#[strum(serialize_all = "lowercase", const_into_str)]
#[strum(parse_err_ty = String, parse_err_fn = unknown_scope)]
pub(crate) enum Scope {
    /// Read the client's own jobs and spacecraft
    Read,
    /// Submit, end and delete jobs, store spacecraft, compute
    Write,
    /// Read metrics and the cached legs of all clients, import legs
    Operate,
}

fn unknown_scope(text: &str) -> String {
    format!("{text:?} is no scope")
}

/// The permissions that a key grants.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Scopes(Vec<Scope>);

impl Scopes {
    /// A set of scopes, sorted and without duplicates.
    pub(crate) fn new(scopes: &[Scope]) -> Self {
        let mut scopes = scopes.to_vec();
        scopes.sort_unstable();
        scopes.dedup();
        Self(scopes)
    }

    /// Whether a scope is among them.
    pub(crate) fn contain(&self, scope: Scope) -> bool {
        self.0.contains(&scope)
    }
}

impl Display for Scopes {
    fn fmt(&self, form: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<&str> = self.0.iter().map(Scope::into_str).collect();
        form.write_str(&names.join(" "))
    }
}

impl FromStr for Scopes {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let scopes = text.split_whitespace().map(str::parse);
        Ok(Self(scopes.collect::<Result<_, _>>()?))
    }
}

/// A new key. Its secret is held in memory only, to be shown once.
pub(crate) struct FreshKey {
    /// Public identifier of the key.
    pub(crate) id: String,
    /// The secret key.
    pub(crate) secret: String,
}

impl FreshKey {
    /// A key from the operating system's randomness.
    ///
    /// # Errors
    ///
    /// When the operating system provides no randomness.
    pub(crate) fn new() -> Result<Self, getrandom::Error> {
        let mut bytes = [0; SECRET_BYTES];
        getrandom::fill(&mut bytes)?;
        let mut id = [0; ID_BYTES];
        getrandom::fill(&mut id)?;
        Ok(Self {
            id: hex::encode(id),
            secret: format!("{PREFIX}{}", hex::encode(bytes)),
        })
    }

    /// The digest that is stored of the key.
    pub(crate) fn digest(&self) -> String {
        digest_of(&self.secret)
    }
}

/// The digest by which a received key is looked up. The time of the look-up depends on the digest,
/// which a client cannot choose, and not on the key.
pub(crate) fn digest_of(key: &str) -> String {
    digest::hex(key.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_have_256_random_bits() {
        let keys = [(); 2].map(|()| FreshKey::new().expect("randomness"));
        assert_ne!(keys[0].secret, keys[1].secret);
        assert_ne!(keys[0].id, keys[1].id);
        for key in keys {
            let secret = key.secret.strip_prefix(PREFIX).expect("the prefix");
            assert_eq!(secret.len(), 64);
            assert_eq!(key.digest(), digest_of(&key.secret));
            assert!(!key.secret.contains(&key.id));
        }
    }

    #[test]
    fn scopes_are_parsed_from_their_text() {
        let scopes = Scopes::new(&[Scope::Write, Scope::Read, Scope::Write]);
        assert_eq!(scopes.to_string(), "read write");
        assert_eq!("read write".parse(), Ok(scopes));
        assert!("read fly".parse::<Scopes>().is_err());
    }
}
