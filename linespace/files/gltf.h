// What tinygltf is given of a glTF file, and how nodes turn their meshes.

#pragma once

#include <Eigen/Geometry>
#include <string>
#include <string_view>
#include <vector>

namespace sightline::internal {

/// A glTF file as tinygltf is to read it.
struct CheckedGltf {
  /// JSON with scenes, nodes, meshes, accessors and buffers only, every member of the
  /// type that the format wants: tinygltf passes over members of a wrong type in silence.
  /// Images, materials, animations and extras are left out; primitives keep the numbers
  /// of their materials.
  std::string json;
  /// The buffer inside a .glb file; empty in others.
  std::string_view binary;
  /// The "byteLength" of each buffer that is a file of its own, in order.
  std::vector<std::size_t> file_sizes;
  /// By material: whether it emits light, which an emissiveFactor above 0 says.
  std::vector<bool> emits;
};

/// Checks a .gltf or, by its first bytes, .glb file.  Throws InvalidInput for what is no
/// glTF 2, and for what is required or used in it that would be misread: extensions that
/// are not read here, instances, skins, compressed meshes.
[[nodiscard]] CheckedGltf check_gltf(const std::string& path, std::string_view bytes);

/// The buffers of a checked file that are files of their own, named from its folder.
[[nodiscard]] std::vector<std::string> buffer_files(const CheckedGltf& checked);

/// The linear part of a transformation with the rounding of single precision taken out
/// of what it would skew: an entry below 2^-21 of the largest of its row and of its
/// column becomes 0; if then all entries are within 2^-21 of 0, 1 or -1, they become
/// these.  A diagonal matrix, which scales and does not turn, stays as it is.
///
/// Why 2^-21: a right angle in single precision has numbers that are off by e = 2^-24 at
/// most.  An entry of the matrix that a quaternion q gives, such as 2(xy - wz), is then
/// off by 2e(|x| + |y| + |z| + |w|) <= 4e, or by 4e(|y| + |z|) <= 6e: less than 8e =
/// 2^-21.
[[nodiscard]] Eigen::Matrix3d settled(Eigen::Matrix3d linear);

}  // namespace sightline::internal
