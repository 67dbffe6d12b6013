"""The interface of the package: its types equal those of the stub, and everything has a docstring."""
import ast
import inspect
import pathlib
import subprocess
import sys
import unittest

import abbe

PACKAGE = pathlib.Path(abbe.__file__).resolve().parent


class Interface(unittest.TestCase):
    def test_the_stub_is_that_of_the_module(self):
        written = subprocess.run([sys.executable, "-B", PACKAGE.parent / "stub" / "write_stub.py"], check=True, capture_output=True, text=True).stdout
        self.assertEqual((PACKAGE / "_abbe.pyi").read_text(), written, "the target `stub` writes it anew")
        offered = {name for name in vars(abbe._abbe) if not name.startswith("_")}
        typed = {node.name for node in ast.parse(written).body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        self.assertEqual(offered, typed)
        self.assertTrue((PACKAGE / "py.typed").exists())

    def test_all_of_it_has_whole_sentences(self):
        for name, thing in vars(abbe).items():
            if name.startswith("_") or inspect.ismodule(thing):
                continue
            members = [thing, *(m for n, m in vars(thing).items() if not n.startswith("_"))] if inspect.isclass(thing) else [thing]
            for member in members:
                words = inspect.getdoc(member) or ""
                self.assertRegex(words.strip(), r"[.)\]]$", f"{name}: {member}")


if __name__ == "__main__":
    unittest.main()
