//! The points that a fluid flows through, and the critical constriction.
//!
//! Points are opened from the widest gap down, and joined with the open ones beside them. The gap at which they first
//! reach from one cell into the next, or from inlet to outlet, is the critical one: the percolation of
//! Dapp, Luecke, Persson & Mueser 2012 (doi:10.1103/PhysRevLett.108.244301). In a repeating cell a cluster reaches
//! into the next one where two ways between the same points cross different numbers of cells (Machta et al. 1996,
//! doi:10.1103/PhysRevE.54.1332). Inlet and outlet are one point, and the way over the outlet crosses into the next cell.
//!
//! Each strip of rows is opened by itself. What others need to know of it is at which gaps the points of its first and its
//! last row become joined: the maximum spanning forest between these (Kruskal), of fewer edges than such points. The forests of
//! strips, with the links between them, give that of a rank, and those of all ranks the critical gap, exactly.

use rayon::prelude::*;

use super::clusters::{Clusters, Edge};
use super::faces::Frame;
use crate::backend::{BackendError, Share};
use crate::scene::Axis;

/// Rows of a strip.
const STRIP: usize = 32;

/// Rows that are opened by themselves.
struct Strip<'a> {
    frame: &'a Frame,
    /// The first row.
    first: usize,
    gap: &'a [f64],
}

impl Strip<'_> {
    fn rows(&self) -> usize {
        self.gap.len() / self.frame.points[0]
    }

    fn first_row(&self) -> &[f64] {
        &self.gap[..self.frame.points[0]]
    }

    fn last_row(&self) -> &[f64] {
        &self.gap[self.gap.len() - self.frame.points[0]..]
    }

    /// The number of inlet and outlet, after those of the points.
    fn ends(&self) -> u32 {
        self.gap.len() as u32
    }

    fn is_border(&self, point: usize) -> bool {
        let width = self.frame.points[0];
        point < width || point >= self.gap.len() - width
    }

    /// Inlet and outlet are there, and kept.
    fn clusters(&self) -> Clusters {
        let mut clusters = Clusters::new(self.gap.len() + 1);
        clusters.open(self.ends(), true);
        clusters
    }

    /// Opens a point and joins it with its open neighbours.
    fn open(&self, clusters: &mut Clusters, point: usize) {
        let [width, all] = self.frame.points;
        let is_x = self.frame.axis == Axis::X;
        let gap = self.gap[point];
        let (row, place) = (point / width, point % width);
        let join = |clusters: &mut Clusters, to: usize, cells: i32| {
            if clusters.is_open(to as u32) {
                clusters.join(Edge {
                    ends: [point as u32, to as u32],
                    cells,
                    gap,
                });
            }
        };
        let cell = i32::from(is_x);
        clusters.open(point as u32, self.is_border(point));
        if place + 1 < width {
            join(clusters, point + 1, 0);
        } else if self.frame.repeats {
            join(clusters, point - place, cell);
        }
        if place > 0 {
            join(clusters, point - 1, 0);
        } else if self.frame.repeats {
            join(clusters, point + width - 1, -cell);
        }
        if row + 1 < self.rows() {
            join(clusters, point + width, 0);
        }
        if row > 0 {
            join(clusters, point - width, 0);
        }
        if !self.frame.repeats {
            let (place, count) = if is_x {
                (place, width)
            } else {
                (self.first + row, all)
            };
            if place == 0 {
                join(clusters, self.gap.len(), 0);
            }
            if place + 1 == count {
                join(clusters, self.gap.len(), 1);
            }
        }
    }

    /// The forest between the points of its first and last row, in the numbers of a border, and the critical gap here.
    fn forest(&self) -> (Vec<Edge>, f64) {
        let mut order: Vec<(u64, u32)> = (self.gap.iter().zip(0..))
            .filter(|(gap, _)| **gap > 0.0)
            .map(|(gap, point)| (gap.to_bits(), point))
            .collect();
        // Positive numbers are in the order of their bits.
        order.sort_unstable_by(|a, b| b.cmp(a));
        let mut clusters = self.clusters();
        for (_, point) in order {
            self.open(&mut clusters, point as usize);
        }
        let border = Border::new(self.rows(), self.frame.points[0]);
        let mut edges = clusters.take_edges();
        for edge in &mut edges {
            edge.ends = edge.ends.map(|point| border.number(point, self.gap.len()));
        }
        (edges, clusters.critical())
    }

    /// Whether a cluster that reaches through has each point, where `winds` says of the border's points whether they are
    /// in one.
    fn conducts(&self, winds: &[bool]) -> Vec<bool> {
        let mut clusters = self.clusters();
        for (point, gap) in self.gap.iter().enumerate() {
            if *gap > 0.0 {
                self.open(&mut clusters, point);
            }
        }
        let border = Border::new(self.rows(), self.frame.points[0]);
        for point in (0..=self.gap.len()).filter(|point| self.is_border(*point)) {
            let point = point as u32;
            if clusters.is_open(point) && winds[border.number(point, self.gap.len()) as usize] {
                clusters.wind(point);
            }
        }
        let points = 0..self.ends();
        let conducts = points.map(|point| clusters.is_open(point) && clusters.winds(point));
        conducts.collect()
    }
}

/// The first and the last row of some rows, and after them inlet and outlet. Of a single row the first is the last.
#[derive(Clone, Copy)]
struct Border {
    width: usize,
    is_single: bool,
}

impl Border {
    fn new(rows: usize, width: usize) -> Border {
        Border {
            width,
            is_single: rows == 1,
        }
    }

    /// Points of a border, inlet and outlet among them.
    fn len(width: usize) -> usize {
        2 * width + 1
    }

    /// The number of a point of the first row, or of the last.
    fn place(&self, is_last: bool, column: usize) -> usize {
        if is_last && !self.is_single {
            self.width + column
        } else {
            column
        }
    }

    /// The number of a point of these rows, whose inlet and outlet has the number `end` there: a point of the first row has its
    /// column, any other one lies in the last.
    fn number(&self, point: u32, end: usize) -> u32 {
        let (point, width) = (point as usize, self.width);
        let number = if point == end {
            2 * width
        } else if point < width {
            point
        } else {
            self.place(true, point % width)
        };
        number as u32
    }
}

/// Borders of rows one after another, whose inlets and outlets are the same.
struct Borders {
    borders: Vec<Border>,
    width: usize,
}

impl Borders {
    fn new(borders: Vec<Border>, width: usize) -> Borders {
        Borders { borders, width }
    }

    fn len(&self) -> usize {
        2 * self.width * self.borders.len() + 1
    }

    /// The number of a border's point.
    fn number(&self, border: usize, point: usize) -> u32 {
        let number = if point == 2 * self.width {
            self.len() - 1
        } else {
            2 * self.width * border + point
        };
        number as u32
    }

    /// An edge of a border in the numbers of all.
    fn edge(&self, border: usize, edge: &Edge) -> Edge {
        Edge {
            ends: edge.ends.map(|end| self.number(border, end as usize)),
            ..*edge
        }
    }

    /// The links between the last row of a border and the first of another one, with these gaps.
    fn links(&self, borders: [usize; 2], rows: [&[f64]; 2], cells: i32) -> Vec<Edge> {
        let [from, to] = borders;
        let pairs = rows[0].iter().zip(rows[1]).enumerate();
        let open = pairs.filter(|(_, (one, other))| **one > 0.0 && **other > 0.0);
        let links = open.map(|(column, (one, other))| Edge {
            ends: [
                self.number(from, self.borders[from].place(true, column)),
                self.number(to, self.borders[to].place(false, column)),
            ],
            cells,
            gap: one.min(*other),
        });
        links.collect()
    }

    /// Whether a point lies in the first row of all or in the last, or is inlet and outlet.
    fn is_outer(&self, point: usize) -> bool {
        let (border, place) = (point / (2 * self.width), point % (2 * self.width));
        let is_last = |border: &Border| border.is_single || place >= self.width;
        border == 0 && place < self.width
            || border + 1 == self.borders.len() && is_last(&self.borders[border])
            || point + 1 == self.len()
    }

    /// The clusters of these edges, of which outer points are kept.
    fn clusters(&self, mut edges: Vec<Edge>) -> Clusters {
        edges.par_sort_unstable_by(|a, b| b.gap.total_cmp(&a.gap));
        let mut clusters = Clusters::new(self.len());
        for point in 0..self.len() {
            clusters.open(point as u32, self.is_outer(point));
        }
        edges.into_iter().for_each(|edge| clusters.join(edge));
        clusters
    }
}

/// Closes the points through which nothing flows in the held rows of a gap; returns the critical gap, 0 where the open points
/// do not percolate.
///
/// # Errors
/// A rank has ended.
pub(super) fn close(share: &Share, frame: &Frame, gap: &mut [f64]) -> Result<f64, BackendError> {
    let width = frame.points[0];
    let first = share.rows().start;
    let numbered = gap.chunks(STRIP * width).enumerate();
    let strips: Vec<Strip> = numbered
        .map(|(number, gap)| Strip {
            frame,
            first: first + number * STRIP,
            gap,
        })
        .collect();
    let forests: Vec<(Vec<Edge>, f64)> = strips.par_iter().map(Strip::forest).collect();

    // The strips of this rank.
    let borders = strips.iter().map(|strip| Border::new(strip.rows(), width));
    let borders = Borders::new(borders.collect(), width);
    let mut critical = forests
        .iter()
        .fold(0.0, |most: f64, (_, gap)| most.max(*gap));
    let mut edges = Vec::new();
    for (strip, (forest, _)) in forests.into_iter().enumerate() {
        edges.extend(forest.iter().map(|edge| borders.edge(strip, edge)));
    }
    for (strip, pair) in strips.windows(2).enumerate() {
        let rows = [pair[0].last_row(), pair[1].first_row()];
        edges.extend(borders.links([strip, strip + 1], rows, 0));
    }
    let mut clusters = borders.clusters(edges);
    critical = critical.max(clusters.critical());

    // All ranks.
    let slab = Border::new(share.rows().len(), width);
    let mut edges = clusters.take_edges();
    for edge in &mut edges {
        edge.ends = edge.ends.map(|point| slab.number(point, borders.len() - 1));
    }
    let rows = match (strips.first(), strips.last()) {
        (Some(first), Some(last)) => [first.first_row(), last.last_row()].concat(),
        _ => Vec::new(),
    };
    let (slabs, edges) = of_all_ranks(share, frame, &edges, &rows)?;
    let mut all = slabs.clusters(edges);
    critical = share.greatest(critical.max(all.critical()));
    share.failed()?;
    if critical <= 0.0 {
        return Ok(0.0);
    }

    // And back.
    let before = (0..share.rank()).filter(|rank| !share.rows_of(*rank).is_empty());
    let here = before.count();
    if !strips.is_empty() {
        for point in (0..borders.len()).filter(|point| borders.is_outer(*point)) {
            let outer = slab.number(point as u32, borders.len() - 1) as usize;
            if all.winds(slabs.number(here, outer)) {
                clusters.wind(point as u32);
            }
        }
    }
    let winds: Vec<bool> = (0..borders.len() as u32)
        .map(|point| clusters.winds(point))
        .collect();
    let conducts: Vec<Vec<bool>> = strips
        .par_iter()
        .enumerate()
        .map(|(number, strip)| {
            let points = 0..Border::len(width);
            let winds = points.map(|point| winds[borders.number(number, point) as usize]);
            strip.conducts(&winds.collect::<Vec<bool>>())
        })
        .collect();
    let parts = gap.par_chunks_mut(STRIP * width);
    parts.zip(conducts).for_each(|(gap, conducts)| {
        for (gap, conducts) in gap.iter_mut().zip(conducts) {
            if !conducts {
                *gap = 0.0;
            }
        }
    });
    Ok(critical)
}

/// The borders of all ranks that hold rows, and their edges with the links between them, from those of this rank and from its
/// first and last row.
fn of_all_ranks(
    share: &Share,
    frame: &Frame,
    edges: &[Edge],
    rows: &[f64],
) -> Result<(Borders, Vec<Edge>), BackendError> {
    const NUMBERS: usize = 4;
    let width = frame.points[0];
    let numbers = edges.iter().flat_map(|edge| {
        let [from, to] = edge.ends.map(f64::from);
        [from, to, f64::from(edge.cells), edge.gap]
    });
    let numbers: Vec<f64> = numbers.collect();
    let ranks = || 0..share.count();
    let lengths = share.numbers(&[numbers.len() as f64], ranks().map(|_| 1))?;
    let lengths: Vec<usize> = lengths.iter().map(|length| *length as usize).collect();
    let numbers = share.numbers(&numbers, lengths.iter().copied())?;
    let holding: Vec<usize> = ranks()
        .filter(|rank| !share.rows_of(*rank).is_empty())
        .collect();
    let held = |rank: usize| 2 * width * usize::from(!share.rows_of(rank).is_empty());
    let rows = share.numbers(rows, ranks().map(held))?;
    let rows: Vec<[&[f64]; 2]> = rows
        .chunks_exact(2 * width)
        .map(|rows| [&rows[..width], &rows[width..]])
        .collect();
    let borders = holding
        .iter()
        .map(|rank| Border::new(share.rows_of(*rank).len(), width));
    let slabs = Borders::new(borders.collect(), width);
    let mut all = Vec::new();
    let mut left = &numbers[..];
    for (slab, rank) in holding.iter().enumerate() {
        let (own, rest) = left.split_at(lengths[*rank]);
        left = rest;
        all.extend(own.chunks_exact(NUMBERS).map(|numbers| {
            let edge = Edge {
                ends: [numbers[0] as u32, numbers[1] as u32],
                cells: numbers[2] as i32,
                gap: numbers[3],
            };
            slabs.edge(slab, &edge)
        }));
    }
    for slab in 1..rows.len() {
        all.extend(slabs.links([slab - 1, slab], [rows[slab - 1][1], rows[slab][0]], 0));
    }
    if let (true, Some(first), Some(last)) = (frame.repeats, rows.first(), rows.last()) {
        let cells = i32::from(frame.axis == Axis::Y);
        all.extend(slabs.links([rows.len() - 1, 0], [last[1], first[0]], cells));
    }
    Ok((slabs, all))
}
