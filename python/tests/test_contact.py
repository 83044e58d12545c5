"""Contacts of arrays."""

import pickle
import signal
import threading
import time

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
    for wrong in (heights, heights[0], "heights", np.zeros((0, 4))):
        with pytest.raises(ValueError, match="heights"):
            tabor.Contact(wrong, 1e-6, contact_modulus=1e9)


def test_a_scene_pickles():
    contact = tabor.Contact(sphere(16, 1e-6, 1e-6), 1e-6, contact_modulus=1e9)
    other = pickle.loads(pickle.dumps(contact))
    np.testing.assert_array_equal(contact.solve(pressure=1e6).gap, other.solve(pressure=1e6).gap)


def test_control_c_ends_a_solve_within_a_second():
    heights = tabor.self_affine((1024, 1024), 1e-6, rms_slope=0.1, shortest=4e-9)
    contact = tabor.Contact(heights, 1e-6, contact_modulus=1e9, tolerance=1e-12, max_iterations=100000)
    sent = []

    def interrupt():
        sent.append(time.monotonic())
        signal.raise_signal(signal.SIGINT)

    threading.Timer(0.5, interrupt).start()
    with pytest.raises(KeyboardInterrupt):
        contact.solve(pressure=1e7)
    # The second of the promise, from the signal on; signals are looked for ten times in it.
    assert time.monotonic() - sent[0] < 1.0
