//! Models of summits: interacting asperities of the height map, and GW-M.

use super::field::separated_pull_off;
use super::load_scan::{LoadScan, scan_loads};
use super::table::Table;
use super::{Comparison, State, Stopped};
use crate::theory::gw::Summits;
use crate::theory::icha::{Icha, MergeRule};
use crate::theory::{Sphere, gw_m};

/// Contact area up to which interacting asperities approximate the full field; beyond it most have
/// merged.
const ICHA_AREA: f64 = 0.3;
/// Repulsive pressure over E* times the rms slope under which that much of a rough surface touches, by Persson's theory. The few
/// summits of a smooth one merge there into too small an area.
const ICHA_LOAD: f64 = 0.15;
/// Share of the surface on which it overlaps outside its circles up to which its gaps stand: its mean gap is 14 % below that of the full field
/// with DMT there, its attraction 10 to 15 %, and 29 and 18 % at 0.22 (H = 0.8, ten waves a side, slope 0.05).
const ICHA_OVERLAP: f64 = 0.1;
/// Contact area up to which non-interacting summits are a valid model.
const GW_AREA: f64 = 0.05;

/// Interacting asperities, the law's traction summed over their gap field.
pub(super) fn icha(comparison: &Comparison, table: &mut Table) -> Result<(), Stopped> {
    let (setup, law) = (&comparison.setup, comparison.treated.law);
    let modulus = setup.scene.solid.contact_modulus;
    let unit = modulus * setup.statistics.moments.rms_slope();
    let surface = Icha::new(setup.surface.grid, &setup.surface.heights)?;
    let mut loading = surface.loading(MergeRule::Volume);
    let mut scan = LoadScan::default();
    // A weak attraction of stiff summits is greatest where they first touch, or before.
    let apart = separated_pull_off(&comparison.treated);
    if let (Some(gap), Some(attraction)) = (apart.mean_gap, apart.adhesive_pressure) {
        scan.add(0.0, 0.0, gap, attraction);
    }
    let largest = comparison.loads.last().copied().unwrap_or(0.0);
    let mut ended = None;
    let mut overlapping = f64::INFINITY;
    for repulsive in scan_loads(unit, largest, comparison.tension) {
        let pressed = match loading.press(repulsive / modulus) {
            Ok(pressed) => pressed,
            // The rows reached so far are kept.
            Err(error) => {
                ended = Some(error);
                break;
            }
        };
        let gap = pressed.gap(&surface);
        let attraction = gap.mean_outside(|gap| law.traction(gap));
        let area = pressed.contact_area_fraction();
        if gap.overlapping > ICHA_OVERLAP {
            overlapping = overlapping.min(repulsive);
        }
        scan.add(repulsive, area, gap.mean(), attraction);
        if scan.stays_above(largest, law.peak_tension()) {
            break;
        }
    }
    let limit = |state: &State| {
        let crowded = state.contact_area_fraction > Some(ICHA_AREA);
        let crowded = crowded.then_some("contact area above 30 %");
        let repulsive = state.mean_pressure + state.adhesive_pressure.unwrap_or(0.0);
        let pressed = repulsive > ICHA_LOAD * unit;
        let crowded = crowded.or(pressed.then_some("load above that of 30 % contact"));
        let overlaps = repulsive >= overlapping;
        let crowded =
            crowded.or(overlaps.then_some("overlap outside the contacts on more than 10 %"));
        crowded.or(comparison.beyond_dmt())
    };
    let pull_off = scan.pull_off();
    let tension = pull_off.map_or(0.0, |state| -state.mean_pressure);
    if let Some(state) = pull_off {
        table.add(state, Some(tension), limit(&state))?;
    }
    for load in comparison.carried(tension) {
        if let Some(state) = scan.at(load) {
            table.add(state, Some(tension), limit(&state))?;
        }
    }
    ended.map_or(Ok(()), |error| Err(error.into()))
}

/// Greenwood & Williamson's summits with Maugis' constant: radius 2/h'', heights and number of the
/// spectrum's moments.
pub(super) fn gw_m(comparison: &Comparison, table: &mut Table) -> Result<(), Stopped> {
    let setup = &comparison.setup;
    let moments = setup.statistics.moments;
    let missing = || Stopped::Out("the surface has no summit statistics".to_owned());
    let radius = moments.mean_radius().ok_or_else(missing)?;
    let density = moments.summit_density().ok_or_else(missing)?;
    let mean_summit = moments.mean_summit_height().ok_or_else(missing)?;
    let work = setup.law.work_of_adhesion();
    let sphere = Sphere::new(radius, setup.scene.solid.contact_modulus, work)?;
    let rms_height = moments.rms_height();
    let summits = Summits::new(sphere, density, rms_height)?;
    let state = |separation: f64| -> Result<State, Stopped> {
        let net = gw_m::pressure(&summits, separation)?;
        Ok(State {
            mean_pressure: net,
            contact_area_fraction: Some(summits.contact_area_fraction(separation)),
            // Below the mean plane the model's flat has no meaningful gap.
            mean_gap: Some(separation * rms_height + mean_summit).filter(|gap| *gap > 0.0),
            adhesive_pressure: Some(summits.pressure(separation)? - net),
        })
    };
    let limit = |state: &State| {
        let crowded = state.contact_area_fraction > Some(GW_AREA);
        let crowded = crowded.then_some("contact area above 5 %");
        crowded.or(comparison.beyond_dmt())
    };
    let mut tension = 0.0;
    if work > 0.0 {
        let theta = summits.adhesion_parameter()?;
        let reduced = gw_m::reduced_pull_off(theta)?;
        let at = state(reduced.0)?;
        tension = gw_m::pull_off(&summits)?;
        if tension > 0.0 {
            table.add(at, Some(tension), limit(&at))?;
        }
    }
    for load in comparison.carried(tension) {
        let mut at = state(gw_m::separation(&summits, load)?)?;
        at.mean_pressure = load;
        table.add(at, Some(tension), limit(&at))?;
    }
    Ok(())
}
