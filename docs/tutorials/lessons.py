#!/usr/bin/env python3
"""What light does, and how it is found: the commands of lessons.md."""
import json
import pathlib
import shlex

import numpy as np

from common import planes, run

# A lamp under the ceiling of a closed room, and a lens of 1 m focal length as wide as DIAMETER.
ROOM = """{"abbe": 1,
  "camera": {"thin_lens": {"focal_length": 1, "f_number": 1}, "from": [0, 1, 3.4], "to": [0, 1, 0], "up": [0, 1, 0]},
  "sensor": {"resolution": [16, 16], "pixel_pitch_um": 62500, "channels": {"G": {"band": [500, 600]}}},
  "materials": {"wall": {"diffuse": {"reflectance": 0.7}}},
  "lights": [{"name": "lamp", "quad": {"corner": [-1, 3.5, -1], "edge_u": [2, 0, 0], "edge_v": [0, 0, 2]}, "emission": {"spectrum": 1}}],
  "shapes": [{"name": "room", "sphere": {"center": [0, 1, 0], "radius": 4}, "material": "wall"}]}"""

# Sun behind the camera, and before it a ball of droplets, or of something that scatters by the fourth power of 1/λ, both without loss.
AIR = """{"abbe": 1,
  "camera": {"pinhole": {"fov_deg": 40}, "from": [0, 0, 4], "to": [0, 0, 0], "up": [0, 1, 0]},
  "sensor": {"resolution": [48, 48], "channels": {"450": {"band": [449, 451]}, "650": {"band": [649, 651]}}},
  "materials": {"cloud": {"medium": {"scattering_per_m": 40, "phase": {"henyey_greenstein": 0.85}}},
                "air": {"medium": {"scattering_per_m": {"table": TABLE}, "phase": "rayleigh"}}},
  "lights": [{"directional": {"towards": [0, 0.3, 1]}, "emission": {"spectrum": 1}}],
  "shapes": [{"name": "ball", "sphere": {"center": [0, 0, 0], "radius": 1}, "material": "MATTER"}]}"""


# A plate seen along its normal, under a sky that is as bright everywhere.
UNDER_SKY = """{"abbe": 1,
  "camera": {"pinhole": {"fov_deg": 0.5}, "from": [0, 0, 10], "to": [0, 0, 0], "up": [0, 1, 0]},
  "sensor": {"resolution": [256, 256], "response": "energy", "channels": {"all": 1}},
  "materials": {"diffuse": {"diffuse": {"reflectance": 0.5}}, "glossy": {"phong": {"reflectance": 0.5, "exponent": 20}}},
  "lights": [{"environment": {}, "emission": {"spectrum": 1}}],
  "shapes": [{"quad": {"corner": [-9, -9, 0], "edge_u": [18, 0, 0], "edge_v": [0, 18, 0]}, "material": "MATTER"}],
  "render": {"integrator": "path", "lights": "bsdf", "max_depth": 1}}"""

# A rough plate that mirrors a lamp into the camera; whatever its size, the lamp sends the plate as much.
UNDER_LAMP = """{"abbe": 1,
  "camera": {"pinhole": {"fov_deg": 12}, "from": [0, -4, 3], "to": [0, 0, 0], "up": [0, 0, 1]},
  "sensor": {"resolution": [32, 32], "response": "energy", "channels": {"all": 1}},
  "materials": {"plate": {"conductor": {"ior": "Al_Rakic", "roughness": ROUGHNESS}}},
  "lights": [{"sphere": {"center": [0, 4, 3], "radius": RADIUS}, "emission": {"spectrum": 1}}],
  "shapes": [{"quad": {"corner": [-9, -9, 0], "edge_u": [18, 0, 0], "edge_v": [0, 18, 0]}, "material": "plate"}],
  "render": {"integrator": "path", "max_depth": 1}}"""


def spread(command):
    """Relative variance of what a path brings, over the pixels of a film that are alike and have one each."""
    run(f"{command} --spp 1 -o spread.exr --quiet")
    values = planes("spread.exr")["all"].astype(float)
    return float(values.var() / values.mean() ** 2)


def pixel_error():
    """What a pixel of lamp.exr errs by, over their mean."""
    film = planes("lamp.exr")
    return float(np.sqrt(film["Variance.all"].mean(dtype=float)) / film["all"].mean(dtype=float))


def useful(integrator, samples, diameter_m):
    """The share of all paths that would have this noise if each of them brought the same and all others nothing: as photons that are counted do,
    whose mean is n w, and its variance n w², where n of them arrive with w each."""
    told = json.loads(run(f"abbe render room.json --integrator {integrator} --spp {samples} --set /camera/thin_lens/f_number={1 / diameter_m} "
                          "-o useful.exr --stats - --quiet"))
    film = planes("useful.exr")
    return float(film["G"].sum(dtype=float) ** 2 / film["Variance.G"].sum(dtype=float)) / told["paths"]


def error(film, reference):
    """Root of the mean square of the relative differences over blocks of four by four pixels."""
    blocks = [planes(name)["Y"].reshape(8, 4, 8, 4).mean(axis=(1, 3)) for name in (film, reference)]
    return float(np.sqrt((((blocks[0] - blocks[1]) / blocks[1]) ** 2).mean()))


found = {}

pathlib.Path("room.json").write_text(ROOM)
found["useful"] = {
    "photons, 1 m": useful("photon-brute", 32, 1.0),
    "photons, 0.5 m": useful("photon-brute", 64, 0.5),
    "adjoint, 0.5 m": useful("adjoint-brute", 1024, 0.5),
    "path, 0.5 m": useful("path", 64, 0.5),
}

run("abbe render data/scenes/furnace.json --spp 64 --layers bounces:6 -o furnace.exr --quiet")
terms = planes("furnace.exr")
found["terms"] = [float(terms[f"bounce{k}.G"].mean()) for k in range(6)]

small = "abbe render data/scenes/cornell.json --set /sensor/resolution=[32,32] --quiet"
run(f"{small} --integrator path --spp 512 -o reference.exr")
found["map"] = {}
for nearest in (25, 100, 400, 1600):
    photons = json.dumps({"per_sample": 20000, "nearest": nearest}).replace(" ", "")
    run(f"{small} --integrator photon-map --spp 4 --set {shlex.quote(f'/render/photons={photons}')} -o map.exr")
    found["map"][nearest] = error("map.exr", "reference.exr")
found["ppm"] = {}
for passes in (4, 16, 64):
    run(f"{small} --integrator sppm --spp {passes} -o sppm.exr")
    found["ppm"][passes] = error("sppm.exr", "reference.exr")

found["efficacy"] = {lamp: json.loads(run(f"abbe query light {lamp} --json"))["LER_lm_per_W"] for lamp in ("A", "FL2", "FL11", "LED-B1")}

nm = np.arange(440, 661)
table = json.dumps({"wavelength_nm": nm.tolist(), "values": (0.005 * (550 / nm) ** 4).tolist(), "outside": "clamp"})
found["blue_over_red"] = {}
for matter, samples in (("cloud", 16), ("air", 256)):
    pathlib.Path(f"{matter}.json").write_text(AIR.replace("MATTER", matter).replace("TABLE", table))
    run(f"abbe render {matter}.json --spp {samples} -o {matter}.exr --quiet")
    film = planes(f"{matter}.exr")
    found["blue_over_red"][matter] = float(film["450"].mean() / film["650"].mean())

found["directions"] = {}
for matter in ("diffuse", "glossy"):
    pathlib.Path("sky.json").write_text(UNDER_SKY.replace("MATTER", matter))
    for directions in ("uniform", "cosine", "bsdf"):
        found["directions"][f"{matter}, {directions}"] = spread(f"abbe render sky.json --set /render/directions={directions}")

found["lights"] = {}
for roughness, radius in ((0.05, 0.05), (0.05, 2), (0.3, 0.05), (0.3, 2)):
    pathlib.Path("lamp.json").write_text(UNDER_LAMP.replace("ROUGHNESS", str(roughness)).replace("RADIUS", str(radius)))
    row = found["lights"][f"{roughness}, {radius}"] = {}
    for lights, heuristic in (("bsdf", "balance"), ("light", "balance"), ("mis", "balance"), ("mis", "power")):
        run(f"abbe render lamp.json --set /render/lights={lights} --set /render/heuristic={heuristic} --spp 64 -o lamp.exr --quiet")
        row[f"{lights}, {heuristic}"] = pixel_error()

found["roulette"] = {}
EVEN = '{"resolution":[256,256],"response":"energy","channels":{"all":1}}'
for albedo, depth in ((0.5, 1), (0.8, 1), (0.8, 4), (0.8, 8), (0.9, 1)):
    command = (f"abbe render data/scenes/furnace.json --set /render/integrator=path --set /render/lights=bsdf --set /render/roulette_depth={depth} "
               f"--set /materials/wall/diffuse/reflectance={albedo} --set /shapes/0/emission/spectrum={1 - albedo} "
               f"--set /camera/pinhole/fov_deg=0.5 --set {shlex.quote(f'/sensor={EVEN}')}")
    found["roulette"][f"{albedo}, {depth}"] = spread(command)

print(json.dumps(found, indent=1))
pathlib.Path("found.json").write_text(json.dumps(found))
