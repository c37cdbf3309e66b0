//! Shards of a table, for parallel runs.

use super::failure::Failure;
use slewplan_solver::tour::planner::Shard;
use std::ffi::OsStr;
use std::str::FromStr;

/// The variable with the number of a pod of a Kubernetes Indexed Job, counted from 0.
const COMPLETION_INDEX: &str = "JOB_COMPLETION_INDEX";

/// A shard as written on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ShardArgument {
    /// A shard by its number.
    Named(Shard),
    /// The shard whose number the environment has.
    Indexed {
        /// Number of shards.
        of: usize,
    },
}

impl FromStr for ShardArgument {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let wrong = "expected I/N with 1 <= I <= N, for example 2/4, or indexed/N";
        let (index, of) = text.split_once('/').ok_or(wrong)?;
        let of = of.parse().ok().filter(|of| *of > 0).ok_or(wrong)?;
        if index == "indexed" {
            return Ok(Self::Indexed { of });
        }
        let index: usize = index.parse().map_err(|_| wrong)?;
        if !(1..=of).contains(&index) {
            return Err(wrong);
        }
        Ok(Self::Named(Shard {
            index: index - 1,
            of,
        }))
    }
}

impl ShardArgument {
    /// The shard of this process.
    pub(super) fn resolve(self) -> Result<Shard, Failure> {
        match self {
            Self::Named(shard) => Ok(shard),
            Self::Indexed { of } => {
                let index = std::env::var_os(COMPLETION_INDEX);
                indexed(index.as_deref().map(OsStr::to_string_lossy).as_deref(), of)
            }
        }
    }
}

/// The shard with an index from the environment, counted from 0.
fn indexed(index: Option<&str>, of: usize) -> Result<Shard, Failure> {
    let wrong = |what| Failure::Setting {
        name: "--shard",
        what,
    };
    let Some(index) = index else {
        return Err(wrong(format!(
            "indexed/{of} takes the part from the variable {COMPLETION_INDEX}, which is not set; \
             name the part, as in 1/{of}"
        )));
    };
    match index.parse() {
        Ok(index) if index < of => Ok(Shard { index, of }),
        _ => Err(wrong(format!(
            "{COMPLETION_INDEX} is {index:?}, and the {of} parts of indexed/{of} count from 0 to {}; \
             a job needs as many completions as there are parts",
            of - 1
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_count_from_one() {
        let second = ShardArgument::Named(Shard { index: 1, of: 4 });
        assert_eq!("2/4".parse(), Ok(second));
        assert_eq!("indexed/4".parse(), Ok(ShardArgument::Indexed { of: 4 }));
        for wrong in [
            "0/4",
            "5/4",
            "1/0",
            "1",
            "a/b",
            "1/2/3",
            "-1/2",
            "",
            "indexed",
            "indexed/0",
            "indexed/x",
            "Indexed/2",
        ] {
            assert!(wrong.parse::<ShardArgument>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn indices_of_the_environment_count_from_zero() {
        let shard = |index| indexed(Some(index), 3).ok();
        assert_eq!(shard("0"), Some(Shard { index: 0, of: 3 }));
        assert_eq!(shard("2"), Some(Shard { index: 2, of: 3 }));
        for wrong in ["3", "-1", "", "1.0", "one"] {
            assert_eq!(shard(wrong), None, "{wrong}");
        }
        assert!(indexed(None, 3).is_err());
    }
}
