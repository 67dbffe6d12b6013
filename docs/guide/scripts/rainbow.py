#!/usr/bin/env python3
"""A rainbow by the sun: the angles of docs/guide/prism.md."""
import json
import pathlib

import numpy as np

from common import planes, run

SCREEN_MM, BESIDE_MM, FOV_DEG = 200, 30, 114  # from the drop to the screen, from the sun's axis to the camera, and its field of view
BANDS = '{"resolution": [200, 200], "channels": {"450": {"band": [449, 451]}, "546": {"band": [545, 547]}, "656": {"band": [655, 657]}}}'


def outer_edge_mm(image):
    """Radius around the sun's axis where the primary bow, the brightest ring, has fallen to half on its outer side."""
    edge = len(image)
    pixel_mm = 2 * SCREEN_MM * np.tan(np.radians(FOV_DEG / 2)) / edge
    rows, columns = np.mgrid[:edge, :edge] + 0.5 - edge / 2
    radius = np.hypot(columns * pixel_mm, -rows * pixel_mm - BESIDE_MM)
    ring = np.arange(100, 260)  # rings of 1 mm
    light = np.array([image[(radius >= r) & (radius < r + 1)].mean() for r in ring])
    peak = light.argmax()
    beyond = peak + np.flatnonzero(light[peak:] < light[peak] / 2)[0]
    share = (light[beyond - 1] - light[peak] / 2) / (light[beyond - 1] - light[beyond])
    return ring[beyond - 1] + 0.5 + share


run(f"abbe render data/scenes/rainbow.json --spp 64 -o bands.exr --display bands.png --quiet --set '/sensor={BANDS}' --set /lights/0/sun/angular_diameter_deg=0.05")

film = planes("bands.exr")
edges = {name: outer_edge_mm(film[name]) for name in ("450", "546", "656")}
print(edges)
pathlib.Path("edges.json").write_text(json.dumps(edges))
