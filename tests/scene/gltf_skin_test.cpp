// Meshes of skins, in the pose in which their joints stand in the file.
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <random>

#include "tests/scene/gltf_maker.hpp"

namespace brume::scene {
namespace {

/// A triangle with a skin of two joints. The nodes: the mesh, far off; joint 1, whose child joint 2 is.
struct Skinned : Document {
  /// Joints and weights of the three vertices.
  explicit Skinned(const Bytes& joints = Bytes().add<std::uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}),
                   const Bytes& weights = Bytes().add<float>({1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0})) {
    binary.data += joints.data + weights.data;
    // joint_from_mesh: moved down by 1, and by 2.
    binary.add<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1});
    binary.add<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -2, 0, 1});
    primitive = R"({"attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}})";
    nodes = R"([{"mesh": 0, "skin": 0, "translation": [100, 0, 0]},
      {"translation": [0, 10, 0], "children": [2]}, {"translation": [0, 1, 0], "scale": [2, 2, 2]}])";
    accessors = R"([{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
      {"bufferView": 0, "byteOffset": 36, "componentType": 5121, "count": 3, "type": "VEC4"},
      {"bufferView": 0, "byteOffset": 48, "componentType": 5126, "count": 3, "type": "VEC4"},
      {"bufferView": 0, "byteOffset": 96, "componentType": 5126, "count": 2, "type": "MAT4"}])";
    more = R"(, "skins": [{"joints": [1, 2], "inverseBindMatrices": 3}])";
  }

  void replace(std::string Document::*text, const std::string& from, const std::string& to) {
    (this->*text).replace((this->*text).find(from), from.size(), to);
  }
};

void expect_corners(const Scene& scene, std::initializer_list<glm::vec3> corners) {
  std::size_t at = 0;
  for (const glm::vec3 corner : corners) {
    const glm::vec3 found = world_corner(scene, 0, at++);
    EXPECT_LT(glm::distance(found, corner), 1e-5f) << found.x << ' ' << found.y << ' ' << found.z;
  }
}

TEST(GltfSkin, JointsPlaceTheirVertices) {
  const LogLines warnings;
  const auto scene = Skinned().load().value_or_throw();
  expect_sound(scene);
  EXPECT_EQ(warnings.lines, std::vector<std::string>());
  // By joint 1: up by 9. By joint 2: 2 p + (0, 7, 0). By the mean of both. The mesh's own node moves nothing.
  expect_corners(scene, {{0, 9, 0}, {2, 7, 0}, {0, 9.5f, 0}});
  const Skinned document;
  keep_as_seed("skin.glb", glb_of(
                               [&] {
                                 Skinned embedded;
                                 embedded.uri = "";
                                 return embedded.json();
                               }(),
                               document.binary.data));
}

TEST(GltfSkin, WithoutInverseBindMatricesTheyAreOne) {
  Skinned document;
  document.replace(&Document::more, R"(, "inverseBindMatrices": 3)", "");
  expect_corners(document.load().value_or_throw(), {{0, 10, 0}, {2, 11, 0}, {0, 12, 0}});
}

TEST(GltfSkin, WeightsAreNormalizedAndTheFirstJointIsTheDefault) {
  const Skinned document(Bytes().add<std::uint8_t>({1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}),
                         Bytes().add<float>({0, 0, 0, 0, 0.25f, 0, 0, 0, 2, 2, 0, 0}));
  expect_corners(document.load().value_or_throw(), {{0, 9, 0}, {2, 7, 0}, {0, 9.5f, 0}});
}

TEST(GltfSkin, PartsOfAPersonAreEachTheirOwn) {
  Skinned document;
  document.replace(&Document::nodes, "[{", R"([{"mesh": 0, "skin": 0, "name": "twin"}, {)");
  document.replace(&Document::nodes, R"("children": [2])", R"("children": [3])");
  document.replace(&Document::more, "[1, 2]", "[2, 3]");
  document.replace(&Document::nodes, R"("scale": [2, 2, 2]})", R"("scale": [2, 2, 2]}, {"mesh": 0})");
  const Scene scene = document.load().value_or_throw();
  ASSERT_EQ(scene.objects.size(), 3u);
  EXPECT_EQ(scene.objects[0].mesh, scene.objects[1].mesh) << "one skin, one mesh";
  EXPECT_EQ(world_corner(scene, 2, 1), glm::vec3(1, 0, 0)) << "the same mesh without a skin";
}

// Normals against a matrix in double precision; the winding against a mirroring joint.
TEST(GltfSkin, NormalsAndWindingFollow) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(0.3, 2);
  for (const double sign : {1.0, -1.0}) {
    const glm::dvec3 scale{sign * number(random), number(random), number(random)};
    const double angle = number(random);
    Skinned document;
    document.binary.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1});
    document.primitive = R"({"attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2, "NORMAL": 4}})";
    document.accessors.back() = ',';
    document.accessors +=
        R"({"bufferView": 0, "byteOffset": 224, "componentType": 5126, "count": 3, "type": "VEC3"}])";
    const std::string turn = "\"rotation\": [0, " + std::to_string(std::sin(angle / 2)) + ", 0, " +
                             std::to_string(std::cos(angle / 2)) + "], \"scale\": [" +
                             std::to_string(scale.x) + ", " + std::to_string(scale.y) + ", " +
                             std::to_string(scale.z) + "]";
    document.nodes = R"([{"mesh": 0, "skin": 0}, {)" + turn + "}, {" + turn + "}]";
    const Scene scene = document.load().value_or_throw();
    expect_sound(scene);
    const Mesh& mesh = scene.meshes[scene.objects[0].mesh];
    const glm::dmat3 linear = glm::dmat3(glm::rotate(glm::dmat4(1), angle, {0, 1, 0})) *
                              glm::dmat3(scale.x, 0, 0, 0, scale.y, 0, 0, 0, scale.z);
    const glm::dvec3 expected = glm::normalize(glm::transpose(glm::inverse(linear)) * glm::dvec3(0, 0, 1));
    for (const Vertex& vertex : mesh.vertices)
      EXPECT_LT(glm::distance(glm::dvec3(vertex.normal), expected), 1e-5);
    // Counter-clockwise as seen from the side of the normal.
    const auto corner = [&](std::size_t i) { return mesh.vertices[mesh.indices[i]].position; };
    EXPECT_GT(glm::dot(glm::cross(corner(1) - corner(0), corner(2) - corner(0)), mesh.vertices[0].normal), 0);
  }
}

TEST(GltfSkin, SaysWhatIsWrong) {
  const auto error = [](std::string Document::*text, const std::string& from, const std::string& to) {
    Skinned document;
    document.replace(text, from, to);
    return document.error();
  };
  EXPECT_HAS(error(&Document::primitive, R"(, "WEIGHTS_0": 2)", ""), "expected JOINTS_0 and WEIGHTS_0");
  EXPECT_HAS(error(&Document::primitive, R"(, "JOINTS_0": 1, "WEIGHTS_0": 2)", ""),
             "because its node has a skin");
  EXPECT_HAS(error(&Document::more, "[1, 2]", "[1]"), "names a joint beyond the 1 of its skin");
  EXPECT_HAS(error(&Document::more, "[1, 2]", "[1, 2, 2]"),
             "inverseBindMatrices: expected a matrix for each joint");
  EXPECT_HAS(error(&Document::more, "[1, 2]", "[]"), "skins[0].joints: expected at least one joint");
  EXPECT_HAS(error(&Document::more, "[1, 2]", "[1, 3]"), "skins[0].joints[1]");
  EXPECT_HAS(error(&Document::more, "\"inverseBindMatrices\": 3", "\"inverseBindMatrices\": 0"),
             "expected an accessor of MAT4");
  EXPECT_HAS(error(&Document::nodes, "\"skin\": 0", "\"skin\": 1"), "nodes[0].skin");
  EXPECT_HAS(error(&Document::nodes, "[2, 2, 2]", "[1e9, 2, 2]"), "farther than 10,000 km");
  // A circle of nodes that no scene shows.
  EXPECT_HAS(error(&Document::nodes, R"("scale": [2, 2, 2]})",
                   R"("children": [1]}], "scene": 0, "scenes": [{"nodes": [0]})"),
             "is an ancestor of itself");
}

}  // namespace
}  // namespace brume::scene
