"""Spectra as the tests of the loop read them by themselves: 1 nm, straight lines, 380 to 780 nm."""
import csv
import os
import pathlib

import numpy as np

DATA = pathlib.Path(os.environ["ABBE_DATA"])
NM = np.arange(380, 781)


def table(path):
    """The columns of a table by their names, each over NM; held constant beyond the ends."""
    with open(DATA / path, encoding="utf-8") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    numbers = np.array(rows[1:], float)
    return {name: np.interp(NM, numbers[:, 0], numbers[:, i]) for i, name in enumerate(rows[0]) if i > 0}


def lamp(name):
    """An illuminant of the CIE."""
    if name.startswith("FL"):
        return table("illuminant/cie_FL1-12.csv")[name]
    if name.startswith("LED"):
        return table("illuminant/cie_LED.csv")[name]
    return next(iter(table(f"illuminant/cie_{name}.csv").values()))


def chart_colours(light, chart="colorchecker24_babelcolor_average"):
    """Names, XYZ of the patches and of the white, which has Y = 1, for the CIE 1931 observer."""
    observer = np.stack(list(table("observer/cie_1931_2deg.csv").values()))
    seen = observer * lamp(light)
    seen /= seen[1].sum()
    patches = table(f"reflectance/{chart}.csv")
    return list(patches), np.array([seen @ spectrum for spectrum in patches.values()]), seen.sum(axis=1)
