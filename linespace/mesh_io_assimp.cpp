// glTF, IFC, AC3D and the other scene formats, through assimp.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "linespace/mesh_io_internal.h"

#ifdef SIGHTLINE_HAS_ASSIMP
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <unordered_map>
#endif

namespace sightline::internal {

#ifdef SIGHTLINE_HAS_ASSIMP
namespace {

Eigen::Affine3d transformation(const aiMatrix4x4& m) {
  Eigen::Affine3d t;
  t.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4,
      m.d1, m.d2, m.d3, m.d4;
  return t;
}

// assimp turns IFC models by a quarter around x, with a cosine of -4.4e-8 in single
// precision, which would skew whatever is aligned.  Turned back exactly, with what that
// cosine left behind removed: entries under 2^-24 of the largest.
Eigen::Affine3d upright(const Eigen::Affine3d& root) {
  Eigen::Matrix4d back;
  back << 1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1;
  Eigen::Affine3d t(back * root.matrix());
  const double least = 0x1p-24 * t.linear().cwiseAbs().maxCoeff();
  t.linear() =
      t.linear().unaryExpr([least](double x) { return std::abs(x) < least ? 0 : x; });
  return t;
}

// Walks the tree of nodes: their transformations are composed in double, which assimp's
// own flattening does in single precision, and their names make the groups.  A node's
// group has the faces of all nodes below it.
class SceneWalker {
 public:
  SceneWalker(const std::string& path, const aiScene& scene)
      : path_(path), scene_(scene) {}

  PolygonSoup walk(bool is_ifc) {
    if (scene_.mRootNode != nullptr) {
      const Eigen::Affine3d root = transformation(scene_.mRootNode->mTransformation);
      visit(*scene_.mRootNode, is_ifc ? upright(root) : root);
    }
    name_groups();
    return std::move(soup_);
  }

 private:
  // The faces [first, last) of a node and of all below it.
  struct NamedRange {
    std::string name;
    int first, last;
    bool is_root;
  };

  void visit(const aiNode& node, const Eigen::Affine3d& to_world) {
    const int first = static_cast<int>(soup_.polygons.size());
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      append(*scene_.mMeshes[node.mMeshes[i]], to_world);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) {
      const aiNode& child = *node.mChildren[i];
      visit(child, to_world * transformation(child.mTransformation));
    }
    const int last = static_cast<int>(soup_.polygons.size());
    const std::string name = node.mName.C_Str();
    if (last > first && !name.empty()) {
      ranges_.push_back({name, first, last, node.mParent == nullptr});
    }
  }

  // A face's object is the first group that lists it: of the nodes above it the nearest
  // whose name is its own; names that several nodes bear ("IfcMappedItem") and the root's
  // come last.  Children stand before their parents in `ranges_`.
  void name_groups() {
    std::unordered_map<std::string, int> uses;
    for (const auto& range : ranges_) ++uses[range.name];
    const auto rank = [&](const NamedRange& range) {
      return range.is_root ? 2 : uses[range.name] > 1 ? 1 : 0;
    };
    std::stable_sort(ranges_.begin(), ranges_.end(),
                     [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
    std::unordered_map<std::string, std::size_t> numbers;
    for (const auto& range : ranges_) {
      const auto [entry, is_new] = numbers.emplace(range.name, soup_.groups.size());
      if (is_new) soup_.groups.push_back({range.name, {}});
      auto& faces = soup_.groups[entry->second].faces;
      for (int f = range.first; f < range.last; ++f) faces.push_back(f);
    }
    for (auto& group : soup_.groups) {
      std::sort(group.faces.begin(), group.faces.end());
      group.faces.erase(std::unique(group.faces.begin(), group.faces.end()),
                        group.faces.end());
    }
  }

  void append(const aiMesh& mesh, const Eigen::Affine3d& to_world) {
    const int first = static_cast<int>(soup_.vertices.size());
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D& v = mesh.mVertices[i];
      soup_.vertices.push_back(to_world * Point(v.x, v.y, v.z));
    }
    const bool mirrored = to_world.linear().determinant() < 0;
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      if (face.mNumIndices < 3) continue;  // a point or a line
      std::vector<int> polygon;
      polygon.reserve(face.mNumIndices);
      for (unsigned j = 0; j < face.mNumIndices; ++j) {
        if (face.mIndices[j] >= mesh.mNumVertices) {
          refuse(path_, "face " + std::to_string(soup_.polygons.size()) +
                            " names a vertex that its mesh does not have");
        }
        polygon.push_back(first + static_cast<int>(face.mIndices[j]));
      }
      if (mirrored) std::reverse(polygon.begin(), polygon.end());
      soup_.polygons.push_back(std::move(polygon));
    }
  }

  const std::string& path_;
  const aiScene& scene_;
  PolygonSoup soup_;
  std::vector<NamedRange> ranges_;
};

std::uint64_t little_endian(std::string_view bytes, std::size_t at) {
  std::uint64_t value = 0;
  for (std::size_t i = 4; i-- > 0;) {
    value = 256 * value + static_cast<unsigned char>(bytes[at + i]);
  }
  return value;
}

// Refuses a binary glTF file that announces more bytes than it has: assimp makes room for
// what a chunk announces, gigabytes at worst, before it reads.  What is no binary glTF is
// left to assimp.  The first length of version 1 stands where that of version 2 does.
void check_glb(const std::string& path, std::string_view bytes) {
  constexpr std::size_t kHeader = 12;  // "glTF", version, bytes in all
  constexpr std::size_t kChunkHeader = 8;
  if (!bytes.starts_with("glTF")) return;
  const auto announces = [&](const std::string& what, std::uint64_t count,
                             std::uint64_t there) {
    if (count <= there) return;
    refuse(path, "announces " + what + std::to_string(count) + " bytes, but has " +
                     std::to_string(there));
  };
  if (bytes.size() < kHeader + kChunkHeader) refuse(path, "ends inside the header");
  announces("", little_endian(bytes, 8), bytes.size());
  const bool has_chunks = little_endian(bytes, 4) >= 2;
  std::size_t at = kHeader;
  do {
    const std::uint64_t length = little_endian(bytes, at);
    announces("a chunk of ", length, bytes.size() - at - kChunkHeader);
    at += kChunkHeader + (length + 3) / 4 * 4;  // chunks start at multiples of four
  } while (has_chunks && at + kChunkHeader <= bytes.size());
}

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

}  // namespace

PolygonSoup read_with_assimp(const std::string& path, const std::string& extension,
                             Stage& stage) {
  const auto known = assimp_extensions();
  if (!std::binary_search(known.begin(), known.end(), extension)) {
    refuse(path, "no mesh format is known by the extension " + quoted(extension));
  }
  if (extension == "ifc") check_step(path, load_file(path, stage));
  if (extension == "glb") check_glb(path, load_file(path, stage));
  try {
    Assimp::Importer importer;
    // Polygons stay whole where the format has them: Scene cuts them exactly.
    const aiScene* const scene = importer.ReadFile(path, 0);
    if (scene == nullptr) refuse(path, one_line(importer.GetErrorString()));
    stage.check(1);
    return SceneWalker(path, *scene).walk(extension == "ifc" || extension == "ifczip");
  } catch (const InvalidInput&) {
    throw;
  } catch (const Stopped&) {
    throw;
  } catch (const std::exception& error) {
    refuse(path, "cannot be read: " + one_line(error.what()));
  }
}

std::vector<std::string> assimp_extensions() {
  aiString list;
  Assimp::Importer().GetExtensionList(list);  // "*.3ds;*.ac;..."
  std::vector<std::string> extensions;
  std::string_view rest = list.C_Str();
  while (!rest.empty()) {
    const std::size_t end = rest.find(';');
    const std::string_view item = rest.substr(0, end);
    if (item.starts_with("*.")) extensions.emplace_back(item.substr(2));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  }
  std::sort(extensions.begin(), extensions.end());
  return extensions;
}

#else

PolygonSoup read_with_assimp(const std::string& path, const std::string& extension,
                             Stage&) {
  refuse(path, "the format " + quoted(extension) +
                   " needs assimp, which this build is without");
}

std::vector<std::string> assimp_extensions() { return {}; }

#endif

}  // namespace sightline::internal
