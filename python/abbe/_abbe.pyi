"""Types of the compiled module; written by write_stub.py from its docstrings."""
from __future__ import annotations

import os
import typing

import numpy
from numpy.typing import ArrayLike, NDArray

__version__: str


class Developed:
    """A film after readout: an array of rows, columns and planes for each step from light to digital numbers. Steps that the film's sensor lacks are None."""

    @property
    def planes(self) -> typing.List[str]:
        """The names of the planes of the arrays."""

    @property
    def exposure(self) -> NDArray[numpy.float32] | None:
        """The film values before readout."""

    @property
    def electrons(self) -> NDArray[numpy.float32] | None:
        """The expected number of photoelectrons of each pixel."""

    @property
    def codes(self) -> NDArray[numpy.float32] | None:
        """The digital numbers, with all noise."""

    @property
    def saturated(self) -> NDArray[numpy.float32] | None:
        """1 where a pixel saturated, 0 elsewhere."""

    @property
    def calibrated(self) -> NDArray[numpy.float32] | None:
        """The exposure estimated from the digital numbers; without a readout the exposure itself."""

    @property
    def figures(self) -> list:
        """A list of dicts, one for each plane: its mean, the error of the render (None if unknown), and the noise of the sensor, in electrons if there is a readout."""

    def picture(self: Developed) -> NDArray[numpy.float32]:
        """Returns the picture on an sRGB display, as code values in [0, 1]. Raises UsageError if no display can show the sensor's channels."""

    def write(self: Developed, path: str | os.PathLike[str]) -> None:
        """Writes the digital numbers to a 16-bit .tif or .png, or all planes to an .exr with parts. Raises OutputError."""


class Diagnostic:
    """An error or warning about an input: the message, and the location in the input."""

    @property
    def file(self) -> typing.Optional[str]:
        """The name of the input, or None if there is none."""

    @property
    def pointer(self) -> str:
        """The JSON pointer of the value concerned, such as "/camera/from"."""

    @property
    def message(self) -> str:
        """The message, without its location."""

    @property
    def severity(self) -> str:
        """"error" or "warning"."""


class Film:
    """The film of a scene's sensor: values per pixel and channel with their variance, before sensor noise.

    `abbe.render` and `abbe.merge` return films with their exact sums, and Film.read reads them from files. Jupyter displays a film as a picture if it has one."""

    @property
    def array(self) -> NDArray[numpy.float32]:
        """The film's values as a read-only float32 array of rows, columns and channels, equal to those in a file. The first access computes it from the exact sums; later ones return the same array without a copy."""

    @property
    def variance(self) -> NDArray[numpy.float32] | None:
        """The variance of each value, in the same shape; inf if it exceeds single precision. None if the image does not record it, or if it is unknown because some pixels have samples in fewer than two replicates."""

    @property
    def channels(self) -> list[str]:
        """The names of the channels, in the order of `array`."""

    @property
    def wavelengths(self) -> NDArray[numpy.float64] | None:
        """The centers of the bands of a spectral film in nm, in the order of `array`; None for other films. Raises InputError for a spectral image in another unit than W/(m^2 sr), or without bands of radiance."""

    def spectrum(self: Film, x: int, y: int) -> NDArray[numpy.float32]:
        """Returns the radiance in each band at the pixel in column x and row y, in W/(m^2 sr), as a view of `array`. Raises UsageError for a film whose sensor is not spectral and for a pixel outside the film, and InputError as `wavelengths` does."""

    @staticmethod
    def read(path: str | os.PathLike[str]) -> Film:
        """Reads a film from an .abbepart, with its exact sums, or from an .exr. Raises InputError for a file that is missing, damaged or not a film."""

    def write(self: Film, path: str | os.PathLike[str]) -> None:
        """Writes the film to .exr with its variance, to .abbepart with its exact sums, or its display picture to .png, .jpg or .tif. The file equals that of `abbe render` and never appears half-written. Raises OutputError."""

    @property
    def metadata(self) -> dict[str, str]:
        """The attributes of the film's file, as strings by name."""

    @property
    def stats(self) -> dict[str, typing.Any] | None:
        """Statistics of the render as a dict; None for a film that was read from an image. `wall_s`, `cpu_s` and `threads` are None for a film that was merged or read from a part. The errors are None in that case, and unless the render was given `error` or `progress`. `samples_per_pixel` is None if pixels differ in their samples; `metadata` then has the `areas`."""

    @property
    def width(self) -> int:
        """The film's columns of pixels."""

    @property
    def height(self) -> int:
        """The film's rows of pixels."""

    def picture(self: Film) -> NDArray[numpy.float32]:
        """Returns the picture of the film on an sRGB display: rows, columns, and R, G, B or grey, as code values in [0, 1]. Raises UsageError for a film that no display can show."""


class Progress:
    """The progress of a render."""

    @property
    def share(self) -> float:
        """The fraction of the work that is done, in [0, 1]; an estimate if a time or error limit ends the render."""

    @property
    def samples(self) -> int:
        """The number of finished samples per pixel."""

    @property
    def rate(self) -> float:
        """The samples per pixel that this run finishes per second, without its planning; 0 before the first one."""

    @property
    def elapsed_s(self) -> float:
        """The time since the render began, in s."""

    @property
    def left_s(self) -> float:
        """The estimated remaining time, in s; NaN before there is an estimate."""

    @property
    def error(self) -> float:
        """The median relative error of the illuminated values so far; infinite while it is unknown."""

    @property
    def error_samples(self) -> int:
        """The number of samples per pixel from which `error` was estimated."""


class Scene:
    """A scene, ready to render.

    Scene(path) reads a scene file. Scene(dict) takes the content of such a file; files that it names are relative to `folder`, by default the current one, which only a dict may have. Keywords are keys at the top level of the scene and replace those of the file or dict. Invalid input raises abbe.SceneError or abbe.InputError, whose `diagnostics` list all errors."""

    def __init__(self: Scene, source: typing.Any = None, *, folder: typing.Any = None, **keywords: typing.Any) -> None:
        """Reads a scene from a path or a dict. Keywords replace keys at the top level."""

    def to_dict(self: Scene) -> dict[str, typing.Any]:
        """Returns the scene as a dict that describes the same scene, without values that equal their defaults."""

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
        """The samples per pixel, unless the arguments of `render` replace them."""

    @property
    def seed(self) -> int:
        """The seed of the random numbers, unless the arguments of `render` replace it."""


def calibrate(camera: str = '', illuminant: str = 'D65', *, chart: str = 'colorchecker24_babelcolor_average', response: str = '', bits: typing.Optional[int] = None, measured: typing.Optional[str | os.PathLike[str]] = None, series: typing.Optional[str | os.PathLike[str]] = None, training: str = '', correction: str = 'matrix', camera_response: str = '') -> dict:
    """Calibrates a camera on a chart under an illuminant, as `abbe calibrate` does. It fits the white-preserving correction with the least mean CIEDE2000.

    `camera` is a camera with known curves. It photographs the chart with `bits` bits, 12 by default, linearly or through a planted response ("linear", "gamma:G" or "s-curve"), which is then recovered without knowledge of it. Instead, `measured` is a table of a real camera's values of the chart. `series` are photographs of the same camera at known exposure times; the response recovered from them linearises the values. `training` names reflectances that replace the chart in the fit. Their camera values follow from the curves of `camera`, which is given with `measured` only for this purpose. `correction` is "matrix", "root-polynomial-2", "root-polynomial-3" or "auto". `camera_response` states the quantity that the camera's curves multiply, "energy" or "quantum". Without it, columns named QE are quantum efficiencies, and all others are responses to energy.

    Returns a dict: CIEDE2000 of each patch, its mean and maximum, and its mean over patches left out of the fit; the gains that balance white; for a matrix also the matrix from linear camera values to XYZ relative to D65; for each recovered response its curve, as from `recover_response`, and, if it was planted, its maximum error as a fraction of full scale. Raises InputError for an unknown name and for unusable files, and UsageError for arguments that other arguments make ineffective."""


def camera(name: str, wavelengths_nm: ArrayLike, *, response: str = '') -> dict:
    """Returns the responses of a measured camera at wavelengths as a dict by channel: relative to energy, or electrons per J for a quantum efficiency. `response` states the quantity that the camera's curves multiply, "energy" or "quantum". Without it, columns named QE are quantum efficiencies, and all others are responses to energy. Raises as `illuminant` does, and InputError for quantum efficiencies in percent."""


def color(illuminant: typing.Any, reflectance: typing.Any = None, observer: str = '1931', *, range: str = '360-830') -> dict:
    """Returns the colour of a reflectance, or of the perfect diffuser, as a dict of XYZ (Y = 100 for the perfect diffuser), xy and Lab. The sums run over every nanometre from 360 to 830 nm, or, with range="380-780", over that range, as in other programs.

    Illuminant and reflectance are names, or pairs of wavelengths in nm and values, linear between them and 0 outside. Raises InputError for an unknown name and for a table of reflectances outside [0, 1]. Raises UsageError for a pair with reflectances outside [0, 1], with a negative illuminant, or without wavelengths from 300 to 1100 nm."""


def compare(film: Film, reference: Film, *, white: typing.Any = None) -> dict:
    """Compares a film with a reference. Returns a dict with the keys of `abbe compare --json`: relative and absolute errors, the ratio of means, and CIEDE2000 over the pixels, which is None if colours are unknown. For films with crops or gaps, `crop` or `areas` are the pixels that both have. Warns if only one film declares its unit, and of channels that only one film has, which are not compared. Raises InputError for films of different size or unit."""


def curve(kind: str, name: str, wavelengths_nm: ArrayLike) -> typing.Any:
    """Returns a measured curve, such as a reflectance, at wavelengths. The kinds are those of `names` except material and glass. Raises as `illuminant` does."""


def delta_e(lab1: ArrayLike, lab2: ArrayLike, formula: str = '2000') -> typing.Any:
    """Returns the CIE colour differences between arrays whose last axis is L*, a*, b*; the first array is the standard. The formula is that of 2000, 94 or 76, or cam16 (CAM16-UCS) or itp (BT.2124), which both assume D65. Values that are not finite give NaN."""


def develop(film: Film, *, readout: typing.Any = None, white: typing.Any = None, seed: typing.Optional[int] = None, scene: Scene | None = None) -> Developed:
    """Reads a film out without rendering: adds noise, converts to digital numbers, and estimates the exposure from these.

    `readout` replaces the readout of the sensor, as a dict with the keys of `help("sensor/readout")`. `white` is the white of pictures, as `output/white` of a scene. `seed` is that of the readout noise, by default that of the render. The sensor of `scene` can view a spectral film."""


def extinction(name: str, wavelengths_nm: ArrayLike) -> typing.Any:
    """Returns the extinction coefficient k of a material, the imaginary part of its index n + ik, as catalogued; NaN where it is not measured. Raises as `ior` does."""


def help(key: str = '') -> str:
    """Returns the meaning, range and default of a key of scenes, as `abbe help scene KEY` prints them."""


def illuminant(name: str, wavelengths_nm: ArrayLike) -> typing.Any:
    """Returns the relative power of an illuminant at wavelengths, in the unit of its table. "blackbody:3000" and "daylight:6500" are computed for that temperature in K. Raises InputError for an unknown name and for a wavelength outside the table, and UsageError for a wavelength outside [300, 1100] nm."""


def ior(name: str, wavelengths_nm: ArrayLike) -> typing.Any:
    """Returns the real refractive index n of a material at wavelengths in standard air, as catalogued. It is relative to air or vacuum; `material(name)` returns which.

    Names are those of `names("material")` and `names("glass")`, or files. Raises InputError for an unknown name, and UsageError for a wavelength without data or outside [300, 1100] nm."""


def material(name: str) -> dict:
    """Returns a dict that describes the data of a material: its full name, their source, the medium that the index is relative to, and the wavelength ranges of n (`low_nm`, `high_nm`) and k (`k_low_nm`, `k_high_nm`, None without measured k)."""


def measure(scene: Scene, film: Film, reference: Film | None = None) -> list:
    """Measures the first chart of a scene in a film of that scene. Returns a list of dicts, one for each patch: its L*a*b*, that of the chart's own spectra (or of a reference film), and CIEDE2000 between them. Raises InputError for a scene without a chart."""


def merge(films: typing.Sequence[typing.Any], *, partial: bool = False) -> Film:
    """Merges films of one render, or the .abbepart files at paths, to the film that a single render of all their samples would give, bit for bit. Raises InputError for films of different renders, for samples that two films share, and, unless `partial`, for missing samples."""


def meter(scene: typing.Any, *, only: typing.Any = None, spp: typing.Optional[int] = None, seed: typing.Optional[int] = None, threads: int = 0, error: typing.Optional[float] = None, time: typing.Optional[float] = None, integrator: typing.Any = None, progress: typing.Any = None) -> dict:
    """Measures the meters of a scene, given as a path, a dict or a Scene, with the results of `abbe meter`. A path or dict needs no camera.

    Returns a dict of dicts by the meters' names, in the scene's order, with the keys of `abbe meter --json` except `wall_s` and the `columns` and `rows` of cells. `radiant`, `luminous` and `photons` have `value`, `unit`, `standard_error` and `half_interval_95`, half the width of Student's 95 % interval, or None if that is unknown. `cells` are arrays of rows and columns if the meter has cells. `spectrum` has arrays over `wavelength_nm`, with nan for unknown errors. `only` names a meter, or several. `spp`, `seed` and `integrator` replace those of the scene. `threads`, `time` and `progress` are those of `render`, for each meter. `error` ends a render at that largest relative standard error of the three figures. Raises UsageError for a name that no meter has and for an empty list, and SceneError for a scene without meters."""


def names(kind: str) -> typing.List[str]:
    """Returns the names of all tables of a kind: material, glass, illuminant, reflectance, camera, filter or observer. Raises UsageError for another kind."""


def observer(name: str = '1931', *, wavelengths_nm: ArrayLike) -> dict:
    """Returns the colour-matching functions of the CIE standard observer of 1931 or 1964 at wavelengths, as a dict of x, y, z. Raises as `illuminant` does."""


def prism_deviation(name: str, wavelengths_nm: ArrayLike, apex_deg: float = 60.0, incidence_deg: typing.Optional[float] = None) -> typing.Any:
    """Returns the deviation of light by a prism in air in degrees: the minimum deviation, or that at one angle of incidence. NaN if the light is totally reflected or the material is opaque (k above 1e-3). Raises as `ior` does."""


def recover_response(series: str | os.PathLike[str]) -> dict:
    """Recovers the response of a real camera's channels from photographs at known exposure times, as `abbe calibrate --series` does.

    Returns a dict of arrays by channel with four columns: the code as a fraction of the largest, the exposure (1 at full scale), and the bounds of its 95 % interval. Raises InputError for files that cannot be read, and for a series that determines no curve."""


def reflectance(name: str, wavelengths_nm: ArrayLike, angle_deg: ArrayLike = 0.0, coating: typing.List[typing.Tuple[str, float]] = []) -> tuple:
    """Returns (Rs, Rp), the reflectance of a smooth surface in air for s and p polarisation, by Fresnel's formulas.

    Wavelengths and angles of incidence are broadcast against one another. `coating` lists thin films (material, thickness in nm) from outside inwards. Raises as `ior` does, and UsageError if the reflectance depends on a k that is not measured."""


def render(scene: Scene, *, spp: typing.Optional[int] = None, seed: typing.Optional[int] = None, threads: int = 0, error: typing.Optional[float] = None, time: typing.Optional[float] = None, progress: typing.Any = None, sample_range: typing.Optional[typing.Union[typing.Tuple[int, int], range]] = None) -> Film:
    """Renders a scene and returns its film, with the same bits as `abbe render` for any number of threads.

    `spp` and `seed` replace those of the scene; `threads` is one per processor by default. `error` ends the render at that median relative error (0.01 for one percent), `time` after so many seconds, both at the end of a pass; both exclude `spp` and `sample_range`. `progress` is called after passes with a Progress, on the calling thread. `sample_range` (first, last), or range(first, last), renders only these samples, for `merge`. Other Python threads run meanwhile. Ctrl-C, and exceptions from `progress`, end the render after the current pass and are raised here."""
