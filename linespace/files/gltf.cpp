// glTF 2 (.gltf, .glb) through tinygltf: the meshes of the nodes of one scene.
//
// Coordinates stay doubles: positions are taken as the file's floats or integers say, and
// the transformations of the nodes are composed in double.

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <span>

#include "linespace/files/mesh_io.h"

#ifdef SIGHTLINE_HAS_TINYGLTF
#include <tiny_gltf.h>

#include "linespace/files/gltf.h"
#include "linespace/files/nodes.h"
#endif

namespace sightline::internal {

#ifdef SIGHTLINE_HAS_TINYGLTF
namespace {

// The files beside a .gltf that hold its buffers.
struct BufferFiles {
  std::string folder;
  std::vector<std::size_t> sizes;  // of the buffers, in the order in which they are read
  std::size_t next = 0;
};

// tinygltf also looks in the folder of the process: that would be another file.
bool file_exists(const std::string& file, void* data) {
  const auto& files = *static_cast<const BufferFiles*>(data);
  std::error_code error;
  return file.starts_with(files.folder + "/") &&
         std::filesystem::is_regular_file(file, error);
}

std::string same_path(const std::string& file, void*) { return file; }

// The bytes of a buffer; those behind it in the file are padding.
bool read_buffer(std::vector<unsigned char>* bytes, std::string* error,
                 const std::string& file, void* data) {
  auto& files = *static_cast<BufferFiles*>(data);
  std::ifstream in(file, std::ios::binary);
  std::error_code no_size;
  const std::uintmax_t there = std::filesystem::file_size(file, no_size);
  if (!in || no_size || files.next >= files.sizes.size()) {
    *error = "cannot be read";
    return false;
  }
  bytes->resize(std::min<std::uintmax_t>(there, files.sizes[files.next++]));
  in.read(reinterpret_cast<char*>(bytes->data()),
          static_cast<std::streamsize>(bytes->size()));
  return in.good() || bytes->empty();
}

bool no_writing(std::string*, const std::string&, const std::vector<unsigned char>&,
                void*) {
  return false;
}

void append_little_endian(std::string& bytes, std::size_t value) {
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> 8 * i & 0xFF);
}

void append_chunk(std::string& bytes, const char* kind, std::string_view content,
                  char padding) {
  append_little_endian(bytes, (content.size() + 3) / 4 * 4);
  bytes.append(kind, 4).append(content);
  while (bytes.size() % 4 != 0) bytes += padding;
}

// The checked file as a .glb again.
std::string binary_gltf(const CheckedGltf& checked) {
  std::string chunks;
  append_chunk(chunks, "JSON", checked.json, ' ');
  append_chunk(chunks, "BIN\0", checked.binary, '\0');
  std::string bytes = "glTF";
  append_little_endian(bytes, 2);
  append_little_endian(bytes, bytes.size() + 4 + chunks.size());
  return bytes + chunks;
}

tinygltf::Model load_model(const std::string& path, const CheckedGltf& checked) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  BufferFiles files{folder.empty() ? "." : folder, checked.file_sizes};
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks({file_exists, same_path, read_buffer, no_writing, &files});
  tinygltf::Model model;
  std::string error, warning;
  bool loaded = false;
  const std::string bytes = checked.binary.empty() ? checked.json : binary_gltf(checked);
  if (bytes.size() > std::numeric_limits<unsigned>::max()) refuse(path, "is too large");
  const auto size = static_cast<unsigned>(bytes.size());
  if (checked.binary.empty()) {
    loaded = loader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size,
                                        files.folder);
  } else {
    loaded = loader.LoadBinaryFromMemory(
        &model, &error, &warning, reinterpret_cast<const unsigned char*>(bytes.data()),
        size, files.folder);
  }
  if (!loaded || !error.empty()) refuse(path, "cannot be read: " + one_line(error));
  return model;
}

std::string named(const char* what, int number, const std::string& name) {
  std::string text = what + (" " + std::to_string(number));
  return name.empty() ? text : text + " " + internal::quoted(name);
}

// Values of an accessor, checked against the bytes that it may read.
class Values {
 public:
  // `of` names the mesh.
  Values(const std::string& path, const tinygltf::Model& model, int accessor,
         std::string of)
      : path_(path), model_(model), of_(std::move(of)) {
    if (accessor >= static_cast<int>(model.accessors.size())) {
      fail("names accessor " + std::to_string(accessor) + " of " +
           std::to_string(model.accessors.size()));
    }
    accessor_ = &model.accessors[static_cast<std::size_t>(accessor)];
    what_ = "accessor " + std::to_string(accessor);
    bytes_per_component_ = bytes_of(accessor_->componentType);
    components_ = static_cast<std::size_t>(
        tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor_->type)));
    if (accessor_->bufferView >= 0) {
      dense_ = part(accessor_->bufferView, accessor_->byteOffset, accessor_->count,
                    element_bytes(), true);
    } else if (!accessor_->sparse.isSparse) {
      fail(what_ + " has no data");
    }
    if (accessor_->sparse.isSparse) read_sparse();
  }

  [[nodiscard]] std::size_t count() const { return accessor_->count; }
  [[nodiscard]] int type() const { return accessor_->type; }
  [[nodiscard]] int component_type() const { return accessor_->componentType; }

  // Component k of element i, as a number of the file; integers are divided where the
  // accessor is normalized.
  [[nodiscard]] double real(std::size_t i, std::size_t k) const {
    const unsigned char* const at = element(i) + k * bytes_per_component_;
    switch (accessor_->componentType) {
      case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return static_cast<double>(
            std::bit_cast<float>(static_cast<std::uint32_t>(unsigned_at(at, 4))));
      case TINYGLTF_COMPONENT_TYPE_BYTE:
        return scaled(static_cast<std::int8_t>(unsigned_at(at, 1)), 127);
      case TINYGLTF_COMPONENT_TYPE_SHORT:
        return scaled(static_cast<std::int16_t>(unsigned_at(at, 2)), 32767);
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return scaled(static_cast<double>(unsigned_at(at, 1)), 255);
      default:
        return scaled(static_cast<double>(unsigned_at(at, 2)), 65535);
    }
  }

  // Element i of whole numbers.
  [[nodiscard]] std::size_t whole(std::size_t i) const {
    return unsigned_at(element(i), bytes_per_component_);
  }

  [[noreturn]] void fail(const std::string& message) const {
    refuse(path_, of_ + ": " + message);
  }

 private:
  // Elements in a buffer.
  struct Part {
    const unsigned char* data = nullptr;
    std::size_t stride = 0;
  };

  std::size_t bytes_of(int component_type) const {
    switch (component_type) {
      case TINYGLTF_COMPONENT_TYPE_BYTE:
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return 1;
      case TINYGLTF_COMPONENT_TYPE_SHORT:
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return 2;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return 4;
      default:
        fail(what_ + " has numbers of a type that the format does not have: " +
             std::to_string(component_type));
    }
  }

  [[nodiscard]] std::size_t element_bytes() const {
    return bytes_per_component_ * components_;
  }

  // Where `count` elements lie.  All sizes are at most 2^53 and strides at most 252, so
  // nothing overflows.
  Part part(int view_number, std::size_t offset, std::size_t count, std::size_t bytes,
            bool may_stride) const {
    if (view_number < 0 || view_number >= static_cast<int>(model_.bufferViews.size())) {
      fail(what_ + " names bufferView " + std::to_string(view_number) + " of " +
           std::to_string(model_.bufferViews.size()));
    }
    const auto& view = model_.bufferViews[static_cast<std::size_t>(view_number)];
    if (view.buffer >= static_cast<int>(model_.buffers.size())) {
      fail("bufferView " + std::to_string(view_number) + " names buffer " +
           std::to_string(view.buffer) + " of " + std::to_string(model_.buffers.size()));
    }
    const auto& data = model_.buffers[static_cast<std::size_t>(view.buffer)].data;
    if (view.byteOffset + view.byteLength > data.size()) {
      fail("bufferView " + std::to_string(view_number) + " ends at byte " +
           std::to_string(view.byteOffset + view.byteLength) + " of a buffer of " +
           std::to_string(data.size()));
    }
    const std::size_t stride =
        may_stride && view.byteStride != 0 ? view.byteStride : bytes;
    if (stride < bytes) fail(what_ + " has elements larger than their stride");
    const std::size_t end = count == 0 ? offset : offset + stride * (count - 1) + bytes;
    if (end > view.byteLength) {
      fail(what_ + " ends at byte " + std::to_string(end) + " of a bufferView of " +
           std::to_string(view.byteLength));
    }
    return {data.data() + view.byteOffset + offset, stride};
  }

  // Elements that differ from the dense ones (zeros, where there are none).
  void read_sparse() {
    const auto& sparse = accessor_->sparse;
    const auto count = static_cast<std::size_t>(std::max(sparse.count, 0));
    const std::size_t bytes = bytes_of(sparse.indices.componentType);
    const Part indices =
        part(sparse.indices.bufferView,
             static_cast<std::size_t>(sparse.indices.byteOffset), count, bytes, false);
    sparse_ =
        part(sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset),
             count, element_bytes(), false);
    sparse_indices_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t index = unsigned_at(indices.data + i * indices.stride, bytes);
      if (index >= accessor_->count) {
        fail(what_ + " replaces element " + std::to_string(index) + " of " +
             std::to_string(accessor_->count));
      }
      if (i > 0 && index <= sparse_indices_.back()) {
        fail(what_ + " replaces elements in no ascending order");
      }
      sparse_indices_.push_back(index);
    }
  }

  [[nodiscard]] const unsigned char* element(std::size_t i) const {
    static constexpr std::array<unsigned char, 64> kZeros{};
    if (!sparse_indices_.empty()) {
      const auto found =
          std::lower_bound(sparse_indices_.begin(), sparse_indices_.end(), i);
      if (found != sparse_indices_.end() && *found == i) {
        return sparse_.data +
               sparse_.stride * static_cast<std::size_t>(found - sparse_indices_.begin());
      }
    }
    return dense_.data == nullptr ? kZeros.data() : dense_.data + i * dense_.stride;
  }

  static std::uint64_t unsigned_at(const unsigned char* at, std::size_t bytes) {
    std::uint64_t value = 0;
    for (std::size_t i = bytes; i-- > 0;) value = 256 * value + at[i];
    return value;
  }

  [[nodiscard]] double scaled(double integer, double largest) const {
    return accessor_->normalized ? std::max(integer / largest, -1.0) : integer;
  }

  const std::string& path_;
  const tinygltf::Model& model_;
  std::string of_, what_;
  const tinygltf::Accessor* accessor_ = nullptr;
  std::size_t bytes_per_component_ = 0, components_ = 0;
  Part dense_, sparse_;
  std::vector<std::size_t> sparse_indices_;
};

Eigen::Affine3d transformation(const std::string& path, const tinygltf::Node& node,
                               int number) {
  Eigen::Affine3d t = Eigen::Affine3d::Identity();
  if (!node.matrix.empty()) {
    const Eigen::Map<const Eigen::Matrix4d> matrix(node.matrix.data());  // by columns
    if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
      refuse(path, named("node", number, node.name) +
                       " has a matrix whose last row is not 0 0 0 1");
    }
    t.matrix() = matrix;
    t.linear() = settled(t.linear());
    return t;
  }
  if (!node.rotation.empty()) {
    const Eigen::Map<const Eigen::Vector4d> q(node.rotation.data());  // x, y, z, w
    constexpr double kMostOff = 0x1p-6;
    if (!(std::abs(q.squaredNorm() - 1) <= kMostOff)) {
      refuse(path, named("node", number, node.name) +
                       " has a rotation that is no unit quaternion");
    }
    const double x = q[0], y = q[1], z = q[2], w = q[3], s = 2 / q.squaredNorm();
    Eigen::Matrix3d turn;
    turn << 1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y),
        s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x),
        s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y);
    t.linear() = settled(turn);
  }
  if (!node.scale.empty()) {
    t.linear() *= Eigen::Vector3d(node.scale.data()).asDiagonal();
  }
  if (!node.translation.empty())
    t.translation() = Eigen::Vector3d(node.translation.data());
  return t;
}

// A transformation as a part of another one.
Eigen::Affine3d composed(const Eigen::Affine3d& outer, const Eigen::Affine3d& inner) {
  Eigen::Affine3d t = outer * inner;
  t.linear() = settled(t.linear());
  return t;
}

class GltfReader {
 public:
  // `bytes`: of the file, its buffers not counted.
  GltfReader(const std::string& path, const tinygltf::Model& model, std::size_t bytes,
             const std::vector<bool>& emits, Stage& stage)
      : path_(path), model_(model), emits_(emits), bytes_(bytes), stage_(stage) {
    for (const auto& buffer : model.buffers) bytes_ += buffer.data.size();
  }

  MeshFile read() {
    check_tree();
    const std::vector<int> roots = roots_of_scene();
    check_size(roots);
    for (const int root : roots) walk(root, roots.size() == 1);
    soup_.groups = groups_.groups();
    report_left_out();
    return std::move(soup_);
  }

 private:
  // A file may use one mesh for many nodes.  So many faces need half a gigabyte.
  static constexpr std::size_t kMostFaces = 4'000'000, kMostFacesPerByte = 4;

  const tinygltf::Node& node(int number) const {
    return model_.nodes[static_cast<std::size_t>(number)];
  }

  // Every node has one parent at most, and none is above itself.
  void check_tree() {
    const int count = static_cast<int>(model_.nodes.size());
    parent_.assign(model_.nodes.size(), -1);
    for (int n = 0; n < count; ++n) {
      for (const int child : node(n).children) {
        if (child >= count) {
          refuse(path_, named("node", n, node(n).name) + " names node " +
                            std::to_string(child) + " of " + std::to_string(count));
        }
        int& parent = parent_[static_cast<std::size_t>(child)];
        if (parent >= 0) {
          refuse(path_,
                 "node " + std::to_string(child) + " is a child of node " +
                     std::to_string(parent) +
                     (parent == n ? " twice" : " and of node " + std::to_string(n)) +
                     ": the nodes form no tree");
        }
        parent = n;
      }
    }
    // With one parent each, nodes that no root leads to are on a cycle or below one.
    used_.assign(model_.nodes.size(), false);
    std::vector<int> open;
    std::size_t reached = 0;
    for (int n = 0; n < count; ++n) {
      if (parent_[static_cast<std::size_t>(n)] < 0) open.push_back(n);
    }
    while (!open.empty()) {
      const int n = open.back();
      open.pop_back();
      used_[static_cast<std::size_t>(n)] = true;
      ++reached;
      open.insert(open.end(), node(n).children.begin(), node(n).children.end());
    }
    if (reached < used_.size()) {
      const auto first = std::find(used_.begin(), used_.end(), false) - used_.begin();
      refuse(path_, "node " + std::to_string(first) +
                        " is below itself or below such a node: the nodes form no tree");
    }
    used_.assign(model_.nodes.size(), false);
  }

  // The roots of the file's own scene, else of its first one, else all.
  std::vector<int> roots_of_scene() const {
    const int scenes = static_cast<int>(model_.scenes.size());
    std::vector<int> roots;
    if (scenes == 0) {
      for (std::size_t n = 0; n < parent_.size(); ++n) {
        if (parent_[n] < 0) roots.push_back(static_cast<int>(n));
      }
      return roots;
    }
    const int scene = std::max(model_.defaultScene, 0);
    if (scene >= scenes) {
      refuse(path_,
             "names scene " + std::to_string(scene) + " of " + std::to_string(scenes));
    }
    roots = model_.scenes[static_cast<std::size_t>(scene)].nodes;
    std::vector<bool> seen(parent_.size());
    for (const int root : roots) {
      const std::string what =
          "scene " + std::to_string(scene) + " names node " + std::to_string(root);
      if (root >= static_cast<int>(parent_.size())) {
        refuse(path_, what + " of " + std::to_string(parent_.size()));
      }
      const auto r = static_cast<std::size_t>(root);
      if (seen[r]) refuse(path_, what + " twice");
      if (parent_[r] >= 0) {
        refuse(path_, what + ", which is a child of node " + std::to_string(parent_[r]));
      }
      seen[r] = true;
    }
    return roots;
  }

  // Refuses a scene of far more faces than its file has bytes before it is unfolded.
  void check_size(const std::vector<int>& roots) const {
    std::vector<std::size_t> faces_of(model_.meshes.size(), 0);
    for (std::size_t m = 0; m < faces_of.size(); ++m) {
      for (const auto& primitive : model_.meshes[m].primitives) {
        if (primitive.mode < TINYGLTF_MODE_TRIANGLES) continue;
        const int list = primitive.indices >= 0 ? primitive.indices
                                                : primitive.attributes.at("POSITION");
        if (list >= static_cast<int>(model_.accessors.size())) continue;  // refused later
        const std::size_t count = std::min(
            model_.accessors[static_cast<std::size_t>(list)].count, std::size_t{1} << 32);
        faces_of[m] += primitive.mode == TINYGLTF_MODE_TRIANGLES ? count / 3 : count;
      }
    }
    const std::size_t most = std::max(kMostFaces, kMostFacesPerByte * bytes_);
    std::size_t faces = 0;
    std::vector<int> open = roots;
    while (!open.empty()) {
      const auto& next = node(open.back());
      open.pop_back();
      const auto mesh = static_cast<std::size_t>(next.mesh);
      if (next.mesh >= 0 && mesh < faces_of.size()) faces += faces_of[mesh];
      if (faces > most) {
        refuse(path_, "unfolds to more than " + std::to_string(most) + " faces");
      }
      open.insert(open.end(), next.children.begin(), next.children.end());
    }
  }

  // A root and all nodes below it, without recursion: chains of nodes may be long.
  void walk(int root, bool is_only) {
    struct Visit {
      int node, first;
      std::size_t next_child;
      Eigen::Affine3d to_world;
    };
    std::vector<Visit> path;
    const auto enter = [&](int n, const Eigen::Affine3d& outer) {
      const int first = static_cast<int>(soup_.polygons.size());
      const auto t = transformation(path_, node(n), n);
      path.push_back({n, first, 0, path.empty() ? t : composed(outer, t)});
      used_[static_cast<std::size_t>(n)] = true;
      append_mesh(node(n).mesh, path.back().to_world);
    };
    enter(root, Eigen::Affine3d::Identity());
    while (!path.empty()) {
      Visit& visit = path.back();
      const auto& children = node(visit.node).children;
      if (visit.next_child < children.size()) {
        const int child = children[visit.next_child++];
        enter(child, Eigen::Affine3d(visit.to_world));
        continue;
      }
      groups_.add(node(visit.node).name, visit.first,
                  static_cast<int>(soup_.polygons.size()), is_only && path.size() == 1);
      path.pop_back();
    }
  }

  void append_mesh(int number, const Eigen::Affine3d& to_world) {
    if (number < 0) return;
    if (number >= static_cast<int>(model_.meshes.size())) {
      refuse(path_, "a node names mesh " + std::to_string(number) + " of " +
                        std::to_string(model_.meshes.size()));
    }
    const auto& mesh = model_.meshes[static_cast<std::size_t>(number)];
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
      append_primitive(
          mesh.primitives[p],
          named("mesh", number, mesh.name) + ", primitive " + std::to_string(p),
          to_world);
    }
  }

  void append_primitive(const tinygltf::Primitive& primitive, const std::string& what,
                        const Eigen::Affine3d& to_world) {
    if (primitive.mode < TINYGLTF_MODE_TRIANGLES) return;  // points or lines
    const Values positions(path_, model_, primitive.attributes.at("POSITION"), what);
    if (positions.type() != TINYGLTF_TYPE_VEC3) {
      positions.fail("POSITION has no three coordinates");
    }
    if (positions.component_type() == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
      positions.fail("POSITION has numbers of 32 bits, which the format does not have");
    }
    const std::vector<int> corners = corners_of(primitive, positions, what);
    const bool mirrored = to_world.linear().determinant() < 0;
    const std::size_t first_face = soup_.polygons.size();
    append_triangles(corners, primitive.mode);
    if (emits_light(primitive, what)) {
      for (std::size_t f = first_face; f < soup_.polygons.size(); ++f) {
        soup_.emitting.push_back(static_cast<int>(f));
      }
    }
    // The corners become vertices of the soup in the order of their numbers.
    std::vector<int> used(corners);
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    const int first_vertex = static_cast<int>(soup_.vertices.size());
    for (const int v : used) {
      stage_.at(0, 1);
      soup_.vertices.push_back(to_world * position(positions, v));
    }
    for (std::size_t f = first_face; f < soup_.polygons.size(); ++f) {
      stage_.at(0, 1);
      auto& polygon = soup_.polygons[f];
      for (int& corner : polygon) {
        const auto at = std::lower_bound(used.begin(), used.end(), corner);
        corner = first_vertex + static_cast<int>(at - used.begin());
      }
      if (mirrored) std::reverse(polygon.begin(), polygon.end());
    }
  }

  bool emits_light(const tinygltf::Primitive& primitive, const std::string& what) const {
    if (primitive.material < 0) return false;
    const auto material = static_cast<std::size_t>(primitive.material);
    if (material >= emits_.size()) {
      refuse(path_, what + ": names material " + std::to_string(material) + " of " +
                        std::to_string(emits_.size()));
    }
    return emits_[material];
  }

  // Numbers of positions, three a triangle or as a strip or fan has them.
  std::vector<int> corners_of(const tinygltf::Primitive& primitive,
                              const Values& positions, const std::string& what) const {
    std::optional<Values> indices;
    if (primitive.indices >= 0) {
      indices.emplace(path_, model_, primitive.indices, what);
      const int type = indices->component_type();
      if (indices->type() != TINYGLTF_TYPE_SCALAR ||
          (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
           type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
           type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)) {
        indices->fail("its indices are no whole numbers");
      }
    }
    const std::size_t count = indices ? indices->count() : positions.count();
    const bool triangles = primitive.mode == TINYGLTF_MODE_TRIANGLES;
    if (triangles ? count % 3 != 0 : count < 3) {
      positions.fail("has " + std::to_string(count) +
                     (indices ? " indices" : " vertices") +
                     (triangles ? ", no multiple of three" : ", fewer than three"));
    }
    std::vector<int> corners(count);
    for (std::size_t i = 0; i < count; ++i) {
      stage_.at(0, 1);
      const std::size_t corner = indices ? indices->whole(i) : i;
      if (corner >= positions.count()) {
        positions.fail("index " + std::to_string(i) + " names vertex " +
                       std::to_string(corner) + " of " +
                       std::to_string(positions.count()));
      }
      corners[i] = static_cast<int>(corner);
    }
    return corners;
  }

  void append_triangles(std::span<const int> corners, int mode) {
    for (std::size_t i = 3; i <= corners.size(); ++i) {
      if (mode == TINYGLTF_MODE_TRIANGLES) {
        if (i % 3 == 0) {
          soup_.polygons.push_back({corners[i - 3], corners[i - 2], corners[i - 1]});
        }
      } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
        append_strip_triangle(soup_.polygons, corners.first(i));
      } else {
        soup_.polygons.push_back({corners[0], corners[i - 2], corners[i - 1]});
      }
    }
  }

  static Point position(const Values& positions, int vertex) {
    Point p;
    for (int axis = 0; axis < 3; ++axis) {
      p[axis] = positions.real(static_cast<std::size_t>(vertex),
                               static_cast<std::size_t>(axis));
      if (!std::isfinite(p[axis])) {
        positions.fail("vertex " + std::to_string(vertex) +
                       " has a coordinate that is not finite");
      }
    }
    return p;
  }

  void report_left_out() {
    std::size_t left_out = 0;
    for (std::size_t n = 0; n < used_.size(); ++n) {
      if (!used_[n] && model_.nodes[n].mesh >= 0) ++left_out;
    }
    if (left_out == 0) return;
    soup_.defects.push_back({"left out",
                             std::to_string(left_out) +
                                 " nodes with a mesh are not in the scene that is read",
                             {},
                             {}});
  }

  const std::string& path_;
  const tinygltf::Model& model_;
  const std::vector<bool>& emits_;  // per material
  std::size_t bytes_;
  Stage& stage_;
  MeshFile soup_;
  NodeGroups groups_;
  std::vector<int> parent_;  // per node, -1 for none
  std::vector<bool> used_;   // per node: in the scene that is read
};

}  // namespace

Eigen::Matrix3d settled(Eigen::Matrix3d linear) {
  constexpr double kRounding = 0x1p-21;
  if (linear.isDiagonal(0)) return linear;  // a scale, and no turn
  const Eigen::Matrix3d size = linear.cwiseAbs();
  const Eigen::Vector3d rows = size.rowwise().maxCoeff();
  const Eigen::RowVector3d columns = size.colwise().maxCoeff();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (size(i, j) < kRounding * std::min(rows[i], columns[j])) linear(i, j) = 0;
    }
  }
  const auto nearest = [](double x) { return x < -0.5 ? -1.0 : x > 0.5 ? 1.0 : 0.0; };
  const Eigen::Matrix3d turn = linear.unaryExpr(nearest);
  const bool is_turn = ((linear - turn).array().abs() < kRounding).all();
  return is_turn ? turn : linear;
}

MeshFile read_gltf(const std::string& path, std::string_view bytes, Stage& stage) {
  const CheckedGltf checked = check_gltf(path, bytes);
  try {
    const tinygltf::Model model = load_model(path, checked);
    return GltfReader(path, model, bytes.size(), checked.emits, stage).read();
  } catch (const InvalidInput&) {
    throw;
  } catch (const Stopped&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    refuse(path, "cannot be read: " + one_line(error.what()));
  }
}

#else

MeshFile read_gltf(const std::string& path, std::string_view, Stage&) {
  refuse(path, "glTF needs tinygltf, which this build is without");
}

#endif

}  // namespace sightline::internal
