//! The claims of one sphere, T1 and T2.

use tabor::theory::dmt::{self, Method};
use tabor::theory::lennard_jones_sphere::LennardJonesSphere;
use tabor::theory::{Law, bradley, derjaguin};

use super::claims::Found;

/// T1: what each DMT theory attracts with.
pub fn one_sphere() -> Found {
    let at = |method, law, radius: f64| dmt::attraction(method, law, radius);
    let (mut apart, mut falls) = (0.0_f64, true);
    let mut before = [2.0; 2];
    for i in 0..60 {
        let radius = 0.05 * f64::from(i);
        let both = [
            at(Method::Thermodynamic, Law::Cubic, radius)?,
            at(Method::Thermodynamic, Law::LennardJones, radius)?,
        ];
        falls &= both[0] < before[0] && both[1] < before[1];
        apart = apart.max((both[0] - both[1]).abs());
        before = both;
    }
    let far = at(Method::Thermodynamic, Law::LennardJones, 300.0)?;
    let force = at(Method::Force, Law::LennardJones, 200.0)?;
    let holds = falls && apart <= 0.037 && (far - 0.5).abs() < 0.02 && force > 20.0;
    Ok((
        format!(
            "{apart:.4} apart; {far:.2} at a contact of 300, DMT-F {force:.0} at 200 sqrt(R eps)"
        ),
        holds,
    ))
}

const TABOR: f64 = 0.2;

/// T2: the order of the forces, and how far each is from the self-consistent sphere.
pub fn pressed_sphere() -> Found {
    let sphere = LennardJonesSphere::new(TABOR, 2.0)?;
    let mut ordered = true;
    let (mut constant, mut energy) = ((f64::MAX, 0.0_f64), (f64::MAX, 0.0_f64));
    for approach in [0.5, 1.0, 2.0] {
        let force = |method, law| dmt::force(method, law, approach, TABOR);
        let falling = [
            derjaguin::reduced_force(approach, TABOR)?,
            force(Method::Thermodynamic, Law::Cubic)?,
            force(Method::Thermodynamic, Law::LennardJones)?,
            force(Method::Constant, Law::LennardJones)?,
            force(Method::Force, Law::LennardJones)?,
        ];
        ordered &= falling.windows(2).all(|pair| pair[0] > pair[1]);
        let judge = sphere.at_approach(approach)?.force;
        let miss = (falling[3] - judge).abs();
        constant = (constant.0.min(miss), constant.1.max(miss));
        for value in &falling[1..3] {
            let miss = (value - judge).abs();
            energy = (energy.0.min(miss), energy.1.max(miss));
        }
    }
    // To the last digit of the claim.
    let holds =
        ordered && constant.0 > 0.006 && constant.1 < 0.205 && energy.0 > 0.195 && energy.1 < 0.605;
    Ok((
        format!(
            "{}; {:.4} to {:.2}, {:.2} to {:.2}",
            if ordered {
                "so ordered"
            } else {
                "not so ordered"
            },
            constant.0,
            constant.1,
            energy.0,
            energy.1
        ),
        holds,
    ))
}

/// T2: pull-off, and the rigid sphere before contact.
pub fn free_sphere() -> Found {
    let sphere = LennardJonesSphere::new(TABOR, 2.0)?;
    let pull_off = sphere.pull_off()?;
    let mut less = Vec::new();
    for gap in [0.25, 0.5, 1.0, 2.0] {
        let rigid = bradley::reduced_force(Law::LennardJones, gap);
        less.push(100.0 * (1.0 - rigid / sphere.at_approach(-gap)?.force));
    }
    let near = less
        .iter()
        .zip([14.0, 14.0, 5.0, 1.0])
        .all(|(found, asked)| (found - asked).abs() < 0.6);
    let holds = near && pull_off.approach < 0.0 && (-1.0..-0.75).contains(&pull_off.force);
    Ok((
        format!(
            "{:.3} at {:.2} eps; {:.1}, {:.1}, {:.1}, {:.1} %",
            -pull_off.force, pull_off.approach, less[0], less[1], less[2], less[3]
        ),
        holds,
    ))
}
