//! The points that a fluid flows through, and the critical constriction.
//!
//! Points are opened from the widest gap down, and joined with the open ones beside them. The gap at which they first
//! reach from one cell into the next, or from inlet to outlet, is the critical one: the percolation of
//! Dapp, Luecke, Persson & Mueser 2012 (doi:10.1103/PhysRevLett.108.244301). In a repeating cell a cluster reaches
//! into the next one where two paths between the same points cross different numbers of cells (Machta et al. 1996,
//! doi:10.1103/PhysRevE.54.1332).

use rayon::slice::ParallelSliceMut;

use super::lattice::Lattice;

/// No point.
const NONE: u32 = u32::MAX;

/// How a gap percolates.
pub(super) struct Percolation {
    /// Critical constriction over the largest gap; 0 where the open points do not percolate.
    pub critical_gap: f64,
    /// Points of the clusters that percolate, in the order of the field.
    pub conducting: Vec<u32>,
}

/// Finds the clusters that percolate.
pub(super) fn find(lattice: &Lattice) -> Percolation {
    let points = 0..lattice.len() as u32;
    let mut order: Vec<u32> = points
        .clone()
        .filter(|point| lattice.gap(*point as usize) > 0.0)
        .collect();
    // From the widest gap down, and among equals in the order of the field.
    order.par_sort_unstable_by(|a, b| {
        let [first, second] = [*a, *b].map(|point| lattice.gap(point as usize));
        second.total_cmp(&first).then(a.cmp(b))
    });
    let mut clusters = Clusters::new(lattice);
    let mut critical_gap = 0.0;
    let mut percolates = false;
    for point in order {
        clusters.open(lattice, point);
        if !percolates && clusters.percolates(point) {
            percolates = true;
            critical_gap = lattice.gap(point as usize);
        }
    }
    let conducting = if percolates {
        points.filter(|point| clusters.conducts(*point)).collect()
    } else {
        Vec::new()
    };
    Percolation {
        critical_gap,
        conducting,
    }
}

/// Clusters of open points, as trees whose roots stand for them.
struct Clusters {
    /// The next point towards the root; the root itself at the root, no point where it is closed.
    parent: Vec<u32>,
    /// Cells that the link to the parent crosses along the flow.
    cells: Vec<i32>,
    /// Roots of clusters that reach into the next cell.
    reaching: Vec<bool>,
    /// The inlet and the outlet, where there are any.
    ends: Option<[u32; 2]>,
}

impl Clusters {
    fn new(lattice: &Lattice) -> Clusters {
        let points = lattice.len() as u32;
        let ends = (!lattice.repeats).then_some([points, points + 1]);
        let all = lattice.len() + if ends.is_some() { 2 } else { 0 };
        let mut parent = vec![NONE; all];
        for end in ends.iter().flatten() {
            parent[*end as usize] = *end;
        }
        Clusters {
            parent,
            cells: vec![0; all],
            reaching: vec![false; all],
            ends,
        }
    }

    /// Opens a point and joins it with its open neighbours.
    fn open(&mut self, lattice: &Lattice, point: u32) {
        self.parent[point as usize] = point;
        for link in lattice.links(point as usize) {
            if self.parent[link.to] != NONE {
                self.join(point, link.to as u32, link.cells);
            }
        }
        if let Some(ends) = self.ends {
            for (end, conducts) in ends.into_iter().zip(lattice.ends(point as usize)) {
                if conducts > 0.0 {
                    self.join(point, end, 0);
                }
            }
        }
    }

    /// The root of an open point, and the cells that the path to it crosses.
    fn root(&mut self, point: u32) -> (u32, i32) {
        let mut at = point as usize;
        let mut cells = 0;
        while self.parent[at] as usize != at {
            let next = self.parent[at] as usize;
            // Halves the path for later calls.
            let [this, that] = [self.cells[at], self.cells[next]];
            if self.parent[next] as usize != next {
                self.parent[at] = self.parent[next];
                self.cells[at] = this + that;
                cells += this + that;
            } else {
                cells += this;
            }
            at = self.parent[at] as usize;
        }
        (at as u32, cells)
    }

    /// Joins the clusters of two open neighbours, of which the second lies so many `cells` ahead.
    fn join(&mut self, one: u32, other: u32, cells: i32) {
        let (first, to_first) = self.root(one);
        let (second, to_second) = self.root(other);
        // From the first root to the second: back to one, over to the other, and on.
        let between = cells + to_second - to_first;
        if first == second {
            if between != 0 {
                self.reaching[first as usize] = true;
            }
            return;
        }
        self.parent[first as usize] = second;
        self.cells[first as usize] = between;
        let reaches = self.reaching[first as usize];
        self.reaching[second as usize] |= reaches;
    }

    /// Whether the cluster of a point that has just been opened percolates.
    fn percolates(&mut self, point: u32) -> bool {
        match self.ends {
            None => {
                let (root, _) = self.root(point);
                self.reaching[root as usize]
            }
            Some([inlet, outlet]) => self.root(inlet).0 == self.root(outlet).0,
        }
    }

    /// Whether a point belongs to a cluster that percolates, where there is one.
    fn conducts(&mut self, point: u32) -> bool {
        if self.parent[point as usize] == NONE {
            return false;
        }
        let (root, _) = self.root(point);
        match self.ends {
            None => self.reaching[root as usize],
            Some([inlet, _]) => self.root(inlet).0 == root,
        }
    }
}
