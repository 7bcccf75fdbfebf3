// The nodes of a view by all contacts of their lines, also of those beyond the arcs.

#pragma once

#include "linespace/silhouettes/silhouettes.h"
#include "skeleton/build/vertex_view.h"

namespace sightline::internal {

class KnownLines;

/// Looks at nodes of a view along their whole maximal free segments: those with more
/// contacts than their kind has become Degenerate, with all generators listed from the
/// end with the smaller one.  Looked at are nodes found among zero signs, and all that
/// `probe` is not certain of: whatever else was asked for, so that a part names its nodes
/// as the whole does.
void find_further_contacts(const Silhouettes& silhouettes, const Star& star,
                           LineProbe& probe, KnownLines& known, VertexView& view);

}  // namespace sightline::internal
