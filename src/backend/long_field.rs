//! Memory of a field, which Linux hands out in large pages where it is long: the first touch of small ones takes a tenth of
//! the seconds of a solve.

use std::fmt;
use std::ops::{Deref, DerefMut};

use rayon::prelude::*;

#[cfg(target_os = "linux")]
use memmap2::{Advice, MmapMut};

/// Bytes of a large page. A field that does not fill one comes from the allocator.
#[cfg(target_os = "linux")]
const LARGE_PAGE: usize = 2 << 20;

/// The values of a field.
pub struct LongField<T>(Memory<T>);

/// Where they are.
enum Memory<T> {
    /// With the allocator.
    Allocated(Vec<T>),
    /// In pages of their own: so many bytes from the first large page on.
    #[cfg(target_os = "linux")]
    Mapped {
        pages: MmapMut,
        first: usize,
        bytes: usize,
    },
}

impl<T> Default for LongField<T> {
    fn default() -> Self {
        Vec::new().into()
    }
}

impl<T: bytemuck::Pod> LongField<T> {
    /// So many values of 0.
    pub fn zeros(count: usize) -> Self {
        #[cfg(target_os = "linux")]
        if let Some(mapped) = count.checked_mul(size_of::<T>()).and_then(mapped) {
            return LongField(mapped);
        }
        bytemuck::zeroed_vec(count).into()
    }
}

/// So many bytes of 0, if they fill a large page.
#[cfg(target_os = "linux")]
fn mapped<T>(bytes: usize) -> Option<Memory<T>> {
    if bytes < LARGE_PAGE {
        return None;
    }
    let pages = MmapMut::map_anon(bytes.checked_add(LARGE_PAGE)?).ok()?;
    let first = pages.as_ptr().align_offset(LARGE_PAGE);
    let whole = bytes / LARGE_PAGE * LARGE_PAGE;
    // A kernel without large pages has small ones.
    let _ = pages.advise_range(Advice::HugePage, first, whole);
    // What is beyond the last whole one stays in small pages, so that no more memory is taken than the values need.
    let _ = pages.advise_range(
        Advice::NoHugePage,
        first + whole,
        pages.len() - first - whole,
    );
    #[cfg(feature = "fault-injection")]
    MAPPED.fetch_add(bytes, std::sync::atomic::Ordering::Relaxed);
    Some(Memory::Mapped {
        pages,
        first,
        bytes,
    })
}

/// Bytes of all fields that were mapped so far, for tests that count: the allocator does not see them.
#[cfg(feature = "fault-injection")]
pub static MAPPED: std::sync::atomic::AtomicUsize = std::sync::atomic::AtomicUsize::new(0);

impl<T> From<Vec<T>> for LongField<T> {
    fn from(values: Vec<T>) -> Self {
        LongField(Memory::Allocated(values))
    }
}

/// Without a copy where the values are with the allocator.
impl<T: bytemuck::Pod + Send + Sync> From<LongField<T>> for Vec<T> {
    fn from(field: LongField<T>) -> Self {
        match field.0 {
            Memory::Allocated(values) => values,
            #[cfg(target_os = "linux")]
            Memory::Mapped { .. } => field.par_iter().copied().collect(),
        }
    }
}

impl<T: bytemuck::Pod> Clone for LongField<T> {
    fn clone(&self) -> Self {
        let mut copy = LongField::zeros(self.len());
        copy.copy_from_slice(self);
        copy
    }
}

impl<T: bytemuck::Pod + PartialEq> PartialEq for LongField<T> {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl<T: bytemuck::Pod + fmt::Debug> fmt::Debug for LongField<T> {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        (**self).fmt(out)
    }
}

impl<'a, T: bytemuck::Pod> IntoIterator for &'a LongField<T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<'a, T: bytemuck::Pod> IntoIterator for &'a mut LongField<T> {
    type Item = &'a mut T;
    type IntoIter = std::slice::IterMut<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter_mut()
    }
}

impl<T: bytemuck::Pod> Deref for LongField<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        match &self.0 {
            Memory::Allocated(values) => values,
            #[cfg(target_os = "linux")]
            Memory::Mapped {
                pages,
                first,
                bytes,
            } => bytemuck::cast_slice(&pages[*first..first + bytes]),
        }
    }
}

impl<T: bytemuck::Pod> DerefMut for LongField<T> {
    fn deref_mut(&mut self) -> &mut [T] {
        match &mut self.0 {
            Memory::Allocated(values) => values,
            #[cfg(target_os = "linux")]
            Memory::Mapped {
                pages,
                first,
                bytes,
            } => bytemuck::cast_slice_mut(&mut pages[*first..*first + *bytes]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lengths around a large page: zeros at first, each value in its own place.
    #[test]
    fn fields_of_many_lengths() {
        let page = (2 << 20) / size_of::<f64>();
        for count in [0, 1, 1000, page - 1, page, page + 1, 2 * page + 77] {
            let mut field = LongField::<f64>::zeros(count);
            assert_eq!(field.len(), count);
            assert!(field.iter().all(|&value| value == 0.0));
            for (at, value) in field.iter_mut().enumerate() {
                *value = at as f64;
            }
            assert!(
                field
                    .iter()
                    .enumerate()
                    .all(|(at, &value)| value == at as f64)
            );
            let copy = field.clone();
            assert!(copy == field);
            assert_eq!(Vec::from(copy), *field);
        }
    }
}
