#!/usr/bin/env python3
"""Newton's crucial experiment: the colours and deviations of docs/guide/prism.md, from the newton.json of that page."""
import json
import pathlib

import numpy as np

from common import above, planes, run

APEX_DEG, INCIDENCE_DEG, DESIGN_NM = 60, 63.632, 546.074  # of both prisms
SCREEN_MM, EXIT_MM, WIDTH_MM = 200, 189, 48  # from the pivot and from the prism to the screen; the width that the camera sees
COLOURS_NM = (460, DESIGN_NM, 620)


def deviations(incidence_deg):
    """Deviations by the formula, in degrees."""
    wavelengths = ",".join(map(str, COLOURS_NM))
    answer = json.loads(run(f"abbe query prism N-SF11 --apex {APEX_DEG} --incidence {incidence_deg} --at {wavelengths} --json"))
    return answer["deviation_deg"]


def sun(deviation_deg):
    """The option that lets the sun shine on prism 1 so that light of this deviation leaves it along +x."""
    angle = np.radians(deviation_deg)
    return f"--set /lights/0/sun/towards={[-np.cos(angle), 0, np.sin(angle)]}".replace(" [", "[").replace(", ", ",")


def position_mm(channel):
    """The centroid along the screen, towards greater deviation."""
    light = channel.mean(axis=0)
    return ((np.arange(light.size) + 0.5) / light.size - 0.5) @ light / light.sum() * WIDTH_MM


pictures = ["white.png"]
run("abbe render newton.json --spp 48 -o white.exr --display white.png --quiet --set /lights/0/sun/towards=[-1,0,0] --set /shapes/0/transform/translate=[0,0,100]")

found = {"nm": COLOURS_NM, "query_deg": deviations(INCIDENCE_DEG), "screen_deg": []}
for nm, deviation_deg in zip(COLOURS_NM, found["query_deg"]):
    pictures.append(f"{nm}.png")
    run(f"abbe render newton.json --spp 48 -o colour.exr --display {nm}.png --quiet {sun(deviation_deg)}")
    band = f'{{"resolution":[480,60],"channels":{{"band":{{"band":[{nm - 1},{nm + 1}]}}}}}}'
    run(f"abbe render newton.json --spp 16 -o band.exr --quiet {sun(deviation_deg)} --set '/sensor={band}'")
    from_design = np.degrees(np.arctan(position_mm(planes("band.exr")["band"]) / EXIT_MM))
    found["screen_deg"].append(deviations(INCIDENCE_DEG)[1] + from_design)

above(pictures, "newton.png")
print(json.dumps(found))
pathlib.Path("newton_found.json").write_text(json.dumps(found))
