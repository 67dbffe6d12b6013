"""What matplotlib shows of films, where it is installed."""


def plot_spectrum(film, *pixels, axes=None):
    """Draws the radiance of a spectral film over wavelength at pixels (x, y), and returns the axes it drew on.

    Radiance is per nm of the bands' distance. Raises UsageError for a film whose sensor is not spectral.
    """
    import matplotlib.pyplot

    axes = axes or matplotlib.pyplot.gca()
    for x, y in pixels:
        spectrum = film.spectrum(x, y)
        width = (film.wavelengths[-1] - film.wavelengths[0]) / (len(film.wavelengths) - 1)
        axes.plot(film.wavelengths, spectrum / width, label=f"({x}, {y})")
    axes.set_xlabel("wavelength [nm]")
    axes.set_ylabel("radiance [W m$^{-2}$ sr$^{-1}$ nm$^{-1}$]")
    axes.legend()
    return axes
