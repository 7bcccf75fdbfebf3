#!/usr/bin/env python3
"""Draws docs/pictures/node_catalogue.svg: each kind of node with the arcs that end there.

  python3 docs/pictures/node_catalogue.py > docs/pictures/node_catalogue.svg

Left, the extremal stabbing line with its contacts; right, the node as a point and the
arcs that end there as curves, those that pass dashed.
"""

EV, EEE, PASS = "#e69f00", "#0072b2", "#888888"
WIDTH, HEIGHT = 430, 128

# kind; contacts along the line: 'v' a corner, 'e' an edge, 'F' a face crossed along its plane;
# ends: (colour, label); passing: labels
NODES = [
    ("VV", [("v", "u"), ("v", "v")],
     [(EV, "u a1"), (EV, "u a2"), (EV, "v b1"), (EV, "v b2")], []),
    ("VEE", [("v", "v"), ("e", "e"), ("e", "f")],
     [(EV, "v f"), (EEE, "a1 e f"), (EEE, "a2 e f")], ["v e"]),
    ("EVE", [("e", "e"), ("v", "v"), ("e", "f")],
     [(EEE, "e a1 f"), (EEE, "e a2 f")], ["v e", "v f"]),
    ("EEEE", [("e", "a"), ("e", "b"), ("e", "c"), ("e", "d")],
     [(EEE, "a b d"), (EEE, "a c d")], ["a b c", "b c d"]),
    ("FvE", [("Fv", "F"), ("e", "e")], [(EV, "v e")], []),
    ("FEE", [("F", "F"), ("e", "e"), ("e", "f")],
     [(EEE, "s1 e f"), (EEE, "s2 e f")], []),
    ("FF", [("F", "F"), ("F", "G")], [], []),
]


def text(x, y, s, size=12, anchor="middle", colour="#222"):
    return (f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" text-anchor="{anchor}" '
            f'fill="{colour}">{s}</text>')


def line(x0, y0, x1, y1, colour="#222", width=1.5, dash=""):
    extra = f' stroke-dasharray="{dash}"' if dash else ""
    return (f'<line x1="{x0:.1f}" y1="{y0:.1f}" x2="{x1:.1f}" y2="{y1:.1f}" '
            f'stroke="{colour}" stroke-width="{width}"{extra}/>')


def polygon(points, fill):
    path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    return f'<polygon points="{path}" fill="{fill}" stroke="#666"/>'


def contact(kind, label, x, y, below):
    """A solid that the line grazes at (x, y), below the line or above it."""
    d = 1 if below else -1
    out = []
    if kind == "v":
        out.append(polygon([(x, y), (x - 20, y + 26 * d), (x + 20, y + 26 * d)], "#e8e8e8"))
        out.append(f'<circle cx="{x}" cy="{y}" r="3" fill="#222"/>')
    elif kind == "e":
        # An edge seen nearly along: a wedge with a stroke for the edge.
        out.append(polygon([(x - 4, y - 7), (x + 4, y + 7), (x + 18, y + 26 * d + 7),
                            (x - 18, y + 26 * d - 7)], "#e8e8e8"))
        out.append(line(x - 4, y - 7, x + 4, y + 7, width=3))
    else:
        out.append(polygon([(x - 22, y), (x + 22, y), (x + 14, y + 26 * d),
                            (x - 14, y + 26 * d)], "#d6e6f2"))
        out.append(line(x - 22, y, x + 22, y, width=3))
        if kind == "Fv":
            out.append(f'<circle cx="{x + 22}" cy="{y}" r="3.5" fill="#222"/>')
            out.append(text(x + 24, y - 8 * d + 4, "v", 11))
    out.append(text(x, y + 40 * d + 4, label, 12))
    return out


def node(kind, contacts, ends, passing, x0, y0):
    out = [text(x0 + 10, y0 + 20, kind, 15, "start")]
    y = y0 + 64
    out.append(line(x0 + 16, y, x0 + 236, y, "#222", 1))
    for i, (what, label) in enumerate(contacts):
        x = x0 + 126 + (i - (len(contacts) - 1) / 2) * (160 / max(1, len(contacts) - 1)) * 0.95
        out += contact(what, label, x, y, i % 2 == 0)
    cx, cy = x0 + 330, y
    places = {1: [(-50, 0)], 2: [(-50, 0), (50, 0)], 3: [(-50, 0), (42, -30), (42, 30)],
              4: [(-45, -30), (-45, 30), (45, -30), (45, 30)]}.get(len(ends), [])
    for (colour, label), (dx, dy) in zip(ends, places):
        out.append(line(cx, cy, cx + dx, cy + dy, colour, 3))
        out.append(text(cx + dx * 1.12, cy + dy * 1.1 + (4 if dy >= 0 else -2), label, 11,
                        "end" if dx < 0 else "start", colour))
    for k, label in enumerate(passing):
        dx = -22 if k == 0 else 22
        out.append(line(cx - dx, cy - 40, cx + dx, cy + 40, PASS, 1.5, "4 3"))
        out.append(text(cx - dx, cy - 45, label, 10, "middle", PASS))
    out.append(f'<circle cx="{cx}" cy="{cy}" r="5" fill="#222"/>')
    if not ends:
        out.append(text(cx, cy + 24, "no EV, no EEE", 11, "middle", PASS))
    return out


def main():
    columns = 2
    rows = (len(NODES) + columns) // columns
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH * columns} '
           f'{HEIGHT * rows}" font-family="sans-serif">',
           f'<rect width="{WIDTH * columns}" height="{HEIGHT * rows}" fill="white"/>']
    for i, (kind, contacts, ends, passing) in enumerate(NODES):
        out += node(kind, contacts, ends, passing, WIDTH * (i % columns),
                    HEIGHT * (i // columns))
    x, y = WIDTH + 30, HEIGHT * (rows - 1) + 40
    for colour, dash, label in [(EV, "", "EV arc that ends here: vertex, edge"),
                                (EEE, "", "EEE arc that ends here: three edges in order"),
                                (PASS, "4 3", "arc that passes: its span is not touched")]:
        out.append(line(x, y, x + 40, y, colour, 3 if not dash else 1.5, dash))
        out.append(text(x + 50, y + 4, label, 12, "start"))
        y += 24
    out.append("</svg>")
    print("\n".join(out))


if __name__ == "__main__":
    main()
