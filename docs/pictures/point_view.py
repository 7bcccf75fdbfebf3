#!/usr/bin/env python3
"""Draws the pictures of docs/point_view.md with `sightline look`.

  python3 docs/pictures/point_view.py build/default/bin/sightline           # all, anew
  python3 docs/pictures/point_view.py build/default/bin/sightline --check   # as they are?
  python3 docs/pictures/point_view.py build/default/bin/sightline --house FILE.ifc

The drawings are those of `look`, made fit for a small size: fewer digits, thicker lines,
dots coloured by the kind of vertex.  --check compares them with the files here, numbers
to half a unit of 1000, and exits with 1 where one differs.  --house draws the house,
AC14-FZK-Haus.ifc of assimp-testmodels, instead; these pictures are not checked.
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
    "sunk_box": ("sunk_box", OBLIQUE),
    "box_on_its_edge": ("box_on_its_edge", ["--direction=2,-6,3"]),
    "flush_boxes": ("flush_boxes", OBLIQUE),
    "coinciding_facets": ("coinciding_sheets", ["--direction=0,0,1"]),
    "two_equal_boxes": ("two_equal_boxes", OBLIQUE),
    "sheet_on_a_box": ("sheet_on_box", OBLIQUE),
    "coinciding_patches": ("touching_boxes",
                           ["--from=1,1,1", "--towards=2,1,0.6", "--fov=110"]),
    "tee_junction_in_a_plane": ("tee_flat", OBLIQUE),
    "tee_junction_on_a_fold": ("tee_folded", OBLIQUE),
    "box_of_sheets": ("box_of_sheets", OBLIQUE),
    "crossing_facets": ("crossing_sheets", OBLIQUE),
    "book_of_three_pages": ("book", OBLIQUE),
    "sheet_from_above": ("sheet", OBLIQUE),
    "sheet_from_below": ("sheet", ["--direction=1,-2,-2"]),
    "frame_with_a_hole": ("frame", ["--from=1.5,1.5,1"]),
    "eye_in_a_room": ("room", ["--from=1,1,1", "--towards=2,1.4,0.8", "--fov=110"]),
    "eye_in_a_solid": ("box", ["--from=1,1,1", "--towards=2,1.4,0.8", "--fov=110"]),
    "eye_on_a_rooms_wall": ("room", ["--from=0,1,1", "--towards=0.5,0.1,0.9", "--fov=110"]),
    "eye_on_a_facet": ("box_below_sheet",
                       ["--from=1,1,0", "--towards=1,1,1", "--fov=120"]),
    "eye_on_an_edge": ("box_below_sheets",
                       ["--from=1,0,0", "--towards=1,0,1", "--fov=120"]),
    "eye_on_a_corner": ("box_corner_below_sheet",
                        ["--from=0,0,0", "--towards=0,0,1", "--fov=120"]),
    "eye_near_a_face": ("box_below_sheet",
                        ["--from=1,1,1/16", "--towards=1,2,0.2", "--fov=120"]),
    "accident_corner_on_edge": ("corner_on_edge", ["--from=0,-2,1"]),
    "accident_corner_half_hidden": ("corner_half_hidden", ["--from=0,-2,1"]),
    "accident_corner_on_corner": ("corner_on_corner", ["--from=1,-2,1"]),
    "accident_three_edges": ("three_edges", ALONG_Y),
    "accident_along_edge": ("two_sheets", ["--from=0,-1,0"]),
    "corner_on_a_seam": ("before_a_seam", ["--from=1/2,-6,3/4"]),
    "edge_passing_a_joint": ("before_a_joint", ["--from=1/2,-6,3/4"]),
    "section_of_a_box": ("box", [*OBLIQUE, "--box=-1,-1,-1,3,3,1"]),
    "facet_in_a_side_of_the_box": ("box", [*OBLIQUE, "--box=-1,-1,2,3,3,5"]),
    "what_is_cut_off_does_not_hide": ("stacked_boxes",
                                      [*OBLIQUE, "--box=-1,-1,-1,9,9,1"]),
    "crossing_facets_are_cut": ("crossing_sheets", [*OBLIQUE, "--box=-9,-9,-9,9,9,0"]),
    "eye_in_a_solid_cut_open": ("box", ["--from=1,1,1/2", "--box=-1,-1,-1,3,3,1",
                                        "--towards=2,1.6,0.9", "--fov=110"]),
    "hidden_accident": ("hidden_three_edges", ALONG_Y),
}

# The room without what stands in the way of a plan, of an elevation.
ROOM = {
    "room_plan": (["ceiling"], ["--direction=0,1,0", "--up", "0,0,-1"]),
    "room_elevation": (["wall_front"], ["--direction=0,0,1", "--up", "0,1,0"]),
    "room_perspective": ([], ["--from=5,1.6,4", "--up", "0,1,0", "--towards", "2,0.9,1.5",
                              "--fov=80"]),
}
HOUSE = {
    "house_plan": ["--direction=0,0,1"],
    "house_elevation": ["--direction=0,-1,0"],
    "house_perspective": ["--from=24,-13,5", "--towards=6,5,1", "--fov=44"],
}

STYLE = """  circle { stroke: #16181f; stroke-width: 3; }
  .t { fill: #ffffff; } .touch { fill: #8a5cc2; } .accident { fill: #e02020; }
"""


def rounded(text, digits):
    """Numbers with so many decimals at most; the version of XML stays what it is."""
    return re.sub(r"(?<!version=\")-?\d+\.\d+",
                  lambda m: f"{float(m.group()):.{digits}f}".rstrip("0").rstrip("."),
                  text)


def made_small(svg, size, dots):
    """The drawing at a longer side of `size`, with lines and dots to be seen there."""
    if not dots:
        svg = re.sub(r"<circle [^\n]*\n", "", svg)
    scale = 1000 / size
    width, height = map(float, re.search(r'viewBox="0 0 (\S+) (\S+)"', svg).groups())
    head, body = svg.split("</style>", 1)
    head = re.sub(r"stroke-width: ([\d.]+)",
                  lambda m: f"stroke-width: {float(m.group(1)) * scale * 0.6:.3g}", head)
    body = re.sub(r' r="[\d.]+"', f' r="{2.2 * scale:.3g}"', body)
    head = re.sub(r'(viewBox="[^"]*") width="\S+" height="[^">]+"',
                  rf'\1 width="{width / scale:.0f}" height="{height / scale:.0f}"', head)
    return rounded(head + STYLE + "</style>" + body, 1)


def draw(program, scene, options, size=190, dots=True):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "view.svg"
        subprocess.run([program, "look", str(scene), *options, "--svg", str(file)],
                       check=True, stdout=subprocess.DEVNULL)
        return made_small(file.read_text(encoding="utf-8"), size, dots)


def room_without(objects, file):
    """Writes the built-in room without these objects."""
    kept = True
    with open(SCENES / "room.obj", encoding="utf-8") as room, \
            open(file, "w", encoding="utf-8") as out:
        for line in room:
            if line.startswith("o "):
                kept = line.split()[1] not in objects
            if kept or not line.startswith("f "):
                out.write(line)


def pictures(program):
    """Name and SVG of every picture but those of the house."""
    for name, (scene, options) in CASES.items():
        yield f"view_{name}", draw(program, VIEWS / f"{scene}.obj", options)
    with tempfile.TemporaryDirectory() as folder:
        scene = pathlib.Path(folder) / "room.obj"
        for name, (objects, options) in ROOM.items():
            room_without(objects, scene)
            yield f"look_{name}", draw(program, scene, options, 400, dots=False)


def pictures_of_house(program, file):
    for name, options in HOUSE.items():
        svg = draw(program, file, options, 400, dots=False)
        svg = re.sub(r"<title>[^<]*</title>", "", svg)  # the file would be large
        yield f"look_{name}", re.sub(r' data-[a-z]+="[^"]*"', "", svg)


def alike(a, b):
    """The same but for numbers that differ by less than half a unit."""
    number = re.compile(r"-?\d+(?:\.\d+)?")
    if number.sub("0", a) != number.sub("0", b):
        return False
    pairs = zip(number.findall(a), number.findall(b))
    return all(abs(float(x) - float(y)) < 0.5 for x, y in pairs)


def write_or_compare(drawn, check, command):
    """Writes pictures, name and SVG each; or, to check, tells those that lie beside this
    script otherwise.  The exit status."""
    stale = []
    for name, svg in drawn:
        file = HERE / f"{name}.svg"
        if not check:
            file.write_text(svg, encoding="utf-8")
        elif not file.exists() or not alike(svg, file.read_text(encoding="utf-8")):
            stale.append(file.name)
    for name in stale:
        print(f"docs/pictures/{name} is not what `{command}` draws now", file=sys.stderr)
    return 1 if stale else 0


def main():
    program, options = sys.argv[1], sys.argv[2:]
    if options[:1] == ["--house"]:
        drawn = pictures_of_house(program, options[1])
    else:
        drawn = pictures(program)
    return write_or_compare(drawn, options == ["--check"], "look")


if __name__ == "__main__":
    sys.exit(main())
