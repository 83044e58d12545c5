use std::path::PathBuf;
use tabor::backend::{Backend, cpu::{CpuBackend, with_threads}};
use tabor::law::Law;
use tabor::scene::*;
use tabor::solver::*;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let n: usize = args[1].parse().unwrap();
    let level: f64 = args[2].parse().unwrap();
    let tol: f64 = args[3].parse().unwrap();
    let threads: usize = args[4].parse().unwrap();
    let scene = Scene {
        title: None,
        grid: GridScene { points: Some([n, n]), size: Some([1.0, 1.0]), boundary: Boundary::Periodic },
        solid: SolidScene { contact_modulus: 1.0, poisson_ratio: None },
        surfaces: vec![SurfacePart::SelfAffine(SelfAffineScene { hurst: 0.8, roughness: Roughness::RmsSlope(1.0), longest: 1.0, rolloff: 0.25, shortest: 8.0 / n as f64, seed: 1 })],
        adhesion: None,
        loading: LoadingScene { control: Control::Pressure, path: vec![level], spring: None },
        solver: SolverScene { tolerance: tol, max_iterations: 5000, precision: Precision::Auto, backend: BackendName::Auto },
        output: OutputScene { images: vec![], fields: vec![], steps: StepChoice::Last },
        folder: PathBuf::new(),
    };
    let surface = tabor::surface::Surface::build(&scene).unwrap();
    let problem = Problem::new(surface.grid, Boundary::Periodic, 1.0, &surface.heights, 1.0, Law::HardWall);
    with_threads(Some(threads), || {
        let make = || -> Box<dyn Backend + Send> { Box::new(CpuBackend::<f64>::new()) };
        let clock = std::time::Instant::now();
        let mut b = make(); let mut solver = ContactSolver::new(&mut *b, &problem);
        println!("plan {:?}", clock.elapsed());
        let p = level / problem.scales.pressure;
        let load = Load { hold: Hold::Pressure(p), zero_stiffness: 0.0, zero_compliance: ContactSolver::pressure_compliance(&problem, p) };
        let cold = args.get(5).is_some();
        let mut watch = |s: &tabor::kernel::Scalars| { if s.iterations % 5 == 0 { println!("{} {:.3e} a={:.3} t={:.3}", s.iterations, s.residual, s.trial, s.step); } true };
        let start = if cold { solver.begin(&load, &Start::Cold, tol, false).unwrap(); Start::Present } else { Start::Cold };
        let outcome = solver.solve(&load, &start, tol, 5000, false, &make, &mut watch).unwrap();
        println!("{outcome:?} transforms {} {:?}", solver.transforms(), clock.elapsed());
        let gap = problem.surface_part(&solver.gap().unwrap());
        println!("contact {} mean gap/h {}", gap.iter().filter(|&&g| g == 0.0).count(), gap.iter().sum::<f64>() / gap.len() as f64 );
        // Tamaas error
        let mut p: Vec<f64> = solver.elastic_pressure().unwrap().iter().zip(&gap).map(|(&q, _)| (q + p).max(0.0)).collect();
        for (p, g) in p.iter_mut().zip(&gap) { if *g > 0.0 { *p = 0.0 } }
        let mean = p.iter().sum::<f64>() / p.len() as f64;
        let target = level / problem.scales.pressure;
        p.iter_mut().for_each(|p| *p *= target / mean);
        use rustfft::{FftPlanner, num_complex::Complex};
        let mut f: Vec<Complex<f64>> = p.iter().map(|&p| Complex::new(p, 0.0)).collect();
        let fft2 = |f: &mut Vec<Complex<f64>>, inv: bool| { let mut pl = FftPlanner::new(); let plan = if inv { pl.plan_fft_inverse(n) } else { pl.plan_fft_forward(n) };
            for _ in 0..2 { for r in f.chunks_mut(n) { plan.process(r); } let mut t = f.clone(); for i in 0..n { for j in 0..n { t[j*n+i] = f[i*n+j]; } } *f = t; } };
        fft2(&mut f, false);
        for i in 0..n { for j in 0..n { let q = problem.grid.wavenumber(j, i); let v = if q > 0.0 { 2.0 / (q * problem.scales.lateral) } else { 0.0 } / (n*n) as f64; f[i*n+j] *= v; } }
        fft2(&mut f, true);
        let g: Vec<f64> = f.iter().zip(&problem.heights).map(|(u, h)| u.re - h).collect();
        let least = g.iter().copied().fold(f64::INFINITY, f64::min);
        let e = p.iter().zip(&g).map(|(p, g)| p * (g - least)).sum::<f64>() / p.iter().sum::<f64>() / problem.rms_height();
        println!("peer error {e:.3e}");
    }).unwrap();
}
