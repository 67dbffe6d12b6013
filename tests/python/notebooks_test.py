"""The notebooks of docs/notebooks have no outputs, and every cell runs; without ABBE_NIGHTLY only one notebook is run."""
import os
import pathlib
import unittest
import warnings

warnings.simplefilter("default")  # ignores those of nbconvert itself
os.environ["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"  # avoids a message of the kernel
os.environ["MPLBACKEND"] = "agg"
try:
    import nbformat
    from nbconvert.preprocessors import ExecutePreprocessor
except ImportError:
    raise unittest.SkipTest("nbconvert is not installed")

NIGHTLY = "ABBE_NIGHTLY" in os.environ
BY_DAY = "dispersion_fit.ipynb"
FOLDER = pathlib.Path(__file__).resolve().parent.parent.parent / "docs" / "notebooks"


class Notebooks(unittest.TestCase):
    def test_every_notebook_runs(self):
        paths = sorted(FOLDER.glob("*.ipynb"))
        self.assertGreaterEqual(len(paths), 6)
        for path in paths:
            with self.subTest(path.name):
                notebook = nbformat.read(path, as_version=4)
                for cell in notebook.cells:
                    self.assertFalse(cell.get("outputs"), "stored outputs")
                if NIGHTLY or path.name == BY_DAY:
                    ExecutePreprocessor(timeout=200, kernel_name="python3").preprocess(notebook, {"metadata": {"path": FOLDER}})


if __name__ == "__main__":
    unittest.main()
