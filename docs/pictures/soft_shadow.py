#!/usr/bin/env python3
"""The Cornell box under its light: exact, and by random rays in the same time.

  python3 docs/pictures/soft_shadow.py build/default/bin/sightline

Writes soft_shadow_exact.png and soft_shadow_rays.png here.  The number of rays a pixel is
that with which the picture takes as much time of the processor as the exact one, least of
two runs each.  Tells both times and the difference of the pictures: root mean square
and largest, over white.
"""

import pathlib
import resource
import struct
import subprocess
import sys
import zlib

HERE = pathlib.Path(__file__).resolve().parent
SCENE = HERE.parents[1] / "examples" / "scenes" / "cornell.obj"
RUNS = 2
CAMERA = "--eye 27.8,27.3,-80 --towards 27.8,27.3,28 --up 0,1,0 --fov 38 --size 200x200"


def seconds(program, picture, rays):
    """Processor time of a picture, threads together; rays = 0: exact."""
    command = [program, "shadows", str(SCENE), "--light", "light", "--png", str(picture)]
    command += CAMERA.split() + (["--rays", str(rays)] if rays else [])
    times = []
    for _ in range(RUNS):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(command, check=True, capture_output=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        times.append(after.ru_utime - before.ru_utime)
    return min(times)


def samples(picture):
    """The bytes of a PNG of 8 bits a channel, row by row."""
    data = picture.read_bytes()
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + size]
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", body[:10])
            assert depth == 8
            step = {0: 1, 2: 3, 6: 4}[colour]
        elif kind == b"IDAT":
            packed += body
        at += 12 + size
    raw, rows, above = zlib.decompress(packed), [], bytearray(width * step)
    for y in range(height):
        start = y * (width * step + 1)
        method, row = raw[start], bytearray(raw[start + 1 : start + 1 + width * step])
        for i in range(len(row)):
            left = row[i - step] if i >= step else 0
            corner = above[i - step] if i >= step else 0
            guess = left + above[i] - corner
            near = min((left, above[i], corner), key=lambda v: abs(guess - v))
            row[i] = (row[i] + (0, left, above[i], (left + above[i]) // 2, near)[method]) % 256
        rows.append(row)
        above = row
    return b"".join(rows)


def main():
    program = sys.argv[1]
    exact, random = HERE / "soft_shadow_exact.png", HERE / "soft_shadow_rays.png"
    wanted = seconds(program, exact, 0)
    few, many = seconds(program, random, 16), seconds(program, random, 128)
    rays = max(1, round(16 + (wanted - few) / (many - few) * 112))
    taken = seconds(program, random, rays)
    off = [abs(a - b) / 255 for a, b in zip(samples(exact), samples(random))]
    root = (sum(d * d for d in off) / len(off)) ** 0.5
    print(f"exact {wanted:.2f} s; {rays} rays a pixel {taken:.2f} s")
    print(f"difference: root mean square {root:.2e}, largest {max(off):.2e}")


if __name__ == "__main__":
    main()
