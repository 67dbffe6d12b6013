"""Types of the compiled module; written by write_stub.py from its docstrings."""
from __future__ import annotations

import os
import typing

import numpy
from numpy.typing import ArrayLike, NDArray

__version__: str


class Developed:
    """A film that was read out: arrays of rows, columns and planes for each step from light to numbers; what the film's sensor does not have is None."""

    @property
    def planes(self) -> typing.List[str]:
        """The names of the planes of the arrays."""

    @property
    def exposure(self) -> NDArray[numpy.float32] | None:
        """The film values that were read out."""

    @property
    def electrons(self) -> NDArray[numpy.float32] | None:
        """The electrons that each pixel expects from light."""

    @property
    def codes(self) -> NDArray[numpy.float32] | None:
        """The digital numbers, with all noise."""

    @property
    def saturated(self) -> NDArray[numpy.float32] | None:
        """1 where a pixel saturated, 0 elsewhere."""

    @property
    def calibrated(self) -> NDArray[numpy.float32] | None:
        """What the digital numbers say of the exposure; without a read-out the exposure itself."""

    @property
    def figures(self) -> list:
        """For each plane a dict of its mean, the error of the render, None where it is not known, and the noise of the sensor, in electrons where there is a read-out."""

    def picture(self: Developed) -> NDArray[numpy.float32]:
        """Returns the result as an sRGB display shows it, code values in [0, 1]. Raises UsageError where no display can show what the sensor sees."""

    def write(self: Developed, path: str | os.PathLike[str]) -> None:
        """Writes the codes to a 16-bit .tif or .png, or all planes to an .exr of parts. Raises OutputError."""


class Diagnostic:
    """One complaint about an input: what is wrong, and where it stands."""

    @property
    def file(self) -> typing.Optional[str]:
        """The name of the text complained about, None where there is none."""

    @property
    def pointer(self) -> str:
        """The JSON pointer of the value complained about, such as "/camera/from"."""

    @property
    def message(self) -> str:
        """What is wrong, as a sentence without its place."""

    @property
    def severity(self) -> str:
        """"error" or "warning"."""


class Film:
    """The film of a scene's sensor: values per pixel and channel with their variance, before noise.

    `abbe.render` and `abbe.merge` make films that keep their exact sums, Film.read reads them from files. Jupyter shows a film as its display picture where it has one."""

    @property
    def array(self) -> NDArray[numpy.float32]:
        """The film's values as a read-only array of float32: rows, columns, channels. It is made of the exact sums the first time it is asked for, with the values that a file has; after that nothing is copied."""

    @property
    def variance(self) -> NDArray[numpy.float32] | None:
        """The variance of each of these values, of the same shape; None for an image that does not tell it, and where samples of some pixels are in fewer than two replicates, so that nothing is known of it. It is inf where it is beyond single precision."""

    @property
    def channels(self) -> list[str]:
        """The names of the channels, in the order of `array`."""

    @property
    def wavelengths(self) -> NDArray[numpy.float64] | None:
        """The middles of the bands of a spectral film in nm, in the order of `array`; None for other films. Raises InputError for a spectral image that is in another unit than W/(m^2 sr) or not of bands of radiance."""

    def spectrum(self: Film, x: int, y: int) -> NDArray[numpy.float32]:
        """Returns the radiance in each band at the pixel of column x and row y, in W/(m^2 sr), a view of `array`. Raises UsageError for a film whose sensor is not spectral and for a pixel beyond it, and as `wavelengths` does."""

    @staticmethod
    def read(path: str | os.PathLike[str]) -> Film:
        """Reads a film: an .abbepart with its exact sums, or an .exr. Raises InputError for a file that is missing, damaged or no film."""

    def write(self: Film, path: str | os.PathLike[str]) -> None:
        """Writes the film: to .exr with its variance, to .abbepart with its exact sums, to .png, .jpg or .tif its display picture. The file is the one that `abbe render` writes, and appears whole or not at all. Raises OutputError."""

    @property
    def metadata(self) -> dict[str, str]:
        """What the film's file tells of it, as strings by name."""

    @property
    def stats(self) -> dict[str, typing.Any] | None:
        """What the render did, as a dict; None for a film read from an image. `wall_s`, `cpu_s` and `threads` are None of a film that was merged or read from a part, and its errors unless the render was given `error` or `progress`; `samples_per_pixel` is None where pixels have different samples or none, of which `metadata` then tells the `areas`."""

    @property
    def width(self) -> int:
        """The film's columns of pixels."""

    @property
    def height(self) -> int:
        """The film's rows of pixels."""

    def picture(self: Film) -> NDArray[numpy.float32]:
        """Returns the film as an sRGB display shows it: rows, columns, and R, G, B or grey, code values in [0, 1]. Raises UsageError for a film that no display can show."""


class Progress:
    """How far a render has come."""

    @property
    def share(self) -> float:
        """The share of the work that is done, in [0, 1]; an estimate where time or error decides."""

    @property
    def samples(self) -> int:
        """How many samples of each pixel are finished."""

    @property
    def rate(self) -> float:
        """How many samples of each pixel this run finishes in a second, without its planning; 0 before its first."""

    @property
    def elapsed_s(self) -> float:
        """The time since the render began, in s."""

    @property
    def left_s(self) -> float:
        """An estimate of the time that is left, in s; NaN before there is one."""

    @property
    def error(self) -> float:
        """The median relative error of the lit values so far; infinite while it is not known."""

    @property
    def error_samples(self) -> int:
        """Of how many samples of each pixel `error` is."""


class Scene:
    """A scene, ready to render.

    Scene(path) reads a scene file; Scene(dict) takes what such a file would hold, and files it names are looked for in `folder`, by default the current one, which only a dict may have. Keywords are keys at the top of the scene and replace those of the file or dict. What is wrong is raised as abbe.SceneError or abbe.InputError, whose `diagnostics` tell all of it."""

    def __init__(self: Scene, source: typing.Any = None, *, folder: typing.Any = None, **keywords: typing.Any) -> None:
        """Reads a scene from a path or a dict; keywords replace keys at its top."""

    def to_dict(self: Scene) -> dict[str, typing.Any]:
        """Returns the scene as a dict that makes the same scene, without what is as by default."""

    @property
    def width(self) -> int:
        """The film's columns of pixels."""

    @property
    def height(self) -> int:
        """The film's rows of pixels."""

    @property
    def channels(self) -> list[str]:
        """The names of the film's planes."""

    @property
    def samples(self) -> int:
        """How many samples a pixel gets unless `render` is told otherwise."""

    @property
    def seed(self) -> int:
        """The seed of the random numbers unless `render` is told otherwise."""


def calibrate(camera: str = '', illuminant: str = 'D65', *, chart: str = 'colorchecker24_babelcolor_average', response: str = '', bits: typing.Optional[int] = None, measured: typing.Optional[str | os.PathLike[str]] = None, series: typing.Optional[str | os.PathLike[str]] = None, training: str = '', correction: str = 'matrix', camera_response: str = '') -> dict:
    """Calibrates a camera on a chart under an illuminant, as `abbe calibrate` does: the white-preserving correction with the least mean CIEDE2000 is fitted.

    `camera` is a camera whose curves are known: the chart is photographed at so many `bits`, 12 by default, by a linear camera, or through a planted response ("linear", "gamma:G" or "s-curve") that is recovered without knowing it. Or `measured` is a table of a real camera's values of the chart, and `series` its photographs at known exposure times, by whose curves these are made linear. `training` names reflectances to fit to instead, seen through `camera`, which is given beside `measured` for that alone. `correction` is "matrix", "root-polynomial-2", "root-polynomial-3" or "auto". `camera_response` says what the camera's curves multiply, "energy" or "quantum"; without it those of columns named QE are quantum efficiencies, and all others responses to energy.

    Returns a dict: CIEDE2000 of each patch, its mean and largest, its mean over patches that the fit has not seen, the gains that balance white, of a matrix that from linear camera values to XYZ relative to D65, and of each recovered response its curve, as `recover_response` has it, and the largest error where it was planted, as a share of full scale. Raises InputError for an unknown name and for files that cannot be used, UsageError for arguments that have no effect beside others."""


def camera(name: str, wavelengths_nm: ArrayLike, *, response: str = '') -> dict:
    """Returns the responses of a measured camera at wavelengths as a dict by channel: relative to energy, or electrons per J for a quantum efficiency. `response` says what the camera's curves multiply, "energy" or "quantum"; without it those of columns named QE are quantum efficiencies, and all others responses to energy. Raises as `illuminant` does, and InputError for quantum efficiencies in percent."""


def color(illuminant: typing.Any, reflectance: typing.Any = None, observer: str = '1931', *, range: str = '360-830') -> dict:
    """Returns the colour of a reflectance, or of the perfect diffuser, as a dict of XYZ (Y = 100 for the perfect diffuser), xy and Lab, summed every nanometre from 360 to 830 nm, or with range="380-780" over that range, as other programs do.

    Illuminant and reflectance are names, or pairs of wavelengths in nm and values, taken as linear between them and as 0 beyond. Raises InputError for an unknown name and for a table of reflectances that are no shares of 1, UsageError for a pair with values outside [0, 1], or of an illuminant below 0, or with no wavelengths from 300 to 1100 nm."""


def compare(film: Film, reference: Film, *, white: typing.Any = None) -> dict:
    """Returns how far a film is from a reference, as a dict with the keys of `abbe compare --json`: relative and absolute errors, the ratio of means, and CIEDE2000 over the pixels, None where colours are not known; of films with crops or gaps, `crop` or `areas` are the pixels that both have. Warns where one film alone tells its unit, and of channels that one film alone has, which are not compared. Raises InputError for films of different size or unit."""


def curve(kind: str, name: str, wavelengths_nm: ArrayLike) -> typing.Any:
    """Returns a measured curve of one of the kinds of `names` but material and glass, such as a reflectance, at wavelengths. Raises as `illuminant` does."""


def delta_e(lab1: ArrayLike, lab2: ArrayLike, formula: str = '2000') -> typing.Any:
    """Returns the CIE colour differences of arrays whose last axis is L*, a*, b*, by the formula of 2000, 94 or 76, by cam16 (CAM16-UCS) or itp (BT.2124), both beside D65; the first is the standard. Of numbers that are not finite it is NaN."""


def develop(film: Film, *, readout: typing.Any = None, white: typing.Any = None, seed: typing.Optional[int] = None, scene: Scene | None = None) -> Developed:
    """Reads a film out without rendering: noise, digital numbers, and what these say.

    `readout` replaces the sensor's, as a dict with the keys of `help("sensor/readout")`; `white` is what pictures show as white, as `output/white` of a scene; `seed` is that of the noise of a read-out, by default the render's. At a spectral film the sensor of `scene` may look."""


def extinction(name: str, wavelengths_nm: ArrayLike) -> typing.Any:
    """Returns the extinction coefficient k of a material, the imaginary part of its index n + ik, as catalogued; NaN where it is not measured. Raises as `ior` does."""


def help(key: str = '') -> str:
    """Returns what a key of scenes means, its range and its default, as `abbe help scene KEY` prints it."""


def illuminant(name: str, wavelengths_nm: ArrayLike) -> typing.Any:
    """Returns the relative power of an illuminant at wavelengths, in the unit of its table. "blackbody:3000" and "daylight:6500" are made of their temperature in K. Raises InputError for an unknown name, or where a table says nothing of one of them, and UsageError for a wavelength outside [300, 1100] nm."""


def ior(name: str, wavelengths_nm: ArrayLike) -> typing.Any:
    """Returns the real refractive index n of a material at wavelengths in standard air, as catalogued: relative to air or vacuum, as `material(name)` tells.

    Names are those of `names("material")` and `names("glass")`, or files. Raises InputError for an unknown name and UsageError for a wavelength without data or outside [300, 1100] nm."""


def material(name: str) -> dict:
    """Returns a dict of what is known of a material: its full name, the source of its data, the medium its index is relative to, and the wavelengths between which n (`low_nm`, `high_nm`) and k (`k_low_nm`, `k_high_nm`, None where no k is measured) hold."""


def measure(scene: Scene, film: Film, reference: Film | None = None) -> list:
    """Reads the first chart of a scene out of a film of it: a dict for each patch, with its L*a*b*, that of the chart's own spectra (or of a reference film), and CIEDE2000 between them. Raises InputError for a scene without a chart."""


def merge(films: typing.Sequence[typing.Any], *, partial: bool = False) -> Film:
    """Adds up films of one render, or the .abbepart files of paths, to the film that one render of all their samples gives, bit for bit. Raises InputError for films of different renders, for samples that two of them have, and, unless `partial`, where samples are missing of those the render is to have."""


def meter(scene: typing.Any, *, only: typing.Any = None, spp: typing.Optional[int] = None, seed: typing.Optional[int] = None, threads: int = 0, error: typing.Optional[float] = None, time: typing.Optional[float] = None, integrator: typing.Any = None, progress: typing.Any = None) -> dict:
    """Reads the meters of a scene, a path, a dict or a Scene, of the numbers that `abbe meter` gives; a path or dict needs no camera.

    Returns a dict of dicts by the meters' names, in the scene's order, with the keys of `abbe meter --json` but `wall_s`, and `columns` and `rows` of cells: `radiant`, `luminous` and `photons` have `value`, `unit`, `standard_error` and `half_interval_95`, half the width of Student's interval of 95 %, None where nothing is known; `cells` are arrays of rows and columns of a meter that has some, `spectrum` arrays over `wavelength_nm`, nan where an error is not known. `only` names a meter, or several. `spp`, `seed` and `integrator` replace what the scene says; `threads`, `time` and `progress` are those of `render`, for each meter, and `error` ends at the largest relative standard error of its three figures. Raises UsageError for a name that no meter has and for a list of none, SceneError for a scene without meters."""


def names(kind: str) -> typing.List[str]:
    """Returns the names that Abbe knows of a kind: material, glass, illuminant, reflectance, camera, filter or observer. Raises UsageError for another kind."""


def observer(name: str = '1931', *, wavelengths_nm: ArrayLike) -> dict:
    """Returns the colour-matching functions of the CIE standard observer of 1931 or 1964 at wavelengths, as a dict of x, y, z. Raises as `illuminant` does."""


def prism_deviation(name: str, wavelengths_nm: ArrayLike, apex_deg: float = 60.0, incidence_deg: typing.Optional[float] = None) -> typing.Any:
    """Returns by how many degrees a prism in air deviates light: the least deviation, or that at one angle of incidence; NaN where the light is totally reflected or the matter lets none through (k above 1e-3). Raises as `ior` does."""


def recover_response(series: str | os.PathLike[str]) -> dict:
    """Recovers the response of a real camera's channels from photographs at known exposure times, as `abbe calibrate --series` does.

    Returns a dict by channel of arrays with four columns: code, as a share of the largest; exposure, 1 at full scale; and the bounds of its 95 % interval. Raises InputError for files that cannot be read, and for a series that determines no curve."""


def reflectance(name: str, wavelengths_nm: ArrayLike, angle_deg: ArrayLike = 0.0, coating: typing.List[typing.Tuple[str, float]] = []) -> tuple:
    """Returns (Rs, Rp), the reflectance of a smooth surface for light from air, polarised across and in the plane of incidence, by Fresnel's formulas.

    Wavelengths and angles of incidence are broadcast against one another. `coating` lists films (material, thickness in nm) from outside inwards. Raises as `ior` does, and UsageError too where k is not measured and the reflectance hangs on it."""


def render(scene: Scene, *, spp: typing.Optional[int] = None, seed: typing.Optional[int] = None, threads: int = 0, error: typing.Optional[float] = None, time: typing.Optional[float] = None, progress: typing.Any = None, sample_range: typing.Optional[typing.Union[typing.Tuple[int, int], range]] = None) -> Film:
    """Renders a scene and returns its film, of the bits that `abbe render` gives, whatever the threads.

    `spp` and `seed` replace what the scene says; `threads` is one per processor unless given. `error` ends the render at that median relative error (0.01 for a percent), `time` after so many seconds, both at the end of a pass; neither goes with `spp` or `sample_range`. `progress` is called after passes with a Progress, on the calling thread. `sample_range` (first, last), or range(first, last), renders these samples only, for `merge`. Other threads of Python run meanwhile. Ctrl-C, and what `progress` raises, end the render after the pass that runs and are raised here."""
