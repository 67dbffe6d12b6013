"""Scenes from paths, dicts and keywords, and their errors."""
import json
import pathlib
import pickle
import unittest
import warnings

import numpy

import abbe
from common import CORNELL, SCENES, Test, box


class Own:
    """Converts to its own type."""

    def tolist(self):
        return Own()


class Turning:
    """Converts to another type, which converts back."""

    def tolist(self):
        class Back:
            def tolist(self):
                return Turning()

        return Back()


class Scenes(Test):
    def test_a_dict_makes_the_scene_that_its_file_makes(self):
        scene = abbe.Scene(CORNELL, render={"samples": 2})
        again = abbe.Scene(scene.to_dict(), folder=CORNELL.parent)
        self.assertEqual(scene.to_dict(), again.to_dict())
        numpy.testing.assert_array_equal(abbe.render(scene).array, abbe.render(again).array)

    def test_keywords_are_keys_and_replace_those_of_what_is_given(self):
        words = abbe.Scene(**box())
        self.assertEqual(words.to_dict(), abbe.Scene(box()).to_dict())
        self.assertEqual(abbe.Scene(box(), render={"samples": 7}).samples, 7)
        self.assertEqual(abbe.Scene(CORNELL, render={"samples": 7, "seed": 3}).seed, 3)

    def test_arrays_tuples_and_paths_stand_for_lists_and_texts(self):
        camera = {**box()["camera"], "from": numpy.array([0.0, -5, 2]), "to": (0, 0, numpy.float32(0))}
        scene = abbe.Scene(box(camera=camera, output={"image": pathlib.Path("film.exr")}))
        self.assertEqual(scene.to_dict()["camera"], abbe.Scene(box()).to_dict()["camera"])
        self.assertEqual(scene.to_dict()["output"], {"image": "film.exr"})
        self.assertEqual((scene.width, scene.height, scene.channels), (8, 6, ["long", "short"]))

    def test_what_is_wrong_has_its_pointer_and_its_message(self):
        with self.assertRaises(abbe.SceneError) as caught:
            abbe.Scene(box(shapes=[{"sphere": {"radius": -1}, "material": "grey"}], rendr={}))
        told = {d.pointer: d.message for d in caught.exception.diagnostics}
        self.assertEqual(told["/shapes/0/sphere/radius"], "expected a number (got -1, allowed (0, 1000000000000])")
        self.assertIn('did you mean "render"?', told["/rendr"])
        self.assertEqual({(d.file, d.severity) for d in caught.exception.diagnostics}, {("dict", "error")})
        self.assertRegex(str(caught.exception), r"dict:\d+:\d+: /shapes/0/sphere/radius: error: expected a number")

    def test_complaints_of_a_file_are_those_of_the_command(self):
        file = self.scratch / "wrong.json"
        file.write_text('{"abbe": 1,\n "camera": {"pinhole": {"fov_deg": 400}}}')
        with self.assertRaises(abbe.SceneError) as caught:
            abbe.Scene(file)
        self.assertIn(f"{file}:2:36: /camera/pinhole/fov_deg: error: expected a number (got 400, allowed (0, 180))", str(caught.exception))

    def test_what_json_cannot_hold_is_refused_where_it_stands(self):
        endless = []
        endless.append(endless)
        for value, message in ((float("nan"), "expected a finite number (got nan)"), ({1, 2}, "expected a value that JSON can represent (got a set)"),
                               ({1: 2}, "expected keys that are strings (got a int)"), (10 ** 400, "expected a finite number"),
                               (10 ** 5000, "expected a finite number (got an int of 16610 bits)"), (b"text", "expected a value that JSON can represent (got a bytes)"),
                               (2 ** 53 + 1, "expected a number that a double represents exactly (got 9007199254740993)"),
                               (numpy.longdouble("1e400"), "expected a finite number (got 1e+400)"),
                               (numpy.clongdouble(1), "expected a value that JSON can represent (got a complex256)"), (Own(), "expected a value that JSON can represent (got a Own)")):
            with self.subTest(message=message), self.assertRaises(abbe.SceneError) as caught:
                abbe.Scene(box(lights=[{"a/b": value}]))
            self.assertEqual(caught.exception.diagnostics[0].pointer, "/lights/0/a~1b")
            self.assertIn(message, caught.exception.diagnostics[0].message)
        for deep in (endless, Turning()):
            with self.assertRaisesRegex(abbe.SceneError, "nested deeper than 256"):
                abbe.Scene(box(lights=deep))

    def test_dates_and_spans_of_time_are_refused_in_every_unit(self):
        for value in (numpy.timedelta64(10 ** 9, "ns"), numpy.timedelta64(1, "s"), numpy.timedelta64(1), numpy.array(10 ** 9, "m8[ns]"), numpy.array([1], "m8[ns]"),
                      numpy.datetime64(1, "ns"), numpy.array(["2001-01-01"], "M8[D]")):
            with self.subTest(value=value), self.assertRaises(abbe.SceneError) as caught:
                abbe.Scene(box(sensor={**box()["sensor"], "exposure_s": value}))
            told = caught.exception.diagnostics[0]
            self.assertEqual((told.pointer, told.message), ("/sensor/exposure_s", f"expected a value that JSON can represent (got a {value.dtype})"))
        with self.assertRaises(abbe.SceneError) as caught:
            abbe.Scene(box(camera={**box()["camera"], "from": numpy.array([0, numpy.timedelta64(-5, "ns"), 2], object)}))
        self.assertEqual(caught.exception.diagnostics[0].pointer, "/camera/from/1")

    def test_long_doubles_are_numbers(self):
        resolution = numpy.array([8, 6], dtype=numpy.longdouble)
        camera = {**box()["camera"], "from": numpy.array([0, -5, 2], dtype=numpy.longdouble), "pinhole": {"fov_deg": numpy.longdouble(40)}}
        self.assertEqual(abbe.Scene(box(camera=camera)).to_dict(), abbe.Scene(box()).to_dict())
        self.assertEqual(abbe.Scene(box(sensor={**box()["sensor"], "resolution": resolution})).width, 8)

    def test_large_ints_that_a_double_holds_are_numbers(self):
        scene = abbe.Scene(box(render={"seed": 2 ** 53 - 1}, lights=[{"environment": {}, "emission": {"spectrum": 10 ** 20}}]))
        self.assertEqual(scene.seed, 2 ** 53 - 1)

    def test_keywords_over_a_file_are_refused_where_they_stand(self):
        for value in (0, numpy.nan):
            with self.subTest(value=value), self.assertRaises(abbe.SceneError) as caught:
                abbe.Scene(CORNELL, render={"samples": value})
            self.assertEqual(caught.exception.diagnostics[0].pointer, "/render/samples")
        with self.assertRaises(abbe.SceneError) as caught:
            abbe.Scene(CORNELL, **{"a/b": 1})
        self.assertIn('unknown key "a/b"', caught.exception.diagnostics[0].message)

    def test_what_is_no_path_is_refused(self):
        for source in (3, [1]):
            with self.assertRaisesRegex(TypeError, rf"^source: expected a path or a dict \(got a {type(source).__name__}\)$"):
                abbe.Scene(source)
        with self.assertRaisesRegex(TypeError, r"^folder: expected a path \(got a int\)$"):
            abbe.Scene(box(), folder=3)
        with self.assertRaisesRegex(abbe.UsageError, "^folder: applies only to files that a dict names"):
            abbe.Scene(CORNELL, folder=self.scratch)

    def test_paths_that_are_not_utf_8_are_told(self):
        odd = self.scratch / "odd\udcff"
        with self.assertRaises(abbe.InputError) as caught:
            abbe.Film.read(odd)
        self.assertIn(str(odd), str(caught.exception))
        odd.write_text("{")
        with self.assertRaises(abbe.SceneError) as caught:
            abbe.Scene(odd)
        self.assertEqual(caught.exception.diagnostics[0].file, str(odd))
        self.assertIn("odd?:1:2", str(caught.exception.diagnostics[0]))
        odd.write_text(json.dumps(box(abbe=1)))
        scene = abbe.Scene(odd)
        self.assertEqual(repr(scene), f"<abbe.Scene {odd}: 8 x 6 pixels, 1 shapes, 1 lights>")
        film = abbe.render(scene, spp=1)
        film.write(self.scratch / "film.exr")
        for told in (film, abbe.Film.read(self.scratch / "film.exr")):
            self.assertEqual(told.metadata["scene"], "odd\udcff")

    def test_text_that_is_not_utf_8_is_refused_where_it_stands(self):
        (self.scratch / "box.json").write_text(json.dumps(box(abbe=1)))
        film = abbe.render(abbe.Scene(box()), spp=1)
        for half in ("\udce9", "\ud800"):
            for call, pointer in ((lambda: abbe.Scene({"camera": {"from": half}}), "/camera/from"), (lambda: abbe.Scene({"camera": {half: 1}}), "/camera"),
                                  (lambda: abbe.Scene(box(output={"image": pathlib.Path(half)})), "/output/image"), (lambda: abbe.Scene(box(), **{half: 1}), ""),
                                  (lambda: abbe.Scene(self.scratch / "box.json", camera={"from": [half]}), "/camera/from/0"),
                                  (lambda: abbe.Scene(self.scratch / "box.json", **{half: 1}), ""), (lambda: abbe.develop(film, white=half), "/output/white")):
                with self.subTest(half=half, pointer=pointer), self.assertRaises(abbe.SceneError) as caught:
                    call()
                told = caught.exception.diagnostics[0]
                self.assertEqual((told.pointer, told.message), (pointer, f"expected text that UTF-8 can represent (got {half!r})"))
        for call in (lambda name: abbe.color(name), lambda name: abbe.meter(box(meters={"a": {"at": [0, 0, 1], "normal": [0, 0, 1]}}), only=name)):
            with self.assertRaisesRegex(abbe.Error, "caf[?\udce9]"):
                call("caf\udce9")
            with self.assertRaisesRegex(abbe.UsageError, r"^expected text that UTF-8 can represent \(got 'caf\\ud800'\)$"):
                call("caf\ud800")

    def test_errors_cross_processes(self):
        with self.assertRaises(abbe.SceneError) as caught:
            abbe.Scene(box(shapes=[{"sphere": {"radius": -1}, "material": "grey"}], lights={1}))
        with self.assertRaises(abbe.SceneError) as from_file:
            abbe.Scene(CORNELL, rendr=1)
        for error in (caught.exception, from_file.exception):
            again = pickle.loads(pickle.dumps(error))
            self.assertEqual((type(again), str(again)), (abbe.SceneError, str(error)))
            for key in ("file", "pointer", "message", "severity", "__str__"):
                told = [[getattr(d, key)() if key == "__str__" else getattr(d, key) for d in e.diagnostics] for e in (error, again)]
                self.assertEqual(*told, key)
            self.assertGreater(len(again.diagnostics), 0)

    def test_a_missing_file_is_an_input_error(self):
        with self.assertRaises(abbe.InputError):
            abbe.Scene(self.scratch / "absent.json")
        with self.assertRaises(abbe.InputError) as caught:
            abbe.Scene(box(shapes=[{"mesh": "absent.ply", "material": "grey"}]), folder=self.scratch)
        self.assertIn(str(self.scratch / "absent.ply"), str(caught.exception))

    def test_warnings_are_those_of_python(self):
        with warnings.catch_warnings(record=True) as heard:
            warnings.simplefilter("always")
            abbe.Scene(SCENES / "spectrograph.json")
        self.assertEqual([w.category for w in heard], [abbe.SceneWarning])
        self.assertIn("F2 has data on [320, 2500] nm", str(heard[0].message))

    def test_renders_warn_of_light_that_is_missing(self):
        lamp = {"name": "lamp", "point": {"at": [0, 0, 3]}, "emission": {"spectrum": 1}}
        glass = {"sphere": {"center": [0, 0, 1], "radius": 0.5}, "material": "glass"}
        scene = abbe.Scene(box(lights=[lamp], materials={**box()["materials"], "glass": {"dielectric": {"ior": 1.5}}},
                               shapes=[*box()["shapes"], glass], render={"samples": 1, "integrator": "path"}))
        with self.assertWarnsRegex(abbe.SceneWarning, 'integrator "path" cannot sample some light paths, whose light is missing'):
            abbe.render(scene)

    def test_renders_warn_of_a_sensor_that_measures_polarisation_left_out(self):
        sensor = {**box()["sensor"], "stokes": True}
        with self.assertWarnsRegex(abbe.SceneWarning, '^the sensor measures polarisation, but render/polarisation is "off"'):
            abbe.render(abbe.Scene(box(sensor=sensor, render={"samples": 1, "polarisation": "off"})))
        with warnings.catch_warnings(record=True) as heard:
            warnings.simplefilter("always")
            abbe.render(abbe.Scene(box(sensor=sensor, render={"samples": 1})))
        self.assertEqual(heard, [])

    def test_renders_warn_of_an_error_that_no_light_tells(self):
        scene = abbe.Scene(box(lights=[{"directional": {"towards": [0, 0, -1], "irradiance": 1}}]))
        with self.assertWarnsRegex(abbe.SceneWarning, "^a pilot found no light on the film, so that error had no effect$"):
            abbe.render(scene, error=0.01)

    def test_renders_warn_of_what_does_nothing(self):
        lamp = {"name": "lamp", "point": {"at": [0, 0, 3]}, "emission": {"spectrum": 1}}
        scene = abbe.Scene(box(lights=[lamp], shapes=[], render={"samples": 1, "integrator": "path", "photons": {"radius": 1}}))
        with warnings.catch_warnings(record=True) as heard:
            warnings.simplefilter("always")
            abbe.render(scene)
        self.assertEqual([str(w.message).split(":")[0] for w in heard], [
            'integrator "path" does not use these settings', "no light reached the sensor in 1 samples per pixel, although lights emit in its wavelength range"])

    def test_docstrings_tell_what_the_tables_of_keys_say(self):
        self.assertIn("  camera: The camera or irradiance probe that records the scene. (object, required without meters)", abbe.Scene.__doc__)
        self.assertEqual(abbe.help("sensor/readout/bits"), self.command("help", "scene", "sensor/readout/bits"))
        with self.assertRaisesRegex(abbe.UsageError, "did you mean"):
            abbe.help("camra")
        with self.assertRaisesRegex(abbe.UsageError, 'key "sunn"; did you mean "sun"'):
            abbe.help("lights/sunn")


if __name__ == "__main__":
    unittest.main()
