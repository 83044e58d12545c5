//! The nodes of a graph in strips, which of them this process holds, and what it needs of others.
//!
//! The strips follow from the grid alone. A sum is taken strip by strip, in their order; so it is the same on any number
//! of threads and ranks.

use std::ops::Range;

use rayon::prelude::*;

use crate::backend::{BackendError, Share};

/// Nodes below which a graph is worked on by one thread.
const FEW: usize = 1 << 12;
/// Where a link leads nowhere: the pressure there is 0.
pub(super) const NOWHERE: usize = usize::MAX;

/// The nodes of a graph, numbered strip after strip, and the strips of each rank.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    /// The first node of each strip, and the number of nodes.
    starts: Vec<usize>,
    /// The first strip of each rank, and the number of strips; `None` if every rank holds all strips.
    ranks: Option<Vec<usize>>,
    /// The strips held here.
    own: Range<usize>,
    /// Whether the last strip lies beside the first.
    is_ring: bool,
}

impl Layout {
    /// Strips of the rows of a share, of which each strip but the last has so many.
    pub fn of_rows(share: &Share, rows: usize, is_ring: bool) -> Layout {
        let [width, all] = share.shape().points;
        let strips = all.div_ceil(rows);
        let starts = (0..=strips).map(|strip| (strip * rows).min(all) * width);
        let first = |rank: usize| share.rows_of(rank).start.div_ceil(rows);
        let ranks = (!share.is_whole()).then(|| {
            let firsts = (0..share.count()).map(first);
            firsts.chain([strips]).collect::<Vec<_>>()
        });
        Layout {
            starts: starts.collect(),
            own: own_strips(share, ranks.as_deref(), strips),
            ranks,
            is_ring,
        }
    }

    /// A layout of so many nodes a strip of this one, of which each two strips are joined, over the same ranks; on
    /// every rank whole if it has at most `few` nodes.
    pub fn joined(&self, share: &Share, counts: &[usize], few: usize) -> Layout {
        let strips = self.strips().div_ceil(2);
        let ends = (0..=strips).map(|strip| (2 * strip).min(self.strips()));
        let mut first = 0;
        let mut firsts: Vec<usize> = vec![0];
        firsts.extend(counts.iter().map(|count| {
            first += count;
            first
        }));
        let starts: Vec<usize> = ends.map(|strip| firsts[strip]).collect();
        let is_small = first <= few;
        let ranks = self.ranks.as_ref().filter(|_| !is_small);
        let ranks: Option<Vec<usize>> =
            ranks.map(|firsts| firsts.iter().map(|first| first.div_ceil(2)).collect());
        Layout {
            starts,
            own: own_strips(share, ranks.as_deref(), strips),
            ranks,
            is_ring: self.is_ring,
        }
    }

    /// Number of nodes of all ranks.
    pub fn nodes(&self) -> usize {
        self.starts[self.strips()]
    }

    /// Number of strips of all ranks.
    pub fn strips(&self) -> usize {
        self.starts.len() - 1
    }

    /// The strips held here.
    pub fn own(&self) -> Range<usize> {
        self.own.clone()
    }

    /// The nodes held here.
    pub fn own_nodes(&self) -> Range<usize> {
        self.starts[self.own.start]..self.starts[self.own.end]
    }

    /// Whether this process holds all nodes.
    pub fn is_whole(&self) -> bool {
        self.ranks.is_none()
    }

    /// The nodes of a strip.
    pub fn nodes_of(&self, strip: usize) -> Range<usize> {
        self.starts[strip]..self.starts[strip + 1]
    }

    /// The first node of each rank, and the number of nodes; `None` if every rank holds all of them.
    pub fn bounds(&self) -> Option<Vec<usize>> {
        self.bounds_by(&self.starts)
    }

    /// The same of other nodes, of which each strip begins with such a one.
    pub fn bounds_by(&self, firsts: &[usize]) -> Option<Vec<usize>> {
        let ranks = self.ranks.as_ref()?;
        Some(ranks.iter().map(|strip| firsts[*strip]).collect())
    }

    /// Colours of the strips: two beside each other have different ones, if there are two.
    pub fn colours(&self) -> usize {
        match self.strips() {
            1 => 1,
            strips if self.is_ring && strips % 2 == 1 => 3,
            _ => 2,
        }
    }

    /// The colour of a strip.
    pub fn colour(&self, strip: usize) -> usize {
        if self.colours() == 3 && strip + 1 == self.strips() {
            2
        } else {
            strip % 2
        }
    }

    /// Works on something of each held strip, on all threads where it pays.
    pub fn for_each<T: Send>(&self, of_strips: Vec<T>, work: impl Fn(T) + Sync) {
        if self.own_nodes().len() < FEW {
            of_strips.into_iter().for_each(work);
        } else {
            of_strips.into_par_iter().for_each(&work);
        }
    }

    /// Finds something of each held strip.
    pub fn find<R: Send>(&self, of_strip: impl Fn(usize) -> R + Sync) -> Vec<R> {
        if self.own_nodes().len() < FEW {
            self.own().map(of_strip).collect()
        } else {
            self.own().into_par_iter().map(&of_strip).collect()
        }
    }

    /// The part of each held strip.
    pub fn parts<'a, T>(&self, mut all: &'a mut [T]) -> Vec<&'a mut [T]> {
        let lengths = self.own().map(|strip| self.nodes_of(strip).len());
        let parts = lengths.map(|length| {
            let (part, rest) = std::mem::take(&mut all).split_at_mut(length);
            all = rest;
            part
        });
        parts.collect()
    }

    /// Where the nodes of a strip lie in a vector of the held ones.
    pub fn place(&self, strip: usize) -> Range<usize> {
        let nodes = self.nodes_of(strip);
        let first = self.starts[self.own.start];
        nodes.start - first..nodes.end - first
    }

    /// One number for each strip of all ranks, from those of the held ones.
    ///
    /// # Errors
    /// A rank has ended.
    pub fn all_strips(&self, share: &Share, own: Vec<f64>) -> Result<Vec<f64>, BackendError> {
        match &self.ranks {
            None => Ok(own),
            Some(ranks) => share.numbers(&own, ranks.windows(2).map(|ends| ends[1] - ends[0])),
        }
    }

    /// The sum of one number a strip, in the order of the strips.
    ///
    /// # Errors
    /// A rank has ended.
    pub fn sum(&self, share: &Share, own: Vec<f64>) -> Result<f64, BackendError> {
        Ok(self.all_strips(share, own)?.iter().sum())
    }

    /// The sum of the products of two vectors.
    ///
    /// # Errors
    /// A rank has ended.
    pub fn dot(&self, share: &Share, left: &[f64], right: &[f64]) -> Result<f64, BackendError> {
        let sums = self.find(|strip| {
            let place = self.place(strip);
            dot(&left[place.clone()], &right[place])
        });
        self.sum(share, sums)
    }
}

/// The strips of this process.
fn own_strips(share: &Share, ranks: Option<&[usize]>, strips: usize) -> Range<usize> {
    match ranks {
        None => 0..strips,
        Some(ranks) => ranks[share.rank()]..ranks[share.rank() + 1],
    }
}

/// In four sums, whose additions do not wait for one another.
fn dot(left: &[f64], right: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (fours, rests) = (left.chunks_exact(4), left.len() / 4 * 4);
    for (l, r) in fours.zip(right.chunks_exact(4)) {
        for k in 0..4 {
            sums[k] += l[k] * r[k];
        }
    }
    let rest = left[rests..].iter().zip(&right[rests..]);
    let rest: f64 = rest.map(|(l, r)| l * r).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

/// Nodes outside each held strip to which its nodes are linked, and how their values get here.
#[derive(Debug, Default)]
pub(super) struct Halo {
    /// For each held strip the places of these nodes among the held ones, and after those among the received ones.
    places: Vec<Vec<usize>>,
    /// Held nodes whose values go to other ranks, one rank after another.
    sent: Vec<usize>,
    sent_lengths: Vec<usize>,
    received_lengths: Vec<usize>,
}

impl Halo {
    /// That of the nodes outside each held strip, in the numbers of all ranks.
    ///
    /// # Errors
    /// A rank has ended.
    pub fn new(
        share: &Share,
        layout: &Layout,
        mut outside: Vec<Vec<usize>>,
    ) -> Result<Halo, BackendError> {
        let own = layout.own_nodes();
        let mut halo = Halo::default();
        let mut wanted = Vec::new();
        if let Some(bounds) = layout.bounds() {
            let of_others = outside.iter().flatten().copied();
            wanted.extend(of_others.filter(|node| *node != NOWHERE && !own.contains(node)));
            wanted.sort_unstable();
            wanted.dedup();
            let from = |rank: usize| {
                let ends = [bounds[rank], bounds[rank + 1]];
                let [first, last] = ends.map(|end| wanted.partition_point(|node| *node < end));
                last - first
            };
            let ranks = share.count();
            halo.received_lengths = (0..ranks).map(from).collect();
            let lengths: Vec<f64> = halo.received_lengths.iter().map(|l| *l as f64).collect();
            let all = share.numbers(&lengths, (0..ranks).map(|_| ranks))?;
            halo.sent_lengths = (0..ranks)
                .map(|rank| all[rank * ranks + share.rank()] as usize)
                .collect();
            // Numbers of nodes are far below 2^53.
            let numbers: Vec<f64> = wanted.iter().map(|node| *node as f64).collect();
            let asked = share.exchange(&numbers, &halo.received_lengths, &halo.sent_lengths)?;
            halo.sent = asked
                .into_iter()
                .map(|node| node as usize - own.start)
                .collect();
        }
        outside.par_iter_mut().for_each(|nodes| {
            for node in nodes.iter_mut().filter(|node| **node != NOWHERE) {
                *node = if own.contains(node) {
                    *node - own.start
                } else {
                    own.len() + wanted.partition_point(|other| other < node)
                };
            }
        });
        halo.places = outside;
        Ok(halo)
    }

    /// Where among the nodes, which this process holds all, one outside a strip lies.
    pub fn place(&self, strip: usize, outside: usize) -> usize {
        self.places[strip][outside]
    }

    /// What other ranks have of a vector.
    fn received(&self, share: &Share, vector: &[f64]) -> Result<Vec<f64>, BackendError> {
        if self.sent_lengths.is_empty() {
            return Ok(Vec::new());
        }
        let sent: Vec<f64> = self.sent.iter().map(|place| vector[*place]).collect();
        share.exchange(&sent, &self.sent_lengths, &self.received_lengths)
    }

    /// The values of a vector outside each held strip, of those strips that ask for them.
    ///
    /// # Errors
    /// A rank has ended.
    pub fn outside(
        &self,
        share: &Share,
        layout: &Layout,
        vector: &[f64],
        asks: impl Fn(usize) -> bool + Sync,
    ) -> Result<Vec<Vec<f64>>, BackendError> {
        let received = self.received(share, vector)?;
        let value = |place: &usize| match vector.get(*place) {
            Some(value) => *value,
            None if *place == NOWHERE => 0.0,
            None => received[place - vector.len()],
        };
        let first = layout.own().start;
        Ok(layout.find(|strip| {
            if asks(strip) {
                self.places[strip - first].iter().map(value).collect()
            } else {
                Vec::new()
            }
        }))
    }
}

/// A vector on its way from the ranks that made it to those that go on with it.
#[derive(Debug)]
pub(super) struct Passage {
    /// Bounds by rank on either side; `None` where every rank holds all.
    ends: [Option<Vec<usize>>; 2],
}

impl Passage {
    /// From one side to the other.
    pub fn new(from: Option<Vec<usize>>, to: Option<Vec<usize>>) -> Passage {
        Passage { ends: [from, to] }
    }

    /// Whether everything stays where it is.
    pub fn stays(&self) -> bool {
        self.ends[0] == self.ends[1]
    }

    /// Whether each rank holds a part of its own at the end.
    pub fn is_divided(&self) -> bool {
        self.ends[1].is_some()
    }

    /// There.
    ///
    /// # Errors
    /// A rank has ended.
    pub fn down(&self, share: &Share, own: Vec<f64>) -> Result<Vec<f64>, BackendError> {
        let [from, to] = &self.ends;
        handed(share, from.as_deref(), to.as_deref(), own)
    }

    /// And back.
    ///
    /// # Errors
    /// A rank has ended.
    pub fn up(&self, share: &Share, own: Vec<f64>) -> Result<Vec<f64>, BackendError> {
        let [to, from] = &self.ends;
        handed(share, from.as_deref(), to.as_deref(), own)
    }
}

/// Numbers that lie over the ranks within the bounds `from`, within the bounds `to`.
fn handed(
    share: &Share,
    from: Option<&[usize]>,
    to: Option<&[usize]>,
    own: Vec<f64>,
) -> Result<Vec<f64>, BackendError> {
    let here = share.rank();
    match (from, to) {
        (None, None) => Ok(own),
        (None, Some(to)) => Ok(own[to[here]..to[here + 1]].to_vec()),
        (Some(from), None) => share.numbers(&own, from.windows(2).map(|ends| ends[1] - ends[0])),
        (Some(from), Some(to)) if from == to => Ok(own),
        (Some(from), Some(to)) => {
            let common = |one: usize, other: usize| {
                let [first, last] = [from[one].max(to[other]), from[one + 1].min(to[other + 1])];
                last.saturating_sub(first)
            };
            // What stays here may be more than an exchange takes.
            let to_other = |rank: usize| if rank == here { 0 } else { common(here, rank) };
            let from_other = |rank: usize| if rank == here { 0 } else { common(rank, here) };
            let sent: Vec<usize> = (0..share.count()).map(to_other).collect();
            let received: Vec<usize> = (0..share.count()).map(from_other).collect();
            let before: usize = sent[..here].iter().sum();
            let stays = before..before + common(here, here);
            let leaving = [&own[..stays.start], &own[stays.end..]].concat();
            let mut found = share.exchange(&leaving, &sent, &received)?;
            let coming: usize = received[..here].iter().sum();
            let after = found.split_off(coming);
            found.extend_from_slice(&own[stays]);
            found.extend(after);
            Ok(found)
        }
    }
}
