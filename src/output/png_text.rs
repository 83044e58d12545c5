//! Texts inside a PNG file, for programs that read its data.

use super::visible::visible;

/// Length of the signature and of the header chunk, after which texts may stand.
const AFTER_HEADER: usize = 8 + 25;

/// The name of the writing program.
pub(super) fn software() -> (&'static str, String) {
    (
        "Software",
        concat!("tabor ", env!("CARGO_PKG_VERSION")).to_owned(),
    )
}

/// `png` with a text chunk for each keyword and text after its header. Control characters are
/// escaped: programs print these texts, and a zero byte would end one early.
///
/// Texts outside ASCII are stored as `iTXt` (UTF-8), others as `tEXt`. Keywords are ASCII, shorter
/// than 80 bytes.
///
/// # Source
/// PNG specification, third edition, sections 5.3 (chunks) and 11.3.3 (texts).
pub(super) fn with_texts(png: &[u8], texts: &[(&str, String)]) -> Vec<u8> {
    let mut bytes = png[..AFTER_HEADER].to_vec();
    for (keyword, text) in texts {
        let mut content = keyword.as_bytes().to_vec();
        let text = visible(text);
        if text.is_ascii() {
            content.push(0);
            content.extend(text.bytes());
            bytes.extend(chunk(*b"tEXt", &content));
        } else {
            // Not compressed, no language, no translated keyword.
            content.extend([0, 0, 0, 0, 0]);
            content.extend(text.bytes());
            bytes.extend(chunk(*b"iTXt", &content));
        }
    }
    bytes.extend(&png[AFTER_HEADER..]);
    bytes
}

fn chunk(kind: [u8; 4], content: &[u8]) -> Vec<u8> {
    let mut bytes = (content.len() as u32).to_be_bytes().to_vec();
    bytes.extend(kind);
    bytes.extend(content);
    let checksum = crc32fast::hash(&bytes[4..]);
    bytes.extend(checksum.to_be_bytes());
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checksum_of_the_end_chunk() {
        // The last bytes of every PNG file.
        assert_eq!(chunk(*b"IEND", &[]), b"\0\0\0\0IEND\xae\x42\x60\x82");
    }
}
