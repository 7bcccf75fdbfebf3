// glTF: what is read of it, to the last bit, and what is refused by name.

#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numeric>
#include <random>
#include <sstream>

#include "linespace/face_visibility.h"
#include "linespace/files/mesh_io.h"
#include "linespace/mesh_io.h"
#include "tests/support/unhurried.h"

namespace sightline {
namespace {

using Random = std::mt19937;
constexpr int kNeighbours = 100;

std::string data(const std::string& name) {
  return std::string(SIGHTLINE_TEST_DATA) + "/" + name;
}

bool can_read_gltf() {
  const auto known = readable_extensions();
  return std::binary_search(known.begin(), known.end(), "gltf");
}

std::string complaint(const std::function<void()>& read) {
  try {
    read();
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

std::string complaint_about(const std::string& text) {
  return complaint([&] { (void)internal::read_gltf("x.gltf", text, test::Unhurried()); });
}

std::string base64(const std::string& bytes) {
  static const std::string digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool there = i + k < bytes.size();
      group = group << 8 | (there ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

template <class T>
void append(std::string& bytes, T value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

std::string numbers_text(const std::vector<double>& numbers) {
  std::ostringstream text;
  text.precision(17);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    text << (i > 0 ? "," : "") << numbers[i];
  return "[" + text.str() + "]";
}

// One mesh of one primitive, as text: what a test varies is public.
struct File {
  std::string positions, indices;  // bytes
  int position_type = 5126, index_type = 5125;
  std::size_t position_count = 0, index_count = 0, stride = 0;
  bool normalized = false, has_indices = true;
  std::string mode = "4", node = R"("name":"n")", nodes, scenes = R"([{"nodes":[0]}])";
  std::string scene = "0", root, accessor;

  [[nodiscard]] std::string text() const {
    const std::string buffer = positions + indices;
    std::ostringstream out;
    out << R"({"asset":{"version":"2.0"},"scenes":)" << scenes << root;
    if (!scene.empty()) out << R"(,"scene":)" << scene;
    out << R"(,"nodes":[)" << (nodes.empty() ? R"({"mesh":0,)" + node + "}" : nodes)
        << R"(],"meshes":[{"name":"m","primitives":[{"mode":)" << mode
        << R"(,"attributes":{"POSITION":0})" << (has_indices ? R"(,"indices":1)" : "")
        << R"(}]}],"accessors":[{"bufferView":0,"componentType":)" << position_type
        << R"(,"count":)" << position_count << R"(,"type":"VEC3","normalized":)"
        << (normalized ? "true" : "false") << accessor << "}";
    if (has_indices) {
      out << R"(,{"bufferView":1,"componentType":)" << index_type << R"(,"count":)"
          << index_count << R"(,"type":"SCALAR"})";
    }
    out << R"(],"bufferViews":[{"buffer":0,"byteLength":)" << positions.size();
    if (stride > 0) out << R"(,"byteStride":)" << stride;
    out << R"(},{"buffer":0,"byteOffset":)" << positions.size() << R"(,"byteLength":)"
        << std::max<std::size_t>(indices.size(), 1) << R"(}],"buffers":[{"byteLength":)"
        << buffer.size() + (indices.empty() ? 1 : 0)
        << R"(,"uri":"data:application/octet-stream;base64,)"
        << base64(indices.empty() ? buffer + '\0' : buffer) << "\"}]}";
    return out.str();
  }
};

// Floats at the corners of the unit cube, and its twelve triangles.
File cube() {
  File file;
  for (int v = 0; v < 8; ++v) {
    for (int axis = 0; axis < 3; ++axis) {
      append(file.positions, static_cast<float>(v >> axis & 1));
    }
  }
  file.position_count = 8;
  for (const unsigned v : {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                           2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5}) {
    append(file.indices, v);
  }
  file.index_count = 36;
  return file;
}

std::array<Point, 2> box_of(const PolygonSoup& soup) {
  std::array<Point, 2> box{soup.vertices.at(0), soup.vertices.at(0)};
  for (const Point& p : soup.vertices) {
    box = {box[0].cwiseMin(p), box[1].cwiseMax(p)};
  }
  return box;
}

class Gltf : public testing::Test {
 protected:
  void SetUp() override {
    if (!can_read_gltf()) GTEST_SKIP() << "built without tinygltf";
  }
};

TEST_F(Gltf, QuantizedCubesOfTheCorpus) {
  const std::vector<std::tuple<const char*, double, double>> cubes{
      {"quantized_bytes.gltf", 40, 120},
      {"quantized_normalized.gltf", 2000.0 / 65535, 14000.0 / 65535},
      {"quantized_scaled.gltf", 1000 * 0.001, 3000 * 0.001},
      {"escaped_uri.gltf", 0, 1}};
  for (const auto& [name, low, high] : cubes) {
    SCOPED_TRACE(name);
    const Scene scene(read_mesh(data("readable/") + name));
    EXPECT_EQ(scene.soup().polygons.size(), 12u);
    EXPECT_EQ(scene.mesh_edges().convex, 12);
    EXPECT_EQ(scene.solids(), 1);
    EXPECT_EQ(scene.bounds()[0], Point(low, low, low));
    EXPECT_EQ(scene.bounds()[1], Point(high, high, high));
    EXPECT_TRUE(scene.defects().empty());
  }
}

// Integers of every size, with and without stride, are the numbers that the format says.
TEST_F(Gltf, IntegerPositionsAreTheirNumbers) {
  Random random(1);
  for (int i = 0; i < kNeighbours; ++i) {
    File file = cube();
    file.positions.clear();
    file.normalized = random() % 2 == 0;
    file.position_type = 5120 + static_cast<int>(random() % 4);
    const bool is_short = file.position_type >= 5122,
               is_signed = file.position_type % 2 == 0;
    const std::size_t bytes = is_short ? 6 : 3;
    file.stride = random() % 2 == 0 ? 0 : 8 + 4 * (random() % 3);
    const double divisor = !file.normalized ? 1
                           : is_short       ? (is_signed ? 32767 : 65535)
                                            : (is_signed ? 127 : 255);
    std::vector<Point> expected;
    for (int v = 0; v < 8; ++v) {
      Point p;
      for (int axis = 0; axis < 3; ++axis) {
        const auto raw = static_cast<std::uint16_t>(random());
        double number = 0;
        if (is_short) {
          append(file.positions, raw);
          number = is_signed ? static_cast<double>(static_cast<std::int16_t>(raw)) : raw;
        } else {
          append(file.positions, static_cast<std::uint8_t>(raw));
          number = is_signed ? static_cast<double>(static_cast<std::int8_t>(raw & 255))
                             : raw & 255;
        }
        p[axis] = std::max(number / divisor, file.normalized ? -1.0 : number);
      }
      expected.push_back(p);
      if (file.stride > 0) file.positions.append(file.stride - bytes, '\x55');
    }
    EXPECT_EQ(internal::read_gltf("x.gltf", file.text(), test::Unhurried()).vertices,
              expected)
        << file.text();
  }
}

TEST_F(Gltf, SparsePositionsReplaceDenseOnesOrZeros) {
  Random random(2);
  for (int i = 0; i < kNeighbours; ++i) {
    File file = cube();
    // Behind the dense positions: two indices of 16 bits and the positions that they get.
    const int first = static_cast<int>(random() % 7);
    const int second =
        first + 1 + static_cast<int>(random() % static_cast<unsigned>(7 - first));
    const std::size_t at = file.positions.size();
    append(file.positions, static_cast<std::uint16_t>(first));
    append(file.positions, static_cast<std::uint16_t>(second));
    for (const float x : {1.5F, 2.5F, 3.5F, -4.F, -5.F, -6.F}) append(file.positions, x);
    const bool dense = i % 2 == 0;
    file.accessor = R"(,"sparse":{"count":2,"indices":{"bufferView":0,"byteOffset":)" +
                    std::to_string(at) +
                    R"(,"componentType":5123},"values":{"bufferView":0,"byteOffset":)" +
                    std::to_string(at + 4) + "}}";
    std::string text = file.text();
    if (!dense) {
      const std::string member = R"("bufferView":0,"componentType":5126)";
      text.replace(text.find(member), member.size(), R"("componentType":5126)");
    }
    const PolygonSoup soup = internal::read_gltf("x.gltf", text, test::Unhurried());
    for (int v = 0; v < 8; ++v) {
      const Point old = dense ? Point(v & 1, v >> 1 & 1, v >> 2 & 1) : Point(0, 0, 0);
      EXPECT_EQ(soup.vertices[static_cast<std::size_t>(v)],
                v == first    ? Point(1.5, 2.5, 3.5)
                : v == second ? Point(-4, -5, -6)
                              : old);
    }
  }
}

// Triangles, strips and fans, with and without indices, against the definitions.
TEST_F(Gltf, TrianglesStripsAndFans) {
  Random random(3);
  for (int i = 0; i < kNeighbours; ++i) {
    File file;
    file.has_indices = i % 2 == 0;
    const unsigned mode = 4 + random() % 3;
    file.mode = std::to_string(mode);
    std::size_t count = 3 + random() % 8;
    if (mode == 4) count = count / 3 * 3;
    file.position_count = file.has_indices ? 7 : count;
    for (std::size_t v = 0; v < file.position_count; ++v) {
      for (int axis = 0; axis < 3; ++axis) {
        append(file.positions,
               static_cast<float>(v * 8 + static_cast<std::size_t>(axis)));
      }
    }
    std::vector<int> corners;
    file.index_type = std::array{5121, 5123, 5125}[random() % 3];
    for (std::size_t k = 0; k < count; ++k) {
      const auto v = static_cast<std::uint32_t>(file.has_indices ? random() % 7 : k);
      corners.push_back(static_cast<int>(v));
      if (file.index_type == 5121) append(file.indices, static_cast<std::uint8_t>(v));
      if (file.index_type == 5123) append(file.indices, static_cast<std::uint16_t>(v));
      if (file.index_type == 5125) append(file.indices, v);
    }
    if (!file.has_indices) file.indices.clear();
    file.index_count = count;
    std::vector<std::vector<int>> expected;
    for (std::size_t k = 0; k + 2 < count; ++k) {
      const int a = corners[k], b = corners[k + 1], c = corners[k + 2];
      if (mode == 4 && k % 3 == 0) expected.push_back({a, b, c});
      if (mode == 5 && a != b && b != c && a != c) {
        expected.push_back(k % 2 == 0 ? std::vector{a, b, c} : std::vector{b, a, c});
      }
      if (mode == 6) expected.push_back({corners[0], b, c});
    }
    PolygonSoup soup = internal::read_gltf("x.gltf", file.text(), test::Unhurried());
    std::vector<std::vector<int>> found = soup.polygons;
    for (auto& polygon : found) {
      for (int& v : polygon)
        v = static_cast<int>(soup.vertices[static_cast<std::size_t>(v)][0] / 8);
    }
    EXPECT_EQ(found, expected) << file.text();
  }
}

TEST_F(Gltf, TurnedWallsHideWhatIsBehindTheirSeam) {
  for (const char* const name : {"walls_matrix.gltf", "walls_quaternion.gltf"}) {
    SCOPED_TRACE(name);
    const Scene scene(read_mesh(data("readable/") + name));
    for (const Point& p : scene.points()) {
      for (const double x : p) EXPECT_EQ(x, std::round(x));
    }
    const FaceVisibility visibility(scene);
    const GroupAnswer answer =
        visibility.between(scene.faces_named("A"), scene.faces_named("B"), false);
    EXPECT_EQ(answer.verdict, Verdict::Hidden);
  }
}

// Every turn onto the axes, written as a quaternion or matrix in single or double
// precision, with the noise of a cosine in single precision, gives whole coordinates; a
// turn by 1e-6 more does not.
TEST_F(Gltf, RightAnglesAreExact) {
  Random random(4);
  for (int i = 0; i < 4 * kNeighbours; ++i) {
    // A product of quarter turns.
    Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d axis = Eigen::Vector3d::Unit(static_cast<int>(random() % 3));
      q = q * Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 2 * (random() % 4), axis));
    }
    const Eigen::Matrix3d exact = q.toRotationMatrix().array().round();
    const bool as_float = random() % 2 == 0, tilted = i % 4 == 0;
    if (tilted)
      q = q * Eigen::Quaterniond(Eigen::AngleAxisd(1e-6, Eigen::Vector3d::UnitZ()));
    const auto written = [&](double x) {
      return as_float && !tilted ? static_cast<double>(static_cast<float>(x)) : x;
    };
    File file = cube();
    std::vector<double> numbers;
    if (i % 2 == 0) {
      for (const double x : {q.x(), q.y(), q.z(), q.w()}) numbers.push_back(written(x));
      file.node = R"("translation":[4,-8,16],"scale":[2,3,5],"rotation":)" +
                  numbers_text(numbers);
    } else {
      const Eigen::Matrix3d turn = q.toRotationMatrix();
      for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
          double x = turn(row, column);
          if (!tilted && as_float && std::abs(x) < 0.5) x += 4.371139e-8;
          numbers.push_back(written(x) * (tilted ? 2 + column + (column == 2) : 1));
        }
        numbers.push_back(0);
      }
      for (const double x : {4, -8, 16, 1}) numbers.push_back(x);
      file.node = R"("matrix":)" + numbers_text(numbers);
    }
    const PolygonSoup soup =
        internal::read_gltf("x.gltf", file.text(), test::Unhurried());
    const Eigen::Vector3d size =
        i % 2 == 0 || tilted ? Eigen::Vector3d(2, 3, 5) : Eigen::Vector3d(1, 1, 1);
    bool same = true;
    for (int v = 0; v < 8; ++v) {
      const Point local(v & 1, v >> 1 & 1, v >> 2 & 1);
      const Point expected = exact * size.cwiseProduct(local) + Point(4, -8, 16);
      same = same && soup.vertices[static_cast<std::size_t>(v)] == expected;
    }
    EXPECT_EQ(same, !tilted) << file.node;
  }
}

// Chains of nodes that turn by right angles, as any tool writes them, stay on the grid.
TEST_F(Gltf, RightAnglesStayExactInChains) {
  Random random(11);
  for (int i = 0; i < kNeighbours; ++i) {
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    Point move(0, 0, 0);
    std::string nodes;
    const int depth = 2 + i % 4;
    for (int k = 0; k < depth; ++k) {
      const Eigen::Quaterniond q(
          Eigen::AngleAxisd(M_PI / 2 * (random() % 4),
                            Eigen::Vector3d::Unit(static_cast<int>(random() % 3))));
      const Eigen::Matrix3d exact = q.toRotationMatrix().array().round();
      Point step;
      for (double& x : step) x = static_cast<double>(random() % 1000) / 8;
      move = Point(turn * step + move);
      turn = Eigen::Matrix3d(turn * exact);
      const bool as_float = random() % 2 == 0;
      std::vector<double> numbers;
      if (random() % 2 == 0) {
        for (const double x : {q.x(), q.y(), q.z(), q.w()}) {
          numbers.push_back(as_float ? static_cast<double>(static_cast<float>(x)) : x);
        }
        nodes += R"({"rotation":)" + numbers_text(numbers) + R"(,"translation":)" +
                 numbers_text({step[0], step[1], step[2]});
      } else {
        const Eigen::Matrix3d m = q.toRotationMatrix();
        for (int column = 0; column < 3; ++column) {
          for (int row = 0; row < 3; ++row) {
            const double x = m(row, column);
            numbers.push_back(as_float ? static_cast<double>(static_cast<float>(x)) : x);
          }
          numbers.push_back(0);
        }
        for (const double x : step) numbers.push_back(x);
        numbers.push_back(1);
        nodes += R"({"matrix":)" + numbers_text(numbers);
      }
      nodes += k + 1 < depth ? R"(,"children":[)" + std::to_string(k + 1) + "]},"
                             : std::string(R"(,"mesh":0})");
    }
    File file = cube();
    file.nodes = nodes;
    const PolygonSoup soup =
        internal::read_gltf("x.gltf", file.text(), test::Unhurried());
    for (int v = 0; v < 8; ++v) {
      const Point local(v & 1, v >> 1 & 1, v >> 2 & 1);
      EXPECT_EQ(soup.vertices[static_cast<std::size_t>(v)], Point(turn * local + move))
          << nodes;
    }
  }
}

// A chain of nodes against the product of their matrices.
TEST_F(Gltf, TransformationsOfNodesAreComposedInDouble) {
  Random random(5);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int i = 0; i < kNeighbours; ++i) {
    Eigen::Affine3d product = Eigen::Affine3d::Identity();
    std::string nodes;
    const int depth = 1 + i % 5;
    for (int k = 0; k < depth; ++k) {
      const Eigen::Quaterniond q = Eigen::Quaterniond(number(random), number(random),
                                                      number(random), number(random))
                                       .normalized();
      const Point move(number(random), number(random), number(random));
      const Point scale(number(random), 2 + number(random), 1);
      product = product * Eigen::Translation3d(move) * q * Eigen::Scaling(scale);
      nodes += (k > 0 ? "," : "") + std::string(R"({"translation":)") +
               numbers_text({move[0], move[1], move[2]}) + R"(,"rotation":)" +
               numbers_text({q.x(), q.y(), q.z(), q.w()}) + R"(,"scale":)" +
               numbers_text({scale[0], scale[1], scale[2]}) +
               (k + 1 < depth ? R"(,"children":[)" + std::to_string(k + 1) + "]}"
                              : std::string(R"(,"mesh":0})"));
    }
    File file = cube();
    file.nodes = nodes;
    const PolygonSoup soup =
        internal::read_gltf("x.gltf", file.text(), test::Unhurried());
    for (int v = 0; v < 8; ++v) {
      const Point expected = product * Point(v & 1, v >> 1 & 1, v >> 2 & 1);
      EXPECT_LT((soup.vertices[static_cast<std::size_t>(v)] - expected).norm(), 1e-13);
    }
    if (std::abs(product.linear().determinant()) > 1e-3) {
      EXPECT_EQ(Scene(soup).solids(), 1);  // the front stays outside
    }
  }
}

TEST_F(Gltf, ReadsTheSceneOfTheFile) {
  File file = cube();
  file.nodes = R"({"mesh":0,"name":"a"},{"mesh":0,"name":"b","translation":[10,0,0]},)"
               R"({"mesh":0,"name":"c","translation":[20,0,0]})";
  file.scenes = R"([{"nodes":[0]},{"nodes":[1,2]}])";
  const auto names = [&] {
    std::string all;
    const PolygonSoup soup =
        internal::read_gltf("x.gltf", file.text(), test::Unhurried());
    for (const auto& group : soup.groups) all += group.name;
    return all + std::to_string(soup.defects.size());
  };
  EXPECT_EQ(names(), "a1");  // b and c are left out, and told
  file.scene = "1";
  EXPECT_EQ(names(), "bc1");
  file.scene = "";
  EXPECT_EQ(names(), "a1");
  file.scenes = "[]";
  EXPECT_EQ(names(), "abc0");
  file.scene = "2";
  file.scenes = R"([{"nodes":[0]}])";
  EXPECT_NE(complaint_about(file.text()).find("names scene 2 of 1"), std::string::npos);
}

TEST_F(Gltf, RefusesByName) {
  const auto expect = [](const File& file, const std::string& part) {
    const std::string message = complaint_about(file.text());
    EXPECT_TRUE(message.starts_with("x.gltf: ")) << message;
    EXPECT_NE(message.find(part), std::string::npos) << message << "\n" << part;
    EXPECT_EQ(message.find_first_of("\r\n"), std::string::npos);
  };
  const auto changed = [](auto change) {
    File file = cube();
    change(file);
    return file;
  };
  for (const char* const name :
       {"KHR_draco_mesh_compression", "EXT_meshopt_compression",
        "EXT_mesh_gpu_instancing", "KHR_node_visibility", "X_unknown"}) {
    expect(changed([&](File& f) {
             f.root = std::string(R"(,"extensionsRequired":[")") + name + "\"]";
           }),
           "requires the extension '" + std::string(name).substr(0, 24));
  }
  expect(
      changed([](File& f) { f.node = R"("extensions":{"EXT_mesh_gpu_instancing":{}})"; }),
      "instances are not read here");
  expect(changed([](File& f) { f.node = R"("skin":0)"; }), "has a skin");
  expect(changed([](File& f) { f.node = R"("weights":[0,0.5])"; }), "morph targets");
  expect(changed([](File& f) { f.node = R"("matrix":[1,0,0])"; }),
         "nodes[0].matrix is no array of 16 numbers");
  expect(changed([](File& f) { f.node = R"("rotation":[0,0,0,2])"; }),
         "no unit quaternion");
  expect(changed([](File& f) { f.node = R"("rotation":["0",0,0,1])"; }),
         "nodes[0].rotation is no array of 4 numbers");
  expect(
      changed([](File& f) { f.node = R"("matrix":[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1])"; }),
      "last row is not 0 0 0 1");
  expect(changed([](File& f) { f.node = R"("children":[-1])"; }), "nodes[0].children");
  expect(changed([](File& f) { f.node = R"("children":[7])"; }), "names node 7 of 1");
  expect(changed([](File& f) { f.node = R"("children":[0])"; }), "form no tree");
  expect(changed([](File& f) { f.nodes = R"({"mesh":1})"; }), "names mesh 1 of 1");
  expect(changed([](File& f) { f.index_count = 35; }),
         "mesh 0 'm', primitive 0: has 35 indices, no multiple of three");
  expect(changed([](File& f) { f.indices[35 * 4] = 99; }),
         "mesh 0 'm', primitive 0: index 35 names vertex 99 of 8");
  expect(changed([](File& f) { f.index_count = 39; }),
         "ends at byte 156 of a bufferView of 144");
  expect(changed([](File& f) { f.position_count = 9; }),
         "ends at byte 108 of a bufferView of 96");
  expect(changed([](File& f) { f.position_type = 5125; }), "32 bits");
  expect(changed([](File& f) { f.position_type = 5130; }),
         "a type that the format does not have");
  expect(changed([](File& f) { f.index_type = 5126; }), "no whole numbers");
  expect(changed([](File& f) { f.positions[3] = '\x7f', f.positions[2] = '\x80'; }),
         "vertex 0 has a coordinate that is not finite");
  expect(changed([](File& f) { f.mode = "7"; }), "mode is none of the format's");
  expect(changed([](File& f) { f.scenes = R"([{"nodes":[0,0]}])"; }),
         "names node 0 twice");
  std::string text = cube().text();
  text.replace(text.find("POSITION"), 8, "POSITIOM");
  EXPECT_NE(complaint_about(text).find("meshes[0].primitives[0] has no POSITION"),
            std::string::npos);
  text = cube().text();
  text.replace(text.find("base64,"), 10, "base64,!!!");
  EXPECT_NE(complaint_about(text), "");
  text = cube().text();
  text.replace(text.find("\"2.0\""), 5, "\"1.0\"");
  EXPECT_NE(complaint_about(text).find("version '1.0' is not read here"),
            std::string::npos);
}

// Random graphs of nodes: read iff they form a forest whose roots the scene names.
TEST_F(Gltf, NodesThatFormNoTreeAreRefusedBeforeTheyAreUnfolded) {
  EXPECT_NE(complaint([] {
              (void)read_mesh(data("malformed/dag18.gltf"));
            }).find("is a child of node 0 twice: the nodes form no tree"),
            std::string::npos);
  Random random(6);
  int refused = 0;
  for (int i = 0; i < 4 * kNeighbours; ++i) {
    const int count = 2 + static_cast<int>(random() % 30);
    std::vector<std::vector<int>> children(static_cast<std::size_t>(count));
    std::vector<int> parents(static_cast<std::size_t>(count), 0);
    for (int n = 1; n < count; ++n) {  // a tree, in which children come later
      children[random() % static_cast<unsigned>(n)].push_back(n);
      parents[static_cast<std::size_t>(n)] = 1;
    }
    bool is_tree = true;
    if (i % 2 == 0) {  // one more child, of anything
      const auto child = static_cast<int>(random() % static_cast<unsigned>(count));
      children[random() % static_cast<unsigned>(count)].push_back(child);
      is_tree = false;  // a second parent, or a cycle through the root
    }
    File file = cube();
    for (int n = 0; n < count; ++n) {
      file.nodes += n > 0 ? ",{" : "{";
      if (!children[static_cast<std::size_t>(n)].empty()) {
        std::vector<double> list(children[static_cast<std::size_t>(n)].begin(),
                                 children[static_cast<std::size_t>(n)].end());
        file.nodes += R"("children":)" + numbers_text(list) + ",";
      }
      file.nodes += R"("mesh":0})";
    }
    const std::string message = complaint_about(file.text());
    EXPECT_EQ(message.empty(), is_tree) << message << file.nodes;
    if (!is_tree) {
      EXPECT_NE(message.find("form no tree"), std::string::npos) << message;
      ++refused;
    }
  }
  EXPECT_EQ(refused, 2 * kNeighbours);
}

// Chains of nodes are as deep as the file likes.
TEST_F(Gltf, DeepChainsOfNodes) {
  File file = cube();
  constexpr int kDepth = 100'000;
  for (int n = 0; n + 1 < kDepth; ++n) {
    file.nodes += R"({"children":[)" + std::to_string(n + 1) + "]},";
  }
  file.nodes += R"({"mesh":0})";
  EXPECT_EQ(internal::read_gltf("x.gltf", file.text(), test::Unhurried()).polygons.size(),
            12u);
  // Nested extras are passed over.
  std::string text = cube().text();
  text.insert(1,
              "\"extras\":" + std::string(kDepth, '[') + std::string(kDepth, ']') + ",");
  EXPECT_EQ(internal::read_gltf("x.gltf", text, test::Unhurried()).polygons.size(), 12u);
}

TEST_F(Gltf, ManyUsesOfOneMeshAreRefusedBeforeTheyFillTheMemory) {
  File file = cube();
  std::string roots;
  for (int n = 0; n < 200'000; ++n) {
    file.nodes += n > 0 ? R"(,{"mesh":0})" : R"({"mesh":0})";
    roots += (n > 0 ? "," : "") + std::to_string(n);
  }
  file.scenes = R"([{"nodes":[)" + roots + "]}]";
  const std::string once = file.indices;
  for (int k = 0; k < 20; ++k) file.indices += once;
  file.index_count *= 21;
  EXPECT_NE(complaint_about(file.text()).find("unfolds to more than"), std::string::npos);
}

/// A whole file in which every kind of index stands once, as the text before it.
std::string indexed_file() {
  File file = cube();
  // Sparse positions, as in SparsePositionsReplaceDenseOnesOrZeros.
  const std::size_t at = file.positions.size();
  append(file.positions, static_cast<std::uint16_t>(2));
  append(file.positions, static_cast<std::uint16_t>(5));
  for (const float x : {0.F, 1.F, 0.F, 1.F, 0.F, 1.F}) append(file.positions, x);
  file.accessor = R"(,"sparse":{"count":2,"indices":{"bufferView":0,"byteOffset":)" +
                  std::to_string(at) +
                  R"(,"componentType":5123},"values":{"bufferView":0,"byteOffset":)" +
                  std::to_string(at + 4) + "}}";
  file.nodes = R"({"children":[1],"name":"r"},{"mesh":0})";
  std::string text = file.text();
  text.insert(text.find(R"("indices":1)"), R"("material":0,)");
  text.insert(text.find(R"(,"meshes")"), R"(,"materials":[{"name":"m"}])");
  return text;
}

// Every index of the format, out of its range or no index at all.
TEST_F(Gltf, IndicesOutOfRangeAreRefusedWhereverTheyStand) {
  const std::string whole = indexed_file();
  ASSERT_EQ(complaint_about(whole), "");
  const std::vector<std::string> before{R"("scenes":[{"nodes":[)",
                                        R"("scene":)",
                                        R"("children":[)",
                                        R"("mesh":)",
                                        R"("POSITION":)",
                                        R"("indices":)",
                                        R"("material":)",
                                        R"("accessors":[{"bufferView":)",
                                        R"("indices":{"bufferView":)",
                                        R"("values":{"bufferView":)",
                                        R"(,{"bufferView":)",
                                        R"("bufferViews":[{"buffer":)"};
  const std::vector<std::string> no_index{
      "7",     "2147483647", "2147483648", "4294967296", "-1", "-2147483648",
      "1e300", "0.5",        "\"0\"",      "[0]",        "{}", "true"};
  Random random(8);
  for (int i = 0; i < 2 * kNeighbours; ++i) {
    const std::string& place = before[static_cast<std::size_t>(i) % before.size()];
    const std::string& value = no_index[random() % no_index.size()];
    std::string text = whole;
    const std::size_t at = text.find(place);
    ASSERT_NE(at, std::string::npos) << place;
    const std::size_t begin = at + place.size();
    text.replace(begin, text.find_first_not_of("0123456789", begin) - begin, value);
    const std::string message = complaint_about(text);
    EXPECT_TRUE(message.starts_with("x.gltf: ")) << place << value << ": " << message;
    EXPECT_EQ(message.find_first_of("\r\n"), std::string::npos) << message;
  }
}

// Materials with a colour of light that is not black; a mesh of two nodes is there twice.
TEST_F(Gltf, PolygonsWhoseMaterialEmitsAreTold) {
  File file = cube();
  file.nodes = R"({"children":[1,2],"name":"r"},{"mesh":0},{"mesh":0})";
  const auto emitting = [&](const std::string& materials, const std::string& number) {
    std::string text = file.text();
    text.insert(text.find(R"("indices":1)"), R"("material":)" + number + ",");
    text.insert(text.find(R"(,"meshes")"), R"(,"materials":)" + materials);
    return internal::read_gltf("x.gltf", text, test::Unhurried()).emitting;
  };
  const std::string materials =
      R"([{"name":"wall"},{"emissiveFactor":[0,0.25,0]},{"emissiveFactor":[0,0,0]}])";
  std::vector<int> all(24);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(emitting(materials, "1"), all);
  EXPECT_EQ(emitting(materials, "0"), std::vector<int>{});
  EXPECT_EQ(emitting(materials, "2"), std::vector<int>{});
  for (const char* wrong : {"[{\"emissiveFactor\":[1,1]}]", "[{\"emissiveFactor\":1}]",
                            "[{\"emissiveFactor\":[0,\"1\",0]}]", "[1]", "{}", "[]"}) {
    EXPECT_THROW(emitting(wrong, "0"), InvalidInput) << wrong;
  }
  EXPECT_EQ(internal::read_gltf("x.gltf", file.text(), test::Unhurried()).emitting,
            std::vector<int>{});
}

// Indices of vertices, of 8, 16 and 32 bits, dense and sparse: the first bad one is
// named.
TEST_F(Gltf, IndicesOfVerticesThatAreNotThereAreNamed) {
  Random random(9);
  for (int i = 0; i < kNeighbours; ++i) {
    File file = cube();
    const std::string dense = file.indices;
    const int bytes = std::array{1, 2, 4}[random() % 3];
    file.index_type = std::array{0, 5121, 5123, 0, 5125}[static_cast<std::size_t>(bytes)];
    const std::size_t bad = random() % 36;
    std::uint32_t value = 8 + random() % 200;
    if (bytes > 1 && random() % 2 == 0) value = 65534;
    if (bytes == 4 && random() % 2 == 0) value = 0xFFFFFFFE;
    file.indices.clear();
    for (std::size_t k = 0; k < 36; ++k) {
      const auto v = k == bad || (k > bad && random() % 8 == 0)
                         ? value
                         : static_cast<std::uint32_t>(dense[4 * k]);
      for (int b = 0; b < bytes; ++b) {
        file.indices += static_cast<char>(v >> 8 * b & 255);
      }
    }
    const std::string message = complaint_about(file.text());
    EXPECT_NE(message.find("mesh 0 'm', primitive 0: index " + std::to_string(bad) +
                           " names vertex " + std::to_string(value) + " of 8"),
              std::string::npos)
        << message;
  }
}

// Names of buffers with anything in them, written with as many escapes as a writer likes.
TEST_F(Gltf, EscapedUrisNameTheirFiles) {
  const std::string folder =
      testing::TempDir() + "sightline_uris_" + std::to_string(getpid());
  std::filesystem::create_directories(folder + "/d");
  const std::array pieces{" ", "%", "\xC3\xA4", "#", "?", "+", "a", "%20", "\xE2\x82\xAC",
                          "&", "'", "(",        "~", "!", "_", "B"};
  Random random(10);
  for (int i = 0; i < kNeighbours; ++i) {
    std::string name, uri;
    for (std::size_t n = 1 + random() % 6; n > 0; --n) name += pieces[random() % 16];
    name += ".bin";
    const bool below = random() % 4 == 0;
    for (const char c : name) {
      const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' ||
                         c == '.' || c == '~';
      if (plain && random() % 4 != 0) {
        uri += c;
        continue;
      }
      const std::string digits =
          random() % 2 == 0 ? "0123456789ABCDEF" : "0123456789abcdef";
      uri += {'%', digits[static_cast<unsigned char>(c) >> 4],
              digits[static_cast<unsigned char>(c) & 15]};
    }
    const std::string file = folder + (below ? "/d/" : "/") + name;
    const File described = cube();
    std::ofstream(file, std::ios::binary) << described.positions << described.indices;
    std::string text = described.text();
    const std::size_t data_uri = text.find("data:");
    text.replace(data_uri, text.find('"', data_uri) - data_uri,
                 (below ? "d/" : "") + uri);
    std::ofstream(folder + "/x.gltf") << text;
    EXPECT_EQ(
        complaint([&] { EXPECT_EQ(read_mesh(folder + "/x.gltf").polygons.size(), 12U); }),
        "")
        << uri;
    EXPECT_EQ(files_beside(folder + "/x.gltf"), std::vector<std::string>{file}) << uri;
    std::filesystem::remove(file);
    // Now it is not there: told by name.
    const std::string message = complaint([&] { (void)read_mesh(folder + "/x.gltf"); });
    EXPECT_TRUE(message.starts_with(folder + "/x.gltf: ")) << message;
  }
  for (const char* const broken : {"%", "%2", "%zz.bin", "a%00b", "%0", ""}) {
    std::string text = cube().text();
    const std::size_t data_uri = text.find("data:");
    text.replace(data_uri, text.find('"', data_uri) - data_uri, broken);
    EXPECT_NE(complaint_about(text), "") << broken;
  }
  std::filesystem::remove_all(folder);
}

// Copies with a byte changed are read or refused in one line, text and binary alike.
TEST_F(Gltf, SurvivesDamagedFiles) {
  Random random(7);
  for (const char* const name : {"formats/two_cubes.gltf", "formats/two_cubes.glb",
                                 "readable/quantized_bytes.gltf"}) {
    std::ifstream in(data(name), std::ios::binary);
    std::ostringstream whole;
    whole << in.rdbuf();
    int refused = 0;
    for (int i = 0; i < 500; ++i) {
      std::string damaged = whole.str();
      for (int k = 0; k < 1 + i % 3; ++k) {
        const char digits[] = "0123456789-.e\",:{}[]x";
        damaged[random() % damaged.size()] =
            i % 2 == 0 ? static_cast<char>(random()) : digits[random() % 21];
      }
      if (i % 5 == 0) damaged.resize(random() % damaged.size());
      const std::string message = complaint([&] {
        const Scene scene(internal::read_gltf("damaged", damaged, test::Unhurried()));
      });
      EXPECT_EQ(message.find_first_of("\r\n"), std::string::npos) << message;
      EXPECT_LT(message.size(), 400u);
      refused += message.empty() ? 0 : 1;
    }
    EXPECT_GT(refused, 100);
  }
}

}  // namespace
}  // namespace sightline
