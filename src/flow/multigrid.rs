//! Conjugate gradients on a graph of conductances, preconditioned by multigrid over pairs of nodes.
//!
//! Conductances go with the cube of a gap and differ by many orders. So coarse nodes are not squares of the grid: each
//! node is joined with the neighbour that it is most strongly linked to (Notay 2010, ETNA 37, 123), and two steps of
//! conjugate gradients on every other coarse graph make up for what its piecewise constant pressure lacks (the
//! K-cycle, Notay & Vassilevski 2008, doi:10.1002/nla.542; on all of them it would take several times as long).
//! Everything goes through the nodes in one order, so that the result does not depend on threads.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// No node.
const NONE: u32 = u32::MAX;
/// Most nodes of a graph that is solved directly.
const DIRECT: usize = 200;
/// A link is strong if it conducts this share of the strongest one of its node (Notay 2010).
const STRONG: f64 = 0.25;
/// Iterations whose decrease of the power stands for the error of the first of them (Hestenes & Stiefel 1952).
const DELAY: usize = 4;

/// Nodes linked by conductances. A node may be linked to the ground too, where the pressure is 0.
#[derive(Default)]
pub(super) struct Graph {
    /// Where the links of each node begin, and where those of the last end.
    start: Vec<usize>,
    to: Vec<u32>,
    conductance: Vec<f64>,
    /// Conductance to the ground of each node.
    ground: Vec<f64>,
    /// Sum of the conductances of each node.
    diagonal: Vec<f64>,
}

/// The pressure that was found.
pub(super) struct Pressure {
    /// Power that is lost.
    pub power: f64,
    /// Whether the power is known to the tolerance.
    pub converged: bool,
    /// Iterations.
    pub iterations: usize,
}

impl Graph {
    /// No nodes yet, room for so many.
    pub fn with_capacity(nodes: usize) -> Graph {
        let mut start = Vec::with_capacity(nodes + 1);
        start.push(0);
        Graph {
            start,
            ground: Vec::with_capacity(nodes),
            diagonal: Vec::with_capacity(nodes),
            ..Graph::default()
        }
    }

    /// Links the node that is being added to another one.
    pub fn link(&mut self, to: u32, conductance: f64) {
        self.to.push(to);
        self.conductance.push(conductance);
    }

    /// Ends the node that is being added.
    pub fn end_node(&mut self, ground: f64) {
        let begun = *self.start.last().unwrap_or(&0);
        let links: f64 = self.conductance[begun..].iter().sum();
        self.diagonal.push(links + ground);
        self.ground.push(ground);
        self.start.push(self.to.len());
    }

    fn len(&self) -> usize {
        self.ground.len()
    }

    /// The links of a node: the other node and the conductance.
    fn links(&self, node: usize) -> impl Iterator<Item = (usize, f64)> {
        let range = self.start[node]..self.start[node + 1];
        let to = self.to[range.clone()].iter().map(|to| *to as usize);
        to.zip(self.conductance[range].iter().copied())
    }

    /// What leaves each node under a pressure. By differences: so nothing is lost where the pressure is nearly constant.
    fn outflow(&self, pressure: &[f64], outflow: &mut [f64]) {
        for (node, out) in outflow.iter_mut().enumerate() {
            let here = pressure[node];
            let through = self.links(node).map(|(to, g)| g * (here - pressure[to]));
            *out = self.ground[node] * here + through.sum::<f64>();
        }
    }

    /// Gives a node the pressure at which nothing is left over.
    fn relax(&self, node: usize, source: &[f64], pressure: &mut [f64]) {
        if self.diagonal[node] > 0.0 {
            let entering = self.links(node).map(|(to, g)| g * pressure[to]);
            pressure[node] = (source[node] + entering.sum::<f64>()) / self.diagonal[node];
        }
    }

    /// Joins each node with the one that it is most strongly linked to: the coarse node of each.
    fn pairs(&self) -> (Vec<u32>, usize) {
        let mut coarse = vec![NONE; self.len()];
        let mut count = 0;
        for node in 0..self.len() {
            if coarse[node] != NONE {
                continue;
            }
            let strongest = |free: bool| {
                let of_kind = self
                    .links(node)
                    .filter(|(to, g)| *to != node && *g > 0.0 && (coarse[*to] == NONE) == free);
                of_kind.fold(
                    (NONE, 0.0),
                    |best, (to, g)| {
                        if g > best.1 { (to as u32, g) } else { best }
                    },
                )
            };
            let (free, taken) = (strongest(true), strongest(false));
            // A weak link to a free node is worse than a third node in a strong pair.
            if free.0 != NONE && free.1 >= STRONG * taken.1 {
                coarse[node] = count;
                coarse[free.0 as usize] = count;
                count += 1;
            } else if taken.0 != NONE {
                coarse[node] = coarse[taken.0 as usize];
            } else if self.diagonal[node] > 0.0 {
                // Only the ground, or only nodes of no conductance.
                coarse[node] = count;
                count += 1;
            }
        }
        (coarse, count as usize)
    }

    /// The graph of the coarse nodes.
    fn joined(&self, coarse: &[u32], count: usize) -> Graph {
        // Nodes by their coarse one.
        let mut first = vec![NONE; count];
        let mut next = vec![NONE; self.len()];
        for node in (0..self.len()).rev() {
            if coarse[node] != NONE {
                next[node] = first[coarse[node] as usize];
                first[coarse[node] as usize] = node as u32;
            }
        }
        let mut joined = Graph::with_capacity(count);
        // Where the link to a coarse node stands, while the links of another one are put together.
        let mut place = vec![usize::MAX; count];
        for (node, mut member) in first.into_iter().enumerate() {
            let begun = joined.to.len();
            let mut ground = 0.0;
            while member != NONE {
                ground += self.ground[member as usize];
                for (to, g) in self.links(member as usize) {
                    let to = coarse[to];
                    if to == NONE || to as usize == node {
                        continue;
                    }
                    let at = place[to as usize];
                    if at != usize::MAX && at >= begun {
                        joined.conductance[at] += g;
                    } else {
                        place[to as usize] = joined.to.len();
                        joined.link(to, g);
                    }
                }
                member = next[member as usize];
            }
            joined.end_node(ground);
        }
        joined
    }

    /// Finds the pressure that balances a `source` in every node. `power` is what a pressure loses, which ends the
    /// iteration: its relative error is at most about `tolerance`.
    pub fn solve(
        self,
        source: &[f64],
        power: impl Fn(&[f64]) -> f64,
        tolerance: f64,
        max_iterations: usize,
    ) -> Pressure {
        let nodes = self.len();
        let levels = Levels::new(self);
        let graph = &levels.graphs[0];
        let mut pressure = vec![0.0; nodes];
        let mut residual = source.to_vec();
        let mut direction = vec![0.0; nodes];
        let mut outflow = vec![0.0; nodes];
        let mut correction = vec![0.0; nodes];
        // Twice the decrease of each iteration, the last ones.
        let mut decreases = [f64::INFINITY; DELAY];
        let mut lost = power(&pressure);
        for iteration in 0..max_iterations {
            levels.correct(0, &residual, &mut correction);
            // Conjugate to the last direction, whatever the preconditioner did.
            let curvature = dot(&direction, &outflow);
            let beta = if curvature > 0.0 {
                dot(&correction, &outflow) / curvature
            } else {
                0.0
            };
            for (d, c) in direction.iter_mut().zip(&correction) {
                *d = c - beta * *d;
            }
            graph.outflow(&direction, &mut outflow);
            let slope = dot(&direction, &residual);
            let curvature = dot(&direction, &outflow);
            let is_done = slope <= 0.0 || curvature <= 0.0;
            if !is_done {
                let step = slope / curvature;
                for (p, d) in pressure.iter_mut().zip(&direction) {
                    *p += step * d;
                }
                for (r, o) in residual.iter_mut().zip(&outflow) {
                    *r -= step * o;
                }
                decreases[iteration % DELAY] = step * slope;
            }
            let error: f64 = decreases.iter().sum();
            // The power only falls: the last one known is an upper bound.
            if is_done || error <= tolerance * lost {
                lost = power(&pressure);
            }
            if is_done || error <= tolerance * lost {
                return Pressure {
                    power: lost,
                    converged: lost.is_finite(),
                    iterations: iteration + 1,
                };
            }
        }
        Pressure {
            power: power(&pressure),
            converged: false,
            iterations: max_iterations,
        }
    }
}

/// A graph and the coarser ones made from it.
struct Levels {
    graphs: Vec<Graph>,
    /// For each graph but the last, the node of the next one that each node belongs to.
    coarse: Vec<Vec<u32>>,
    /// The last graph, ready to be solved.
    direct: Option<Cholesky<f64, Dyn>>,
}

impl Levels {
    fn new(graph: Graph) -> Levels {
        let mut graphs = vec![graph];
        let mut coarse = Vec::new();
        while let Some(fine) = graphs.last()
            && fine.len() > DIRECT
        {
            let (pairs, count) = fine.pairs();
            let next = fine.joined(&pairs, count);
            coarse.push(pairs);
            let is_stuck = 10 * next.len() > 9 * fine.len();
            graphs.push(next);
            if is_stuck {
                break;
            }
        }
        let direct = graphs.last().and_then(factorise);
        Levels {
            graphs,
            coarse,
            direct,
        }
    }

    /// The correction of the pressure that a residual asks for, from level `at` on.
    fn correct(&self, at: usize, residual: &[f64], correction: &mut [f64]) {
        let graph = &self.graphs[at];
        correction.fill(0.0);
        if at + 1 == self.graphs.len()
            && let Some(direct) = &self.direct
        {
            let solved = direct.solve(&DVector::from_column_slice(residual));
            correction.copy_from_slice(solved.as_slice());
            return;
        }
        for node in 0..graph.len() {
            graph.relax(node, residual, correction);
        }
        if let Some(coarse) = self.coarse.get(at) {
            let mut left = vec![0.0; graph.len()];
            graph.outflow(correction, &mut left);
            for (l, r) in left.iter_mut().zip(residual) {
                *l = r - *l;
            }
            let mut joined = vec![0.0; self.graphs[at + 1].len()];
            for (to, l) in coarse.iter().zip(&left) {
                if *to != NONE {
                    joined[*to as usize] += l;
                }
            }
            drop(left);
            let found = self.steps(at + 1, joined);
            for (c, from) in correction.iter_mut().zip(coarse) {
                if *from != NONE {
                    *c += found[*from as usize];
                }
            }
        }
        for node in (0..graph.len()).rev() {
            graph.relax(node, residual, correction);
        }
    }

    /// Two steps of conjugate gradients on every other coarse graph, one correction on the others.
    fn steps(&self, at: usize, mut residual: Vec<f64>) -> Vec<f64> {
        let graph = &self.graphs[at];
        let mut first = vec![0.0; graph.len()];
        self.correct(at, &residual, &mut first);
        if at % 2 == 1 || at + 1 == self.graphs.len() {
            return first;
        }
        let mut first_out = vec![0.0; graph.len()];
        graph.outflow(&first, &mut first_out);
        let curvature = dot(&first, &first_out);
        if curvature <= 0.0 {
            return first;
        }
        let step = dot(&first, &residual) / curvature;
        for (r, o) in residual.iter_mut().zip(&first_out) {
            *r -= step * o;
        }
        let scaled = |first: Vec<f64>, by: f64| first.into_iter().map(|c| by * c).collect();
        let mut second = vec![0.0; graph.len()];
        self.correct(at, &residual, &mut second);
        // Conjugate to the first.
        let beta = dot(&second, &first_out) / curvature;
        for (s, f) in second.iter_mut().zip(&first) {
            *s -= beta * f;
        }
        let mut second_out = first_out;
        graph.outflow(&second, &mut second_out);
        let curvature = dot(&second, &second_out);
        if curvature <= 0.0 {
            return scaled(first, step);
        }
        let further = dot(&second, &residual) / curvature;
        let both = first.iter().zip(&second);
        both.map(|(f, s)| step * f + further * s).collect()
    }
}

/// The Cholesky factor of a small graph. In each part of it that has no ground one node is given some: a source that
/// sums to 0 over the part sends nothing through it.
fn factorise(graph: &Graph) -> Option<Cholesky<f64, Dyn>> {
    if graph.len() > DIRECT {
        return None;
    }
    let mut matrix = DMatrix::zeros(graph.len(), graph.len());
    for node in 0..graph.len() {
        matrix[(node, node)] += graph.diagonal[node];
        for (to, g) in graph.links(node) {
            matrix[(node, to)] -= g;
        }
    }
    let mut is_seen = vec![false; graph.len()];
    for node in 0..graph.len() {
        let mut has_ground = false;
        let mut waiting = vec![node];
        if is_seen[node] {
            continue;
        }
        is_seen[node] = true;
        while let Some(at) = waiting.pop() {
            has_ground |= graph.ground[at] > 0.0;
            for (to, _) in graph.links(at).filter(|(_, g)| *g > 0.0) {
                if !is_seen[to] {
                    is_seen[to] = true;
                    waiting.push(to);
                }
            }
        }
        if !has_ground {
            let diagonal = graph.diagonal[node];
            matrix[(node, node)] += if diagonal > 0.0 { diagonal } else { 1.0 };
        }
    }
    Cholesky::new(matrix)
}

fn dot(left: &[f64], right: &[f64]) -> f64 {
    left.iter().zip(right).map(|(l, r)| l * r).sum()
}
