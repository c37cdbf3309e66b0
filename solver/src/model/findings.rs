//! Collects all problems of a description, instead of stopping at the first one.
//!
//! A reader takes the findings by mutable reference, adds problems and returns `None` for a value
//! that it cannot use, so that one fault neither hides nor causes another.

use crate::model::problem::{Code, Faults, MAX_KEPT, Problem};
use nalgebra::{Matrix3, Vector3};

/// Problems and warnings, in the order in which they were found.
#[derive(Debug, Default)]
pub struct Findings {
    problems: Vec<Problem>,
    warnings: Vec<Problem>,
}

impl Findings {
    /// Adds a reason to refuse the description.
    pub fn refuse(
        &mut self,
        pointer: impl Into<String>,
        code: Code,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) {
        if self.problems.len() < MAX_KEPT {
            let problem = Problem::new(pointer, code, message, hint);
            self.problems.push(problem);
        }
    }

    /// Adds a warning, which does not refuse the description.
    pub fn warn(
        &mut self,
        pointer: impl Into<String>,
        code: Code,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) {
        if self.warnings.len() < MAX_KEPT {
            let warning = Problem::new(pointer, code, message, hint);
            self.warnings.push(warning);
        }
    }

    /// Adds the problems that another reader has found.
    pub fn include(&mut self, problems: Vec<Problem>) {
        self.problems.extend(problems);
    }

    /// The value with its warnings, or all the problems.
    ///
    /// A reader that returns `None` has added the reason, so there is a value or a problem.
    ///
    /// # Errors
    ///
    /// The problems, when there are any.
    pub fn conclude<T>(self, value: Option<T>) -> Result<(T, Vec<Problem>), Vec<Problem>> {
        self.judge(value).map_err(|faults| faults.problems)
    }

    /// The value with its warnings, or all the problems with all the warnings.
    ///
    /// # Errors
    ///
    /// The problems and warnings, when there are any problems.
    pub fn judge<T>(self, value: Option<T>) -> Result<(T, Vec<Problem>), Faults> {
        match value {
            Some(value) if self.problems.is_empty() => Ok((value, self.warnings)),
            _ => {
                debug_assert!(
                    !self.problems.is_empty(),
                    "a value is missing without a reason"
                );
                Err(Faults {
                    problems: self.problems,
                    warnings: self.warnings,
                })
            }
        }
    }

    /// Whether a list has at most so many entries; longer ones are not read.
    pub fn at_most(&mut self, pointer: &str, entries: usize, most: usize) -> bool {
        if entries > most {
            self.include(vec![Problem::too_long(pointer, entries, most)]);
        }
        entries <= most
    }

    /// A finite number.
    pub fn finite(&mut self, pointer: &str, value: f64) -> Option<f64> {
        if value.is_finite() {
            return Some(value);
        }
        self.refuse(
            pointer,
            Code::NotFinite,
            format!("the number is {value}"),
            "write a finite number",
        );
        None
    }

    /// Finite numbers; each fault points at its element.
    pub fn finite_all<const N: usize>(
        &mut self,
        pointer: &str,
        values: [f64; N],
    ) -> Option<[f64; N]> {
        let mut all = true;
        for (i, value) in values.into_iter().enumerate() {
            all &= self.finite(&format!("{pointer}/{i}"), value).is_some();
        }
        all.then_some(values)
    }

    /// A finite matrix, given by rows; each fault points at its entry.
    pub fn matrix(&mut self, pointer: &str, rows: &[[f64; 3]; 3]) -> Option<Matrix3<f64>> {
        let mut finite = true;
        for (i, row) in rows.iter().enumerate() {
            finite &= self.finite_all(&format!("{pointer}/{i}"), *row).is_some();
        }
        finite.then(|| Matrix3::from_fn(|i, j| rows[i][j]))
    }

    /// A finite vector.
    pub fn vector(&mut self, pointer: &str, values: [f64; 3]) -> Option<Vector3<f64>> {
        self.finite_all(pointer, values).map(Vector3::from)
    }

    /// A finite number above zero.
    pub fn positive(&mut self, pointer: &str, value: f64) -> Option<f64> {
        let value = self.finite(pointer, value)?;
        if value > 0.0 {
            return Some(value);
        }
        self.refuse(
            pointer,
            Code::OutOfRange,
            format!("the number is {value}, it must be above 0"),
            "give a value above 0; leave an optional limit out, or null, for none",
        );
        None
    }

    /// A finite number that is zero or above.
    pub fn not_negative(&mut self, pointer: &str, value: f64) -> Option<f64> {
        let value = self.finite(pointer, value)?;
        if value >= 0.0 {
            return Some(value);
        }
        self.refuse(
            pointer,
            Code::OutOfRange,
            format!("the number is {value}, it must not be below 0"),
            "give zero or a number above it",
        );
        None
    }

    /// A finite vector that is not zero, as given.
    pub fn nonzero(&mut self, pointer: &str, values: [f64; 3]) -> Option<Vector3<f64>> {
        let vector = self.vector(pointer, values)?;
        if vector.amax() > 0.0 {
            return Some(vector);
        }
        self.refuse(
            pointer,
            Code::ZeroDirection,
            "all three components are 0, which points nowhere",
            "give a direction of any length but zero",
        );
        None
    }

    /// The unit vector along a finite vector that is not zero.
    pub fn direction(&mut self, pointer: &str, values: [f64; 3]) -> Option<Vector3<f64>> {
        self.nonzero(pointer, values).map(unit)
    }
}

/// Unit vector along a non-zero vector of any representable length.
#[must_use]
pub fn unit(vector: Vector3<f64>) -> Vector3<f64> {
    // Scaled first, since the squares of very long or very short vectors leave the number range.
    (vector / vector.amax()).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_element_that_is_not_finite_is_named() {
        let mut findings = Findings::default();
        assert!(
            findings
                .vector("/v", [f64::NAN, 1.0, f64::INFINITY])
                .is_none()
        );
        let problems = findings.conclude::<()>(None).unwrap_err();
        let pointers: Vec<_> = problems.iter().map(|p| p.pointer.as_str()).collect();
        assert_eq!(pointers, ["/v/0", "/v/2"]);
    }

    #[test]
    fn of_many_problems_the_first_are_kept() {
        let mut findings = Findings::default();
        for i in 0..2 * MAX_KEPT {
            findings.finite(&format!("/v/{i}"), f64::NAN);
        }
        let problems = findings.conclude::<()>(None).unwrap_err();
        assert_eq!(problems.len(), MAX_KEPT);
        assert_eq!(problems[MAX_KEPT - 1].pointer, "/v/999");
    }

    #[test]
    fn extreme_lengths_still_have_a_direction() {
        for length in [1e-300, 1e300] {
            let axis = unit(Vector3::new(0.0, 3.0, 4.0) * length);
            assert!((axis - Vector3::new(0.0, 0.6, 0.8)).norm() < 1e-15);
        }
    }
}
