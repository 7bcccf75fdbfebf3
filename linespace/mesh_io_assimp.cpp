// glTF, IFC, AC3D and the other scene formats, through assimp.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "linespace/mesh_io_internal.h"
#include "linespace/mesh_io_nodes_internal.h"

#ifdef SIGHTLINE_HAS_ASSIMP
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
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

}  // namespace

PolygonSoup read_with_assimp(const std::string& path, const std::string& extension) {
  const auto known = assimp_extensions();
  if (!std::binary_search(known.begin(), known.end(), extension)) {
    refuse(path, "no mesh format is known by the extension " + quoted(extension));
  }
  if (extension == "ifc") check_step(path, load_file(path));
  try {
    Assimp::Importer importer;
    // Polygons stay whole where the format has them: Scene cuts them exactly.
    const aiScene* const scene = importer.ReadFile(path, 0);
    if (scene == nullptr) refuse(path, one_line(importer.GetErrorString()));
    return SceneWalker(path, *scene).walk(extension == "ifc" || extension == "ifczip");
  } catch (const InvalidInput&) {
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

PolygonSoup read_with_assimp(const std::string& path, const std::string& extension) {
  refuse(path, "the format " + quoted(extension) +
                   " needs assimp, which this build is without");
}

std::vector<std::string> assimp_extensions() { return {}; }

#endif

}  // namespace sightline::internal
