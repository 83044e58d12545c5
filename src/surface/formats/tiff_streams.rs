//! Strips and tiles of a TIFF image, unpacked a row at a time: those too large to be held where several processes read a file.
//!
//! # Source
//! Adobe, "TIFF Revision 6.0" (1992), sections 9, 13, 14; "Adobe Photoshop TIFF Technical Notes" (2002 and 3, 2005), deflate and the
//! predictor of floating point.

use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom};

use flate2::bufread::ZlibDecoder;
use tiff::TiffError;
use tiff::decoder::Decoder;
use tiff::tags::{ByteOrder, CompressionMethod, PhotometricInterpretation, Predictor, Tag};
use weezl::{BitOrder, LzwStatus};

use super::bytes::{Bytes, Opening, Stream};
use super::numbers::{NumberRows, Numbers};
use super::tiff::broken;
use super::unordered::Unordered;
use crate::surface::file_error::FileError;

/// Numbers of a row of the widest tile that is unpacked here.
const WIDEST_TILE: usize = 1 << 20;

/// Strips or tiles of an image, and how they are packed.
pub(super) struct Streams {
    file: Bytes,
    /// Rows and columns of the image, and of a strip or tile.
    shape: [usize; 2],
    chunk: [usize; 2],
    /// Where each begins in the file, and how many bytes it takes.
    places: Vec<[u64; 2]>,
    packing: Packing,
}

/// How the bytes of a row become its numbers.
#[derive(Clone, Copy)]
struct Packing {
    compression: CompressionMethod,
    predictor: Predictor,
    order: ByteOrder,
    is_float: bool,
    /// Bytes of a number.
    size: usize,
    /// Whether 0 is white.
    is_inverted: bool,
}

impl Streams {
    /// Those of an image of so many bits a number; `None` if it is packed in a way that is not unpacked here.
    pub fn new(
        image: &mut Decoder<BufReader<Stream>>,
        file: &Bytes,
        [shape, chunk]: [[usize; 2]; 2],
        (bits, is_float): (u8, bool),
    ) -> Result<Option<Self>, TiffError> {
        let compression: Option<u16> = image.find_tag_unsigned(Tag::Compression)?;
        let compression = compression.map_or(
            CompressionMethod::None,
            CompressionMethod::from_u16_exhaustive,
        );
        let is_known = matches!(
            compression,
            CompressionMethod::None
                | CompressionMethod::LZW
                | CompressionMethod::PackBits
                | CompressionMethod::Deflate
                | CompressionMethod::OldDeflate
        );
        let predictor: Option<u16> = image.find_tag_unsigned(Tag::Predictor)?;
        let predictor = predictor.map_or(Some(Predictor::None), Predictor::from_u16);
        let predictor = predictor.filter(|kind| is_float || *kind != Predictor::FloatingPoint);
        let shades: Option<u16> = image.find_tag_unsigned(Tag::PhotometricInterpretation)?;
        // A tile may be wider than the image, within reason.
        let is_known = is_known && chunk[1] <= shape[1].max(WIDEST_TILE);
        let (Some(predictor), true) = (predictor, is_known) else {
            return Ok(None);
        };
        let is_tiled = image.find_tag(Tag::TileOffsets)?.is_some();
        let [starts, lengths] = match is_tiled {
            true => [Tag::TileOffsets, Tag::TileByteCounts],
            false => [Tag::StripOffsets, Tag::StripByteCounts],
        }
        .map(|tag| image.get_tag_u64_vec(tag));
        let places: Vec<_> = starts?
            .into_iter()
            .zip(lengths?)
            .map(|(start, length)| [start, length])
            .collect();
        let count = shape[0].div_ceil(chunk[0]) * shape[1].div_ceil(chunk[1]);
        if places.len() < count {
            return Ok(None);
        }
        Ok(Some(Streams {
            file: file.clone(),
            shape,
            chunk,
            places,
            packing: Packing {
                compression,
                predictor,
                order: image.byte_order(),
                is_float,
                size: usize::from(bits / 8),
                is_inverted: shades == Some(PhotometricInterpretation::WhiteIsZero.to_u16()),
            },
        }))
    }

    /// The numbers of the image. Those of tiles wait for the others of their rows.
    ///
    /// # Errors
    /// Of tiles, which are read now, as of their rows; no temporary file.
    pub fn numbers(self) -> Result<Numbers, FileError> {
        let ([rows, columns], [height, width]) = (self.shape, self.chunk);
        if width == columns {
            return Ok(Numbers::Rows(Box::new(StripRows {
                streams: self,
                strip: None,
                given: 0,
            })));
        }
        let mut unordered = Unordered::new(self.shape, Opening::ByRows)?;
        let across = columns.div_ceil(width);
        let mut values = vec![0.0; width];
        for first_row in (0..rows).step_by(height) {
            for tile in 0..across {
                let first = tile * width;
                let mut rows_of_tile = self.open(first_row / height * across + tile)?;
                let values = &mut values[..width.min(columns - first)];
                for row in first_row..rows.min(first_row + height) {
                    rows_of_tile.next(values)?;
                    for (column, value) in (first..).zip(&*values) {
                        unordered.put(row * columns + column, *value)?;
                    }
                }
            }
        }
        Ok(unordered.numbers())
    }

    /// The rows of a strip or tile.
    fn open(&self, index: usize) -> Result<UnpackedRows, FileError> {
        let [start, length] = self.places[index];
        let mut bytes = self.file.stream();
        bytes.seek(SeekFrom::Start(start)).map_err(broken)?;
        let bytes: Box<dyn Read> = match self.packing.compression {
            CompressionMethod::LZW => Box::new(Lzw::new(bytes.take(length))),
            CompressionMethod::PackBits => Box::new(PackBits {
                packed: bytes.take(length),
                run: Run::Literal(0),
            }),
            // A stream of deflate says by itself where it ends, and not all programs say so rightly.
            CompressionMethod::Deflate | CompressionMethod::OldDeflate => {
                Box::new(ZlibDecoder::new(bytes))
            }
            _ => Box::new(bytes),
        };
        Ok(UnpackedRows {
            bytes,
            packing: self.packing,
            line: vec![0; self.chunk[1] * self.packing.size],
            planes: Vec::new(),
        })
    }
}

/// The rows of an image in strips.
struct StripRows {
    streams: Streams,
    /// The strip in which the next row lies.
    strip: Option<UnpackedRows>,
    /// Rows given so far.
    given: usize,
}

impl NumberRows for StripRows {
    fn next(&mut self, values: &mut [f64]) -> Result<(), FileError> {
        let [height, columns] = self.streams.chunk;
        for row in values.chunks_exact_mut(columns) {
            let begins = self.given.is_multiple_of(height);
            let strip = match self.strip.take() {
                Some(strip) if !begins => strip,
                _ => self.streams.open(self.given / height)?,
            };
            self.strip.insert(strip).next(row)?;
            self.given += 1;
        }
        Ok(())
    }
}

/// The rows of a strip or tile, as they are unpacked.
struct UnpackedRows {
    bytes: Box<dyn Read>,
    packing: Packing,
    /// The bytes of a row.
    line: Vec<u8>,
    /// Those of a row whose first bytes all come first, then the second ones, and so on.
    planes: Vec<u8>,
}

impl UnpackedRows {
    /// The next row, of at most as many numbers as a tile is wide.
    fn next(&mut self, values: &mut [f64]) -> Result<(), FileError> {
        self.bytes.read_exact(&mut self.line).map_err(broken)?;
        if self.packing.predictor == Predictor::FloatingPoint {
            self.join_planes();
        }
        match self.packing.size {
            1 => self.decode(values, |[byte]| byte.into()),
            2 => self.decode(values, |bytes| u16::from_be_bytes(bytes).into()),
            4 => self.decode(values, |bytes| u32::from_be_bytes(bytes).into()),
            _ => self.decode(values, u64::from_be_bytes),
        }
        Ok(())
    }

    /// The bits of each number from its bytes, the most significant first, and the number from its bits.
    fn decode<const SIZE: usize>(&self, values: &mut [f64], bits: impl Fn([u8; SIZE]) -> u64) {
        let packing = &self.packing;
        let is_little = packing.order == ByteOrder::LittleEndian
            && packing.predictor != Predictor::FloatingPoint;
        let is_sum = packing.predictor == Predictor::Horizontal;
        let mask = u64::MAX >> (u64::BITS as usize - 8 * SIZE);
        let (elements, _) = self.line.as_chunks::<SIZE>();
        let mut before = 0_u64;
        for (value, element) in values.iter_mut().zip(elements) {
            let mut element = *element;
            if is_little {
                element.reverse();
            }
            let mut found = bits(element);
            if is_sum {
                found = found.wrapping_add(before) & mask;
                before = found;
            }
            *value = packing.number(found);
        }
    }

    /// Undoes the differences of bytes, and puts those of a number side by side, the most significant first.
    fn join_planes(&mut self) {
        let mut before = 0_u8;
        for byte in &mut self.line {
            before = before.wrapping_add(*byte);
            *byte = before;
        }
        self.planes.clone_from(&self.line);
        let size = self.packing.size;
        let count = self.line.len() / size;
        for (place, bytes) in self.line.chunks_exact_mut(size).enumerate() {
            for (plane, byte) in bytes.iter_mut().enumerate() {
                *byte = self.planes[plane * count + place];
            }
        }
    }
}

impl Packing {
    /// A shade from 0, black, to 1, white, or a height, of its bits.
    fn number(&self, bits: u64) -> f64 {
        let shade = |white: u64| {
            let shade = if self.is_inverted { white - bits } else { bits };
            shade as f64 / white as f64
        };
        match (self.is_float, self.size) {
            (false, 1) => shade(u8::MAX.into()),
            (false, _) => shade(u16::MAX.into()),
            (true, 4) => {
                let height = f32::from_bits(bits as u32);
                if self.is_inverted {
                    1.0 - height
                } else {
                    height
                }
                .into()
            }
            (true, _) => {
                let height = f64::from_bits(bits);
                if self.is_inverted {
                    1.0 - height
                } else {
                    height
                }
            }
        }
    }
}

/// Bytes that LZW packs.
struct Lzw<R> {
    packed: R,
    decoder: weezl::decode::Decoder,
}

impl<R: BufRead> Lzw<R> {
    fn new(packed: R) -> Self {
        let width = 8;
        let settings = weezl::decode::Configuration::with_tiff_size_switch(BitOrder::Msb, width);
        Lzw {
            packed,
            decoder: settings.with_yield_on_full_buffer(true).build(),
        }
    }
}

impl<R: BufRead> Read for Lzw<R> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        loop {
            let found = self.decoder.decode_bytes(self.packed.fill_buf()?, bytes);
            self.packed.consume(found.consumed_in);
            match found.status {
                Ok(LzwStatus::Ok) if found.consumed_out == 0 => {}
                Ok(LzwStatus::Ok | LzwStatus::Done) => return Ok(found.consumed_out),
                Ok(LzwStatus::NoProgress) => return Err(io::ErrorKind::UnexpectedEof.into()),
                Err(error) => return Err(io::Error::new(io::ErrorKind::InvalidData, error)),
            }
        }
    }
}

/// Bytes packed as runs of equal ones.
struct PackBits<R> {
    packed: R,
    run: Run,
}

/// What is left of a run.
enum Run {
    /// So many bytes as they are.
    Literal(usize),
    /// So many times a byte.
    Repeated(usize, u8),
}

impl<R: Read> Read for PackBits<R> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        while let Run::Literal(0) | Run::Repeated(0, _) = self.run {
            let mut header = [0];
            if self.packed.read(&mut header)? == 0 {
                return Ok(0);
            }
            self.run = match header[0] as i8 {
                count @ 0.. => Run::Literal(count as usize + 1),
                // By the standard it is passed over.
                i8::MIN => continue,
                count => {
                    let mut byte = [0];
                    self.packed.read_exact(&mut byte)?;
                    Run::Repeated(1 + usize::from(count.unsigned_abs()), byte[0])
                }
            };
        }
        match &mut self.run {
            Run::Literal(left) => {
                let most = bytes.len().min(*left);
                let count = self.packed.read(&mut bytes[..most])?;
                *left -= count;
                Ok(count)
            }
            Run::Repeated(left, byte) => {
                let count = bytes.len().min(*left);
                bytes[..count].fill(*byte);
                *left -= count;
                Ok(count)
            }
        }
    }
}
