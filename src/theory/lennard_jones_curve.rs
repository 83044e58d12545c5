//! The curve of equilibria of a [`LennardJonesSphere`], including unstable parts and folds.
//!
//! The curve is followed by its arc length in (approach, force), so that it may turn back in
//! either. Folds of the approach are located and kept as states of the curve, so between two
//! neighbours the approach is monotone.

use super::error::TheoryError;
use super::lennard_jones_sphere::{Constraint, LennardJonesSphere, Solved, State};
use super::roots::{minimum, root};

const MAX_CURVE: usize = 4000;
/// In units of force; the curve bends over at least some tenths.
const LONGEST_STEP: f64 = 0.1;
const SHORTEST_STEP: f64 = 1e-6;
/// Least cosine of the angle between the tangents at two neighbours. A step that skips two folds
/// would turn by more than that.
const LEAST_COSINE: f64 = 0.9;
/// Error of the position of a fold along the curve; that of its value is the square.
const PLACE_TOLERANCE: f64 = 1e-9;

/// Unit tangent in (approach/unit, force).
type Direction = (f64, f64);

/// A state with the direction of the curve.
struct Node {
    state: State,
    tangent: Direction,
}

/// A segment of the curve between two of its states, parametrised along their chord.
struct Piece<'a> {
    ends: [&'a State; 2],
    direction: (f64, f64),
    places: [f64; 2],
    unit: f64,
}

impl<'a> Piece<'a> {
    fn new(first: &'a State, last: &'a State, unit: f64) -> Self {
        let chord = (
            (last.approach - first.approach) / unit,
            last.force - first.force,
        );
        let length = chord.0.hypot(chord.1);
        let direction = (chord.0 / length, chord.1 / length);
        let place = |state: &State| direction.0 * state.approach / unit + direction.1 * state.force;
        Piece {
            ends: [first, last],
            direction,
            places: [place(first), place(last)],
            unit,
        }
    }
}

impl LennardJonesSphere {
    /// Equilibria from far away inwards, along stable and unstable parts, until `until` holds; the
    /// last state satisfies it. Neighbours are at most 0.1 apart in force, and every fold of the
    /// approach is a state.
    pub fn curve(&self, until: impl Fn(&[State]) -> bool) -> Result<Vec<State>, TheoryError> {
        let (states, tangents) = self.followed(until)?;
        let mut nodes: Vec<Node> = Vec::with_capacity(states.len() + 4);
        for (state, tangent) in states.into_iter().zip(tangents) {
            let node = Node { state, tangent };
            self.add_folds(&mut nodes, &node)?;
            nodes.push(node);
        }
        Ok(nodes.into_iter().map(|node| node.state).collect())
    }

    /// Equilibria at steps of the arc length, with their unit tangents.
    fn followed(
        &self,
        until: impl Fn(&[State]) -> bool,
    ) -> Result<(Vec<State>, Vec<Direction>), TheoryError> {
        let unit = self.force_unit();
        let mut now = self.rigid_start(self.far())?;
        let mut states = vec![now.state.clone()];
        let mut tangents = vec![now.tangent(unit, (1.0, 0.0))];
        let mut step = LONGEST_STEP;
        while states.len() < MAX_CURVE {
            let last = &now.state;
            let tangent = tangents[tangents.len() - 1];
            if until(&states) {
                return Ok((states, tangents));
            }
            let held = Constraint {
                approach_share: tangent.0 / unit,
                force_share: tangent.1,
                sum: tangent.0 * last.approach / unit + tangent.1 * last.force + step,
            };
            let mut guess = last.clone();
            guess.approach += step * tangent.0 * unit;
            guess.gap += &now.gap_rate * (step * tangent.0 * unit);
            let next = self.solve(guess, held).map(|next| {
                let chord = (
                    (next.state.approach - last.approach) / unit,
                    next.state.force - last.force,
                );
                let new = next.tangent(unit, chord);
                let near = chord.0.hypot(chord.1) < 1.5 * step;
                let cosine = new.0 * tangent.0 + new.1 * tangent.1;
                (next, new, near && cosine > LEAST_COSINE)
            });
            match next {
                // A long step or a sharp turn may be a jump to another part of the curve.
                Ok((next, new, true)) => {
                    if next.rounds <= 5 {
                        step = (1.5 * step).min(LONGEST_STEP);
                    }
                    tangents.push(new);
                    states.push(next.state.clone());
                    now = next;
                }
                _ if step > SHORTEST_STEP => step *= 0.5,
                Err(error) => return Err(error),
                Ok(_) => break,
            }
        }
        Err(TheoryError::NotConverged {
            what: "the curve of a Lennard-Jones sphere",
        })
    }

    /// Adds the folds of the approach that become known with `next`, the next state.
    fn add_folds(&self, nodes: &mut Vec<Node>, next: &Node) -> Result<(), TheoryError> {
        let Some(last) = nodes.last() else {
            return Ok(());
        };
        let rate = |node: &Node| node.tangent.0;
        if rate(last) * rate(next) < 0.0 {
            let fold = self.turning_point(&last.state, &next.state, |tangent| tangent.0)?;
            nodes.push(fold);
            return Ok(());
        }
        // Two folds may lie within the last two steps: the approach is slowest in between.
        let [.., before, middle] = &nodes[..] else {
            return Ok(());
        };
        let slows = rate(middle) < rate(before) && rate(middle) < rate(next);
        if !(slows && rate(before) > 0.0 && rate(middle) > 0.0) {
            return Ok(());
        }
        let piece = Piece::new(&before.state, &next.state, self.force_unit());
        let slowest = |place: f64| self.rate_at(&piece, place, |tangent| tangent.0);
        let (place, least) = minimum(slowest, piece.places[0], piece.places[1]);
        if least >= 0.0 {
            return Ok(());
        }
        let Some((between, _)) = self.at_place(&piece, place) else {
            return Ok(());
        };
        let first = self.turning_point(&before.state, &between.state, |tangent| tangent.0)?;
        let second = self.turning_point(&between.state, &next.state, |tangent| tangent.0)?;
        // The middle state keeps its position among the three new ones.
        let along = |state: &State| {
            piece.direction.0 * state.approach / piece.unit + piece.direction.1 * state.force
        };
        let between = Node {
            tangent: between.tangent(piece.unit, piece.direction),
            state: between.state,
        };
        let middle = nodes.pop();
        nodes.extend([first, between, second]);
        nodes.extend(middle);
        let from = nodes.len() - 4;
        nodes[from..].sort_by(|a, b| along(&a.state).total_cmp(&along(&b.state)));
        Ok(())
    }

    /// The curve as far as the approach `deepest` and beyond all folds, so that both directions find their branch on it
    /// ([`LennardJonesSphere::on_curve`]).
    ///
    /// # Errors
    /// A state that is not found.
    pub fn curve_to(&self, deepest: f64) -> Result<Vec<State>, TheoryError> {
        self.curve(|states| {
            states
                .last()
                .is_some_and(|state| state.force > 0.0 && state.approach >= deepest)
        })
    }

    /// The state at an approach on the first crossing of a curve, for a sphere that moves `together` with its
    /// counter-face, or on the last.
    ///
    /// # Errors
    /// A state that is not found.
    pub fn on_curve(
        &self,
        curve: &[State],
        approach: f64,
        together: bool,
    ) -> Result<State, TheoryError> {
        let crosses = |pair: &&[State]| pair[0].approach < approach && approach <= pair[1].approach;
        let mut pairs = curve.windows(2);
        let found = if together {
            pairs.find(crosses)
        } else {
            pairs.rfind(crosses)
        };
        match found {
            Some(neighbours) => self.between(neighbours, approach),
            // Farther away than the curve begins.
            None => self.at_approach(approach),
        }
    }

    /// The state of greatest tension: pull-off under load control.
    pub fn pull_off(&self) -> Result<State, TheoryError> {
        // Pull-off is beyond -0.75 for every sphere; a soft sphere has a lesser minimum before it
        // touches.
        const BEYOND_ATTRACTION: f64 = -0.6;
        let (states, tangents) = self.followed(|states| match states {
            [.., before, last] => before.force < BEYOND_ATTRACTION && last.force > before.force,
            _ => false,
        })?;
        // The least force may lie on either side of the last state but one.
        let turn = |from: usize| tangents[from].1 < 0.0 && tangents[from + 1].1 >= 0.0;
        let from = (0..states.len() - 1)
            .rev()
            .take(2)
            .find(|from| turn(*from))
            .ok_or(TheoryError::NotConverged {
                what: "the greatest tension of a Lennard-Jones sphere",
            })?;
        self.turning_point(&states[from], &states[from + 1], |tangent| tangent.1)
            .map(|node| node.state)
    }

    /// Folds of the approach, at which the sphere jumps under a prescribed approach: in on loading
    /// and off on unloading. `None` for small Tabor parameters (0.65 and less), where the curve is
    /// single-valued.
    pub fn folds(&self) -> Result<Option<(State, State)>, TheoryError> {
        let states = self.curve(|states| states.last().is_some_and(|last| last.force > 0.0))?;
        let rises = |pair: &[State]| pair[1].approach > pair[0].approach;
        let mut turns = states
            .windows(3)
            .filter(|three| rises(&three[..2]) != rises(&three[1..]))
            .map(|three| three[1].clone());
        Ok(turns.next().zip(turns.next()))
    }

    /// The state between two neighbours at which a component of the curve's tangent, in (approach,
    /// force), changes sign.
    fn turning_point(
        &self,
        first: &State,
        last: &State,
        component: impl Fn((f64, f64)) -> f64 + Copy,
    ) -> Result<Node, TheoryError> {
        let piece = Piece::new(first, last, self.force_unit());
        let place = root(
            "a turning point",
            |place| self.rate_at(&piece, place, component),
            piece.places[0],
            piece.places[1],
            PLACE_TOLERANCE,
        )?;
        let (solved, tangent) = self
            .at_place(&piece, place)
            .ok_or(TheoryError::NotConverged {
                what: "a turning point",
            })?;
        Ok(Node {
            state: solved.state,
            tangent,
        })
    }

    /// A component of the tangent at a position in a segment; NaN if no state is found.
    fn rate_at(&self, piece: &Piece, place: f64, component: impl Fn((f64, f64)) -> f64) -> f64 {
        self.at_place(piece, place)
            .map_or(f64::NAN, |(_, tangent)| component(tangent))
    }

    /// The state and the tangent at a position in a segment.
    fn at_place(&self, piece: &Piece, place: f64) -> Option<(Solved, (f64, f64))> {
        let share = (place - piece.places[0]) / (piece.places[1] - piece.places[0]);
        let [first, last] = piece.ends;
        let guess = State {
            approach: first.approach + share * (last.approach - first.approach),
            force: first.force + share * (last.force - first.force),
            gap: &first.gap + (&last.gap - &first.gap) * share,
        };
        let held = Constraint {
            approach_share: piece.direction.0 / piece.unit,
            force_share: piece.direction.1,
            sum: place,
        };
        let solved = self.solve(guess, held).ok()?;
        let tangent = solved.tangent(piece.unit, piece.direction);
        Some((solved, tangent))
    }
}
