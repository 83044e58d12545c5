//! Clusters of open points, as trees whose roots stand for them, and what remains of them for those who know some of
//! the points only.

/// No point.
const NONE: u32 = u32::MAX;

/// Two points that are in one cluster where the points of at least `gap` are open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Edge {
    pub ends: [u32; 2],
    /// Cells that the way from the first to the second crosses along the flow.
    pub cells: i32,
    pub gap: f64,
}

/// Clusters of open points.
pub(super) struct Clusters {
    /// The next point towards the root; the root itself at the root, no point where it is closed.
    parent: Vec<u32>,
    /// Cells that the way to the parent crosses along the flow.
    cells: Vec<i32>,
    /// Whether a root's cluster reaches into the next cell: two ways between the same points cross different numbers of
    /// cells.
    winds: Vec<bool>,
    /// A point of a root's cluster that is kept, if it has one, and the cells on the way from there to the root.
    kept: Vec<(u32, i32)>,
    /// Ways between kept points, as many as join all of a cluster, from the widest on.
    edges: Vec<Edge>,
    /// The widest gap at which a cluster reached into the next cell; 0 if none did.
    critical: f64,
}

impl Clusters {
    /// So many closed points.
    pub fn new(points: usize) -> Clusters {
        Clusters {
            parent: vec![NONE; points],
            cells: vec![0; points],
            winds: vec![false; points],
            kept: vec![(NONE, 0); points],
            edges: Vec::new(),
            critical: 0.0,
        }
    }

    /// Opens a point, to be kept or not.
    pub fn open(&mut self, point: u32, is_kept: bool) {
        self.parent[point as usize] = point;
        if is_kept {
            self.kept[point as usize] = (point, 0);
        }
    }

    /// Whether a point is open.
    pub fn is_open(&self, point: u32) -> bool {
        self.parent[point as usize] != NONE
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

    /// Joins the clusters of two open points, of which the second lies so many cells ahead, at a gap not above those of earlier
    /// calls.
    pub fn join(&mut self, edge: Edge) {
        let Edge {
            ends: [one, other],
            cells,
            gap,
        } = edge;
        let (first, to_first) = self.root(one);
        let (second, to_second) = self.root(other);
        // From the first root to the second: back to one, over to the other, and on.
        let between = cells + to_second - to_first;
        let [a, b] = [first, second].map(|root| root as usize);
        if a == b {
            if between != 0 {
                self.winds[a] = true;
                self.critical = self.critical.max(gap);
            }
            return;
        }
        let ((from, to_a), (to, to_b)) = (self.kept[a], self.kept[b]);
        if from != NONE && to != NONE {
            self.edges.push(Edge {
                ends: [from, to],
                cells: to_a + between - to_b,
                gap,
            });
        } else if from != NONE {
            self.kept[b] = (from, to_a + between);
        }
        self.parent[a] = second;
        self.cells[a] = between;
        self.winds[b] |= self.winds[a];
    }

    /// The widest gap at which a cluster reached into the next cell; 0 if none did.
    pub fn critical(&self) -> f64 {
        self.critical
    }

    /// Whether an open point's cluster reaches into the next cell.
    pub fn winds(&mut self, point: u32) -> bool {
        let (root, _) = self.root(point);
        self.winds[root as usize]
    }

    /// From now on an open point's cluster does.
    pub fn wind(&mut self, point: u32) {
        let (root, _) = self.root(point);
        self.winds[root as usize] = true;
    }

    /// The ways between kept points, the widest first, and at the end one from a point to itself in the next cell for each cluster
    /// that reaches there, of gap 0: how wide it is, [`Clusters::critical`] says.
    pub fn take_edges(&mut self) -> Vec<Edge> {
        let mut edges = std::mem::take(&mut self.edges);
        for root in 0..self.parent.len() {
            let (kept, _) = self.kept[root];
            if self.parent[root] as usize == root && self.winds[root] && kept != NONE {
                edges.push(Edge {
                    ends: [kept; 2],
                    cells: 1,
                    gap: 0.0,
                });
            }
        }
        edges
    }
}
