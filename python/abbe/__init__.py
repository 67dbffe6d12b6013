"""Abbe, a spectral renderer validated against measured colour science: scenes, renders, films and data of materials, as arrays."""
import os as _os
import pathlib as _pathlib

from . import _abbe
from ._abbe import *  # noqa: F401,F403
from ._abbe import __version__  # noqa: F401
from .errors import *  # noqa: F401,F403
from .plots import plot_spectrum  # noqa: F401


def _data_directory():
    """The folder of the tables: inside the package if pip installed it, otherwise `share/abbe/data` of the prefix or build folder."""
    here = _pathlib.Path(__file__).parent
    for candidate in (here / "data", *(folder / "share" / "abbe" / "data" for folder in here.parents)):
        if candidate.is_dir():
            return candidate
    return None


if "ABBE_DATA" not in _os.environ and _data_directory():
    _abbe._set_data_directory(_data_directory())
