// The files that commands read beside scenes: JSON questions and saved skeletons.

#pragma once

#include <string>

namespace sightline::fuzz {

/// The questions of `stab`, `transversals`, `visible` and `look`, up to where computing
/// begins.
void run_portals(const std::string& bytes);
void run_transversals(const std::string& bytes);
void run_look(const std::string& bytes);
void run_visible(const std::string& bytes);
/// A path of `look`.
void run_path(const std::string& bytes);
/// Points that ask for light in the room (examples/scenes/room.obj): JSON where the bytes
/// begin with '{', else text.
void run_points(const std::string& bytes);
/// A saved aspect graph, up to where its views are taken.
void run_aspects(const std::string& bytes);
/// A saved skeleton of the room (examples/scenes/room.obj), read as if its checksum and
/// its fingerprint were right, so that the parser is reached and ids meet the scene's.
void run_skeleton(const std::string& bytes);

}  // namespace sightline::fuzz
