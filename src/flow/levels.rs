//! A graph in strips on all ranks, and the coarser ones made from it.

use super::faces::Faces;
use super::graph::{Graph, NONE, Target};
use super::layout::{Halo, Layout, Passage};
use crate::backend::{BackendError, Share};

/// Most nodes of a graph of which every rank holds all, and works on it alone; no result depends on it. Tests want coarse graphs
/// on several ranks.
const FEW: usize = if cfg!(test) { 1 << 8 } else { 1 << 16 };

/// The nodes of a strip and their links.
#[derive(Debug)]
pub(super) enum Strip {
    Faces(Faces),
    Graph(Graph),
}

impl Strip {
    fn relax(&self, source: &[f64], pressure: &mut [f64], outside: &[f64], forwards: bool) {
        match self {
            Strip::Faces(faces) => faces.relax(source, pressure, outside, forwards),
            Strip::Graph(graph) => graph.relax(source, pressure, outside, forwards),
        }
    }

    /// Calls with some nodes, the first one's number and what leaves each.
    fn outflow(&self, pressure: &[f64], outside: &[f64], mut left: impl FnMut(usize, &[f64])) {
        match self {
            Strip::Faces(faces) => faces.outflow(pressure, outside, &mut Vec::new(), left),
            Strip::Graph(graph) => {
                graph.outflow(pressure, outside, |node, out| left(node, &[out]));
            }
        }
    }

    fn with_graph<R>(&self, work: impl FnOnce(&Graph) -> R) -> R {
        match self {
            Strip::Faces(faces) => work(&faces.graph()),
            Strip::Graph(graph) => work(graph),
        }
    }
}

/// A graph.
#[derive(Debug)]
pub(super) struct Level {
    pub layout: Layout,
    pub strips: Vec<Strip>,
    pub halo: Halo,
}

/// How the nodes of a graph are joined into those of a coarser one.
#[derive(Debug)]
pub(super) struct Joint {
    /// The coarse node of each node, from 0 in each strip.
    coarse: Vec<Vec<u32>>,
    /// Coarse nodes of each held strip.
    counts: Vec<usize>,
    /// From the ranks that hold the fine nodes to those that hold the coarse ones.
    pub passage: Passage,
}

impl Level {
    /// The strips held here, each with its place.
    fn held<'a, T>(&self, parts: Vec<T>, outside: Vec<Vec<f64>>) -> Vec<Held<'_, T>>
    where
        T: 'a,
    {
        let own = self.layout.own();
        let strips = own.zip(&self.strips).zip(parts).zip(outside);
        let held = strips.map(|(((number, strip), part), outside)| Held {
            number,
            strip,
            part,
            outside,
        });
        held.collect()
    }

    /// The values outside all held strips.
    pub fn outside(&self, share: &Share, vector: &[f64]) -> Result<Vec<Vec<f64>>, BackendError> {
        self.halo.outside(share, &self.layout, vector, |_| true)
    }

    /// What leaves each node.
    pub fn outflow(
        &self,
        share: &Share,
        pressure: &[f64],
        outflow: &mut [f64],
    ) -> Result<(), BackendError> {
        let outside = self.outside(share, pressure)?;
        let held = self.held(self.layout.parts(outflow), outside);
        self.layout.for_each(held, |held| {
            let pressure = &pressure[self.layout.place(held.number)];
            held.strip.outflow(pressure, &held.outside, |first, out| {
                held.part[first..first + out.len()].copy_from_slice(out);
            });
        });
        Ok(())
    }

    /// One step of Gauss and Seidel, colour by colour; backwards it is the transpose of that forwards.
    pub fn relax(
        &self,
        share: &Share,
        source: &[f64],
        pressure: &mut [f64],
        forwards: bool,
    ) -> Result<(), BackendError> {
        let colours = self.layout.colours();
        for turn in 0..colours {
            let colour = if forwards { turn } else { colours - 1 - turn };
            let is_of = |strip: usize| self.layout.colour(strip) == colour;
            let outside = self.halo.outside(share, &self.layout, pressure, is_of)?;
            let mut held = self.held(self.layout.parts(pressure), outside);
            held.retain(|held| is_of(held.number));
            self.layout.for_each(held, |held| {
                let source = &source[self.layout.place(held.number)];
                held.strip.relax(source, held.part, &held.outside, forwards);
            });
        }
        Ok(())
    }

    /// What a pressure leaves of a source, summed over the nodes of each coarse one.
    pub fn restrict(
        &self,
        share: &Share,
        joint: &Joint,
        source: &[f64],
        pressure: &[f64],
    ) -> Result<Vec<f64>, BackendError> {
        let outside = self.outside(share, pressure)?;
        let mut joined = vec![0.0; joint.counts.iter().sum()];
        let parts = parts_of(&joint.counts, &mut joined);
        let parts = parts.into_iter().zip(&joint.coarse).collect();
        let held = self.held(parts, outside);
        self.layout.for_each(held, |held| {
            let (part, coarse) = held.part;
            let place = self.layout.place(held.number);
            let (source, pressure) = (&source[place.clone()], &pressure[place]);
            held.strip.outflow(pressure, &held.outside, |first, out| {
                let nodes = coarse[first..].iter().zip(&source[first..]).zip(out);
                for ((to, source), out) in nodes {
                    if *to != NONE {
                        part[*to as usize] += source - out;
                    }
                }
            });
        });
        Ok(joined)
    }

    /// Adds the value of the coarse node to each.
    pub fn prolong(&self, joint: &Joint, found: &[f64], pressure: &mut [f64]) {
        let mut found = found;
        let founds = joint.counts.iter().map(|count| {
            let (part, rest) = found.split_at(*count);
            found = rest;
            part
        });
        let parts = self.layout.parts(pressure).into_iter();
        let all = parts.zip(founds).zip(&joint.coarse).collect();
        self.layout.for_each(all, |((pressure, found), coarse)| {
            for (p, from) in pressure.iter_mut().zip(coarse) {
                if *from != NONE {
                    *p += found[*from as usize];
                }
            }
        });
    }

    /// A coarser graph: some four nodes are joined, and strips by twos.
    ///
    /// # Errors
    /// A rank has ended.
    pub fn joined(&self, share: &Share) -> Result<(Joint, Level), BackendError> {
        let first = self.layout.own().start;
        let fours = self
            .layout
            .find(|strip| self.strips[strip - first].with_graph(Graph::fours));
        let (coarse, counts): (Vec<Vec<u32>>, Vec<usize>) = fours.into_iter().unzip();
        let own: Vec<f64> = counts.iter().map(|count| *count as f64).collect();
        let all = self.layout.all_strips(share, own)?;
        let all: Vec<usize> = all.into_iter().map(|count| count as usize).collect();
        let layout = self.layout.joined(share, &all, FEW);
        // The first coarse node of each strip, and of each rank.
        let mut firsts = vec![0];
        firsts.extend(all.iter().scan(0, |sum, count| {
            *sum += count;
            Some(*sum)
        }));
        let from = self.layout.bounds_by(&firsts);
        let passage = Passage::new(from, layout.bounds());

        // The coarse node of each node in the numbers of all ranks from 1 on, which are far below 2^53. A node without a
        // coarse one has -1, the ground outside 0.
        let numbers = self.layout.find(|strip| {
            let number = |to: &u32| match *to {
                NONE => -1.0,
                to => (firsts[strip] + to as usize + 1) as f64,
            };
            coarse[strip - first]
                .iter()
                .map(number)
                .collect::<Vec<f64>>()
        });
        let outside = self.outside(share, &numbers.concat())?;
        drop(numbers);
        let rows = self.layout.find(|strip| {
            let place = strip - first;
            let coarse = &coarse[place];
            let target = |to: usize| match coarse.get(to) {
                Some(&NONE) => Target::Nothing,
                Some(to) => Target::Node(firsts[strip] + *to as usize),
                None => match outside[place][to - coarse.len()] {
                    ..0.0 => Target::Nothing,
                    0.0 => Target::Ground,
                    to => Target::Node(to as usize - 1),
                },
            };
            let mut rows = Rows::default();
            self.strips[place].with_graph(|graph| {
                graph.for_each_joined(coarse, counts[place], target, |links, ground| {
                    rows.push(links, ground);
                });
            });
            rows
        });
        let joint = Joint {
            coarse,
            counts,
            passage,
        };
        drop(outside);
        let rows = Rows::concat(rows).handed(share, &joint.passage)?;
        Ok((joint, rows.level(share, layout)?))
    }
}

/// A strip and something of it.
struct Held<'a, T> {
    number: usize,
    strip: &'a Strip,
    part: T,
    outside: Vec<f64>,
}

/// Consecutive parts of so many numbers.
fn parts_of<'a, T>(counts: &[usize], mut all: &'a mut [T]) -> Vec<&'a mut [T]> {
    let parts = counts.iter().map(|count| {
        let (part, rest) = std::mem::take(&mut all).split_at_mut(*count);
        all = rest;
        part
    });
    parts.collect()
}

/// Nodes one after another with their links to nodes in the numbers of all ranks.
#[derive(Debug, Default)]
struct Rows {
    /// Number of links of each node.
    degrees: Vec<f64>,
    ground: Vec<f64>,
    /// The node that each link leads to.
    to: Vec<f64>,
    conductance: Vec<f64>,
}

impl Rows {
    fn push(&mut self, links: &[(usize, f64)], ground: f64) {
        self.degrees.push(links.len() as f64);
        self.ground.push(ground);
        self.to.extend(links.iter().map(|(to, _)| *to as f64));
        self.conductance.extend(links.iter().map(|(_, g)| g));
    }

    /// Those of all strips, one after another.
    fn concat(strips: Vec<Rows>) -> Rows {
        let mut all = Rows::default();
        let [nodes, links] = [
            strips.iter().map(|rows| rows.ground.len()).sum(),
            strips.iter().map(|rows| rows.to.len()).sum(),
        ];
        all.degrees.reserve_exact(nodes);
        all.ground.reserve_exact(nodes);
        all.to.reserve_exact(links);
        all.conductance.reserve_exact(links);
        for rows in strips {
            all.degrees.extend(rows.degrees);
            all.ground.extend(rows.ground);
            all.to.extend(rows.to);
            all.conductance.extend(rows.conductance);
        }
        all
    }

    /// Hands them to the ranks that hold them from now on.
    fn handed(self, share: &Share, passage: &Passage) -> Result<Rows, BackendError> {
        if passage.stays() {
            return Ok(self);
        }
        let bounds = |links: usize| -> Result<Vec<usize>, BackendError> {
            let all = share.numbers(&[links as f64], (0..share.count()).map(|_| 1))?;
            let ends = all.iter().scan(0, |sum, links| {
                *sum += *links as usize;
                Some(*sum)
            });
            Ok(std::iter::once(0).chain(ends).collect())
        };
        let from = bounds(self.to.len())?;
        let degrees = passage.down(share, self.degrees)?;
        let ground = passage.down(share, self.ground)?;
        let here: usize = degrees.iter().map(|degree| *degree as usize).sum();
        let to = bounds(here)?;
        let links = Passage::new(Some(from), passage.is_divided().then_some(to));
        Ok(Rows {
            degrees,
            ground,
            to: links.down(share, self.to)?,
            conductance: links.down(share, self.conductance)?,
        })
    }

    /// The graph of a layout.
    fn level(self, share: &Share, layout: Layout) -> Result<Level, BackendError> {
        let mut link = 0;
        let links: Vec<usize> = layout
            .own()
            .map(|strip| {
                let begun = link;
                let degrees = &self.degrees[layout.place(strip)];
                link += degrees.iter().map(|degree| *degree as usize).sum::<usize>();
                begun
            })
            .collect();
        let first = layout.own().start;
        let strips = layout.find(|strip| {
            let (nodes, place) = (layout.nodes_of(strip), layout.place(strip));
            let degrees = &self.degrees[place.clone()];
            let all: usize = degrees.iter().map(|degree| *degree as usize).sum();
            let begun = links[strip - first];
            let to = &self.to[begun..begun + all];
            let mut outside: Vec<usize> = to.iter().map(|to| *to as usize).collect();
            outside.retain(|to| !nodes.contains(to));
            outside.sort_unstable();
            outside.dedup();
            let mut graph = Graph::with_capacity(nodes.len(), all);
            let mut links = to.iter().zip(&self.conductance[begun..begun + all]);
            for (degree, ground) in degrees.iter().zip(&self.ground[place]) {
                for (to, g) in links.by_ref().take(*degree as usize) {
                    let to = *to as usize;
                    let here = if nodes.contains(&to) {
                        to - nodes.start
                    } else {
                        nodes.len() + outside.partition_point(|other| *other < to)
                    };
                    graph.link(here as u32, *g);
                }
                graph.end_node(*ground);
            }
            (Strip::Graph(graph), outside)
        });
        drop(self);
        let (strips, outside) = strips.into_iter().unzip();
        let halo = Halo::new(share, &layout, outside)?;
        Ok(Level {
            layout,
            strips,
            halo,
        })
    }
}
