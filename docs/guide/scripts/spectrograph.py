#!/usr/bin/env python3
"""A prism spectrograph: the measurement of docs/guide/spectrograph.md."""
import json
import pathlib

import numpy as np

from common import planes, run

MERCURY_NM = np.array([404.6561, 435.8343, 546.0740, 576.9598, 579.0663])
CADMIUM_NM = np.array([467.8149, 479.9912, 508.5822])


def line_columns(film):
    """The middles of the lines on the array, from left to right."""
    counts = planes(film)["counts"][0]
    lit = np.flatnonzero(counts > 0.01 * counts.max())
    lines = np.split(lit, np.flatnonzero(np.diff(lit) > 1) + 1)
    strongest = max(counts[line].sum() for line in lines)  # light that goes round within the prism makes faint lines beside each
    return np.array([np.average(line + 0.5, weights=counts[line]) for line in lines if counts[line].sum() > 0.1 * strongest])


def hartmann(columns, nm):
    """Hartmann's formula nm = a + c/(column - b) through lines, by least squares of nm column = a column + b nm + (c - a b)."""
    terms = np.stack([columns, nm, np.ones_like(nm)], axis=1)
    a, b, rest = np.linalg.lstsq(terms, nm * columns, rcond=None)[0]
    return lambda column: (a * column + rest) / (column - b)


run("abbe render data/scenes/spectrograph.json --spp 4096 -o mercury.exr --quiet")
pathlib.Path("cadmium.json").write_text(json.dumps({"radiance": 50, "lines": [{"nm": nm, "width_nm": 0.01, "power": 1} for nm in CADMIUM_NM]}))
lamp = pathlib.Path("cadmium.json").read_text()
run(f"abbe render data/scenes/spectrograph.json --spp 4096 -o cadmium.exr --quiet --set '/lights/0/emission={lamp}'")

wavelength = hartmann(line_columns("mercury.exr"), MERCURY_NM)
found = wavelength(line_columns("cadmium.exr"))
print("found", found, "listed", CADMIUM_NM)
pathlib.Path("found.json").write_text(json.dumps({"found_nm": list(found), "listed_nm": list(CADMIUM_NM)}))
