#!/bin/sh
# Makes the pictures of this folder: runs each scene and keeps one picture of it.
# From the root of the repository: sh docs/pictures/make.sh
set -e
cargo build --release
tabor=${CARGO_TARGET_DIR:-target}/release/tabor
out=$(mktemp -d)
keep() { # scene, step and field, name here
    [ -d "$out/$1" ] || "$tabor" run "examples/scenes/$1.toml" --out "$out/$1" --quiet
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
keep coating 0016_pressure coating
keep humid_tip 0011_pressure humid_tip
rm -r "$out"
