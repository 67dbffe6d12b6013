"""Common parts of the package's tests: scenes, the command, a scratch folder."""
import os
import pathlib
import subprocess
import tempfile
import unittest

DATA = pathlib.Path(os.environ["ABBE_DATA"])
SCENES = DATA / "scenes"
CORNELL = SCENES / "cornell.json"
NIGHTLY = "ABBE_NIGHTLY" in os.environ  # run longer tests too


def cornell_sensor(edge):
    """The Cornell box's sensor with another number of pixels per side and the same field of view."""
    return {"resolution": [edge, edge], "pixel_pitch_um": 97.65625 * 256 / edge, "observer": "1931"}


def box(**keys):
    """A grey floor under a uniform sky, with a sensor of two channels and 8 x 6 pixels."""
    scene = {
        "camera": {"pinhole": {"fov_deg": 40}, "from": [0, -5, 2], "to": [0, 0, 0], "up": [0, 0, 1]},
        "sensor": {"resolution": [8, 6], "pixel_pitch_um": 10,
                   "channels": {"long": {"band": [600, 700]}, "short": {"band": [400, 500]}}},
        "materials": {"grey": {"diffuse": {"reflectance": 0.5}}},
        "shapes": [{"quad": {"corner": [-9, -9, 0], "edge_u": [18, 0, 0], "edge_v": [0, 18, 0]}, "material": "grey"}],
        "lights": [{"environment": {}, "emission": {"spectrum": 1}}],
        "render": {"samples": 4},
    }
    return {**scene, **keys}


class Test(unittest.TestCase):
    """A test with its own folder."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.scratch = pathlib.Path(folder.name)

    def command(self, *arguments):
        """Standard output of the command."""
        return self.run_command(*arguments, check=True).stdout

    def refused(self, *arguments):
        """The command's error for invalid arguments."""
        ended = self.run_command(*arguments)
        self.assertEqual(ended.returncode, 2, ended)
        return ended.stderr

    def run_command(self, *arguments, check=False):
        return subprocess.run([os.environ["ABBE_BINARY"], *map(str, arguments)], check=check, capture_output=True, text=True, cwd=self.scratch)
