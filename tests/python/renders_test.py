"""Renders in one process: their threads, progress, interruption, cost and memory."""
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import threading
import time
import unittest

import numpy

import abbe
from common import CORNELL, NIGHTLY, Test, box, cornell_sensor


def memory_kb():
    return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGESIZE") // 1024


class Renders(Test):
    def test_renders_of_two_threads_have_the_bits_they_have_alone(self):
        scene = abbe.Scene(CORNELL, sensor=cornell_sensor(96))
        alone = [abbe.render(scene, spp=3, seed=seed).array for seed in (1, 2)]
        beside = [None, None]

        def render(i):
            beside[i] = abbe.render(scene, spp=3, seed=i + 1, threads=1).array

        threads = [threading.Thread(target=render, args=(i,)) for i in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertFalse(numpy.array_equal(*alone))
        for i in range(2):
            numpy.testing.assert_array_equal(beside[i], alone[i])

    def test_other_threads_run_while_one_renders(self):
        turns = []
        ended = threading.Event()

        def count():
            while not ended.wait(0.01):
                turns.append(1)

        counter = threading.Thread(target=count)
        counter.start()
        abbe.render(abbe.Scene(CORNELL), time=1)
        ended.set()
        counter.join()
        self.assertGreater(len(turns), 20)

    def test_progress_is_told_on_the_calling_thread(self):
        told = []
        scene, spp = (abbe.Scene(CORNELL), 48) if NIGHTLY else (abbe.Scene(box(sensor={**box()["sensor"], "resolution": [8, 8]})), 12288)
        film = abbe.render(scene, spp=spp, progress=lambda p: told.append((p.share, p.samples, p.elapsed_s, p.error, threading.get_ident())))
        self.assertEqual({t[4] for t in told}, {threading.get_ident()})
        shares = [t[0] for t in told]
        self.assertTrue(shares == sorted(shares) and 0 < shares[0] < 0.5 and shares[-1] <= 1, shares)
        self.assertEqual(told[0][1] % 4, 0)
        self.assertLess(told[-1][3], 1)
        numpy.testing.assert_array_equal(film.array, abbe.render(scene, spp=spp).array)

    def test_what_the_callback_raises_ends_the_render(self):
        def refuse(progress):
            raise KeyError("enough")

        begin = time.monotonic()
        with self.assertRaisesRegex(KeyError, "enough"):
            abbe.render(abbe.Scene(box()), spp=10000000, progress=refuse)
        self.assertLess(time.monotonic() - begin, 30)

    def test_control_c_ends_the_render(self):
        begin = time.monotonic()
        timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            abbe.render(abbe.Scene(CORNELL), spp=100000)
        timer.join()
        self.assertLess(time.monotonic() - begin, 30)
        self.assertEqual(abbe.render(abbe.Scene(box())).stats["samples_per_pixel"], 4)  # the next render is not affected

    def test_python_ends_while_a_thread_of_its_own_renders(self):
        for call in ("abbe.render(abbe.Scene(box()), spp=10**6, threads=1)", "abbe.render(abbe.Scene(box()), spp=10**6, threads=1, progress=lambda p: sum(range(20000)))",
                     "abbe.meter(box(meters={'floor': {'at': [0, 0, 0.5], 'normal': [0, 0, 1]}}), spp=10**6)", "[abbe.ior('N-BK7', 500.0) for _ in range(10**9)]"):
            program = ("import threading, time\nimport abbe\nfrom common import box\n"
                       f"threading.Thread(target=lambda: {call}, daemon=True).start()\ntime.sleep(0.3)\n")
            ended = subprocess.run([sys.executable, "-B", "-c", program], capture_output=True, text=True, timeout=60)
            self.assertEqual((ended.returncode, ended.stderr), (0, ""), call)

    def test_time_and_error_end_renders(self):
        scene = abbe.Scene(CORNELL, sensor=cornell_sensor(96))
        self.assertLess(abbe.render(scene, error=0.3).stats["relative_error"], 0.3)
        self.assertLess(abbe.render(scene, time=0.2).stats["wall_s"], 20)
        for wrong in ({"time": numpy.timedelta64(1, "ns")}, {"error": numpy.complex128(0.5)}, {"spp": 0}, {"error": 2}, {"time": 0}, {"threads": -1}, {"sample_range": (0, 5), "spp": 4}):
            with self.subTest(wrong=wrong), self.assertRaises(abbe.UsageError):
                abbe.render(scene, **wrong)

    def test_whole_numbers_are_those_that_are_whole(self):
        scene = abbe.Scene(box())
        for whole in (numpy.int64(3), numpy.uint8(3), numpy.array(3)):
            self.assertEqual(abbe.render(scene, spp=whole, seed=whole, threads=whole).metadata["seed"], "3")
        for fraction in (2.5, 2.0, numpy.float32(2.5), numpy.float16(2), numpy.array(2.5), numpy.timedelta64(2, "ns"), "2"):
            for wrong in ({"spp": fraction}, {"seed": fraction}, {"threads": fraction}, {"sample_range": (0, fraction)}):
                with self.subTest(wrong=wrong), self.assertRaises(TypeError):
                    abbe.render(scene, **wrong)
            with self.subTest(fraction=fraction), self.assertRaises(TypeError):
                abbe.meter(scene, spp=fraction)
            with self.subTest(fraction=fraction), self.assertRaises(TypeError):
                abbe.calibrate("Nikon_D5100", "A", bits=fraction)

    def test_renders_are_bounded_as_those_of_the_command(self):
        scene = abbe.Scene(box())
        for option, argument, last in (("--spp", "spp", 2 ** 24), ("--seed", "seed", 2 ** 53 - 1), ("--threads", "threads", 1024)):
            self.assertIn(f"in [{1 if argument == 'spp' else 0}, {last}]", self.refused("render", "x", option, last + 2))
            for beyond in (-1, last + 2):
                with self.subTest(argument=argument), self.assertRaises(abbe.UsageError) as caught:
                    abbe.render(scene, **{argument: beyond})
                self.assertIn(f"--{caught.exception}".replace(f"got {beyond}", f'got "{beyond}"'), self.refused("render", "x", option, beyond))
        self.assertEqual(abbe.render(scene, seed=2 ** 53 - 1).metadata["seed"], str(2 ** 53 - 1))

    def test_samples_that_are_given_exclude_time_and_error(self):
        scene = abbe.Scene(box())
        given = {"spp": 4, "sample_range": (0, 2), "error": 0.1, "time": 1}
        for fixed in ("spp", "sample_range"):
            for other in ("error", "time"):
                with self.assertRaisesRegex(abbe.UsageError, f"^{fixed} excludes {other}$"):
                    abbe.render(scene, **{fixed: given[fixed], other: given[other]})

    def test_ranges_of_python_are_ranges_of_samples(self):
        scene = abbe.Scene(box())
        for given in (range(1, 3), [1, 3], numpy.array([1, 3])):
            with self.subTest(given=given):
                film = abbe.render(scene, sample_range=given)
                self.assertEqual(film.stats["samples_per_pixel"], 2)
                numpy.testing.assert_array_equal(film.array, abbe.render(scene, sample_range=(1, 3)).array)
        numpy.testing.assert_array_equal(abbe.merge([abbe.render(scene, sample_range=range(i, i + 2)) for i in (0, 2)]).array, abbe.render(scene).array)
        with self.assertRaisesRegex(abbe.UsageError, r"^sample_range: got \(2, 2\), allowed first < last"):
            abbe.render(scene, sample_range=range(2, 2))
        for wrong in (range(0, 4, 2), range(1, 3, 2), range(1, -1, -1), range(-1, 2), b"\0\2", bytearray(b"\0\2"), memoryview(b"\0\2"), "02", {0, 2}, (0, 1, 2), (0, 1.5), 3):
            with self.subTest(wrong=wrong), self.assertRaises(TypeError) as caught:
                abbe.render(scene, sample_range=wrong)
            self.assertEqual(str(caught.exception), f"sample_range: expected (first, last), whole numbers from 0 on, or a range of step 1 (got {wrong!r})")

    def test_memory_is_flat_over_many_renders(self):
        edge, renders = (128, 100) if NIGHTLY else (80, 50)
        scene = abbe.Scene(CORNELL, sensor={"resolution": [edge, edge], "observer": "1931"})
        for i in range(renders):
            film = abbe.render(scene, spp=1, seed=i)
            self.assertEqual(film.array.shape, (edge, edge, 3))
            film.picture()
            if i == 9:
                early = memory_kb()
        # A leak of one film per render would be 70 MB, without ABBE_NIGHTLY 12 MB.
        self.assertLess(memory_kb() - early, 4000)

    @unittest.skipUnless(NIGHTLY, "for the night")
    def test_a_render_costs_what_the_command_costs(self):
        scene = self.scratch / "box.json"
        scene.write_text(json.dumps(box(abbe=1)))

        def instructions(*command):
            counted = subprocess.run(["valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null", *map(str, command)],
                                     check=True, capture_output=True, text=True, cwd=self.scratch, env=os.environ | {"PYTHONHASHSEED": "0"})
            return int(re.search(r"I +refs: +([\d,]+)", counted.stderr)[1].replace(",", ""))

        def of_command(spp):
            return instructions(os.environ["ABBE_BINARY"], "render", scene, "--spp", spp, "--quiet", "--threads", 1, "-o", "c.exr")

        def of_module(spp):
            return instructions(sys.executable, "-B", "-c", f"import abbe; abbe.render(abbe.Scene({str(scene)!r}), spp={spp}, threads=1).array")

        # The cost of the samples, after the same cost to start. It is counted in instructions, because times differ more between runs of the same
        # program, depending on the memory layout.
        own, command = (cost(2080) - cost(32) for cost in (of_module, of_command))
        paths = 2048 * 8 * 6
        print(f"Instructions of a path: {own / paths:.0f} in Python, {command / paths:.0f} by the command: {own / command:.4f}")
        self.assertLess(own, 1.02 * command)
        self.assertGreater(own, 0.98 * command)


if __name__ == "__main__":
    unittest.main()
