// Discontinuity meshes as blocks of VTK files.

#pragma once

#include <map>
#include <string>

#include "shadows/shadow_mesh.h"
#include "shadows/shadow_volumes.h"
#include "viewers/files/vtk_cells.h"

namespace sightline::viewers {

/// Adds the blocks shadow_faces, shadow_edges and shadow_vertices, as write_vtk() tells
/// of them.  Throws Stopped.
void add_shadow_blocks(std::map<std::string, Cells>& blocks, const Shadows& shadows,
                       internal::Stage& stage);
/// Adds shadow_umbra and shadow_penumbra.
void add_volume_blocks(std::map<std::string, Cells>& blocks,
                       const ShadowVolumes& volumes);

}  // namespace sightline::viewers
