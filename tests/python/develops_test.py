"""Developing, comparing and measuring films, and calibrating cameras: the results equal those of the command."""
import json
import unittest

import numpy
import OpenImageIO

import abbe
from common import DATA, NIGHTLY, SCENES, Test, box

CHART = SCENES / "validation" / "colorchecker.json"


class Develops(Test):
    def test_codes_are_those_of_the_command(self):
        film = abbe.render(abbe.Scene(SCENES / "ccd.json"), spp=4)
        film.write(self.scratch / "f.exr")
        raw = abbe.develop(film, readout={"gain_e_per_dn": 0.5, "bits": 10, "read_noise_e": 3}, seed=7)
        self.command("develop", self.scratch / "f.exr", "--seed", 7, "--set", '/readout={"gain_e_per_dn":0.5,"bits":10,"read_noise_e":3}',
                     "-o", self.scratch / "c16.png", "-o", self.scratch / "c.exr", "--display", self.scratch / "c.png")
        for name in ("c16.png", "c.exr"):
            raw.write(self.scratch / ("own_" + name))
            self.assertEqual((self.scratch / name).read_bytes(), (self.scratch / ("own_" + name)).read_bytes(), name)
        raw.write(self.scratch / "CAPITALS.EXR")
        self.assertEqual((self.scratch / "CAPITALS.EXR").read_bytes(), (self.scratch / "c.exr").read_bytes())
        with self.assertRaisesRegex(abbe.UsageError, 'got extension ".jpg", allowed .exr, .tif, .tiff, .png, .dng, .fits, .fit$'):
            raw.write(self.scratch / "c.jpg")
        raw.write(self.scratch / "c.tiff")
        self.assertEqual(raw._repr_png_(), (self.scratch / "c.png").read_bytes())
        self.assertEqual(raw.codes.shape, (128, 192, 1))
        self.assertEqual(raw.codes.max(), 1023)
        self.assertEqual(set(numpy.unique(raw.saturated)), {0, 1})
        self.assertGreater(raw.figures[0]["read_noise_e"], 0)

    def test_a_film_without_a_read_out_has_no_codes(self):
        film = abbe.render(abbe.Scene(box()))
        plain = abbe.develop(film)
        numpy.testing.assert_array_equal(plain.calibrated, film.array)
        self.assertIsNone(plain.codes)
        with self.assertRaisesRegex(abbe.UsageError, "no readout"):
            plain.write(self.scratch / "c.tif")
        with self.assertRaisesRegex(abbe.UsageError, "^seed: the film has no readout, so that there is no noise to seed$"):
            abbe.develop(film, seed=7)
        for seed in (-1, 2 ** 53):
            with self.assertRaisesRegex(abbe.UsageError, rf"^seed: got {seed}, allowed whole numbers in \[0, 9007199254740991\]$"):
                abbe.develop(film, seed=seed)
        with self.assertRaisesRegex(abbe.InputError, "counts no electrons"):
            abbe.develop(film, readout={"bits": 12})
        with self.assertRaises(abbe.Error) as caught:
            abbe.develop(abbe.render(abbe.Scene(SCENES / "ccd.json"), spp=1), readout={"bits": 99})
        self.assertIn("/readout/bits", [d.pointer for d in caught.exception.diagnostics])

    def test_another_sensor_looks_at_a_spectral_film(self):
        spectral = box(sensor={"resolution": [8, 6], "spectral": {"from_nm": 380, "to_nm": 780, "step_nm": 10}})
        film = abbe.render(abbe.Scene(spectral), spp=256)
        eye = abbe.Scene(box(sensor={"resolution": [8, 6], "observer": "1931"}))
        seen = abbe.develop(film, scene=eye)
        self.assertEqual(seen.planes, ["X", "Y", "Z"])
        numpy.testing.assert_allclose(seen.exposure.mean((0, 1)), abbe.render(eye, spp=256).array.mean((0, 1)), rtol=0.05)
        with self.assertRaisesRegex(abbe.UsageError, "^readout: a spectral film has no sensor to read out; `scene` supplies one$"):
            abbe.develop(film, readout={"bits": 12})
        with self.assertRaises(abbe.Error) as caught:
            abbe.develop(film, scene=eye, readout={"bits": numpy.nan})
        self.assertEqual(caught.exception.diagnostics[0].pointer, "/readout/bits")
        with self.assertRaisesRegex(abbe.UsageError, "only a spectral film"):
            abbe.develop(abbe.render(abbe.Scene(box())), scene=abbe.Scene(box()))

    def test_comparisons_are_those_of_the_command(self):
        scene = abbe.Scene(CHART)
        films = [abbe.render(scene, spp=2, seed=seed) for seed in (1, 2)]
        for name, film in zip("ab", films):
            film.write(self.scratch / (name + ".exr"))
        told = json.loads(self.command("compare", self.scratch / "a.exr", self.scratch / "b.exr", "--chart", CHART, "--json"))
        for key, value in abbe.compare(*films).items():
            self.assertEqual(value, told[key], key)
        patches = abbe.measure(scene, *films)
        self.assertEqual([p["dE00"] for p in patches], [p["dE00"] for p in told["patches"]])
        self.assertEqual(len(abbe.measure(scene, films[0])), 24)
        with self.assertRaises(abbe.InputError):
            abbe.compare(films[0], abbe.render(abbe.Scene(box())))

    def test_a_unit_that_one_film_tells_is_warned_of(self):
        film = abbe.render(abbe.Scene(box()), spp=1)
        film.write(self.scratch / "told.exr")
        untold = OpenImageIO.ImageBuf(str(self.scratch / "told.exr"))
        untold.specmod().erase_attribute("channel.short")
        untold.write(str(self.scratch / "untold.exr"))
        with self.assertWarnsRegex(abbe.SceneWarning, "only one of the films declares the unit of channel short"):
            self.assertEqual(abbe.compare(film, abbe.Film.read(self.scratch / "untold.exr"))["mean_ratio"], 1)

    def test_the_pixels_that_films_of_crops_have_in_common_are_told_as_the_command_does(self):
        (self.scratch / "box.json").write_text(json.dumps({"abbe": 1, **box()}))
        crops = []
        for name, crop in (("left", "0,0,4,4"), ("right", "2,1,8,6")):
            self.command("render", self.scratch / "box.json", "--crop", crop, "--quiet", "-o", self.scratch / f"{name}.exr")
            crops.append(self.scratch / f"{name}.exr")
        found = abbe.compare(*map(abbe.Film.read, crops))
        self.assertEqual(found["crop"], [2, 1, 4, 4])
        self.assertEqual(found["crop"], json.loads(self.command("compare", *crops, "--json"))["crop"])

    def test_channels_that_one_film_has_are_warned_of(self):
        two = abbe.render(abbe.Scene(box()), spp=2)
        one = abbe.render(abbe.Scene(box(sensor={**box()["sensor"], "channels": {"long": box()["sensor"]["channels"]["long"]}})), spp=2)
        with self.assertWarnsRegex(abbe.SceneWarning, "channels that only one of the images has are not compared: short"):
            abbe.compare(two, one)

    def test_complaints_name_the_keyword_that_they_are_about(self):
        film = abbe.render(abbe.Scene(box(sensor={**box()["sensor"], "response": "quantum"})), spp=2)
        for call, message in ((lambda: abbe.develop(film, readout={"bits": 10}), "readout:1:1: /readout: error: missing key"),
                              (lambda: abbe.develop(film, white="foo"), "white:1:1: /output/white: error: unknown light"),
                              (lambda: abbe.compare(film, film, white="foo"), "white:1:1: /output/white: error: unknown light")):
            with self.subTest(message=message), self.assertRaisesRegex(abbe.Error, message):
                call()

    def test_calibrations_are_those_of_the_command(self):
        made = abbe.calibrate("Nikon_D5100", "A", bits=10)
        told = json.loads(self.command("calibrate", "--camera", "Nikon_D5100", "--illuminant", "A", "--bits", 10, "--json"))
        for key, value in (("dE00_mean", told["dE00_mean"]), ("dE00_max", told["dE00_max"]), ("dE00_unseen_mean", told["unseen_dE00_mean"])):
            self.assertEqual(made[key], value, key)
        self.assertEqual(made["to_xyz_d65"].tolist(), told["to_xyz_d65"])
        self.assertEqual(made["dE00"].tolist(), [patch["dE00"] for patch in told["patches"]])
        self.assertEqual(list(made["response_max_error"].values()), [response["max_error"] for response in told["responses"]])

    def test_curves_of_a_camera_are_what_they_are_said_to_be(self):
        quantum = abbe.calibrate("Nikon_D5100", "A", camera_response="quantum")["dE00_mean"]
        if NIGHTLY:
            self.assertNotAlmostEqual(quantum, abbe.calibrate("Nikon_D5100", "A")["dE00_mean"], 3)
        told = json.loads(self.command("calibrate", "--camera", "Nikon_D5100", "--camera-response", "quantum", "--illuminant", "A", "--json"))
        self.assertEqual(quantum, told["dE00_mean"])

    def write_photographs_of_gamma_2(self):
        """Photographs of grey steps, and raw values of a chart, by a camera with that response."""
        exposures = []
        for stop in range(-6, 2):
            steps = numpy.sqrt(numpy.minimum(1, numpy.arange(1, 49) / 48 * 2.0**stop))
            pixels = numpy.ascontiguousarray(numpy.repeat(steps.astype(numpy.float32), 3))
            picture = OpenImageIO.ImageOutput.create("s.tif")
            self.assertTrue(picture.open(str(self.scratch / f"s{stop}.tif"), OpenImageIO.ImageSpec(48, 1, 3, "float")))
            picture.write_image(pixels.reshape(1, 48, 3))
            picture.close()
            exposures.append({"file": f"s{stop}.tif", "exposure_s": 2.0**stop})
        series = self.scratch / "series.json"
        series.write_text(json.dumps({"exposures": exposures}))
        lines = (DATA / "reference" / "camera_raw_colorchecker.csv").read_text().splitlines()
        rows = [line.split(",") for line in lines if line.startswith("Nikon_D5100,A,colorchecker24_ohta1997,")]
        self.assertEqual(len(rows), 25)
        measured = self.scratch / "measured.csv"
        measured.write_text("# unit: code values\npatch,R,G,B\n" + "".join(
            ",".join([row[4], *(str((float(value) / 1.1) ** 0.5) for value in row[5:])]) + "\n" for row in rows))
        return measured, series

    def test_real_cameras_are_calibrated_as_by_the_command(self):
        measured, series = self.write_photographs_of_gamma_2()
        how = {"chart": "colorchecker24_ohta1997", "measured": measured, "series": series}
        for correction in ("matrix", "root-polynomial-2", "auto") if NIGHTLY else ("matrix",):
            made = abbe.calibrate(illuminant="A", correction=correction, **how)
            told = json.loads(self.command("calibrate", "--illuminant", "A", "--chart", how["chart"], "--measured", measured, "--series", series,
                                           "--correction", correction, "--json"))
            self.assertEqual(made["dE00"].tolist(), [patch["dE00"] for patch in told["patches"]])
            self.assertEqual(made["dE00_unseen_mean"], told["unseen_dE00_mean"])
            self.assertEqual(list(made["gains"]), told["gains"])
            self.assertEqual("to_xyz_d65" in made, "to_xyz_d65" in told)
        matrix = abbe.calibrate(illuminant="A", **how) if NIGHTLY else made
        simulated = abbe.calibrate("Nikon_D5100", "A", chart=how["chart"], bits=0)
        numpy.testing.assert_allclose(matrix["dE00_mean"], simulated["dE00_mean"], atol=0.02)
        if NIGHTLY:
            trained = abbe.calibrate("Nikon_D5100", "A", training="rawtoaces_190_patches", **how)
            self.assertGreater(trained["dE00_mean"], matrix["dE00_mean"])
        curves = abbe.recover_response(series)
        self.assertEqual(list(curves), ["R", "G", "B"])
        for channel, curve in curves.items():
            code, exposure, low, high = curve.T
            middle = (code > 0.1) & (code < 0.95)
            numpy.testing.assert_allclose(exposure[middle], code[middle] ** 2, atol=0.002)
            self.assertTrue(((low <= exposure) & (exposure <= high)).all())
            numpy.testing.assert_array_equal(curve, matrix["responses"][channel])

    def test_calibrations_of_nothing_are_refused(self):
        measured, series = self.write_photographs_of_gamma_2()
        for words, arguments in (("camera: is needed", {}), ("camera: is needed", {"measured": measured, "training": "rawtoaces_190_patches"}),
                                 ("series: needs measured", {"camera": "Nikon_D5100", "series": series}),
                                 ("response: is planted", {"measured": measured, "response": "linear"}),
                                 ("bits: are those of a simulated camera", {"measured": measured, "bits": 12}),
                                 ("camera: is allowed with measured only for training", {"camera": "nosuch", "measured": measured}),
                                 ("camera_response: needs camera", {"measured": measured, "camera_response": "energy"}),
                                 ("^bits: expected 0 to 16 .got 17.$", {"camera": "Nikon_D5100", "bits": 17}),
                                 ("^response: expected .*got foo", {"camera": "Nikon_D5100", "response": "foo"}),
                                 ("^camera: expected three bands .got 1.$", {"camera": "box:400-500"}),
                                 ("correction: expected matrix, root-polynomial-2, root-polynomial-3 or auto .got cubic",
                                  {"camera": "Nikon_D5100", "correction": "cubic"})):
            with self.assertRaisesRegex(abbe.UsageError, words):
                abbe.calibrate(**arguments)
        with self.assertRaisesRegex(abbe.InputError, "none.json"):
            abbe.recover_response(self.scratch / "none.json")


if __name__ == "__main__":
    unittest.main()
