//! The keys of each table with an example value: the one list behind every message.

use super::tables;
#[cfg(feature = "cli")]
use crate::units::parse_any_quantity;

/// A key, and an example of its value; the head of a table stands for a table.
pub(super) type Key = (&'static str, &'static str);

/// A table of a scene, or one kind of `[[surface]]`.
pub(super) struct Section {
    /// The table's name in messages.
    pub title: &'static str,
    /// Keys in the order of the documentation.
    pub keys: &'static [Key],
    /// Keys of effects that this version lacks, each with the name of the effect.
    pub later: &'static [Key],
}

impl Section {
    /// The section of these keys.
    pub const fn new(title: &'static str, keys: &'static [Key]) -> Self {
        let later = &[];
        Section { title, keys, later }
    }

    /// An example line for a key.
    pub fn example(&self, key: &str) -> String {
        let known = self.keys.iter().find(|(name, _)| *name == key);
        match known {
            None => format!("{key} = ..."),
            Some((_, value)) if is_head(value) => (*value).to_string(),
            Some((_, value)) => format!("{key} = {value}"),
        }
    }

    /// The keys of the table; those of later versions come last.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.keys.iter().chain(self.later).map(|(name, _)| *name)
    }
}

/// The unit of a key such as `surface.0.rms_height` in a resolved scene, by the example of its value; empty where it has none.
#[cfg(feature = "cli")]
pub(crate) fn unit_of(key: &str) -> &'static str {
    let name = key.rsplit('.').next().unwrap_or(key).trim();
    let mut keys = all().flat_map(|section| section.keys);
    keys.find(|(known, _)| *known == name)
        .and_then(|(_, example)| parse_any_quantity(example.trim_matches('"')))
        .map_or("", |(_, dimension)| dimension.unit_in_scenes())
}

/// Whether a text is `[table]` or `[[table]]`, and no list.
fn is_head(text: &str) -> bool {
    text.starts_with('[') && !text.starts_with("[\"")
}

/// Declares sections by their title and a line for each key.
macro_rules! sections {
    ($( $NAME:ident $title:literal { $( $key:ident = $value:tt, )+ } )+) => {
        $(
            pub(super) const $NAME: Section = Section::new(
                $title,
                &[$( (stringify!($key), stringify!($value)) ),+],
            );
        )+
    };
}

/// Keys of the scene itself before the tables that [`tables`] declares, and behind them.
const FIRST: [Key; 6] = [
    ("title", "\"Sphere on a flat\""),
    ("grid", "[grid]"),
    ("solid", "[solid]"),
    ("surface", "[[surface]]"),
    ("adhesion", "[adhesion]"),
    ("capillary", "[capillary]"),
];
const LAST: [Key; 3] = [
    ("loading", "[loading]"),
    ("solver", "[solver]"),
    ("output", "[output]"),
];
const COUNT: usize = FIRST.len() + tables::NAMES.len() + LAST.len();

/// The keys of the scene itself in their order.
const fn scene_keys() -> [Key; COUNT] {
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
    later: &[("plastic", "plasticity")],
    ..Section::new("the scene itself", &scene_keys())
};

sections! {
    GRID "[grid]" {
        points = 1024,
        size = "25 um",
        boundary = "periodic",
    }
    SOLID "[solid]" {
        contact_modulus = "1.33 TPa",
        young_modulus = "70 GPa",
        poisson_ratio = 0.3,
        counter_young_modulus = "210 GPa",
        counter_poisson_ratio = 0.3,
        thickness = "5 um",
        base = "bonded",
        hardness = "10 GPa",
        relaxation = [[solid.relaxation]],
    }
    RELAXATION "[[solid.relaxation]]" {
        modulus = "1 MPa",
        time = "10 ms",
    }
    ADHESION "[adhesion]" {
        law = "maugis-dugdale",
        work_of_adhesion = "50 mJ/m^2",
        range = "1 nm",
        peak_tension = "50 MPa",
        taper = "auto",
        treatment = "full",
        map = "w.npy",
        rate = { reference_speed = "1 um/s", exponent = 0.5 },
    }
    RATE "the rate of [adhesion]" {
        reference_speed = "1 um/s",
        exponent = 0.5,
    }
    PATTERN "the pattern of [adhesion] map" {
        pattern = "checker",
        period = "1 um",
        low = 0,
        high = 1,
    }
    CAPILLARY "[capillary]" {
        humidity = 0.5,
        surface_tension = "72 mN/m",
        molar_volume = "1.8e-5 m^3/mol",
        temperature = "298 K",
        contact_angle = "20 deg",
    }
    LOADING "[loading]" {
        control = "pressure",
        path = ["1 MPa", "10 MPa"],
        start = "1 MPa",
        ramp = [[loading.ramp]],
        spring = "0.2 N/m",
        time_tolerance = 1e-3,
        pull_off_tolerance = 0.01,
        until = "apart",
    }
    RAMP "[[loading.ramp]]" {
        to = "10 MPa",
        steps = 10,
        duration = "1 s",
        hold = "1 s",
    }
    SOLVER "[solver]" {
        tolerance = 1e-6,
        max_iterations = 5000,
        precision = "auto",
        backend = "auto",
    }
    OUTPUT "[output]" {
        images = ["pressure"],
        fields = ["gap"],
        steps = "last",
    }
}

const KIND: Key = ("kind", "\"sphere\"");
const CENTRE: Key = ("centre", "[\"1 um\", \"1 um\"]");
const HURST: Key = ("hurst", "0.8");
const RMS_HEIGHT: Key = ("rms_height", "\"0.52 nm\"");
const RMS_SLOPE: Key = ("rms_slope", "0.1");
const LONGEST: Key = ("longest", "\"25 um\"");
const ROLLOFF: Key = ("rolloff", "\"6.25 um\"");
const SHORTEST: Key = ("shortest", "\"195 nm\"");
const SEED: Key = ("seed", "1");
const RADIUS: Key = ("radius", "\"1 um\"");
const HALF_ANGLE: Key = ("half_angle", "\"70 deg\"");
const AMPLITUDE: Key = ("amplitude", "\"1 nm\"");
const WAVELENGTH: Key = ("wavelength", "\"1 um\"");
const PATH: Key = ("path", "\"heights.npy\"");
const UNIT: Key = ("unit", "\"nm\"");
const SCALE: Key = ("scale", "1.0");
const DETREND: Key = ("detrend", "\"plane\"");
const FILL: Key = ("fill", "\"interpolate\"");
const BLACK: Key = ("black", "0.0");
const PROFILE: Key = ("profile", "true");
const CROP: Key = ("crop", "[0, 0, 256, 256]");
const OUTLIERS: Key = ("outliers", "6.0");
const EDGES: Key = ("edges", "\"window\"");
const RESAMPLE: Key = ("resample", "512");
const WHITE: Key = ("white", "\"1 um\"");

/// A `[[surface]]` of unknown kind: the keys of every kind.
pub(super) const SURFACE: Section = Section::new(
    "[[surface]]",
    &[
        KIND, HURST, RMS_HEIGHT, RMS_SLOPE, LONGEST, ROLLOFF, SHORTEST, SEED, RADIUS, HALF_ANGLE,
        CENTRE, AMPLITUDE, WAVELENGTH, PATH, UNIT, SCALE, BLACK, WHITE, DETREND, FILL, PROFILE,
        CROP, OUTLIERS, EDGES, RESAMPLE,
    ],
);
pub(super) const SELF_AFFINE: Section = Section::new(
    "a self-affine [[surface]]",
    &[
        KIND, HURST, RMS_HEIGHT, RMS_SLOPE, LONGEST, ROLLOFF, SHORTEST, SEED,
    ],
);
pub(super) const SPHERE: Section = Section::new("a sphere [[surface]]", &[KIND, RADIUS, CENTRE]);
pub(super) const CONE: Section = Section::new("a cone [[surface]]", &[KIND, HALF_ANGLE, CENTRE]);
pub(super) const WAVY: Section = Section::new("a wavy [[surface]]", &[KIND, AMPLITUDE, WAVELENGTH]);
pub(super) const FLAT: Section = Section::new("a flat [[surface]]", &[KIND]);
pub(super) const FILE: Section = Section::new(
    "a file [[surface]]",
    &[
        KIND, PATH, UNIT, SCALE, BLACK, WHITE, DETREND, FILL, PROFILE, CROP, OUTLIERS, EDGES,
        RESAMPLE,
    ],
);

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
