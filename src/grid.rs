//! The grid: points, sizes, wavevectors, and the order in which fields are stored.
//!
//! A field is row-major with shape `[ny, nx]`: point (ix, iy) is element `iy * nx + ix`, lies at `x
//! = ix dx`, `y = iy dy`, and represents the pixel around it. A half-plane spectrum has the
//! wavevectors `kx = 0 ..= nx/2` and all of `ky`; the forward transform is unscaled and the inverse
//! divides by the number of points.

use std::f64::consts::PI;

/// Longest side of a field in a picture, pixels.
pub(crate) const LONGEST_DRAWN: u32 = 1780;
/// Least longer side of a drawn field, pixels: smaller grids are enlarged by a whole factor.
const ENLARGED: f64 = 512.0;

/// A regular grid of `nx` by `ny` points over `lx` by `ly` metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Points along x.
    pub nx: usize,
    /// Points along y.
    pub ny: usize,
    /// Length along x, m.
    pub lx: f64,
    /// Length along y, m.
    pub ly: f64,
}

/// What lies beyond the edge of the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Boundary {
    /// The cell repeats.
    Periodic,
    /// One isolated contact on an unbounded half-space.
    Free,
}

impl Boundary {
    /// Every one of them.
    pub const ALL: &[Boundary] = &[Boundary::Periodic, Boundary::Free];

    /// The word used in scenes.
    pub fn name(self) -> &'static str {
        match self {
            Boundary::Periodic => "periodic",
            Boundary::Free => "free",
        }
    }
}

impl Grid {
    /// A grid of `points` = (nx, ny) over `size` = (lx, ly) in metres.
    pub fn new(points: [usize; 2], size: [f64; 2]) -> Self {
        Grid {
            nx: points[0],
            ny: points[1],
            lx: size[0],
            ly: size[1],
        }
    }

    /// Points along x and y.
    pub fn points(&self) -> [usize; 2] {
        [self.nx, self.ny]
    }

    /// Lengths along x and y, m.
    pub fn size(&self) -> [f64; 2] {
        [self.lx, self.ly]
    }

    /// Number of points, nx times ny.
    pub fn len(&self) -> usize {
        self.nx * self.ny
    }

    /// Whether the grid has no points.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Pixel length along x, m.
    pub fn dx(&self) -> f64 {
        self.lx / self.nx as f64
    }

    /// Pixel length along y, m.
    pub fn dy(&self) -> f64 {
        self.ly / self.ny as f64
    }

    /// The longer side of a pixel, m, which bounds what the grid resolves. Along an axis of one point nothing varies, so that
    /// the length of its pixel does not count.
    pub fn longer_pixel(&self) -> f64 {
        let [x, y] = self.varying([self.dx(), self.dy()]);
        x.max(y)
    }

    /// Pixels along x and y of a picture of this grid, its longer side at most `limit`; square on the surface.
    ///
    /// For dx = dy a point becomes a whole number of pixels, or a pixel a whole number of points
    /// (except for a remainder that is spread evenly).
    pub(crate) fn drawn_size(&self, limit: u32) -> [u32; 2] {
        let finest = self.dx().min(self.dy());
        let points = self.lx.max(self.ly) / finest;
        let pixel = if points <= f64::from(limit) {
            // Enlarging must not exceed the limit either, for a grid slightly below half of it.
            let factor = (ENLARGED / points).ceil().max(1.0);
            let fitting = (f64::from(limit) / points).floor().max(1.0);
            finest / factor.min(fitting)
        } else {
            finest * (points / f64::from(limit)).ceil()
        };
        let pixels = |length: f64| ((length / pixel).round() as u32).clamp(1, limit);
        [pixels(self.lx), pixels(self.ly)]
    }

    /// Lengths along x and y, of which that along an axis of one point is the other one, too.
    pub(crate) fn varying(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        match [self.nx, self.ny] {
            [1, ny] if ny > 1 => [y, y],
            [nx, 1] if nx > 1 => [x, x],
            _ => [x, y],
        }
    }

    /// Area of one pixel, m^2.
    pub fn pixel_area(&self) -> f64 {
        self.dx() * self.dy()
    }

    /// Nominal area, m^2.
    pub fn area(&self) -> f64 {
        self.lx * self.ly
    }

    /// Signed wave number along x of column `kx` of a full spectrum, 1/m.
    #[inline]
    pub fn wavenumber_x(&self, kx: usize) -> f64 {
        2.0 * PI / self.lx * signed_index(kx, self.nx) as f64
    }

    /// Signed wave number along y of row `ky` of a spectrum, 1/m.
    #[inline]
    pub fn wavenumber_y(&self, ky: usize) -> f64 {
        2.0 * PI / self.ly * signed_index(ky, self.ny) as f64
    }

    /// Length of the wavevector (kx, ky), 1/m.
    #[inline]
    pub fn wavenumber(&self, kx: usize, ky: usize) -> f64 {
        self.wavenumber_x(kx).hypot(self.wavenumber_y(ky))
    }
}

/// Signed index of a discrete frequency: `k` for `k <= n/2`, `k - n` above.
#[inline]
pub fn signed_index(k: usize, n: usize) -> i64 {
    if k <= n / 2 {
        k as i64
    } else {
        k as i64 - n as i64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_keeps_the_shape_of_the_surface() {
        let drawn = |points, size| Grid::new(points, size).drawn_size(1800);
        assert_eq!(drawn([8, 8], [1.0, 1.0]), [512, 512]);
        assert_eq!(drawn([300, 150], [2.0, 1.0]), [600, 300]);
        assert_eq!(drawn([1024, 1024], [1.0, 1.0]), [1024, 1024]);
        assert_eq!(drawn([2048, 2048], [1.0, 1.0]), [1024, 1024]);
        assert_eq!(drawn([4096, 2048], [2.0, 1.0]), [1365, 683]);
        assert_eq!(drawn([512, 512], [2.0, 1.0]), [1024, 512]);
        assert_eq!(drawn([1024, 1], [1.0, 1.0 / 1024.0]), [1024, 1]);
        assert_eq!(drawn([1, 1], [1.0, 1.0]), [512, 512]);
        assert_eq!(drawn([1000, 2], [1.0, 1.0]), [1000, 1000]);
    }

    #[test]
    fn wavenumbers_are_signed_and_scaled() {
        let grid = Grid::new([8, 5], [2.0, 1.0]);
        assert_eq!(grid.dx(), 0.25);
        assert_eq!(grid.wavenumber_x(4), 4.0 * PI);
        assert_eq!(grid.wavenumber_x(7), -PI);
        assert_eq!(grid.wavenumber_y(2), 4.0 * PI);
        assert_eq!(grid.wavenumber_y(3), -4.0 * PI);
        assert_eq!(grid.wavenumber(7, 0), PI);
    }

    #[test]
    fn an_axis_of_one_point_has_no_part_in_the_resolution() {
        let pixel = |points| Grid::new(points, [2.0, 3.0]).longer_pixel();
        assert_eq!(pixel([4, 4]), 0.75);
        assert_eq!(pixel([4, 1]), 0.5);
        assert_eq!(pixel([1, 4]), 0.75);
        assert_eq!(pixel([1, 1]), 3.0);
    }
}
