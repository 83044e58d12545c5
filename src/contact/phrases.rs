//! Messages about scenes, told to who writes Rust: the method in place of the key, the name of a type in place
//! of a line of TOML.

/// Methods that set the keys of a scene, by how the keys begin; the first that fits.
const METHODS: &[(&str, &str)] = &[
    ("grid.boundary", "Contact::boundary"),
    ("grid", "Contact::new"),
    ("solid.contact_modulus", "Contact::contact_modulus"),
    ("solid.young_modulus", "Contact::solid"),
    ("solid.poisson_ratio", "Contact::solid"),
    ("solid.thickness", "Contact::layer"),
    ("solid.base", "Contact::layer"),
    ("solid.hardness", "Contact::hardness"),
    ("solid.relaxation", "Contact::relaxation"),
    ("surface", "Contact::from_parts"),
    ("adhesion.treatment", "Contact::treatment"),
    ("adhesion.map", "Contact::adhesion_map"),
    ("adhesion.rate", "Contact::rate"),
    ("adhesion", "Contact::law"),
    ("capillary", "Contact::capillary"),
    ("friction", "Contact::friction"),
    ("conductance", "Contact::conductance"),
    ("wear", "Contact::wear"),
    ("leakage", "Contact::leakage"),
    ("loading.spring", "Contact::spring"),
    ("loading.pull_off_tolerance", "Contact::pull_off_tolerance"),
    ("loading.ramp", "Contact::ramps"),
    ("loading.start", "Contact::ramps"),
    ("loading.time_tolerance", "Contact::ramps"),
    ("loading", "Contact::path"),
    ("solver.tolerance", "Contact::tolerance"),
    ("solver.max_iterations", "Contact::max_iterations"),
    ("solver.precision", "Contact::precision"),
    ("solver", "Contact::device"),
    ("title", "Contact::title"),
    ("output", "Contact::output"),
];

/// How long each load takes, in Rust.
const TIMES: &str =
    "give each load but the first its time, as in Control::MeanPressure(1e6).after(1.0)";

/// Phrases of scene files and what they are in Rust; longer ones stand before those that they hold.
const PHRASES: &[(&str, &str)] = &[
    (
        "give start and [[loading.ramp]] with duration = \"1 s\" (or hold = \"1 s\")",
        TIMES,
    ),
    (
        "give start and [[loading.ramp]] with a duration above 0, such as duration = \"1 s\"",
        TIMES,
    ),
    (
        "give duration = \"1 s\", or a number of steps",
        "give Ramp::during, or a number of steps",
    ),
    (
        "hold = \"1 s\" keeps the load for that long; leave this out, or give to and duration in its place",
        "Ramp::hold has its time already",
    ),
    (
        "precision = \"single\", or \"double\", with backend = \"cpu\" where the adapter has none",
        "Precision::Single, or Precision::Double, with Device::cpu() where the adapter has none",
    ),
    (
        "law = \"maugis-dugdale\" or \"exponential\"",
        "MaugisDugdale or Exponential",
    ),
    (
        "control = \"pressure\" or \"force\"",
        "Control::MeanPressure or Control::Force",
    ),
    (
        "\"force\" or \"approach\"",
        "Control::Force or Control::Approach",
    ),
    ("boundary = \"periodic\"", "Boundary::Periodic"),
    ("boundary = \"free\"", "Boundary::Free"),
    ("treatment = \"dmt\"", "Treatment::Dmt"),
    ("treatment = \"full\"", "Treatment::Full"),
    ("law = \"lennard-jones\"", "LennardJones"),
    ("law = \"maugis-dugdale\"", "MaugisDugdale"),
    ("control = \"approach\"", "Control::Approach"),
    ("control = \"mean-gap\"", "Control::MeanGap"),
    ("precision = \"single\"", "Precision::Single"),
    (
        "\"mixed\" and \"double\" go below",
        "Precision::Mixed and Precision::Double go below",
    ),
    ("precision = \"mixed\"", "Precision::Mixed"),
    ("steps = \"auto\"", "Ramp::auto_steps"),
    (
        "take at most that, or \"auto\"",
        "take at most that, or no taper of your own",
    ),
    ("take \"auto\"", "take Ramp::auto_steps"),
    ("\"auto\" goes by", "Ramp::auto_steps goes by"),
    ("range = \"auto\"", "Range::Auto"),
    ("leave taper at \"auto\"", "leave MaugisDugdale::taper out"),
    ("poisson_ratio = 0.5", "a Poisson ratio of 0.5"),
    ("leave [adhesion] out", "leave Contact::law out"),
    (
        "leave [[solid.relaxation]] out",
        "leave Contact::relaxation out",
    ),
    ("[[solid.relaxation]]", "Contact::relaxation"),
    ("[[loading.ramp]]", "Ramp"),
    ("or [conductance]", "or Contact::conductance"),
    ("leave the thickness out", "leave Contact::layer out"),
    ("or the thickness", "or Contact::layer"),
    ("leave the hardness out", "leave Contact::hardness out"),
    ("leave the spring out", "leave Contact::spring out"),
    ("leave the rate out", "leave Contact::rate out"),
    (
        "leave the tolerance out",
        "leave Contact::pull_off_tolerance out",
    ),
    (
        "write fill = \"interpolate\" to fill them",
        "take Fill::Interpolate to fill them",
    ),
    (
        "write black and white, the heights of its ends (black = 0, white = \"1 um\")",
        "give HeightFileScene black and white, the heights of its ends",
    ),
    ("take kind = \"flat\"", "take SurfacePart::Flat"),
    (", or \"inf\"", ", or f64::INFINITY"),
    ("as in a scene file", "as in a scene"),
    (
        "; a path in a scene is relative to the folder of the scene file",
        "; a relative path is taken from the current folder",
    ),
    ("[grid] points = ", "points = "),
    ("[grid] size = ", "size = "),
    ("grid.points: ", ""),
    ("[grid] points", "the points of the contact"),
    ("[grid] size", "the size of the contact"),
    ("[[surface]] ", "part "),
    ("[[surface]]", "part"),
    ("[adhesion] map ", "map of adhesion "),
];

/// The method that sets a key.
pub(super) fn method_of(key: &str) -> &'static str {
    METHODS
        .iter()
        .find(|(start, _)| key.starts_with(start))
        .map_or("Contact::tables", |(_, method)| *method)
}

/// A message about a scene in the words of Rust.
pub(super) fn in_rust(message: &impl ToString) -> String {
    PHRASES
        .iter()
        .fold(message.to_string(), |text, (toml, rust)| {
            text.replace(toml, rust)
        })
}
