#!/usr/bin/env python3
"""Choosing filters for a given accuracy: the search of docs/guide/calibration.md."""
import itertools
import json
import pathlib

from common import document, run

BLUE_NM, GREEN_NM, RED_NM = (440, 460), (530, 540, 550), (600, 610, 620)
WIDTHS_NM = (10, 40, 70)
AIM = 2  # mean CIEDE2000 of patches left out


def judge(centres, width):
    """What the camera behind three filters of a width errs at best, on patches that the correction has not seen."""
    bands = ",".join(f"{centre - width // 2}-{centre + width // 2}" for centre in centres)
    found = json.loads(run(f"abbe calibrate --camera box:{bands} --illuminant D65 --bits 0 --json"))
    return {"bands": bands, "dE00_mean": found["dE00_mean"], "left_out_dE00_mean": found["unseen_dE00_mean"],
            "gains": found["gains"], "columns": found["correction"]["columns"]}


def bars(sets):
    """An SVG of the sets' errors, one bar each."""
    lines = []
    for row, one in enumerate(sets):
        error, y = one["left_out_dE00_mean"], 20 * row + 20
        colour = "#2a7" if error < AIM else "#999"
        lines += [f'<text x="8" y="{y}">{one["bands"]} nm</text>', f'<rect x="230" y="{y - 12}" width="{100 * error:.0f}" height="15" fill="{colour}"/>',
                  f'<text x="{236 + 100 * error:.0f}" y="{y}">{error:.2f}</text>']
    return document(620, 20 * len(sets) + 10, lines)


tried = [judge(centres, WIDTHS_NM[1]) for centres in itertools.product(BLUE_NM, GREEN_NM, RED_NM)]
best = min(tried, key=lambda one: one["left_out_dE00_mean"])
centres = [sum(map(int, band.split("-"))) // 2 for band in best["bands"].split(",")]
widths = [judge(centres, width) for width in WIDTHS_NM]

for one in [*tried, *widths]:
    print(f"{one['bands']:30} {one['left_out_dE00_mean']:.2f}")
pathlib.Path("tutorial_filters.svg").write_text(bars([*tried, *widths]))
pathlib.Path("choice.json").write_text(json.dumps({"tried": tried, "best": best, "widths": widths}))
