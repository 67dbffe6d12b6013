"""The manual: commands of its pages run, print what the pages show and make their pictures; figures are beside their known answers.

A page is Markdown of docs/guide or docs/reference, or the README. Its fenced blocks mean:
  ```sh            commands, which run in their order in one folder a page; `data` and `docs` lie in it, `abbe` is found
  ```sh not-run    commands that need what a test has not: files of the reader's own, several machines, a browser
  ```json a.json   a file, written before the commands that follow; so for any language that is followed by a name
  ```text          what the block before printed: its lines, in order; "…" stands for anything, on a line of its own for any lines
"""
import csv
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

import OpenImageIO as oiio
import numpy as np

import colour
import spectra

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*/*.md"))]
FENCE = re.compile(r"^```(\w+)[ ]*([^\n]*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def words(text):
    """Text without line breaks, continued or not."""
    return " ".join(text.replace("\\\n", " ").split())


def output_pattern(shown):
    """The pattern of an output that shows these lines, among others."""
    parts = []
    for line in shown.splitlines():
        if line.strip() == "…":
            parts.append(r"(?:.*\n)*?")
        else:
            parts.append(r"[ ]*" + r"[ ]+".join(".*?".join(map(re.escape, word.split("…"))) for word in line.split()) + r"[ ]*\n")
    return re.compile("".join(parts))


def picture(path):
    return oiio.ImageBuf(str(path)).get_pixels(oiio.FLOAT)


class Page(unittest.TestCase):
    """Runs the commands of PAGE, a path below docs, once."""

    PAGE = None

    @classmethod
    def setUpClass(cls):
        if cls.PAGE is None:
            raise unittest.SkipTest("no page")
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.scratch = pathlib.Path(folder.name)
        cls.text = (ROOT / "docs" / cls.PAGE).read_text(encoding="utf-8")
        (cls.scratch / "data").symlink_to(spectra.DATA)
        for name in ("docs", "python"):
            (cls.scratch / name).symlink_to(ROOT / name)
        binary = pathlib.Path(os.environ["ABBE_BINARY"])
        program = cls.scratch / "abbe"
        program.write_text(f"""#!/bin/sh
[ "$1" = python ] && {{ shift; PYTHONPATH={binary.parents[1] / "python"} exec {sys.executable} -B "$@"; }}
exec "{binary}" "$@"
""")
        program.chmod(0o755)
        cls.run_page({**os.environ, "PATH": f"{cls.scratch}{os.pathsep}{os.environ['PATH']}"})

    @classmethod
    def run_page(cls, environment):
        printed = None
        for language, name, body in FENCE.findall(cls.text):
            if language == "sh" and name != "not-run":
                done = subprocess.run(["bash", "-euo", "pipefail", "-c", body], cwd=cls.scratch, env=environment,
                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
                if done.returncode != 0:
                    raise AssertionError(f"{cls.PAGE}: exit {done.returncode} of\n{body}\n{done.stdout}")
                printed = done.stdout
            elif language == "text" and printed is not None:
                if not output_pattern(body).search(printed):
                    raise AssertionError(f"{cls.PAGE} shows\n{body}\nand the program printed\n{printed}")
            else:
                printed = None
                if name and language != "sh":
                    (cls.scratch / name).write_text(body, encoding="utf-8")

    def read(self, name):
        return json.loads((self.scratch / name).read_text())

    def claimed(self, pattern):
        """The number that the page states where the pattern's group is."""
        return float(re.search(pattern, words(self.text))[1])

    def test_its_pictures_are_what_its_commands_make(self):
        # A picture that links to another page is made there.
        own = re.sub(r"\[!\[[^\]]*\]\([^)]*\)\]\([^)]*\)", "", self.text)
        for shown in re.findall(r"!\[[^\]]*\]\(([^)]*)\)", own):
            expected, made = (ROOT / "docs" / self.PAGE).parent / shown, self.scratch / pathlib.Path(shown).name
            self.assertTrue(expected.is_file(), shown)
            self.assertTrue(made.is_file(), f"no command makes {shown}")
            if made.suffix == ".svg":
                xml.etree.ElementTree.parse(made)
                continue
            a, b = picture(expected), picture(made)
            self.assertEqual(a.shape, b.shape, shown)
            self.assertLess(np.abs(a - b).mean(), 0.015, shown)  # noise of another machine's bits


class guide_calibration(Page):
    PAGE = "guide/calibration.md"

    def test_the_chart_is_seen_as_well_as_the_camera_can(self):
        limit, found, uneven = (self.read(name)["unseen_dE00_mean"] for name in ("limit.json", "found.json", "uneven.json"))
        self.assertAlmostEqual(limit, self.claimed(r"without noise (\d+(?:\.\d+)?)"), delta=0.005)
        self.assertAlmostEqual(found, self.claimed(r"flat-fielded (\d+(?:\.\d+)?)"), delta=0.005)
        self.assertAlmostEqual(uneven, self.claimed(r"as it is (\d+(?:\.\d+)?)"), delta=0.005)
        self.assertLess(abs(found - limit), 0.1)
        self.assertAlmostEqual(self.read("tested.json")["test_dE00_mean"], self.claimed(r"is (\d+(?:\.\d+)?) over its 30"), delta=0.005)

    def test_numpy_finds_the_same_errors(self):
        choice = self.read("choice.json")
        _, xyz, white = spectra.chart_colours("D65")
        reflectances = np.array(list(spectra.table("reflectance/colorchecker24_babelcolor_average.csv").values()))
        light = spectra.lamp("D65")
        for one in choice["tried"] + choice["widths"]:
            bands = [tuple(map(float, band.split("-"))) for band in reversed(one["bands"].split(","))]  # R, G, B
            # A sample at an edge stands for a half, which makes the sum the integral over the band.
            curves = np.array([((spectra.NM >= low) / 2 + (spectra.NM > low) / 2) * ((spectra.NM <= high) / 2 + (spectra.NM < high) / 2) for low, high in bands])
            values = reflectances @ (curves * light).T / (curves @ light)
            seen = values @ np.array(one["columns"])
            errors = colour.delta_e_2000(colour.lab(xyz, white), colour.lab(seen, white))
            self.assertAlmostEqual(errors.mean(), one["dE00_mean"], delta=0.001, msg=one["bands"])
        self.assertEqual(choice["best"]["left_out_dE00_mean"], min(one["left_out_dE00_mean"] for one in choice["tried"]))
        self.assertAlmostEqual(choice["best"]["left_out_dE00_mean"], self.claimed(r"best 40 nm set (\d+(?:\.\d+)?)"), delta=0.005)


class guide_ccd(Page):
    PAGE = "guide/ccd.md"

    def test_the_chart_is_seen_as_well_as_the_filters_can(self):
        limit, found = (self.read(name)["unseen_dE00_mean"] for name in ("limit.json", "found.json"))
        self.assertAlmostEqual(limit, self.claimed(r"without noise (\d+(?:\.\d+)?)"), delta=0.005)
        self.assertAlmostEqual(found, self.claimed(r"flat-fielded (\d+(?:\.\d+)?)"), delta=0.005)
        self.assertLess(abs(found - limit), 0.1)

    def test_gain_and_read_noise_are_those_of_the_model(self):
        found = self.read("transfer.json")
        gain, noise = (np.average(found[key], weights=[1, 2, 1]) for key in ("gain_e_per_dn", "read_noise_e"))
        # What 98304 pixels tell.
        self.assertAlmostEqual(gain / self.claimed(r"planted gain is (\d+(?:\.\d+)?)"), 1, delta=0.01)
        self.assertAlmostEqual(noise / 3, 1, delta=0.01)
        model = json.loads((spectra.DATA / "sensor" / "dslr_apsc_bayer_14bit.json").read_text())["sensor"]["readout"]
        self.assertEqual(model["read_noise_e"], 3)


class guide_spectrograph(Page):
    PAGE = "guide/spectrograph.md"

    def test_the_lines_of_cadmium_are_found(self):
        found = self.read("found.json")
        miss = np.abs(np.subtract(found["found_nm"], found["listed_nm"])).max()
        self.assertLess(miss, self.claimed(r"within (\d+(?:\.\d+)?) nm"))


class guide_prism(Page):
    PAGE = "guide/prism.md"

    def test_the_bow_ends_where_descartes_says(self):
        edges = self.read("edges.json")
        with open(spectra.DATA / "reference" / "rainbow_water_20C.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        expected = {}
        for name, nm in (("450", "450"), ("546", "546.0740"), ("656", "656.2725")):
            row = next(r for r in rows if float(r["wavelength_nm"]) == float(nm) and r["order_k"] == "1" and r["index_used"] == "relative_to_air")
            angle, incidence = (np.radians(float(row[key])) for key in ("angle_from_antisolar_deg", "incidence_deg"))
            # The ray leaves the drop, of radius 10 mm, as far beside its middle as it came, and goes 200 mm up.
            expected[name] = 200 * np.tan(angle) + 10 * np.sin(incidence) / np.cos(angle)
            self.assertAlmostEqual(edges[name], expected[name], delta=self.claimed(r"within (\d+(?:\.\d+)?) mm"), msg=name)
        spread, wanted = (radii["656"] - radii["450"] for radii in (edges, expected))
        self.assertAlmostEqual(spread, wanted, delta=self.claimed(r"differ by is right to (\d+(?:\.\d+)?) mm"))

    def test_the_second_prism_deviates_a_colour_as_the_first_does(self):
        found = self.read("newton_found.json")
        within = self.claimed(r"formula agree within (\d+(?:\.\d+)?)°")
        for nm, query, screen in zip(found["nm"], found["query_deg"], found["screen_deg"]):
            self.assertAlmostEqual(screen, query, delta=within, msg=nm)
            row = re.search(rf"^\| {nm:.0f} \| ([\d.]+)° \| ([\d.]+)° \|$", self.text, re.MULTILINE)
            self.assertAlmostEqual(query, float(row[1]), delta=0.006, msg=nm)
            self.assertAlmostEqual(screen, float(row[2]), delta=0.02, msg=nm)


class guide_lens(Page):
    PAGE = "guide/lens.md"

    def test_the_focus_is_where_the_lensmaker_says(self):
        # Schott's data sheet of N-BK7.
        for nm, n in (("486.1327", 1.52238), ("587.5618", 1.51680), ("656.2725", 1.51432)):
            # Thick plano-convex lens, curved side to the light: f = R/(n - 1), of which the glass takes t/n. A ray at 0.5 mm comes short by some h^2/f.
            paraxial = 51.68 / (n - 1) - 5 / n
            self.assertAlmostEqual(self.read("focus.json")[nm], paraxial, delta=0.01, msg=nm)


class guide_light_paths(Page):
    PAGE = "guide/light_paths.md"

    def test_the_textbook_is_right(self):
        found = self.read("found.json")
        self.check_useful(found["useful"])
        for before, after in zip(found["terms"], found["terms"][1:]):
            self.assertAlmostEqual(after / before, 0.8, delta=0.005)
        self.assertAlmostEqual(found["terms"][0], self.claimed(r"lamp's own (\d\.\d+)"), delta=0.001)
        blur = [found["map"][nearest] for nearest in ("25", "100", "400", "1600")]
        self.assertEqual(blur, sorted(blur))
        # Error falls as the square root of the passes or slower [Hachisuka2009].
        progress = [found["ppm"][passes] for passes in ("4", "16", "64")]
        for before, after in zip(progress, progress[1:]):
            self.assertGreater(before / after, 1.4)
        for lamp, claim in (("A", r"\(A\) (\d+) lm/W"), ("FL2", r"\(FL2\) (\d+)"), ("FL11", r"\(FL11\) (\d+)"), ("LED-B1", r"\(LED-B1\) (\d+)")):
            self.assertAlmostEqual(found["efficacy"][lamp], self.claimed(claim), delta=0.5, msg=lamp)
        self.assertAlmostEqual(found["blue_over_red"]["cloud"], 1, delta=0.01)
        self.assertAlmostEqual(found["blue_over_red"]["air"], (650 / 450) ** 4, delta=0.05)
        self.check_directions(found["directions"])
        self.check_lights(found["lights"])
        self.check_roulette(found["roulette"])
        self.check_plots()
        self.check_pictures()

    def check_useful(self, found):
        photons, adjoint, path = (found[traced] for traced in ("photons", "adjoint", "path"))
        for wide in ("1", "1.4"):
            self.assertAlmostEqual(photons[wide] / photons["0.5"] / (float(wide) / 0.5) ** 2, 1, delta=0.25, msg=wide)
            self.assertAlmostEqual(adjoint[wide] / adjoint["0.5"], 1, delta=0.2, msg=wide)
        self.assertGreater(adjoint["0.5"], 50 * photons["0.5"])
        self.assertGreater(path["0.5"], 10 * adjoint["0.5"])
        self.check_claims("photons, lens of 0.5 m", [photons["0.5"]])
        self.check_claims("adjoint photons from the pixels (`adjoint-brute`), lens of 0.5 m", [adjoint["0.5"]])

    def check_claims(self, row, measured):
        """The last numbers of the page's row that begins so are those measured, to the digits stated or what other machines' bits change."""
        page = self.text
        cells = re.search(rf"^\| {re.escape(row)} \|(.*)\|$", page, re.MULTILINE)[1].split("|")
        for cell, value in zip(cells[-len(measured):], measured):
            stated = float(cell)
            self.assertAlmostEqual(value, stated, delta=max(0.01 * stated, 0.6 * 10.0 ** -len(cell.strip().partition(".")[2])), msg=row)

    def check_directions(self, found):
        formulas = {"uniform": lambda n: n**2 / (2 * n + 1), "cosine": lambda n: (n - 1) ** 2 / (4 * n), "bsdf": lambda n: 0}
        for directions, formula in formulas.items():
            for exponent, variance in found[directions].items():
                expected = formula(int(exponent))
                # 65536 paths tell the variance to some 1 % of heavy tails.
                self.assertAlmostEqual(variance, expected, delta=0.03 * expected + 1e-6, msg=f"{directions}, {exponent}")
        for directions, density in (("uniform", "1/(2π)"), ("cosine", "cos θ/π"), ("bsdf", "f cos θ/ρ")):
            for exponent, last in (("1", 3), ("20", 1)):
                page = self.text
                cells = re.search(rf"^\| `{directions}` \| {re.escape(density)} \|(.*)\|$", page, re.MULTILINE)[1].split("|")
                self.assertAlmostEqual(float(cells[-last]), found[directions][exponent], delta=0.006, msg=directions)

    def check_lights(self, found):
        for case, errors in found.items():
            bsdf, light, balance, power = (errors[way] for way in ("bsdf, balance", "light, balance", "mis, balance", "mis, power"))
            roughness, radius = case.split(", ")
            self.assertLess(power, 1.4 * min(bsdf, light), case)
            self.assertLess(balance, max(bsdf, light), case)
            self.assertGreater(max(bsdf, light), 7 * min(bsdf, light), case)
            self.check_claims(f"α = {roughness}, r = {radius} m", [bsdf, light, balance, power])
        self.assertLess(found["0.05, 2"]["bsdf, balance"], found["0.05, 2"]["light, balance"])
        self.assertLess(found["0.05, 2"]["mis, balance"], found["0.05, 2"]["mis, power"])

    def check_roulette(self, found):
        for case, variance in found.items():
            albedo, depth = (float(number) for number in case.split(", "))
            left = albedo**depth
            expected = left * ((1 + albedo) / 4 - left)
            # Of 65536 paths, the rare ones that survive long weigh most.
            self.assertAlmostEqual(variance, expected, delta=0.05 * expected, msg=case)
            self.check_claims(f"{albedo} | {depth:.0f}", [expected, variance])

    def check_plots(self):
        shown = set(re.findall(r"\(\.\./images/(lessons_\w+\.\w+)\)", self.text))
        self.assertEqual(shown, {path.name for path in self.scratch.glob("lessons_*")})
        for name in shown:
            self.assertTrue((ROOT / "docs" / "images" / name).is_file(), name)
        for name, lines, dots in (("photons", 2, 15), ("maps", 2, 7), ("directions", 3, 12), ("roulette", 3, 7), ("lamps", 4, 0)):
            svg = xml.etree.ElementTree.parse(self.scratch / f"lessons_{name}.svg")
            drawn = {tag: svg.findall(f".//{{http://www.w3.org/2000/svg}}{tag}") for tag in ("polyline", "circle")}
            self.assertEqual((len(drawn["polyline"]), len(drawn["circle"])), (lines, dots), name)
            points = [(float(dot.get("cx")), float(dot.get("cy"))) for dot in drawn["circle"]]
            points += [tuple(map(float, point.split(","))) for line in drawn["polyline"] for point in line.get("points").split()]
            for x, y in points:  # within the axes
                self.assertTrue(58 <= x <= 316 and 34 <= y <= 250, f"{name}: {x}, {y}")
            if name == "photons":  # of the series, each term as far below the one before
                below = np.diff([y for _, y in points[9:15]])
                self.assertLess(np.ptp(below), 0.05 * below.mean())

    def check_pictures(self):
        ways = np.hsplit(picture(self.scratch / "lessons_plates.png")[..., 1], 3)
        smooth, rough = ((slice(57, 66), slice(146, 166)), (slice(109, 118), slice(40, 100)))  # under the largest lamp, under the smallest
        noise = [[np.abs(np.diff(way[part], axis=1)).mean() for way in ways] for part in (smooth, rough)]
        for best, worst, both in (noise[0], (noise[1][1], noise[1][0], noise[1][2])):
            self.assertGreater(worst, 5 * best)
            self.assertLess(both, 3 * best)
        cloud, air = (half[26:46, 26:46].mean(axis=(0, 1)) for half in np.hsplit(picture(self.scratch / "lessons_sky.png"), 2))
        self.assertGreater(cloud.min(), 0.5)
        self.assertLess(np.ptp(cloud), 0.01)
        self.assertGreater(air[2], 1.2 * air[1])
        self.assertGreater(air[1], 1.2 * air[0])


def case_name(page):
    return page.stem if page.parent == ROOT else f"{page.parent.name}_{page.stem}"


for one in PAGES:
    globals().setdefault(case_name(one), type(case_name(one), (Page,), {"PAGE": os.path.relpath(one, ROOT / "docs")}))


if __name__ == "__main__":
    unittest.main()
