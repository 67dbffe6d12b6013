"""Films developed, compared, and read out by their charts; cameras calibrated: the numbers of the command."""
import json
import unittest

import numpy

import abbe
from common import SCENES, Test, box

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
        with self.assertRaisesRegex(abbe.UsageError, "no read-out"):
            plain.write(self.scratch / "c.tif")
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
        with self.assertRaisesRegex(abbe.UsageError, "^readout: a spectral film has no sensor to read out: `scene` gives it one$"):
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

    def test_calibrations_are_those_of_the_command(self):
        made = abbe.calibrate("Nikon_D5100", "A", bits=10)
        told = json.loads(self.command("calibrate", "--camera", "Nikon_D5100", "--illuminant", "A", "--bits", 10, "--json"))
        for key, value in (("dE00_mean", told["dE00_mean"]), ("dE00_max", told["dE00_max"]), ("dE00_unseen_mean", told["unseen_dE00_mean"])):
            self.assertEqual(made[key], value, key)
        self.assertEqual(made["to_xyz_d65"].tolist(), told["to_xyz_d65"])
        self.assertEqual(made["dE00"].tolist(), [patch["dE00"] for patch in told["patches"]])
        self.assertEqual(list(made["response_max_error"].values()), [response["max_error"] for response in told["responses"]])


if __name__ == "__main__":
    unittest.main()
