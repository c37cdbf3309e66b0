//! SHA-256 digests.

use sha2::{Digest, Sha256};

/// SHA-256 as lower-case hexadecimal digits.
pub(crate) fn hex(content: &[u8]) -> String {
    hex::encode(Sha256::digest(content))
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_digest_of_the_fips_example_is_right() {
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(super::hex(b"abc"), expected);
    }
}
