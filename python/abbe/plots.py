"""What matplotlib shows of films, where it is installed."""
import numpy as _numpy


def _band_widths(middles):
    """The widths of bands, whose edges lie halfway between their middles, the outermost as far out as in."""
    edges = (middles[1:] + middles[:-1]) / 2
    return _numpy.diff([2 * middles[0] - edges[0], *edges, 2 * middles[-1] - edges[-1]])


def plot_spectrum(film, *pixels, axes=None):
    """Draws the radiance of a spectral film over wavelength at pixels (x, y), and returns the axes it drew on.

    Radiance is per nm of each band, whose edges lie halfway between the middles of neighbours. Raises UsageError for a film whose sensor
    is not spectral, and InputError where `film.wavelengths` does.
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
