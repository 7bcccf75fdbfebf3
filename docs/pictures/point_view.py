#!/usr/bin/env python3
"""Draws the pictures of docs/point_view.md with `sightline look`.

  python3 docs/pictures/point_view.py build/default/bin/sightline           # all, anew
  python3 docs/pictures/point_view.py build/default/bin/sightline --check   # as they are?

The drawings are those of `look`, made fit for a small size: fewer digits, thicker lines,
dots coloured by the kind of vertex.  --check compares them with the files here, numbers
to half a unit of 1000, and exits with 1 where one differs.
"""

import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
VIEWS = HERE.parents[1] / "tests" / "data" / "views"
SCENES = HERE.parents[1] / "examples" / "scenes"

OBLIQUE = ["--direction=1,-2,2"]
ALONG_Y = ["--direction=0,-1,0"]

# picture: scene, options of look
CASES = {
    "facet_edge_on": ("box", ["--from=5,-2,2"]),
    "sheet_edge_on": ("sheet_before_box", ["--from=1,-6,1"]),
    "edge_end_on": ("box", ["--from=2,-3,2"]),
    "edges_in_line": ("row_of_boxes", OBLIQUE),
    "crack_of_no_width": ("crack", ALONG_Y),
    "boxes_sharing_an_edge": ("boxes_sharing_an_edge", OBLIQUE),
    "boxes_sharing_a_corner": ("boxes_sharing_a_corner", OBLIQUE),
    "stacked_boxes": ("stacked_boxes", OBLIQUE),
    "flush_boxes": ("flush_boxes", OBLIQUE),
    "coinciding_facets": ("coinciding_sheets", ["--direction=0,0,1"]),
    "sheet_on_a_box": ("sheet_on_box", OBLIQUE),
    "coinciding_patches": ("touching_boxes",
                           ["--from=1,1,1", "--towards=2,1,0.6", "--fov=110"]),
    "tee_junction_in_a_plane": ("tee_flat", OBLIQUE),
    "tee_junction_on_a_fold": ("tee_folded", OBLIQUE),
    "crossing_facets": ("crossing_sheets", OBLIQUE),
    "sheet_from_above": ("sheet", OBLIQUE),
    "sheet_from_below": ("sheet", ["--direction=1,-2,-2"]),
    "frame_with_a_hole": ("frame", ["--from=1.5,1.5,1"]),
    "eye_in_a_room": ("room", ["--from=1,1,1", "--towards=2,1.4,0.8", "--fov=110"]),
    "eye_in_a_solid": ("box", ["--from=1,1,1", "--towards=2,1.4,0.8", "--fov=110"]),
    "eye_on_a_facet": ("box_below_sheet",
                       ["--from=1,1,0", "--towards=1,1,1", "--fov=120"]),
    "eye_on_an_edge": ("box_below_sheets",
                       ["--from=1,0,0", "--towards=1,0,1", "--fov=120"]),
    "eye_on_a_corner": ("box_corner_below_sheet",
                        ["--from=0,0,0", "--towards=0,0,1", "--fov=120"]),
    "eye_near_a_face": ("box_below_sheet",
                        ["--from=1,1,1/16", "--towards=1,2,0.2", "--fov=120"]),
    "accident_corner_on_edge": ("corner_on_edge", ["--from=0,-2,1"]),
    "accident_corner_on_corner": ("corner_on_corner", ["--from=1,-2,1"]),
    "accident_three_edges": ("three_edges", ALONG_Y),
    "accident_along_edge": ("two_sheets", ["--from=0,-1,0"]),
    "hidden_accident": ("hidden_three_edges", ALONG_Y),
}

STYLE = """  circle { stroke: #16181f; stroke-width: 3; }
  .t { fill: #ffffff; } .touch { fill: #8a5cc2; } .accident { fill: #e02020; }
"""


def rounded(text, digits):
    return re.sub(r"-?\d+\.\d+",
                  lambda m: f"{float(m.group()):.{digits}f}".rstrip("0").rstrip("."),
                  text)


def made_small(svg, size):
    """The drawing at a longer side of `size`, with lines and dots to be seen there."""
    scale = 1000 / size
    width, height = map(float, re.search(r'viewBox="0 0 (\S+) (\S+)"', svg).groups())
    head, body = svg.split("</style>", 1)
    head = re.sub(r"stroke-width: ([\d.]+)",
                  lambda m: f"stroke-width: {float(m.group(1)) * scale * 0.6:.3g}", head)
    body = re.sub(r' r="[\d.]+"', f' r="{2.2 * scale:.3g}"', body)
    head = re.sub(r'(viewBox="[^"]*") width="\S+" height="[^">]+"',
                  rf'\1 width="{width / scale:.0f}" height="{height / scale:.0f}"', head)
    return rounded(head + STYLE + "</style>" + body, 1)


def draw(program, scene, options, size):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "view.svg"
        subprocess.run([program, "look", str(scene), *options, "--svg", str(file)],
                       check=True, stdout=subprocess.DEVNULL)
        return made_small(file.read_text(encoding="utf-8"), size)


def alike(a, b):
    """The same but for numbers that differ by less than half a unit."""
    number = re.compile(r"-?\d+(?:\.\d+)?")
    if number.sub("0", a) != number.sub("0", b):
        return False
    pairs = zip(number.findall(a), number.findall(b))
    return all(abs(float(x) - float(y)) < 0.5 for x, y in pairs)


def main():
    program, check = sys.argv[1], sys.argv[2:] == ["--check"]
    stale = []
    for name, (scene, options) in CASES.items():
        file = HERE / f"view_{name}.svg"
        svg = draw(program, VIEWS / f"{scene}.obj", options, 190)
        if not check:
            file.write_text(svg, encoding="utf-8")
        elif not file.exists() or not alike(svg, file.read_text(encoding="utf-8")):
            stale.append(file.name)
    for name in stale:
        print(f"docs/pictures/{name} is not what `look` draws now", file=sys.stderr)
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main())
