//! What a surface is where it touches first, as far as its parts say.

use std::f64::consts::PI;

use crate::scene::SurfacePart;

/// The highest place of a surface of known shape.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Top {
    /// Summits of roughness, parts of different shape, flats, or heights of which no shape is known.
    #[default]
    Unknown,
    /// The apex of a sphere or of several spheres about one centre, which are one: of this radius, m.
    Sphere(f64),
    /// Round crests of waves along both axes; their radius, m, is the geometric mean of those along x and y.
    Crests(f64),
    /// Straight crests of waves along one axis.
    Ridges {
        /// Radius of a crest, m.
        radius: f64,
        /// The axis of the waves: 0 along x, 1 along y.
        axis: usize,
    },
    /// The apex of a cone.
    Cone {
        /// Angle between axis and flank, rad.
        half_angle: f64,
        /// Apex (x, y), m; `None` is the middle of the points.
        centre: Option<[f64; 2]>,
    },
}

impl Top {
    /// That of the sum of parts.
    pub fn from_parts(parts: &[SurfacePart]) -> Top {
        let mut shaped = parts
            .iter()
            .filter(|part| !matches!(part, SurfacePart::Flat));
        let alone = match shaped.next() {
            Some(SurfacePart::Sphere { radius, centre }) => {
                let mut curvature = 1.0 / radius;
                for part in shaped {
                    match part {
                        SurfacePart::Sphere {
                            radius,
                            centre: other,
                        } if other == centre => curvature += 1.0 / radius,
                        _ => return Top::Unknown,
                    }
                }
                return Top::Sphere(1.0 / curvature);
            }
            first => first,
        };
        match (alone, shaped.next()) {
            (Some(SurfacePart::Cone { half_angle, centre }), None) => Top::Cone {
                half_angle: *half_angle,
                centre: *centre,
            },
            (
                Some(SurfacePart::Wavy {
                    amplitude,
                    wavelength,
                }),
                None,
            ) => crests(*amplitude, *wavelength),
            _ => Top::Unknown,
        }
    }

    /// Radius, m, of a sphere.
    pub fn sphere_radius(self) -> Option<f64> {
        match self {
            Top::Sphere(radius) => Some(radius),
            _ => None,
        }
    }
}

/// Crests of a product of cosines, each of curvature `amplitude k^2` along its axis.
fn crests(amplitude: f64, wavelength: [f64; 2]) -> Top {
    let radius = |length: f64| (length / (2.0 * PI)).powi(2) / amplitude.abs();
    let ridges = |axis: usize| Top::Ridges {
        radius: radius(wavelength[axis]),
        axis,
    };
    match wavelength.map(f64::is_finite) {
        [true, true] => Top::Crests((radius(wavelength[0]) * radius(wavelength[1])).sqrt()),
        [true, false] => ridges(0),
        [false, true] => ridges(1),
        [false, false] => Top::Unknown,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn shapes_by_their_parts() {
        let sphere = |radius: f64, centre| SurfacePart::Sphere { radius, centre };
        let wave = |wavelength| SurfacePart::Wavy {
            amplitude: 2.0,
            wavelength,
        };
        let cone = SurfacePart::Cone {
            half_angle: 1.2,
            centre: None,
        };
        assert_eq!(Top::from_parts(&[sphere(2.0, None)]), Top::Sphere(2.0));
        let both = [sphere(2.0, None), SurfacePart::Flat, sphere(2.0, None)];
        assert_eq!(Top::from_parts(&both), Top::Sphere(1.0));
        let apart = [sphere(2.0, None), sphere(2.0, Some([0.0, 1.0]))];
        assert_eq!(Top::from_parts(&apart), Top::Unknown);
        let apex = Top::Cone {
            half_angle: 1.2,
            centre: None,
        };
        assert_eq!(Top::from_parts(&[SurfacePart::Flat, cone.clone()]), apex);
        assert_eq!(Top::from_parts(&[cone.clone(), cone]), Top::Unknown);
        assert_eq!(Top::from_parts(&[SurfacePart::Flat]), Top::Unknown);
        // k = 1 and 2: curvatures 2 and 8.
        let Top::Crests(radius) = Top::from_parts(&[wave([2.0 * PI, PI])]) else {
            panic!("crests");
        };
        assert_relative_eq!(radius, 0.25, max_relative = 1e-14);
        for (along, wavelength) in [[PI, f64::INFINITY], [f64::INFINITY, PI]]
            .into_iter()
            .enumerate()
        {
            let Top::Ridges { radius, axis } = Top::from_parts(&[wave(wavelength)]) else {
                panic!("ridges");
            };
            assert_eq!(axis, along);
            assert_relative_eq!(radius, 0.125, max_relative = 1e-14);
        }
    }
}
