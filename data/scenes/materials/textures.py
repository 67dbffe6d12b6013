#!/usr/bin/env python3
"""Writes the images that textures.json names, beside this file: textures_paint.png, textures_tiles.png, textures_ripples.png."""
import math
import pathlib
import struct
import zlib

SIDE = 64


def write_png(name, bits, channels, value):
    """`value(u, v)` gives each channel in [0, 1]; v runs upwards."""
    top = (1 << bits) - 1
    rows = bytearray()
    for row in range(SIDE):
        rows.append(0)
        for column in range(SIDE):
            for x in value((column + 0.5) / SIDE, 1 - (row + 0.5) / SIDE):
                rows += round(top * x).to_bytes(bits // 8, "big")
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    header = struct.pack(">IIBBBBB", SIDE, SIDE, bits, {1: 0, 3: 2}[channels], 0, 0, 0)
    body = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(rows), 9)) + chunk(b"IEND", b"")
    (pathlib.Path(__file__).parent / name).write_bytes(b"\x89PNG\r\n\x1a\n" + body)


def wave(phase):
    return 0.5 + 0.5 * math.sin(2 * math.pi * phase)


def paint(u, v):
    """Shares of three pigments, which add up to 1."""
    bent = u + 0.15 * math.sin(2 * math.pi * v)
    shares = [wave(2 * bent + k / 3) ** 3 for k in range(3)]
    return [share / sum(shares) for share in shares]


def tiles(u, v):
    """Normals of four tiles with rounded edges, a brick's half apart from row to row."""
    row = math.floor(2 * v)
    x = (2 * (u + 0.25 * row)) % 1 - 0.5
    y = (2 * v) % 1 - 0.5
    lean = [math.copysign(max(0, abs(t) - 0.42) / 0.08, t) for t in (x, y)]
    length = math.sqrt(lean[0] ** 2 + lean[1] ** 2 + 1)
    return [0.5 + lean[0] / length / 2, 0.5 + lean[1] / length / 2, 0.5 + 1 / length / 2]


def ripples(u, v):
    return [(wave(2 * u + v) + wave(u - 2 * v + 0.3)) / 2]


write_png("textures_paint.png", 8, 3, paint)
write_png("textures_tiles.png", 8, 3, tiles)
write_png("textures_ripples.png", 16, 1, ripples)
