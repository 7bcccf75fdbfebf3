#!/usr/bin/env python3
"""Draws the pictures of docs/shadows.md from the answers of `sightline shadows`.

  python3 docs/pictures/shadows.py build/default/bin/sightline           # all, anew
  python3 docs/pictures/shadows.py build/default/bin/sightline --check   # as they are?

A plan of a receiver shows its regions by class, the edges of its mesh by kind, and the
outlines of source and blockers.  A view of the source shows what a point sees of it.
--check compares with the files here, as point_view.py does, and exits with 1 where one
differs.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

from point_view import HERE, rounded, write_or_compare

SCENES = HERE.parents[1] / "tests" / "data" / "shadows"

# picture: scene, half-side of the window on the ground, options
PLANS = {
    "source_in_mid_air": ("mid_air", 6, []),
    "source_above_a_hole": ("recessed", 10, []),
    "source_part_of_a_wall": ("part_of_a_wall", 8, ["--light", "#1-1"]),
    "source_l_shaped": ("l_shaped", 8, []),
    "several_sources": ("several_at_once", 8, ["--light", "high,low"]),
    "source_closed": ("closed_lamp", 8, []),
    "blocker_cuts_the_source": ("cuts_the_source", 8, []),
    "foot": ("foot", 8, []),
    "foot_of_a_leaning_sheet": ("leaning", 8, []),
    "blocker_in_mid_air": ("corner", 8, []),
    "edges_face": ("edge_face", 8, []),
    "edges_ev": ("edge_ev", 6, []),
    "edges_eee": ("edge_eee", 3, []),
    "fused_umbrae": ("fused_umbrae", 8, []),
    "umbra_with_a_hole": ("umbra_with_a_hole", 8, []),
    "four_pieces": ("four_pieces", 12, []),
}
# picture: scene, point, normal, half-side of the window on the source's plane, options
VIEWS = {
    "seen_corner_of_a_blocker": ("corner", "0,0,1", "0,0,1", []),
    "seen_horizon": ("lamp", "0,0,0", "8,0,-1", []),
    "seen_blocker_cuts_the_source": ("cuts_the_source", "8,0,0", "0,0,1", []),
}

# picture: scene, options
VOLUMES = {"volumes": ("volumes", [])}

FILL = {"umbra": "#4a4f5c", "penumbra": "#b9bdc8", "lit": "#fff6d5"}
STROKE = {"EV": "#1f6fb4", "EE": "#2a9d5c", "EEE": "#d62828", "face": "#c77d0a",
          "contact": "#101010", "plane": "#8a5cc2", "boundary": "#606060"}
SIZE = 220


def ask(program, scene, options):
    light = [] if "--light" in options else ["--light", "lamp"]
    command = [program, "shadows", str(SCENES / f"{scene}.obj"), *light, *options]
    return json.loads(subprocess.run([*command, "--json", "-"], check=True,
                                     capture_output=True, text=True).stdout)


def polygons(scene):
    """(group, corners) of every polygon of the file."""
    vertices, group = [], ""
    for line in open(SCENES / f"{scene}.obj", encoding="utf-8"):
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append(tuple(map(float, words[1:4])))
        elif words[:1] == ["o"]:
            group = words[1]
        elif words[:1] == ["f"]:
            yield group, [vertices[int(w) - 1] for w in words[1:]]


def path(points, half, closed=True):
    """A window of this half-side is 1,000 units wide."""
    steps = (f"{500 * x / half:.3f} {-500 * y / half:.3f}" for x, y in points)
    return "M" + "L".join(steps) + ("Z" if closed else "")


def picture(title, elements):
    body = "\n".join(elements)
    return rounded(
        f'<?xml version="1.0" encoding="UTF-8"?>\n'
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="-500 -500 1000 1000" '
        f'width="{SIZE}" height="{SIZE}">\n<title>{title}</title>\n'
        f'<g fill="none" stroke-width="7" stroke-linejoin="round">\n'
        f'{body}\n</g>\n</svg>\n', 1)


def outlines(scene, half, skipped):
    for group, corners in polygons(scene):
        if group in skipped:
            continue
        shines = group in ("lamp", "high", "low")
        yield (f'<path d="{path([p[:2] for p in corners], half)}" '
               f'stroke="{"#e0a000" if shines else "#ffffff"}" '
               f'stroke-dasharray="18"/>')


def loops(edges, face):
    """The face's boundary: directed polylines chained at common vertices."""
    pieces = []
    for e in edges:
        if e["left"] == e["right"]:
            continue
        if e["left"] == face:
            pieces.append((e["ends"][0], e["ends"][1], e["points"]))
        elif e["right"] == face:
            pieces.append((e["ends"][1], e["ends"][0], e["points"][::-1]))
    while pieces:
        first, at, points = pieces.pop(0)
        points = list(points)
        while at != first:
            i = next(i for i, p in enumerate(pieces) if p[0] == at)
            _, at, more = pieces.pop(i)
            points += more[1:]
        yield points


def plan(program, name, scene, half, options):
    answer = ask(program, scene, [*options, "--receivers", "ground", "--list"])
    elements = []
    for mesh in answer["receivers"][0]["facets"]:
        frame = mesh["frame"]

        def flat(points):
            return [tuple(frame["origin"][i] + p[0] * frame["x"][i] + p[1] * frame["y"][i]
                          for i in (0, 1)) for p in points]

        for f, face in enumerate(mesh["faces"]):
            d = "".join(path(flat(loop), half) for loop in loops(mesh["edges"], f))
            elements.append(f'<path d="{d}" fill="{FILL[face["class"]]}" '
                            'fill-rule="evenodd"/>')
        for e in mesh["edges"]:
            elements.append(f'<path d="{path(flat(e["points"]), half, False)}" '
                            f'stroke="{STROKE[e["kind"]]}"/>')
    elements += outlines(scene, half, ("ground", "ceiling"))
    return picture(name, elements)


def view(program, name, scene, point, normal, options):
    half = 1.5
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "point.txt"
        file.write_text(f"{point},{normal}\n", encoding="utf-8")
        answer = ask(program, scene, [*options, "--structure", "--at", str(file)])
    elements = [f'<path d="{path([p[:2] for p in corners], half)}" fill="{FILL["umbra"]}"/>'
                for group, corners in polygons(scene) if group == "lamp"]
    seen = answer["points"][0]
    d = "".join(path([p[:2] for p in loop], half) for loop in seen["seen"])
    elements.append(f'<path d="{d}" fill="#ffd75e" fill-rule="evenodd"/>')
    colours = {"source": "#e0a000", "edge": "#1f6fb4", "cut": "#101010",
               "horizon": "#d62828"}
    for boundary, loop in zip(seen["structure"], seen["seen"]):
        for k, names in enumerate(boundary["sides"]):
            ends = [loop[k][:2], loop[(k + 1) % len(loop)][:2]]
            kind = names[0].split()[0]
            elements.append(f'<path d="{path(ends, half, False)}" stroke="{colours[kind]}" '
                            'stroke-width="16"/>')
    return picture(name, elements)


def volumes(program, name, scene, options):
    """Seen from the side and a little from above; what is farther is drawn first."""
    answer = ask(program, scene, [*options, "--volumes"])["volumes"]
    half = 7.5

    def flat(points):
        return [(x + 0.35 * y, z * 1.3 - 2 + 0.3 * y) for x, y, z in points]

    def number(text):
        over = str(text).split("/")
        return float(over[0]) / float(over[1]) if len(over) == 2 else float(over[0])

    elements = []
    for group, corners in polygons(scene):
        if group == "ground":
            elements.append(f'<path d="{path(flat(corners), half)}" fill="{FILL["lit"]}"/>')
    for which, opacity in (("penumbra", 0.45), ("umbra", 0.55)):
        body = answer[which]
        at = [[number(x) for x in v] for v in body["vertices"]]
        sides = [[at[c] for c in side["corners"]] for side in body["sides"]]
        for side in sorted(sides, key=lambda s: -sum(p[1] for p in s) / len(s)):
            elements.append(f'<path d="{path(flat(side), half)}" fill="{FILL[which]}" '
                            f'fill-opacity="{opacity}" stroke="{STROKE["boundary"]}" '
                            'stroke-width="4"/>')
    for group, corners in polygons(scene):
        if group != "ground":
            colour = "#e0a000" if group == "lamp" else "#101010"
            elements.append(f'<path d="{path(flat(corners), half)}" stroke="{colour}"/>')
    return picture(name, elements)


def pictures(program):
    """Name and SVG of every picture."""
    for name, (scene, half, options) in PLANS.items():
        yield f"shadow_{name}", plan(program, name, scene, half, options)
    for name, (scene, point, normal, options) in VIEWS.items():
        yield f"shadow_{name}", view(program, name, scene, point, normal, options)
    for name, (scene, options) in VOLUMES.items():
        yield f"shadow_{name}", volumes(program, name, scene, options)


def main():
    program, check = sys.argv[1], sys.argv[2:] == ["--check"]
    return write_or_compare(pictures(program), check, "shadows")


if __name__ == "__main__":
    sys.exit(main())
