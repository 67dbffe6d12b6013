"""Plots of films by matplotlib, if it is installed."""
import numpy as _numpy


def _band_widths(centers):
    """Widths of bands with edges halfway between their centers. The outermost bands are symmetric about their centers."""
    edges = (centers[1:] + centers[:-1]) / 2
    return _numpy.diff([2 * centers[0] - edges[0], *edges, 2 * centers[-1] - edges[-1]])


def plot_spectrum(film, *pixels, axes=None):
    """Plots the radiance of a spectral film over wavelength at pixels (x, y), and returns the axes.

    `axes` are those of matplotlib, by default the current ones. Radiance is per nm of each band, with edges halfway between the centers of adjacent bands. Raises UsageError for a film whose sensor
    is not spectral, and InputError as `film.wavelengths` does.
    """
    import matplotlib.pyplot

    axes = axes or matplotlib.pyplot.gca()
    for x, y in pixels:
        spectrum = film.spectrum(x, y)
        axes.plot(film.wavelengths, spectrum / _band_widths(film.wavelengths), label=f"({x}, {y})")
    axes.set_xlabel("wavelength [nm]")
    axes.set_ylabel("radiance [W m$^{-2}$ sr$^{-1}$ nm$^{-1}$]")
    axes.legend()
    return axes
