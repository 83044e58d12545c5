"""Scenes, folders of runs, studies, and the program."""

import os
import re
import signal
import subprocess
import sys
import time
import warnings
from pathlib import Path

import numpy as np
import pytest

import tabor

SCENE = {
    "grid": {"points": 32, "size": "4 um"},
    "solid": {"contact_modulus": "100 MPa"},
    "surface": [{"kind": "self-affine", "hurst": 0.8, "rms_slope": 0.1, "longest": "4 um", "rolloff": "2 um", "shortest": "1 um", "seed": 1}],
    "adhesion": {"law": "maugis-dugdale", "work_of_adhesion": "20 mJ/m^2", "range": "12 nm"},
    "loading": {"control": "pressure", "path": ["1 MPa", "2 MPa"]},
    "output": {"fields": ["pressure", "gap"], "steps": [1, 2]},
}


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return tabor.Scene(SCENE).run(tmp_path_factory.mktemp("runs") / "run", images=False)


def test_a_run_is_read_back(run):
    assert len(run.curve) == 2
    assert run.curve["converged"].all()
    assert run.curve["step"].dtype.kind == "i" and run.curve["force"].dtype.kind == "f"
    assert run.summary["pull_off_force"] is None
    assert run.fields == [(1, "gap"), (1, "pressure"), (2, "gap"), (2, "pressure")]
    field = run.field("pressure")
    assert isinstance(field, np.memmap) and field.shape == (32, 32)
    assert field.mean() == pytest.approx(2e6, rel=1e-5)
    assert run.field("pressure", 1).mean() == pytest.approx(1e6, rel=1e-5)
    assert len(run.to_frame()) == 2
    for name, step, words in (
        ("displacement", None, r'displacement is not there; it holds gap, pressure; \[output\] fields = \["displacement"\] writes it'),
        ("presure", None, "presure is no field; a run has pressure, gap, displacement, heights"),
        ("pressure", 3, "step 3 has no pressure; steps that have it are 1, 2$"),
    ):
        with pytest.raises(tabor.OutputError, match=words):
            run.field(name, step)


def test_a_path_is_the_run(run):
    steps = list(tabor.Scene(SCENE).path())
    assert [step.contact_area_fraction for step in steps] == pytest.approx(run.curve["contact_area_fraction"], rel=1e-12)
    np.testing.assert_array_equal(steps[1].pressure, run.field("pressure", 2))


def test_a_scene_is_written_and_read(tmp_path):
    tabor.Scene(SCENE).write(tmp_path / "scene.toml")
    read = tabor.Scene.read(tmp_path / "scene.toml", {"grid.points": 16})
    assert read.resolved["grid"]["points"] == [16, 16]
    assert tabor.Scene.read(tmp_path / "scene.toml").resolved == tabor.Scene(SCENE).resolved
    with pytest.raises(tabor.SceneError, match="array"):
        tabor.Scene(SCENE, heights=np.zeros((32, 32))).write(tmp_path / "other.toml")


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(tabor.SceneError, match="none.toml"):
        tabor.Scene.read(tmp_path / "none.toml")
    with pytest.raises(tabor.OutputError, match="curve.csv"):
        tabor.Run(tmp_path)


def test_a_folder_of_something_else_is_refused(tmp_path):
    (tmp_path / "thesis.tex").write_text("years of work")
    with pytest.raises(tabor.OutputError):
        tabor.Scene(SCENE).run(tmp_path, images=False)
    assert (tmp_path / "thesis.tex").exists()


def test_the_program(tmp_path):
    def tabor_of(word):
        # Elsewhere, so that the installed package is found and not its source.
        return subprocess.run([sys.executable, "-m", "tabor", word], capture_output=True, text=True, cwd=tmp_path)

    done = tabor_of("--version")
    assert (done.returncode, done.stdout.split()) == (0, ["tabor", tabor.__version__])
    wrong = tabor_of("rnu")
    assert wrong.returncode == 2 and "rnu" in wrong.stderr


def test_a_sweep(tmp_path):
    (tmp_path / "base.toml").write_text(tabor.Scene({**SCENE, "output": {}}).to_toml())
    study = {"scene": str(tmp_path / "base.toml"), "axis": [{"key": "surface.0.seed", "values": [1, 2]}, {"key": "surface.0.rms_slope", "values": [0.1, 0.09]}]}
    found = tabor.sweep(study, tmp_path / "swept", jobs=1)
    assert len(found["sweep"]) == 8
    assert set(found.tables) >= {"means", "runs", "sweep"}
    assert found.pictures


def test_models_are_compared(tmp_path):
    found = tabor.compare(SCENE, tmp_path / "compared")
    assert "compare" in found.tables and len(found["compare"]) > 0


def test_a_path_that_begins_with_a_hyphen_is_no_option(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("-scene.toml").write_text(tabor.Scene(SCENE).to_toml())
    found = tabor.compare("-scene.toml", "-x")
    assert found.folder == Path("-x") and len(found["compare"]) > 0
    assert tabor.Scene.new("sphere", "-new").path_of_file == tmp_path / "-new" / "scene.toml"


def test_a_scene_stays_as_it_was_read(tmp_path):
    np.save(tmp_path / "map.npy", np.eye(32) * 1e-9)
    np.save(tmp_path / "other.npy", np.eye(32) * 2e-9)
    tables = {**SCENE, "surface": [{"kind": "file", "path": "map.npy", "unit": "m"}], "grid": {"size": "4 um"}, "output": {}}
    del tables["adhesion"]
    file = tmp_path / "scene.toml"
    tabor.Scene(tables).write(file)
    scenes = [tabor.Scene.read(file, overrides) for overrides in (None, {"surface.0.path": "other.npy"}, {"surface": tables["surface"]})]
    said = [scene.check() for scene in scenes]
    assert "100 MPa" in said[0]
    tabor.Scene({**tables, "solid": {"contact_modulus": "7 GPa"}}).write(file)
    assert "7 GPa" in tabor.Scene.read(file).check()
    assert [scene.check() for scene in scenes] == said
    file.unlink()
    assert [scene.check() for scene in scenes] == said
    with pytest.raises(tabor.TaborError, match="none.npy"):
        tabor.compare(scenes[0], tmp_path / "none", overrides={"surface.0.path": "none.npy"})
    found = tabor.compare(scenes[0], tmp_path / "compared", overrides={"surface.0.path": "other.npy"})
    assert len(found["compare"]) > 0


def test_a_study_of_a_wrong_scene_says_what_is_wrong(tmp_path):
    with pytest.raises(tabor.SceneError, match="did you mean"):
        tabor.compare({**SCENE, "gird": {}}, tmp_path / "compared")
    with pytest.raises(TypeError, match="scene: a file, a Scene, a Contact or tables"):
        tabor.compare(np.zeros((8, 8)), tmp_path / "compared")


# Of the last step, which a run writes no fields of; and a mean gap at which the tension is already falling.
@pytest.mark.filterwarnings("ignore:.*has no equilibrium")
@pytest.mark.filterwarnings("ignore:the path turns back at its greatest tension")
@pytest.mark.parametrize("loading", [{"control": "pressure", "path": ["1 MPa", "0 Pa"]}, {"control": "mean-gap", "path": ["60 nm", "65 nm"]}])
def test_a_path_until_apart_has_the_steps_of_a_run(tmp_path, loading):
    scene = tabor.Scene({**SCENE, "loading": {**loading, "until": "apart"}, "output": {}})
    steps = list(scene.path())
    curve = scene.run(tmp_path / "run", images=False).curve
    assert len(steps) > 2 and steps[-1].state == "separated"
    assert [step.state for step in steps] == list(curve["state"])
    np.testing.assert_array_equal([step.force for step in steps], curve["force"])
    # Loads that are asked for are all there is.
    assert len(list(scene.path(pressure=["1 MPa"]))) == 1


def test_control_c_keeps_the_finished_steps(tmp_path):
    loads = [f"{0.5 + 0.01 * number} MPa" for number in range(60)]
    scene = tabor.Scene({**SCENE, "grid": {"points": 128, "size": "4 um"}, "loading": {"control": "pressure", "path": loads}, "output": {}})

    def interrupt(finished, iteration, residual):
        if finished >= 2:
            signal.raise_signal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        scene.run(tmp_path / "run", images=False, progress=interrupt)
    # The run has ended: nobody writes into its folder any more, and it has its summary.
    assert "pull_off_force" in tabor.Run(tmp_path / "run").summary
    finished = len(tabor.Run(tmp_path / "run").curve)
    assert 2 <= finished < 60
    shorter = scene.run(tmp_path / "run", resume=True, images=False)
    assert len(shorter.curve) == 60
    assert shorter.curve["converged"].all()


def test_control_c_keeps_the_warnings(tmp_path):
    # A map that is tilted is warned of, as its surface is built.
    np.save(tmp_path / "tilted.npy", np.add.outer(np.zeros(32), np.linspace(0, 1e-6, 32)))
    loads = [f"{0.5 + 0.01 * number} kPa" for number in range(60)]
    part = tabor.HeightFile(tmp_path / "tilted.npy", unit="m")
    tilted = tabor.Contact(part, "4 um", contact_modulus="100 MPa", loading={"control": "pressure", "path": loads})

    def interrupt(finished, iteration, residual):
        if finished >= 1:
            signal.raise_signal(signal.SIGINT)

    def run():
        with pytest.raises(KeyboardInterrupt):
            tilted.run(tmp_path / "run", images=False, progress=interrupt)

    with pytest.warns(tabor.TaborWarning) as told:
        run()
    assert {warning.filename for warning in told} == {__file__}
    # A filter that makes errors of warnings leaves it what it is.
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run()


#: Says its number and that it began, and a warning when it is told to end, unless it does not hear of that.
PROGRAM = """
import os, signal, sys, time
def end(number, frame):
    sys.stderr.write(f"warning: ended by {number}\\n")
    sys.exit(0)
for number in (signal.SIGINT, signal.SIGTERM):
    signal.signal(number, signal.SIG_IGN if DEAF else end)
with open("begun.part", "w") as file:
    file.write(str(os.getpid()))
os.rename("begun.part", "begun")
time.sleep(60)
"""


@pytest.mark.skipif(os.name != "posix", reason="this system has no SIGALRM")
@pytest.mark.parametrize(
    ("raised", "deaf", "ended_by"),
    [(KeyboardInterrupt, False, signal.SIGINT), (TimeoutError, False, signal.SIGTERM), (SystemExit, False, signal.SIGTERM), (KeyboardInterrupt, True, None)],
)
@pytest.mark.parametrize("strict", [False, True])
def test_no_program_is_left_behind(raised, deaf, ended_by, strict, tmp_path, monkeypatch):
    import tabor.program

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(tabor.program, "PROGRAM", PROGRAM.replace("DEAF", str(deaf)))

    def interrupt(*_):
        if Path("begun").exists():
            raise raised("told to end")

    before = signal.signal(signal.SIGALRM, interrupt)
    signal.setitimer(signal.ITIMER_REAL, 0.1, 0.5)
    begin = time.monotonic()
    try:
        with warnings.catch_warnings(record=not strict) as told:
            warnings.simplefilter("error" if strict else "always")
            with pytest.raises(raised, match="told to end"):
                tabor.program.call(["sweep"], True)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert time.monotonic() - begin < 20
    with pytest.raises(ProcessLookupError):
        os.kill(int(Path("begun").read_text()), 0)
    # A second signal may come before it has said so.
    if told and not deaf:
        assert {str(each.message) for each in told if each.category is tabor.TaborWarning} == {f"ended by {ended_by.value}"}


def test_what_the_program_says_does_not_depend_on_the_locale(tmp_path):
    code = f"import tabor; print(ascii(tabor.Scene({SCENE!r}).check()))"
    environment = {**os.environ, "LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=tmp_path, env=environment)
    assert done.returncode == 0 and "4 \\xb5m x 4 \\xb5m" in done.stdout, done.stderr


def test_a_second_control_c_does_not_wait(tmp_path):
    # A surface is built without a look at who waits for it: on this grid for seconds.
    code = f"""
import os, pathlib, signal, sys, threading, time, tabor
tables = {SCENE!r} | {{"grid": {{"points": 4096, "size": "4 um"}}, "loading": {{"control": "pressure", "path": ["1 MPa"]}}, "output": {{}}}}
scene = tabor.Scene(tables)
sent = []
def interrupt():
    for _ in range(2):
        time.sleep(0.3)
        sent.append(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)
threading.Thread(target=interrupt).start()
try:
    scene.run({str(tmp_path / "run")!r}, images=False)
except KeyboardInterrupt:
    print(len(sent), (pathlib.Path({str(tmp_path / "run")!r}) / "summary.json").exists())
    sys.stdout.flush()
    os._exit(0)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["2", "False"]


@pytest.mark.filterwarnings("ignore::tabor.TaborWarning")
def test_tables_stand_in_place_of_those_of_a_file(tmp_path):
    tables = {**SCENE, "friction": {"shear_strength": "2 MPa"}}
    tabor.Scene(tables).write(tmp_path / "scene.toml")
    other = {
        "adhesion": {"law": "exponential", "work_of_adhesion": 0.01, "range": "20 nm"},
        "surface": [{"kind": "sphere", "radius": "5 um"}, {"kind": "wavy", "amplitude": "1 nm", "wavelength": "1 um"}],
        "friction": {"shear_strength": "1 MPa"},
        "loading.path": [1e6, "1.5 MPa"],
        "title": "a = [1], \"b\"\n{c}",
    }
    read = tabor.Scene.read(tmp_path / "scene.toml", other)
    loading = {**SCENE["loading"], "path": other["loading.path"]}
    expected = {**tables, **{key: value for key, value in other.items() if key != "loading.path"}, "loading": loading}
    assert read.resolved == tabor.Scene(expected).resolved
    # A text stays a text.
    assert tabor.Scene.read(tmp_path / "scene.toml", {"title": "2024"}).resolved["title"] == "2024"
    other = {key: value for key, value in other.items() if key not in ("surface", "friction")}
    studies = [
        tabor.compare(SCENE, tmp_path / "given", overrides=other),
        tabor.compare({**SCENE, "adhesion": other["adhesion"], "loading": loading}, tmp_path / "own"),
    ]
    # Rows without their seconds.
    given, own = ([study["compare"][name] for name in ("model", "mean_pressure", "contact_area_fraction")] for study in studies)
    np.testing.assert_array_equal(given, own)
    for wrong, words in (
        ({"adhesion": {"range": {1, 2}}}, r'^overrides\["adhesion"\].range: .* not set'),
        ({"solid.contact_modulus": "5"}, 'solid.contact_modulus: "5" has no unit'),
        ({"grid.points=8": 16}, r'^overrides\["grid.points=8"\]: a key has no =; give its value behind it'),
        ({"surface": [{"radius": float("nan")}]}, r'^overrides\["surface"\].0.radius: nan is no finite number'),
    ):
        with pytest.raises(tabor.SceneError, match=words):
            tabor.Scene.read(tmp_path / "scene.toml", wrong)


def test_a_check_tells_of_resolution_and_memory():
    words = tabor.Scene(SCENE).check()
    assert "memory" in words and "cohesive zone" in words
    assert "kernels" in tabor.Scene(SCENE).check(verbose=True)


def test_scenes_of_arrays_and_tables_are_checked_and_studied(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    heights = tabor.Scene(SCENE).heights()
    np.save("map.npy", heights)
    law = tabor.MaugisDugdale("20 mJ/m^2", range="12 nm")
    factors = np.ones((32, 32))
    loading = SCENE["loading"]
    contact = tabor.Contact(heights, "4 um", contact_modulus="100 MPa", law=law, adhesion_map=factors, loading=loading)
    assert "32 x 32" in contact.check() and "map" in contact.check()
    # Paths of a scene of tables begin where Python does.
    of_a_file = {**SCENE, "surface": [{"kind": "file", "path": "map.npy"}]}
    assert tabor.Scene(of_a_file).check() == tabor.Contact("map.npy", "4 um", contact_modulus="100 MPa", law=law, loading=loading).check()
    tabor.Scene(SCENE).write("scene.toml")
    few = [pytest.warns(tabor.TaborWarning, match=text) for text in ("^the shortest wave of the surface has 4.0 pixels", "^a stiff summit is attracted over a disc", "^with an rms height of .* the taper of .* makes pull-off too low")]
    with few[0], few[1], few[2]:
        assert "16 x 16" in tabor.Scene.read("scene.toml", {"grid.points": 16}).check()
    tables = [tabor.compare(scene, tmp_path / f"compared{index}")["compare"] for index, scene in enumerate([of_a_file, tabor.Scene(of_a_file)])]
    np.testing.assert_array_equal(tables[0]["contact_area_fraction"], tables[1]["contact_area_fraction"])
    hard = tabor.Contact(heights, "4 um", contact_modulus="100 MPa", loading={"control": "pressure", "path": ["1 MPa"]})
    found = tabor.accuracy(hard, tmp_path / "accuracy", budget=2)
    assert "accuracy" in found.tables
    of_the_file = tabor.Contact("map.npy", "4 um", contact_modulus="100 MPa", loading={"control": "pressure", "path": ["1 MPa"]})
    study = {"scene": of_the_file, "axis": [{"key": "solid.contact_modulus", "values": [1e8, 2e8]}]}
    shares = [tabor.sweep(study, tmp_path / f"share{i}", jobs=1, threads=1, share=(i, 2)) for i in (1, 2)]
    whole = tabor.sweep(study, tmp_path / "whole", merge=[share.folder for share in shares])
    assert len(whole["runs"]) == 2
    with pytest.raises(tabor.SceneError, match="study: its scene holds an array"):
        tabor.sweep({**study, "scene": hard}, tmp_path / "another")


def test_studies_warn_where_they_are_called(tmp_path):
    coarse = tabor.Contact(
        tabor.SelfAffine(rms_slope=0.1, shortest="1 um"),
        "4 um",
        points=16,
        contact_modulus="100 MPa",
        law=tabor.MaugisDugdale("20 mJ/m^2", range="auto"),
        loading={"control": "pressure", "path": ["1 MPa"]},
    )
    for study in (lambda: coarse.check(), lambda: tabor.compare(coarse, tmp_path / "compare")):
        with pytest.warns(tabor.TaborWarning) as told:
            study()
        assert {warning.filename for warning in told} == {__file__}
        said = [str(warning.message) for warning in told]
        assert any(words.startswith("the shortest wave of the surface has 4.0 pixels") for words in said)
        assert any(words.startswith('range="auto" stands for') for words in said), said
    axis = {"key": "surface.0.seed", "values": [1, 2]}
    with pytest.warns(tabor.TaborWarning, match="^study: finished cases with warnings: 2; see the column message of runs.csv$"):
        tabor.sweep({"scene": coarse, "axis": [axis]}, tmp_path / "sweep", jobs=1)
    with pytest.raises(tabor.SceneError, match="name another folder, or move this one away$"):
        tabor.sweep({"scene": coarse, "axis": [axis | {"values": [3]}]}, tmp_path / "sweep")
    for wrong in (3, {3: 4}, {"grid.points": None}):
        with pytest.raises(tabor.SceneError, match="^overrides"):
            tabor.compare(coarse, tmp_path / "none", overrides=wrong)


@pytest.mark.parametrize("kind", ["sphere", "rough", "afm", "pillars", "seal", "mems"])
def test_scenes_to_begin_with(kind, tmp_path):
    scene = tabor.Scene.new(kind, tmp_path / kind)
    assert scene.path_of_file == tmp_path / kind / "scene.toml" and scene.heights().ndim == 2
    with pytest.raises(tabor.TaborError, match="is there already"):
        tabor.Scene.new(kind, tmp_path / kind)
    with pytest.raises(tabor.SceneError, match=f"^kind: one of .*, not '{kind}s'; did you mean '{kind}'\\?$"):
        tabor.Scene.new(kind + "s", tmp_path / "other")


def test_a_run_as_a_dataset(run):
    xarray = pytest.importorskip("xarray")
    data = run.to_dataset()
    assert isinstance(data, xarray.Dataset)
    assert data["force"].attrs["units"] == "N" and data["contact_area_fraction"].attrs["units"] == "1"
    assert data["pressure"].dims == ("field_step", "y", "x") and data["gap"].attrs["units"] == "m"
    np.testing.assert_array_equal(data["pressure"].sel(field_step=2), run.field("pressure", 2))
    np.testing.assert_allclose(data["x"], np.arange(32) * 4e-6 / 32)


def test_units_of_all_columns(tmp_path):
    # The names and units are those of the library.
    source = (Path(__file__).parents[2] / "src").rglob("*.rs")
    columns = {found for path in source for found in re.findall(r'Column::new\("([a-z_]+)", "([^"]*)"', path.read_text(encoding="utf-8"))}
    from tabor.runs import UNITS

    assert len(columns) > 7 and {(name, UNITS.get(name)) for name, _ in columns} == columns


def test_runs_on_one_axis(run):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    axes = run.plot("mean_gap", "mean_pressure", label="one")
    label = axes.get_xlabel()
    assert run.plot("mean_gap", "mean_pressure", axes, label="two", linestyle="--") is axes
    assert len(axes.get_lines()) == 2 and axes.get_xlabel() == label
    np.testing.assert_array_equal(*(line.get_xdata() for line in axes.get_lines()))
    with pytest.raises(ValueError, match="state is no column of numbers"):
        run.plot("state", "force")


def test_a_run_that_was_killed_is_read(run, tmp_path):
    (tmp_path / "curve.csv").write_bytes((run.folder / "curve.csv").read_bytes())
    killed = tabor.Run(tmp_path)
    assert len(killed.curve) == 2 and "2 steps" in killed._repr_html_()
    with pytest.raises(tabor.OutputError, match="has not ended"):
        killed.summary  # noqa: B018


def test_devices():
    assert "processor" in tabor.devices()
