//! The report of `tabor surface`: a scene's beginning in TOML, with the statistics as comments above it.

use std::fmt::Write;
use std::path::Path;

use crate::output::csv_line::{csv_line, csv_number};
use crate::output::plot::{Axis, Figure, LARGE, Panel, PlotPoint, Series};
use crate::scene::Boundary;
use crate::solver::good_size;
use crate::study::PIXELS_A_WAVE;
use crate::surface::Surface;
use crate::surface::correlation::{autocorrelation, length_of};
use crate::surface::fit::{BandFitError, SelfAffineFit, fit};
use crate::surface::roughness::{HeightParameters, distribution, scale_dependence};
use crate::surface::statistics::{SpectrumRing, Statistics, radial_spectrum};

/// Most points a side of the scene that is written, unless the map has more.
const MOST_POINTS: usize = 4096;
/// Points of the line that stands for the fit in the plot.
const LINE_POINTS: usize = 200;

/// Start of the names of counts.
const COUNT: &str = "points_";
const COUNTED: usize = 26;
/// Name, unit and meaning of each number.
const QUANTITIES: [(&str, &str, &str); COUNTED] = [
    ("points_x", "", "points along x"),
    ("points_y", "", "points along y"),
    ("size_x", "m", "size along x"),
    ("size_y", "m", "size along y"),
    ("pixel_x", "m", "distance of points along x"),
    ("pixel_y", "m", "distance of points along y"),
    ("mean_height", "m", "mean of the heights"),
    ("lowest", "m", "lowest point"),
    ("highest", "m", "highest point"),
    ("rms_height", "m", "about the mean"),
    ("rms_slope", "", "of the gradient"),
    ("rms_curvature", "1/m", "of the Laplacian"),
    ("m0", "m^2", "spectral moment: mean square height"),
    ("m2", "", "spectral moment: mean square slope of a profile"),
    (
        "m4",
        "1/m^2",
        "spectral moment: mean square curvature of a profile",
    ),
    ("nayak", "", "Nayak number m0 m4 / m2^2"),
    (
        "summit_density",
        "1/m^2",
        "of a Gaussian surface with these moments",
    ),
    (
        "summit_radius",
        "m",
        "1 / mean curvature of the summits, of a Gaussian surface with these moments",
    ),
    (
        "correlation_length",
        "m",
        "where the autocorrelation falls to 1/e",
    ),
    ("Sa", "m", "ISO 25178: mean distance from the mean height"),
    ("Sq", "m", "ISO 25178: rms height"),
    ("Sz", "m", "ISO 25178: from the lowest to the highest point"),
    ("Ssk", "", "ISO 25178: skewness of the heights"),
    ("Sku", "", "ISO 25178: kurtosis of the heights, 3 if normal"),
    ("psd_longest", "m", "longest wave whose density is reliable"),
    ("psd_shortest", "m", "shortest such wave: four pixels"),
];
/// Classes of the distribution of heights.
const CLASSES: usize = 64;
/// Pixels of the shortest wave whose density sampling does not change.
const RELIABLE_PIXELS: f64 = 4.0;

/// What is known of a surface.
pub(super) struct Report<'a> {
    pub source: &'a Path,
    pub surface: &'a Surface,
    pub boundary: Boundary,
    pub statistics: Statistics,
    /// Distance and mean product of heights.
    pub correlation: Vec<(f64, f64)>,
    pub rings: Vec<SpectrumRing>,
    pub fit: Result<SelfAffineFit, BandFitError>,
    /// Whether the edges of the map were brought to its mean.
    pub is_windowed: bool,
}

impl<'a> Report<'a> {
    /// Everything about a surface that came from `source`.
    pub fn new(source: &'a Path, surface: &'a Surface, boundary: Boundary) -> Self {
        let (grid, heights) = (&surface.grid, &surface.heights);
        Report {
            source,
            surface,
            boundary,
            statistics: surface.statistics(boundary),
            correlation: autocorrelation(grid, heights, boundary),
            rings: radial_spectrum(grid, heights, boundary),
            fit: fit(grid, heights, boundary),
            is_windowed: false,
        }
    }

    /// Everything, for standard output.
    pub fn text(&self) -> String {
        let mut text = String::new();
        let mut line = |words: String| {
            // Nothing that a text cannot take.
            let _ = writeln!(text, "{}", format!("# {words}").trim_end());
        };
        line(self.title());
        if self.is_windowed {
            // Of a side of which two eighths fall as sin^2, 27/32 of the mean square are left.
            let sides =
                [self.surface.grid.nx, self.surface.grid.ny].map(|count| i32::from(count > 1));
            let left = (27.0_f64 / 32.0).powi(sides.iter().sum()).sqrt();
            line(format!(
                "after --edges window, which leaves some {:.0} % of the map's own rms height and slope, here and in scene.toml",
                100.0 * left
            ));
        }
        line(String::new());
        line(row("quantity", "value", "unit", "what it is"));
        for ((name, unit, what), value) in QUANTITIES.into_iter().zip(self.values()) {
            let value = match value {
                Some(count) if name.starts_with(COUNT) => count.to_string(),
                value => value.map_or_else(|| "-".to_owned(), number),
            };
            line(row(name, &value, unit, what));
        }
        line(String::new());
        line(format!(
            "power spectral density C, averaged over directions; <h^2> is its integral over all wavevectors{}",
            match self.boundary {
                Boundary::Periodic => "",
                Boundary::Free => "; under a Hann window",
            }
        ));
        line(row("wavenumber [1/m]", "C [m^4]", "modes", "fit [m^4]"));
        for ring in &self.rings {
            let fitted = self.fitted(ring.wavenumber).map(number);
            line(row(
                &number(ring.wavenumber),
                &number(ring.density),
                &ring.modes.to_string(),
                &fitted.unwrap_or_default(),
            ));
        }
        line(String::new());
        for words in self.verdict() {
            line(words);
        }
        text.push_str(&self.tables().unwrap_or_default());
        text
    }

    /// What the pictures are headed with.
    pub fn title(&self) -> String {
        let name = self.source.file_name().unwrap_or(self.source.as_os_str());
        // A name may hold a line end, which would end the comment.
        let name: String = name
            .to_string_lossy()
            .chars()
            .map(|c| if c.is_control() { ' ' } else { c })
            .collect();
        format!("Surface of {name}")
    }

    /// The numbers of [`QUANTITIES`].
    fn values(&self) -> [Option<f64>; COUNTED] {
        let grid = &self.surface.grid;
        let found = &self.statistics;
        let moments = &found.moments;
        let along = found.along_a_profile(grid);
        let found_heights = HeightParameters::new(&self.surface.heights);
        let [longest, shortest] = self.reliable();
        [
            Some(grid.nx as f64),
            Some(grid.ny as f64),
            Some(grid.lx),
            Some(grid.ly),
            Some(grid.dx()),
            Some(grid.dy()),
            Some(found.mean),
            Some(found.lowest),
            Some(found.highest),
            Some(moments.rms_height()),
            Some(moments.rms_slope()),
            Some(moments.rms_curvature()),
            Some(along.m0),
            Some(along.m2),
            Some(along.m4),
            along.nayak(),
            along.summit_density(),
            along.mean_summit_radius(),
            length_of(&self.correlation),
            Some(found_heights.mean_deviation),
            Some(found_heights.rms_height),
            Some(found_heights.range),
            found_heights.skewness,
            found_heights.kurtosis,
            Some(longest),
            Some(shortest),
        ]
    }

    /// What the fit found, or why there is none.
    fn verdict(&self) -> Vec<String> {
        let fit = match &self.fit {
            Ok(fit) => fit,
            Err(error) => return vec![format!("no self-affine fit: {error}")],
        };
        let factor = fit.factor();
        let mut lines = vec![if !fit.is_close() {
            format!(
                "the surface is not self-affine: the density of the fit is off the rings' by a factor of {factor:.0e} (rms)"
            )
        } else {
            format!(
                "self-affine fit: its density lies within {:.0} % of the rings' (rms)",
                100.0 * (factor - 1.0)
            )
        }];
        if !fit.rolloff_seen {
            lines.push("no roll-off is seen: rolloff is the longest wave".to_owned());
        }
        if !fit.cutoff_seen {
            lines.push(
                "no cut-off is seen: shortest is the shortest wave that the pixels hold".to_owned(),
            );
        }
        if !fit.hurst_inside {
            lines.push("the Hurst exponent lies at the end of its range: the spectrum is no self-affine one".to_owned());
        }
        lines.push(String::new());
        lines
    }

    /// `[grid]` and `[[surface]]` of a scene with a surface like this.
    fn tables(&self) -> Option<String> {
        let fit = self.fit.as_ref().ok()?;
        let grid = &self.surface.grid;
        let spectrum = &fit.spectrum;
        let wavelength = |wavenumber: f64| 2.0 * std::f64::consts::PI / wavenumber;
        // Exactly the size where it is, or the scene would ask for a wave longer than the grid.
        let side = grid.lx.max(grid.ly);
        let exact = |length: f64| {
            if (length / side - 1.0).abs() < 1e-9 {
                side
            } else {
                rounded(length)
            }
        };
        let shortest = rounded(wavelength(spectrum.short));
        let ([nx, ny], coarse) = resolving([grid.nx, grid.ny], [grid.lx, grid.ly], shortest);
        Some(format!(
            "{coarse}[grid]\npoints = [{nx}, {ny}]\nsize = [{:e}, {:e}]\nboundary = \"periodic\"\n\n\
             [[surface]]\nkind = \"self-affine\"\nhurst = {}\nrms_height = {:e}\nlongest = {:e}\n\
             rolloff = {:e}\nshortest = {:e}\nseed = 1\n",
            grid.lx,
            grid.ly,
            (spectrum.hurst * 1e4).round() / 1e4,
            // The heights' own: that of the fit follows the rings only on average.
            rounded(self.statistics.moments.rms_height()),
            exact(wavelength(spectrum.long)),
            exact(wavelength(spectrum.rolloff)),
            shortest,
        ))
    }

    /// The whole of a scene: the tables, with a solid and a load to be replaced.
    pub fn scene(&self) -> Option<String> {
        Some(format!(
            "# A self-affine surface like that of {}: `tabor check` takes it as it is,\n\
             # but solid and load are stand-ins. Put yours in their place.\n\n{}\n\
             [solid]\ncontact_modulus = \"1 GPa\"\n\n\
             [loading]\ncontrol = \"pressure\"\npath = [\"1 MPa\", \"10 MPa\"]\n",
            self.title().trim_start_matches("Surface of "),
            self.tables()?
        ))
    }

    /// The radial spectrum as CSV.
    pub fn table(&self) -> String {
        let mut text = csv_line(["wavenumber [1/m]", "density [m^4]", "modes", "fit [m^4]"]);
        for ring in &self.rings {
            text += &csv_line([
                csv_number(Some(ring.wavenumber)),
                csv_number(Some(ring.density)),
                ring.modes.to_string(),
                csv_number(self.fitted(ring.wavenumber)),
            ]);
        }
        text
    }

    /// Density of the fit, within its band.
    fn fitted(&self, wavenumber: f64) -> Option<f64> {
        let spectrum = &self.fit.as_ref().ok()?.spectrum;
        let band = spectrum.long * (1.0 - 1e-9)..=spectrum.short * (1.0 + 1e-9);
        band.contains(&wavenumber)
            .then(|| spectrum.density(wavenumber))
    }

    /// The radial spectrum and its fit as a plot.
    pub fn spectrum(&self) -> Figure {
        let points = |points: &mut dyn Iterator<Item = [f64; 2]>| -> Vec<PlotPoint> {
            points.map(|[x, y]| PlotPoint::new(x, y)).collect()
        };
        let mut rings = self
            .rings
            .iter()
            .map(|ring| [ring.wavenumber, ring.density]);
        let rings = points(&mut rings);
        let fit = points(&mut self.fit_line().into_iter());
        // The first pen is that of models.
        let mut names = vec!["", "map, averaged over directions"];
        names.extend((!fit.is_empty()).then_some("self-affine fit"));
        Figure {
            title: self.title(),
            names: names.into_iter().map(str::to_owned).collect(),
            panels: vec![Panel {
                title: "power spectral density (m^4)".to_owned(),
                x: Axis::logarithmic("wave number (1/m)", ""),
                y: Axis::logarithmic("density", ""),
                series: vec![Series::marks(1, rings), Series::line(2, fit)],
            }],
            style: LARGE,
            ..Figure::default()
        }
    }

    /// Longest and shortest wavelength whose density is that of the surface: a window smears the first modes of a
    /// patch, and sampling folds waves of a few pixels back.
    fn reliable(&self) -> [f64; 2] {
        let grid = &self.surface.grid;
        let [x, y] = grid.varying([grid.lx, grid.ly]);
        let longest = match self.boundary {
            Boundary::Periodic => x.max(y),
            Boundary::Free => 0.5 * x.min(y),
        };
        [longest, RELIABLE_PIXELS * grid.longer_pixel()]
    }

    /// Distribution of heights, autocorrelation, and slope and curvature by distance: names, tables, and a figure.
    pub fn distributions(&self) -> ([(&'static str, String); 3], Figure) {
        let (grid, heights) = (&self.surface.grid, &self.surface.heights);
        let classes = distribution(heights, CLASSES);
        let whole = self
            .correlation
            .first()
            .map_or(f64::NAN, |(_, whole)| *whole);
        let correlation = self.correlation.iter();
        let correlation: Vec<[f64; 2]> = correlation
            .map(|(distance, product)| [*distance, product / whole])
            .collect();
        let scales = scale_dependence(grid, heights, self.boundary);
        let table = |head: &[&str], rows: Vec<Vec<Option<f64>>>| {
            let rows = rows
                .into_iter()
                .map(|row| csv_line(row.into_iter().map(csv_number)));
            csv_line(head.iter().copied()) + &rows.collect::<String>()
        };
        let pairs = |pairs: &[[f64; 2]]| pairs.iter().map(|pair| pair.map(Some).to_vec()).collect();
        let tables = [
            (
                "distribution.csv",
                table(&["height [m]", "density [1/m]"], pairs(&classes)),
            ),
            (
                "autocorrelation.csv",
                table(&["distance [m]", "autocorrelation"], pairs(&correlation)),
            ),
            (
                "scales.csv",
                table(
                    &["distance [m]", "slope", "curvature [1/m]"],
                    scales
                        .iter()
                        .map(|at| vec![Some(at.distance), Some(at.slope), at.curvature])
                        .collect(),
                ),
            ),
        ];
        let points =
            |pairs: &[[f64; 2]]| pairs.iter().map(|[x, y]| PlotPoint::new(*x, *y)).collect();
        let slopes: Vec<[f64; 2]> = scales.iter().map(|at| [at.distance, at.slope]).collect();
        let curvatures = scales
            .iter()
            .filter_map(|at| Some([at.distance, at.curvature?]));
        let curvatures: Vec<[f64; 2]> = curvatures.collect();
        let panel = |title: &str, x: Axis, y: Axis, values: &[[f64; 2]]| Panel {
            title: title.to_owned(),
            x,
            y,
            series: vec![Series::marked_line(1, points(values))],
        };
        let figure = Figure {
            title: self.title(),
            panels: vec![
                panel(
                    "distribution of heights (1/m)",
                    Axis::linear("height", "m"),
                    Axis::linear("density", ""),
                    &classes,
                ),
                panel(
                    "autocorrelation",
                    Axis::linear("distance", "m"),
                    Axis::linear("autocorrelation", ""),
                    &correlation,
                ),
                panel(
                    "rms slope over a distance along x",
                    Axis::logarithmic("distance (m)", ""),
                    Axis::logarithmic("slope", ""),
                    &slopes,
                ),
                panel(
                    "rms curvature over a distance along x (1/m)",
                    Axis::logarithmic("distance (m)", ""),
                    Axis::logarithmic("curvature", ""),
                    &curvatures,
                ),
            ],
            ..Figure::default()
        };
        (tables, figure)
    }

    /// The fit within its band.
    fn fit_line(&self) -> Vec<[f64; 2]> {
        let Ok(fit) = &self.fit else {
            return Vec::new();
        };
        let spectrum = &fit.spectrum;
        let ratio = spectrum.short / spectrum.long;
        (0..=LINE_POINTS)
            .map(|step| spectrum.long * ratio.powf(step as f64 / LINE_POINTS as f64))
            .map(|wavenumber| [wavenumber, spectrum.density(wavenumber)])
            .collect()
    }
}

/// Points of a scene that resolve the shortest wave, at least those of the map, and a comment where that would take
/// too many.
fn resolving(points: [usize; 2], size: [f64; 2], shortest: f64) -> ([usize; 2], String) {
    let needed = |side: f64| (PIXELS_A_WAVE * side / shortest).ceil() as usize;
    let enough = |axis: usize| {
        let needed = good_size(needed(size[axis]));
        needed.min(MOST_POINTS).max(points[axis])
    };
    let found = [enough(0), enough(1)];
    let pixels = (0..2).map(|axis| shortest * found[axis] as f64 / size[axis]);
    let pixels = pixels.fold(f64::INFINITY, f64::min);
    let comment = if pixels < PIXELS_A_WAVE {
        format!(
            "# The shortest wave has {pixels:.1} pixels, and a run warns of fewer than {PIXELS_A_WAVE}: that would take {} x {} points.\n",
            needed(size[0]),
            needed(size[1])
        )
    } else {
        String::new()
    };
    (found, comment)
}

/// A row of a table of four columns.
fn row(name: &str, value: &str, unit: &str, what: &str) -> String {
    format!("{name:<20} {value:<14} {unit:<6} {what}")
}

/// A number with six digits; `-` for NaN and infinity.
fn number(value: f64) -> String {
    if value.is_finite() {
        format!("{value:.5e}")
    } else {
        "-".to_owned()
    }
}

/// The nearest number with six digits.
fn rounded(value: f64) -> f64 {
    // The digits of a finite number are a number.
    format!("{value:.5e}").parse().unwrap_or(value)
}
