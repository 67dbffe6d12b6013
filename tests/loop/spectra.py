"""Spectra as the tests of the loop read them by themselves: 1 nm, straight lines, 360 to 830 nm."""
import csv
import os
import pathlib

import numpy as np

DATA = pathlib.Path(os.environ["ABBE_DATA"])
NM = np.arange(360, 831)


def table(path, beyond=None):
    """The columns of a table by their names, each over NM; beyond the ends constant, or of that value."""
    with open(DATA / path, encoding="utf-8") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    numbers = np.array(rows[1:], float)
    return {name: np.interp(NM, numbers[:, 0], numbers[:, i], beyond, beyond) for i, name in enumerate(rows[0]) if i > 0}


def lamp(name):
    """An illuminant of the CIE, 0 beyond its table; A goes on by its definition."""
    if name.startswith("FL"):
        return table("illuminant/cie_FL1-12.csv", 0)[name]
    if name.startswith("LED"):
        return table("illuminant/cie_LED.csv", 0)[name]
    power = next(iter(table(f"illuminant/cie_{name}.csv", 0).values()))
    if name == "A":
        second = 1.435e7 / 2848
        defined = 100 * (560 / NM) ** 5 * np.expm1(second / 560) / np.expm1(second / NM)
        return np.where(NM > 780, defined, power)
    return power


def chart_colours(light, chart="colorchecker24_babelcolor_average"):
    """Names, XYZ of the patches and of the white, which has Y = 1, for the CIE 1931 observer."""
    observer = np.stack(list(table("observer/cie_1931_2deg.csv").values()))
    seen = observer * lamp(light)
    seen /= seen[1].sum()
    patches = table(f"reflectance/{chart}.csv")
    return list(patches), np.array([seen @ spectrum for spectrum in patches.values()]), seen.sum(axis=1)
