use std::path::PathBuf;
use tabor::backend::{Backend, cpu::{CpuBackend, with_threads}};
use tabor::scene::*;
use tabor::study::*;
struct Print { q: bool }
impl Observer for Print {
    type Error = ();
    fn step(&mut self, s: FinishedStep) -> Result<(), ()> {
        let r = s.row;
        println!("{:3} app {:9.4} gap {:9.4} F {:10.5} A {:.4} att {:.4} it {:4} res {:.1e} {} {} {:?} {:.2}s", r.step, r.approach.unwrap_or(f64::NAN), r.mean_gap.unwrap_or(f64::NAN), r.force / (2.0*std::f64::consts::PI), r.contact_area_fraction, r.attractive_area_fraction, r.iterations, r.residual, r.converged, r.state.name(), s.jump, r.seconds);
        Ok(())
    }
    fn iteration(&mut self, _: usize, s: &tabor::kernel::Scalars) -> bool { if self.q { println!("   {} {:.3e} a={:.3} t={:.3} lost {} stalls {} {:?} c={:.2e} sy={:.2e}", s.iterations, s.residual, s.trial, s.step, s.lost, s.stalls, s.status, s.curvature, s.slope); } true }
}
fn main() {
    // vertical eps=1, R=1 -> lateral sqrt(R eps)=1; w=1: mu^3 = 1/E^2 => E = mu^-1.5
    let args: Vec<String> = std::env::args().collect();
    let law = args[1].as_str();
    let mu: f64 = args[2].parse().unwrap();
    let n: usize = args[3].parse().unwrap();
    let half: f64 = args[4].parse().unwrap();
    let (a, b, steps): (f64, f64, usize) = (args[5].parse().unwrap(), args[6].parse().unwrap(), args[7].parse().unwrap());
    let boundary = if args.get(8).map(|s| s.as_str()) == Some("periodic") { Boundary::Periodic } else { Boundary::Free };
    let mut path = vec![];
    for i in 0..=steps { path.push(a + (b - a) * i as f64 / steps as f64); }
    for i in 1..=steps { path.push(b + (a - b) * i as f64 / steps as f64); }
    let scene = Scene {
        title: None,
        grid: GridScene { points: Some([n, n]), size: Some([2.0 * half, 2.0 * half]), boundary },
        solid: SolidScene { contact_modulus: mu.powf(-1.5), poisson_ratio: None },
        surfaces: vec![SurfacePart::Sphere { radius: 1.0, centre: None }],
        adhesion: match law { "none" => None, _ => Some(AdhesionScene { law: match law { "lj" => LawName::LennardJones, "exp" => LawName::Exponential, _ => LawName::MaugisDugdale }, work_of_adhesion: 1.0, range: Range::Length(1.0), taper: if law == "sharp" { Some(0.0) } else { None }, treatment: if law == "dmt" { Treatment::Dmt } else { Treatment::Full } }) },
        loading: LoadingScene { control: if std::env::var("FORCE").is_ok() { Control::Force } else { Control::Approach }, path, spring: std::env::var("SPRING").ok().map(|s| s.parse().unwrap()) },
        solver: SolverScene { tolerance: 1e-6, max_iterations: 5000, precision: Precision::Auto, backend: BackendName::Auto },
        output: OutputScene { images: vec![], fields: vec![], steps: StepChoice::Last },
        folder: PathBuf::new(),
    };
    let surface = tabor::surface::Surface::build(&scene).unwrap();
    let setup = Setup::new(scene, surface);
    println!("{:?} {:?}", setup.regime, setup.warnings);
    with_threads(Some(2), || {
        let make = || -> Box<dyn Backend + Send> { Box::new(CpuBackend::<f64>::new()) };
        let end = walk(&setup, &make, &mut Print { q: std::env::var("V").is_ok() }).ok().unwrap();
        println!("jump in {:?} off {:?} hysteresis {:?} transforms {}", end.jump_in_steps, end.jump_off_steps, end.hysteresis_energy, end.transforms);
    }).unwrap();
}
