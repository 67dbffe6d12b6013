"""Materials, tables and colours over arrays: the results equal those of the command."""
import json
import time
import unittest

import numpy

import abbe
from common import Test

LINES = [486.1327, 587.5618, 656.2725]


def objects(*elements):
    """A one-dimensional array of these objects."""
    array = numpy.empty(len(elements), object)
    for i, element in enumerate(elements):
        array[i] = element
    return array


class Queries(Test):
    def query(self, *arguments):
        return json.loads(self.command("query", *arguments, "--json"))

    def test_indices_are_those_of_the_command(self):
        for name in ("N-BK7", "Au_Johnson", "schott/N-SF11"):
            told = self.query("ior", name, "--at", ",".join(map(str, LINES)))
            self.assertEqual(abbe.ior(name, LINES).tolist(), told["n"], name)
            self.assertEqual(abbe.extinction(name, LINES).tolist(), told["k"], name)
        self.assertAlmostEqual(abbe.ior("N-BK7", 587.5618), 1.5168, places=7)
        self.assertEqual(abbe.ior("N-BK7", numpy.full((2, 3), 500)).shape, (2, 3))
        self.assertEqual(abbe.material("N-BK7")["medium"], "air")

    def test_extinctions_that_are_not_measured_are_unknown_as_to_the_command(self):
        told = self.query("ior", "N-LASF31A", "--at", "300,334")
        self.assertIsNone(told["k"][0])
        first, second = abbe.extinction("N-LASF31A", [300, 334])
        self.assertTrue(numpy.isnan(first))
        self.assertEqual(second, told["k"][1])
        self.assertTrue(numpy.isnan(abbe.extinction("water", 550)))
        glass = abbe.material("N-LASF31A")
        self.assertEqual([glass[key] for key in ("low_nm", "high_nm", "k_low_nm", "k_high_nm")], [250, 2500, 334, 2500])
        self.assertIsNone(abbe.material("water")["k_low_nm"])

    def test_what_coats_water_is_met_from_air(self):
        told = self.query("reflectance", "water", "--at", "550", "--angle", "60", "--coating", "MgF2:100")
        self.assertEqual(told["medium"], "air")
        rs, rp = abbe.reflectance("water", 550, 60, coating=[("MgF2", 100)])
        self.assertEqual((rs, rp), (told["Rs"], told["Rp"]))

    def test_reflectances_are_broadcast_and_those_of_the_command(self):
        told = self.query("reflectance", "Ag_Johnson", "--at", "500,600", "--angle", "0,60,90", "--coating", "MgF2:100", "--arrays")
        rs, rp = abbe.reflectance("Ag_Johnson", [[500], [600]], [0, 60, 90], coating=[("MgF2", 100)])
        self.assertEqual(rs.tolist(), told["Rs"])
        self.assertEqual(rp.tolist(), told["Rp"])
        for thickness in (0, 1e6, numpy.inf, numpy.nan):
            with self.subTest(thickness=thickness), self.assertRaisesRegex(abbe.UsageError, r"^coating: .* allowed up to 16 layers of \(0, 100000\] nm"):
                abbe.reflectance("N-BK7", 550, coating=[("MgF2", thickness)])

    def test_prisms_deviate_as_by_the_command(self):
        told = self.query("prism", "N-SF11", "--apex", "60", "--at", "486.1327,587.5618")
        self.assertEqual(abbe.prism_deviation("N-SF11", LINES[:2]).tolist(), told["deviation_deg"])
        self.assertTrue(numpy.isnan(abbe.prism_deviation("N-SF11", 500.0, apex_deg=120)))

    def test_colours_are_those_of_the_command(self):
        told = self.query("color", "--illuminant", "A", "--observer", "1964", "--reflectance", "Blue Sky")
        for key, values in abbe.color("A", "Blue Sky", "1964").items():
            self.assertEqual(values.tolist(), told[key], key)
        grid = numpy.arange(300, 1101, 1.0)
        sampled = abbe.color((grid, abbe.illuminant("A", grid)), (grid, abbe.curve("reflectance", "Blue Sky", grid)), "1964")
        numpy.testing.assert_allclose(sampled["XYZ"], told["XYZ"], rtol=1e-12)

    def test_colours_are_summed_over_the_range_that_is_chosen(self):
        numpy.testing.assert_allclose(abbe.color("D65")["xy"], [0.312727, 0.329023], atol=6e-7)
        numpy.testing.assert_allclose(abbe.color("D65", range="380-780")["xy"], [0.312739, 0.329052], atol=6e-7)
        with self.assertRaisesRegex(abbe.UsageError, 'range: got "400-700", allowed 360-830, 380-780'):
            abbe.color("D65", range="400-700")

    def test_colour_differences_are_those_of_the_command(self):
        labs = [[50, 2.6772, -79.7751], [50, 0, -82.7485]]
        told = self.query("delta-e", *(",".join(map(str, lab)) for lab in labs))
        for formula, key in (("2000", "dE00"), ("94", "dE94"), ("76", "dE76")):
            self.assertEqual(abbe.delta_e(*labs, formula=formula), told[key])
        self.assertEqual(abbe.delta_e(numpy.zeros((4, 5, 3)), labs[0]).shape, (4, 5))
        for formula in ("2000", "94", "76", "cam16", "itp"):
            for axis in range(3):
                for wrong in (numpy.nan, numpy.inf, -numpy.inf):
                    lab = [50.0, 10.0, 10.0]
                    lab[axis] = wrong
                    for pair in ((lab, labs[0]), (labs[0], lab), (lab, lab)):
                        with self.subTest(formula=formula, pair=pair):
                            self.assertTrue(numpy.isnan(abbe.delta_e(*pair, formula=formula)))

    def test_tables_at_wavelengths(self):
        self.assertEqual(abbe.illuminant("A", 560.0), 100)
        beyond = [300.0, 830.0, 900.0, 1100.0]  # outside the table, where illuminant A is defined by its formula
        self.assertEqual(abbe.curve("illuminant", "A", beyond).tolist(), abbe.illuminant("A", beyond).tolist())
        self.assertGreater(abbe.curve("illuminant", "A", 1100.0), 280)
        self.assertEqual(abbe.observer(wavelengths_nm=555.0)["y"], 1)
        self.assertEqual(list(abbe.camera("Nikon_D5100", [550])), ["R", "G", "B"])
        photons = abbe.camera("Nikon_D5100", [450.0, 600.0], response="quantum")["G"] / abbe.camera("Nikon_D5100", [450.0, 600.0], response="energy")["G"]
        self.assertAlmostEqual(photons[1] / photons[0], 600 / 450)
        self.assertIn("D65", abbe.names("illuminant"))
        self.assertEqual(json.loads(self.command("query", "--list", "glass", "--json"))["glass"], abbe.names("glass"))

    def test_what_is_wrong_is_told(self):
        for call in (lambda nm: abbe.illuminant("A", nm), lambda nm: abbe.curve("reflectance", "Blue Sky", nm),
                     lambda nm: abbe.observer("1931", wavelengths_nm=nm), lambda nm: abbe.camera("Nikon_D5100", nm)):
            for nm in (numpy.nan, 299, [500, 1101]):
                with self.subTest(nm=nm), self.assertRaisesRegex(abbe.UsageError, r"^wavelengths_nm: .* has no data at this wavelength \(got (nan|299|1101) nm, allowed \[300, 1100\] nm\)$"):
                    call(nm)
        percent = self.scratch / "percent.csv"
        percent.write_text("# unit: %\n# outside: clamp\nwavelength_nm,T\n380,0.3\n780,0.6\n")
        ended = self.scratch / "ended.csv"
        ended.write_text("# unit: electrons per photon\nwavelength_nm,QE\n380,0.2\n780,0.2\n")
        for call, error, message in ((lambda: abbe.curve("camera", f"{ended}:QE", [500, 1000]), abbe.InputError, "covers 380 to 780 nm, but 380 to 1000 nm are needed"),
                                     (lambda: abbe.camera(str(ended), 500), abbe.InputError, "covers only 380 to 780 nm, but 58.6 % of the integral for channel \"QE\" lies outside"),
                                     (lambda: abbe.ior("N-BK", 500), abbe.InputError, 'did you mean "N-BK7"'),
                                     (lambda: abbe.ior("N-BK7", [500, 200]), abbe.UsageError, "wavelengths_nm: N-BK7 has no data at this wavelength"),
                                     (lambda: abbe.ior("N-BK7", 2000), abbe.UsageError,
                                      r"^wavelengths_nm: outside the wavelengths that Abbe supports, although N-BK7 has data there \(got 2000 nm, allowed \[300, 1100\] nm\)$"),
                                     (lambda: abbe.ior("N-BK7", [numpy.nan]), abbe.UsageError, "got nan nm"),
                                     (lambda: abbe.reflectance("N-BK7", 500, 91), abbe.UsageError, "angle_deg: got 91"),
                                     (lambda: abbe.names("lens"), abbe.UsageError, "unknown kind"),
                                     (lambda: abbe.color("D65", ([400, 390], [1, 1])), abbe.UsageError, "ascending"),
                                     (lambda: abbe.color("D65", ([400], [1])), abbe.UsageError, "two or more"),
                                     (lambda: abbe.color("D65", ([380, 780], [20, 80])), abbe.UsageError, r"reflectance: curve out of range at 380 nm \(got 20, allowed \[0, 1\]\)"),
                                     (lambda: abbe.color("D65", ([380, 780], [-0.2, 0.8])), abbe.UsageError, "got -0.2"),
                                     (lambda: abbe.color(([380, 780], [-1, 1])), abbe.UsageError, "illuminant: curve out of range"),
                                     (lambda: abbe.color("D65", ([0.38, 0.78], [0.5, 0.5])), abbe.UsageError, r"^spectrum: wavelengths from 0.38 to 0.78 nm lie outside \[300, 1100\] nm; is the unit right\?$"),
                                     (lambda: abbe.color(([3800, 7800], [1, 1])), abbe.UsageError, "^spectrum: wavelengths from 3800 to 7800 nm lie outside"),
                                     (lambda: abbe.color("D65", f"{percent}:T"), abbe.InputError, "allowed fractions of 1"),
                                     (lambda: abbe.camera(f"{percent}:T", 500, response="quantum"), abbe.InputError, "allowed fractions of 1"),
                                     (lambda: abbe.camera("Nikon_D5100", 500, response="photons"), abbe.UsageError, "response: got \"photons\", allowed energy, quantum"),
                                     (lambda: abbe.delta_e([1, 2], [1, 2]), abbe.UsageError, "last axis"),
                                     (lambda: abbe.delta_e([1, 2], [1, 2, 3]), abbe.UsageError, "lab1: has no shape in common with lab2")):
            with self.subTest(message=message), self.assertRaisesRegex(error, message):
                call()

    def test_what_is_no_real_number_is_refused(self):
        wavelengths = numpy.ma.array([500.0, 600.0], mask=[False, True])
        grid = [500.0, 600.0]
        for call in (lambda: abbe.ior("N-BK7", wavelengths), lambda: abbe.illuminant("A", wavelengths), lambda: abbe.reflectance("N-BK7", 550, wavelengths),
                     lambda: abbe.ior("N-BK7", [grid, wavelengths]), lambda: abbe.color("D65", (grid, numpy.ma.array([0.5, 0.9], mask=[False, True])))):
            with self.assertRaisesRegex(abbe.UsageError, r"^masked elements have no value \(got 1 of 2 masked, allowed none\)$"):
                call()
        unmasked = numpy.ma.array(grid, mask=[False, False])
        self.assertEqual(abbe.ior("N-BK7", unmasked).tolist(), abbe.ior("N-BK7", grid).tolist())
        self.assertEqual(abbe.ior("N-BK7", objects(500, numpy.float32(600))).tolist(), abbe.ior("N-BK7", grid).tolist())
        self.assertEqual(abbe.ior("N-BK7", numpy.array(["500", "600"])).tolist(), abbe.ior("N-BK7", grid).tolist())
        for wrong, kind in (([500 + 1j], "complex128"), (550 + 20j, "complex128"), (numpy.array([500, 600], "m8[s]"), r"timedelta64\[s\]"),
                            (numpy.array(["2001-01-01"], "M8[D]"), r"datetime64\[D\]"), (numpy.timedelta64(500, "ns"), r"timedelta64\[ns\]"),
                            (objects(numpy.timedelta64(500, "s")), r"timedelta64\[s\]"), (objects(500.0, numpy.datetime64(500, "ns")), r"datetime64\[ns\]"),
                            ([objects(numpy.array(500, "m8[ns]"))], r"timedelta64\[ns\]"), (objects(numpy.complex128(500 + 1j)), "complex128"),
                            (objects(objects(500.0)), "object")):
            with self.subTest(kind=kind), self.assertRaisesRegex(abbe.UsageError, rf"^expected real numbers \(got {kind}, allowed whole and floating-point numbers\)$"):
                abbe.ior("N-BK7", wrong)

    def test_an_object_that_is_an_array_of_one_number_is_one(self):
        one = numpy.array(500.0, dtype=object)
        self.assertEqual(abbe.ior("N-BK7", [one])[0], abbe.ior("N-BK7", one))
        self.assertEqual(abbe.ior("N-BK7", one), abbe.ior("N-BK7", 500.0))

    def test_angles_that_are_spans_of_time_are_refused(self):
        self.assertEqual(abbe.prism_deviation("N-SF11", 500.0, numpy.float32(60), numpy.int64(70)), abbe.prism_deviation("N-SF11", 500.0, 60, 70))
        for call in (lambda wrong: abbe.prism_deviation("N-SF11", 500.0, apex_deg=wrong), lambda wrong: abbe.prism_deviation("N-SF11", 500.0, incidence_deg=wrong),
                     lambda wrong: abbe.reflectance("N-BK7", 550, coating=[("MgF2", wrong)])):
            for wrong in (numpy.timedelta64(50, "ns"), numpy.timedelta64(50, "s"), numpy.complex128(50)):
                with self.assertRaises(abbe.UsageError) as caught:
                    call(wrong)
                self.assertEqual(str(caught.exception), f"expected real numbers (got {wrong.dtype}, allowed whole and floating-point numbers)")
                with self.assertRaises(abbe.UsageError) as caught:
                    call(numpy.array(wrong, dtype=object))
                self.assertEqual(str(caught.exception), f"expected real numbers (got {wrong.dtype}, allowed whole and floating-point numbers)")

    def test_what_is_no_spectrum_is_refused(self):
        for spectra, message in (((3,), "illuminant: expected a name, or wavelengths and values (got a int)"),
                                 (("D65", [1]), "reflectance: expected a name, or wavelengths and values (got a list)")):
            with self.assertRaises(TypeError) as caught:
                abbe.color(*spectra)
            self.assertEqual(str(caught.exception), message)

    def test_a_million_sellmeier_formulas_take_50_ms(self):
        wavelengths = numpy.linspace(400, 1000, 1_000_000)
        abbe.ior("N-BK7", 500.0)  # reads the table
        costs = []
        for _ in range(5):
            begin = time.process_time()
            abbe.ior("N-BK7", wavelengths)
            costs.append(time.process_time() - begin)
        print(f"a million indices: {1000 * min(costs):.1f} ms")
        self.assertLess(min(costs), 0.05)


if __name__ == "__main__":
    unittest.main()
