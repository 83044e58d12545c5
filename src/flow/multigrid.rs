//! Conjugate gradients on a graph of conductances, preconditioned by multigrid over nodes joined by fours.
//!
//! Conductances go with the cube of a gap and differ by many orders. So coarse nodes are not squares of the grid: each
//! node is joined with the neighbour that it is most strongly linked to, and the pairs again (Notay 2010, ETNA 37, 123),
//! and two steps of conjugate gradients on every coarse graph make up for what its piecewise constant pressure lacks (the
//! K-cycle, Notay & Vassilevski 2008, doi:10.1002/nla.542).
//!
//! A node is joined within its strip of rows only. Strips of one colour are relaxed at once and their nodes in order,
//! so that the result depends neither on threads nor on ranks.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use rayon::prelude::*;

use super::graph::Graph;
use super::levels::{Joint, Level, Strip};
use crate::backend::{BackendError, Share};

/// Most nodes of a graph that is solved directly.
const DIRECT: usize = 200;
/// Two steps are made on a graph of fewer nodes than this share of the last graph of two steps: all graphs together cost
/// some times the finest.
const SMALLER: f64 = 0.4;
/// Numbers of a vector that a thread takes at once.
const AT_ONCE: usize = 1 << 13;
/// Iterations whose decrease of the power stands for the error of the first of them (Hestenes & Stiefel 1952).
const DELAY: usize = 4;

/// The pressure that was found.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pressure {
    /// Power that is lost.
    pub power: f64,
    /// Whether the power is known to the tolerance.
    pub converged: bool,
    /// Iterations.
    pub iterations: usize,
}

/// Solves for the pressure under which `source` leaves a graph. `power` is what is lost under a pressure. `watch` sees each iteration
/// with the relative error of the power, and says whether to go on.
///
/// # Errors
/// A rank has ended.
pub(super) fn solve(
    share: &Share,
    graph: Level,
    source: Vec<f64>,
    power: impl Fn(&Level, &[f64]) -> Result<f64, BackendError>,
    tolerance: f64,
    max_iterations: usize,
    watch: &mut dyn FnMut(usize, f64) -> bool,
) -> Result<Pressure, BackendError> {
    let levels = Levels::new(share, graph)?;
    let graph = &levels.graphs[0];
    let layout = &graph.layout;
    let nodes = layout.own_nodes().len();
    let mut residual = source;
    let mut pressure = vec![0.0; nodes];
    let mut direction = vec![0.0; nodes];
    let mut outflow = vec![0.0; nodes];
    // Of the last direction.
    let mut curvature = 0.0;
    // Twice the decrease of each iteration, the last ones.
    let mut decreases = [f64::INFINITY; DELAY];
    let mut lost = power(graph, &pressure)?;
    let mut iterations = 0;
    for iteration in 0..max_iterations {
        let correction = levels.correct(0, &residual)?;
        // Conjugate to the last direction, whatever the preconditioner did.
        let beta = if curvature > 0.0 {
            layout.dot(share, &correction, &outflow)? / curvature
        } else {
            0.0
        };
        each(&mut direction, &correction, |d, c| c - beta * d);
        drop(correction);
        graph.outflow(share, &direction, &mut outflow)?;
        let slope = layout.dot(share, &direction, &residual)?;
        curvature = layout.dot(share, &direction, &outflow)?;
        let is_done = slope <= 0.0 || curvature <= 0.0;
        if !is_done {
            let step = slope / curvature;
            each(&mut pressure, &direction, |p, d| p + step * d);
            each(&mut residual, &outflow, |r, o| r - step * o);
            decreases[iteration % DELAY] = step * slope;
        }
        let error: f64 = decreases.iter().sum();
        // The power only falls: the last one known is an upper bound.
        if is_done || error <= tolerance * lost {
            lost = power(graph, &pressure)?;
        }
        if is_done || error <= tolerance * lost {
            return Ok(Pressure {
                power: lost,
                converged: lost.is_finite(),
                iterations: iteration + 1,
            });
        }
        iterations = iteration + 1;
        if !watch(iterations, error / lost) {
            break;
        }
    }
    Ok(Pressure {
        power: power(graph, &pressure)?,
        converged: false,
        iterations,
    })
}

/// Changes each number of a vector by that of another one.
fn each(vector: &mut [f64], by: &[f64], changed: impl Fn(f64, f64) -> f64 + Sync) {
    let work = |(vector, by): (&mut [f64], &[f64])| {
        for (value, by) in vector.iter_mut().zip(by) {
            *value = changed(*value, *by);
        }
    };
    if vector.len() <= AT_ONCE {
        work((vector, by));
    } else {
        let parts = vector.par_chunks_mut(AT_ONCE);
        parts.zip(by.par_chunks(AT_ONCE)).for_each(work);
    }
}

/// A graph and the coarser ones made from it.
struct Levels<'a> {
    share: &'a Share,
    graphs: Vec<Level>,
    /// Whether two steps are made on each graph.
    twice: Vec<bool>,
    joints: Vec<Joint>,
    /// The last graph, ready to be solved.
    direct: Option<Cholesky<f64, Dyn>>,
}

impl<'a> Levels<'a> {
    fn new(share: &'a Share, graph: Level) -> Result<Levels<'a>, BackendError> {
        let mut graphs = vec![graph];
        let mut joints = Vec::new();
        // The finest graph lies on all ranks even if it is small.
        while let Some(fine) = graphs.last()
            && (joints.is_empty() || fine.layout.nodes() > DIRECT)
        {
            let (joint, next) = fine.joined(share)?;
            let is_stuck =
                fine.layout.strips() == 1 && 10 * next.layout.nodes() > 9 * fine.layout.nodes();
            joints.push(joint);
            graphs.push(next);
            if is_stuck {
                break;
            }
        }
        let direct = graphs.last().and_then(factorise);
        let mut last = graphs[0].layout.nodes();
        let twice = graphs.iter().map(|graph| {
            let nodes = graph.layout.nodes();
            let is_twice = (nodes as f64) < SMALLER * last as f64;
            if is_twice {
                last = nodes;
            }
            is_twice
        });
        let twice = twice.collect();
        Ok(Levels {
            share,
            twice,
            graphs,
            joints,
            direct,
        })
    }

    /// The correction of the pressure that a residual asks for, from level `at` on.
    fn correct(&self, at: usize, residual: &[f64]) -> Result<Vec<f64>, BackendError> {
        let (share, graph) = (self.share, &self.graphs[at]);
        if at + 1 == self.graphs.len()
            && let Some(direct) = &self.direct
        {
            let solved = direct.solve(&DVector::from_column_slice(residual));
            return Ok(solved.data.into());
        }
        let mut correction = vec![0.0; residual.len()];
        graph.relax(share, residual, &mut correction, true)?;
        if let Some(joint) = self.joints.get(at) {
            let left = graph.restrict(share, joint, residual, &correction)?;
            let left = joint.passage.down(share, left)?;
            let found = self.steps(at + 1, left)?;
            let found = joint.passage.up(share, found)?;
            graph.prolong(joint, &found, &mut correction);
        }
        graph.relax(share, residual, &mut correction, false)?;
        Ok(correction)
    }

    /// Two steps of conjugate gradients.
    fn steps(&self, at: usize, mut residual: Vec<f64>) -> Result<Vec<f64>, BackendError> {
        let (share, graph) = (self.share, &self.graphs[at]);
        let layout = &graph.layout;
        let mut first = self.correct(at, &residual)?;
        if at + 1 == self.graphs.len() || !self.twice[at] {
            return Ok(first);
        }
        let mut first_out = vec![0.0; first.len()];
        graph.outflow(share, &first, &mut first_out)?;
        let curvature = layout.dot(share, &first, &first_out)?;
        if curvature <= 0.0 {
            return Ok(first);
        }
        let step = layout.dot(share, &first, &residual)? / curvature;
        each(&mut residual, &first_out, |r, o| r - step * o);
        let mut second = self.correct(at, &residual)?;
        // Conjugate to the first.
        let beta = layout.dot(share, &second, &first_out)? / curvature;
        each(&mut second, &first, |s, f| s - beta * f);
        let mut second_out = first_out;
        graph.outflow(share, &second, &mut second_out)?;
        let curvature = layout.dot(share, &second, &second_out)?;
        if curvature <= 0.0 {
            first.iter_mut().for_each(|f| *f *= step);
            return Ok(first);
        }
        let further = layout.dot(share, &second, &residual)? / curvature;
        each(&mut first, &second, |f, s| step * f + further * s);
        Ok(first)
    }
}

/// The Cholesky factor of a small graph that this process holds whole. In each part of it that has no ground one node is
/// given some: a source that sums to 0 over the part sends nothing through it.
fn factorise(level: &Level) -> Option<Cholesky<f64, Dyn>> {
    let nodes = level.layout.nodes();
    if nodes > DIRECT || !level.layout.is_whole() {
        return None;
    }
    let graphs: Vec<&Graph> = level
        .strips
        .iter()
        .filter_map(|strip| match strip {
            Strip::Graph(graph) => Some(graph),
            Strip::Faces(_) => None,
        })
        .collect();
    let mut matrix = DMatrix::zeros(nodes, nodes);
    let mut links: Vec<Vec<usize>> = vec![Vec::new(); nodes];
    let mut ground = vec![0.0; nodes];
    for (strip, graph) in graphs.iter().enumerate() {
        let place = level.layout.place(strip);
        for node in 0..graph.len() {
            let here = place.start + node;
            matrix[(here, here)] += graph.diagonal(node);
            ground[here] = graph.ground(node);
            for (to, g) in graph.links(node) {
                let to = match to.checked_sub(graph.len()) {
                    None => place.start + to,
                    Some(outside) => level.halo.place(strip, outside),
                };
                matrix[(here, to)] -= g;
                links[here].push(to);
            }
        }
    }
    let mut is_seen = vec![false; nodes];
    for node in 0..nodes {
        if is_seen[node] {
            continue;
        }
        let mut has_ground = false;
        let mut waiting = vec![node];
        is_seen[node] = true;
        while let Some(at) = waiting.pop() {
            has_ground |= ground[at] > 0.0;
            for to in &links[at] {
                if !is_seen[*to] {
                    is_seen[*to] = true;
                    waiting.push(*to);
                }
            }
        }
        if !has_ground {
            let diagonal = matrix[(node, node)];
            matrix[(node, node)] += if diagonal > 0.0 { diagonal } else { 1.0 };
        }
    }
    Cholesky::new(matrix)
}
