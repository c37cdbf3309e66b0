//! Numbers that are longer than any number needs to be.
//!
//! The parser of JSON gathers all digits of a number, however many, in a buffer that doubles: a body
//! of nothing but digits would take three times its size.

use super::outside::outside_texts;
use slewplan_solver::model::problem::{Code, Problem};

/// Longest number, bytes: more than the exact decimal form of any 64-bit float has digits.
const LONGEST: usize = 1100;

/// Looks for numbers that are too long, without any memory.
///
/// # Errors
///
/// One problem with line and column of where the first such number ends.
pub(super) fn check(text: &[u8]) -> Result<(), Problem> {
    let mut length = 0;
    for (place, byte) in outside_texts(text) {
        if matches!(byte, b'0'..=b'9' | b'.' | b'e' | b'E' | b'+' | b'-') {
            length += 1;
            if length > LONGEST {
                return Err(too_long(&text[..=place]));
            }
        } else {
            length = 0;
        }
    }
    Ok(())
}

/// The problem of a document that was read up to here.
fn too_long(read: &[u8]) -> Problem {
    let before = read.iter().rev().position(|byte| *byte == b'\n');
    let column = before.unwrap_or(read.len());
    let line = read.split(|byte| *byte == b'\n').count();
    Problem::new(
        "",
        Code::MalformedJson,
        format!("line {line}, column {column}: a number of more than {LONGEST} characters"),
        "17 significant digits name every 64-bit float",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_may_be_as_long_as_a_float_can_be() {
        let exact = format!("[{:.1074}]", f64::from_bits(1));
        assert_eq!(check(exact.as_bytes()), Ok(()));
        let many = "0.5,".repeat(LONGEST);
        assert_eq!(check(many.as_bytes()), Ok(()));
    }

    #[test]
    fn texts_may_have_any_number_of_digits() {
        let digits = "9".repeat(2 * LONGEST);
        for text in [format!("\"{digits}\""), format!("\"\\\"{digits}\\\\\"")] {
            assert_eq!(check(text.as_bytes()), Ok(()));
        }
        let after = format!("[\"\\\\\", {digits}]");
        check(after.as_bytes()).expect_err("the text has ended");
    }

    #[test]
    fn a_number_that_is_too_long_is_named_by_its_place() {
        let text = format!("[\n {}]", "9".repeat(LONGEST + 1));
        let problem = check(text.as_bytes()).expect_err("too long");
        let place = format!("line 2, column {}", LONGEST + 2);
        assert!(problem.message.contains(&place), "{problem}");
    }
}
