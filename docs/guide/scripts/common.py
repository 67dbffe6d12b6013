"""What the scripts of the guide share: commands, films and tables; plots as SVG with curves of formulas and dots where they were measured."""
import math
import pathlib
import shlex
import subprocess
from typing import NamedTuple

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


def above(pictures, path):
    """Writes pictures of one width on top of each other as one."""
    pixels = np.vstack([oiio.ImageBuf(picture).get_pixels(oiio.UINT8) for picture in pictures])
    whole = oiio.ImageBuf(oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], oiio.UINT8))
    whole.set_pixels(oiio.ROI.All, pixels)
    whole.write(path)


WIDTH, AXES_BOTTOM = 330, 250  # of a panel, in px
LEFT, RIGHT, TOP = 58, 316, 34
ROW = 16  # from line to line of a legend


class Axis(NamedTuple):
    """An axis from its first tick to its last."""
    label: str
    ticks: tuple
    log: bool = False

    def share(self, value):
        """How far along the axis the value lies, 1 at its end."""
        scale = math.log if self.log else float
        low, high = scale(self.ticks[0]), scale(self.ticks[-1])
        return (scale(value) - low) / (high - low)


class Series(NamedTuple):
    """Points (x, y) of one colour: a line through them, dots at them, or both. Only a named one is in the legend."""
    name: str
    colour: str
    points: list
    line: str = ""  # "solid" or "dashed"
    dots: bool = False


class Panel(NamedTuple):
    """A plot, one of those beside one another in a figure."""
    title: str
    x: Axis
    y: Axis
    series: list


def document(width, height, lines):
    """An SVG of that size in px."""
    return "\n".join([f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="13">',
                      '<rect width="100%" height="100%" fill="white"/>', *lines, "</svg>", ""])


def frame(panel):
    """Title, grid and labels."""
    lines = [f'<text x="{LEFT}" y="20" font-weight="bold">{panel.title}</text>']
    for tick in panel.x.ticks:
        x = LEFT + (RIGHT - LEFT) * panel.x.share(tick)
        lines += [f'<path d="M{x:.1f} {TOP}V{AXES_BOTTOM}" stroke="#ddd"/>', f'<text x="{x:.1f}" y="{AXES_BOTTOM + 17}" text-anchor="middle">{tick:g}</text>']
    for tick in panel.y.ticks:
        y = AXES_BOTTOM - (AXES_BOTTOM - TOP) * panel.y.share(tick)
        lines += [f'<path d="M{LEFT} {y:.1f}H{RIGHT}" stroke="#ddd"/>', f'<text x="{LEFT - 6}" y="{y + 4:.1f}" text-anchor="end">{tick:g}</text>']
    middle = (TOP + AXES_BOTTOM) / 2
    return [*lines, f'<rect x="{LEFT}" y="{TOP}" width="{RIGHT - LEFT}" height="{AXES_BOTTOM - TOP}" fill="none" stroke="#444"/>',
            f'<text x="{(LEFT + RIGHT) / 2}" y="{AXES_BOTTOM + 36}" text-anchor="middle">{panel.x.label}</text>',
            f'<text x="13" y="{middle}" text-anchor="middle" transform="rotate(-90 13 {middle})">{panel.y.label}</text>']


def stroke(series):
    return f'fill="none" stroke="{series.colour}" stroke-width="2"' + (' stroke-dasharray="6 4"' if series.line == "dashed" else "")


def drawn(panel, series):
    """A series within the axes."""
    points = [(LEFT + (RIGHT - LEFT) * panel.x.share(x), AXES_BOTTOM - (AXES_BOTTOM - TOP) * panel.y.share(y)) for x, y in series.points]
    line = [f'<polyline points="{" ".join(f"{x:.1f},{y:.1f}" for x, y in points)}" {stroke(series)}/>'] if series.line else []
    return line + [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="{series.colour}"/>' for x, y in points if series.dots]


def legend(panel):
    """A row for each named series, below the axes."""
    lines = []
    for row, series in enumerate(one for one in panel.series if one.name):
        y = AXES_BOTTOM + 58 + ROW * row
        mark = f'<path d="M{LEFT} {y - 4}h26" {stroke(series)}/>' if series.line else f'<rect x="{LEFT + 9}" y="{y - 8}" width="8" height="8" fill="{series.colour}"/>'
        lines += [mark, f'<text x="{LEFT + 34}" y="{y}">{series.name}</text>']
    return lines


def figure(path, *panels):
    """Writes the panels side by side."""
    lines = []
    for column, panel in enumerate(panels):
        lines += [f'<g transform="translate({WIDTH * column} 0)">', *frame(panel), *(line for one in panel.series for line in drawn(panel, one)), *legend(panel), "</g>"]
    rows = max(sum(bool(one.name) for one in panel.series) for panel in panels)
    pathlib.Path(path).write_text(document(WIDTH * len(panels), AXES_BOTTOM + 50 + ROW * rows, lines))
