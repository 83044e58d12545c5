"""What a user of NumPy expects: names of arguments in errors, pickles, forks, Ctrl-C, a light import."""

import contextlib
import copy
import multiprocessing
import pickle
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import tabor

ROUGH = tabor.self_affine(32, "4 um", rms_slope=0.1, shortest="1 um")


def contact(**more):
    return tabor.Contact(ROUGH, "4 um", contact_modulus="100 MPa", **more)


@pytest.mark.parametrize(
    ("call", "kind", "words"),
    [
        (lambda: contact().solve("10 nN"), TypeError, r'solve takes loads by the name .*solve\(force="10 nN"\), not \'10 nN\''),
        (lambda: contact().solve(pressure=True), ValueError, "pressure: True"),
        (lambda: contact().solve(pressure=10**400), ValueError, "pressure: 1000"),
        (lambda: list(contact().path(pressure=np.ones((2, 2)))), ValueError, "pressure: "),
        (lambda: contact(threads=10**9), ValueError, "threads: a count from 1 to 1024"),
        (lambda: contact(solid="steel"), ValueError, "solid: a mapping"),
        (lambda: contact(loading=[]), ValueError, "loading: a mapping"),
        (lambda: contact(solid={"contact_modulus": 1e8}), ValueError, "^contact_modulus: given as an argument and in solid; give one$"),
        (lambda: contact(spring=1, loading={"control": "approach", "path": [0], "spring": 1}), ValueError, "^spring: given as an argument and in loading; give one$"),
        (lambda: contact(spring=1, loading={"control": "force", "path": [1e-9, 2e-9]}), ValueError, "^spring: a spring needs a prescribed far end; take approach"),
        (lambda: contact(hardness=np.inf), ValueError, "^hardness: inf is no finite number"),
        (lambda: contact(title="\ud800"), ValueError, "title: this is no text"),
        (lambda: contact(output={"fields": {1, 2}}), ValueError, r'output\["fields"\]: .* not set'),
        (lambda: tabor.Contact([[1, 2], [3]], 1.0, contact_modulus=1.0), ValueError, "heights: an array of shape"),
        (lambda: tabor.Contact(None, 1.0, contact_modulus=1.0), ValueError, "heights: .* not NoneType"),
        (lambda: tabor.Contact(np.zeros((2, 2), "M8[s]"), 1.0, contact_modulus=1.0), ValueError, "heights: real numbers"),
        (lambda: tabor.Contact(np.zeros((2, 2), "S4"), 1.0, contact_modulus=1.0), ValueError, "heights: real numbers"),
        (lambda: tabor.Contact(".", 1.0, contact_modulus=1.0), ValueError, "heights: .: is a folder"),
        (lambda: tabor.Scene("scene.toml"), ValueError, "Scene.read reads a file"),
        (lambda: tabor.theory.table("jkr", radius=np.ones(3)), ValueError, "radius: "),
        (lambda: contact().path([1e6]), TypeError, r"path takes loads by the name .* as in path\(force="),
        (lambda: contact().solve(), TypeError, "pressure, force, approach or mean_gap"),
        (lambda: contact().solve(pressure=1e6, force=1.0), TypeError, "give one of .* not pressure and force"),
        (lambda: contact().solve(pressure=[1e6]), TypeError, "pressure: solve takes one load"),
        (lambda: contact().solve(preasure=1e6), TypeError, "preasure"),
        (lambda: contact().solve(pressure="10 nN"), ValueError, "pressure: "),
        (lambda: contact().solve(pressure=1j), ValueError, "pressure: "),
        (lambda: contact().solve(pressure=np.nan), ValueError, "pressure: nan"),
        (lambda: list(contact().path(pressure=[1e6, "much"])), ValueError, "pressure: "),
        (lambda: contact().path(pressure=[1e6, 2e6], seconds=[1, 1]), ValueError, "seconds: one for each load but the first is expected, 1 of them, not 2"),
        (lambda: contact().path(seconds=1), ValueError, "seconds: the loads of a scene"),
        (lambda: list(contact().path(pressure=[1e6, 2e6], seconds="soon")), ValueError, "seconds: "),
        (lambda: contact(threads=0), ValueError, "threads: "),
        (lambda: contact(adhesion_map=np.ones((32, 32))), ValueError, "adhesion_map: it needs a law"),
        (lambda: contact(treatment="dmt"), ValueError, "treatment: it needs a law"),
        (lambda: contact(rate={"exponent": 1}), ValueError, "rate: it needs a law"),
        (lambda: contact(hardnes="1 GPa"), ValueError, "hardnes"),
        (lambda: contact(points=32), ValueError, "points: an array has its own"),
        (lambda: tabor.Contact(tabor.Sphere("1 um"), "4 um", contact_modulus=1e8), ValueError, "points"),
        (lambda: tabor.Contact(tabor.Sphere("1 um"), "4 um", points=(4, 4, 4), contact_modulus=1e8), ValueError, "points: "),
        (lambda: tabor.Contact(tabor.Sphere("1 um"), points=8, contact_modulus=1e8), ValueError, "size"),
        (lambda: tabor.Contact("none.spm", contact_modulus=1e8).solve(pressure=1e6), ValueError, "none.spm"),
        (lambda: tabor.Contact(ROUGH, contact_modulus=1e8), ValueError, "size: "),
        (lambda: tabor.Contact(ROUGH, "4 um", contact_modulus=1e8, law=tabor.Exponential("20 mJ/m^2", range="1 Pa")), ValueError, "range"),
        (lambda: tabor.heights(tabor.Cone(70), 8, "1 um"), ValueError, 'half_angle: 70 is not between 0 and pi/2 rad; .*"70 deg"'),
        (lambda: tabor.heights("sphere", 8, "1 um"), ValueError, "parts: "),
        (lambda: tabor.heights(tabor.Flat(), "8", "1 um"), ValueError, "points: "),
        (lambda: tabor.accuracy(contact(), "folder", budget="1 m"), ValueError, "budget: "),
    ],
)
def test_errors_name_the_argument(call, kind, words):
    with pytest.raises(kind, match=words):
        call()


def test_tables_beside_arguments():
    given = tabor.Contact(ROUGH, "4 um", young_modulus="100 MPa", solid={"poisson_ratio": 0.3, "young_modulus": None})
    assert given.resolved == tabor.Contact(ROUGH, "4 um", young_modulus="100 MPa", poisson_ratio=0.3).resolved
    loading = {"path": [0, 1e-9]}
    assert contact(spring=1, loading=loading).resolved["loading"]["control"] == "approach"
    # A Scene of them says the same.
    tables = {
        "grid": {"points": 32, "size": "4 um"},
        "solid": {"contact_modulus": "100 MPa"},
        "surface": [{"kind": "flat"}],
        "adhesion": {"law": "exponential", "work_of_adhesion": 0.01, "range": "20 nm", "map": {"pattern": "checker", "period": "1 um", "low": 0, "high": 1}},
        "loading": {"control": "pressure", "path": [0]},
    }
    with pytest.raises(tabor.SceneError, match="^adhesion_map: given as an argument and as map in adhesion; give one$"):
        tabor.Scene(tables, adhesion_map=np.ones((32, 32)))


def test_numbers_keep_their_last_bit():
    loads = np.random.default_rng(1).uniform(1e5, 1e6, 1000)
    rough = contact(loading={"control": "pressure", "path": loads})
    np.testing.assert_array_equal(rough.resolved["loading"]["path"], loads)


def test_loads_come_from_anything_that_counts():
    expected = [step.force for step in contact().path(pressure=[1e6, 2e6])]
    for loads in ((load for load in (1e6, 2e6)), (1e6, "2 MPa"), np.array([1e6, 2e6], "f4"), np.array([1000000, 2000000]), {1e6: 1, 2e6: 2}):
        assert [step.force for step in contact().path(pressure=loads)] == expected
    assert contact().solve(pressure=np.array(1e6)).force == expected[0] == next(contact().path(pressure=np.float32(1e6))).force


def test_files_that_cannot_be_read_or_written(tmp_path):
    (tmp_path / "curve.csv").touch()
    with pytest.raises(tabor.OutputError, match="curve.csv: is empty"):
        tabor.Run(tmp_path).curve  # noqa: B018
    with pytest.raises(tabor.OutputError, match="cannot be written"):
        tabor.Contact(tabor.Flat(), 1.0, points=4, contact_modulus=1.0).write(tmp_path)
    with pytest.raises(tabor.SceneError, match="cannot be read"):
        tabor.Scene.read("a\0b")


def test_one_time_for_all_loads():
    relaxing = contact(relaxation=[{"modulus": "50 MPa", "time": "1 s"}])
    once = [step.time for step in relaxing.path(pressure=[1e6, 2e6, 3e6], seconds="2 s")]
    assert once == [step.time for step in relaxing.path(pressure=np.array([1e6, 2e6, 3e6]), seconds=[2, 2.0])] == [0.0, 2.0, 4.0]


@pytest.mark.parametrize(
    "times",
    [
        {"relaxation": [{"modulus": "50 MPa", "time": "1 s"}]},
        {"law": tabor.MaugisDugdale("20 mJ/m^2", range="50 nm"), "rate": {"reference_speed": "1 um/s", "exponent": 0.5}},
    ],
)
def test_one_load_takes_no_time(times):
    step = contact(**times).solve(pressure="1 MPa")
    first = next(contact(**times).path(pressure=["1 MPa", "2 MPa"], seconds=1))
    assert step.time == first.time == 0
    np.testing.assert_array_equal(step.pressure, first.pressure)


# Which of its images is read, and that the map is tilted.
@pytest.mark.filterwarnings("ignore::tabor.TaborWarning")
def test_files_bring_their_size(tmp_path):
    path = Path(__file__).parents[2] / "tests" / "files" / "bruker_5.spm"
    surface = tabor.read_heights(path)
    for rough in (tabor.Contact(str(path), contact_modulus="1 GPa"), tabor.Contact(path, contact_modulus="1 GPa")):
        heights, size = rough.surface()
        np.testing.assert_array_equal(heights, surface.heights)
        assert tuple(size) == surface.size
        # A contact of a file is a scene without arrays, which the command line reads.
        rough.write(tmp_path / "scene.toml")
        assert f"{heights.shape[1]} x {heights.shape[0]} points" in rough.check()
    np.save(tmp_path / "map.npy", ROUGH)
    with pytest.raises(ValueError, match="size"):
        tabor.Contact(tmp_path / "map.npy", contact_modulus="1 GPa").heights()
    step = tabor.Contact(tmp_path / "map.npy", "4 um", contact_modulus="100 MPa").solve(pressure="1 MPa")
    np.testing.assert_array_equal(step.pressure, contact().solve(pressure="1 MPa").pressure)


def test_a_sphere_has_its_true_apex():
    # Of an array the highest sample would count: dx^2/(4 R) below the apex between four points.
    radius, side, points = 1e-5, 1e-6, 64
    sphere = tabor.Contact(tabor.Sphere(radius), side, points=points, contact_modulus=1e9, boundary="free", tolerance=1e-9)
    approach = (side / 5) ** 2 / radius
    assert sphere.solve(approach=approach).force == pytest.approx(tabor.theory.hertz.force(radius, 1e9, side / 5), rel=5.7e-4)


def test_a_path_does_not_pickle_and_says_what_does():
    path = contact().path(pressure=[1e6, 2e6, 3e6])
    next(path)
    assert "1 loads solved" in repr(path)
    for call in (pickle.dumps, copy.copy, copy.deepcopy):
        with pytest.raises(TypeError, match="pickle its contact or scene, or the steps"):
            call(path)
    rest = list(path)
    assert len(rest) == 2 and next(path, None) is None
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(rest))[1].gap, rest[1].gap)


@pytest.mark.filterwarnings("ignore::tabor.TaborWarning")
def test_everything_else_pickles(tmp_path):
    law = tabor.MaugisDugdale("20 mJ/m^2", range="10 nm")
    curve = tabor.theory.maugis_dugdale.at_force("10 um", "1 GPa", "50 mJ/m^2", "5 MPa", np.linspace(-2.6e-6, 1e-5, 200))
    found = tabor.fit((curve.approach, curve.force), radius="10 um", contact_at_zero=True)
    run = contact(loading={"control": "pressure", "path": ["1 MPa"]}).run(tmp_path / "run", images=False)
    table = tabor.theory.table("jkr", radius="1 um", contact_modulus="1 GPa", work_of_adhesion="50 mJ/m^2")
    for each in (law, tabor.Sphere("1 um"), tabor.HeightFile("map.npy", unit="nm"), tabor.Surface(ROUGH, (4e-6, 4e-6)), found, found.work_of_adhesion, run, table, contact(law=law)):
        again = pickle.loads(pickle.dumps(each))
        assert type(again) is type(each) and repr(again) == repr(each)
    # Errors too: they cross processes.
    assert str(pickle.loads(pickle.dumps(tabor.SceneError("size: wrong")))) == "size: wrong"


def area(pressure):
    heights = tabor.self_affine(32, "4 um", rms_slope=0.1, shortest="1 um")
    assert tabor.statistics(heights, "4 um")["rms_slope"] > 0
    assert len(tabor.spectrum(heights, "4 um")) > 3
    return contact().solve(pressure=pressure).contact_area_fraction


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="this system does not fork")
@pytest.mark.filterwarnings("ignore:This process .* is multi-threaded")
def test_a_fork_after_a_solve_solves():
    # Threads do not live on in a fork: what waits for one waits for ever.
    expected = [area(1e6), area(2e6)]
    with multiprocessing.get_context("fork").Pool(2) as pool:
        assert pool.map_async(area, [1e6, 2e6]).get(timeout=60) == expected


def run_in(folder):
    loaded = contact(loading={"control": "pressure", "path": [1e6]})
    return [float(fraction) for fraction in loaded.run(folder).curve["contact_area_fraction"]]


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="this system does not fork")
@pytest.mark.filterwarnings("ignore:This process .* is multi-threaded")
def test_a_fork_after_a_run_runs(tmp_path):
    expected = run_in(tmp_path / "before")
    with multiprocessing.get_context("fork").Pool(1) as pool:
        assert pool.map_async(run_in, [tmp_path / "fork"]).get(timeout=60) == [expected]


BEGUN = []


def go_on(_):
    try:
        return next(BEGUN[0]).number
    except RuntimeError as error:
        return str(error)


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="this system does not fork")
@pytest.mark.filterwarnings("ignore:This process .* is multi-threaded")
def test_a_path_goes_on_where_it_was_begun():
    BEGUN[:] = [contact().path(pressure=[1e6, 2e6, 3e6])]
    assert next(BEGUN[0]).number == 1
    with multiprocessing.get_context("fork").Pool(1) as pool:
        assert "begun in another process" in pool.map_async(go_on, [0]).get(timeout=60)[0]
    assert next(BEGUN[0]).number == 2


def test_threads_take_turns_on_a_path_or_are_told():
    path = contact().path(pressure=np.linspace(1e6, 2e6, 20))
    steps, told = [], []

    def work():
        try:
            steps.extend(path)
        except RuntimeError as error:
            told.append(str(error))

    threads = [threading.Thread(target=work) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(steps) + len(list(path)) == 20
    assert all("solves a load already" in words for words in told)

    def again(*_):
        next(path)

    path = contact().path(pressure=[1e6, 2e6], progress=again)
    with pytest.raises(RuntimeError, match="for this progress"):
        next(path)


def test_other_threads_run_while_one_solves():
    heights = tabor.self_affine(1024, 1e-6, rms_slope=0.1, shortest=4e-9)
    rough = tabor.Contact(heights, 1e-6, contact_modulus=1e9, tolerance=1e-10, threads=1)
    turns, done = 0, threading.Event()

    def solve():
        rough.solve(pressure=1e7)
        done.set()

    thread = threading.Thread(target=solve)
    thread.start()
    while not done.wait(0.001):
        turns += 1
    thread.join()
    assert turns > 50


@pytest.mark.parametrize(
    "build",
    [
        "tabor.self_affine(8192, 1.0, rms_slope=0.1, shortest=1e-3)",
        "tabor.statistics(heights, 1.0)",
        # Some ten seconds.
        "tabor.fit((approach, force, numpy.linspace(0, 2, 6000)), radius=1e-6, relaxation=True)",
    ],
)
def test_control_c_ends_what_is_no_solve(build):
    code = f"""
import signal, threading, time, numpy, tabor, sys
approach = 1e-7 * (1 - abs(numpy.linspace(-1, 1, 6000)))
force = 4 / 3 * 1e9 * 1e-6**0.5 * approach**1.5 + numpy.random.default_rng(1).normal(size=6000) * 1e-9
heights = numpy.random.default_rng(1).normal(size=(4096, 4096)) if "heights, 1.0" in {build!r} else None
sent = []
def interrupt():
    sent.append(time.monotonic())
    signal.raise_signal(signal.SIGINT)
threading.Timer(0.15, interrupt).start()
try:
    {build}
    time.sleep(1)
except KeyboardInterrupt:
    print(time.monotonic() - sent[0])
    sys.stdout.flush()
    import os
    os._exit(0)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) < 1.0


SLOW_STUDY = """
import tabor
scene = tabor.Scene({"grid": {"points": 1024, "size": "2 um"}, "solid": {"contact_modulus": "100 MPa"},
    "surface": [{"kind": "self-affine", "hurst": 0.8, "rms_slope": 0.3, "longest": "2 um", "rolloff": "1 um", "shortest": "20 nm", "seed": 1}],
    "adhesion": {"law": "maugis-dugdale", "work_of_adhesion": "50 mJ/m^2", "range": "2 nm"},
    "loading": {"control": "pressure", "path": [1e6 * i for i in range(1, 60)]}})
tabor.compare(scene, "compared")
"""


def _processes(folder):
    """The processes that name a folder among their arguments; one that has ended has none."""
    found = []
    for place in Path("/proc").glob("[0-9]*/cmdline"):
        with contextlib.suppress(OSError):
            if folder.encode() in place.read_bytes():
                found.append(place)
    return found


@pytest.mark.skipif(sys.platform != "linux", reason="lists processes by /proc")
@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_a_study_ends_with_its_caller(sent, tmp_path):
    folder = str(tmp_path / "compared")
    study = subprocess.Popen([sys.executable, "-c", SLOW_STUDY.replace('"compared"', repr(folder))], stderr=subprocess.PIPE, text=True)
    begun = time.monotonic()
    while len(_processes(folder)) < 2 and time.monotonic() - begun < 60:
        time.sleep(0.1)
    time.sleep(1.0)
    assert study.poll() is None, study.communicate()
    study.send_signal(sent)
    study.communicate(timeout=30)
    gone = time.monotonic() + 10
    while _processes(folder) and time.monotonic() < gone:
        time.sleep(0.1)
    assert _processes(folder) == []


def test_warnings_point_to_the_line_of_the_user():
    rough = contact(max_iterations=2)
    with pytest.warns(tabor.NotConvergedWarning) as told:
        rough.solve(pressure=1e6)
        for _ in rough.path(pressure=[1e6]):
            pass
    assert {warning.filename for warning in told if issubclass(warning.category, tabor.NotConvergedWarning)} == {__file__}


def test_warnings_of_runs_and_surfaces_do_too(tmp_path):
    # A map that is tilted is warned of, as its surface is built.
    tilted = np.add.outer(np.zeros(32), np.linspace(0, 1e-6, 32)) + ROUGH
    np.save(tmp_path / "tilted.npy", tilted)
    part = tabor.HeightFile(tmp_path / "tilted.npy", unit="m")
    scene = tabor.Contact(part, "4 um", contact_modulus="100 MPa", loading={"control": "pressure", "path": ["1 kPa"]})
    calls = (
        lambda: scene.surface(),
        lambda: scene.heights(),
        lambda: scene.run(tmp_path / "run", images=False),
        lambda: tabor.read_heights(tmp_path / "tilted.npy", "4 um", unit="m"),
        lambda: tabor.heights(part, 32, "4 um"),
    )
    for call in calls:
        with pytest.warns(tabor.TaborWarning) as told:
            call()
        assert {warning.filename for warning in told} == {__file__}


@pytest.mark.parametrize(
    ("missing", "call"),
    [
        ("xarray", lambda step: step.to_dataset()),
        ("matplotlib.pyplot", lambda step: step.plot()),
        ("SurfaceTopography", lambda step: step.to_topography()),
    ],
)
def test_what_is_not_installed_is_named(missing, call, monkeypatch):
    step = contact().solve(pressure=1e6)
    monkeypatch.setitem(sys.modules, missing, None)
    name = missing.partition(".")[0]
    with pytest.raises(ImportError, match=f"needs {name}: pip install {name}") as raised:
        call(step)
    assert isinstance(raised.value, tabor.TaborError)


def test_an_import_brings_nothing_that_is_not_asked_for():
    heavy = ("numpy", "tabor.theory", "tabor.fits", "tabor.studies", "matplotlib", "pandas", "xarray", "tqdm", "subprocess", "dataclasses", "importlib.metadata")
    code = f"import sys, tabor; print([name for name in {heavy!r} if name in sys.modules]); import tabor.theory; tabor.Contact; print('matplotlib' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split("\n")[:2] == ["[]", "False"]


def test_all_names_are_there():
    for name in tabor.__all__:
        assert getattr(tabor, name) is not None and name in dir(tabor)
    assert tabor.errors.SceneError is tabor.SceneError and tabor.plots.prefix(1e-6)[1] == "\N{MICRO SIGN}"
    with pytest.raises(AttributeError, match="module 'tabor' has no attribute 'Contat'"):
        tabor.Contat  # noqa: B018


def test_signals_are_left_as_they_were():
    before = signal.getsignal(signal.SIGINT)
    contact().solve(pressure=1e6)
    assert signal.getsignal(signal.SIGINT) is before


def test_seconds_of_a_step_are_real():
    begin = time.monotonic()
    step = contact().solve(pressure=1e6)
    assert 0 < step.seconds <= time.monotonic() - begin


def test_what_is_masked_is_no_number():
    force = np.ma.array([1e-9, 1e-6], mask=[False, True])
    with pytest.raises(tabor.TheoryError, match="1 of 2 values are masked"):
        tabor.theory.hertz.contact_radius("1 um", "1 GPa", force)
    np.testing.assert_array_equal(
        tabor.theory.hertz.contact_radius("1 um", "1 GPa", ["1 nN", 2e-9]),
        tabor.theory.hertz.contact_radius("1 um", "1 GPa", [1e-9, 2e-9]),
    )


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda contact: contact.path(pressure=b"1 MPa").__next__(), "pressure: b'1 MPa' is no number"),
        (lambda contact: contact.solve(pressure=1e6 + 1j), "pressure: .* is no number"),
        (lambda _: tabor.self_affine(16, 1e-6, rms_slope=0.1, shortest=1e-7, seed=2**63), "^seed: 9223372036854775808 is out of range"),
        (lambda _: tabor.Contact(np.zeros((4, 4)), 1.0, contact_moduls=1.0), "contact_moduls: unknown argument of a contact; did you mean contact_modulus"),
        (lambda _: tabor.fit((np.arange(9.0), np.arange(9.0)), cone=70), "cone: 70 is not between 0 and pi/2 rad"),
    ],
)
def test_mistakes_are_named(call, words):
    contact = tabor.Contact(np.zeros((4, 4)), 1.0, contact_modulus=1e9)
    with pytest.raises(tabor.TaborError, match=words):
        call(contact)


def test_a_scene_finds_its_files_from_elsewhere(tmp_path, monkeypatch):
    # Another file of the same name lies where the process has gone.
    for folder, height in ((tmp_path, 1e-9), (tmp_path / "elsewhere", 5e-9)):
        folder.mkdir(exist_ok=True)
        np.save(folder / "map.npy", np.eye(8) * height)
    monkeypatch.chdir(tmp_path)
    tables = {
        "grid": {"size": "1 um"},
        "solid": {"contact_modulus": "1 GPa"},
        "surface": [{"kind": "file", "path": "map.npy"}],
        "loading": {"control": "pressure", "path": ["1 MPa"]},
    }
    tabor.Scene(tables).write("scene.toml")
    scenes = [tabor.Scene(tables), tabor.Scene.read("scene.toml")]
    monkeypatch.chdir(tmp_path / "elsewhere")
    assert [scene.heights().max() for scene in scenes] == [1e-9, 1e-9]
    assert scenes[1].check() and scenes[1].path_of_file == tmp_path / "scene.toml"
