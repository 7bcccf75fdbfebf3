"""The plan of the house: which file may include which, and how full a room may be.

    plan.py SOURCE_DIR

Fails, with a line for each offence, when

* a file includes a module above its own, or another that does not stand below it;
* a library is included where it does not belong: CGAL and Embree only in .cpp files and
  in sub-folders, VTK only in viewers;
* a public header, one at the top of a module, includes a header of a sub-folder;
* a module reaches into a sub-folder of another that is not opened to it (OPEN);
* something in skeleton includes skeleton/build.h, or skeleton/graph.h anything of skeleton;
* a folder holds more than 30 files, a header more than 400 lines;
* units include each other in a circle that is not explained here (CIRCLES).

A unit is a header with the .cpp of the same name, a public header with the one in any
sub-folder of its module.
"""

import collections
import pathlib
import re
import sys

BELOW = {
    "linespace": set(),
    "skeleton": {"linespace"},
    "shadows": {"linespace", "skeleton"},
    "aspect": {"linespace", "skeleton"},
    "viewers": {"linespace", "skeleton", "shadows", "aspect"},
}

# Sub-folders are internal to the library: they are not installed.  The modules that build
# events and sets on them may use those of linespace; viewers only what every long work
# needs (stages, stops) and how a file is read whole.
OPEN = {
    "skeleton": {"linespace/*"},
    "shadows": {"linespace/*"},
    "aspect": {"linespace/*"},
    "viewers": {"linespace/work", "linespace/files"},
}

# Circles of units: by the name of one of them, how many they are, and the reason.
CIRCLES = {
    "linespace/predicates": (2, "the interface and the numbers of its last stage"),
    "linespace/occlusion": (2, "contacts are told in the public words of the index"),
    "linespace/polygon_visibility": (8, "search, proof and occluders of one question"),
    "linespace/seams": (2, "faces are asked with their seams closed"),
    "linespace/mesh_io": (2, "the door names the readers, a reader the door's words"),
    "linespace/portals": (3, "a sequence and the parts of its search"),
    "linespace/silhouettes/silhouettes": (6, "what is buried is found by the free parts of edges"),
    "viewers/page": (3, "sections are written in the words of the page"),
    "skeleton/nodes/node_contacts": (2, "lists are kept in the form in which they are asked"),
    "skeleton/skeleton_lines": (8, "a part by far ends is cut by the lines of what is built"),
}

MOST_FILES = 30
MOST_HEADER_LINES = 400


def main(source):
    includes = {}  # file -> what it includes, as written
    offences = []
    for module in BELOW:
        for path in sorted((source / module).rglob("*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            text = path.read_text(encoding="utf-8")
            name = path.relative_to(source).as_posix()
            includes[name] = re.findall(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', text, re.M)
            lines = text.count("\n")
            if path.suffix == ".h" and lines > MOST_HEADER_LINES:
                offences.append(f"{name}: {lines} lines in a header")
            if path.stem.endswith("_internal"):
                offences.append(f"{name}: a sub-folder says that it is internal")
    if not includes:
        sys.exit(f"no source file found under {source}")

    files = collections.Counter(name.rsplit("/", 1)[0] for name in includes)
    for folder, count in files.items():
        if count > MOST_FILES:
            offences.append(f"{folder}: {count} files")

    for name, headers in includes.items():
        for header in headers:
            offence = judge(name, header)
            if offence:
                offences.append(f"{name}: {header} {offence}")

    found = circles(units(includes))
    for circle in found:
        known = [CIRCLES[unit] for unit in circle if unit in CIRCLES]
        if len(circle) not in [size for size, _ in known]:
            offences.append("a circle that is new or has grown: " + ", ".join(sorted(circle)))
    for unit in CIRCLES:
        if not any(unit in circle for circle in found):
            offences.append(f"{unit} is in no circle any more: take it out of CIRCLES")

    if offences:
        sys.exit("\n".join(offences))
    print(f"{len(includes)} files keep to the plan of the house")


def judge(name, header):
    """What is wrong with this include; None where nothing is."""
    module, folder = name.split("/")[0], name.rsplit("/", 1)[0]
    public = name.endswith(".h") and folder == module
    if re.match(r"(CGAL|embree\d*)/", header) and public:
        return "in a public header"
    if header.startswith("vtk") and module != "viewers":
        return "outside of viewers"
    parts = header.split("/")
    if parts[0] in ("tests", "examples"):
        return "is no part of the library"
    if parts[0] not in BELOW:
        return None
    if parts[0] != module and parts[0] not in BELOW[module]:
        return f"is not below {module}"
    inner = len(parts) > 2
    if inner and public:
        return "in a public header"
    if inner and parts[0] != module:
        opened = OPEN.get(module, set())
        if f"{parts[0]}/*" not in opened and "/".join(parts[:2]) not in opened:
            return f"is not opened to {module}"
    if module == "skeleton" and header == "skeleton/build.h" and name != "skeleton/build/build.cpp":
        return "in skeleton itself"
    if name == "skeleton/graph.h" and parts[0] == "skeleton":
        return "below the graph"
    return None


def units(includes):
    """Unit -> the units it includes."""

    def unit(name):
        parts = name.split("/")
        stem = parts[-1].rsplit(".", 1)[0]
        if f"{parts[0]}/{stem}.h" in includes:
            return f"{parts[0]}/{stem}"
        return "/".join(parts[:-1] + [stem])

    graph = collections.defaultdict(set)
    for name, headers in includes.items():
        graph[unit(name)] |= {unit(h) for h in headers if h in includes} - {unit(name)}
    return graph


def circles(graph):
    """Strongly connected components of more than one unit (Tarjan 1972)."""
    number, low, stack, found = {}, {}, [], []

    def visit(v):
        number[v] = low[v] = len(number)
        stack.append(v)
        for w in graph[v]:
            if w not in number:
                visit(w)
                low[v] = min(low[v], low[w])
            elif w in stack:
                low[v] = min(low[v], number[w])
        if low[v] == number[v]:
            component = stack[stack.index(v):]
            del stack[stack.index(v):]
            if len(component) > 1:
                found.append(component)

    sys.setrecursionlimit(10000)
    for v in list(graph):
        if v not in number:
            visit(v)
    return found


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
