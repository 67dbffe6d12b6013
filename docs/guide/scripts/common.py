"""What the scripts of the guide share."""
import pathlib
import shlex
import subprocess

import numpy as np
import OpenImageIO as oiio


def run(command):
    """Runs a command as a shell would; gives what it prints and fails where it fails."""
    return subprocess.run(shlex.split(command), check=True, stdout=subprocess.PIPE, text=True).stdout


def planes(path):
    """The planes of a film by their names, as arrays of rows and columns."""
    image = oiio.ImageInput.open(path)
    pixels = image.read_image(oiio.FLOAT)
    names = image.spec().channelnames
    image.close()
    return {name: pixels[..., i] for i, name in enumerate(names)}


def table(path):
    """The columns of a table by their names."""
    names, *rows = (line.split(",") for line in pathlib.Path(path).read_text().splitlines() if not line.startswith("#"))
    return dict(zip(names, np.array(rows, float).T))


def beside(pictures, path):
    """Writes pictures of one height side by side as one."""
    pixels = np.hstack([oiio.ImageBuf(picture).get_pixels(oiio.UINT8) for picture in pictures])
    whole = oiio.ImageBuf(oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], oiio.UINT8))
    whole.set_pixels(oiio.ROI.All, pixels)
    whole.write(path)
