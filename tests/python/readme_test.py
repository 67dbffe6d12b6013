"""The example of the README runs as printed."""
import contextlib
import io
import os
import pathlib
import re
import unittest
import warnings

from common import NIGHTLY, Test

SOURCE = pathlib.Path(__file__).resolve().parent.parent.parent


class Readme(Test):
    def test_its_example_runs(self):
        example, = re.findall(r"^```python\n(.*?)^```", (SOURCE / "README.md").read_text(), re.M | re.S)
        if not NIGHTLY:
            self.assertIn("spp=8", example)
            example = example.replace("spp=8", "spp=2")
        (self.scratch / "data").symlink_to(SOURCE / "data")
        os.chdir(self.scratch)
        said = io.StringIO()
        with contextlib.redirect_stdout(said), warnings.catch_warnings():
            warnings.simplefilter("ignore")  # a caustic cannot be sampled
            exec(compile(example, "README.md", "exec"), {})
        self.assertRegex(said.getvalue(), r"100% after \d+\.\d s\n\['R', 'G', 'B'\] \(360, 640, 3\)")
        self.assertRegex(said.getvalue(), r"\[1\.8065\d* 1\.7847\d* 1\.7759\d*\]")
        self.assertTrue((self.scratch / "prism.exr").exists())


if __name__ == "__main__":
    unittest.main()
