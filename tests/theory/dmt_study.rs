//! The claims of the DMT study (Violano, Demelio & Afferrante 2018), with its numbers, and the models
//! of a rough contact judged by the full field of the same surface.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

#[path = "../../examples/dmt_study/claims.rs"]
mod claims;
#[path = "../../examples/dmt_study/rows.rs"]
mod rows;
#[path = "../../examples/dmt_study/sphere_claims.rs"]
mod sphere_claims;

use rows::{Case, MODULUS, RANGE, Row, Sample, WORK};
use tabor::theory::dmt::{self, Method};
use tabor::theory::lennard_jones_sphere::LennardJonesSphere;
use tabor::theory::pastewka_robbins::{Edge, stickiness_ratio};
use tabor::theory::persson::Persson;
use tabor::theory::{Law, bradley, derjaguin, gw_m, jkr};

const TABLE: &str = include_str!("../../docs/dmt_study.csv");

fn table() -> Vec<Row> {
    rows::read(TABLE).expect("the committed table is whole")
}

fn of<'a>(table: &'a [Row], model: &str, case: Case) -> Vec<&'a Row> {
    table
        .iter()
        .filter(|row| row.model == model && row.case == case)
        .collect()
}

fn case(hurst: f64, ratio: usize, seed: u64) -> Case {
    Case { hurst, ratio, seed }
}

/// T1: what each DMT theory attracts with.
#[test]
fn t1_attraction_of_one_sphere() {
    let at = |method, law, radius| dmt::attraction(method, law, radius).expect("a number");
    let energy = |law, radius| at(Method::Thermodynamic, law, radius);
    let force = |radius| at(Method::Force, Law::LennardJones, radius);
    let radii: Vec<f64> = (0..60).map(|i| 0.05 * f64::from(i)).collect();
    for law in [Law::Cubic, Law::LennardJones] {
        assert!((energy(law, 0.0) - 1.0).abs() < 1e-9);
        assert!(
            radii
                .windows(2)
                .all(|r| energy(law, r[1]) < energy(law, r[0]))
        );
        // The excess over one half falls like a^(-2/3).
        assert!((energy(law, 300.0) - 0.5).abs() < 0.02);
    }
    let apart = |r: &f64| (energy(Law::LennardJones, *r) - energy(Law::Cubic, *r)).abs();
    let most = radii.iter().map(apart).fold(0.0, f64::max);
    assert!((0.035..0.037).contains(&most), "{most}");
    assert!((force(0.0) - 1.0).abs() < 1e-9);
    assert!(radii.windows(2).all(|r| force(r[1]) > force(r[0])));
    assert!(force(200.0) > 20.0, "grows without bound, as 0.743 a^(2/3)");
    assert_eq!(at(Method::Constant, Law::LennardJones, 2.0), 1.0);
}

/// T2: forces of a sphere of Tabor number 0.2.
#[test]
fn t2_force_of_one_sphere() {
    let mu = 0.2;
    for approach in [0.25, 0.5, 1.0, 2.0] {
        let force = |method, law| dmt::force(method, law, approach, mu).expect("a number");
        let falling = [
            derjaguin::reduced_force(approach, mu).expect("a number"),
            force(Method::Thermodynamic, Law::Cubic),
            force(Method::Thermodynamic, Law::LennardJones),
            force(Method::Constant, Law::LennardJones),
            force(Method::Force, Law::LennardJones),
        ];
        assert!(
            falling.windows(2).all(|pair| pair[0] > pair[1]),
            "{falling:?}"
        );
    }
    // Largest tension of JKR: 3/4 of 2 pi w R.
    assert!((0.5 * jkr::reduced_force(jkr::pull_off()) + 0.75).abs() < 1e-12);
    let whole = LennardJonesSphere::new(mu, 2.0).expect("a sphere");
    let force = |approach| whole.at_approach(approach).expect("a state").force;
    // The energy methods overestimate the force, the constant is nearest to it.
    for approach in [0.5, 1.0, 2.0] {
        let miss = |method, law| {
            dmt::force(method, law, approach, mu).expect("a number") - force(approach)
        };
        let constant = miss(Method::Constant, Law::LennardJones).abs();
        assert!((0.006..0.205).contains(&constant), "{approach}: {constant}");
        for law in [Law::Cubic, Law::LennardJones] {
            let energy = miss(Method::Thermodynamic, law);
            assert!(
                energy > constant && (0.2..0.6).contains(&energy),
                "{approach}: {energy}"
            );
        }
    }
    // Its pull-off lies between JKR's and 2 pi w R, before contact; the rigid sphere pulls less.
    let pull_off = whole.pull_off().expect("a state");
    assert!(pull_off.approach < 0.0 && (-1.0..-0.75).contains(&pull_off.force));
    for (approach, less) in [(-0.25, 0.14), (-0.5, 0.14), (-1.0, 0.05), (-2.0, 0.01)] {
        let rigid = bradley::reduced_force(Law::LennardJones, -approach);
        let found = 1.0 - rigid / force(approach);
        assert!((found - less).abs() < 0.006, "{approach}: {found}");
    }
}

/// T3: H = 0.8, N = 32 by the theories; without adhesion, and with it.
#[test]
fn t3_area_and_load() {
    let theory = Persson::new(rows::GAMMA).expect("a factor");
    let kappa = |load: f64| theory.area_fraction(load).expect("a number") / load;
    assert!((kappa(0.01) - 2.25).abs() < 0.01 && (kappa(0.1) - 2.09).abs() < 0.01);
    let contact = rows::persson(0.8, 32).expect("a contact");
    let unit = MODULUS * contact.spectrum().rms_slope();
    let pull_off = contact.pull_off(&rows::ADHESION).expect("a pull-off");
    let area = |net: f64| {
        let repulsive = contact.repulsive_pressure(&rows::ADHESION, &pull_off, net * unit);
        contact
            .area_fraction(repulsive.expect("a load"))
            .expect("an area")
    };
    assert!((area(0.0) - 0.13635).abs() < 1e-3, "{}", area(0.0));
    let summits = |work| rows::summits(contact.spectrum(), work).expect("summits");
    let gw = |work| {
        let summits = summits(work);
        let separation = gw_m::separation(&summits, 0.02 * unit).expect("a separation");
        summits.contact_area_fraction(separation)
    };
    let hard = theory.area_fraction(0.02).expect("a number");
    assert!(
        (gw(0.0) / hard - 1.0 + 0.27).abs() < 0.01,
        "{}",
        gw(0.0) / hard
    );
    assert!((gw(WORK) / area(0.02) - 1.0 - 0.13).abs() < 0.01);
    let small = pull_off.tension / gw_m::pull_off(&summits(WORK)).expect("a pull-off");
    assert!((small - 3.5).abs() < 0.05, "{small}");
}

/// Each claim with its numbers, and the docs' table of them, which `dmt_study draw` prints. What does not
/// hold is how far finite boxes lie above Persson, on the roughest of the nine surfaces: `t6_finite_boxes`.
#[test]
fn every_claim_but_t6_of_finite_boxes_holds_and_the_docs_say_so() {
    let claims = claims::claims(&table()).expect("numbers");
    let lines = claims::text(&claims);
    let failed: Vec<&str> = claims
        .iter()
        .filter(|claim| !claim.holds)
        .map(|claim| claim.name)
        .collect();
    assert_eq!(failed, ["T6b", "T6c"], "{lines}");
    let docs = include_str!("../../docs/dmt_study.md");
    for line in lines.lines() {
        assert!(docs.contains(line), "docs/dmt_study.md misses\n{line}");
    }
}

/// T3 on all surfaces of the table, of which the study shows H = 0.8, N = 32: asperities against Persson
/// without adhesion, below 30 % in contact; kappa below 10 %. Found numbers, rounded outwards.
#[test]
fn t3_asperities_and_persson() {
    let table = table();
    let theory = Persson::new(rows::GAMMA).expect("a factor");
    let mut count = 0;
    for row in table.iter().filter(|row| row.area < 0.3) {
        let (most, kappas) = match (row.model.as_str(), row.case.hurst, row.case.ratio) {
            // Beyond 0.05 E* h' merged circles go on to merge: up to 36 % too much area.
            ("icha", 0.8, 64) => (0.4, 1.65..2.35),
            ("icha", ..) => (0.25, 1.65..2.36),
            // Steadily low.
            ("icha-displaced", ..) => (0.31, 1.5..2.1),
            _ => continue,
        };
        let judge = theory.area_fraction(row.repulsive).expect("a number");
        let miss = (row.area / judge - 1.0).abs();
        assert!(miss < most, "{row:?}: {miss}");
        let kappa = row.area / row.repulsive;
        assert!(row.area >= 0.1 || kappas.contains(&kappa), "{row:?}");
        count += 1;
    }
    assert!(count >= 450, "{count}");
}

/// T6 on the surfaces of the table: the study has finite boxes 10 to 25 % above Persson's pull-off.
/// The full field here, means over three seeds, lies 12 to 34 % above: more than claimed at H = 0.4 for
/// N = 32 and 64.
#[test]
fn t6_finite_boxes() {
    let table = table();
    for ratio in [16, 32, 64] {
        for hurst in [0.8, 0.6, 0.4] {
            let pull_off =
                |model, seed| rows::pull_off(&of(&table, model, case(hurst, ratio, seed)));
            let field = [1, 2, 3]
                .map(|seed| pull_off("field", seed))
                .iter()
                .sum::<f64>()
                / 3.0;
            let above = field / pull_off("persson", 0) - 1.0;
            let most = match (hurst, ratio) {
                (0.4, 32) => 0.28,
                (0.4, 64) => 0.34,
                _ => 0.25,
            };
            assert!((0.12..most).contains(&above), "{hurst} {ratio}: {above}");
        }
    }
}

/// Why the field lies above Persson, at H = 0.4, N = 64: at the load of pull-off his attraction is 15 to 20 %
/// below the field's, at the same mean gap (by straight lines between rows) 1 to 5 %. What he misses is
/// the mean gap under a light load, not the distribution of gaps about it.
#[test]
fn persson_misses_the_gap_rather_than_its_distribution() {
    let table = table();
    let theory = of(&table, "persson", case(0.4, 64, 0));
    for seed in 1..=3 {
        let field = of(&table, "field", case(0.4, 64, seed));
        let light = theory[1].attraction / field[1].attraction - 1.0;
        assert!((-0.2..-0.15).contains(&light), "{seed}: {light}");
        let mut count = 0;
        for row in &theory {
            let around = field
                .windows(2)
                .find(|pair| pair[1].gap <= row.gap && row.gap <= pair[0].gap);
            let Some([wide, close]) = around else {
                continue;
            };
            let share = (row.gap - close.gap) / (wide.gap - close.gap);
            let attraction = close.attraction + share * (wide.attraction - close.attraction);
            let miss = row.attraction / attraction - 1.0;
            assert!((-0.05..-0.01).contains(&miss), "{seed}: {row:?} {miss}");
            count += 1;
        }
        assert!(count >= 10, "{count}");
    }
}

/// Persson's area at a net load of 0.02 E* h', with adhesion.
fn area_at_two_hundredths(hurst: f64, ratio: usize) -> f64 {
    let contact = rows::persson(hurst, ratio).expect("a contact");
    let unit = MODULUS * contact.spectrum().rms_slope();
    let pull_off = contact.pull_off(&rows::ADHESION).expect("a pull-off");
    let repulsive = contact.repulsive_pressure(&rows::ADHESION, &pull_off, 0.02 * unit);
    contact
        .area_fraction(repulsive.expect("a load"))
        .expect("an area")
}

/// T4 and T5: with adhesion area rises with H and falls with N. Values to 0.3 %, as the source of
/// these numbers states them.
#[test]
fn t4_t5_area_by_hurst_exponent_and_band() {
    for (hurst, ratio, area) in [
        (0.4, 64, 0.09274),
        (0.8, 64, 0.15621),
        (0.8, 32, 0.17426),
        (0.8, 16, 0.19579),
    ] {
        let found = area_at_two_hundredths(hurst, ratio);
        assert!(
            (found / area - 1.0).abs() < 3e-3,
            "{hurst} {ratio}: {found}"
        );
    }
    let middle = area_at_two_hundredths(0.6, 64);
    assert!(0.09274 < middle && middle < 0.15621, "{middle}");
}

/// Persson's pull-off in w/range, the Fuller-Tabor parameter, and GW-M's pull-off, found once a surface.
fn pull_offs(hurst: f64, ratio: usize) -> [f64; 3] {
    static FOUND: Mutex<BTreeMap<(u64, usize), [f64; 3]>> = Mutex::new(BTreeMap::new());
    let mut found = FOUND.lock().unwrap_or_else(PoisonError::into_inner);
    *found
        .entry((hurst.to_bits(), ratio))
        .or_insert_with(|| pull_offs_of(hurst, ratio))
}

fn pull_offs_of(hurst: f64, ratio: usize) -> [f64; 3] {
    let contact = rows::persson(hurst, ratio).expect("a contact");
    let summits = rows::summits(contact.spectrum(), WORK).expect("summits");
    [
        contact
            .pull_off(&rows::ADHESION)
            .expect("a pull-off")
            .tension
            * RANGE
            / WORK,
        summits.adhesion_parameter().expect("a parameter"),
        gw_m::pull_off(&summits).expect("a pull-off") * RANGE / WORK,
    ]
}

/// T6: pull-off against the Fuller-Tabor parameter.
#[test]
fn t6_pull_off() {
    let all = |hurst| [16, 32, 64].map(|ratio| pull_offs(hurst, ratio));
    for (hurst, spread) in [(0.8, 0.025), (0.4, 0.17)] {
        let found = all(hurst);
        let [first, _, last] = found.map(|values| values[0]);
        assert!(
            (0.0..=spread).contains(&(1.0 - last / first)),
            "{hurst}: {first} {last}"
        );
        assert!(
            found
                .windows(2)
                .all(|pair| pair[1][1] > pair[0][1] && pair[1][0] < pair[0][0])
        );
    }
    for ratio in 0..3 {
        let falling = [0.8, 0.6, 0.4].map(|hurst| all(hurst)[ratio][0]);
        assert!(
            falling.windows(2).all(|pair| pair[0] > pair[1]),
            "{falling:?}"
        );
    }
    let [persson, theta, summits] = pull_offs(0.8, 16);
    assert!((theta / 5.280271 - 1.0).abs() < 1e-6 && (summits - 0.177488).abs() < 1e-6);
    assert!((1.9..2.1).contains(&(persson / summits)));
    let [persson, theta, summits] = pull_offs(0.4, 64);
    assert!((theta / 23.282988 - 1.0).abs() < 1e-6 && persson / summits > 1000.0);
}

/// T8: the criterion of Pastewka & Robbins triples where Persson's pull-off loses 30 %.
#[test]
fn t8_stickiness() {
    let ratio = |hurst, ratio| {
        let spectrum = rows::spectrum(hurst, ratio).expect("a spectrum");
        stickiness_ratio(&Edge {
            rms_slope: spectrum.rms_slope(),
            rms_curvature: spectrum.rms_curvature(),
            work_of_adhesion: WORK,
            contact_modulus: MODULUS,
            range: RANGE,
            area_coefficient: 2.0,
        })
        .expect("a ratio")
    };
    assert!((ratio(0.8, 16) - 1.04).abs() < 0.005 && ratio(0.4, 64) > 3.0);
    let loss = 1.0 - pull_offs(0.4, 64)[0] / pull_offs(0.8, 16)[0];
    assert!((loss - 0.30).abs() < 0.01, "{loss}");
}

/// The committed table is what its command writes: N = 16 again, one seed of each Hurst exponent
/// whole, to the digits that are kept and the tolerance of the solver.
#[test]
fn the_table_of_n_16_is_computed_again() {
    let table = table();
    for (hurst, seed) in [(0.8, 1), (0.6, 2), (0.4, 3)] {
        let case = case(hurst, 16, seed);
        let sample = Sample::new(case).expect("a surface");
        let slope = Sample::slope(hurst, 16).expect("a slope");
        assert!((sample.unit / (MODULUS * slope) - 1.0).abs() < 1e-9);
        let mut fresh = rows::field_rows(case, &sample).expect("rows");
        fresh.extend(rows::icha_rows(case, &sample).expect("rows"));
        fresh.extend(rows::theory_rows(hurst, 16).expect("rows"));
        // To the digits that the table keeps.
        let text = format!("{}\n{}", rows::HEADER, rows::lines(&fresh));
        let fresh = rows::read(&text).expect("rows");
        for model in ["field", "icha", "icha-displaced", "persson", "gw-m"] {
            let seed = if matches!(model, "field" | "icha" | "icha-displaced") {
                seed
            } else {
                0
            };
            let kept = of(&table, model, Case { seed, ..case });
            let fresh: Vec<&Row> = fresh.iter().filter(|row| row.model == model).collect();
            assert_eq!(kept.len(), fresh.len(), "{case:?} {model}");
            for (kept, fresh) in kept.iter().zip(fresh) {
                let close = |a: f64, b: f64, what: &str| {
                    assert!(
                        (a / b - 1.0).abs() < 1e-4,
                        "{case:?} {model} {what}: {a} {b}"
                    );
                };
                close(kept.repulsive, fresh.repulsive, "load");
                close(kept.area, fresh.area, "area");
                close(kept.gap, fresh.gap, "gap");
                close(kept.attraction, fresh.attraction, "attraction");
            }
        }
    }
}

/// By how much each model misses the full field of the same surfaces, over all of the table: the
/// bounds that `docs/dmt_study.md` states.
#[test]
fn misses_of_the_models_stay_within_the_stated_bounds() {
    let table = table();
    let mut cases: Vec<Case> = table
        .iter()
        .map(|row| row.case)
        .filter(|case| case.seed > 0)
        .collect();
    cases.dedup();
    assert!(cases.len() >= 27, "{}", cases.len());
    for case in cases {
        let theory = Case { seed: 0, ..case };
        let field = of(&table, "field", case);
        let judge = rows::pull_off(&field);
        for (model, of_case, area, pull_off) in [
            ("icha", case, ICHA_AREA, ICHA_PULL_OFF),
            ("icha-displaced", case, DISPLACED_AREA, DISPLACED_PULL_OFF),
            ("persson", theory, PERSSON_AREA, PERSSON_PULL_OFF),
            ("gw-m", theory, GW_AREA, GW_PULL_OFF),
        ] {
            let rows = of(&table, model, of_case);
            assert!(rows.len() >= 13, "{case:?} {model}");
            let off = rows::pull_off(&rows) / judge - 1.0;
            assert!(
                (pull_off[0]..=pull_off[1]).contains(&off),
                "{case:?} {model} pull-off: {off}"
            );
            for (row, judge) in rows
                .iter()
                .zip(&field)
                .filter(|(row, _)| row.repulsive <= 0.05)
            {
                let off = row.area / judge.area - 1.0;
                let load = row.repulsive;
                assert!(
                    (area[0]..=area[1]).contains(&off),
                    "{case:?} {model} at {load}: {off}"
                );
            }
        }
    }
}

/// Least and greatest misses over all surfaces, seeds and loads up to 0.05 E* h', rounded outwards.
const ICHA_AREA: [f64; 2] = [-0.17, 0.17];
const ICHA_PULL_OFF: [f64; 2] = [0.0, 0.06];
const DISPLACED_AREA: [f64; 2] = [-0.24, 0.0];
const DISPLACED_PULL_OFF: [f64; 2] = [0.0, 0.04];
const PERSSON_AREA: [f64; 2] = [-0.05, 0.13];
const PERSSON_PULL_OFF: [f64; 2] = [-0.27, -0.08];
const GW_AREA: [f64; 2] = [-0.37, 0.14];
// Below -1: none of the table's loads leaves a tension.
const GW_PULL_OFF: [f64; 2] = [-1.13, -0.53];
