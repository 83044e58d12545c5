//! The rigid heights of a solve: those of the problem as plastic indentation and the history of the solid have moved them.

use super::contact::ContactSolver;
use crate::backend::BackendError;
use crate::backend::long_field::LongField;

impl ContactSolver<'_> {
    /// Moves the rigid heights by what the history of a viscoelastic solid adds to its displacement (reduced,
    /// all solved points).
    pub fn set_offset(&mut self, offset: &[f64]) {
        self.mean_offset = self.problem.share.sum(offset) / self.problem.shape.len() as f64;
        self.offset = offset.to_vec();
        self.move_heights();
    }

    /// Mean over all solved points of that offset; 0 without one.
    pub fn mean_offset(&self) -> f64 {
        self.mean_offset
    }

    /// Lowers the rigid heights by the plastic depths (reduced, all solved points).
    pub fn set_plastic_depths(&mut self, depths: Option<&[f64]>) {
        self.plastic_depths = depths.map(<[f64]>::to_vec);
        self.move_heights();
    }

    /// Depths by which plastic indentation has lowered the heights, over all held solved points; `None` if it
    /// has not.
    pub fn plastic_depths(&self) -> Option<&[f64]> {
        self.plastic_depths.as_deref()
    }

    /// The rigid heights over all held solved points as plastic depths and history have left them.
    fn moved_heights(&self) -> LongField<f64> {
        let mut moved = self.problem.padded_heights();
        for (height, depth) in moved.iter_mut().zip(self.plastic_depths.iter().flatten()) {
            *height -= depth;
        }
        for (height, offset) in moved.iter_mut().zip(&self.offset) {
            *height += offset;
        }
        moved
    }

    /// The heights have moved: the iterations take them anew when they need them.
    fn move_heights(&mut self) {
        self.forget_evaluated();
        self.has_heights = false;
        let moved = self.outer().is_some().then(|| self.moved_heights());
        if let (Some(outer), Some(moved)) = (self.outer(), moved) {
            outer.set_heights(&moved);
        }
    }

    /// Lets go of the heights where the iterations run, until they are needed.
    pub(super) fn release_heights(&mut self) {
        self.has_heights = false;
        self.backend.release(self.heights);
    }

    /// Hands the heights to where the iterations run: those of the outer state, which may be on the same device, or else the
    /// problem's.
    pub(super) fn hold_heights(&mut self) -> Result<(), BackendError> {
        if self.has_heights {
            return Ok(());
        }
        match &mut self.outer {
            Some(outer) => outer.hand_heights(&mut *self.backend, self.heights)?,
            None => {
                let heights = self.moved_heights();
                self.backend.write(self.heights, &heights);
            }
        }
        self.has_heights = true;
        Ok(())
    }
}
