"""The picture of hurst.toml: pull-off beside Persson, the bearing-area model, and Pastewka and Robbins' criterion.

`python hurst.py RUNS.csv PICTURE.png` after `tabor sweep hurst.toml`.
"""

import sys

import matplotlib
import numpy as np

from tabor import tables, theory

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

# As in adhesive.toml.
MODULUS, WORK, SIDE = 1e6, 0.05, 10e-6
LONGEST, ROLLOFF, SHORTEST = 10e-6, 5e-6, 0.625e-6
AREA = SIDE**2


def rms_height(hurst, slope):
    """The rms height of a spectrum with an rms slope: both are proportional to its amplitude."""
    return slope / theory.spectrum.statistics(hurst, LONGEST, ROLLOFF, SHORTEST, 1.0).rms_slope


def persson(hurst, slope, reach):
    """Greatest mean tension, Pa; NaN where that theory finds none from 1e-5 of E* h' on."""
    height = rms_height(hurst, slope)
    return theory.persson.pull_off(hurst, LONGEST, ROLLOFF, SHORTEST, height, MODULUS, WORK, reach, law="maugis-dugdale")[0]


def bearing_area(hurst, slope, reach):
    """Greatest mean tension, Pa; NaN where the model has none."""
    return theory.bam.pull_off(rms_height(hurst, slope), ROLLOFF, MODULUS, WORK, reach)[0]


def main(runs, picture):
    table = tables.read(runs)
    hursts, reaches = np.unique(table["surface.0.hurst"]), np.unique(table["adhesion.range"])
    figure, every = plt.subplots(len(reaches), len(hursts), figsize=(10, 9), sharex=True, sharey=True, layout="constrained")
    print("hurst  range [nm]  rms slope  Tabor number  stickiness  pull-off [kPa]  spread  Persson  BAM")
    for row, reach in zip(every, reaches):
        for axes, hurst in zip(row, hursts):
            here = table[(table["surface.0.hurst"] == hurst) & (table["adhesion.range"] == reach)]
            slopes = np.unique(here["surface.0.rms_slope"])
            found = [here["pull_off_force"][here["surface.0.rms_slope"] == slope] / AREA / 1e3 for slope in slopes]
            mean, spread = [np.mean(each) for each in found], [np.std(each, ddof=1) for each in found]
            axes.errorbar(slopes, mean, spread, fmt="ko", markersize=4, label="full field, ten surfaces")
            fine = np.geomspace(slopes[0], slopes[-1], 15)
            axes.loglog(fine, [persson(hurst, slope, reach) / 1e3 for slope in fine], "-", label="Persson")
            axes.loglog(fine, [bearing_area(hurst, slope, reach) / 1e3 for slope in fine], "--", label="bearing area (BAM)")
            statistics = theory.spectrum.statistics(hurst, LONGEST, ROLLOFF, SHORTEST, rms_height(hurst, slopes))
            ratio = theory.pastewka_robbins.stickiness_ratio(slopes, statistics.rms_curvature, WORK, MODULUS, reach)
            numbers = theory.tabor_parameter(statistics.typical_radius, MODULUS, WORK, reach)
            for slope, one in zip(slopes, ratio):
                axes.plot(slope, 3.0, "^" if one < 1 else "v", color="C2" if one < 1 else "C3", markersize=5)
            axes.axhline(WORK / reach / 1e3, color="0.8", zorder=0)
            axes.set_title(f"H = {hurst:g}, range {1e9 * reach:.0f} nm, Tabor number {numbers[-1]:.1f} to {numbers[0]:.1f}", fontsize=8)
            for values in zip(slopes, numbers, ratio, mean, spread):
                slope = values[0]
                models = persson(hurst, slope, reach) / 1e3, bearing_area(hurst, slope, reach) / 1e3
                print(f"{hurst:5g}  {1e9 * reach:10.0f}  {slope:9.3g}  {values[1]:12.2f}  {values[2]:10.3g}", end="")
                print(f"  {values[3]:14.1f}  {values[4]:6.1f}  {models[0]:7.1f}  {models[1]:5.1f}")
    every[0, 0].set_ylim(2.0, 1e3)
    every[0, 0].legend(fontsize=7)
    for axes in every[-1]:
        axes.set_xticks([0.05, 0.1, 0.2, 0.4, 0.8], ["0.05", "0.1", "0.2", "0.4", "0.8"])
        axes.minorticks_off()
        axes.set_xlabel("rms slope")
    for row in every:
        row[0].set_ylabel("pull-off tension [kPa]")
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(*sys.argv[1:])
