//! The nodes of one strip, the conductances that link them with one another and with nodes outside, and their pairs.

/// No node.
pub(super) const NONE: u32 = u32::MAX;
/// A link is strong if it conducts this share of the strongest one of its node (Notay 2010).
const STRONG: f64 = 0.25;

/// A link is too weak to join a node by if all links of this node conduct more than so many times as much: relaxing the
/// nodes one by one would not level out the difference between the two (Notay 2010).
const WEAKEST: f64 = 6.0;

/// Nodes linked by conductances. A node may be linked to the ground too, where the pressure is 0.
#[derive(Debug)]
pub(super) struct Graph {
    /// Where the links of each node begin, and where those of the last end.
    start: Vec<u32>,
    /// Nodes of this strip, and from their number on the nodes outside.
    to: Vec<u32>,
    conductance: Vec<f64>,
    /// Conductance to the ground of each node.
    ground: Vec<f64>,
    /// Sum of the conductances of each node.
    diagonal: Vec<f64>,
}

impl Graph {
    /// No nodes yet, room for so many and for their links.
    pub fn with_capacity(nodes: usize, links: usize) -> Graph {
        let mut start = Vec::with_capacity(nodes + 1);
        start.push(0);
        Graph {
            start,
            to: Vec::with_capacity(links),
            conductance: Vec::with_capacity(links),
            ground: Vec::with_capacity(nodes),
            diagonal: Vec::with_capacity(nodes),
        }
    }

    /// Links the node that is being added to another one.
    pub fn link(&mut self, to: u32, conductance: f64) {
        self.to.push(to);
        self.conductance.push(conductance);
    }

    /// Ends the node that is being added.
    pub fn end_node(&mut self, ground: f64) {
        let begun = *self.start.last().unwrap_or(&0) as usize;
        let links: f64 = self.conductance[begun..].iter().sum();
        self.diagonal.push(links + ground);
        self.ground.push(ground);
        self.start.push(self.to.len() as u32);
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.ground.len()
    }

    /// Conductance from a node to the ground.
    pub fn ground(&self, node: usize) -> f64 {
        self.ground[node]
    }

    /// Sum of the conductances of a node.
    pub fn diagonal(&self, node: usize) -> f64 {
        self.diagonal[node]
    }

    /// The links of a node: the other node and the conductance.
    pub fn links(&self, node: usize) -> impl Iterator<Item = (usize, f64)> {
        let range = self.start[node] as usize..self.start[node + 1] as usize;
        let to = self.to[range.clone()].iter().map(|to| *to as usize);
        to.zip(self.conductance[range].iter().copied())
    }

    /// What leaves each node under a pressure here and outside: `left` takes node and outflow. By differences: so nothing is lost
    /// where the pressure is nearly constant.
    pub fn outflow(&self, pressure: &[f64], outside: &[f64], mut left: impl FnMut(usize, f64)) {
        for (node, here) in pressure.iter().enumerate() {
            let through = self.links(node).map(|(to, g)| {
                let there = *pressure
                    .get(to)
                    .unwrap_or_else(|| &outside[to - pressure.len()]);
                g * (here - there)
            });
            left(node, self.ground[node] * here + through.sum::<f64>());
        }
    }

    /// Gives each node in turn, forwards or backwards, the pressure at which nothing is left over.
    pub fn relax(&self, source: &[f64], pressure: &mut [f64], outside: &[f64], forwards: bool) {
        let mut relax = |node: usize| {
            if self.diagonal[node] > 0.0 {
                let entering = self.links(node).map(|(to, g)| {
                    let there = *pressure
                        .get(to)
                        .unwrap_or_else(|| &outside[to - pressure.len()]);
                    g * there
                });
                pressure[node] = (source[node] + entering.sum::<f64>()) / self.diagonal[node];
            }
        };
        if forwards {
            (0..self.len()).for_each(&mut relax);
        } else {
            (0..self.len()).rev().for_each(&mut relax);
        }
    }

    /// Joins each node with the one of this strip that it is most strongly linked to, and these pairs once more: the
    /// coarse node of each, and their number.
    pub fn fours(&self) -> (Vec<u32>, usize) {
        let (mut fours, count) = self.pairs(&self.diagonal);
        let mut weights = vec![0.0; count];
        for (pair, diagonal) in fours.iter().zip(&self.diagonal) {
            if *pair != NONE {
                weights[*pair as usize] += diagonal;
            }
        }
        let (twos, count) = self.joined(&fours, count).pairs(&weights);
        for coarse in fours.iter_mut().filter(|coarse| **coarse != NONE) {
            *coarse = twos[*coarse as usize];
        }
        (fours, count)
    }

    /// Joins each node with the one that it is most strongly linked to: the coarse node of each. `weights` are the sums of
    /// the conductances of each node, before any were joined into it.
    fn pairs(&self, weights: &[f64]) -> (Vec<u32>, usize) {
        let mut coarse = vec![NONE; self.len()];
        let mut count = 0;
        for node in 0..self.len() {
            if coarse[node] != NONE {
                continue;
            }
            let (mut free, mut taken) = ((NONE, 0.0), (NONE, 0.0));
            for (to, g) in self.links(node) {
                if to >= self.len() || to == node {
                    continue;
                }
                let is_free = coarse[to] == NONE;
                // Where one of a pair depends on the other, that is enough. A node that comes to a pair has to depend on
                // it: or a light node would join two heavy ones.
                let (least, best) = if is_free {
                    (weights[node].min(weights[to]), &mut free)
                } else {
                    (weights[node], &mut taken)
                };
                if WEAKEST * g >= least && g > best.1 {
                    *best = (to as u32, g);
                }
            }
            // A weak link to a free node is worse than a third node in a strong pair.
            if free.0 != NONE && free.1 >= STRONG * taken.1 {
                coarse[node] = count;
                coarse[free.0 as usize] = count;
                count += 1;
            } else if taken.0 != NONE {
                coarse[node] = coarse[taken.0 as usize];
            } else if self.diagonal[node] > 0.0 {
                // Only the ground, only nodes outside, or only nodes of no conductance.
                coarse[node] = count;
                count += 1;
            }
        }
        (coarse, count as usize)
    }

    /// The graph of the coarse nodes of this strip; the nodes outside count as ground.
    fn joined(&self, coarse: &[u32], count: usize) -> Graph {
        let mut joined = Graph::with_capacity(count, self.to.len() / 2);
        let target = |to: usize| match coarse.get(to) {
            Some(to) if *to != NONE => Target::Node(*to as usize),
            Some(_) => Target::Nothing,
            None => Target::Ground,
        };
        self.for_each_joined(coarse, count, target, |links, ground| {
            for (to, g) in links {
                joined.link(*to as u32, *g);
            }
            joined.end_node(ground);
        });
        joined
    }

    /// Calls with the links and the ground of each coarse node of this strip, in their order. `target` says where a
    /// link to a node of this graph leads among the coarse ones.
    pub fn for_each_joined(
        &self,
        coarse: &[u32],
        count: usize,
        target: impl Fn(usize) -> Target,
        mut call: impl FnMut(&[(usize, f64)], f64),
    ) {
        // Nodes by their coarse one.
        let mut first = vec![NONE; count];
        let mut next = vec![NONE; self.len()];
        for node in (0..self.len()).rev() {
            if coarse[node] != NONE {
                next[node] = first[coarse[node] as usize];
                first[coarse[node] as usize] = node as u32;
            }
        }
        let mut links: Vec<(usize, f64)> = Vec::new();
        for mut member in first {
            let mut ground = 0.0;
            links.clear();
            let joined = coarse.get(member as usize);
            while member != NONE {
                ground += self.ground[member as usize];
                for (to, g) in self.links(member as usize) {
                    if coarse.get(to) == joined {
                        continue;
                    }
                    match target(to) {
                        Target::Nothing => {}
                        Target::Ground => ground += g,
                        Target::Node(to) => {
                            match links.iter_mut().find(|(known, _)| *known == to) {
                                Some((_, sum)) => *sum += g,
                                None => links.push((to, g)),
                            }
                        }
                    }
                }
                member = next[member as usize];
            }
            call(&links, ground);
        }
    }
}

/// Where a link leads among coarse nodes.
#[derive(Clone, Copy, Debug)]
pub(super) enum Target {
    /// To this one.
    Node(usize),
    /// To where the pressure is 0.
    Ground,
    /// To a node without a coarse one.
    Nothing,
}
