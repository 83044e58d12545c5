"""Contacts of arrays."""

import copy
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


def sphere(n, size, radius):
    """Heights of a sphere's apex in the middle of n x n points."""
    place = (np.arange(n) / n - 0.5) * size
    return -(place[None, :] ** 2 + place[:, None] ** 2) / (2 * radius)


def test_hertz():
    # a = 16 pixels: the approach is a^2/R to 2e-3, as the library's own test has it.
    radius, modulus, a = 5e-6, 1e9, 0.25e-6
    force = 4 / 3 * modulus * a**3 / radius
    step = tabor.Contact(sphere(64, 1e-6, radius), 1e-6, contact_modulus=modulus, boundary="free").solve(force=force)
    assert step.converged
    assert step.approach == pytest.approx(a**2 / radius, rel=2e-3)
    assert step.pressure.shape == (64, 64) and step.pressure.flags.c_contiguous
    assert step.force == pytest.approx(force, rel=1e-6)


def test_single_precision_heights_and_other_layouts_are_the_same_numbers():
    heights = sphere(32, 1e-6, 5e-6).astype(np.float32)
    steps = [
        tabor.Contact(array, "1 um", contact_modulus="1 GPa").solve(pressure="1 MPa")
        for array in (heights, heights.astype(np.float64), np.asfortranarray(heights.astype(np.float64)))
    ]
    for step in steps[1:]:
        np.testing.assert_array_equal(step.pressure, steps[0].pressure)


# In a process of its own: in this one earlier tests may have left memory that a copy takes.
HEIGHTS_IN_MEMORY = """
import os
from pathlib import Path
import numpy as np
import tabor

def resident():
    pages = Path("/proc/self/statm").read_text().split()[1]
    return int(pages) * os.sysconf("SC_PAGE_SIZE")

# Linear in x, so that no two numbers of a row are equal and every page is in memory: 32 MiB.
heights = np.tile(np.linspace(0, 1e-9, 2048), (2048, 1))
contact = tabor.Contact(heights[:8], 1e-6, contact_modulus=1e9)
before = resident()
contact = tabor.Contact(heights, 1e-6, contact_modulus=1e9)
# Room for what the check of the numbers leaves behind, a byte each.
assert resident() - before < heights.nbytes / 4, resident() - before
assert np.shares_memory(contact._heights, heights)
before = resident()
single = heights.astype(np.float32)
copied = tabor.Contact(single, 1e-6, contact_modulus=1e9)
assert resident() - before > single.nbytes + 0.9 * heights.nbytes, resident() - before
assert copied.resolved["grid"]["points"] == [2048, 2048]
"""


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="only Linux tells of a process's memory")
def test_heights_are_not_copied():
    done = subprocess.run([sys.executable, "-c", HEIGHTS_IN_MEMORY], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("argument", ["heights", "adhesion_map"])
def test_an_array_that_was_written_to_is_refused(argument):
    heights, factors = sphere(32, 1e-6, 5e-6), np.ones((32, 32))
    law = tabor.Exponential("10 mJ/m^2", range="5 nm")
    contact = tabor.Contact(heights, 1e-6, contact_modulus=1e9, law=law, adhesion_map=factors)
    path = contact.path(pressure=[1e6, 2e6])
    next(path)
    {"heights": heights, "adhesion_map": factors}[argument][3, 4] *= 1 + 1e-15
    # That the contact sees it shows that the numbers are those of the array.
    solves = (lambda: next(path), lambda: contact.solve(pressure=1e6), contact.heights, lambda: contact.run("never"))
    studies = (contact.check, lambda: tabor.compare(contact, "never"), lambda: tabor.accuracy(contact, "never", budget=1))
    copies = (lambda: pickle.dumps(contact), lambda: copy.copy(contact), lambda: copy.deepcopy(contact))
    for call in (*solves, *studies, *copies):
        with pytest.raises(tabor.SceneError, match=f"{argument}: this array has been written to"):
            call()
    again = tabor.Contact(heights, 1e-6, contact_modulus=1e9, law=law, adhesion_map=factors)
    assert again.solve(pressure=1e6).converged
    heights.resize((64, 64), refcheck=False)
    with pytest.raises(tabor.SceneError, match="written to"):
        again.solve(pressure=1e6)


def test_heights_outlive_their_names():
    def made():
        return tabor.Contact(sphere(64, 1e-6, 5e-6), 1e-6, contact_modulus=1e9)

    contact = made()
    # What takes the memory of an array that nobody holds.
    others = [np.full((64, 64), np.nan) for _ in range(8)]
    np.testing.assert_array_equal(contact.solve(pressure=1e6).pressure, made().solve(pressure=1e6).pressure)
    assert len(others) == 8


def test_threads_do_not_change_bits():
    heights = tabor.self_affine((64, 64), 1e-6, rms_slope=0.1, shortest=1e-7)
    one, two = (tabor.Contact(heights, 1e-6, contact_modulus=1e9, threads=n).solve(pressure=1e7) for n in (1, 2))
    np.testing.assert_array_equal(one.pressure, two.pressure)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"contact_modulus": -1.0}, "contact_modulus"),
        ({"contact_modulus": "1 nm"}, "contact_modulus"),
        ({"hardness": "0 Pa"}, "hardness"),
        ({"boundary": "round"}, "boundary"),
    ],
)
def test_mistakes_name_the_key(change, words):
    with pytest.raises(tabor.SceneError, match=words):
        tabor.Contact(sphere(8, 1e-6, 1e-6), 1e-6, **{"contact_modulus": 1e9, **change})


def test_what_is_no_height_is_refused():
    heights = sphere(8, 1e-6, 1e-6)
    heights[2, 3] = np.nan
    masked = np.ma.masked_less(sphere(8, 1e-6, 1e-6), -1e-7)
    for wrong in (heights, heights[0], "no such heights", [["a"]], np.zeros((0, 4)), masked):
        with pytest.raises(ValueError, match="heights"):
            tabor.Contact(wrong, 1e-6, contact_modulus=1e9)


def test_a_scene_pickles():
    contact = tabor.Contact(sphere(16, 1e-6, 1e-6), 1e-6, contact_modulus=1e9)
    other = pickle.loads(pickle.dumps(contact))
    np.testing.assert_array_equal(contact.solve(pressure=1e6).gap, other.solve(pressure=1e6).gap)


def test_control_c_ends_a_solve_within_a_second():
    # The signal comes once the solver is at work, in this solve or, on a machine that has ended it by then, in the next.
    heights = tabor.self_affine((1024, 1024), 1e-6, rms_slope=0.1, shortest=4e-9)
    contact = tabor.Contact(
        heights, 1e-6, contact_modulus=1e9, law=tabor.Exponential(0.05, range=0.4e-9), tolerance=1e-12, max_iterations=100000
    )
    started = threading.Event()
    sent = []

    def interrupt():
        started.wait(60)
        sent.append(time.monotonic())
        signal.raise_signal(signal.SIGINT)

    threading.Thread(target=interrupt).start()
    with pytest.raises(KeyboardInterrupt):
        while True:
            contact.solve(pressure=1e7, progress=lambda finished, iteration, residual: started.set())
    # The second of the promise, from the signal on; signals are looked for ten times in it.
    assert time.monotonic() - sent[0] < 1.0


def test_a_path_that_has_ended_says_what_it_does_not_show():
    size = ("1 um", "1 um")
    sphere = tabor.heights(tabor.Sphere("1 um"), (64, 64), size)
    law = tabor.MaugisDugdale("50 mJ/m^2", range="20 nm")
    contact = tabor.Contact(sphere, size, contact_modulus="1 GPa", law=law, boundary="free")
    path = contact.path(force=["100 nN", "-10 nN"])
    assert [step.converged for step in (next(path), next(path))] == [True, True]
    with pytest.warns(tabor.TaborWarning, match="the contact held 10 nN in step 2, the greatest tension of the path: its pull-off is beyond"):
        assert next(path, None) is None
    assert list(path) == []


def test_a_value_that_no_contact_has():
    # The wave of 10 nm is closed everywhere at an approach of 10 nm.
    size = ("1 um", "31.25 nm")
    wave = tabor.heights(tabor.Wavy("10 nm", "1 um"), (64, 2), size)
    contact = tabor.Contact(wave, size, contact_modulus="1 GPa")
    with pytest.warns(tabor.NotConvergedWarning, match="did not converge: the surfaces cannot be closed further than full contact"):
        step = contact.solve(approach="30 nm")
    assert not step.converged and "full contact" in step.unreachable and step.approach is None
    assert np.isnan(step.gap).all() and np.isnan(step.pressure).all() and np.isnan(step.displacement).all()
    assert repr(step) == "<Step 1: no solution, the surfaces cannot be closed further than full contact>"
    assert "no solution" in step._repr_html_()
    assert contact.solve(approach="5 nm").unreachable is None
