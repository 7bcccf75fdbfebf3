// Discontinuity meshes as VTK files.

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "shadows/shadow_mesh.h"
#include "shadows/shadow_volumes.h"

namespace sightline::viewers {

/// Writes into `folder` the scene, as write_vtk() does, and
///   shadow_faces.vtp     the faces of all meshes, curves as chords; cell arrays receiver
///                        (name), facet, face, class, structure, area (scene units
///                        squared).  A face that is not convex is cut into triangles and
///                        trapezoids; `face` tells which belong together
///   shadow_edges.vtp     their edges, a line for each chord; receiver, facet, edge,
///   kind,
///                        order (-1 for none), left, right
///   shadow_vertices.vtp  their vertices; receiver, facet, vertex
/// and with volumes
///   shadow_umbra.vtp, shadow_penumbra.vtp
///                        their surfaces, a polygon each side; side, kind, generators
/// Numbers are those of the answer, `colour` is RGB.  The index sightline.vtm holds all.
/// Returns the names of the files.  Of the request, stop, budget and progress count:
/// throws Stopped.  Throws OutputError and WriteError.
std::vector<std::string> write_vtk_shadows(const std::filesystem::path& folder,
                                           const Scene& scene, const Shadows& shadows,
                                           const ShadowVolumes* volumes = nullptr,
                                           const Request& request = {});

}  // namespace sightline::viewers
