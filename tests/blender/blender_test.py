"""The exporter of Blender's scenes: scenes.py makes and exports scenes in Blender, Abbe renders them, and what comes out is beside its known answer."""
import json
import math
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

import numpy as np
import OpenImageIO as oiio

HERE = pathlib.Path(__file__).resolve().parent
EXPORTER = HERE.parents[1] / "python" / "blender" / "abbe_export.py"
LUMENS_OF_GLTF = 683  # which Blender's exporter of glTF takes for one of its watts
SHORT = ["--quiet", "--threads", "2"]


def blender(*arguments):
    return subprocess.run(["blender", "-b", "--factory-startup", *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def abbe(*arguments):
    return subprocess.run([os.environ["ABBE_BINARY"], *map(str, arguments)], check=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True).stdout


def planes(path):
    """The channels X, Y and Z of a film and the variances of its pixels."""
    image = oiio.ImageBuf(str(path))
    names = image.spec().channelnames
    pixels = image.get_pixels(oiio.FLOAT).astype(float)
    return tuple(np.dstack([pixels[..., names.index(prefix + plane)] for plane in "XYZ"]) for prefix in ("", "Variance."))


def tiles(image, size):
    height, width, depth = image.shape
    return image.reshape(height // size, size, width // size, size, depth).mean(axis=(1, 3))


@unittest.skipUnless(shutil.which("blender"), "Blender is not installed")
class Exported(unittest.TestCase):
    """Exports the scenes of CASE."""

    CASE = None

    @classmethod
    def setUpClass(cls):
        if cls.CASE is None:
            raise unittest.SkipTest("of no case")
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        made = blender("--python-exit-code", "1", "-P", HERE / "scenes.py", "--", EXPORTER, cls.CASE, folder.name)
        if made.returncode != 0:
            raise AssertionError(made.stdout + made.stderr)
        cls.facts = json.loads((cls.folder / "facts.json").read_text())

    def scene(self, name):
        text = (self.folder / f"{name}.json").read_text()
        return json.loads("\n".join(line for line in text.splitlines() if not line.startswith("//")))

    def film(self, name, *options, scene=None):
        """X, Y, Z and their variances in a scene's film."""
        if scene is not None:
            (self.folder / f"{name}.json").write_text(json.dumps(scene))
        out = self.folder / f"{name}.exr"
        abbe("render", self.folder / f"{name}.json", *SHORT, "-o", out, "--display", self.folder / f"{name}.png", *options)
        return planes(out)

    def assert_equal_tiles(self, one, other, share):
        """Means over tiles of 12 pixels agree within 5 standard errors and that share."""
        (a, a_variance), (b, b_variance) = one, other
        a, b, error = tiles(a, 12), tiles(b, 12), np.sqrt((tiles(a_variance, 12) + tiles(b_variance, 12)) / 144)
        excess = np.abs(a - b) - 5 * error - share * b
        worst = np.unravel_index(excess.argmax(), excess.shape)
        self.assertLessEqual(excess.max(), 0, f"tile {worst}: {a[worst]} and {b[worst]}")
        self.assertLess(np.median((error / np.where(b > 0, b, 1))[b > 0]), share)


class Camera(Exported):
    CASE = "view"

    def test_patches_are_where_blender_sees_them(self):
        for name in ("landscape", "portrait", "vertical", "horizontal", "lens"):
            luminance = self.film(name, "--spp", "64", "--integrator", "path")[0][..., 1]
            for x, y in self.facts[name]["pixels"]:
                low_x, low_y = int(x) - 4, int(y) - 4
                window = luminance[max(low_y, 0):low_y + 9, max(low_x, 0):low_x + 9]
                rows, columns = np.indices(window.shape) + 0.5
                with self.subTest(name, x=x, y=y):
                    self.assertGreater(window.sum(), 0)
                    self.assertAlmostEqual((window * columns).sum() / window.sum() + max(low_x, 0), x, delta=0.5)
                    self.assertAlmostEqual((window * rows).sum() / window.sum() + max(low_y, 0), y, delta=0.5)

    def test_lenses_are_those_of_the_scene_and_shifts_are_told(self):
        lens = self.scene("lens")["camera"]["thin_lens"]
        self.assertEqual(lens, {"focal_length": 0.04, "f_number": 8, "focus_distance": 0.5})
        self.assertEqual(self.scene("shifted")["camera"], self.scene("landscape")["camera"])
        self.assertIn("shift of a lens", " ".join(self.facts["shifted"]["notes"]))
        self.assertEqual(self.facts["landscape"]["notes"], [])

    def test_white_is_a_radiance_of_one(self):
        for name in ("landscape", "lens"):
            luminance = self.film(name, "--spp", "64", "--integrator", "path")[0][..., 1]
            middle = luminance[47:49, 79:81].max()
            self.assertAlmostEqual(middle / self.scene(name)["output"]["exposure"], 1, delta=0.01)


class Lamps(Exported):
    CASE = "lamps"

    def irradiance(self, name, **sensor):
        scene = self.scene(name)
        scene["camera"] = {"irradiance_probe": {"at": [0, 0, 0], "normal": [0, 0, 1]}}
        scene["sensor"] = {"resolution": [8, 8], **(sensor or {"channels": {"W": {"band": [300, 1100]}}})}
        del scene["output"]
        (self.folder / "meter.json").write_text(json.dumps(scene))
        abbe("render", self.folder / "meter.json", *SHORT, "--spp", "256", "-o", self.folder / "meter.exr", "--stats", self.folder / "meter.stats")
        film = json.loads((self.folder / "meter.stats").read_text())["film"]
        return film["Y" if sensor else "W"]["mean"]

    def test_irradiance_is_that_of_the_closed_form(self):
        point = 100 / (4 * math.pi * 2**2)

        def rectangle(half_a, half_b, radiance):  # above the middle of the meter, at the distance 1
            a, b = half_a / math.hypot(1, half_a), half_b / math.hypot(1, half_b)
            return 2 * radiance * (a * math.atan(half_b / math.hypot(1, half_a)) + b * math.atan(half_a / math.hypot(1, half_b)))

        disc_area = math.pi * 0.25**2
        disc = math.pi * 100 / (4 * disc_area) * 0.25**2 / (1 + 0.25**2)
        for name, known in {"point": point, "sphere": point, "centimetres": point, "spot": point, "spot_inside": point, "spot_outside": 0,
                            "sun": 3 * math.cos(0.6), "parallel": 3 * math.cos(0.6), "square": rectangle(0.25, 0.25, 100 / (4 * 0.25)),
                            "rectangle": rectangle(0.5, 0.25, 100 / (4 * 0.5)), "disk": disc, "turned_away": 0, "patch": rectangle(0.25, 0.25, 20),
                            "world": math.pi * 0.5}.items():
            with self.subTest(name):
                self.assertAlmostEqual(self.irradiance(name), known, delta=0.01 * known)

    def test_a_colour_gives_its_share_of_the_lumens_of_white(self):
        white = self.irradiance("point", observer="1931")
        share = 0.2126 + 0.7152 * 0.5 + 0.0722 * 0.2
        self.assertAlmostEqual(self.irradiance("coloured", observer="1931") / white, share, delta=0.001)


class Panorama(Exported):
    CASE = "panorama"

    def test_a_texel_is_seen_where_blender_has_it(self):
        luminance = self.film("panorama", "--spp", "16")[0][..., 1]
        self.assertAlmostEqual(luminance[34:38, 46:50].mean() / self.scene("panorama")["output"]["exposure"], 2, delta=0.04)


class Placed(Exported):
    CASE = "placed"

    def triangles(self, name):
        header, _, body = (self.folder / name).read_bytes().partition(b"end_header\n")
        counts = {line.split()[1]: int(line.split()[2]) for line in header.decode().splitlines() if line.startswith("element")}
        width = header.decode().count("property double")
        points = np.frombuffer(body, "<f8", counts["vertex"] * width).reshape(-1, width)
        faces = np.frombuffer(body, [("count", "u1"), ("corners", "<i4", 3)], counts["face"], points.shape[0] * width * 8)
        return points[faces["corners"]]

    def test_areas_boxes_and_fronts(self):
        scene = self.scene("placed")
        found = {}
        for shape in scene["shapes"]:
            meshes, matrix = [shape.get("mesh")], np.eye(3, 4)
            if "instance" in shape:
                meshes = [part["mesh"] for part in scene["objects"][shape["instance"]["of"]]["shapes"]]
                matrix = np.array(shape["instance"]["transform"]["matrix"]).reshape(3, 4)
            for mesh in meshes:
                corners = self.triangles(mesh)[..., :3] @ matrix[:, :3].T + matrix[:, 3]
                normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
                volume = (corners[:, 0] * normals).sum() / 3 * (-1 if np.linalg.det(matrix[:, :3]) < 0 else 1)  # an instance's front stays its front
                found.setdefault(shape["name"], []).append((np.linalg.norm(normals, axis=1).sum(), volume, corners.min((0, 1)), corners.max((0, 1))))
        cubes = sorted(found["first"] + found["second"] + found["inner"], key=lambda cube: cube[2][0])
        self.assertEqual(len(cubes), 4)
        for x, height, cube in zip((0, 5, 10, 15), (1, 2, 1, 1), cubes):
            np.testing.assert_allclose(cube[0], 8 + 16 * height, rtol=1e-6)
            np.testing.assert_allclose(cube[1], 8 * height, rtol=1e-6)
            np.testing.assert_allclose([cube[2], cube[3]], [[x - 1, -1, -height], [x + 1, 1, height]], atol=1e-6)
        np.testing.assert_allclose([found["slots/grey"][0][0], found["slots/red"][0][0]], [20, 4], rtol=1e-6)
        np.testing.assert_allclose(found["slots/grey"][0][1] + found["slots/red"][0][1], 8, rtol=1e-6)
        np.testing.assert_allclose(found["array"][0][0], 72, rtol=1e-6)
        np.testing.assert_allclose(found["array"][0][3], [9, 11, 1], rtol=1e-6)
        for name in ("soft", "text"):
            np.testing.assert_allclose(found[name][0][0], self.facts[name]["area"], rtol=1e-4)

    def test_normals_stay_normal(self):
        corners, linear = self.triangles("placed_files/oblique.ply"), np.array(self.facts["oblique"])
        points, normals = corners[..., :3] - [0, 40, 0], corners[..., 3:]
        known = points @ np.linalg.inv(linear @ linear.T)  # of the ellipsoid
        cosines = (normals * known).sum(axis=-1) / np.linalg.norm(known, axis=-1)
        self.assertGreater(cosines.min(), 0.995)
        flat = np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
        self.assertTrue(((flat[:, None] * normals).sum(axis=-1) > 0).all())

    def test_a_linked_mesh_is_written_once(self):
        self.assertEqual(sorted(path.name for path in (self.folder / "placed_files").iterdir()),
                         ["array.ply", "first.ply", "oblique.ply", "slots_grey.ply", "slots_red.ply", "soft.ply", "text.ply"])


class Glass(Exported):
    CASE = "glass"

    def test_the_property_abbe_is_the_glass(self):
        radiance = 200 / (4 * 4)
        twin = {"abbe": 1, "camera": {"pinhole": {"focal_length": 0.05}, "from": [0, -6, 2], "up": [0, 0, 1],
                                      "to": [0, -6 + math.sin(math.radians(75)), 2 - math.cos(math.radians(75))]},
                "sensor": {"resolution": [96, 72], "pixel_pitch_um": 375, "observer": "1931"},
                "materials": {"N-BK7": {"dielectric": {"ior": "N-BK7"}}, "card": {"diffuse": {"reflectance": 0.6}}},
                "shapes": [{"sphere": {"center": [0, 0, 1.2], "radius": 1}, "material": "N-BK7"},
                           {"quad": {"corner": [-4, -4, 0], "edge_u": [8, 0, 0], "edge_v": [0, 8, 0]}, "material": "card"}],
                "lights": [{"quad": {"corner": [0, 0, 5], "edge_u": [2, 0, 0], "edge_v": [0, -2, 0]}, "emission": {"illuminant": "D65", "radiance": radiance}}]}
        made = self.film("glass", "--spp", "256")
        self.assert_equal_tiles(made, self.film("twin", "--spp", "256", "--seed", "1", scene=twin), 0.01)


class Plain(Exported):
    CASE = "plain"

    def test_principled_surfaces_are_those_of_gltf(self):
        abbe("convert", self.folder / "plain.gltf", "-o", self.folder / "other.json")
        text = (self.folder / "other.json").read_text()
        other = json.loads(text[text.index("{"):])
        other["sensor"]["resolution"] = [96, 72]
        per_watt = self.scene("plain")["output"]["exposure"] / (math.pi / 4 / 4**2)  # lumens
        made = self.film("plain", "--spp", "256")
        luminous = self.film("other", "--spp", "256", "--seed", "1", scene=other)
        self.assert_equal_tiles(made, (luminous[0] * per_watt / LUMENS_OF_GLTF, luminous[1] * (per_watt / LUMENS_OF_GLTF)**2), 0.01)

    def test_coats_are_as_wide_as_in_cycles(self):
        width = 0.1 - 0.099 * self.scene("plain")["materials"]["look2"]["principled"]["clearcoat_gloss"]
        self.assertAlmostEqual(width, 0.2**2, delta=1e-6)

    def test_colours_have_the_spectra_of_abbe(self):
        abbe("convert", self.folder / "plain.gltf", "-o", self.folder / "other.json")
        text = (self.folder / "other.json").read_text()
        other = json.loads(text[text.index("{"):])["materials"]
        for name in ("look0", "look1", "look2"):
            ours, theirs = (materials[name]["principled"]["base_color"]["table"] for materials in (self.scene("plain")["materials"], other))
            self.assertEqual(ours["wavelength_nm"], theirs["wavelength_nm"])
            np.testing.assert_allclose(ours["values"], theirs["values"], atol=2e-6)


class Kinds(Exported):
    CASE = "kinds"

    def test_materials_are_what_they_should_be_and_the_rest_is_told(self):
        self.film("kinds", "--spp", "1", "--integrator", "path")
        scene = self.scene("kinds")
        materials = scene["materials"]
        for name, known in {"mixed": {"mixture": [{"material": "mixed part 1", "weight": 0.75}]}, "mixed part 1": {"diffuse": {"reflectance": 0.8}},
                            "tinted": {"dielectric": {"ior": 1.45, "roughness": {"alpha": 0.25, "distribution": "beckmann"}, "absorption_per_m": 2}},
                            "metal": {"conductor": {"ior": "Al_Rakic"}}, "mirror": {"mirror": {"reflectance": 0.9}}, "fluid": {"dielectric": {"ior": 1.33}},
                            "bottle": {"dielectric": {"ior": 1.45}},
                            "glossy": {"conductor": {"ior": {"n": 1, "k": 2}, "roughness": {"alpha": 0.25, "distribution": "ggx"}}},
                            "velvet": {"diffuse": {"reflectance": 0.8}}, "default": {"diffuse": {"reflectance": 0.8}}}.items():
            self.assertEqual(materials[name], known, name)
        self.assertEqual((materials["chrome"]["principled"]["metallic"], materials["chrome"]["principled"]["base_color"]), (1, 0.5), "a metal transmits nothing")
        self.assertEqual(materials["relief"]["normal_map"], {"image": "kinds_files/texel.png", "filter": "bilinear", "wrap": "clamp", "scale": [3, 1], "offset": [0, 0]})
        shapes = {shape["name"]: shape for shape in scene["shapes"]}
        self.assertEqual([shapes[name]["mesh"] for name in ("shape0", "shape1")], ["kinds_files/shape0.obj", "kinds_files/shape1.ply"])
        self.assertEqual(shapes["shape1"]["emission"], {"illuminant": "D65", "radiance": 0.25})
        self.assertAlmostEqual(shapes["shape10"]["emission"]["luminance"], 2 * 176.80 * (0.2126 + 0.5 * 0.7874), delta=0.05)
        told = "\n".join(self.facts["kinds"]["notes"])
        for part in ('view "Filmic"', "triangles of a smooth body: use a fine mesh (3 times)", 'material "wax": warning: Subsurface', "alpha is dropped",
                     'material "fluid": warning: the colour of a clear surface', "Velvet BSDF", 'object "fog": warning: volumes', "points and lines", "elliptic",
                     'material "bottle": warning: Clearcoat of a Principled BSDF that transmits'):
            self.assertIn(part, told)
        self.assertEqual(len(self.facts["kinds"]["notes"]), 15)

    def test_rough_diffuse_surfaces_are_as_rough_as_in_cycles(self):
        def ratio(sigma_deg):  # of B to A in the qualitative model of Oren and Nayar, which Abbe takes for the roughness
            x = math.radians(sigma_deg)**2
            return 0.45 * x / (x + 0.09) / (1 - 0.5 * x / (x + 0.33))

        for name, roughness in (("clay", 0.5), ("chalk", 0.7767)):
            self.assertAlmostEqual(ratio(self.scene("kinds")["materials"][name]["oren_nayar"]["sigma_deg"]), roughness, delta=1e-6)
        self.assertIn('material "chalk": warning: a roughness of a diffuse surface above 0.7767 is clamped to that', self.facts["kinds"]["notes"])


class Faults(Exported):
    CASE = "faults"

    def refused(self, name, *arguments):
        ended = blender(self.folder / f"{name}.blend", "-P", EXPORTER, "--", *(arguments or [self.folder / "out.json"]))
        self.assertFalse((self.folder / "out.json").exists())
        told = [line for line in ended.stderr.splitlines() if line.startswith("abbe_export: ")]
        self.assertEqual(len(told), 1, ended.stderr)
        self.assertRegex(told[0], r"^[^\n]*\)\.$")
        return ended.returncode, told[0]

    def test_what_is_wrong_is_one_sentence(self):
        for name, code, part in (("no_camera", 3, "no camera"), ("empty_mesh", 3, "no surface"), ("wrong_property", 3, 'material "wrong"'),
                                 ("lost_image", 4, "lost.png")):
            with self.subTest(name):
                got, sentence = self.refused(name)
                self.assertEqual(got, code, sentence)
                self.assertIn(part, sentence)
        self.assertEqual(self.refused("no_camera", "out.txt")[0], 2)


if __name__ == "__main__":
    unittest.main()
