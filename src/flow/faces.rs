//! The finest graph: the points of a strip of rows, one finite volume each, and the faces between them.

use super::graph::Graph;
use super::layout::NOWHERE;
use crate::grid::{Boundary, Grid};
use crate::scene::Axis;

/// A grid as the flow sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    /// Points along x and y.
    pub points: [usize; 2],
    /// What a square face of gap 1 along x, and along y, conducts.
    shares: [f64; 2],
    /// Where the fluid flows to.
    pub axis: Axis,
    /// Whether the cell repeats; else the first points along the flow are at the inlet, the last at the outlet.
    pub repeats: bool,
}

impl Frame {
    pub fn new(grid: &Grid, boundary: Boundary, axis: Axis) -> Frame {
        Frame {
            points: grid.points(),
            shares: [grid.dy() / grid.dx(), grid.dx() / grid.dy()],
            axis,
            repeats: boundary == Boundary::Periodic,
        }
    }
}

/// What a face between two cubes of gaps conducts: half a pixel of each, one after the other.
fn between(here: f64, there: f64) -> f64 {
    if here > 0.0 && there > 0.0 {
        2.0 * here * there / (here + there)
    } else {
        0.0
    }
}

/// The faces of a strip of rows. A point outside is one of the row above, or else one of the row below.
#[derive(Debug)]
pub(super) struct Faces {
    width: usize,
    /// Of each row the faces along x: that before the first point, and that after each point.
    along: Vec<f64>,
    /// Of each point of the row above and of each row the face to the row below.
    down: Vec<f64>,
    /// Whether the first point of a row lies after the last.
    wraps: bool,
    /// Cells that the flow crosses through the faces before the first and after the last point of a row, and through
    /// those to the rows above and below; ends of a grid that does not repeat count as such.
    crosses: [bool; 3],
    /// Whether what lies above belongs to this strip: the inlet.
    has_inlet: bool,
    /// Lost under a fall of pressure by 1 in faces between a point and itself in the next cell.
    looped: f64,
}

impl Faces {
    /// The rows from `first` on with these cubes of gaps, and with those of the rows above and below.
    pub fn new(frame: &Frame, first: usize, cubes: &[f64], outside: &[f64]) -> Faces {
        let [width, all] = frame.points;
        let rows = cubes.len() / width;
        let [is_x, is_y] = [frame.axis == Axis::X, frame.axis == Axis::Y];
        let is_first = first == 0;
        let is_last = first + rows == all;
        let ends = !frame.repeats;
        let mut looped = 0.0;
        let mut along = Vec::with_capacity(rows * (width + 1));
        for row in cubes.chunks_exact(width) {
            let (one, other) = (row[0], row[width - 1]);
            let [before, after] = match (ends, is_x) {
                (true, true) => [2.0 * one, 2.0 * other],
                (true, false) => [0.0; 2],
                (false, _) if width == 1 => {
                    looped += if is_x { one * frame.shares[0] } else { 0.0 };
                    [0.0; 2]
                }
                (false, _) => [between(other, one); 2],
            };
            along.push(before);
            along.extend(row.windows(2).map(|pair| between(pair[0], pair[1])));
            along.push(after);
        }
        let mut down = Vec::with_capacity((rows + 1) * width);
        let (above, below) = outside.split_at(width);
        for row in 0..=rows {
            let line = |row: usize| &cubes[row * width..(row + 1) * width];
            let upper = if row == 0 { above } else { line(row - 1) };
            let lower = if row == rows { below } else { line(row) };
            let is_end = row == 0 && is_first || row == rows && is_last;
            let faces = upper.iter().zip(lower);
            if is_end && ends {
                // Half a pixel of the one row that there is.
                down.extend(faces.map(|(u, l)| if is_y { 2.0 * (u + l) } else { 0.0 }));
            } else if all == 1 {
                if row == 0 && is_y {
                    looped += lower.iter().sum::<f64>() * frame.shares[1];
                }
                down.extend(faces.map(|_| 0.0));
            } else {
                down.extend(faces.map(|(u, l)| between(*u, *l)));
            }
        }
        along.iter_mut().for_each(|face| *face *= frame.shares[0]);
        down.iter_mut().for_each(|face| *face *= frame.shares[1]);
        Faces {
            width,
            along,
            down,
            wraps: frame.repeats,
            crosses: [is_x, is_y && is_first, is_y && is_last],
            has_inlet: is_y && is_first && ends,
            looped,
        }
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.down.len() - self.width
    }

    fn rows(&self) -> usize {
        self.len() / self.width
    }

    /// The faces of a row along x, to the row above and to that below.
    fn faces(&self, row: usize) -> [&[f64]; 3] {
        let width = self.width;
        [
            &self.along[row * (width + 1)..(row + 1) * (width + 1)],
            &self.down[row * width..(row + 1) * width],
            &self.down[(row + 1) * width..(row + 2) * width],
        ]
    }

    /// What enters each point through the faces that the flow crosses, at a pressure of 0 everywhere: the pressure that
    /// is solved for is that of the first cell, and the next one has 1 less; that of an inlet is 1.
    pub fn source(&self, source: &mut [f64]) {
        let width = self.width;
        let [is_along, is_first, is_last] = self.crosses;
        source.fill(0.0);
        if is_along {
            for (row, line) in source.chunks_exact_mut(width).enumerate() {
                let [along, _, _] = self.faces(row);
                line[0] += along[0];
                if self.wraps {
                    line[width - 1] -= along[width];
                }
            }
        }
        if is_first {
            for (s, face) in source[..width].iter_mut().zip(&self.down) {
                *s += face;
            }
        }
        if is_last && self.wraps {
            let last = self.len() - width;
            for (s, face) in source[last..].iter_mut().zip(&self.down[last + width..]) {
                *s -= face;
            }
        }
    }

    /// Power that is lost in the faces after each point along x and below it, and at the inlet.
    pub fn power(&self, pressure: &[f64], outside: &[f64]) -> f64 {
        let width = self.width;
        let [is_along, _, is_last] = self.crosses;
        let mut lost = self.looped;
        for (row, line) in pressure.chunks_exact(width).enumerate() {
            let [along, _, below] = self.faces(row);
            let next = if row + 1 == self.rows() {
                &outside[width..]
            } else {
                &pressure[(row + 1) * width..(row + 2) * width]
            };
            let inner = line.windows(2).zip(&along[1..]);
            let inner: f64 = inner
                .map(|(pair, face)| face * (pair[0] - pair[1]) * (pair[0] - pair[1]))
                .sum();
            let (one, other) = (line[0], line[width - 1]);
            let ends = if self.wraps {
                let drop = other - one + if is_along { 1.0 } else { 0.0 };
                along[width] * drop * drop
            } else {
                along[0] * (1.0 - one) * (1.0 - one) + along[width] * other * other
            };
            let falls = row + 1 == self.rows() && is_last && self.wraps;
            let fall = if falls { 1.0 } else { 0.0 };
            let across = line.iter().zip(next).zip(below);
            let across: f64 = across
                .map(|((here, there), face)| {
                    let drop = here - there + fall;
                    face * drop * drop
                })
                .sum();
            lost += inner + ends + across;
        }
        if self.has_inlet {
            let inlet = pressure[..width].iter().zip(&self.down);
            lost += inlet
                .map(|(here, face)| face * (1.0 - here) * (1.0 - here))
                .sum::<f64>();
        }
        lost
    }

    /// What leaves each point under a pressure here and outside, row by row.
    pub fn outflow(
        &self,
        pressure: &[f64],
        outside: &[f64],
        line_out: &mut Vec<f64>,
        mut left: impl FnMut(usize, &[f64]),
    ) {
        let width = self.width;
        line_out.resize(width, 0.0);
        for row in 0..self.rows() {
            let [along, to_above, to_below] = self.faces(row);
            let [above, line, below] = self.lines(row, pressure, outside);
            let vertical = line.iter().zip(above).zip(below);
            let faces = to_above.iter().zip(to_below);
            for ((out, ((here, u), d)), (up, down)) in line_out.iter_mut().zip(vertical).zip(faces)
            {
                *out = up * (here - u) + down * (here - d);
            }
            let faces = &along[1..width];
            let (ahead, behind) = (&line[1..], &line[..width - 1]);
            let flows = line_out.iter_mut().zip(faces);
            for ((out, face), (here, there)) in flows.zip(behind.iter().zip(ahead)) {
                *out += face * (here - there);
            }
            let flows = line_out[1..].iter_mut().zip(faces);
            for ((out, face), (here, there)) in flows.zip(ahead.iter().zip(behind)) {
                *out += face * (here - there);
            }
            let [before, after] = self.beside(line);
            line_out[0] += along[0] * (line[0] - before);
            line_out[width - 1] += along[width] * (line[width - 1] - after);
            left(row * width, line_out);
        }
    }

    /// The row above a row, this one, and that below.
    fn lines<'a>(&self, row: usize, pressure: &'a [f64], outside: &'a [f64]) -> [&'a [f64]; 3] {
        let width = self.width;
        let line = |row: usize| &pressure[row * width..(row + 1) * width];
        [
            if row == 0 {
                &outside[..width]
            } else {
                line(row - 1)
            },
            line(row),
            if row + 1 == self.rows() {
                &outside[width..]
            } else {
                line(row + 1)
            },
        ]
    }

    /// The pressures before the first point of a row and after the last.
    fn beside(&self, line: &[f64]) -> [f64; 2] {
        if self.wraps {
            [line[self.width - 1], line[0]]
        } else {
            [0.0; 2]
        }
    }

    /// Gives each point in turn, forwards or backwards, the pressure at which nothing is left over.
    pub fn relax(&self, source: &[f64], pressure: &mut [f64], outside: &[f64], forwards: bool) {
        let width = self.width;
        let mut entering = vec![0.0; width];
        // Share of the neighbour that comes just before in the order.
        let mut share = vec![0.0; width];
        for turn in 0..self.rows() {
            let row = if forwards {
                turn
            } else {
                self.rows() - 1 - turn
            };
            let [along, to_above, to_below] = self.faces(row);
            let [above, line, below] = self.lines(row, pressure, outside);
            let source = &source[row * width..(row + 1) * width];
            // All but what enters from the neighbour before in the order, which waits for it.
            let (old, old_face, new_face) = if forwards {
                (&line[1..], &along[1..width], &along[..width])
            } else {
                (&line[..width - 1], &along[1..width], &along[1..])
            };
            let vertical = source.iter().zip(above.iter().zip(below));
            let faces = to_above.iter().zip(to_below);
            for ((e, (s, (u, d))), (up, down)) in entering.iter_mut().zip(vertical).zip(faces) {
                *e = s + (up * u + down * d);
            }
            let waiting = if forwards {
                &mut entering[..width - 1]
            } else {
                &mut entering[1..]
            };
            for ((e, old), face) in waiting.iter_mut().zip(old).zip(old_face) {
                *e += face * old;
            }
            let [before, after] = self.beside(line);
            let beside = along.iter().zip(&along[1..]);
            let faces = to_above.iter().zip(to_below).zip(beside);
            let all = entering.iter_mut().zip(share.iter_mut()).zip(new_face);
            for (((e, share), new), ((up, down), (left, right))) in all.zip(faces) {
                let sum = (up + down) + (left + right);
                let inverse = if sum > 0.0 { 1.0 / sum } else { 0.0 };
                *e *= inverse;
                *share = new * inverse;
            }
            // The last one in the order lies beside the first one where the row repeats.
            let (end, around) = if forwards {
                (width - 1, along[width])
            } else {
                (0, along[0])
            };
            let sum = (to_above[end] + to_below[end]) + (along[end] + along[end + 1]);
            let around = if self.wraps && sum > 0.0 {
                around / sum
            } else {
                0.0
            };
            let line = &mut pressure[row * width..(row + 1) * width];
            if forwards {
                let mut last = before;
                for ((p, e), share) in line.iter_mut().zip(&entering).zip(&share) {
                    last = e + share * last;
                    *p = last;
                }
                line[width - 1] += around * line[0];
            } else {
                let mut last = after;
                let all = line.iter_mut().zip(&entering).zip(&share);
                for ((p, e), share) in all.rev() {
                    last = e + share * last;
                    *p = last;
                }
                line[0] += around * line[width - 1];
            }
        }
    }

    /// The same as a graph; points that nothing passes have no links.
    pub fn graph(&self) -> Graph {
        let (width, all) = (self.width, self.len());
        let mut graph = Graph::with_capacity(all, 4 * all);
        for row in 0..self.rows() {
            let [along, to_above, to_below] = self.faces(row);
            for k in 0..width {
                let point = row * width + k;
                let mut ground = 0.0;
                let mut link = |to: Option<usize>, g: f64| match to {
                    Some(to) if g > 0.0 => graph.link(to as u32, g),
                    Some(_) => {}
                    None => ground += g,
                };
                let wrapped = |to: usize| self.wraps.then_some(to);
                let after = if k + 1 < width {
                    Some(point + 1)
                } else {
                    wrapped(row * width)
                };
                let before = if k > 0 {
                    Some(point - 1)
                } else {
                    wrapped(point + width - 1)
                };
                let below = point + width;
                let above = if row > 0 { point - width } else { all + k };
                let below = if below < all { below } else { below + width };
                link(after, along[k + 1]);
                link(before, along[k]);
                link(Some(below), to_below[k]);
                link(Some(above), to_above[k]);
                graph.end_node(ground);
            }
        }
        graph
    }
}

/// The points of the row above rows `[first, end]` and of that below the last of them, where there are any.
pub(super) fn rows_beside(frame: &Frame, [first, end]: [usize; 2]) -> Vec<usize> {
    let [width, all] = frame.points;
    let above = match first {
        0 if frame.repeats => Some(all - 1),
        0 => None,
        row => Some(row - 1),
    };
    let below = match end {
        row if row < all => Some(row),
        _ if frame.repeats => Some(0),
        _ => None,
    };
    let point = |row: Option<usize>, k: usize| row.map_or(NOWHERE, |row| row * width + k);
    let above = (0..width).map(|k| point(above, k));
    above.chain((0..width).map(|k| point(below, k))).collect()
}
