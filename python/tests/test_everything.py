"""Each law, boundary, control, effect, precision, backend and kind of surface from Python, beside the scene that says the same."""

import re
import struct
import zlib
from pathlib import Path

import numpy as np
import pytest

import tabor

DOCS = Path(__file__).parents[2] / "docs"
SIZE, POINTS = "4 um", 16
ROUGH = tabor.SelfAffine(hurst=0.8, rms_slope=0.1, longest="4 um", rolloff="2 um", shortest="0.6 um", seed=3)
ROUGH_TABLE = {
    "kind": "self-affine", "hurst": 0.8, "rms_slope": 0.1, "longest": "4 um", "rolloff": "2 um", "shortest": "0.6 um", "seed": 3,
}
MAUGIS = {"law": "maugis-dugdale", "work_of_adhesion": "20 mJ/m^2", "range": "60 nm"}
LAW = tabor.MaugisDugdale("20 mJ/m^2", range="60 nm")
RATE = {"reference_speed": "1 um/s", "exponent": 0.5}
PRESSURES = ["1 MPa", "3 MPa"]
FACTORS = 1 + 0.5 * np.cos(np.arange(POINTS * POINTS)).reshape(POINTS, POINTS)


def case(name, contact, scene, path=None, loading=None):
    """Arguments of a contact and of its path, and what a scene has in their place."""
    path = {"pressure": PRESSURES} if path is None else path
    loading = {"control": "pressure", "path": PRESSURES} if loading is None else loading
    return pytest.param(contact, path, {**scene, "loading": loading}, id=name)


def effect(name, **table):
    return case(name, {name: table}, {name: table})


def solid(name, **keys):
    return case(name, keys, {"solid": keys})


def law(name, law, table, **more):
    return case(name, {"law": law, **more}, {"adhesion": {**table, **more}})


CASES = [
    case("hard wall", {}, {}),
    law("Maugis-Dugdale", LAW, MAUGIS),
    law("Maugis-Dugdale, peak tension", tabor.MaugisDugdale("20 mJ/m^2", peak_tension="0.3 MPa"), {"law": "maugis-dugdale", "work_of_adhesion": "20 mJ/m^2", "peak_tension": "0.3 MPa"}),
    law("Maugis-Dugdale, range auto", tabor.MaugisDugdale("20 mJ/m^2", range="auto"), {**MAUGIS, "range": "auto"}),
    law("Maugis-Dugdale, taper", tabor.MaugisDugdale("20 mJ/m^2", range="60 nm", taper="20 nm"), {**MAUGIS, "taper": "20 nm"}),
    law("Maugis-Dugdale, sharp", tabor.MaugisDugdale("20 mJ/m^2", range="60 nm", taper=0), {**MAUGIS, "taper": 0}),
    law("Lennard-Jones", tabor.LennardJones("20 mJ/m^2", range="60 nm"), {**MAUGIS, "law": "lennard-jones"}),
    law("exponential", tabor.Exponential("20 mJ/m^2", range="60 nm"), {**MAUGIS, "law": "exponential"}),
    law("treatment full", LAW, MAUGIS, treatment="full"),
    law("treatment dmt", LAW, MAUGIS, treatment="dmt"),
    case("map of a pattern", {"law": LAW, "adhesion_map": {"pattern": "checker", "period": "2 um", "low": 0.5, "high": 1}}, {"adhesion": {**MAUGIS, "map": {"pattern": "checker", "period": "2 um", "low": 0.5, "high": 1}}}),
    case("map of an array", {"law": LAW, "adhesion_map": FACTORS}, {"adhesion": {**MAUGIS, "map": "factors.npy"}}),
    case("map of a file", {"law": LAW, "adhesion_map": "factors.npy"}, {"adhesion": {**MAUGIS, "map": "factors.npy"}}),
    case(
        "rate",
        {"law": LAW, "rate": RATE},
        {"adhesion": {**MAUGIS, "rate": RATE}},
        {"pressure": ["3 MPa", "2 MPa", "1 MPa"], "seconds": ["1 s", "1 s"]},
        {"control": "pressure", "start": "3 MPa", "ramp": [{"to": "1 MPa", "steps": 2, "duration": "2 s"}]},
    ),
    effect("capillary", humidity=0.5, surface_tension="72 mN/m", molar_volume="1.8e-5 m^3/mol", temperature="298 K", contact_angle="20 deg"),
    effect("friction", shear_strength="10 MPa"),
    effect("conductance", conductivity="400 W/(m K)", counter_conductivity="1.4 W/(m K)"),
    effect("wear", specific_wear_rate="1e-6 mm^3/(N m)"),
    effect("leakage", viscosity="1 mPa s", axis="y"),
    case("current", {"conductance": {"conductivity": 6e7, "counter_conductivity": "59.6 MS/m", "kind": "electrical"}}, {"conductance": {"conductivity": 6e7, "counter_conductivity": "59.6 MS/m", "kind": "electrical"}}),
    solid("bonded layer", contact_modulus="100 MPa", thickness="1 um", poisson_ratio=0.4, base="bonded"),
    solid("frictionless layer", contact_modulus="100 MPa", thickness="1 um", poisson_ratio=0.4, base="frictionless"),
    solid("two bodies", contact_modulus=None, young_modulus="90 MPa", poisson_ratio=0.4, counter_young_modulus="1 GPa", counter_poisson_ratio=0.3),
    solid("hardness", hardness="8 MPa"),
    case(
        "viscoelasticity",
        {"relaxation": [{"modulus": "50 MPa", "time": "1 s"}, {"modulus": 2e7, "time": 10}]},
        {"solid": {"relaxation": [{"modulus": "50 MPa", "time": "1 s"}, {"modulus": 2e7, "time": 10}]}},
        {"pressure": ["1 MPa", "2 MPa", "3 MPa", "3 MPa"], "seconds": ["1 s", 1.0, 0.5]},
        {"control": "pressure", "start": "1 MPa", "ramp": [{"to": "3 MPa", "steps": 2, "duration": "2 s"}, {"hold": "0.5 s", "steps": 1}]},
    ),
    case("force", {}, {}, {"force": ["16 uN", 4e-5]}, {"control": "force", "path": ["16 uN", 4e-5]}),
    case("approach", {}, {}, {"approach": ["40 nm", 60e-9]}, {"control": "approach", "path": ["40 nm", 60e-9]}),
    case("mean gap", {}, {}, {"mean_gap": ["60 nm", 40e-9]}, {"control": "mean-gap", "path": ["60 nm", 40e-9]}),
    case("spring", {"spring": "1 kN/m"}, {}, {"approach": ["40 nm", "60 nm"]}, {"control": "approach", "path": ["40 nm", "60 nm"], "spring": "1 kN/m"}),
    case("free boundary, force", {"boundary": "free"}, {"grid": {"boundary": "free"}}, {"force": "20 uN"}, {"control": "force", "path": ["20 uN"]}),
    case("free boundary, approach", {"boundary": "free"}, {"grid": {"boundary": "free"}}, {"approach": "50 nm"}, {"control": "approach", "path": ["50 nm"]}),
    *(case(f"precision {word}", {"precision": word, "backend": "cpu"}, {"solver": {"precision": word, "backend": "cpu"}}) for word in ("auto", "double", "mixed")),
    case("precision single", {"precision": "single", "tolerance": 1e-4}, {"solver": {"precision": "single", "tolerance": 1e-4}}),
    *(case(f"backend {word}", {"backend": word}, {"solver": {"backend": word}}) for word in ("auto", "cpu", "gpu")),
    case("tolerance", {"tolerance": 1e-9, "max_iterations": 900}, {"solver": {"tolerance": 1e-9, "max_iterations": 900}}),
    *(
        case(f"loading: {name}", {"law": LAW, "loading": loading, **more}, {"adhesion": MAUGIS, **({"solid": more} if more else {})}, {}, loading)
        for name, loading, more in [
            ("until apart", {"control": "pressure", "path": ["1 MPa", "0 Pa"], "until": "apart"}, {}),
            ("pull-off tolerance", {"control": "pressure", "path": ["1 MPa", "-1 MPa"], "pull_off_tolerance": 0.1}, {}),
            (
                "steps of its own",
                {"control": "pressure", "start": "1 MPa", "ramp": [{"to": "3 MPa", "steps": "auto", "duration": "2 s"}], "time_tolerance": 0.05},
                {"relaxation": [{"modulus": "50 MPa", "time": "1 s"}]},
            ),
        ]
    ),
]


def scene_of(tables, surface):
    """A scene of these tables over those of the plain contact."""
    whole = {
        "grid": {"points": POINTS, "size": SIZE, **tables.get("grid", {})},
        "solid": {"contact_modulus": "100 MPa", **tables.get("solid", {})},
        "surface": surface,
        "loading": {"control": "pressure", "path": PRESSURES},
    }
    return {**whole, **{name: table for name, table in tables.items() if name not in whole or name == "loading"}}


def agree(steps, others):
    """Whether all numbers of the steps are the same bits."""
    assert len(steps) == len(others) > 0
    for step, other in zip(steps, others):
        for name in ("pressure", "gap", "displacement", "heights"):
            np.testing.assert_array_equal(getattr(step, name), getattr(other, name), name)
        mine, theirs = step.numbers, other.numbers
        assert {**mine, "seconds": 0} == {**theirs, "seconds": 0}


@pytest.fixture(autouse=True)
def _in_a_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    np.save("factors.npy", FACTORS)


@pytest.mark.filterwarnings("ignore::tabor.TaborWarning")
@pytest.mark.parametrize(("contact", "path", "scene"), CASES)
def test_a_contact_is_its_scene(contact, path, scene):
    heights = tabor.heights(ROUGH, POINTS, SIZE, boundary=contact.get("boundary", "periodic"))
    arguments = {"contact_modulus": "100 MPa", "threads": 1, **contact}
    try:
        found = list(tabor.Contact(heights, SIZE, **arguments).path(**path))
    except tabor.DeviceError as error:
        assert contact.get("backend") == "gpu"
        pytest.skip(str(error))
    # The same from its parts: what the part is, the scene knows.
    parts = list(tabor.Contact(ROUGH, SIZE, points=POINTS, **arguments).path(**path))
    expected = list(tabor.Scene(scene_of(scene, [ROUGH_TABLE]), threads=1).path())
    assert all(step.converged for step in found)
    agree(parts, expected)
    agree(found, expected)


SURFACES = [
    (ROUGH, ROUGH_TABLE),
    (tabor.SelfAffine(0.7, rms_height="5 nm", shortest="1 um"), {"kind": "self-affine", "hurst": 0.7, "rms_height": "5 nm", "longest": "4 um", "rolloff": "4 um", "shortest": "1 um"}),
    (tabor.Sphere("50 um"), {"kind": "sphere", "radius": "50 um"}),
    (tabor.Sphere(5e-5, centre=("1 um", 2e-6)), {"kind": "sphere", "radius": "50 um", "centre": ["1 um", "2 um"]}),
    (tabor.Cone("89 deg"), {"kind": "cone", "half_angle": 89}),
    (tabor.Cone(1.5, centre=(2e-6, 2e-6)), {"kind": "cone", "half_angle": "1.5 rad", "centre": ["2 um", "2 um"]}),
    (tabor.Wavy("10 nm", "2 um"), {"kind": "wavy", "amplitude": "10 nm", "wavelength": "2 um"}),
    (tabor.Wavy("10 nm", ("inf", "2 um")), {"kind": "wavy", "amplitude": "10 nm", "wavelength": ["inf", "2 um"]}),
    (tabor.Flat(), {"kind": "flat"}),
    (tabor.HeightFile("map.npy", unit="nm", scale=2.0), {"kind": "file", "path": "map.npy", "unit": "nm", "scale": 2.0}),
    (tabor.HeightFile("map.npy", detrend="plane", edges="window"), {"kind": "file", "path": "map.npy", "detrend": "plane", "edges": "window"}),
    (tabor.HeightFile("holes.npy", fill="interpolate", outliers=6.0), {"kind": "file", "path": "holes.npy", "fill": "interpolate", "outliers": 6.0}),
    (tabor.HeightFile("large.npy", crop=[2, 3, 16, 16]), {"kind": "file", "path": "large.npy", "crop": [2, 3, 16, 16]}),
    (tabor.HeightFile("large.npy", resample=16), {"kind": "file", "path": "large.npy", "resample": 16}),
    (tabor.HeightFile("scan.txt", profile=True), {"kind": "file", "path": "scan.txt", "profile": True}),
    (tabor.HeightFile("grey.png", black="0 nm", white="50 nm"), {"kind": "file", "path": "grey.png", "black": "0 nm", "white": "50 nm"}),
    ([tabor.Wavy("10 nm", "2 um"), {"kind": "sphere", "radius": "50 um"}], [{"kind": "wavy", "amplitude": "10 nm", "wavelength": "2 um"}, {"kind": "sphere", "radius": "50 um"}]),
]


def write_maps():
    rough = tabor.heights(ROUGH, 24, SIZE)
    np.save("large.npy", rough)
    np.save("map.npy", rough[:16, :16])
    holes = rough[:16, :16].copy()
    holes[3, 4] = np.nan
    np.save("holes.npy", holes)
    np.savetxt("scan.txt", np.column_stack([np.arange(16) * 0.25e-6, rough[0, :16]]))
    grey = (np.arange(256).reshape(16, 16) % 251).astype(np.uint8)
    Path("grey.png").write_bytes(png(grey))


def png(grey):
    """A grey picture of 8 bits."""

    def chunk(kind, content):
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    head = struct.pack(">IIBBBBB", grey.shape[1], grey.shape[0], 8, 0, 0, 0, 0)
    rows = b"".join(b"\0" + row.tobytes() for row in grey)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


@pytest.mark.filterwarnings("ignore::tabor.TaborWarning")
@pytest.mark.parametrize(("part", "table"), SURFACES, ids=lambda value: repr(value) if not isinstance(value, (dict, list)) else "")
def test_a_surface_is_its_table(part, table):
    write_maps()
    tables = table if isinstance(table, list) else [table]
    scene = tabor.Scene(scene_of({}, tables), threads=1)
    np.testing.assert_array_equal(tabor.heights(part, POINTS, SIZE), scene.heights())
    contact = tabor.Contact(part, SIZE, points=POINTS, contact_modulus="100 MPa", threads=1)
    agree(list(contact.path(pressure=PRESSURES)), list(scene.path()))


def keys_of(page):
    """The keys of the tables on a page, each in backticks in the first column."""
    rows = re.findall(r"^\| `([a-z_]+)` \| `([^|]*)` \|", (DOCS / page).read_text(encoding="utf-8"), re.MULTILINE)
    return {key for key, _ in rows}


def used(value):
    """All keys of nested tables."""
    if isinstance(value, dict):
        return set(value) | {key for each in value.values() for key in used(each)}
    if isinstance(value, (list, tuple)):
        return {key for each in value for key in used(each)}
    return set()


def test_no_key_of_the_scene_file_is_left_out():
    reached = {"title", "images", "fields", "steps", "output", "grid", "solid", "surface", "loading", "solver", "points", "size", "contact_modulus"}
    for each in CASES:
        reached |= used(each.values[2])
    reached |= used([table for _, table in SURFACES])
    documented = keys_of("scene_file.md") | keys_of("effects.md")
    assert len(documented) > 70
    assert documented - reached == set()


def test_title_and_output_reach_the_run(tmp_path):
    contact = tabor.Contact(
        tabor.heights(ROUGH, POINTS, SIZE), SIZE, contact_modulus="100 MPa", title="Rough", output={"images": ["gap"], "fields": ["gap"], "steps": "all"},
        loading={"control": "pressure", "path": PRESSURES},
    )
    run = contact.run(tmp_path / "run")
    assert run.summary["scene"]["title"] == "Rough"
    assert run.fields == [(1, "gap"), (2, "gap")] and len([path for path in run.images if "gap" in path.name]) == 2


def test_each_command_has_its_call(tmp_path):
    """`tabor --help` against the names of the package; these are of a terminal alone."""
    shell = {"completions", "man", "help"}
    calls = {
        "new": tabor.Scene.new, "run": tabor.Scene.run, "check": tabor.Scene.check, "surface": tabor.statistics, "theory": tabor.theory.table,
        "compare": tabor.compare, "accuracy": tabor.accuracy, "fit": tabor.fit, "sweep": tabor.sweep, "plot": tabor.Run.plot,
        "devices": tabor.devices, "netcdf": tabor.Run.to_dataset,
    }
    from tabor.program import call

    help_text = call(["--help"], quiet=True)
    commands = re.findall(r"^  ([a-z]+)  ", help_text.partition("Commands:")[2], re.MULTILINE)
    assert len(commands) > 10
    assert set(commands) - shell - set(calls) == set()
