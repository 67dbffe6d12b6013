"""Abbe, a spectral renderer validated against measured colour science: scenes, renders, films, and what their matter does, as arrays."""
import os as _os
import pathlib as _pathlib

from . import _abbe
from ._abbe import *  # noqa: F401,F403
from ._abbe import __version__  # noqa: F401
from .errors import *  # noqa: F401,F403
from .plots import plot_spectrum  # noqa: F401


def _data_directory():
    """The tables: inside the package, as pip puts them, else `share/abbe/data` of the prefix or build folder that the package is in."""
    here = _pathlib.Path(__file__).parent
    for place in (here / "data", *(folder / "share" / "abbe" / "data" for folder in here.parents)):
        if place.is_dir():
            return place
    return None


if "ABBE_DATA" not in _os.environ and _data_directory():
    _abbe._set_data_directory(_data_directory())
