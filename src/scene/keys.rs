//! The keys of each table, with a line that would do: the one list behind every message.

use super::tables;

/// A table of a scene, or one kind of `[[surface]]`.
pub(super) struct Section {
    /// The table as messages name it.
    pub title: &'static str,
    /// Keys, each with a line that sets it, in the order of the contract.
    pub keys: &'static [(&'static str, &'static str)],
    /// Keys of effects that this version lacks, each with what it stands for.
    pub later: &'static [(&'static str, &'static str)],
}

impl Section {
    /// A line that sets a key, for messages.
    pub fn example(&self, key: &str) -> String {
        self.keys
            .iter()
            .find(|(name, _)| *name == key)
            .map_or_else(|| format!("{key} = ..."), |(_, line)| (*line).to_string())
    }

    /// The keys of the table, those of later versions last.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.keys.iter().chain(self.later).map(|(name, _)| *name)
    }
}

/// Keys of the scene itself before the tables that [`tables`] declares, and behind them.
const FIRST: [(&str, &str); 6] = [
    ("title", "title = \"Sphere on a flat\""),
    ("grid", "[grid]"),
    ("solid", "[solid]"),
    ("surface", "[[surface]]"),
    ("adhesion", "[adhesion]"),
    ("capillary", "[capillary]"),
];
const LAST: [(&str, &str); 3] = [
    ("loading", "[loading]"),
    ("solver", "[solver]"),
    ("output", "[output]"),
];
const COUNT: usize = FIRST.len() + tables::NAMES.len() + LAST.len();

/// The keys of the scene itself in their order.
const fn scene_keys() -> [(&'static str, &'static str); COUNT] {
    let mut keys = [FIRST[0]; COUNT];
    let behind = FIRST.len() + tables::NAMES.len();
    let mut i = 0;
    while i < COUNT {
        keys[i] = if i < FIRST.len() {
            FIRST[i]
        } else if i < behind {
            tables::NAMES[i - FIRST.len()]
        } else {
            LAST[i - behind]
        };
        i += 1;
    }
    keys
}

pub(super) const SCENE: Section = Section {
    title: "the scene itself",
    keys: &scene_keys(),
    later: &[("plastic", "plasticity")],
};

pub(super) const GRID: Section = Section {
    title: "[grid]",
    keys: &[
        ("points", "points = 1024"),
        ("size", "size = \"25 um\""),
        ("boundary", "boundary = \"periodic\""),
    ],
    later: &[],
};

pub(super) const SOLID: Section = Section {
    title: "[solid]",
    keys: &[
        ("contact_modulus", "contact_modulus = \"1.33 TPa\""),
        ("young_modulus", "young_modulus = \"70 GPa\""),
        ("poisson_ratio", "poisson_ratio = 0.3"),
        (
            "counter_young_modulus",
            "counter_young_modulus = \"210 GPa\"",
        ),
        ("counter_poisson_ratio", "counter_poisson_ratio = 0.3"),
        ("thickness", "thickness = \"5 um\""),
        ("base", "base = \"bonded\""),
        ("hardness", "hardness = \"10 GPa\""),
        ("relaxation", "[[solid.relaxation]]"),
    ],
    later: &[],
};

pub(super) const RELAXATION: Section = Section {
    title: "[[solid.relaxation]]",
    keys: &[
        ("modulus", "modulus = \"1 MPa\""),
        ("time", "time = \"10 ms\""),
    ],
    later: &[],
};

const KIND: (&str, &str) = ("kind", "kind = \"sphere\"");
const CENTRE: (&str, &str) = ("centre", "centre = [\"1 um\", \"1 um\"]");
const HURST: (&str, &str) = ("hurst", "hurst = 0.8");
const RMS_HEIGHT: (&str, &str) = ("rms_height", "rms_height = \"0.52 nm\"");
const RMS_SLOPE: (&str, &str) = ("rms_slope", "rms_slope = 0.1");
const LONGEST: (&str, &str) = ("longest", "longest = \"25 um\"");
const ROLLOFF: (&str, &str) = ("rolloff", "rolloff = \"6.25 um\"");
const SHORTEST: (&str, &str) = ("shortest", "shortest = \"195 nm\"");
const SEED: (&str, &str) = ("seed", "seed = 1");
const RADIUS: (&str, &str) = ("radius", "radius = \"1 um\"");
const HALF_ANGLE: (&str, &str) = ("half_angle", "half_angle = \"70 deg\"");
const AMPLITUDE: (&str, &str) = ("amplitude", "amplitude = \"1 nm\"");
const WAVELENGTH: (&str, &str) = ("wavelength", "wavelength = \"1 um\"");
const PATH: (&str, &str) = ("path", "path = \"heights.npy\"");
const UNIT: (&str, &str) = ("unit", "unit = \"nm\"");
const SCALE: (&str, &str) = ("scale", "scale = 1.0");
const DETREND: (&str, &str) = ("detrend", "detrend = \"plane\"");
const FILL: (&str, &str) = ("fill", "fill = \"interpolate\"");
const BLACK: (&str, &str) = ("black", "black = 0.0");
const WHITE: (&str, &str) = ("white", "white = \"1 um\"");

/// A `[[surface]]` whose kind cannot be told: the keys of every kind.
pub(super) const SURFACE: Section = Section {
    title: "[[surface]]",
    keys: &[
        KIND, HURST, RMS_HEIGHT, RMS_SLOPE, LONGEST, ROLLOFF, SHORTEST, SEED, RADIUS, HALF_ANGLE,
        CENTRE, AMPLITUDE, WAVELENGTH, PATH, UNIT, SCALE, BLACK, WHITE, DETREND, FILL,
    ],
    later: &[],
};

pub(super) const SELF_AFFINE: Section = Section {
    title: "a self-affine [[surface]]",
    keys: &[
        KIND, HURST, RMS_HEIGHT, RMS_SLOPE, LONGEST, ROLLOFF, SHORTEST, SEED,
    ],
    later: &[],
};

pub(super) const SPHERE: Section = Section {
    title: "a sphere [[surface]]",
    keys: &[KIND, RADIUS, CENTRE],
    later: &[],
};

pub(super) const CONE: Section = Section {
    title: "a cone [[surface]]",
    keys: &[KIND, HALF_ANGLE, CENTRE],
    later: &[],
};

pub(super) const WAVY: Section = Section {
    title: "a wavy [[surface]]",
    keys: &[KIND, AMPLITUDE, WAVELENGTH],
    later: &[],
};

pub(super) const FLAT: Section = Section {
    title: "a flat [[surface]]",
    keys: &[KIND],
    later: &[],
};

pub(super) const FILE: Section = Section {
    title: "a file [[surface]]",
    keys: &[KIND, PATH, UNIT, SCALE, BLACK, WHITE, DETREND, FILL],
    later: &[],
};

pub(super) const ADHESION: Section = Section {
    title: "[adhesion]",
    keys: &[
        ("law", "law = \"maugis-dugdale\""),
        ("work_of_adhesion", "work_of_adhesion = \"50 mJ/m^2\""),
        ("range", "range = \"1 nm\""),
        ("peak_tension", "peak_tension = \"50 MPa\""),
        ("taper", "taper = \"auto\""),
        ("treatment", "treatment = \"full\""),
        ("map", "map = \"w.npy\""),
        (
            "rate",
            "rate = { reference_speed = \"1 um/s\", exponent = 0.5 }",
        ),
    ],
    later: &[],
};

pub(super) const RATE: Section = Section {
    title: "the rate of [adhesion]",
    keys: &[
        ("reference_speed", "reference_speed = \"1 um/s\""),
        ("exponent", "exponent = 0.5"),
    ],
    later: &[],
};

pub(super) const PATTERN: Section = Section {
    title: "the pattern of [adhesion] map",
    keys: &[
        ("pattern", "pattern = \"checker\""),
        ("period", "period = \"1 um\""),
        ("low", "low = 0"),
        ("high", "high = 1"),
    ],
    later: &[],
};

pub(super) const CAPILLARY: Section = Section {
    title: "[capillary]",
    keys: &[
        ("humidity", "humidity = 0.5"),
        ("surface_tension", "surface_tension = \"72 mN/m\""),
        ("molar_volume", "molar_volume = \"1.8e-5 m^3/mol\""),
        ("temperature", "temperature = \"298 K\""),
        ("contact_angle", "contact_angle = \"20 deg\""),
    ],
    later: &[],
};

pub(super) const LOADING: Section = Section {
    title: "[loading]",
    keys: &[
        ("control", "control = \"pressure\""),
        ("path", "path = [\"1 MPa\", \"10 MPa\"]"),
        ("start", "start = \"1 MPa\""),
        ("ramp", "[[loading.ramp]]"),
        ("spring", "spring = \"0.2 N/m\""),
        ("time_tolerance", "time_tolerance = 1e-3"),
        ("pull_off_tolerance", "pull_off_tolerance = 0.01"),
    ],
    later: &[],
};

pub(super) const RAMP: Section = Section {
    title: "[[loading.ramp]]",
    keys: &[
        ("to", "to = \"10 MPa\""),
        ("steps", "steps = 10"),
        ("duration", "duration = \"1 s\""),
        ("hold", "hold = \"1 s\""),
    ],
    later: &[],
};

pub(super) const SOLVER: Section = Section {
    title: "[solver]",
    keys: &[
        ("tolerance", "tolerance = 1e-6"),
        ("max_iterations", "max_iterations = 5000"),
        ("precision", "precision = \"auto\""),
        ("backend", "backend = \"auto\""),
    ],
    later: &[],
};

pub(super) const OUTPUT: Section = Section {
    title: "[output]",
    keys: &[
        ("images", "images = [\"pressure\"]"),
        ("fields", "fields = [\"gap\"]"),
        ("steps", "steps = \"last\""),
    ],
    later: &[],
};

/// The sections before the tables that [`tables`] declares, and behind them.
const BEFORE: &[&Section] = &[
    &SCENE,
    &GRID,
    &SOLID,
    &RELAXATION,
    &SELF_AFFINE,
    &SPHERE,
    &CONE,
    &WAVY,
    &FILE,
    &ADHESION,
    &PATTERN,
    &RATE,
    &CAPILLARY,
];
const BEHIND: &[&Section] = &[&LOADING, &RAMP, &SOLVER, &OUTPUT];

/// Every section, to tell where a misplaced key belongs.
pub(super) fn all() -> impl Iterator<Item = &'static Section> {
    [BEFORE, tables::SECTIONS, BEHIND]
        .into_iter()
        .flatten()
        .copied()
}
