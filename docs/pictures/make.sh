#!/bin/sh
# Makes the pictures of this folder: runs each scene and keeps one picture of it.
# From the root of the repository: sh docs/pictures/make.sh
set -e
cargo build --release
tabor=${CARGO_TARGET_DIR:-target}/release/tabor
out=$(mktemp -d)
keep() { # scene, step and field, name here, more of the call
    [ -d "$out/$1" ] || "$tabor" run "examples/scenes/$1.toml" --out "$out/$1" --quiet $4
    cp "$out/$1/images/step_$2.png" "docs/pictures/$3.png"
}
keep rough 0009_pressure rough_pressure
keep sphere_pull_off 0045_pressure sphere_pull_off
keep ground 0021_pressure ground
keep ground 0021_heights ground_heights
keep wave 0005_pressure wave
keep lennard_jones_sphere 0041_pressure lennard_jones_sphere
keep cantilever 0041_pressure cantilever
keep dmt 0004_pressure dmt
keep coating 0018_pressure coating
keep striped 0015_pressure striped
keep viscoelastic 0026_pressure viscoelastic
keep yielding 0003_pressure yielding
keep joint 0004_pressure joint
keep seal 0005_gap seal
keep fast_pull_off 0018_pressure fast_pull_off
keep humid_tip 0011_pressure humid_tip
keep patterned_punch 0055_pressure patterned_punch
# On fewer points than the scene has, for a small picture.
keep contact_challenge 0001_pressure contact_challenge "--set grid.points=512"
for w in 50 20; do
    "$tabor" run examples/scenes/sphere_pull_off.toml --out "$out/$w mJ per m^2" --quiet --set "adhesion.work_of_adhesion=$w mJ/m^2"
done
"$tabor" plot "$out/50 mJ per m^2" "$out/20 mJ per m^2" --out "$out/two_runs.png"
cp "$out/two_runs.png" docs/pictures/
"$tabor" sweep examples/studies/roughness.toml --out "$out/roughness" --quiet
cp "$out/roughness/means.png" docs/pictures/sweep_roughness.png
rm -r "$out"
