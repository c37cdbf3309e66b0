//! Plans as they are stored: compressed, with the hash of their JSON.
//!
//! The JSON of a plan is mostly digits and compresses to less than half of its size, which keeps
//! the write-ahead log and backups small. Plans are compressed before the write transaction begins,
//! so that it is short.

use super::StoreError;
use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use std::io::{Read, Write};

row! {
    /// The document of a plan, or of the reasons why there is none, ready to be stored.
    #[derive(Debug, Clone, PartialEq)]
    pub(crate) struct PackedPlan {
        /// The JSON, compressed or plain.
        pub(super) document: Vec<u8>,
        /// Whether it is compressed. Plans stored by older versions are not.
        pub(super) packed: bool,
        /// SHA-256 of the JSON, hex.
        pub(super) digest: String,
    }
}

impl PackedPlan {
    /// Compresses the JSON of a plan.
    pub(crate) fn of(json: &[u8]) -> Self {
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
        let written = encoder.write_all(json).and_then(|()| encoder.finish());
        Self {
            document: written.expect("writing to memory cannot fail"),
            packed: true,
            digest: crate::base::digest::hex(json),
        }
    }

    /// The original JSON.
    ///
    /// # Errors
    ///
    /// [`StoreError::Damaged`] when it does not match its hash.
    pub(super) fn unpacked(self) -> Result<Vec<u8>, StoreError> {
        let json = if self.packed {
            inflated(&self.document).ok()
        } else {
            Some(self.document)
        };
        json.filter(|json| crate::base::digest::hex(json) == self.digest)
            .ok_or(StoreError::Damaged { what: "plan" })
    }
}

fn inflated(bytes: &[u8]) -> std::io::Result<Vec<u8>> {
    let mut json = Vec::new();
    ZlibDecoder::new(bytes).read_to_end(&mut json)?;
    Ok(json)
}

#[cfg(test)]
mod tests {
    use super::*;

    const JSON: &str = r#"{"duration_s": 18.413264448308386}"#;

    #[test]
    fn packing_and_unpacking_are_inverse() {
        for text in [String::new(), JSON.into(), JSON.repeat(10_000)] {
            let packed = PackedPlan::of(text.as_bytes());
            assert_eq!(packed.unpacked().expect("intact"), text.as_bytes());
        }
        assert!(PackedPlan::of(JSON.repeat(100).as_bytes()).document.len() < 10 * JSON.len());
    }

    #[test]
    fn uncompressed_plans_of_older_versions_are_read() {
        let old = PackedPlan {
            document: JSON.into(),
            packed: false,
            digest: crate::base::digest::hex(JSON.as_bytes()),
        };
        assert_eq!(old.unpacked().expect("intact"), JSON.as_bytes());
    }

    #[test]
    fn damaged_plans_are_refused() {
        let sound = PackedPlan::of(JSON.as_bytes());
        for (place, bit) in
            (0..sound.document.len()).flat_map(|place| (0..8).map(move |b| (place, b)))
        {
            let mut damaged = sound.clone();
            damaged.document[place] ^= 1 << bit;
            // Some bits do not affect the content: either it is the same, or it is refused.
            if let Ok(json) = damaged.unpacked() {
                assert_eq!(json, JSON.as_bytes());
            }
        }
        // A row overwritten with another valid plan is refused as well.
        let other = PackedPlan::of(JSON.replace('8', "9").as_bytes());
        for exchanged in [
            PackedPlan {
                digest: other.digest.clone(),
                ..sound.clone()
            },
            PackedPlan {
                document: other.document,
                ..sound.clone()
            },
            PackedPlan {
                document: JSON.replace('8', "9").into(),
                packed: false,
                ..sound.clone()
            },
        ] {
            exchanged.unpacked().expect_err("another plan");
        }
        let short = PackedPlan {
            document: sound.document[..sound.document.len() / 2].into(),
            ..sound
        };
        short.unpacked().expect_err("half of it");
    }
}
