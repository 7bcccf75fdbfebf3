// A glTF file's container and JSON, checked before tinygltf reads it.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "linespace/files/gltf.h"
#include "linespace/files/mesh_io.h"

namespace sightline::internal {
namespace {

using Json = nlohmann::json;

std::size_t little_endian(std::string_view bytes, std::size_t at) {
  std::size_t value = 0;
  for (std::size_t i = 4; i-- > 0;) {
    value = 256 * value + static_cast<unsigned char>(bytes[at + i]);
  }
  return value;
}

// The two chunks of a .glb file: JSON, and the buffer, which may be missing.
struct Chunks {
  std::string_view json, binary;
};

Chunks chunks_of(const std::string& path, std::string_view bytes) {
  constexpr std::size_t kHeader = 12;  // "glTF", version, bytes in all
  constexpr std::size_t kChunkHeader = 8;
  constexpr std::size_t kJson = 0x4E4F534A, kBinary = 0x004E4942;
  const auto announces = [&](const std::string& what, std::size_t count,
                             std::size_t there) {
    if (count <= there) return;
    refuse(path, "announces " + what + std::to_string(count) + " bytes, but has " +
                     std::to_string(there));
  };
  if (bytes.size() < kHeader + kChunkHeader) refuse(path, "ends inside the header");
  const std::size_t version = little_endian(bytes, 4);
  if (version != 2) {
    refuse(path, "glTF of version " + std::to_string(version) + " is not read here");
  }
  announces("", little_endian(bytes, 8), bytes.size());
  Chunks chunks;
  std::size_t at = kHeader;
  for (int i = 0; at + kChunkHeader <= bytes.size(); ++i) {
    const std::size_t length = little_endian(bytes, at);
    const std::size_t kind = little_endian(bytes, at + 4);
    at += kChunkHeader;
    announces("a chunk of ", length, bytes.size() - at);
    if (i == 0 && kind != kJson) refuse(path, "does not begin with a chunk of JSON");
    if (i == 0) chunks.json = bytes.substr(at, length);
    if (i == 1 && kind == kBinary) chunks.binary = bytes.substr(at, length);
    at += (length + 3) / 4 * 4;  // chunks start at multiples of four
    if (at > bytes.size()) break;
  }
  return chunks;
}

std::string numbered(const char* list, std::size_t i) {
  return std::string(list) + "[" + std::to_string(i) + "]";
}

// What an extension that a file requires changes of the shapes: nothing, or what is read.
bool is_harmless(std::string_view extension) {
  return extension == "KHR_mesh_quantization" ||
         extension.starts_with("KHR_materials_") ||
         extension.starts_with("KHR_texture_") || extension.starts_with("EXT_texture_") ||
         extension.starts_with("MSFT_texture_") || extension.starts_with("KHR_lights_") ||
         extension.starts_with("EXT_lights_") || extension.starts_with("KHR_xmp");
}

// Copies what is read of the JSON, and refuses members of a wrong type by name.
class Checker {
 public:
  Checker(const std::string& path, bool has_binary)
      : path_(path), has_binary_(has_binary) {}

  Json run(const Json& root, CheckedGltf& checked) {
    if (!root.is_object()) refuse(path_, "no glTF: the JSON is no object");
    check_asset(root);
    check_extensions(root);
    Json copy{{"asset", {{"version", "2.0"}}}};
    copy_member(root, copy, "scene", "", &Checker::index);
    copy_list(root, copy, "scenes", &Checker::scene);
    copy_list(root, copy, "nodes", &Checker::node);
    copy_list(root, copy, "meshes", &Checker::mesh);
    copy_list(root, copy, "accessors", &Checker::accessor);
    copy_list(root, copy, "bufferViews", &Checker::buffer_view);
    copy_list(root, copy, "buffers", &Checker::buffer);
    copy_list(root, copy, "materials", &Checker::material);
    for (const Json& buffer : copy.value("buffers", Json::array())) {
      if (!buffer.contains("uri")) continue;
      if (buffer["uri"].get_ref<const std::string&>().starts_with("data:")) continue;
      checked.file_sizes.push_back(buffer["byteLength"].get<std::size_t>());
    }
    for (const Json& material : copy.value("materials", Json::array())) {
      checked.emits.push_back(material["emits"].get<bool>());
    }
    copy.erase("materials");
    return copy;
  }

 private:
  using Check = Json (Checker::*)(const Json&, const std::string& where) const;

  [[noreturn]] void fail(const std::string& where, const std::string& message) const {
    refuse(path_, where + " " + message);
  }

  void check_asset(const Json& root) const {
    const auto asset = root.find("asset");
    if (asset == root.end() || !asset->is_object() || !asset->contains("version") ||
        !(*asset)["version"].is_string()) {
      refuse(path_, "no glTF: the JSON has no asset.version");
    }
    const auto& version = (*asset)["version"].get_ref<const std::string&>();
    if (!version.starts_with("2.")) {
      refuse(path_, "glTF of version " + internal::quoted(version) + " is not read here");
    }
  }

  void check_extensions(const Json& root) const {
    const auto required = root.find("extensionsRequired");
    if (required == root.end()) return;
    if (!required->is_array()) fail("extensionsRequired", "is no array");
    for (const Json& name : *required) {
      if (!name.is_string()) fail("extensionsRequired", "holds what is no name");
      const auto& text = name.get_ref<const std::string&>();
      if (is_harmless(text)) continue;
      refuse(path_, "requires the extension " + internal::quoted(text) +
                        ", which is not read here");
    }
  }

  static bool uses(const Json& object, const char* extension) {
    const auto found = object.find("extensions");
    return found != object.end() && found->is_object() && found->contains(extension);
  }

  // Copies a member, if it is there, as `check` gives it.
  bool copy_member(const Json& from, Json& to, const char* key, const std::string& where,
                   Check check, bool is_required = false) const {
    const auto found = from.find(key);
    const std::string place = where.empty() ? key : where + "." + key;
    if (found != from.end()) {
      to[key] = (this->*check)(*found, place);
    } else if (is_required) {
      fail(where, "has no " + internal::quoted(key));
    }
    return found != from.end();
  }

  void copy_list(const Json& from, Json& to, const char* key, Check check) const {
    const auto found = from.find(key);
    if (found == from.end()) return;
    if (!found->is_array()) fail(key, "is no array");
    Json& list = to[key] = Json::array();
    for (const Json& item : *found) {
      const std::string where = numbered(key, list.size());
      if (!item.is_object()) fail(where, "is no object");
      list.push_back((this->*check)(item, where));
    }
  }

  // A whole number from 0 to `most`; 3.0 is one.
  Json whole(const Json& value, const std::string& where, double most) const {
    if (!value.is_number()) fail(where, "is no number");
    const double number = value.get<double>();
    if (!(number >= 0 && number <= most && number == std::floor(number))) {
      fail(where, "is no whole number from 0 to " +
                      std::to_string(static_cast<long long>(most)));
    }
    return static_cast<std::uint64_t>(number);
  }
  Json index(const Json& value, const std::string& where) const {
    return whole(value, where, std::numeric_limits<int>::max());
  }
  Json size(const Json& value, const std::string& where) const {
    return whole(value, where, 0x1p53);
  }
  Json text(const Json& value, const std::string& where) const {
    if (!value.is_string()) fail(where, "is no text");
    return value;
  }
  Json flag(const Json& value, const std::string& where) const {
    if (!value.is_boolean()) fail(where, "is neither true nor false");
    return value;
  }
  Json indices(const Json& value, const std::string& where) const {
    if (!value.is_array()) fail(where, "is no array");
    Json copy = Json::array();
    for (const Json& item : value) copy.push_back(index(item, where));
    return copy;
  }
  Json numbers(const Json& value, const std::string& where, std::size_t count) const {
    const auto is_number = [](const Json& x) { return x.is_number(); };
    if (!value.is_array() || value.size() != count ||
        !std::all_of(value.begin(), value.end(), is_number)) {
      fail(where, "is no array of " + std::to_string(count) + " numbers");
    }
    return value;
  }
  Json three_numbers(const Json& value, const std::string& where) const {
    return numbers(value, where, 3);
  }
  Json four_numbers(const Json& value, const std::string& where) const {
    return numbers(value, where, 4);
  }
  Json matrix(const Json& value, const std::string& where) const {
    return numbers(value, where, 16);
  }

  Json scene(const Json& value, const std::string& where) const {
    Json copy = Json::object();
    copy_member(value, copy, "nodes", where, &Checker::indices);
    return copy;
  }

  Json node(const Json& value, const std::string& where) const {
    Json copy = Json::object();
    copy_member(value, copy, "name", where, &Checker::text);
    copy_member(value, copy, "mesh", where, &Checker::index);
    copy_member(value, copy, "children", where, &Checker::indices);
    const bool has_matrix = copy_member(value, copy, "matrix", where, &Checker::matrix);
    for (const char* const key : {"translation", "scale"}) {
      if (copy_member(value, copy, key, where, &Checker::three_numbers) && has_matrix) {
        fail(where, std::string("has both a matrix and a ") + key);
      }
    }
    if (copy_member(value, copy, "rotation", where, &Checker::four_numbers) &&
        has_matrix) {
      fail(where, "has both a matrix and a rotation");
    }
    if (uses(value, "EXT_mesh_gpu_instancing")) {
      fail(where, "uses EXT_mesh_gpu_instancing: instances are not read here");
    }
    if (value.contains("skin") && value.contains("mesh")) {
      fail(where, "has a skin: meshes that a skeleton bends are not read here");
    }
    check_weights(value, where);
    return copy;
  }

  // Weights of morph targets that are 0 leave a mesh as it is.
  void check_weights(const Json& value, const std::string& where) const {
    const auto weights = value.find("weights");
    if (weights == value.end()) return;
    if (!weights->is_array()) fail(where + ".weights", "is no array");
    for (const Json& weight : *weights) {
      if (weight.is_number() && weight.get<double>() == 0) continue;
      fail(where, "has weights of morph targets, which are not read here");
    }
  }

  Json mesh(const Json& value, const std::string& where) const {
    Json copy = Json::object();
    copy_member(value, copy, "name", where, &Checker::text);
    check_weights(value, where);
    const auto primitives = value.find("primitives");
    if (primitives == value.end() || !primitives->is_array() || primitives->empty()) {
      fail(where, "has no primitives");
    }
    Json& list = copy["primitives"] = Json::array();
    for (const Json& item : *primitives) {
      const std::string place = where + "." + numbered("primitives", list.size());
      if (!item.is_object()) fail(place, "is no object");
      list.push_back(primitive(item, place));
    }
    return copy;
  }

  Json primitive(const Json& value, const std::string& where) const {
    Json copy{{"mode", 4}};
    copy_member(value, copy, "mode", where, &Checker::index);
    if (copy["mode"].get<int>() > 6) fail(where + ".mode", "is none of the format's");
    copy_member(value, copy, "indices", where, &Checker::index);
    copy_member(value, copy, "material", where, &Checker::index);
    const auto attributes = value.find("attributes");
    if (attributes == value.end() || !attributes->is_object() ||
        !attributes->contains("POSITION")) {
      fail(where, "has no POSITION");
    }
    copy["attributes"] = Json::object();
    copy_member(*attributes, copy["attributes"], "POSITION", where + ".attributes",
                &Checker::index);
    return copy;
  }

  // {"emits"}: whether some colour of its light is not black.
  Json material(const Json& value, const std::string& where) const {
    Json copy{{"emissiveFactor", Json::array({0, 0, 0})}};
    copy_member(value, copy, "emissiveFactor", where, &Checker::three_numbers);
    const Json& factor = copy["emissiveFactor"];
    const bool emits = std::any_of(factor.begin(), factor.end(),
                                   [](const Json& c) { return c.get<double>() > 0; });
    return {{"emits", emits}};
  }

  Json accessor(const Json& value, const std::string& where) const {
    Json copy = Json::object();
    copy_member(value, copy, "bufferView", where, &Checker::index);
    copy_member(value, copy, "byteOffset", where, &Checker::size);
    copy_member(value, copy, "componentType", where, &Checker::index, true);
    copy_member(value, copy, "normalized", where, &Checker::flag);
    copy_member(value, copy, "count", where, &Checker::size, true);
    copy_member(value, copy, "type", where, &Checker::text, true);
    copy_member(value, copy, "sparse", where, &Checker::sparse);
    return copy;
  }

  Json sparse(const Json& value, const std::string& where) const {
    if (!value.is_object()) fail(where, "is no object");
    Json copy = Json::object();
    copy_member(value, copy, "count", where, &Checker::index, true);
    copy_member(value, copy, "indices", where, &Checker::sparse_part, true);
    copy_member(value, copy, "values", where, &Checker::sparse_part, true);
    if (!copy["indices"].contains("componentType")) {
      fail(where + ".indices", "has no 'componentType'");
    }
    return copy;
  }

  Json sparse_part(const Json& value, const std::string& where) const {
    if (!value.is_object()) fail(where, "is no object");
    Json copy = Json::object();
    copy_member(value, copy, "bufferView", where, &Checker::index, true);
    copy_member(value, copy, "byteOffset", where, &Checker::index);
    copy_member(value, copy, "componentType", where, &Checker::index);
    return copy;
  }

  Json buffer_view(const Json& value, const std::string& where) const {
    Json copy = Json::object();
    copy_member(value, copy, "buffer", where, &Checker::index, true);
    copy_member(value, copy, "byteOffset", where, &Checker::size);
    copy_member(value, copy, "byteLength", where, &Checker::size, true);
    copy_member(value, copy, "byteStride", where, &Checker::size);
    return copy;
  }

  Json buffer(const Json& value, const std::string& where) const {
    Json copy = Json::object();
    copy_member(value, copy, "byteLength", where, &Checker::size, true);
    const bool is_first = where.ends_with("[0]");
    if (!copy_member(value, copy, "uri", where, &Checker::text) &&
        !(is_first && has_binary_)) {
      fail(where, "has no data");
    }
    if (copy["byteLength"] == 0) fail(where, "is empty");
    return copy;
  }

  const std::string& path_;
  bool has_binary_;
};

}  // namespace

CheckedGltf check_gltf(const std::string& path, std::string_view bytes) {
  const bool is_binary = bytes.starts_with("glTF");
  const Chunks chunks = is_binary ? chunks_of(path, bytes) : Chunks{bytes, {}};
  CheckedGltf checked;
  checked.binary = chunks.binary;
  try {
    const Json root = Json::parse(chunks.json);
    checked.json = Checker(path, !chunks.binary.empty()).run(root, checked).dump();
  } catch (const Json::exception& error) {
    const std::string_view what = error.what();
    refuse(path, "no glTF: " + one_line(std::string(what.substr(what.find("] ") + 2))));
  }
  return checked;
}

namespace {

// "my%20buffer.bin" is "my buffer.bin".
std::string without_escapes(std::string_view uri) {
  constexpr std::string_view kDigits = "0123456789abcdef0123456789ABCDEF";
  const auto digit = [&](std::size_t i) {
    const std::size_t at = i < uri.size() ? kDigits.find(uri[i]) : std::string_view::npos;
    return at == std::string_view::npos ? -1 : static_cast<int>(at % 16);
  };
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool escaped = uri[i] == '%' && digit(i + 1) >= 0 && digit(i + 2) >= 0;
    text += escaped ? static_cast<char>(16 * digit(i + 1) + digit(i + 2)) : uri[i];
    if (escaped) i += 2;
  }
  return text;
}

}  // namespace

std::vector<std::string> buffer_files(const CheckedGltf& checked) {
  std::vector<std::string> files;
  const Json root = Json::parse(checked.json);
  for (const Json& buffer : root.value("buffers", Json::array())) {
    const std::string uri = buffer.value("uri", "");
    if (!uri.empty() && !uri.starts_with("data:")) files.push_back(without_escapes(uri));
  }
  return files;
}

}  // namespace sightline::internal
