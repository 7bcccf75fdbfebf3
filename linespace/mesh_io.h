// Mesh files to polygons, in doubles as the file writes them.
//
// OBJ, PLY (ASCII and binary, polygons and triangle strips), STL (ASCII and binary) and
// OFF are read here, strictly: a file that ends early, holds garbage or announces more
// than it has is refused with its line or element.  What is not used, such as normals,
// may hold any number, nan and inf too; a UTF-8 byte order mark may stand before a text.
// Names keep the bytes of the file.
//
// glTF 2 (.gltf, .glb) comes through tinygltf where the build found it: the scene that
// the file names, else its first one, else all nodes.  Positions are the file's floats or
// integers (KHR_mesh_quantization); the transformations of nodes are composed in double,
// and a turn that is a right angle in single precision is one.  Points and lines are no
// faces.  Refused by name: what would be misread, such as compressed meshes, instances,
// skins, morph targets, nodes that form no tree, any other extension that is required.
//
// IFC 2x3, and .3ds, .ac, .dae, .dxf, .fbx, .lwo and .x, go through assimp where the
// build found it; that library keeps single precision.  IFC models stay upright (z up) as
// their file has them, without rooms; records of a name that IFC does not have are
// refused. assimp runs in a child process (fork): when it crashes, takes more than 10 s
// of processor time and 10 s for each megabyte of the file, or more than 1 GiB and 1 KiB
// for each byte, the file is refused.  What assimp itself complains of is told as
// defects.  Read such files before other threads work: a lock that one of them holds at
// the fork would keep the child waiting.

#pragma once

#include <string>
#include <vector>

#include "linespace/request.h"
#include "linespace/scene.h"

namespace sightline {

/// What a mesh file says.
struct MeshFile : PolygonSoup {
  /// Polygons whose material emits light, ascending: glTF, an emissiveFactor above 0.
  std::vector<int> emitting;
};

/// The polygons of a mesh file, its format told by the extension, or by `format`, an
/// extension too; "-" is standard input.  Names of groups come
/// from `o` and `g` lines of OBJ, `solid` lines of ASCII STL and nodes of scene formats;
/// defects tell what the file has and the polygons lack ("spare bytes" after binary STL,
/// meshes "left out" of the scene that is read); indices are not checked against the
/// vertices where Scene will do so, save for OBJ, whose message can name the line. Throws
/// InvalidInput with one line that names file and line, byte or element; nothing is
/// allocated beyond a small multiple of the file's size.  Of the request, budget, stop
/// and progress count; throws Stopped.
[[nodiscard]] MeshFile read_mesh(const std::string& path, const Request& request = {},
                                 const std::string& format = {});

/// Files that read_mesh would read besides this one: the buffers of glTF.  None where it
/// would refuse the file.
[[nodiscard]] std::vector<std::string> files_beside(const std::string& path);

/// Extensions that read_mesh knows in this build, in lower case, without dot, sorted.
[[nodiscard]] std::vector<std::string> readable_extensions();

}  // namespace sightline
