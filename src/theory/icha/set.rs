//! The remaining asperities, each with its stencil on the mesh.

use super::Asperity;
use super::lattice::Lattice;
use super::mesh::Stencil;

/// Asperities on an infinite half-space or in a cell.
#[derive(Clone, Debug)]
pub(super) struct Set {
    /// The asperities.
    pub asperities: Vec<Asperity>,
    /// Their stencils on the cell's mesh; empty without a mesh.
    pub stencils: Vec<Stencil>,
}

impl Set {
    /// Computes the stencils.
    pub fn new(asperities: Vec<Asperity>, lattice: &Lattice) -> Self {
        let mut set = Set {
            asperities: Vec::with_capacity(asperities.len()),
            stencils: Vec::new(),
        };
        asperities
            .into_iter()
            .for_each(|one| set.push(one, lattice));
        set
    }

    /// Adds one.
    pub fn push(&mut self, asperity: Asperity, lattice: &Lattice) {
        let place = lattice
            .mesh
            .as_ref()
            .map(|mesh| mesh.stencil(asperity.position));
        self.stencils.extend(place);
        self.asperities.push(asperity);
    }

    /// Removes the marked asperities.
    pub fn remove_marked(&mut self, gone: &[bool]) {
        retain_unmarked(&mut self.asperities, gone);
        retain_unmarked(&mut self.stencils, gone);
    }
}

/// Removes marked values; values without a mark stay.
pub(super) fn retain_unmarked<T>(values: &mut Vec<T>, gone: &[bool]) {
    let mut marks = gone.iter();
    values.retain(|_| !marks.next().is_some_and(|gone| *gone));
}
