"""Surfaces made, read, added up, and their statistics."""

import numpy as np
import pytest

import tabor


def test_parts_add_up():
    points, size = (48, 32), ("6 um", "4 um")
    parts = [tabor.Sphere("5 um"), tabor.Wavy("3 nm", ("1 um", "inf")), tabor.SelfAffine(rms_height="1 nm", shortest="0.5 um")]
    whole = tabor.heights(parts, points, size)
    assert whole.shape == (32, 48)
    np.testing.assert_allclose(whole, sum(tabor.heights(part, points, size) for part in parts), atol=1e-20)


def test_a_sphere_is_its_paraboloid():
    heights = tabor.heights(tabor.Sphere("5 um", centre=("1 um", "2 um")), (40, 40), "4 um", boundary="free")
    x = (np.arange(40) * 4e-6 / 40)[None, :]
    y = (np.arange(40) * 4e-6 / 40)[:, None]
    np.testing.assert_allclose(heights, -((x - 1e-6) ** 2 + (y - 2e-6) ** 2) / 1e-5, atol=1e-18)


def test_statistics_of_a_wave():
    # h = a cos(kx) cos(ky): mean squares a^2/4, and k^2 a^2/2 of the gradient.
    a, k = 2e-9, 2 * np.pi / 1e-6
    heights = tabor.heights(tabor.Wavy(a, (1e-6, 1e-6)), (64, 64), "4 um")
    found = tabor.statistics(heights, "4 um")
    assert found["rms_height"] == pytest.approx(a / 2, rel=1e-12)
    assert found["rms_slope"] == pytest.approx(a * k / np.sqrt(2), rel=1e-12)
    assert found["skewness"] == pytest.approx(0, abs=1e-12)


def test_the_spectrum_has_the_mean_square():
    heights = tabor.self_affine((256, 256), "10 um", rms_height="3 nm", rolloff="2 um", shortest="0.3 um", seed=3)
    rings = tabor.spectrum(heights, "10 um")
    # Each mode stands for (2 pi/L)^2 of the plane of wavevectors.
    assert (rings["density"] * rings["modes"]).sum() * (2 * np.pi / 1e-5) ** 2 == pytest.approx((3e-9) ** 2, rel=1e-9)
    assert np.all(np.diff(rings["wavenumber"]) > 0)


def test_slope_over_one_point():
    heights = tabor.self_affine((64, 64), "1 um", rms_height="3 nm", shortest="0.1 um")
    first = tabor.scale_dependence(heights, "1 um")[0]
    assert first["distance"] == pytest.approx(1e-6 / 64)
    steps = np.diff(np.hstack([heights, heights[:, :1]]), axis=1)
    assert first["slope"] == pytest.approx(np.sqrt((steps**2).mean()) / (1e-6 / 64), rel=1e-10)


def test_files_are_read(tmp_path):
    heights = tabor.self_affine((32, 16), ("2 um", "1 um"), rms_height="3 nm", shortest="0.3 um")
    np.save(tmp_path / "map.npy", heights)
    surface = tabor.read_heights(tmp_path / "map.npy", ("2 um", "1 um"))
    np.testing.assert_array_equal(surface.heights, heights)
    assert surface.size == pytest.approx((2e-6, 1e-6))
    half = tabor.read_heights(tmp_path / "map.npy", ("2 um", "1 um"), scale=0.5)
    np.testing.assert_allclose(half.heights, 0.5 * heights)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: tabor.heights(tabor.Sphere("-1 um"), (8, 8), "1 um"), "radius"),
        (lambda: tabor.heights(tabor.Sphere("1 um"), (8, 8), "-1 um"), "size"),
        (lambda: tabor.heights([], (8, 8), "1 um"), r'^parts: is empty; add for example Sphere\("1 um"\)'),
        (lambda: tabor.heights({"kind": "speher"}, (8, 8), "1 um"), "did you mean"),
        (lambda: tabor.heights(tabor.Flat(), (8, 8), "1 um", boundary="round"), "boundary"),
        (lambda: tabor.self_affine((8, 8), "1 um", shortest="0.1 um"), "rms"),
        (lambda: tabor.read_heights("there is none.npy", "1 um"), "there is none.npy"),
        (lambda: tabor.statistics(np.zeros((2, 2)), (1, 2, 3)), "size"),
        (lambda: tabor.statistics(np.zeros((2, 2)), 0), "size"),
        (lambda: tabor.statistics(np.array([[np.inf]]), 1), "heights"),
        (lambda: tabor.spectrum(np.zeros((2, 2)), 1, boundary="round"), "boundary"),
    ],
)
def test_mistakes_name_what_is_wrong(call, words):
    with pytest.raises(ValueError, match=words) as raised:
        call()
    assert isinstance(raised.value, tabor.TaborError)


def test_a_surface_brings_its_size(tmp_path):
    np.save(tmp_path / "map.npy", tabor.self_affine((32, 24), (4e-6, 3e-6), rms_slope=0.1, shortest=1e-6))
    read = tabor.read_heights(tmp_path / "map.npy", (4e-6, 3e-6))
    assert tabor.statistics(read) == tabor.statistics(read.heights, read.size)
    rough = tabor.Contact(read, contact_modulus="1 GPa")
    assert rough.resolved["grid"]["size"] == pytest.approx([4e-6, 3e-6])
    with pytest.raises(tabor.SurfaceError, match="size"):
        tabor.statistics(read.heights)
    with pytest.raises(tabor.SceneError, match="law: a law such as"):
        tabor.Contact(read, contact_modulus="1 GPa", law="jkr")
