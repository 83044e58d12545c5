//! Numbers that several hold and nobody copies.

use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

/// Numbers, one a point, that whoever needs them shares: a clone holds the same ones.
///
/// They are tabor's own, or lent by somebody who keeps them elsewhere, such as in an array of another language.
/// To go through lent ones takes one look at who lends them and none a number: take the slice before a loop.
#[derive(Clone)]
pub struct SharedValues(Holder);

#[derive(Clone)]
enum Holder {
    Own(Arc<Vec<f64>>),
    Lent(Arc<dyn AsRef<[f64]> + Send + Sync>),
}

impl SharedValues {
    /// Numbers of an owner, which lives as long as somebody holds them. It must show the same ones each time it is
    /// asked: a contact looks at its heights in every solve.
    pub fn from_owner(owner: impl AsRef<[f64]> + Send + Sync + 'static) -> Self {
        SharedValues(Holder::Lent(Arc::new(owner)))
    }

    /// The numbers.
    pub fn as_slice(&self) -> &[f64] {
        match &self.0 {
            Holder::Own(values) => values,
            Holder::Lent(owner) => (**owner).as_ref(),
        }
    }

    /// The numbers in a vector, which is a copy where somebody else holds them too.
    pub fn into_vec(self) -> Vec<f64> {
        match self.0 {
            Holder::Own(values) => Arc::unwrap_or_clone(values),
            Holder::Lent(owner) => (*owner).as_ref().to_vec(),
        }
    }
}

impl From<Vec<f64>> for SharedValues {
    fn from(values: Vec<f64>) -> Self {
        SharedValues(Holder::Own(Arc::new(values)))
    }
}

impl Deref for SharedValues {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        self.as_slice()
    }
}

impl PartialEq for SharedValues {
    fn eq(&self, other: &Self) -> bool {
        self.as_slice() == other.as_slice()
    }
}

impl fmt::Debug for SharedValues {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Not millions of numbers.
        let count = self.as_slice().len();
        write!(formatter, "SharedValues({count} numbers)")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Shows a part of what it holds.
    struct Lender(Vec<f64>);

    impl AsRef<[f64]> for Lender {
        fn as_ref(&self) -> &[f64] {
            &self.0[1..]
        }
    }

    #[test]
    fn nobody_copies() {
        let kept = vec![1.0, 2.0, 3.0];
        let place = kept.as_ptr();
        let own = SharedValues::from(kept);
        let (first, second) = (own.clone(), own);
        assert_eq!([first.as_ptr(), second.as_ptr()], [place; 2]);
        drop(first);
        // The last holder has the vector itself.
        let vector = second.into_vec();
        assert_eq!(vector.as_ptr(), place);

        let lender = Lender(vec![1.0, 2.0, 3.0]);
        let place = lender.as_ref().as_ptr();
        let lent = SharedValues::from_owner(lender);
        assert_eq!(lent.clone().as_ptr(), place);
        assert_eq!(lent, SharedValues::from(vec![2.0, 3.0]));
        assert_eq!(lent.into_vec(), [2.0, 3.0]);
    }
}
