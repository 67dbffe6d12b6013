"""What the scripts of the tutorials share."""
import shlex
import subprocess

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
