"""Meters of scenes: the results equal those of the command."""
import json
import math
import os
import unittest
import warnings

import numpy

import abbe
from common import SCENES, Test, box

METERS = {
    "floor": {"at": [0, 0, 0.5], "normal": [0, 0, 1], "spectrum": {"from_nm": 400, "to_nm": 700, "step_nm": 100}},
    "grid": {"measures": "flux", "quad": {"corner": [0, 0, 1], "edge_u": [3, 0, 0], "edge_v": [0, 2, 0]}, "cells": [3, 2]},
    "sight": {"measures": "radiance", "at": [0, 0, 1], "normal": [0, 0, -1], "acceptance_deg": 2},
}


class Meters(Test):
    def scene(self, **keys):
        scene = {"abbe": 1, **box(meters=METERS), **keys}
        (self.scratch / "scene.json").write_text(json.dumps(scene))
        return scene

    def told(self, *options):
        return {meter["name"]: meter for meter in json.loads(self.command("meter", "scene.json", "--json", "--quiet", *options))["meters"]}

    def compare(self, found, told):
        self.assertEqual(list(found), list(told))
        for name, meter in told.items():
            self.assertEqual(set(found[name]), set(meter) - {"wall_s"})
            for key in ("name", "measures", "radiant", "luminous", "photons", "integrator", "seed", "samples"):
                self.assertEqual(found[name][key], meter[key], f"{name}: {key}")
            for key in {"cells", "spectrum"} & set(meter):
                for column, array in found[name][key].items():
                    self.assertIsInstance(array, numpy.ndarray)
                    numpy.testing.assert_array_equal(array.ravel(), meter[key][column], f"{name}: {column}")

    def test_the_numbers_are_those_of_the_command(self):
        scene = self.scene()
        told = self.told()
        found = abbe.meter(scene)
        self.compare(found, told)
        self.compare(abbe.meter(self.scratch / "scene.json", threads=1), told)
        self.compare(abbe.meter(abbe.Scene(self.scratch / "scene.json")), told)
        self.compare(abbe.meter(abbe.Scene(scene)), told)
        self.assertEqual(found["grid"]["cells"]["photons"].shape, (2, 3))
        # A sky of 1 W/(m2 sr nm) over 300-1100 nm.
        self.assertAlmostEqual(found["floor"]["radiant"]["value"], 800 * math.pi, delta=3 * found["floor"]["radiant"]["half_interval_95"] + 1e-6)

    def test_arguments_are_the_options_of_the_command(self):
        scene = self.scene()
        self.compare(abbe.meter(scene, spp=8, seed=5, integrator="bdpt", only=["grid", "floor"]),
                     self.told("--spp", 8, "--seed", 5, "--integrator", "bdpt", "--only", "grid", "--only", "floor"))
        self.compare(abbe.meter(scene, only="sight", error=0.01), self.told("--only", "sight", "--error", "1%"))

    def test_what_lamps_lie_on_is_told_once_for_all_meters(self):
        panel = {"corner": [-1, -1, 3], "edge_u": [0, 2, 0], "edge_v": [2, 0, 0]}
        scene = {"abbe": 1, "materials": {"black": {"diffuse": {"reflectance": 0}}}, "shapes": [{"quad": panel, "material": "black"}],
                 "lights": [{"quad": panel, "emission": {"spectrum": 1}}], "meters": {name: METERS["floor"] for name in ("a", "b")}}
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            abbe.meter(scene, spp=1)
        self.assertEqual([str(warning.message) for warning in told],
                         ['"shape 0" and "light 0" coincide within single precision: rays hit only one of the two surfaces, '
                          'so that the other has no effect or its light is lost; separate them'])

    def test_a_scene_with_meters_needs_no_camera(self):
        scene = self.scene()
        without = {key: value for key, value in scene.items() if key not in ("camera", "sensor")}
        for found, beside in zip(abbe.meter(without).values(), abbe.meter(scene).values()):
            self.assertEqual(found["radiant"], beside["radiant"])

    def test_a_scene_is_read_from_where_it_was_whatever_the_current_folder(self):
        self.addCleanup(os.chdir, os.getcwd())
        for name, reflectance in (("a", 0.2), ("b", 0.8)):
            (self.scratch / name).mkdir()
            (self.scratch / name / "r.csv").write_text(f"# unit: 1\nwavelength_nm,r\n300,{reflectance}\n1100,{reflectance}\n")
            scene = {"abbe": 1, **box(meters={"up": {"at": [0, 0, 1], "normal": [0, 0, -1]}}),
                     "materials": {"grey": {"diffuse": {"reflectance": "r.csv:r"}}}}
            (self.scratch / name / "scene.json").write_text(json.dumps(scene))
        os.chdir(self.scratch / "a")
        scenes = [abbe.Scene("scene.json"), abbe.Scene(scene), abbe.Scene(scene, folder=".")]
        here = [abbe.meter(one, spp=16)["up"]["radiant"] for one in scenes]
        os.chdir(self.scratch / "b")
        self.assertEqual([abbe.meter(one, spp=16)["up"]["radiant"] for one in scenes], here)
        self.assertEqual(repr(scenes[0]).split(":")[0], "<abbe.Scene scene.json")

    def test_what_is_wrong_is_told(self):
        scene = self.scene()
        with self.assertRaisesRegex(abbe.UsageError, r'only: no such meter \(got "flor", allowed floor, grid, sight\)'):
            abbe.meter(scene, only="flor")
        with self.assertRaisesRegex(abbe.UsageError, r"only: names no meter \(got \[\], allowed one or more, or None for all\)"):
            abbe.meter(scene, only=[])
        with self.assertRaisesRegex(abbe.UsageError, "spp excludes error"):
            abbe.meter(scene, spp=4, error=0.1)
        with self.assertRaisesRegex(abbe.SceneError, "the scene has no meters"):
            abbe.meter(SCENES / "cornell.json")
        with self.assertRaisesRegex(abbe.SceneError, "integrator:1:1: /render/integrator: error:"):
            abbe.meter(scene, integrator="paths")
        with self.assertRaises(TypeError):
            abbe.meter(scene, only=3)
        with self.assertWarnsRegex(abbe.SceneWarning, "meter sight: a pilot found no light at the meter: error has no effect"):
            abbe.meter({**scene, "lights": [{"directional": {"towards": [0, 0, -1], "irradiance": 1}}]}, only="sight", error=0.01)

    def test_progress_ends_it(self):
        def stop(progress):
            raise KeyError(progress.samples)

        with self.assertRaises(KeyError):
            abbe.meter(self.scene(), only="floor", spp=4096, progress=stop)


if __name__ == "__main__":
    unittest.main()
