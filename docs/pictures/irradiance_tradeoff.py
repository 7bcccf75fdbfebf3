#!/usr/bin/env python3
"""Draws irradiance_tradeoff.svg from the table in docs/irradiance.md.

  python3 docs/pictures/irradiance_tradeoff.py
"""

import math
import pathlib

HERE = pathlib.Path(__file__).resolve().parent
COLOURS = {"linear": "#d08000", "quadratic": "#2060c0", "rays": "#888888", "closed form": "#208040"}
LEFT, TOP, WIDTH, HEIGHT = 70, 20, 540, 320
TIMES, ERRORS = (-0.5, 4.0), (-12.5, 0.0)  # powers of ten


def place(time, error):
    x = (math.log10(time) - TIMES[0]) / (TIMES[1] - TIMES[0])
    y = (math.log10(error) - ERRORS[0]) / (ERRORS[1] - ERRORS[0])
    return LEFT + x * WIDTH, TOP + (1 - y) * HEIGHT


def rows():
    found = {}
    exact = 0.0
    for line in (HERE.parent / "irradiance.md").read_text().splitlines():
        cells = [c.strip() for c in line.strip("|").split("|")]
        if len(cells) != 4:
            continue
        name = cells[0].split(",")[0]
        if name == "exact" and cells[1][:1].isdigit():
            exact = float(cells[1])
        elif name in COLOURS:
            found.setdefault(name, []).append((float(cells[1]), float(cells[2])))
    return exact, found


def main():
    exact, found = rows()
    out = ['<svg xmlns="http://www.w3.org/2000/svg" width="640" height="400" '
           'font-family="sans-serif" font-size="12">',
           '<rect width="640" height="400" fill="white"/>']
    for power in range(0, 5):
        x, _ = place(10**power, 1)
        out.append(f'<path d="M{x:.1f} {TOP}V{TOP + HEIGHT}" stroke="#ddd"/>'
                   f'<text x="{x:.1f}" y="358" text-anchor="middle">{10**power}</text>')
    for power in range(-12, 1, 2):
        _, y = place(1, 10**power)
        out.append(f'<path d="M{LEFT} {y:.1f}H{LEFT + WIDTH}" stroke="#ddd"/>'
                   f'<text x="{LEFT - 8}" y="{y + 4:.1f}" text-anchor="end">1e{power}</text>')
    out.append('<text x="340" y="382" text-anchor="middle">seconds of the processor for '
               '10^5 points, building included</text>'
               '<text transform="translate(16 180) rotate(-90)" text-anchor="middle">'
               'root mean square error over the mean</text>')
    x, _ = place(exact, 1)
    out.append(f'<path d="M{x:.1f} {TOP}V{TOP + HEIGHT}" stroke="#c03030" '
               f'stroke-dasharray="5 4"/><text x="{x + 5:.1f}" y="215" fill="#c03030">'
               'exact, point by point</text>')
    for name, points in found.items():
        at = [place(*p) for p in points]
        path = "M" + " L".join(f"{x:.1f} {y:.1f}" for x, y in at)
        out.append(f'<path d="{path}" fill="none" stroke="{COLOURS[name]}"/>')
        out += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.5" fill="{COLOURS[name]}"/>'
                for x, y in at]
    labels = {"rays": (430, 70, "random rays, 10 to 10^5"), "linear": (188, 92, "linear"),
              "quadratic": (188, 222, "quadratic"), "closed form": (180, 330, "closed form")}
    for name, (x, y, text) in labels.items():
        out.append(f'<text x="{x}" y="{y}" fill="{COLOURS[name]}">{text}</text>')
    out.append("</svg>")
    (HERE / "irradiance_tradeoff.svg").write_text("\n".join(out) + "\n")


if __name__ == "__main__":
    main()
