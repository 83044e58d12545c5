"""Messages about a contact name arguments as Python writes them, never a line or a table of a scene file."""

import pickle
import re
import warnings

import numpy as np
import pytest

import tabor
from tabor import Exponential, LennardJones, MaugisDugdale, SelfAffine, Sphere, Wavy

ROUGH = tabor.self_affine(32, "4 um", rms_slope=0.1, shortest="1 um")
LAW = MaugisDugdale("50 mJ/m^2", range="20 nm")
STRIPES = {"pattern": "stripe", "period": "4 um", "low": 0, "high": 1}
RELAXING = {"relaxation": [{"modulus": "1 MPa", "time": "1 s"}]}
RATE = {"reference_speed": "1 um/s", "exponent": 1}
#: What only a scene file has: a table's head, a key with its value, a dotted key, options, a line.
OF_FILES = re.compile(r'\[\[|\[[a-z]+\]|\b\w+ = ["\[{]|(?<!")\b(solid|solver|grid|surface)\.|--\w|scene: |scene file|\.toml|:\d+: |\ba table\b')


def contact(heights=ROUGH, **more):
    return tabor.Contact(heights, "4 um", **{"contact_modulus": "100 MPa"} | more)


def parts(*more, **other):
    return contact(more[0] if len(more) == 1 else list(more), points=32, **other)


def loading(**keys):
    return contact(loading={"control": "pressure", **keys})


MISTAKES = [
    (lambda: contact(contact_modulus=-1), "contact_modulus: -1 is out of range; it must be finite and above 0"),
    (lambda: contact(contact_modulus=None), 'contact_modulus: missing; add for example `contact_modulus="1.33 TPa"`'),
    (lambda: contact(hardness="1 nm"), 'hardness: "nm" is a length in m; give a pressure in Pa'),
    (lambda: contact(young_modulus=1e9), "young_modulus: contact_modulus is given too"),
    (lambda: tabor.Contact(ROUGH, (4e-6, None), contact_modulus=1e8), "size[1]: a number, a text, a list or a mapping is expected"),
    (lambda: contact(thickness="1 um", poisson_ratio=0.3, boundary="free"), 'thickness: a layer needs boundary="periodic"'),
    (lambda: contact(hardness="1 GPa", precision="mixed"), 'hardness: a hardness in mixed precision is not in this version; take precision="single"'),
    (lambda: contact(hardness="1 GPa", law=LennardJones(0.05, 2e-8)), "hardness: .*; take MaugisDugdale or Exponential, or leave the hardness out"),
    (lambda: contact(relaxation="x"), '.*write for example `relaxation=[{"modulus": "1 MPa", "time": "10 ms"}]`'),
    (lambda: contact(relaxation=[{"modulus": 1e6}]), 'relaxation[0]["time"]: missing; add for example `time="10 ms"`'),
    (lambda: contact(**RELAXING, law=LAW, treatment="dmt"), 'treatment: treatment="dmt" on a viscoelastic solid .*, or leave relaxation out'),
    (lambda: contact(law=MaugisDugdale("50 mJ/m^2")), 'MaugisDugdale.range: missing; add for example `range="1 nm"` or `peak_tension="50 MPa"`'),
    (lambda: contact(law=Exponential("50 mJ", 1e-8)), 'Exponential.work_of_adhesion: "mJ" is an energy in J'),
    (lambda: contact(law=MaugisDugdale(0.05, "auto", 1.0)), 'MaugisDugdale.peak_tension: range="auto" follows from the grid'),
    (lambda: contact(law=LAW, treatment="dtm"), 'treatment: "dtm" is not one of "full", "dmt"'),
    (lambda: contact(law=LAW, rate=3), 'rate: the number 3 where a mapping is expected; write for example `rate={"reference_speed": "1 um/s", "exponent": 0.5}`'),
    (lambda: contact(law=LennardJones(0.05, 2e-8), rate=RATE), "rate: multiplies .* with LennardJones also the repulsion"),
    (lambda: contact(law=LAW, adhesion_map={"pattern": "checker"}), 'adhesion_map["period"]: missing'),
    (lambda: contact(law=LAW, adhesion_map=STRIPES | {"high": 0}), 'adhesion_map["high"]: is 0 like low, so nothing attracts; leave the law out'),
    (lambda: contact(law=LAW, adhesion_map=STRIPES | {"period": 2e-7}).solve(pressure=1), "adhesion_map pattern: .* is shorter than two pixels"),
    (lambda: contact(law=LAW, adhesion_map=np.ones((3, 3))).solve(pressure=1), "adhesion_map array: "),
    (lambda: contact(law=LAW, adhesion_map="none.npy"), "adhesion_map: none.npy: there is no such file"),
    (lambda: contact(spring=1).solve(pressure=1), "spring: a spring needs a prescribed far end; take approach, or leave the spring out"),
    (lambda: contact(tolerance=1e-12, precision="single"), 'tolerance: 1e-12 is out of range; .*for precision="single"'),
    (lambda: contact(max_iterations=True), "max_iterations: True where a whole number is expected; write for example `max_iterations=5000`"),
    (lambda: contact(backend="cuda"), 'backend: "cuda" is not one of "auto", "cpu", "gpu"'),
    (lambda: contact(solid={"hardnes": 1}), 'solid["hardnes"]: unknown key in solid; did you mean `hardness`?'),
    (lambda: contact(solid={"plastic": 1}), 'solid["plastic"]: unknown key'),
    (lambda: contact(plastic={}), "plastic: plasticity is not in this version; leave it out"),
    (lambda: contact(hardnes=1), "hardnes: unknown argument of a contact; did you mean hardness?"),
    (lambda: contact(fricton={}), "fricton: unknown argument of a contact; did you mean friction?"),
    (lambda: contact(zzz=1), "zzz: unknown argument of a contact; it takes"),
    (lambda: contact(grid={}), "grid: a contact takes size, points and boundary"),
    (lambda: contact(solver={"tolerance": 1e-3}), "solver: a contact takes tolerance, max_iterations, precision and backend"),
    (lambda: contact(adhesion={}), "adhesion: a contact takes law"),
    (lambda: loading(path=["1 N"]), 'loading["path"][0]: "N" is a force in N'),
    (lambda: loading(start=0, ramp=[{"to": 1}]), 'loading["ramp"][0]["steps"]: missing; add for example `steps=10`'),
    (lambda: loading(start=0, ramp=3), 'loading["ramp"]: the number 3 where a list of mappings is expected'),
    (lambda: contact(**RELAXING, loading={"control": "pressure", "path": [1]}), 'loading["path"]: a viscoelastic solid needs durations; give start and ramp'),
    (lambda: contact(friction=3), "friction: the number 3 where a mapping is expected"),
    (lambda: contact(friction={}), 'friction["shear_strength"]: missing'),
    (lambda: contact(capillary={"humidity": 0.5}, law=LAW), "capillary: a law is given too"),
    (lambda: contact(output={"fields": ["presure"]}), 'output["fields"][0]: "presure" is not one of'),
    (lambda: parts(Sphere(-1)), "Sphere.radius: -1 is out of range"),
    (lambda: parts(tabor.Flat(), Sphere("1 Pa")), 'heights[1].radius: "Pa" is a pressure'),
    (lambda: parts(tabor.Flat(), {"kind": "sphere"}), 'heights[1]["radius"]: missing'),
    (lambda: parts({"kind": "sphere", "radus": 1}), 'heights["radus"]: unknown key in a part of kind sphere; did you mean `radius`?'),
    (lambda: parts(tabor.HeightFile("map.npy", detrnd=1)), "HeightFile.detrnd: unknown key in a part of kind file; did you mean `detrend`?"),
    (lambda: parts(Wavy(1e-9, "0.1 um")).solve(pressure=1), "Wavy: .* is shorter than two pixels"),
    (lambda: tabor.Contact(tabor.Flat(), "1 um", points=2**18, contact_modulus=1e8).solve(pressure=1), "points=[262144, 262144] is not possible"),
    (lambda: contact(__file__).solve(pressure=1), "heights: "),
    (lambda: contact(__file__).check(), "heights: "),
    # Loads of a path, of a contact and of tables.
    (lambda: contact().solve(mean_gap=-1), "mean_gap: -1.0 is out of range; it must be finite and at least 0"),
    (lambda: contact().solve(force=1e50), "force: 1e50 is out of range"),
    (lambda: contact(boundary="free").solve(pressure=1), 'pressure: a free boundary .*; take force or approach, or boundary="periodic"'),
    (lambda: contact(hardness="1 MPa").solve(pressure="2 MPa"), "hardness: the path has a mean pressure of 2 MPa"),
    (lambda: contact(hardness="1 MPa").solve(mean_gap=0), "hardness: mean_gap does not determine .*; take approach"),
    (lambda: list(contact(**RELAXING).path(pressure=[1, 2])), "seconds: a viscoelastic solid needs durations; give seconds, the time that each load but the first takes"),
    (lambda: list(contact(law=LAW, rate=RATE).path(pressure=[1e6, 2e6])), "seconds: rate-dependent adhesion needs durations; give seconds"),
    (lambda: list(contact(**RELAXING).path(pressure=[1e6, 2e6], seconds=-1)), "seconds: -1 is out of range"),
    # Functions that make surfaces.
    (lambda: tabor.heights([tabor.Flat(), Sphere(-1)], 32, 1.0), "parts[1].radius: -1 is out of range"),
    (lambda: tabor.heights(tabor.Flat(), 32, 1.0, boundary="open"), 'boundary: "open" is not one of'),
    (lambda: tabor.self_affine(32, 1.0, rms_slope=-1, shortest=0.1), "rms_slope: -1 is out of range"),
    (lambda: tabor.self_affine(32, 1.0, rms_slope=0.1, shortest=0.1, seed=-1), "seed: -1 is out of range"),
    (lambda: tabor.statistics([[1e200, 0], [0, 1]], 1.0), "heights: the largest height is 1e200 m; heights must be 0 or between 1e-30 and 1e30 m"),
    (lambda: tabor.statistics([[1, 0], [0, 1]], 1e-40), "size: "),
    (lambda: tabor.read_heights(__file__, unit="N"), 'unit: "N" is a force'),
    (lambda: tabor.read_heights("none.npy"), "path: .*none.npy: there is no such file"),
    # Studies, which the command line makes of files that are written for them.
    (lambda: tabor.compare(contact(boundary="free"), "folder"), 'boundary="free" is one isolated contact: '),
    (lambda: tabor.accuracy(contact(law=LAW), "folder", budget=-1), "budget: must be more than zero"),
    (lambda: tabor.sweep({"scene": parts(Sphere("1 um"))}, "folder"), "study: there is no axis"),
    (lambda: tabor.sweep({"scene": parts(Sphere("1 um")), "vary": 1}, "folder"), "study: not a study: unknown field `vary`"),
    (lambda: tabor.sweep({}, "folder", jobs=0), "jobs: a count from 1 to 1024 is expected, not 0"),
    (lambda: tabor.sweep({}, "folder", share=(3, 2)), "share: (i, n) is expected"),
]  # fmt: skip


@pytest.mark.parametrize(("call", "words"), MISTAKES)
def test_mistakes_name_the_argument(call, words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(tabor.TaborError) as raised:
        call()
    said = str(raised.value)
    assert re.match(".*".join(re.escape(each) for each in words.split(".*")), said)
    assert not OF_FILES.search(said), said


WARNINGS = [
    (lambda: contact(law=MaugisDugdale("50 J/m^2", "1 nm", taper=0)).solve(pressure=1e6), '(range="auto" finds'),
    (lambda: parts(SelfAffine(rms_slope=0.1, shortest=1e-8)).heights(), "SelfAffine: the grid is too coarse"),
    (lambda: parts(*2 * [SelfAffine(rms_slope=0.1, shortest=1e-6)]).heights(), "heights[1] has the seed of heights[0]"),
    (lambda: tabor.self_affine(32, 1.0, rms_slope=0.1, shortest=0.01), "self_affine: the grid is too coarse"),
]


@pytest.mark.parametrize(("call", "words"), WARNINGS)
def test_warnings_name_the_argument(call, words):
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        call()
    [said] = [str(each.message) for each in told if words in str(each.message)]
    assert not OF_FILES.search(said), said


def test_keys_of_tables_and_lines_of_files_stay(tmp_path):
    tables = {
        "grid": {"points": 8, "size": "1 um"},
        "solid": {"contact_modulus": "1 GPa"},
        "surface": [{"kind": "sphere", "radius": "1 um"}],
        "loading": {"control": "pressure", "path": ["1 MPa"]},
    }
    with pytest.raises(tabor.SceneError, match=r"^surface\.0\.radius: -1 is out of range"):
        tabor.Scene(tables | {"surface": [{"kind": "sphere", "radius": -1}]})
    scene = tabor.Scene(tables)
    with pytest.raises(tabor.SceneError, match=r"^mean_gap: -1\.0 is out of range"):
        scene.solve(mean_gap=-1)
    with pytest.raises(tabor.SceneError, match=r'^overrides\["grid\.pionts"\]: unknown key'):
        tabor.compare(scene, tmp_path / "compare", overrides={"grid.pionts": 8})
    path = tmp_path / "scene.toml"
    path.write_text(scene.to_toml().replace("1 GPa", "1 nm"))
    with pytest.raises(tabor.SceneError, match=r"scene\.toml:\d+: solid\.contact_modulus: "):
        tabor.Scene.read(path)


def test_words_stay_in_another_process():
    again = pickle.loads(pickle.dumps(contact(law=LennardJones("50 mJ/m^2", "20 nm"))))
    with pytest.raises(tabor.SceneError, match="^mean_gap: a mean gap must stay above"):
        again.solve(mean_gap=-1)
