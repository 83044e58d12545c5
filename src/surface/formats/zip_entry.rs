//! An entry of a ZIP archive, unpacked while it is read, so that none of it is held.

use std::io::{self, BufReader, Read, Seek, SeekFrom};

use flate2::bufread::DeflateDecoder;
use zip::{CompressionMethod, ZipArchive};

use super::bytes::{Bytes, Opening, Stream};

/// Bytes that are passed over at once.
const PASSED_OVER: usize = 1 << 16;

/// The unpacked bytes of an entry. To go back is to unpack it again from its beginning.
pub(super) struct ZipEntry {
    file: Bytes,
    /// Where its bytes begin in the archive, and how many there are.
    start: u64,
    packed: u64,
    is_packed: bool,
    /// Unpacked bytes.
    length: u64,
    unpacked: Box<dyn Read>,
    /// Offset of the next one.
    at: u64,
}

impl ZipEntry {
    /// The entry of this name. Unless for a glance it is read to its end, to be compared with its check sum.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn open(
        file: &Bytes,
        archive: &mut ZipArchive<BufReader<Stream>>,
        name: &str,
    ) -> Result<Self, String> {
        let mut entry = archive.by_name(name).map_err(|error| error.to_string())?;
        let method = entry.compression();
        let is_packed = match method {
            CompressionMethod::Stored => false,
            CompressionMethod::Deflated => true,
            other => return Err(format!("it is compressed by {other}")),
        };
        let (start, packed) = (entry.data_start(), entry.compressed_size());
        let length = match file.opening() {
            Opening::Glance => entry.size(),
            _ => io::copy(&mut entry, &mut io::sink()).map_err(|error| error.to_string())?,
        };
        let mut found = ZipEntry {
            file: file.clone(),
            start: start.unwrap_or(u64::MAX),
            packed,
            is_packed,
            length,
            unpacked: Box::new(io::empty()),
            at: 0,
        };
        found.restart().map_err(|error| error.to_string())?;
        Ok(found)
    }

    /// Number of its unpacked bytes.
    pub fn length(&self) -> u64 {
        self.length
    }

    fn restart(&mut self) -> io::Result<()> {
        let mut bytes = self.file.stream();
        bytes.seek(SeekFrom::Start(self.start))?;
        let bytes = bytes.take(self.packed);
        self.unpacked = match self.is_packed {
            true => Box::new(DeflateDecoder::new(bytes)),
            false => Box::new(bytes),
        };
        self.at = 0;
        Ok(())
    }
}

impl Read for ZipEntry {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let count = self.unpacked.read(bytes)?;
        self.at += count as u64;
        Ok(count)
    }
}

impl Seek for ZipEntry {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let place = match to {
            SeekFrom::Start(place) => i128::from(place),
            SeekFrom::Current(by) => i128::from(self.at) + i128::from(by),
            SeekFrom::End(by) => i128::from(self.length) + i128::from(by),
        };
        let place = u64::try_from(place).map_err(|_| io::ErrorKind::InvalidInput)?;
        if place < self.at {
            self.restart()?;
        }
        let mut piece = [0; PASSED_OVER];
        while self.at < place {
            let count = (place - self.at).min(PASSED_OVER as u64) as usize;
            if self.read(&mut piece[..count])? == 0 {
                break;
            }
        }
        Ok(self.at)
    }
}
