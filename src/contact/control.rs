//! What a load prescribes.

use crate::scene;

/// What a load prescribes, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Control {
    /// Mean pressure over the grid, Pa; negative pulls. Periodic grids only.
    MeanPressure(f64),
    /// Total force, N; negative pulls.
    Force(f64),
    /// Rigid displacement of the bodies towards each other since they first touched, m.
    Approach(f64),
    /// Mean of the gap over the grid, m. Periodic grids only.
    MeanGap(f64),
}

impl Control {
    /// The load that takes so long to come to, s, from the load before. A path on a viscoelastic solid, or of
    /// an adhesion that grows with speed, must say so of every load but its first.
    pub fn after(self, seconds: f64) -> Load {
        Load {
            control: self,
            duration: Some(seconds),
        }
    }

    /// The number.
    pub fn value(self) -> f64 {
        match self {
            Control::MeanPressure(value)
            | Control::Force(value)
            | Control::Approach(value)
            | Control::MeanGap(value) => value,
        }
    }

    /// The word for it in a scene.
    pub fn kind(self) -> scene::Control {
        match self {
            Control::MeanPressure(_) => scene::Control::Pressure,
            Control::Force(_) => scene::Control::Force,
            Control::Approach(_) => scene::Control::Approach,
            Control::MeanGap(_) => scene::Control::MeanGap,
        }
    }

    /// A value of what a scene prescribes.
    pub(crate) fn from_kind(kind: scene::Control, value: f64) -> Self {
        match kind {
            scene::Control::Pressure => Control::MeanPressure(value),
            scene::Control::Force => Control::Force(value),
            scene::Control::Approach => Control::Approach(value),
            scene::Control::MeanGap => Control::MeanGap(value),
        }
    }
}

/// A load of a path: what it prescribes, and how long it takes where that matters.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Load {
    pub(super) control: Control,
    pub(super) duration: Option<f64>,
}

impl From<Control> for Load {
    fn from(control: Control) -> Self {
        Load {
            control,
            duration: None,
        }
    }
}
