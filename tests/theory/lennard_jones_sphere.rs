//! The panels of the Lennard-Jones sphere.

use tabor::theory::lennard_jones_sphere::LennardJonesSphere;

#[test]
fn finer_panels_leave_the_folds_in_place() {
    let mu = 0.8;
    let coarse = LennardJonesSphere::new(mu, 0.0).unwrap();
    let fine = LennardJonesSphere::with_panels(mu, 0.15, 4.0);
    let folds = |sphere: &LennardJonesSphere| sphere.folds().unwrap().unwrap();
    let (first, second) = (folds(&coarse), folds(&fine));
    for (one, other) in [(first.0, second.0), (first.1, second.1)] {
        assert!((one.approach - other.approach).abs() < 1e-7);
        // The position along the curve is known to 1e-9, but the panels change it by more.
        assert!((one.force - other.force).abs() < 1e-5);
    }
}

#[test]
fn finer_panels_change_nothing() {
    for mu in [0.1, 0.5] {
        let coarse = LennardJonesSphere::new(mu, 1.0).unwrap();
        let width = (0.15 * f64::powf(mu, -1.5)).min(0.2);
        let fine = LennardJonesSphere::with_panels(mu, width, 5.0);
        for approach in [-1.0, 0.5] {
            let first = coarse.at_approach(approach).unwrap().force;
            let second = fine.at_approach(approach).unwrap().force;
            assert!(
                (first - second).abs() < 1e-7,
                "{mu} {approach}: {first} {second}"
            );
        }
    }
}
