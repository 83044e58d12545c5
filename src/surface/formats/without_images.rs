//! Grey images and archives in a build without the feature `images`: they are known, and not read.

use super::FileError;
use super::Map;
use super::bytes::Bytes;

/// PNG images.
pub(super) mod png {
    use super::*;

    /// First bytes of a file.
    pub const MAGIC: &[u8] = b"\x89PNG\r\n\x1a\n";

    /// Its header is not read.
    pub fn claimed_points<R>(_: R) -> Option<[usize; 2]> {
        None
    }

    /// Refuses the image.
    pub fn read(_: Bytes) -> Result<Map, FileError> {
        Err(not_built("PNG images"))
    }
}

/// TIFF images.
pub(super) mod tiff {
    use super::*;

    /// First bytes of a file: both orders of bytes, and files beyond 4 GiB.
    pub const MAGIC: [&[u8]; 4] = [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"];

    /// Its header is not read.
    pub fn claimed_points<R>(_: R) -> Option<[usize; 2]> {
        None
    }

    /// Refuses the image.
    pub fn read(_: Bytes) -> Result<Map, FileError> {
        Err(not_built("TIFF images"))
    }
}

/// X3P archives.
pub(super) mod x3p {
    use super::*;

    /// First bytes of a file.
    pub const MAGIC: &[u8] = b"PK\x03\x04";

    /// Its description is not read.
    pub fn claimed_points<R>(_: R) -> Option<[usize; 2]> {
        None
    }

    /// Refuses the archive.
    pub fn read(_: Bytes) -> Result<Map, FileError> {
        Err(not_built("X3P surfaces"))
    }
}

fn not_built(what: &'static str) -> FileError {
    FileError::NotSupported {
        what,
        instead: "build tabor with its feature `images`, or save the heights as .npy",
    }
}
