// Mesh files to polygons, in doubles as the file writes them.
//
// OBJ, PLY (ASCII and binary), STL (ASCII and binary) and OFF are read here, strictly: a
// file that ends early, holds garbage or announces more than it has is refused with its
// line or element.  glTF, IFC, AC3D and others go through assimp where the build found
// it; that library keeps single precision.  IFC models stay upright (z up) as their file
// has them, without rooms.  An IFC file that is well-formed but wrong in itself (a record
// of another type than its user expects) may crash assimp: read only files you trust.

#pragma once

#include <string>
#include <vector>

#include "linespace/request.h"
#include "linespace/scene.h"

namespace sightline {

/// The polygons of a mesh file, its format told by the extension.  Names of groups come
/// from `o` and `g` lines of OBJ, `solid` lines of ASCII STL and nodes of scene formats;
/// indices are not checked against the vertices where Scene will do so, save for OBJ,
/// whose message can name the line.  Throws InvalidInput with one line that names file
/// and line, byte or element; nothing is allocated beyond a small multiple of the file's
/// size.  Of the request, budget, stop and progress count; throws Stopped.
[[nodiscard]] PolygonSoup read_mesh(const std::string& path, const Request& request = {});

/// Extensions that read_mesh knows in this build, in lower case, without dot, sorted.
[[nodiscard]] std::vector<std::string> readable_extensions();

}  // namespace sightline
