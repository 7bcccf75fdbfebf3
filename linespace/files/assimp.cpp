// IFC, AC3D and other scene formats through assimp, in a process of its own.

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <set>
#include <string_view>

#include "linespace/files/child.h"
#include "linespace/files/mesh_io.h"
#include "linespace/files/nodes.h"

#ifdef SIGHTLINE_HAS_ASSIMP
#include <assimp/config.h>
#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>
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
// own flattening does in single precision, and their names make the groups.
class SceneWalker {
 public:
  SceneWalker(const std::string& path, const aiScene& scene)
      : path_(path), scene_(scene) {}

  PolygonSoup walk(bool is_ifc) {
    if (scene_.mRootNode != nullptr) {
      const Eigen::Affine3d root = transformation(scene_.mRootNode->mTransformation);
      visit(*scene_.mRootNode, is_ifc ? upright(root) : root);
    }
    soup_.groups = groups_.groups();
    return std::move(soup_);
  }

 private:
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
    groups_.add(node.mName.C_Str(), first, last, node.mParent == nullptr);
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
  NodeGroups groups_;
};

// Those formats of assimp whose readers neither crashed nor hung on damaged copies, and
// IFC.
constexpr std::array<std::string_view, 8> kExtensions{"3ds", "ac",  "dae", "dxf",
                                                      "fbx", "ifc", "lwo", "x"};

// Gathers what assimp says of a file; of messages that differ in numbers only, the first.
class Complaints : public Assimp::LogStream {
 public:
  void write(const char* message) override {
    constexpr std::size_t kMost = 20;
    std::string text = one_line(message);  // "Warn,  T0: IFC: ..."
    if (const std::size_t at = text.find(": "); at != std::string::npos) {
      text.erase(0, at + 2);
    }
    std::string kind = text;
    std::erase_if(kind, [](unsigned char c) { return std::isdigit(c) != 0; });
    if (defects_.size() < kMost && kinds_.insert(kind).second) {
      defects_.push_back({"reader's warning", text, {}, {}});
    }
  }
  [[nodiscard]] const std::vector<Defect>& defects() const { return defects_; }

 private:
  std::set<std::string> kinds_;
  std::vector<Defect> defects_;
};

bool is_ifc(const AssimpFile& file) { return file.format == "ifc"; }

// To be called in a process of its own.
PolygonSoup read_scene(const AssimpFile& file) {
  const std::string& path = file.path;
  Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0, nullptr);
  auto* const complaints = new Complaints;  // the logger owns it
  Assimp::DefaultLogger::get()->attachStream(complaints,
                                             Assimp::Logger::Warn | Assimp::Logger::Err);
  try {
    Assimp::Importer importer;
    // Otherwise a file without faces gets pyramids where its bones might be.
    importer.SetPropertyInteger(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, 1);
    // Polygons stay whole where the format has them: Scene cuts them exactly.
    const aiScene* const scene =
        file.by_name ? importer.ReadFile(path, 0)
                     : importer.ReadFileFromMemory(file.bytes.data(), file.bytes.size(),
                                                   0, file.format.c_str());
    if (scene == nullptr) refuse(path, one_line(importer.GetErrorString()));
    PolygonSoup soup = SceneWalker(path, *scene).walk(is_ifc(file));
    soup.defects = complaints->defects();
    return soup;
  } catch (const InvalidInput&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    refuse(path, "cannot be read: " + one_line(error.what()));
  }
}

}  // namespace

PolygonSoup read_with_assimp(const AssimpFile& file, Stage& stage) {
  if (is_ifc(file)) check_step(file.path, file.bytes, stage);
  if (file.format == "dae") check_collada(file.path, file.bytes, stage);
  return read_in_child(
      file.path, file.bytes.size(), [&] { stage.check(0); },
      [&] { return read_scene(file); });
}

std::vector<std::string> assimp_extensions() {
  return {kExtensions.begin(), kExtensions.end()};
}

#else

PolygonSoup read_with_assimp(const AssimpFile& file, Stage&) {
  refuse(file.path, "the format " + quoted(file.format) +
                        " needs assimp, which this build is without");
}

std::vector<std::string> assimp_extensions() { return {}; }

#endif

}  // namespace sightline::internal
