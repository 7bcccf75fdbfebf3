// Small files of the scene formats that assimp reads, as trees of parts, so that a test
// can take parts away and know what is left.

#pragma once

#include <random>
#include <string>
#include <vector>

namespace sightline::test {

/// A part of a file: what stands before and behind the parts within it.  In chunked
/// formats `head` begins with the chunk's name, and sizes are counted when it is written.
struct FilePart {
  std::string head;
  std::vector<FilePart> parts = {};
  std::string tail = "";
};

enum class PartStyle { Text, Chunks3ds, ChunksIff };

struct PartedFile {
  std::string extension;
  PartStyle style = PartStyle::Text;
  FilePart root;

  [[nodiscard]] std::string bytes() const;
  /// How many parts there are below the root, of any depth.
  [[nodiscard]] int count() const;
  /// Takes away the part of this number, in the order of the file, with all within it.
  void remove(int part);
};

/// A cube from 0 to 1, its faces squares or pairs of triangles, in each format: ac, dae,
/// dxf, fbx, lwo, x, 3ds; and `ifc`, the records of that file.
[[nodiscard]] std::vector<PartedFile> parted_files(const std::string& ifc);

}  // namespace sightline::test
