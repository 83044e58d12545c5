"""Force curves fitted."""

from pathlib import Path

import numpy as np
import pytest

import tabor
from tabor import theory

# What a fit says of its doubts is no error here.
pytestmark = pytest.mark.filterwarnings("ignore::tabor.TaborWarning")
SPHERE = ("10 um", "1 GPa", "50 mJ/m^2")


def curve(noise=0.0):
    state = theory.maugis_dugdale.at_force(*SPHERE, "5 MPa", np.linspace(-2.6e-6, 1e-5, 200))
    generator = np.random.default_rng(1)
    return state.approach, state.force + noise * generator.normal(size=200)


def test_a_curve_gives_back_its_sphere():
    found = tabor.fit(curve(5e-9), radius="10 um")
    for name, true in (("work_of_adhesion", 0.05), ("contact_modulus", 1e9)):
        estimate = getattr(found, name)
        # Three standard deviations, and the 1 % of the curve's few points.
        assert abs(estimate.value - true) < 3 * estimate.uncertainty + 0.01 * true
    assert found.curve.dtype.names[:2] == ("approach", "position")
    assert "Fit" in repr(found)


def test_all_kinds_of_curves_are_the_same(tmp_path):
    approach, force = curve()
    pandas = pytest.importorskip("pandas")
    np.savetxt(tmp_path / "curve.csv", np.c_[approach, force], delimiter=",", header="approach,force", comments="")
    table = np.rec.fromarrays([approach, force], names="approach,force")
    kinds = [
        (approach, force),
        {"approach": approach, "force": force},
        table,
        pandas.DataFrame({"approach": approach, "force": force}),
        tmp_path / "curve.csv",
    ]
    fits = [tabor.fit(kind, radius="10 um", contact_at_zero=True) for kind in kinds]
    assert len({fit.work_of_adhesion for fit in fits}) == 1


def test_columns_that_are_not_asked_for_may_hold_anything():
    approach, force = curve(5e-9)
    plain = tabor.fit((approach, force), radius="10 um").work_of_adhesion
    dates = np.datetime64("2026-01-01") + np.arange(200).astype("timedelta64[s]")
    texts = np.array(['dry, "cold"'] * 200, dtype=object)
    beside = {"note, or none": texts, "time": dates, "approach": approach, "force": force}
    assert tabor.fit(beside, radius="10 um").work_of_adhesion == plain
    # Rows that began with # were left out as comments.
    odd = np.array(["#1", "a;b\tc", "two\nlines", None] * 50, dtype=object)
    for name in ("note; or none", "# note", "note\tor none", "two\nlines"):
        assert tabor.fit({name: odd, "approach": approach, "force": force}, radius="10 um").work_of_adhesion == plain
    pandas = pytest.importorskip("pandas")
    assert tabor.fit(pandas.DataFrame(beside), radius="10 um").work_of_adhesion == plain
    with pytest.raises(tabor.FitError, match="time: real numbers are expected"):
        tabor.fit(beside, radius="10 um", relaxation=True)


def test_masked_points_are_missing():
    approach, force = curve(5e-9)
    junk = np.arange(200) % 10 == 0
    masked = np.ma.array(np.where(junk, 1e-3, force), mask=junk)
    assert tabor.fit((approach, masked), radius="10 um").work_of_adhesion == tabor.fit((approach[~junk], force[~junk]), radius="10 um").work_of_adhesion


def test_a_list_is_a_curve_too():
    assert tabor.fit(list(curve()), radius="10 um").work_of_adhesion == tabor.fit(curve(), radius="10 um").work_of_adhesion


def test_a_share_may_be_in_per_cent():
    widened = [tabor.fit(curve(), radius="10 um", spring_error=share) for share in (0.1, "10%", " 10 % ")]
    alone = tabor.fit(curve(), radius="10 um")
    assert len({found.work_of_adhesion.uncertainty for found in widened}) == 1
    assert widened[0].work_of_adhesion.uncertainty > alone.work_of_adhesion.uncertainty


def test_advice():
    found = tabor.fit(curve(5e-9), radius="10 um", advise=True)
    assert set(found.advice["probabilities"]) == {"hertz", "dmt", "jkr", "maugis-dugdale", "none"}
    assert sum(found.advice["probabilities"].values()) == pytest.approx(1.0, abs=1e-9)
    assert tabor.fit(curve(5e-9), radius="10 um").report.get("advice") is None
    with pytest.raises(tabor.FitError, match="sphere"):
        tabor.fit(curve(), cone=0.3, advise=True)


def test_words():
    with pytest.warns(tabor.TaborWarning) as told:
        found = tabor.fit(Path(__file__).parents[2] / "examples" / "force_curve.csv", radius="10 um", radius_error=0.02)
    assert found.warnings == [str(each.message) for each in told]
    page = found._repr_html_()
    assert found.model in page and "mJ/m^2 ± " in page and "Tabor parameter" in page
    assert all(f"warning{'' if not number else f' {number + 1}'}<" in page for number, _ in enumerate(found.warnings))


def test_pictures():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    axes = tabor.fit(curve(5e-9), radius="10 um").plot()
    assert axes.get_xlabel().startswith("approach")


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: tabor.fit(curve()), "radius"),
        (lambda: tabor.fit(curve(), radius=1e-5, cone=0.3), "radius"),
        (lambda: tabor.fit(curve(), radius=-1.0), "radius"),
        (lambda: tabor.fit(curve(), radius="1 Pa"), "radius"),
        (lambda: tabor.fit(([0.0], [0.0]), radius=1e-5), "row"),
        (lambda: tabor.fit((np.zeros(3), np.zeros(4)), radius=1e-5), "one length"),
        (lambda: tabor.fit((np.zeros(3),), radius=1e-5), "approach"),
        (lambda: tabor.fit({"force": np.zeros(20)}, radius=1e-5), "approach"),
        (lambda: tabor.fit(3.0, radius=1e-5), "curve"),
        (lambda: tabor.fit("none.csv", radius=1e-5), "none.csv"),
        (lambda: tabor.fit(curve(), radius=1e-5, spring_error=10), 'spring_error: "10.0" must be a share'),
        (lambda: tabor.fit(curve(), radius=1e-5, radius_error="ten %"), "radius_error"),
        (lambda: tabor.fit(curve(), radius=1e-5, columns=["depth=1"]), "columns"),
        (lambda: tabor.fit(curve(), radius=1e-5, columns=[1]), r"columns: a list of texts .* not \[1\]"),
        (lambda: tabor.fit(curve(), radius=1e-5, range=-1e-9), "range: -1e-09 is not above zero"),
        (lambda: tabor.fit(curve(), radius=1e-5, spring=0), "spring: 0 is not above zero"),
        (lambda: tabor.fit(curve(), radius=1e-5, baseline="no"), "baseline: True or False is expected, not 'no'"),
        (lambda: tabor.fit(curve(), cone="70 deg", range=1e-9), "range: of spheres only"),
        (lambda: tabor.fit(np.array(curve()), radius=1e-5), r"curve: .* \(approach, force\) are expected, not ndarray"),
        (lambda: tabor.fit((curve()[0] + 0j, curve()[1]), radius=1e-5), "approach: real numbers are expected, not complex128"),
        (lambda: tabor.fit((curve()[0], np.inf * curve()[1]), radius=1e-5), "force: .* values are infinite; what is missing is NaN"),
    ],
)
def test_mistakes_name_what_is_wrong(call, words):
    with pytest.raises(ValueError, match=words) as raised:
        call()
    assert isinstance(raised.value, tabor.TaborError)
