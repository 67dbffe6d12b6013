"""Renders in one process: their threads, progress, interruption, cost and memory."""
import json
import os
import pathlib
import signal
import threading
import time
import unittest

import numpy

import abbe
from common import CORNELL, Test, box


def memory_kb():
    return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGESIZE") // 1024


class Renders(Test):
    def test_renders_of_two_threads_have_the_bits_they_have_alone(self):
        scene = abbe.Scene(CORNELL)
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
        film = abbe.render(abbe.Scene(CORNELL), spp=48, progress=lambda p: told.append((p.share, p.samples, p.elapsed_s, p.error, threading.get_ident())))
        self.assertEqual({t[4] for t in told}, {threading.get_ident()})
        shares = [t[0] for t in told]
        self.assertTrue(shares == sorted(shares) and 0 < shares[0] < 0.5 and shares[-1] <= 1, shares)
        self.assertEqual(told[0][1] % 4, 0)
        self.assertLess(told[-1][3], 1)
        numpy.testing.assert_array_equal(film.array, abbe.render(abbe.Scene(CORNELL), spp=48).array)

    def test_what_the_callback_raises_ends_the_render(self):
        def refuse(progress):
            raise KeyError("enough")

        begin = time.monotonic()
        with self.assertRaisesRegex(KeyError, "enough"):
            abbe.render(abbe.Scene(CORNELL), spp=100000, progress=refuse)
        self.assertLess(time.monotonic() - begin, 30)

    def test_control_c_ends_the_render(self):
        begin = time.monotonic()
        timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            abbe.render(abbe.Scene(CORNELL), spp=100000)
        timer.join()
        self.assertLess(time.monotonic() - begin, 30)
        self.assertEqual(abbe.render(abbe.Scene(box())).stats["samples_per_pixel"], 4)  # and the next runs as ever

    def test_time_and_error_end_renders(self):
        scene = abbe.Scene(CORNELL)
        self.assertLess(abbe.render(scene, error=0.3).stats["relative_error"], 0.3)
        self.assertLess(abbe.render(scene, time=0.5).stats["wall_s"], 20)
        for wrong in ({"spp": 0}, {"error": 2}, {"time": 0}, {"threads": -1}, {"sample_range": (0, 5), "spp": 4}):
            with self.subTest(wrong=wrong), self.assertRaises(abbe.UsageError):
                abbe.render(scene, **wrong)

    def test_renders_are_bounded_as_those_of_the_command(self):
        scene = abbe.Scene(box())
        for option, argument, last in (("--spp", "spp", 2 ** 24), ("--seed", "seed", 2 ** 53), ("--threads", "threads", 1024)):
            self.assertIn(f"in [{1 if argument == 'spp' else 0}, {last}]", self.refused("render", "x", option, last + 2))
            for beyond in (-1, last + 2):
                with self.subTest(argument=argument), self.assertRaises(abbe.UsageError) as caught:
                    abbe.render(scene, **{argument: beyond})
                self.assertIn(f"--{caught.exception}".replace(f"got {beyond}", f'got "{beyond}"'), self.refused("render", "x", option, beyond))
        self.assertEqual(abbe.render(scene, seed=2 ** 53).metadata["seed"], str(2 ** 53))

    def test_samples_that_are_given_exclude_time_and_error(self):
        scene = abbe.Scene(box())
        given = {"spp": 4, "sample_range": (0, 2), "error": 0.1, "time": 1}
        for fixed in ("spp", "sample_range"):
            for other in ("error", "time"):
                with self.assertRaisesRegex(abbe.UsageError, f"^{fixed} excludes {other}$"):
                    abbe.render(scene, **{fixed: given[fixed], other: given[other]})

    def test_memory_is_flat_over_a_hundred_renders(self):
        scene = abbe.Scene(CORNELL, sensor={"resolution": [128, 128], "observer": "1931"})
        for i in range(100):
            film = abbe.render(scene, spp=1, seed=i)
            self.assertEqual(film.array.shape, (128, 128, 3))
            film.picture()
            if i == 9:
                early = memory_kb()
        # A leak of a film a render would be 70 MB.
        self.assertLess(memory_kb() - early, 4000)

    def test_a_render_costs_what_the_command_costs(self):
        stats = self.scratch / "stats.json"
        scene = abbe.Scene(CORNELL)

        def of_command():
            self.command("render", CORNELL, "--spp", 32, "--quiet", "--threads", 1, "-o", self.scratch / "c.exr", "--stats", stats)
            return json.loads(stats.read_text())["cpu_s"]

        def of_module():
            begin = time.process_time()
            abbe.render(scene, spp=32, threads=1).array
            return time.process_time() - begin

        # The least of several, alternating, since the machine does other things as well.
        pairs = [(of_module(), of_command()) for _ in range(5)]
        own, command = (min(costs) for costs in zip(*pairs))
        print(f"CPU seconds of a render: {own:.3f} in Python, {command:.3f} by the command: {own / command:.3f}")
        self.assertLess(own, 1.02 * command)


if __name__ == "__main__":
    unittest.main()
