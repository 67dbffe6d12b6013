"""Attributes of films, and writing, reading and merging them."""
import importlib.util
import json
import pathlib
import threading
import unittest

import numpy
import OpenImageIO

import abbe
from common import CORNELL, SCENES, Test, box


def spectral():
    return abbe.Scene(box(sensor={"resolution": [8, 6], "spectral": {"from_nm": 400, "to_nm": 700, "step_nm": 100}}))


class Films(Test):
    def test_files_are_those_of_the_command(self):
        film = abbe.render(abbe.Scene(CORNELL), spp=1, seed=5)
        self.command("render", CORNELL, "--spp", 1, "--seed", 5, "--quiet", "-o", self.scratch / "c.exr", "--display", self.scratch / "c.png")
        for name in ("c.exr", "c.png"):
            film.write(self.scratch / ("own_" + name))
            self.assertEqual((self.scratch / name).read_bytes(), (self.scratch / ("own_" + name)).read_bytes(), name)
        self.assertEqual(film._repr_png_(), (self.scratch / "c.png").read_bytes())

    def test_colours_of_a_camera_are_fitted_to_the_same_bits(self):
        furnace = SCENES / "furnace.json"
        abbe.render(abbe.Scene(furnace), spp=2).write(self.scratch / "own.exr")
        self.command("render", furnace, "--spp", 2, "--quiet", "-o", self.scratch / "c.exr")
        self.assertEqual((self.scratch / "c.exr").read_bytes(), (self.scratch / "own.exr").read_bytes())

    def test_keywords_over_a_file_are_what_set_is_to_the_command(self):
        abbe.render(abbe.Scene(CORNELL, render={"samples": 1, "seed": 1})).write(self.scratch / "own.exr")
        self.command("render", CORNELL, "--set", '/render={"samples":1,"seed":1}', "--quiet", "-o", self.scratch / "c.exr")
        self.assertEqual((self.scratch / "c.exr").read_bytes(), (self.scratch / "own.exr").read_bytes())

    def test_arrays_have_rows_columns_and_channels_and_are_made_once(self):
        film = abbe.render(abbe.Scene(box()))
        self.assertEqual((film.array.shape, film.array.dtype, film.channels), ((6, 8, 2), numpy.float32, ["long", "short"]))
        self.assertIs(film.array, film.array)
        self.assertFalse(film.array.flags.writeable)
        self.assertEqual(film.variance.shape, film.array.shape)
        self.assertTrue((film.array > 0).all() and (film.variance >= 0).all())
        self.assertIsNone(film.wavelengths)
        with self.assertRaisesRegex(abbe.UsageError, "not spectral"):
            film.spectrum(0, 0)

    def test_spectra_of_a_spectral_film(self):
        film = abbe.render(spectral(), spp=1024)
        self.assertEqual(film.wavelengths.tolist(), [450, 550, 650])
        self.assertEqual(film.array.shape, (6, 8, 3))
        numpy.testing.assert_array_equal(film.spectrum(7, 2), film.array[2, 7])
        numpy.testing.assert_allclose(film.spectrum(0, 0), 100, rtol=0.05)  # a sky of 1 W/(m^2 sr nm)
        with self.assertRaisesRegex(abbe.UsageError, "no such pixel"):
            film.spectrum(8, 0)
        self.assertEqual(film.picture().shape, (6, 8, 3))
        film.write(self.scratch / "s.exr")
        numpy.testing.assert_array_equal(abbe.Film.read(self.scratch / "s.exr").array, film.array)
        for name in ("S.EXR", "S.ABBEPART"):
            film.write(self.scratch / name)
            numpy.testing.assert_array_equal(abbe.Film.read(self.scratch / name).array, film.array)

    def write_bands(self, middles_nm, unit="W.m^-2.sr^-1"):
        """A spectral image of one pixel with 100 W/(m^2 sr) in each band."""
        layout = OpenImageIO.ImageSpec(1, 1, len(middles_nm), "float")
        layout.channelnames = [f"S0.{nm},000000nm" for nm in middles_nm]
        layout.attribute("spectralLayoutVersion", "1.0")
        layout.attribute("emissiveUnits", unit)
        image = OpenImageIO.ImageOutput.create("bands.exr")
        self.assertTrue(image.open(str(self.scratch / "bands.exr"), layout), image.geterror())
        image.write_image(numpy.full((1, 1, len(middles_nm)), 100, numpy.float32))
        image.close()
        return abbe.Film.read(self.scratch / "bands.exr")

    def test_spectra_in_another_unit_or_without_widths_are_refused(self):
        for film, message in ((self.write_bands([400, 500, 600], "W.m^-2.sr^-1.nm^-1"), '^film: unsupported emissiveUnits .got "W'),
                              (self.write_bands([550]), "^film: too few bands of radiance to infer their widths .got 1, allowed 2 or more.$")):
            for call in (lambda: film.wavelengths, lambda: film.spectrum(0, 0), lambda: abbe.plot_spectrum(film, (0, 0))):
                with self.subTest(message=message), self.assertRaisesRegex(abbe.InputError, message):
                    call()

    @unittest.skipUnless(importlib.util.find_spec("matplotlib"), "matplotlib is not installed")
    def test_spectra_are_drawn_per_nm_of_each_band(self):
        axes = abbe.plot_spectrum(self.write_bands([400, 500, 700]), (0, 0))
        numpy.testing.assert_array_equal(axes.lines[-1].get_xydata(), [[400, 100 / 100], [500, 100 / 150], [700, 100 / 200]])

    def test_threads_write_a_film_whose_image_is_not_made_yet(self):
        film = abbe.render(abbe.Scene(box(sensor={**box()["sensor"], "resolution": [300, 300]}, render={"samples": 1})))
        film.write(self.scratch / "f.abbepart")
        film.write(self.scratch / "f.exr")
        whole = (self.scratch / "f.exr").read_bytes()
        for _ in range(4):
            fresh = abbe.Film.read(self.scratch / "f.abbepart")
            start = threading.Barrier(4)
            written = []

            def write(i):
                start.wait()
                fresh.write(self.scratch / f"{i}.exr")
                written.append((self.scratch / f"{i}.exr").read_bytes() == whole)

            writers = [threading.Thread(target=write, args=(i,)) for i in range(4)]
            for writer in writers:
                writer.start()
            for writer in writers:
                writer.join()
            self.assertEqual(written, [True] * 4)

    def test_errors_that_are_not_known_are_none(self):
        scene = abbe.Scene(box())
        self.assertEqual([abbe.render(scene).stats[key] for key in ("relative_error", "frame_mean_error")], [None, None])
        measured = abbe.render(scene, progress=lambda p: None).stats
        self.assertTrue(0 < measured["relative_error"] < 1 and 0 < measured["frame_mean_error"] < 1, measured)

    def test_costs_of_films_that_were_not_rendered_here_are_none(self):
        scene = abbe.Scene(box())
        costs = ("wall_s", "cpu_s", "threads")
        whole = abbe.render(scene, threads=1)
        self.assertGreater(whole.stats["wall_s"], 0)
        self.assertEqual(whole.stats["threads"], 1)
        whole.write(self.scratch / "f.abbepart")
        for film in (abbe.Film.read(self.scratch / "f.abbepart"), abbe.merge([abbe.render(scene, sample_range=(i, i + 2)) for i in (0, 2)])):
            self.assertEqual([film.stats[key] for key in costs], [None, None, None])
            self.assertEqual([film.stats[key] for key in ("samples_per_pixel", "paths")], [4, whole.stats["paths"]])

    def test_one_sample_tells_no_variance(self):
        film = abbe.render(abbe.Scene(box()), spp=1)
        film.write(self.scratch / "one.exr")
        for one in (film, abbe.Film.read(self.scratch / "one.exr")):
            self.assertIsNone(one.variance)
            self.assertEqual([plane["render_error"] for plane in abbe.develop(one).figures], [None, None])
        self.assertIsNotNone(abbe.render(abbe.Scene(box()), spp=2).variance)

    def test_classes_make_no_object_without_their_constructor(self):
        for of in (abbe.Scene, abbe.Film, abbe.Progress, abbe.Developed, abbe.Diagnostic):
            for make in (of.__new__, object.__new__, type("Heir", (of,), {}).__new__):
                with self.subTest(of=of, make=make), self.assertRaisesRegex(TypeError, "is not safe"):
                    make(of)
            if of is not abbe.Scene:
                with self.assertRaisesRegex(TypeError, "No constructor defined"):
                    of()
        self.assertEqual(type("Heir", (abbe.Scene,), {})(box()).width, 8)

    def test_films_are_read_as_they_were_written(self):
        film = abbe.render(abbe.Scene(box()))
        for name in ("f.exr", "f.abbepart"):
            film.write(self.scratch / name)
            read = abbe.Film.read(self.scratch / name)
            self.assertEqual(read.channels, film.channels)
            numpy.testing.assert_array_equal(read.array, film.array)
            numpy.testing.assert_array_equal(read.variance, film.variance)
        with self.assertRaisesRegex(abbe.UsageError, "exact sums"):
            abbe.Film.read(self.scratch / "f.exr").write(self.scratch / "g.abbepart")
        with self.assertRaises(abbe.InputError):
            abbe.Film.read(self.scratch / "absent.exr")
        with self.assertRaises(abbe.OutputError):
            film.write(self.scratch / "absent" / "f.exr")
        for name in ("f", "f.npy", "f.tiff"):
            with self.assertRaisesRegex(abbe.UsageError, rf'got extension "{pathlib.Path(name).suffix}", allowed .exr, .abbepart, .png, .jpg, .tif$'):
                film.write(self.scratch / name)
        self.assertEqual(sorted(path.name for path in self.scratch.iterdir()), ["f.abbepart", "f.exr"])

    def test_parts_merge_to_the_bits_of_the_whole(self):
        scene = abbe.Scene(box(render={"samples": 16}))
        whole = abbe.render(scene)
        parts = [abbe.render(scene, sample_range=(first, first + 8)) for first in (0, 8)]
        parts[1].write(self.scratch / "p.abbepart")
        for films in (parts, [parts[0], self.scratch / "p.abbepart"], [str(self.scratch / "p.abbepart"), parts[0]]):
            merged = abbe.merge(films)
            numpy.testing.assert_array_equal(merged.array, whole.array)
            merged.write(self.scratch / "m.exr")
            whole.write(self.scratch / "w.exr")
            self.assertEqual((self.scratch / "m.exr").read_bytes(), (self.scratch / "w.exr").read_bytes())
        with self.assertRaisesRegex(abbe.InputError, "samples 8:16 of the render are missing"):
            abbe.merge(parts[:1])
        self.assertEqual(abbe.merge(parts[:1], partial=True).stats["samples_per_pixel"], 8)
        self.assertEqual(whole.stats["samples_per_pixel"], 16)
        with self.assertRaisesRegex(abbe.InputError, r"films\[1\]"):
            abbe.merge([parts[0], parts[0]])
        for other in (None, 3):
            with self.assertRaisesRegex(TypeError, rf"^films\[0\]: expected a film or the path of a part \(got a {type(other).__name__}\)$"):
                abbe.merge([other])
        for text in ("p.abbepart", str(self.scratch / "p.abbepart")):
            with self.assertRaisesRegex(TypeError, r"^films: expected a list of films or paths \(got a str\)$"):
                abbe.merge(text)
        with self.assertRaisesRegex(abbe.UsageError, "read from an image"):
            abbe.merge([abbe.Film.read(self.scratch / "w.exr")])

    def test_pixels_of_different_samples_have_no_count_in_common(self):
        (self.scratch / "box.json").write_text(json.dumps(box(abbe=1)))
        parts = []
        for samples, crop in (("0:2", "0,0,4,6"), ("0:1", "4,0,8,6")):
            parts.append(self.scratch / f"{crop}.abbepart")
            self.command("render", self.scratch / "box.json", "--spp", 2, "--sample-range", samples, "--crop", crop, "--quiet", "-o", parts[-1])
        uneven = abbe.merge(parts, partial=True)
        self.assertIsNone(uneven.stats["samples_per_pixel"])
        self.assertNotIn("samples_per_pixel", uneven.metadata)
        self.assertEqual(uneven.stats["paths"], (2 + 1) * 4 * 6)
        self.assertEqual(abbe.Film.read(parts[0]).stats["samples_per_pixel"], 2)

    def test_parts_of_the_program_are_of_another_build(self):
        abbe.render(abbe.Scene(CORNELL), spp=2, sample_range=(0, 1)).write(self.scratch / "a.abbepart")
        self.command("render", CORNELL, "--spp", 2, "--sample-range", "1:2", "--quiet", "-o", self.scratch / "b.abbepart")
        with self.assertRaisesRegex(abbe.InputError, "build"):
            abbe.merge([self.scratch / "a.abbepart", self.scratch / "b.abbepart"])

    def test_pictures_are_code_values(self):
        picture = abbe.render(abbe.Scene(CORNELL), spp=1).picture()
        self.assertEqual(picture.shape, (256, 256, 3))
        self.assertTrue(0 <= picture.min() and 0.9 < picture.max() <= 1)
        with self.assertRaisesRegex(abbe.UsageError, "one or three channels"):
            abbe.render(abbe.Scene(box())).picture()
        alike = {name: {"band": [400, 500]} for name in "abc"}
        film = abbe.render(abbe.Scene(box(sensor={"resolution": [8, 6], "channels": alike})))
        for picture in (film.picture, abbe.develop(film).picture):
            with self.assertRaisesRegex(abbe.UsageError, "channels a, b, c do not distinguish colours"):
                picture()

    def test_notebooks_show_films_without_a_picture_as_text(self):
        bands = {name: {"band": [400 + 50 * i, 450 + 50 * i]} for i, name in enumerate("abcd")}
        for channels in (1, 2, 3, 4):
            film = abbe.render(abbe.Scene(box(sensor={**box()["sensor"], "channels": dict(list(bands.items())[:channels])})), spp=1)
            for shown in (film, abbe.develop(film)):
                with self.subTest(channels=channels, shown=shown):
                    if channels in (1, 3):
                        self.assertEqual(shown._repr_png_()[:4], b"\x89PNG")
                        continue
                    self.assertIsNone(shown._repr_png_())
                    with self.assertRaisesRegex(abbe.UsageError, "one or three channels"):
                        shown.picture()
        with self.assertRaisesRegex(abbe.InputError, "unsupported emissiveUnits"):
            self.write_bands([400, 500, 600], "W.m^-2.sr^-1.nm^-1")._repr_png_()

    def test_names_of_channels_that_are_not_utf_8_are_told(self):
        abbe.render(abbe.Scene(box()), spp=1).write(self.scratch / "f.exr")
        odd = self.scratch / "odd.exr"
        odd.write_bytes((self.scratch / "f.exr").read_bytes().replace(b"long", b"l\xf6ng"))
        film = abbe.Film.read(odd)
        self.assertEqual(film.channels, ["l\udcf6ng", "short"])
        self.assertIn("channel.l\udcf6ng", film.metadata)


if __name__ == "__main__":
    unittest.main()
