#!/usr/bin/env python3
"""Prints a type stub of the module `abbe._abbe`, from the signatures at the start of its docstrings. The target `stub` runs it."""
import inspect
import re

import abbe._abbe as module

HEAD = '''"""Types of the compiled module; written by write_stub.py from its docstrings."""
from __future__ import annotations

import os
import typing

import numpy
from numpy.typing import ArrayLike, NDArray
'''
# Names of types in pybind11, and in type checkers.
TYPES = ((r"abbe\._abbe\.", ""), (r"numpy\.ndarray\[numpy\.float64\]", "ArrayLike"), (r"os\.PathLike", "str | os.PathLike[str]"), (r"\bobject\b", "typing.Any"),
         (r"\bhandle\b", "typing.Any"), (r"\bSequence\b", "typing.Sequence[typing.Any]"), (r"\b(List|Dict|Tuple|Optional|Union)\[", r"typing.\1["),
         (r"\bsequence\b", "typing.Sequence[typing.Any]"), (r": (Scene|Film) = None", r": \1 | None = None"), (r"\*\*kwargs", "**keywords: typing.Any"))
# Return types of functions for which pybind11 declares only `object`.
RESULTS = {"array": "NDArray[numpy.float32]", "variance": "NDArray[numpy.float32] | None", "wavelengths": "NDArray[numpy.float64] | None",
           **{name: "NDArray[numpy.float32] | None" for name in ("exposure", "electrons", "codes", "saturated", "calibrated")},
           "to_dict": "dict[str, typing.Any]", "spectrum": "NDArray[numpy.float32]", "picture": "NDArray[numpy.float32]", "stats": "dict[str, typing.Any] | None",
           "channels": "list[str]", "metadata": "dict[str, str]"}


def translated(signature):
    for pattern, name in TYPES:
        signature = re.sub(pattern, name, signature)
    return signature


def split(text):
    """The signature and the text of a docstring."""
    signature, _, words = text.partition("\n\n")
    return signature.strip(), words.strip()


def docstring(words, indent):
    lines = words.replace("\\", "\\\\").splitlines()
    return "".join(f"{indent}{line}".rstrip() + "\n" for line in [f'"""{lines[0]}', *lines[1:]])[:-1] + '"""\n'


def function(name, text, indent=""):
    signature, words = split(text)
    signature = translated(signature)
    if name in RESULTS:
        signature = re.sub(r"->.*", f"-> {RESULTS[name]}", signature)
    return f"{indent}def {signature}:\n" + (docstring(words, indent + "    ") if words else f"{indent}    ...\n")


def property_of(name, member, indent):
    signature, words = split(member.fget.__doc__ or "")
    result = RESULTS.get(name) or translated(re.sub(r".*->\s*", "", signature)) or "typing.Any"
    return f"{indent}@property\n{indent}def {name}(self) -> {result}:\n" + docstring(member.__doc__.strip() or words, indent + "    ")


def members(kind):
    for name, member in vars(kind).items():
        if isinstance(member, property):
            yield property_of(name, member, "    ")
        elif (getattr(kind, name).__doc__ or "").startswith(f"{name}(") and (name == "__init__" or not name.startswith("_")):
            static = "    @staticmethod\n" if isinstance(member, staticmethod) else ""
            yield static + function(name, getattr(kind, name).__doc__, "    ")


def main():
    print(HEAD)
    print("__version__: str")
    for name, thing in sorted(vars(module).items()):
        if inspect.isclass(thing):
            text = thing.__doc__.split("\n\nKeywords:")[0]
            print(f"\n\nclass {name}:\n" + docstring(text, "    ") + "\n" + "\n".join(members(thing)), end="")
        elif callable(thing) and not name.startswith("_"):
            print("\n\n" + function(name, thing.__doc__), end="")


if __name__ == "__main__":
    main()
