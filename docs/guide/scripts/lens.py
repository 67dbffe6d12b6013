#!/usr/bin/env python3
"""Parallel light and lenses by priority: the rays of docs/guide/lens.md."""
import json
import pathlib

from common import run

FLAT_MM = 100.0  # height of the lens's flat face


def back_focal_mm(nm):
    """The distance below the flat face at which a ray near the axis, which came parallel to it, crosses it."""
    path = json.loads(run(f"abbe trace data/scenes/lens.json --lambda {nm} --origin 0.5,0,300 --dir 0,0,-1 --json"))
    x, _, z = next(event["point"] for event in path["events"] if event["shape"] == "block")
    along_x, _, along_z = path["final_dir"]
    return FLAT_MM - (z - x / along_x * along_z)


found = {nm: back_focal_mm(nm) for nm in ("486.1327", "587.5618", "656.2725")}
print(found)
pathlib.Path("focus.json").write_text(json.dumps(found))
