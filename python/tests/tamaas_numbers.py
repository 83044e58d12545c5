"""Tamaas' examples of rough contact and of adhesion, solved by Tamaas on surfaces that tabor makes.

``python tests/tamaas_numbers.py > tests/tamaas_numbers.json`` prints the numbers with which test_peers.py compares
tabor where Tamaas is not installed. Printed by Tamaas 2.9.0.
"""

import json

import numpy as np

import tabor

POINTS, SIDE = 128, 1.0
#: Of its example adhesion.py, on an eighth of its points: spectrum from 16 waves a side on, range, work of adhesion, mean gap.
RANGE, WORK, MEAN_GAP = 2e-3, 2e-5, 5e-2
#: Of its example rough_contact.py: 4 to 32 waves a side; a load that leaves some per cent in contact.
PRESSURE = 0.02


def surface(example):
    """The heights of an example."""
    if example == "rough contact":
        return tabor.self_affine((POINTS, POINTS), SIDE, rms_slope=0.1, longest=SIDE / 4, shortest=SIDE / 32)
    return tabor.self_affine((POINTS, POINTS), SIDE, rms_height=0.025, longest=SIDE / 16, shortest=SIDE / 32)


def solved_by_tamaas(example):
    """Tractions and gaps of an example."""
    import tamaas

    tamaas.set_log_level(tamaas.LogLevel.error)
    heights = surface(example)
    model = tamaas.Model(tamaas.model_type.basic_2d, [SIDE, SIDE], [POINTS, POINTS])
    model.E, model.nu = 1.0, 0.0
    if example == "rough contact":
        tamaas.PolonskyKeerRey(model, heights, 1e-12).solve(PRESSURE)
    else:
        by_gap = tamaas.PolonskyKeerRey.gap
        solver = tamaas.PolonskyKeerRey(model, heights, 1e-12, by_gap, by_gap)
        adhesion = tamaas.ExponentialAdhesionFunctional(heights)
        adhesion.parameters = {"rho": RANGE, "surface_energy": WORK}
        solver.addFunctionalTerm(adhesion)
        solver.max_iter = 5000
        solver.solve(MEAN_GAP)
    return np.asarray(model.traction).copy(), np.asarray(model["gap"]).copy()


def solved_by_tabor(example):
    """The same by tabor."""
    if example == "rough contact":
        contact = tabor.Contact(surface(example), SIDE, contact_modulus=1.0, tolerance=1e-9)
        return contact.solve(pressure=PRESSURE)
    law = tabor.Exponential(WORK, range=RANGE)
    contact = tabor.Contact(surface(example), SIDE, contact_modulus=1.0, law=law, tolerance=1e-9)
    return contact.solve(mean_gap=MEAN_GAP)


def numbers(pressure, touching):
    """What is compared of a field."""
    return {
        "mean": float(pressure.mean()),
        "rms": float(np.sqrt((pressure**2).mean())),
        "least": float(pressure.min()),
        "greatest": float(pressure.max()),
        "points in contact": int(touching.sum()),
    }


EXAMPLES = ("rough contact", "adhesion")


if __name__ == "__main__":
    found = {}
    for each in EXAMPLES:
        traction, gap = solved_by_tamaas(each)
        # Its gaps of closed points are 0 to rounding.
        found[each] = numbers(traction, gap <= 1e-12)
    print(json.dumps(found, indent=2))
