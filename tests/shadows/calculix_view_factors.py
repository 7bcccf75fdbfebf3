#!/usr/bin/env python3
"""View factors of CalculiX beside those of sightline.

    calculix_view_factors.py SIGHTLINE [SQUARES ...]

Ends with status 77 (skipped) where no `ccx` (Debian's calculix-ccx) is found.  Three scenes
are cut into SQUARES x SQUARES squares a side (default 4 8).  CalculiX finds view factors
between all squares (*RADIATE with a cavity); read are the heat flows: one surface at
temperature 1 among black ones at 0 sends sigma A F to each other one, and sigma is 1.
Prints a table; fails where the finer CalculiX answer is further than 0.005 from ours.
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SKIPPED = 77
WITHIN = 0.005


def sheet(axis, at, up, u, v):
    """A rectangle across an axis, its front towards larger coordinates if `up`."""
    corners = []
    for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
        p = [0.0, 0.0, 0.0]
        p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3] = at, u[a], v[b]
        corners.append(p)
    return corners if up else corners[::-1]


def scenes():
    """Name -> (surfaces by name, the pair to compare)."""
    whole, middle = (0.0, 1.0), (0.25, 0.75)
    floor = sheet(2, 0.0, True, whole, whole)
    ceiling = sheet(2, 1.0, False, whole, whole)
    wall = sheet(0, 0.0, True, whole, whole)
    plate = {
        "over": sheet(2, 0.25, True, middle, middle),
        "under": sheet(2, 0.25, False, middle, middle),
    }
    fin = {
        "left": sheet(0, 0.5, False, middle, (0.0, 0.5)),
        "right": sheet(0, 0.5, True, middle, (0.0, 0.5)),
    }
    box = {"lid": sheet(2, 0.5, True, middle, middle)}
    for axis in (0, 1):
        # Of a side across x the ranges are those of y and z, across y of z and x.
        u, v = (middle, (0.0, 0.5)) if axis == 0 else ((0.0, 0.5), middle)
        box[f"low {axis}"] = sheet(axis, 0.25, False, u, v)
        box[f"high {axis}"] = sheet(axis, 0.75, True, u, v)
    return {
        "plate between squares": ({"floor": floor, "ceiling": ceiling, **plate},
                                  ("floor", "ceiling")),
        "fin on a floor": ({"floor": floor, "wall": wall, **fin}, ("wall", "floor")),
        "box on a floor": ({"floor": floor, "ceiling": ceiling, "wall": wall, **box},
                           ("wall", "ceiling")),
    }


def squares(corners, n):
    """The rectangle cut into n x n, each with its corners in the rectangle's order."""
    a, b, _, d = corners

    def at(i, j):
        return [a[k] + (b[k] - a[k]) * i / n + (d[k] - a[k]) * j / n for k in range(3)]

    return [[at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]
            for i in range(n) for j in range(n)]


def normal(c):
    u = [c[1][k] - c[0][k] for k in range(3)]
    v = [c[3][k] - c[0][k] for k in range(3)]
    n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    size = sum(x * x for x in n) ** 0.5
    return [x / size for x in n]


def write_obj(surfaces, path):
    lines, count = [], 0
    for name, corners in surfaces.items():
        lines.append("g " + name.replace(" ", "_"))
        lines += ["v {} {} {}".format(*p) for p in corners]
        lines.append("f " + " ".join(str(count + k) for k in (1, 2, 3, 4)))
        count += 4
    path.write_text("\n".join(lines) + "\n")


def write_input(surfaces, n, source, path):
    """Each square is the second face of a brick that lies behind it.  The brick conducts
    well, and its first face has the temperature: what flows through it is what is sent."""
    nodes, elements, sets = [], [], {}
    for name, corners in surfaces.items():
        out = normal(corners)
        members = sets.setdefault(name.replace(" ", "_"), [])
        for square in squares(corners, n):
            ids = []
            for depth in (0.01, 0.0):
                for p in square:
                    nodes.append([p[k] - depth * out[k] for k in range(3)])
                    ids.append(len(nodes))
            members += ids[:4]
            elements.append(ids)
    lines = ["*NODE, NSET=all"]
    lines += ["{},{:.9g},{:.9g},{:.9g}".format(i + 1, *p) for i, p in enumerate(nodes)]
    lines.append("*ELEMENT, TYPE=C3D8, ELSET=bricks")
    lines += [",".join(map(str, [i + 1] + e)) for i, e in enumerate(elements)]
    for name, members in sets.items():
        lines.append(f"*NSET, NSET={name}")
        lines += [f"{m}," for m in members]
    lines += ["*MATERIAL, NAME=any", "*CONDUCTIVITY", "1.E5",
              "*SOLID SECTION, ELSET=bricks, MATERIAL=any",
              "*PHYSICAL CONSTANTS, ABSOLUTE ZERO=0., STEFAN BOLTZMANN=1.",
              "*INITIAL CONDITIONS, TYPE=TEMPERATURE", "all,0.5",
              "*STEP", "*HEAT TRANSFER, STEADY STATE", "1.,1.", "*BOUNDARY"]
    lines += [f"{name},11,11,{1.0 if name == source else 0.0}" for name in sets]
    lines.append("*RADIATE, CAVITY=all")
    lines += [f"{i + 1},R2CR,0.,1." for i in range(len(elements))]
    for name in sets:
        lines += [f"*NODE PRINT, NSET={name}, TOTALS=ONLY", "RFL"]
    lines.append("*END STEP")
    path.write_text("\n".join(lines) + "\n")


def of_calculix(surfaces, n, pair, folder):
    write_input(surfaces, n, pair[0], folder / "scene.inp")
    subprocess.run(["ccx", "scene"], cwd=folder, check=True, stdout=subprocess.DEVNULL,
                   timeout=600)
    text = (folder / "scene.dat").read_text()
    flow = re.search(r"set\s+" + pair[1].upper() + r"\b[^\n]*\n\s*\n?\s*(\S+)", text)
    side = surfaces[pair[0]]
    u = [side[1][k] - side[0][k] for k in range(3)]
    v = [side[3][k] - side[0][k] for k in range(3)]
    area = (sum(x * x for x in u) * sum(x * x for x in v)) ** 0.5
    return abs(float(flow.group(1))) / area


def of_sightline(program, surfaces, pair, folder):
    write_obj(surfaces, folder / "scene.obj")
    answer = subprocess.run([program, "formfactors", str(folder / "scene.obj"), "--json", "-"],
                            check=True,
                            stdout=subprocess.PIPE)
    answer = json.loads(answer.stdout)
    names = answer["groups"]
    return answer["matrix"][names.index(pair[0])][names.index(pair[1])]


def main(argv):
    if not shutil.which("ccx"):
        print("ccx (Debian's calculix-ccx) is not installed")
        sys.exit(SKIPPED)
    counts = [int(a) for a in argv[2:]] or [4, 8]
    wrong = False
    print("scene | pair | sightline | " +
          " | ".join(f"ccx, {n} x {n}" for n in counts))
    for name, (surfaces, pair) in scenes().items():
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            ours = of_sightline(argv[1], surfaces, pair, folder)
            theirs = [of_calculix(surfaces, n, pair, folder) for n in counts]
        print(f"{name} | {pair[0]} to {pair[1]} | {ours:.12f} | " +
              " | ".join(f"{value:.6f}" for value in theirs))
        wrong = wrong or abs(theirs[-1] - ours) > WITHIN
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main(sys.argv)
