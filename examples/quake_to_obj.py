#!/usr/bin/env python3
"""Turns the drawn faces of a Quake 3 map into an OBJ file that sightline reads.

    apt-get download openarena-081-maps && dpkg -x openarena-081-maps_*.deb oa
    examples/quake_to_obj.py oa/usr/share/games/openarena/baseoa/pak1-maps.pk3 \\
        maps/oa_dm4.bsp oa_dm4.obj

The map is an IBSP file of version 46, alone or in a .pk3 (a zip).  Written are the faces
of types 1 (polygons) and 3 (meshes), as the triangles of their mesh vertices, of model 0,
the world; curved patches (type 2) are left out, and so is what the map does not draw
(shaders whose surface flags say NODRAW or SKY).  There are no groups, so that walls which
meet are one object; the triangles of one face of the map follow each other.  Quake's front
is clockwise: it is turned.  Coordinates are as in the file, in Quake units.
"""

import struct
import sys
import zipfile

NODRAW, SKY = 0x80, 0x4


def read_map(argv):
    if len(argv) == 4:
        return zipfile.ZipFile(argv[1]).read(argv[2])
    with open(argv[1], "rb") as file:
        return file.read()


def main(argv):
    if len(argv) not in (3, 4):
        sys.exit(__doc__)
    data = read_map(argv)
    if data[:4] != b"IBSP" or struct.unpack_from("<i", data, 4)[0] != 46:
        sys.exit("not an IBSP file of version 46")

    def lump(number):
        offset, length = struct.unpack_from("<2i", data, 8 + 8 * number)
        return data[offset : offset + length]

    shaders, models, vertices, mesh, faces = map(lump, (1, 7, 10, 11, 13))
    first_face, face_count = struct.unpack_from("<2i", models, 24)
    ids, lines, triangles, drawn = {}, [], [], 0
    for number in range(first_face, first_face + face_count):
        shader, _, kind, vertex, _, corner, corners = struct.unpack_from(
            "<7i", faces, 104 * number
        )
        flags = struct.unpack_from("<i", shaders, 72 * shader + 64)[0]
        if kind not in (1, 3) or flags & (NODRAW | SKY):
            continue
        drawn += 1
        for k in range(corner, corner + corners, 3):
            points = []
            for offset in struct.unpack_from("<3i", mesh, 4 * k):
                point = struct.unpack_from("<3f", vertices, 44 * (vertex + offset))
                if point not in ids:
                    ids[point] = len(ids) + 1
                    lines.append("v %.9g %.9g %.9g" % point)
                points.append(ids[point])
            if len(set(points)) == 3:
                triangles.append("f %d %d %d" % (points[0], points[2], points[1]))
    with open(argv[-1], "w") as out:
        out.write("\n".join(lines + triangles) + "\n")
    print(f"{len(ids)} vertices, {len(triangles)} triangles of {drawn} faces")


if __name__ == "__main__":
    main(sys.argv)
