#!/usr/bin/env python3
"""What light does, and how it is found: the experiments of docs/guide/light_paths.md."""
import json
import pathlib
import shlex

import numpy as np

from common import Axis, Panel, Series, beside, figure, planes, run, table

# A lamp under the ceiling of a closed room, and a lens of 1 m focal length as wide as DIAMETER.
ROOM = """{"abbe": 1,
  "camera": {"thin_lens": {"focal_length": 1, "f_number": 1}, "from": [0, 1, 3.4], "to": [0, 1, 0], "up": [0, 1, 0]},
  "sensor": {"resolution": [16, 16], "pixel_pitch_um": 62500, "channels": {"G": {"band": [500, 600]}}},
  "materials": {"wall": {"diffuse": {"reflectance": 0.7}}},
  "lights": [{"name": "lamp", "quad": {"corner": [-1, 3.5, -1], "edge_u": [2, 0, 0], "edge_v": [0, 0, 2]}, "emission": {"spectrum": 1}}],
  "shapes": [{"name": "room", "sphere": {"center": [0, 1, 0], "radius": 4}, "material": "wall"}]}"""

# Sun behind the camera, and before it a ball of droplets, or of something that scatters by the fourth power of 1/λ, both without loss. The droplets
# send light evenly in all directions, which makes less noise than their forward lobe and is as white.
AIR = """{"abbe": 1,
  "camera": {"pinhole": {"fov_deg": 40}, "from": [0, 0, 4], "to": [0, 0, 0], "up": [0, 1, 0]},
  "sensor": {"resolution": [48, 48], "channels": {"450": {"band": [449, 451]}, "650": {"band": [649, 651]}}},
  "materials": {"cloud": {"medium": {"scattering_per_m": 20}},
                "air": {"medium": {"scattering_per_m": {"table": THIN}, "phase": "rayleigh"}}},
  "lights": [{"directional": {"towards": [0, 0.3, 1]}, "emission": {"spectrum": 1}}],
  "shapes": BALLS}"""

# What an eye sees of both balls from afar.
FROM_AFAR = {"/camera": {"pinhole": {"fov_deg": 11}, "from": [0, 0, 12], "to": [0, 0, 0], "up": [0, 1, 0]},
             "/sensor": {"resolution": [144, 72], "observer": "1931"}, "/output/white": "E"}

# A plate seen along its normal, under a sky that is as bright everywhere.
UNDER_SKY = """{"abbe": 1,
  "camera": {"pinhole": {"fov_deg": 0.5}, "from": [0, 0, 10], "to": [0, 0, 0], "up": [0, 1, 0]},
  "sensor": {"resolution": [256, 256], "response": "energy", "channels": {"all": 1}},
  "materials": {"diffuse": {"diffuse": {"reflectance": 0.5}}, "glossy": {"phong": {"reflectance": 0.5, "exponent": EXPONENT}}},
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

# All four plates and lamps of Veach: the plates ever rougher and each turned so that it mirrors the row of lamps into the camera, the lamps ever larger and of one power.
EYE = np.array([0, 2, 15])
PLATES = {0.01: (-2.40, -0.13), 0.04: (-3.06, 0.92), 0.1: (-3.58, 2.22), 0.25: (-3.91, 3.57)}  # (y, z) of their middles by their roughness
LAMPS = {-3.75: 0.05, -1.25: 0.15, 1.25: 0.4, 3.75: 0.9}  # radii by their x


def unit(vector):
    return vector / np.linalg.norm(vector)


def plate(roughness):
    """A plate of 8 m by 1 m."""
    middle = np.array([0, *PLATES[roughness]])
    up, sideways = np.cross(unit(unit(EYE - middle) + unit(-middle)), [1, 0, 0]), np.array([8, 0, 0])
    corner = middle - sideways / 2 - up / 2
    return {"quad": {"corner": corner.tolist(), "edge_u": sideways.tolist(), "edge_v": up.tolist()}, "material": f"{roughness}"}


def veach():
    """The scene of all plates and lamps."""
    return {"abbe": 1,
            "camera": {"pinhole": {"fov_deg": 28}, "from": EYE.tolist(), "to": [0, -1.8, 2.5], "up": [0, 1, 0]},
            "sensor": {"resolution": [208, 130], "observer": "1931"},
            "materials": {f"{roughness}": {"conductor": {"ior": "Al_Rakic", "roughness": roughness}} for roughness in PLATES},
            "lights": [{"sphere": {"center": [x, 0, 0], "radius": radius}, "emission": {"spectrum": 1 / radius**2}} for x, radius in LAMPS.items()],
            "shapes": [plate(roughness) for roughness in PLATES],
            "render": {"integrator": "path", "max_depth": 1},
            "output": {"exposure": 4000, "white": "E"}}


def balls(path, places, air_per_m):
    """Writes the scene of balls of these kinds of matter at these x, where the air scatters so much at 550 nm."""
    nm = np.arange(360, 831)
    thin = {"wavelength_nm": nm.tolist(), "values": (air_per_m * (550 / nm) ** 4).tolist(), "outside": "clamp"}
    shapes = [{"name": matter, "sphere": {"center": [x, 0, 0], "radius": 1}, "material": matter} for matter, x in places.items()]
    pathlib.Path(path).write_text(AIR.replace("THIN", json.dumps(thin)).replace("BALLS", json.dumps(shapes)))


def settings(values):
    """Options that set keys of a scene, by their pointers."""
    return " ".join(f"--set {shlex.quote(f'{pointer}={json.dumps(value)}')}" for pointer, value in values.items())


def spread(command):
    """Relative variance of what a path brings, over the pixels of a film that are alike and have one each."""
    run(f"{command} --spp 1 -o spread.exr --quiet")
    values = planes("spread.exr")["all"].astype(float)
    return float(values.var() / values.mean() ** 2)


def pixel_error(command):
    """What a pixel errs by, over their mean, as films of four seeds tell."""
    films = []
    for seed in range(4):
        run(f"{command} --seed {seed} -o lamp.exr --quiet")
        films.append(planes("lamp.exr"))
    variance, mean = (np.mean([film[plane].mean(dtype=float) for film in films]) for plane in ("Variance.all", "all"))
    return float(np.sqrt(variance) / mean)


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
    "photons": {1.4: useful("photon-brute", 16, 1.4), 1: useful("photon-brute", 32, 1), 0.5: useful("photon-brute", 64, 0.5)},
    "adjoint": {diameter: useful("adjoint-brute", 512, diameter) for diameter in (1.4, 1, 0.5)},
    "path": {diameter: useful("path", 64, diameter) for diameter in (1.4, 1, 0.5)},
}

run("abbe render data/scenes/furnace.json --spp 64 --layers bounces:6 -o furnace.exr --quiet")
terms = planes("furnace.exr")
found["terms"] = [float(terms[f"bounce{k}.G"].mean()) for k in range(6)]

small = "abbe render data/scenes/cornell.json --set /sensor/resolution=[32,32] --quiet"
run(f"{small} --integrator path --spp 512 -o reference.exr")
found["map"] = {}
for nearest in (25, 100, 400, 1600):
    photons = settings({"/render/photons": {"per_sample": 20000, "nearest": nearest}})
    run(f"{small} --integrator photon-map --spp 8 {photons} -o map.exr")
    found["map"][nearest] = error("map.exr", "reference.exr")
found["ppm"] = {}
for passes in (4, 16, 64):
    run(f"{small} --integrator sppm --spp {passes} -o sppm.exr")
    found["ppm"][passes] = error("sppm.exr", "reference.exr")

found["efficacy"] = {lamp: json.loads(run(f"abbe query light {lamp} --json"))["LER_lm_per_W"] for lamp in ("A", "FL2", "FL11", "LED-B1")}

found["blue_over_red"] = {}
for matter, samples in (("cloud", 16), ("air", 256)):
    balls(f"{matter}.json", {matter: 0}, 0.005)
    run(f"abbe render {matter}.json --spp {samples} -o {matter}.exr --quiet")
    film = planes(f"{matter}.exr")
    found["blue_over_red"][matter] = float(film["450"].mean() / film["650"].mean())
balls("sky.json", {"cloud": -1.05, "air": 1.05}, 0.3)
run(f"abbe render sky.json --spp 24 -o sky.exr --display lessons_sky.png --quiet {settings(FROM_AFAR)}")

found["directions"] = {directions: {} for directions in ("uniform", "cosine", "bsdf")}
for exponent in (1, 5, 20, 40):  # 1 is that of a diffuse plate
    pathlib.Path("sky.json").write_text(UNDER_SKY.replace("MATTER", "glossy" if exponent > 1 else "diffuse").replace("EXPONENT", str(exponent)))
    for directions, variances in found["directions"].items():
        variances[exponent] = spread(f"abbe render sky.json --set /render/directions={directions}")

found["lights"] = {}
for roughness, radius in ((0.05, 0.05), (0.05, 2), (0.3, 0.05), (0.3, 2)):
    pathlib.Path("lamp.json").write_text(UNDER_LAMP.replace("ROUGHNESS", str(roughness)).replace("RADIUS", str(radius)))
    row = found["lights"][f"{roughness}, {radius}"] = {}
    for lights, heuristic in (("bsdf", "balance"), ("light", "balance"), ("mis", "balance"), ("mis", "power")):
        row[f"{lights}, {heuristic}"] = pixel_error(f"abbe render lamp.json --set /render/lights={lights} --set /render/heuristic={heuristic} --spp 64")

pathlib.Path("plates.json").write_text(json.dumps(veach()))
for lights, heuristic in (("bsdf", "balance"), ("light", "balance"), ("mis", "power")):
    run(f"abbe render plates.json --set /render/lights={lights} --set /render/heuristic={heuristic} --spp 16 -o plates.exr --display {lights}.png --quiet")

found["roulette"] = {}
EVEN = {"/camera/pinhole/fov_deg": 0.5, "/sensor": {"resolution": [256, 256], "response": "energy", "channels": {"all": 1}}}
for albedo, depth in ((0.5, 3), (0.5, 4), (0.8, 7), (0.8, 9), (0.8, 12), (0.9, 14), (0.9, 20)):
    walls = {"/materials/wall/diffuse/reflectance": albedo, "/shapes/0/emission/spectrum": 1 - albedo}
    command = f"abbe render data/scenes/furnace.json --set /render/integrator=path --set /render/lights=bsdf --set /render/roulette_depth={depth}"
    found["roulette"][f"{albedo}, {depth}"] = spread(f"{command} {settings({**walls, **EVEN})}")

BLUE, RED, GREEN, GREY = "#2166ac", "#c0392b", "#1b7837", "#777"


def measured(name, colour, values, line=""):
    """Dots at the values by their x."""
    return Series(name, colour, [(float(x), y) for x, y in values.items()], line, dots=True)


def formula(name, colour, f, xs, line="solid"):
    """The curve of a formula over xs."""
    return Series(name, colour, [(x, f(x)) for x in xs], line)


beside(["bsdf.png", "light.png", "mis.png"], "lessons_plates.png")

useful_of = found["useful"]
widths, per_area = (0.3, 2), np.mean([share / diameter**2 for diameter, share in useful_of["photons"].items()])
shares = [measured("camera paths connected to the lamp", GREEN, useful_of["path"]), measured("adjoint photons", RED, useful_of["adjoint"]),
          measured("photons", BLUE, useful_of["photons"]), formula("as the lens's area", BLUE, lambda d: per_area * d**2, widths, "dashed")]
neumann = [measured("measured", BLUE, dict(enumerate(found["terms"]))), formula("0.8 of the one before", BLUE, lambda k: found["terms"][0] * 0.8**k, range(6))]
figure("lessons_photons.svg",
       Panel("Useful share of what is traced", Axis("diameter of the lens [m]", (0.25, 0.5, 1, 2), log=True), Axis("share", (1e-4, 1e-3, 1e-2, 0.1, 1, 10, 100), log=True), shares),
       Panel("Terms of the Neumann series", Axis("reflections", range(6)), Axis("film value", (0.1, 0.2, 0.4, 0.8), log=True), neumann))

errors = Axis("difference", (0.02, 0.05, 0.1, 0.2, 0.5), log=True)
figure("lessons_maps.svg",
       Panel("A photon map", Axis("nearest photons", (10, 100, 1000, 10000), log=True), errors, [measured("measured", BLUE, found["map"], "solid")]),
       Panel("Progressive maps", Axis("passes", (1, 4, 16, 64, 256), log=True), errors,
             [measured("measured", BLUE, found["ppm"]), formula("1/√passes", BLUE, lambda passes: found["ppm"][4] * (4 / passes) ** 0.5, (4, 64), "dashed")]))

exponents = np.linspace(1, 40, 79)
formulas = {"uniform": (BLUE, lambda n: n**2 / (2 * n + 1)), "cosine": (RED, lambda n: (n - 1) ** 2 / (4 * n)), "bsdf": (GREEN, lambda n: 0)}
figure("lessons_directions.svg",
       Panel("Directions under an even sky", Axis("Phong's exponent", (1, 10, 20, 30, 40)), Axis("relative variance", (0, 5, 10, 15, 20)),
             [one for name, (colour, f) in formulas.items() for one in (formula(name, colour, f, exponents), measured("", colour, found["directions"][name]))]))

played = []
for albedo, colour in ((0.5, BLUE), (0.8, RED), (0.9, GREEN)):
    depths = np.linspace(np.log(0.25) / np.log(albedo), min(20, np.log(0.025) / np.log(albedo)), 60)
    played += [formula(f"albedo {albedo}", colour, lambda d, a=albedo: a**d * ((1 + a) / 4 - a**d), depths),
               measured("", colour, {case.split(", ")[1]: variance for case, variance in found["roulette"].items() if case.startswith(f"{albedo},")})]
figure("lessons_roulette.svg", Panel("What roulette costs", Axis("events before roulette", (2, 5, 10, 15, 20)), Axis("relative variance", (0, 0.02, 0.04, 0.06)), played))

spectra = []
for (lamp, efficacy), file, colour in zip(found["efficacy"].items(), ("A", "FL1-12", "FL1-12", "LED"), (RED, GREY, GREEN, BLUE)):
    columns = table(f"data/illuminant/cie_{file}.csv")
    nm, power = columns["wavelength_nm"], columns[lamp]
    seen = (nm >= 380) & (nm <= 780)
    spectra.append(Series(f"{lamp}: {efficacy:.0f} lm/W", colour, list(zip(nm[seen], 1000 * power[seen] / np.trapz(power, nm))), "solid"))
figure("lessons_lamps.svg", Panel("Lamps of one watt", Axis("wavelength [nm]", (380, 480, 580, 680, 780)), Axis("power [mW/nm]", (0, 10, 20, 30)), spectra))

print(json.dumps(found, indent=1))
pathlib.Path("found.json").write_text(json.dumps(found))
