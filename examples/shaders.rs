//! Writes the assembled WGSL of every kernel into a folder, to be read:
//! `cargo run --release --example shaders -- shaders_out`. Tests keep copies of some and show what a change makes
//! of them.

use std::error::Error;
use std::fs;
use std::path::Path;

use tabor::backend::gpu::source::representative;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).ok_or("the folder to write into")?;
    let folder = Path::new(&folder);
    fs::create_dir_all(folder)?;
    // What is no longer written must not stay.
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path
            .extension()
            .is_some_and(|extension| extension == "wgsl")
        {
            fs::remove_file(path)?;
        }
    }
    for (name, text) in representative()? {
        fs::write(folder.join(format!("{name}.wgsl")), text)?;
    }
    Ok(())
}
