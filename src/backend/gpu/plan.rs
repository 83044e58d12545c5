//! How a line is transformed by a workgroup: radices, threads, lines side by side, and how values
//! pass between the threads.

use std::f64::consts::TAU;

use super::butterfly::Direction;
use super::layout::Number;
use crate::kernel::SUMS;

/// Limits of a workgroup on an adapter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct GroupLimits {
    /// Threads in a workgroup.
    pub threads: usize,
    /// Bytes of workgroup memory.
    pub memory: usize,
}

/// Points of the lines that are split into fours. A kernel is written out for each value of a thread, and half as many take a
/// driver half the time to compile; eights pay where a grid keeps the device busy, which coarse levels do not.
const SHORT: usize = 64;

/// Values that one thread may hold at a time; more of them would spill out of its registers.
const MOST_VALUES: usize = 16;
/// Threads from which a workgroup takes only one line.
const ENOUGH_THREADS: usize = 128;
/// Lines side by side in a workgroup: four complex numbers are one sector of memory.
const MOST_LINES: usize = 4;
/// Bytes of workgroup memory that one thread's share of a sum takes.
const SUM_BYTES: usize = 8;
/// Banks of workgroup memory: neighbouring threads that reach for the same one at a time wait for one another.
pub const BANKS: usize = 32;

/// How values pass from one butterfly to the next through workgroup memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Exchange {
    /// Complex numbers as they are.
    Whole,
    /// Real parts first, then imaginary parts: half the memory.
    Split,
    /// The same, each in so many rounds, for a part of the line at a time.
    Rounds(usize),
}

/// Ways to pass values, the one that takes the fewest barriers first.
const WAYS: [Exchange; 4] = [
    Exchange::Whole,
    Exchange::Split,
    Exchange::Rounds(2),
    Exchange::Rounds(4),
];

impl Exchange {
    /// Numbers of a line that are in workgroup memory at a time.
    pub fn places(self, length: usize) -> usize {
        match self {
            Exchange::Whole | Exchange::Split => length,
            Exchange::Rounds(rounds) => length.div_ceil(rounds),
        }
    }

    /// Bytes of workgroup memory that a line of these numbers takes.
    pub fn memory(self, length: usize, number: Number) -> usize {
        let numbers = match self {
            Exchange::Whole => 2,
            Exchange::Split | Exchange::Rounds(_) => 1,
        };
        numbers * number.bytes() * self.places(length)
    }
}

/// The plan of one line length.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct LinePlan {
    /// Points in a line.
    pub length: usize,
    /// Radices in the order of the forward transform; the first one is even. The inverse takes
    /// them in reverse, so that its first butterfly uses the values its thread already holds.
    pub radices: Vec<usize>,
    /// Threads on one line.
    pub threads: usize,
    /// Lines in a workgroup.
    pub lines: usize,
    /// How values pass between threads.
    pub exchange: Exchange,
    /// Sums that the workgroup reduces together, in the memory that is left.
    pub sums_at_once: usize,
    /// Points of the whole line of which this is a part; where it is no part, its own.
    pub whole: usize,
    /// Where the roots of its stages begin in the table of roots.
    pub roots_at: usize,
    /// Whether its shaders spread values over the banks of workgroup memory: a butterfly of eight gives them to places eight
    /// apart, which few banks hold. A software driver has no banks.
    pub spread: bool,
}

/// A stage of a transform.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stage {
    /// Values in a butterfly.
    pub radix: usize,
    /// Product of the radices before.
    pub before: usize,
    /// Where its roots begin in the table: those of leg 1 for each `j % before`, those of leg 2, and so on.
    pub roots_at: usize,
}

impl Stage {
    /// Roots of unity that it turns values by; none where it is the first.
    fn roots(&self) -> usize {
        match self.before {
            1 => 0,
            before => (self.radix - 1) * before,
        }
    }

    /// Where the root of a leg begins in the table.
    pub fn leg_at(&self, leg: usize) -> usize {
        self.roots_at + (leg - 1) * self.before
    }
}

/// The roots of unity that the passes over a line read, `exp(-2 pi i m / n)` of its points, real and imaginary parts one
/// after another, computed in double precision: of a line in two passes all n of them, by which parts are turned; then
/// those of each stage, side by side as neighbouring threads take them.
pub fn roots(first: &LinePlan, then: Option<&LinePlan>) -> Vec<f64> {
    let whole = first.whole;
    let mut powers: Vec<usize> = match then {
        Some(_) => (0..whole).collect(),
        None => Vec::new(),
    };
    for plan in std::iter::once(first).chain(then) {
        for direction in [Direction::Forward, Direction::Inverse] {
            for stage in plan.stages(direction) {
                debug_assert_eq!(stage.roots_at, powers.len());
                let fold = whole / (stage.before * stage.radix);
                let legs = 1..if stage.before > 1 { stage.radix } else { 1 };
                powers.extend(legs.flat_map(|leg| (0..stage.before).map(move |j| j * fold * leg)));
            }
        }
    }
    let turns = powers.into_iter().flat_map(|power| {
        let angle = TAU * power as f64 / whole as f64;
        [angle.cos(), -angle.sin()]
    });
    turns.collect()
}

/// Radices of an even length whose prime factors are 2, 3, 5 and 7, powers of two first.
pub fn radices(length: usize) -> Option<Vec<usize>> {
    smooth_radices(length).filter(|_| length.is_multiple_of(2))
}

/// The same of any length.
fn smooth_radices(length: usize) -> Option<Vec<usize>> {
    if length < 2 {
        return None;
    }
    let mut twos = length.trailing_zeros();
    let mut rest = length >> twos;
    let mut found = Vec::new();
    while twos > 0 {
        // Eights while what is left is not better shared out as two fours.
        let step = match twos {
            1 | 2 => twos,
            _ if length <= SHORT => 2,
            4 => 2,
            _ => 3,
        };
        found.push(1 << step);
        twos -= step;
    }
    for prime in [7usize, 5, 3] {
        while rest.is_multiple_of(prime) {
            found.push(prime);
            rest /= prime;
        }
    }
    (rest == 1).then_some(found)
}

impl LinePlan {
    /// The plan of `count` lines of a length, or `None` where the length has another prime factor,
    /// is odd, or does not fit the adapter's workgroups.
    pub fn new(length: usize, count: usize, limits: GroupLimits, number: Number) -> Option<Self> {
        Self::part(length, length, count, limits, number).filter(|_| length.is_multiple_of(2))
    }

    /// The same for lines that each lie in one piece: several in a workgroup would spare no reading, and wait for one
    /// another. Real and imaginary parts pass in turn, which is faster from 2048 points on and no slower below.
    pub fn in_one_piece(
        length: usize,
        count: usize,
        limits: GroupLimits,
        number: Number,
    ) -> Option<Self> {
        let plan = LinePlan::new(length, count, limits, number)?;
        match plan.threads >= ENOUGH_THREADS {
            true => Self::passing(&WAYS[1..], length, length, 1, limits, number),
            false => Some(plan),
        }
    }

    /// The plan of parts of a line of `whole` points; these may be odd.
    pub fn part(
        length: usize,
        whole: usize,
        count: usize,
        limits: GroupLimits,
        number: Number,
    ) -> Option<Self> {
        Self::passing(&WAYS, length, whole, count, limits, number)
    }

    /// The same where values pass in one of these ways.
    fn passing(
        ways: &[Exchange],
        length: usize,
        whole: usize,
        count: usize,
        limits: GroupLimits,
        number: Number,
    ) -> Option<Self> {
        let radices = smooth_radices(length)?;
        let rounds = |threads: usize, radix: usize| (length / radix).div_ceil(threads);
        // The least work counted in idle threads too; of equals, the most threads.
        let threads = (1..=limits.threads.min(length.div_ceil(2)))
            .filter(|&threads| {
                radices
                    .iter()
                    .all(|&radix| rounds(threads, radix) * radix <= MOST_VALUES)
            })
            .min_by_key(|&threads| {
                let work: usize = radices.iter().map(|&radix| rounds(threads, radix)).sum();
                (threads * work, std::cmp::Reverse(threads))
            })?;
        let fits = |lines: usize, exchange: Exchange| {
            lines * (threads * SUM_BYTES + exchange.memory(length, number)) <= limits.memory
                && lines * threads <= limits.threads
        };
        let most = MOST_LINES.max(ENOUGH_THREADS / threads.next_power_of_two());
        let wanted = std::iter::successors(Some(1), |lines| Some(2 * lines))
            .take_while(|&lines| lines <= most && lines < 2 * count)
            .last()
            .unwrap_or(1);
        let mut lines = wanted;
        // Rounds cost barriers; one line at a time wastes half of what memory hands out at once.
        let exchange = loop {
            let pays = |exchange: Exchange| match exchange {
                Exchange::Whole => true,
                Exchange::Split => lines <= MOST_LINES,
                Exchange::Rounds(_) => lines == 1,
            };
            let mut ways = ways.iter().filter(|&&exchange| pays(exchange));
            if let Some(&exchange) = ways.find(|&&exchange| fits(lines, exchange)) {
                break exchange;
            }
            if lines == 1 {
                return None;
            }
            lines /= 2;
        };
        let used = lines * exchange.memory(length, number);
        let left = (limits.memory - used) / (lines * threads * SUM_BYTES);
        Some(LinePlan {
            sums_at_once: left.min(SUMS),
            whole,
            roots_at: if whole == length { 0 } else { whole },
            length,
            radices,
            threads,
            lines,
            exchange,
            spread: true,
        })
    }

    /// Longest line of these numbers that has a plan: a power of two, since these fill workgroups best.
    pub fn longest(limits: GroupLimits, number: Number) -> usize {
        (1..=20)
            .map(|power| 1usize << power)
            .take_while(|&length| LinePlan::new(length, 1, limits, number).is_some())
            .last()
            .unwrap_or(0)
    }

    /// The stages of a transform, in order.
    pub fn stages(&self, direction: Direction) -> Vec<Stage> {
        let placed = |radices: &[usize], mut roots_at: usize| -> (Vec<Stage>, usize) {
            let mut before = 1;
            let stages = radices
                .iter()
                .map(|&radix| {
                    let stage = Stage {
                        radix,
                        before,
                        roots_at,
                    };
                    before *= radix;
                    roots_at += stage.roots();
                    stage
                })
                .collect();
            (stages, roots_at)
        };
        let (stages, end) = placed(&self.radices, self.roots_at);
        match direction {
            Direction::Forward => stages,
            Direction::Inverse => {
                let reversed: Vec<usize> = self.radices.iter().rev().copied().collect();
                placed(&reversed, end).0
            }
        }
    }

    /// The end of the roots of its stages in the table.
    pub fn roots_end(&self) -> usize {
        let last = self.stages(Direction::Inverse).pop();
        last.map_or(self.roots_at, |stage| stage.roots_at + stage.roots())
    }

    /// Whether places are spread: blocks of as many as there are banks, which the places of a line must fill.
    pub fn spreads(&self) -> bool {
        self.spread && self.exchange.places(self.length).is_multiple_of(BANKS)
    }

    /// Threads in a workgroup.
    pub fn group_threads(&self) -> usize {
        self.threads * self.lines
    }

    /// Workgroups for a number of lines.
    pub fn groups(&self, count: usize) -> usize {
        count.div_ceil(self.lines)
    }

    /// Complex numbers that a thread holds at most.
    pub fn values(&self) -> usize {
        self.radices
            .iter()
            .map(|radix| (self.length / radix).div_ceil(self.threads) * radix)
            .max()
            .unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COMMON: GroupLimits = GroupLimits {
        threads: 1024,
        memory: 32768,
    };

    #[test]
    fn radices_multiply_to_the_length_and_start_even() {
        for length in (2..=4096).step_by(2) {
            let mut rest: usize = length;
            for prime in [2usize, 3, 5, 7] {
                while rest.is_multiple_of(prime) {
                    rest /= prime;
                }
            }
            match radices(length) {
                Some(found) => {
                    assert_eq!(found.iter().product::<usize>(), length);
                    assert_eq!(found[0] % 2, 0, "{length}");
                    assert_eq!(rest, 1);
                }
                None => assert_ne!(rest, 1, "{length}"),
            }
        }
        assert_eq!(radices(9), None);
        assert_eq!(radices(22), None);
        assert_eq!(radices(32), Some(vec![4, 4, 2]));
        assert_eq!(radices(128), Some(vec![8, 4, 4]));
    }

    #[test]
    fn plans_keep_the_limits() {
        let least = GroupLimits {
            threads: 256,
            memory: 16384,
        };
        let all = [Number::Single, Number::Double]
            .into_iter()
            .flat_map(|number| [(COMMON, number), (least, number)]);
        for (limits, number) in all {
            for length in (2..=LinePlan::longest(limits, number)).step_by(2) {
                let Some(plan) = LinePlan::new(length, length, limits, number) else {
                    continue;
                };
                assert!(plan.group_threads() <= limits.threads, "{plan:?}");
                assert!(plan.values() <= MOST_VALUES, "{plan:?}");
                let sums = plan.sums_at_once * plan.threads * SUM_BYTES;
                let memory = plan.lines * (plan.exchange.memory(length, number) + sums);
                assert!(plan.sums_at_once > 0, "{plan:?}");
                assert!(memory <= limits.memory, "{plan:?}");
            }
        }
        assert_eq!(LinePlan::longest(COMMON, Number::Single), 16384);
        assert_eq!(LinePlan::longest(COMMON, Number::Double), 8192);
    }
}
