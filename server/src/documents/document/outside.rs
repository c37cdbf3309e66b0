//! What of a document is not text in quotes.

/// The bytes outside of texts, with their places; of a text only the quote that opens it.
pub(super) fn outside_texts(document: &[u8]) -> impl Iterator<Item = (usize, u8)> {
    let (mut in_text, mut escaped) = (false, false);
    document
        .iter()
        .copied()
        .enumerate()
        .filter(move |&(_, byte)| {
            let inside = in_text;
            if inside {
                (in_text, escaped) = (escaped || byte != b'"', !escaped && byte == b'\\');
            } else {
                in_text = byte == b'"';
            }
            !inside
        })
}
