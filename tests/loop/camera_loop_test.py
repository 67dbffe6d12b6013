"""The whole loop on measured cameras, as a user goes through it: flat and dark frames, a chart, raw files, calibration, colours; each figure beside what
numpy finds in the raw files by itself."""
import csv
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np
import OpenImageIO as oiio

import colour
import spectra

ABBE = os.environ["ABBE_BINARY"]
SCENES = spectra.DATA / "scenes"
MODEL = "dslr_apsc_bayer_14bit"
PLANTED = json.loads((spectra.DATA / "sensor" / f"{MODEL}.json").read_text())["sensor"]["readout"]
NIGHTLY = "ABBE_NIGHTLY" in os.environ
COLUMNS, ROWS, CELL = 6, 4, 48  # the chart fills the picture: a cell of so many pixels for each patch


def run(*words):
    return subprocess.run([ABBE, *map(str, words)], check=True, capture_output=True, text=True)


def abbe(*words):
    """What a command prints as JSON."""
    return json.loads(run(*words, "--json").stdout)


def read_raw(path):
    """The codes of a raw file, planes last, and the attributes it has."""
    image = oiio.ImageInput.open(str(path))
    pixels = image.read_image(oiio.UINT16).astype(float)
    description = image.spec().getattribute("ImageDescription")  # which a PNG has not: its texts have names
    told = {a.name: a.value for a in image.spec().extra_attribs}
    told |= dict(line.split(": ", 1) for line in (description or "").splitlines())
    image.close()
    return pixels, told


def sites(pixels):
    """The pixels of each channel of the mosaic R G / G B."""
    plane = pixels[..., 0]
    return {"R": plane[0::2, 0::2].ravel(), "G": np.concatenate([plane[0::2, 1::2].ravel(), plane[1::2, 0::2].ravel()]),
            "B": plane[1::2, 1::2].ravel()}


class Loop(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.scratch = pathlib.Path(folder.name)

    def write(self, name, value):
        path = self.scratch / name
        path.write_text(json.dumps(value))
        return path

    def render(self, name, scene):
        film = self.scratch / f"{name}.exr"
        run("render", self.write(f"{name}.json", scene), "-o", film, "--quiet")
        return film

    def assert_near(self, found, expected, share):
        self.assertLess(abs(found / expected - 1), share, (found, expected))


class Sensor(Loop):
    """Gain and read noise from a million pixels at four speeds, by day from fewer at the fastest."""

    EDGE = 1024 if NIGHTLY else 256
    SPEEDS = (100, 400, 1600, 6400) if NIGHTLY else (6400,)
    LEVELS = (150, 500, 900, 3000) if NIGHTLY else (500, 900, 3000)
    BOUND = 5e-3 if NIGHTLY else 5 * np.sqrt(2) / EDGE  # five standard errors of the variance of all pixels
    RAW = "tif" if NIGHTLY else "png"  # which takes the program less to start

    def flat(self, name, exposure_s, luminance):
        """A film of an evenly bright sky."""
        return self.render(name, {
            "abbe": 1, "camera": {"pinhole": {"fov_deg": 20, "f_number": 4}, "from": [0, 0, 0], "to": [0, 0, 1], "up": [0, 1, 0]},
            "sensor": {"model": MODEL, "resolution": [self.EDGE, self.EDGE], "exposure_s": exposure_s},
            "lights": [{"environment": {}, "emission": {"illuminant": "D65", "luminance": luminance}}],
            "render": {"samples": 1, "integrator": "path"}})

    def frames(self, film, iso):
        """Two exposures of one film, between which nothing but the noise of the sensor differs."""
        files = [film.with_name(f"{film.stem}_{iso}_{seed}.{self.RAW}") for seed in (0, 1)]
        for seed, file in enumerate(files):
            run("develop", film, "--set", f"/readout/iso={iso}", "--seed", seed, "-o", file)
        return files

    def by_numpy(self, dark, lit, exposures, channel):
        """Gain and read noise by the photon transfer method."""
        def moments(files):
            a, b = (sites(read_raw(file)[0])[channel] for file in files)
            return (a.mean() + b.mean()) / 2, np.var(a - b, ddof=1) / 2
        means, variances = np.array([moments(files) for files in dark]).T
        black, variance_of = np.polyfit(exposures, means, 1), np.polyfit(exposures, variances, 1)
        time = float(read_raw(lit[0][0])[1]["exposure_s"])
        points = np.array([moments(files) for files in lit])
        signal, variance = points[:, 0] - np.polyval(black, time), points[:, 1]
        low = signal <= 0.7 * signal[variance.argmax()]
        shot = variance[low] - np.polyval(variance_of, time)
        gain = (signal[low] ** 2).sum() / (signal[low] * shot).sum()
        return gain, gain * np.sqrt(variance_of[1] - 1 / 12)

    def test_gain_and_read_noise(self):
        exposures = (1e-4, 0.5)
        dark_films = [self.flat(f"dark{t}", t, 1e-9) for t in exposures]
        for iso in self.SPEEDS:
            # From a tenth of what saturates to beyond it [cd/m^2].
            lit = [self.frames(self.flat(f"lit{iso}_{level}", 0.01, level * 100 / iso), iso) for level in self.LEVELS]
            dark = [self.frames(film, iso) for film in dark_films]
            found = abbe("transfer", "--dark", *sum(dark, []), "--lit", *sum(lit, []))
            self.assertEqual(found["channel"], ["R", "G", "B"])
            told = read_raw(lit[0][0])[1]
            # What saturates at 78/ISO lx s has the code where the camera clips [ISO 12232].
            planted = 78 / iso * float(told["electrons_per_lx_s"]) / (PLANTED["saturation_dn"] - PLANTED["offset_dn"])
            for k, channel in enumerate(found["channel"]):
                gain, noise = self.by_numpy(dark, lit, exposures, channel)
                self.assert_near(found["gain_e_per_dn"][k], gain, 1e-3)
                self.assert_near(found["read_noise_e"][k], noise, 1e-3)
                self.assertIsNone(found["full_well_e"][k], "the codes end first")
            # All pixels together: there are as many green ones as red and blue.
            gain, noise = (np.average(found[key], weights=[1, 2, 1]) for key in ("gain_e_per_dn", "read_noise_e"))
            print(f"ISO {iso}: gain {gain:.5f} e/DN (planted {planted:.5f}), read noise {noise:.4f} e ({PLANTED['read_noise_e']})")
            self.assert_near(gain, planted, self.BOUND)
            self.assert_near(noise, PLANTED["read_noise_e"], self.BOUND)


class Chart(Loop):
    """The ColorChecker, from raw files to colours; by day before one camera in one light."""

    def scene(self, light, sensor):
        text = (SCENES / "validation" / "colorchecker.json").read_text()
        scene = json.loads("\n".join(line for line in text.splitlines() if not line.startswith("//")))
        scene["camera"]["pinhole"]["fov_deg"] = 2 * np.degrees(np.arctan(2 / 1000))
        scene["lights"][0]["emission"]["illuminant"] = light
        scene["sensor"] = {"resolution": [COLUMNS * CELL, ROWS * CELL], **sensor}
        if not NIGHTLY:
            scene["render"]["samples"] = 24
        return scene

    def dslr(self, iso, share):
        """The camera, exposed to a share of what saturates it: at 1 lx and f/1 a perfect diffuser gives it 1/4 lx."""
        return {"model": MODEL, "exposure_s": share * 4 * 78 / iso, "readout": {**PLANTED, "iso": iso}}

    def regions(self, cell=CELL):
        """The middles of the patches, in the order of the chart, beginning at even pixels."""
        low, high = cell // 2 - 14 * cell // CELL, cell // 2 + 14 * cell // CELL
        return [(c * cell + low, r * cell + low, c * cell + high, r * cell + high) for r in range(ROWS) for c in range(COLUMNS)]

    def raw(self, name, light, sensor):
        film = self.render(name, self.scene(light, sensor))
        file = film.with_suffix(".tif")
        run("develop", film, "-o", file, "-o", film.with_suffix(".parts.exr"))
        return file

    def patches(self, file):
        """Means above black, deviations of a pixel and numbers of pixels, by numpy: patch by patch, R, G, B."""
        pixels, told = read_raw(file)
        readout = json.loads(told["sensor"])["readout"]
        dark = readout.get("dark_e_per_s", 0) * float(told["exposure_s"]) / float(told["gain_e_per_dn"])
        black = readout.get("offset_dn", 0) + dark
        values = []
        for x0, y0, x1, y1 in self.regions():
            part = pixels[y0:y1, x0:x1]
            of = sites(part) if part.shape[2] == 1 else {c: part[..., k].ravel() for k, c in enumerate("RGB")}
            values.append([(of[c].mean() - black, of[c].std(ddof=1), of[c].size) for c in "RGB"])
        return np.array(values)

    def measure(self, file, values):
        """The table of the patches that `measure` writes, which has the values that numpy finds in the same pixels."""
        table = file.with_suffix(".csv")
        run("measure", file, "--chart", file.with_suffix(".json"), "-o", table)
        with open(table, encoding="utf-8") as lines:
            rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
        for row, value in zip(rows, values, strict=True):
            for channel, (mean, deviation, pixels) in zip("RGB", value):
                self.assertEqual(int(row[f"{channel}_pixels"]), pixels)
                self.assert_near(float(row[channel]), mean, 1e-6)
                self.assert_near(float(row[f"{channel}_deviation"]), deviation, 5e-3)
        return table

    def compare(self, light, found, values):
        """CIEDE2000 of the patches under the correction that was found, by numpy, is what the command says."""
        _, xyz, white = spectra.chart_colours(light)
        seen = (values[:, :, 0] * found["gains"]) @ np.array(found["correction"]["columns"])
        errors = colour.delta_e_2000(colour.lab(xyz, white), colour.lab(seen, white))
        self.assert_near(found["dE00_mean"], errors.mean(), 1e-3)

    def judge(self, light, camera, file, margin):
        """Both the calibration to the raw file and its error on patches left out, beside the camera's own limit."""
        limit = abbe("calibrate", "--camera", camera, "--illuminant", light, "--bits", 0)["unseen_dE00_mean"]
        values = self.patches(file)
        found = abbe("calibrate", "--measured", self.measure(file, values), "--illuminant", light)
        self.compare(light, found, values)
        print(f"{file.stem}: left out {found['unseen_dE00_mean']:.3f}, without noise {limit:.3f}")
        if margin is not None:
            self.assertLess(found["unseen_dE00_mean"], limit + margin)
        return found["unseen_dE00_mean"], limit

    def test_bayer_camera(self):
        for light in ("D65", "A", "FL11") if NIGHTLY else ("A",):
            share = 0.7 if light == "D65" else 0.5
            clean, limit = self.judge(light, "Nikon_D5100", self.raw(f"{light}_100", light, self.dslr(100, share)), 0.1)
            if not NIGHTLY:
                continue
            noisy, _ = self.judge(light, "Nikon_D5100", self.raw(f"{light}_6400", light, self.dslr(6400, share)), None)
            self.assertGreater(noisy, limit)
            self.assert_preview(light, limit)

    def assert_preview(self, light, limit):
        """What `develop` demosaics and corrects by itself is as near to the spectra."""
        parts = oiio.ImageInput.open(str(self.scratch / f"{light}_100.parts.exr"))
        index = 0
        while parts.seek_subimage(index, 0) and parts.spec().getattribute("name") != "preview":
            index += 1
        names = parts.spec().channelnames
        pixels = parts.read_image(oiio.FLOAT)
        parts.close()
        order = [next(i for i, n in enumerate(names) if n.split(".")[-1] == c) for c in "RGB"]
        rgb = np.array([pixels[y0:y1, x0:x1][..., order].reshape(-1, 3).mean(axis=0) for x0, y0, x1, y1 in self.regions()], float)
        to_xyz = np.array([[0.4123907993, 0.3575843394, 0.1804807884], [0.2126390059, 0.7151686788, 0.0721923154],
                           [0.0193308187, 0.1191947798, 0.9505321522]])
        d65 = to_xyz.sum(axis=1)
        _, xyz, white = spectra.chart_colours(light)
        bradford = np.array([[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]])
        adapt = np.linalg.inv(bradford) @ np.diag((bradford @ d65) / (bradford @ white)) @ bradford
        wanted, seen = xyz @ adapt.T, rgb @ to_xyz.T
        seen *= (wanted[:, 1] * seen[:, 1]).sum() / (seen[:, 1] ** 2).sum()
        error = colour.delta_e_2000(colour.lab(wanted, d65), colour.lab(seen, d65)).mean()
        print(f"{light}: developed and demosaicked {error:.3f}")
        self.assertLess(error, limit + 0.1)

    @unittest.skipUnless(NIGHTLY, "for the night")
    def test_three_narrow_filters(self):
        bands = {"R": (605, 615), "G": (535, 545), "B": (445, 455)}
        sensor = {"pixel_pitch_um": 6.8, "exposure_s": 8, "quantum_efficiency": "kodak_kaf-3200me",
                  "channels": {name: {"band": list(ends)} for name, ends in bands.items()},
                  "readout": {"gain_e_per_dn": 1, "bits": 16, "offset_dn": 100, "full_well_e": 55000, "read_noise_e": 8, "dark_e_per_s": 0.8,
                              "prnu_percent": 1, "dsnu_e": 3}}
        camera = "box:" + ",".join(f"{low}-{high}" for low, high in (bands[c] for c in "BGR"))
        self.judge("LED-B1", camera, self.raw("narrow", "LED-B1", sensor), 0.1)

    @unittest.skipUnless(NIGHTLY, "for the night")
    def test_response_is_linear(self):
        """A series from `develop` needs no key but its files; the response that is found is the straight line it is."""
        cell = 2 * CELL
        scene = self.scene("D65", {**self.dslr(100, 1), "resolution": [COLUMNS * cell, ROWS * cell]})
        scene["render"]["samples"] = 16  # what noise the film has all exposures share
        film = self.render("series", scene)
        files = [self.scratch / f"series{i}.tif" for i in range(26)]
        for i, share in enumerate(np.geomspace(0.01, 4, 26)):
            run("develop", film, "--exposure-s", self.dslr(100, share)["exposure_s"], "--seed", i, "-o", files[i])
        listing = self.write("series.json", {"exposures": [{"file": file.name} for file in files],
                                             "regions": [list(region) for region in self.regions(cell)]})
        run("calibrate", "--series", listing, "-o", self.scratch / "response")
        rows = (self.scratch / "response" / "response.csv").read_text().splitlines()
        table = np.array([row.split(",") for row in rows if row[0].isdigit()], float)
        code = table[:, 0]
        inside = (code >= 0.01) & (code <= 0.99)
        worst = max(np.abs(table[inside, 1 + 3 * k] - code[inside]).max() for k in range(3))
        print(f"response: {100 * worst:.3f} % of full scale from a straight line")
        self.assertLess(worst, 0.003)


if __name__ == "__main__":
    unittest.main()
