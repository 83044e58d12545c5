//! Displacement of each asperity by the contacts: pair by pair if they are near or few, by the mesh
//! otherwise.

use super::Contact;
use super::lattice::Lattice;
use super::mesh::{Mesh, Stencil};
use super::newton::displacement_by;
use super::pair::pair;

/// Up to this number of contacts all pairs are summed; the mesh would cost more.
const FEW: usize = 96;
/// Distance in contact radii up to which a contact is more than a point load. Beyond, its
/// displacement is underestimated by `(a/r)^2/10` of itself, less than 1/360.
const WIDE: f64 = 6.0;
/// Largest derivative of one asperity's displacement with another's indentation. Two circles that
/// cover each other's summits act on the same place, and derivatives of 1 would leave their shares
/// of the load undetermined; less than 1 lets the lower one leave contact.
const STEEPEST: f64 = 0.9;

/// A contact's displacement of an asperity, or the part that the mesh lacks, m, and its derivative
/// with the contact's indentation.
#[derive(Clone, Copy, Debug)]
struct Pair {
    row: usize,
    source: usize,
    displacement: f64,
    slope: f64,
}

/// Displacements of some asperities (the rows) by the contacts of a set.
pub(super) struct Field<'a> {
    mesh: Option<&'a Mesh>,
    /// Stencils of the asperities on the mesh.
    stencils: &'a [Stencil],
    /// Indices of the rows.
    rows: Vec<usize>,
    /// Indices of the asperities in contact.
    touching: Vec<usize>,
    /// Load over modulus of each contact, m^2.
    loads: Vec<f64>,
    pairs: Vec<Pair>,
    /// Pairs of contacts whose circles overlap.
    pub overlapping: Vec<[usize; 2]>,
    /// Pairs of which one circle covers the other's summit.
    pub covering: Vec<[usize; 2]>,
}

impl<'a> Field<'a> {
    /// Collects the pairs.
    pub fn new(
        contacts: &[Contact],
        rows: &[usize],
        lattice: &'a Lattice,
        stencils: &'a [Stencil],
    ) -> Self {
        let touching: Vec<usize> = (0..contacts.len())
            .filter(|&i| contacts[i].contact_radius > 0.0)
            .collect();
        let mesh = lattice.mesh.as_ref().filter(|_| touching.len() > FEW);
        let mut field = Field {
            mesh,
            stencils,
            rows: rows.to_vec(),
            loads: touching
                .iter()
                .map(|&i| contacts[i].load_over_modulus())
                .collect(),
            pairs: Vec::new(),
            overlapping: Vec::new(),
            covering: Vec::new(),
            touching,
        };
        match mesh {
            None => field.take_all(contacts, lattice),
            Some(mesh) => field.take_near(contacts, lattice, mesh),
        }
        field
    }

    fn take_all(&mut self, contacts: &[Contact], lattice: &Lattice) {
        let own = lattice.rest([0.0, 0.0]);
        for source in 0..self.touching.len() {
            let j = self.touching[source];
            let contact = &contacts[j];
            for row in 0..self.rows.len() {
                let i = self.rows[row];
                let (displacement, slope) = if i == j {
                    (own * self.loads[source], own * 2.0 * contact.contact_radius)
                } else {
                    let position = contacts[i].asperity.position;
                    let [x, y] = lattice.offset(contact.asperity.position, position);
                    self.note(contacts, i, j, x.hypot(y));
                    displacement_by(contact, position, lattice)
                };
                self.pairs.push(Pair {
                    row,
                    source,
                    displacement,
                    slope: slope.min(STEEPEST),
                });
            }
        }
    }

    fn take_near(&mut self, contacts: &[Contact], lattice: &Lattice, mesh: &Mesh) {
        let bins = Bins::new(contacts, &self.rows, lattice.size(), mesh.reach());
        let own = mesh.smooth(0.0);
        for source in 0..self.touching.len() {
            let j = self.touching[source];
            let contact = contacts[j];
            let (load, stiffness) = (self.loads[source], 2.0 * contact.contact_radius);
            let reach = mesh.reach().max(WIDE * contact.contact_radius);
            let square = reach * reach;
            bins.each_near(contact.asperity.position, reach, |row| {
                let i = self.rows[row];
                if i == j {
                    self.pairs.push(Pair {
                        row,
                        source,
                        displacement: -own * load,
                        slope: -own * stiffness,
                    });
                    return;
                }
                let [x, y] =
                    lattice.offset(contact.asperity.position, contacts[i].asperity.position);
                if x * x + y * y >= square {
                    return;
                }
                let distance = x.hypot(y);
                self.note(contacts, i, j, distance);
                let (u, slope) = pair(contact.contact_radius, contact.asperity.radius, distance);
                let smooth = mesh.smooth(distance);
                self.pairs.push(Pair {
                    row,
                    source,
                    displacement: u - smooth * load,
                    slope: slope.min(STEEPEST) - smooth * stiffness,
                });
            });
        }
    }

    /// Records whether two circles overlap, tested from the wider one.
    fn note(&mut self, contacts: &[Contact], i: usize, j: usize, distance: f64) {
        let (other, wider) = (contacts[i].contact_radius, contacts[j].contact_radius);
        if other > 0.0 && (other, i) < (wider, j) {
            if distance < other + wider {
                self.overlapping.push([i, j]);
            }
            if distance < wider {
                self.covering.push([i, j]);
            }
        }
    }

    /// Displacement of each row, m, by the contacts selected by `counted`.
    pub fn displacement(&self, counted: impl Fn(usize) -> bool) -> Vec<f64> {
        let takes: Vec<bool> = self.touching.iter().map(|&i| counted(i)).collect();
        let mut sums = self.smooth(|source| {
            if takes[source] {
                self.loads[source]
            } else {
                0.0
            }
        });
        for pair in &self.pairs {
            if takes[pair.source] {
                sums[pair.row] += pair.displacement;
            }
        }
        sums
    }

    fn smooth(&self, load: impl Fn(usize) -> f64) -> Vec<f64> {
        let Some(mesh) = self.mesh else {
            return vec![0.0; self.rows.len()];
        };
        let loads = self
            .touching
            .iter()
            .enumerate()
            .map(|(source, &i)| (&self.stencils[i], load(source)));
        let field = mesh.displacement(loads);
        self.rows
            .iter()
            .map(|&i| mesh.at(&field, &self.stencils[i]))
            .collect()
    }

    /// The linearised displacement of the active rows.
    pub fn slopes(&self, active: &[usize], contacts: &[Contact]) -> Slopes<'a> {
        // Index of each row, and of each contact, among the active ones.
        let mut of_row = vec![None; self.rows.len()];
        let mut of_asperity = vec![None; contacts.len()];
        for (place, &row) in active.iter().enumerate() {
            of_row[row] = Some(place);
            of_asperity[self.rows[row]] = Some(place);
        }
        let pairs = self.pairs.iter().filter_map(|pair| {
            let to = of_row[pair.row]?;
            let from = of_asperity[self.touching[pair.source]]?;
            Some((to as u32, from as u32, pair.slope))
        });
        Slopes {
            mesh: self.mesh,
            pairs: pairs.collect(),
            stencils: active
                .iter()
                .filter_map(|&row| self.stencils.get(self.rows[row]).copied())
                .collect(),
            stiffness: active
                .iter()
                .map(|&row| 2.0 * contacts[self.rows[row]].contact_radius)
                .collect(),
        }
    }
}

/// Linearised displacements of the active asperities by their indentations.
pub(super) struct Slopes<'a> {
    mesh: Option<&'a Mesh>,
    pairs: Vec<(u32, u32, f64)>,
    stencils: Vec<Stencil>,
    /// Load over modulus by indentation of each, m.
    pub stiffness: Vec<f64>,
}

impl Slopes<'_> {
    /// Adds the displacements by the indentations `by` to `sums`, m.
    pub fn add(&self, by: &[f64], sums: &mut [f64]) {
        for &(to, from, slope) in &self.pairs {
            sums[to as usize] += slope * by[from as usize];
        }
        if let Some(mesh) = self.mesh {
            let loads = self.stencils.iter().zip(by.iter().zip(&self.stiffness));
            let field =
                mesh.displacement(loads.map(|(place, (by, stiffness))| (place, by * stiffness)));
            for (sum, place) in sums.iter_mut().zip(&self.stencils) {
                *sum += mesh.at(&field, place);
            }
        }
    }
}

/// Rows by their part of the cell.
struct Bins {
    size: [f64; 2],
    counts: [usize; 2],
    first: Vec<usize>,
    rows: Vec<usize>,
}

impl Bins {
    fn new(contacts: &[Contact], rows: &[usize], size: [f64; 2], reach: f64) -> Self {
        let counts = size.map(|side| ((side / reach) as usize).max(1));
        let mut bins = Bins {
            size,
            counts,
            first: vec![0; counts[0] * counts[1] + 1],
            rows: vec![0; rows.len()],
        };
        let homes: Vec<usize> = rows
            .iter()
            .map(|&i| {
                let [x, y] = bins.home(contacts[i].asperity.position);
                y * counts[0] + x
            })
            .collect();
        for home in &homes {
            bins.first[home + 1] += 1;
        }
        for bin in 1..bins.first.len() {
            bins.first[bin] += bins.first[bin - 1];
        }
        let mut next = bins.first.clone();
        for (row, &home) in homes.iter().enumerate() {
            bins.rows[next[home]] = row;
            next[home] += 1;
        }
        bins
    }

    fn home(&self, position: [f64; 2]) -> [usize; 2] {
        [0, 1].map(|axis| {
            let share = position[axis] / self.size[axis];
            ((share * self.counts[axis] as f64) as usize).min(self.counts[axis] - 1)
        })
    }

    /// Calls `at` with each row in the bins within `reach` (m) of a position.
    fn each_near(&self, position: [f64; 2], reach: f64, mut at: impl FnMut(usize)) {
        let home = self.home(position);
        let span = |axis: usize| {
            let count = self.counts[axis];
            let wide = (reach / self.size[axis] * count as f64).ceil() as usize;
            let from = home[axis] + count * (1 + wide / count) - wide;
            (from, (2 * wide + 1).min(count))
        };
        let ((x, wide), (y, high)) = (span(0), span(1));
        for row in y..y + high {
            for column in x..x + wide {
                let bin = row % self.counts[1] * self.counts[0] + column % self.counts[0];
                for &found in &self.rows[self.first[bin]..self.first[bin + 1]] {
                    at(found);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Asperity;
    use super::super::set::Set;
    use super::*;

    /// Contacts at random positions, more than are summed pair by pair, including a wide one: the
    /// mesh against the sum over all pairs.
    #[test]
    fn the_mesh_and_its_pairs_are_the_sum_over_all_pairs() {
        let size = [4.0, 3.0];
        let place = |i: usize, step: f64, side: f64| (i as f64 * step).fract() * side;
        let contacts: Vec<Contact> = (0..400)
            .map(|i| Contact {
                asperity: Asperity {
                    position: [
                        place(i, 0.754_877_7, size[0]),
                        place(i, 0.569_840_3, size[1]),
                    ],
                    height: 0.0,
                    radius: 1.0,
                },
                contact_radius: match i {
                    7 => 0.2,
                    i if i % 2 == 0 => 0.01 + 0.02 * place(i, 0.618_034, 1.0),
                    _ => 0.0,
                },
            })
            .collect();
        let rows: Vec<usize> = (0..contacts.len()).collect();
        let lattice = Lattice::periodic(size).with_mesh(contacts.len());
        let asperities = contacts.iter().map(|contact| contact.asperity).collect();
        let set = Set::new(asperities, &lattice);
        let field = Field::new(&contacts, &rows, &lattice, &set.stencils);
        let found = field.displacement(|_| true);
        let own = lattice.rest([0.0, 0.0]);
        // The mesh omits an erfc of 2.4e-4 at its shortest wave; the table of the remainder is
        // accurate to 1e-4/L.
        let coarse = 2.4e-4 * 3.0 / field.mesh.expect("many contacts").reach() + 3e-5;
        for (i, found) in found.iter().enumerate() {
            let mut sum = own * contacts[i].load_over_modulus();
            let mut bound = coarse * contacts[i].load_over_modulus();
            for (j, contact) in contacts.iter().enumerate() {
                if j != i && contact.contact_radius > 0.0 {
                    let position = contacts[i].asperity.position;
                    sum += displacement_by(contact, position, &lattice).0;
                    let [x, y] = lattice.offset(contact.asperity.position, position);
                    // A distant contact is taken as a point, which underestimates it by 1/360 at
                    // most (and 3 % of that).
                    let point = 1.03 / (std::f64::consts::PI * x.hypot(y) * 360.0);
                    bound += contact.load_over_modulus() * (coarse + point);
                }
            }
            assert!((found - sum).abs() < bound, "{i}: {found} {sum} {bound}");
        }
        let pairs = field.overlapping.iter().filter(|[i, j]| *i == 7 || *j == 7);
        assert!(pairs.count() > 0);
    }
}
