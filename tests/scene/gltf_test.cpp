#include <cmath>
#include <limits>

#include "tests/scene/gltf_maker.hpp"

namespace brume::scene {
namespace {

TEST(Gltf, TheSmallestDocument) {
  const auto scene = Document().load().value_or_throw();
  expect_sound(scene);
  EXPECT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(scene.meshes[0].vertices[0].normal, glm::vec3(0, 0, 1)) << "computed";
}

TEST(Gltf, NodesMultiplyDownTheTree) {
  Document document;
  // A quarter turn about y takes x to -z; then the parent scales and moves.
  document.nodes = R"([{"children": [1, 2], "translation": [10, 0, 0], "scale": [2, 2, 2]},
    {"mesh": 0, "rotation": [0, 0.70710678, 0, 0.70710678], "translation": [0, 1, 0]},
    {"mesh": 0, "matrix": [0,1,0,0, -1,0,0,0, 0,0,1,0, 5,6,7,1]}])";
  const auto scene = document.load().value_or_throw();
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_LT(glm::distance(world_corner(scene, 0, 1), glm::vec3(10, 2, -2)), 1e-5f);
  EXPECT_LT(glm::distance(world_corner(scene, 1, 1), glm::vec3(20, 14, 14)), 1e-5f);
  EXPECT_EQ(scene.objects[0].mesh, scene.objects[1].mesh) << "instanced";
}

TEST(Gltf, MirroringNodesKeepTrianglesOutward) {
  Document document;
  document.nodes = R"([{"mesh": 0, "scale": [-1, 1, 1]}])";
  const auto scene = document.load();
  ASSERT_TRUE(scene);
  const glm::vec3 a = world_corner(*scene, 0, 0), b = world_corner(*scene, 0, 1),
                  c = world_corner(*scene, 0, 2);
  EXPECT_GT(glm::cross(b - a, c - a).z, 0) << "still seen from +z";
}

TEST(Gltf, AllIndexTypes) {
  const std::pair<int, Bytes> cases[] = {{5121, triangle().add<std::uint8_t>({0, 2, 1})},
                                         {5123, triangle().add<std::uint16_t>({0, 2, 1})},
                                         {5125, triangle().add<std::uint32_t>({0, 2, 1})}};
  for (const auto& [type, binary] : cases) {
    Document document;
    document.binary = binary;
    document.primitive = R"({"attributes": {"POSITION": 0}, "indices": 1})";
    document.accessors = R"([{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
      {"bufferView": 0, "byteOffset": 36, "count": 3, "type": "SCALAR", "componentType": )" +
                         std::to_string(type) + "}]";
    const auto scene = document.load().value_or_throw();
    EXPECT_EQ(world_corner(scene, 0, 1), glm::vec3(0, 1, 0)) << type;
  }
}

TEST(Gltf, RejectsAnIndexOutOfRange) {
  Document document;
  document.binary.add<std::uint16_t>({0, 1, 3});
  document.primitive = R"({"attributes": {"POSITION": 0}, "indices": 1})";
  document.accessors = R"([{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
    {"bufferView": 0, "byteOffset": 36, "count": 3, "type": "SCALAR", "componentType": 5123}])";
  EXPECT_EQ(document.error(),
            "a.gltf: meshes[0].primitives[0].indices: index 3 (number 2) is out of range: the primitive has "
            "3 vertices");
}

TEST(Gltf, StripsAndFansKeepTheirWinding) {
  for (const int mode : {5, 6}) {
    Document document;
    document.binary = mode == 5 ? Bytes().add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0})
                                : Bytes().add<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    document.accessors = R"([{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}])";
    document.primitive = R"({"attributes": {"POSITION": 0}, "mode": )" + std::to_string(mode) + "}";
    const auto scene = document.load().value_or_throw();
    ASSERT_EQ(scene.meshes[0].indices.size(), 6u);
    for (const Vertex& vertex : scene.meshes[0].vertices)
      EXPECT_EQ(vertex.normal, glm::vec3(0, 0, 1)) << mode;
  }
}

TEST(Gltf, NormalizedTextureCoordinatesAndStrides) {
  Document document;
  // Interleaved: a position, then two 16-bit coordinates.
  document.binary = Bytes();
  for (int i = 0; i < 3; ++i) {
    document.binary.add<float>({float(i == 1), float(i == 2), 0});
    document.binary.add<std::uint16_t>({std::uint16_t(i * 32767), 65535});
  }
  document.views = R"([{"buffer": 0, "byteLength": 48, "byteStride": 16}])";
  document.accessors = R"([{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
    {"bufferView": 0, "byteOffset": 12, "componentType": 5123, "normalized": true, "count": 3, "type": "VEC2"}])";
  document.primitive = R"({"attributes": {"POSITION": 0, "TEXCOORD_0": 1}})";
  const auto scene = document.load().value_or_throw();
  EXPECT_EQ(scene.meshes[0].vertices[1].uv, glm::vec2(32767 / 65535.0f, 1));
  EXPECT_EQ(scene.meshes[0].vertices[2].position, glm::vec3(0, 1, 0));
}

TEST(Gltf, SparseAccessorsReplaceElements) {
  Document document;
  document.binary.add<std::uint16_t>({2, 0}).add<float>({7, 8, 9});
  document.views = R"([{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 2},
    {"buffer": 0, "byteOffset": 40, "byteLength": 12}])";
  document.accessors =
      R"([{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "sparse": {"count": 1,
    "indices": {"bufferView": 1, "componentType": 5123}, "values": {"bufferView": 2}}}])";
  const auto scene = document.load().value_or_throw();
  EXPECT_EQ(world_corner(scene, 0, 1), glm::vec3(1, 0, 0));
  EXPECT_EQ(world_corner(scene, 0, 2), glm::vec3(7, 8, 9));
}

TEST(Gltf, RejectsTruncatedAndOverreachingBuffers) {
  Document truncated;
  truncated.promised = 40;
  EXPECT_HAS(truncated.error(), "a.gltf: buffers[0]: is truncated: expected 40 bytes, found 36");

  Document past_end;
  past_end.accessors =
      R"([{"bufferView": 0, "byteOffset": 4, "componentType": 5126, "count": 3, "type": "VEC3"}])";
  EXPECT_HAS(past_end.error(), "a.gltf: accessors[0]: reaches past its bufferView");

  Document huge;
  huge.accessors = R"([{"bufferView": 0, "componentType": 5126, "count": 4000000000, "type": "VEC3"}])";
  EXPECT_HAS(huge.error(), "accessors[0]: reaches past its bufferView");
  huge.accessors = R"([{"componentType": 5126, "count": 4000000000, "type": "VEC3"}])";
  EXPECT_HAS(huge.error(), "accessors[0]: has too many elements without a bufferView");

  Document view;
  view.views = R"([{"buffer": 0, "byteOffset": 30, "byteLength": 36}])";
  EXPECT_HAS(view.error(), "bufferViews[0]: ends at byte 66 of a buffer of 36");

  Document missing;
  missing.accessors = R"([])";
  EXPECT_HAS(missing.error(), "names accessors[0], but the document has 0 of them");
}

TEST(Gltf, RejectsUrisOutsideOfTheFolder) {
  for (const char* uri : {"../data.bin", "/etc/passwd", "a/../../b.bin", "%2e%2e/data.bin", "C:/data.bin",
                          "..\\\\data.bin", "http://host/data.bin"}) {
    Document document;
    document.uri = uri;
    EXPECT_HAS(document.error(), "is not below the scene's folder");
  }
  Document missing;
  missing.uri = "other.bin";
  EXPECT_HAS(missing.error(),
             "buffers[0].uri: the file \"other.bin\" does not exist below the scene's folder");
}

TEST(Gltf, DataUrisAndPercentEscapes) {
  Document document;
  document.uri = "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
  const auto scene = document.load().value_or_throw();
  EXPECT_EQ(world_corner(scene, 0, 2), glm::vec3(0, 1, 0));
  document.uri = "data:application/octet-stream;base64,A*";
  EXPECT_HAS(document.error(), "expected a data: URI in base64");
  document.uri = "d%61ta.bin";
  EXPECT_TRUE(document.load());
}

TEST(Gltf, RejectsNonFinitePositions) {
  Document document;
  document.binary = Bytes().add<float>({0, 0, 0, 1, std::numeric_limits<float>::quiet_NaN(), 0, 0, 1, 0});
  EXPECT_HAS(document.error(),
             "meshes[0].primitives[0].attributes.POSITION: element 1 of accessors[0] is not finite");
}

TEST(Gltf, LightsKeepTheirUnitsAndFollowTheirNodes) {
  Document document;
  document.nodes = R"([{"mesh": 0}, {"translation": [1, 2, 3], "rotation": [-0.70710678, 0, 0, 0.70710678],
    "extensions": {"KHR_lights_punctual": {"light": 0}}}, {"extensions": {"KHR_lights_punctual": {"light": 1}}},
    {"extensions": {"KHR_lights_punctual": {"light": 2}}}])";
  document.more = R"(, "extensions": {"KHR_lights_punctual": {"lights": [
    {"type": "spot", "color": [1, 0.5, 0], "intensity": 13660, "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.4}},
    {"type": "directional", "intensity": 2049}, {"type": "point"}]}})";
  const auto scene = document.load().value_or_throw();
  ASSERT_EQ(scene.lights.size(), 3u);
  const Light& spot = scene.lights[0];
  EXPECT_EQ(spot.kind, LightKind::spot);
  EXPECT_EQ(spot.intensity, glm::vec3(20, 10, 0));
  EXPECT_EQ(spot.position_world, glm::vec3(1, 2, 3));
  EXPECT_LT(glm::distance(spot.direction_world, glm::vec3(0, -1, 0)), 1e-6f) << "-z turned down";
  EXPECT_FLOAT_EQ(spot.cos_inner, std::cos(0.2f));
  EXPECT_FLOAT_EQ(spot.cos_outer, std::cos(0.4f));
  EXPECT_EQ(scene.lights[1].kind, LightKind::directional);
  EXPECT_EQ(scene.lights[2].kind, LightKind::point);
  document.nodes = R"([{"mesh": 0}, {"extensions": {"KHR_lights_punctual": {"light": 3}}}])";
  EXPECT_HAS(document.error(), "nodes[1].extensions.KHR_lights_punctual.light: names lights[3]");
}

TEST(Gltf, WhatContradictsItselfIsNamedOnce) {
  Document document;
  document.nodes = R"([{"mesh": 0, "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 5,0,0,1], "translation": [1, 2, 3]},
    {"matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1], "rotation": [0, 0, 0, 1]},
    {"extensions": {"KHR_lights_punctual": {"light": 1}}}, {"extensions": {"KHR_lights_punctual": {"light": 0}}}])";
  document.more = R"(, "extensions": {"KHR_lights_punctual": {"lights": [
    {"type": "spot", "spot": {"innerConeAngle": 0.5, "outerConeAngle": 0.4}},
    {"type": "spot", "spot": {"innerConeAngle": 0.4, "outerConeAngle": 0.4}}]}})";
  const LogLines warnings;
  const Scene scene = document.load().value_or_throw();
  EXPECT_EQ(world_corner(scene, 0, 0), glm::vec3(5, 0, 0));
  EXPECT_EQ(scene.lights.at(1).cos_inner, scene.lights[1].cos_outer);
  EXPECT_EQ(
      warnings.lines,
      (std::vector<std::string>{
          "a.gltf: nodes[0]: has a matrix, and a translation, rotation or scale; the matrix alone counts",
          "a.gltf: extensions.KHR_lights_punctual.lights[0].spot: its inner cone is wider than the outer "
          "one, which counts for both"}));
}

TEST(Gltf, MaterialsAndCameras) {
  Document document;
  document.primitive = R"({"attributes": {"POSITION": 0}, "material": 0})";
  document.nodes = R"([{"mesh": 0}, {"camera": 0, "translation": [0, 0, 5]}])";
  document.more = R"(, "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
    "materials": [{"name": "glow", "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.25, 0.8],
    "metallicFactor": 0.1, "roughnessFactor": 0.3},
    "emissiveFactor": [1, 0.5, 0], "alphaMode": "MASK", "alphaCutoff": 0.4,
    "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 10}}}])";
  const auto scene = document.load().value_or_throw();
  const Material& material = scene.materials[scene.objects[0].material];
  EXPECT_EQ(material.base_color, glm::vec3(1, 0.5f, 0.25f));
  EXPECT_EQ(material.emission, glm::vec3(10, 5, 0));
  EXPECT_FLOAT_EQ(material.roughness, 0.3f);
  EXPECT_FLOAT_EQ(material.metallic, 0.1f);
  EXPECT_FLOAT_EQ(material.alpha_cutoff, 0.5f) << "of the texel: the factor is on its side";
  ASSERT_TRUE(scene.camera);
  EXPECT_EQ(scene.camera->position_world, glm::vec3(0, 0, 5));
  EXPECT_LT(glm::distance(scene.camera->target_world, glm::vec3(0, 0, 0)), 1e-5f);
  EXPECT_FLOAT_EQ(scene.camera->vertical_fov, 0.8f);
}

TEST(Gltf, PanesAreWhatBlendsOrTransmits) {
  const auto load = [](const std::string& material, const std::string& node = R"({"mesh": 0})") {
    Document document;
    document.primitive = R"({"attributes": {"POSITION": 0}, "material": 0})";
    document.nodes = "[" + node + "]";
    document.more = R"(, "materials": [)" + material + "]";
    return document.load().value_or_throw();
  };
  const std::string blended =
      R"({"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.3]}})";
  Scene scene = load(blended);
  EXPECT_TRUE(is_pane(scene.objects[0]));
  EXPECT_TRUE(scene.materials[0].blended);
  EXPECT_FLOAT_EQ(scene.materials[0].opacity, 0.3f);
  EXPECT_EQ(scene.materials[0].transmission, 0);

  scene = load(R"({"extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.75}}})");
  EXPECT_TRUE(is_pane(scene.objects[0]));
  EXPECT_FALSE(scene.materials[0].blended);
  EXPECT_EQ(scene.materials[0].opacity, 1);
  EXPECT_FLOAT_EQ(scene.materials[0].transmission, 0.75f);

  // By its role alone, tinted by its colour; and whatever stops less than glass stays a pane.
  scene = load("{}", R"({"mesh": 0, "extras": {"brume_role": "glass"}})");
  EXPECT_TRUE(is_pane(scene.objects[0]));
  EXPECT_EQ(scene.materials[0].transmission, 1);
  EXPECT_TRUE(is_pane(load(blended, R"({"mesh": 0, "extras": {"brume_role": "ghost"}})").objects[0]));
  EXPECT_FALSE(is_pane(load(blended, R"({"mesh": 0, "extras": {"brume_role": "wall"}})").objects[0]));
  EXPECT_FALSE(is_pane(load(R"({"alphaMode": "BLEND"})").objects[0]));
}

TEST(Gltf, MissingImagesAreWarningsWithStandIns) {
  Document document;
  document.primitive = R"({"attributes": {"POSITION": 0}, "material": 0})";
  document.more = R"(, "images": [{"uri": "gone.png"}, {"bufferView": 0, "mimeType": "image/png"}],
    "textures": [{"source": 0}, {"source": 1}],
    "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
    "normalTexture": {"index": 1}}])";
  const LogLines warnings;
  const auto scene = document.load().value_or_throw();
  expect_sound(scene);
  EXPECT_TRUE(warnings.has("a.gltf: images[0]: the image \"gone.png\" does not exist"));
  EXPECT_TRUE(warnings.has("a.gltf: images[1]"));
  EXPECT_NE(scene.materials[0].base_color_image, kNone);
}

// One line for each file, with all that it asks for in vain.
TEST(Gltf, SaysWhatIsNotSupported) {
  const std::string begin = "a.gltf: not supported, and ignored: ";
  const auto warned = [](const std::string& more, const std::string& nodes) {
    Document document;
    document.more = more;
    if (!nodes.empty()) document.nodes = nodes;
    const LogLines warnings;
    document.load().value_or_throw();
    return warnings.lines.empty() ? std::string() : warnings.lines.at(0);
  };
  EXPECT_EQ(warned("", ""), "");
  EXPECT_EQ(warned(R"(, "samplers": [{"wrapS": 33071}])", ""), "");
  EXPECT_EQ(
      warned(R"(, "materials": [{"extensions": {"KHR_materials_transmission": {}}},
                        {"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.7]}}])",
             ""),
      begin +
          "rough KHR_materials_transmission (what is behind the glass is sharp); blending from an alpha of "
          "0.5 on (it is drawn opaque)");
  EXPECT_EQ(warned(R"(, "materials": [{"alphaMode": "BLEND",
                          "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.3]}}])",
                   ""),
            "")
      << "a pane";
  EXPECT_EQ(
      warned(R"(, "materials": [{"extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.3}},
                          "pbrMetallicRoughness": {"roughnessFactor": 0}}])",
             ""),
      begin + "KHR_materials_transmission below 0.5 (it is drawn opaque)");
  EXPECT_EQ(warned(R"(, "cameras": [{"type": "orthographic",
                          "orthographic": {"xmag": 1, "ymag": 1, "zfar": 10, "znear": 0.1}}])",
                   ""),
            begin + "orthographic cameras (views are perspective)");
  EXPECT_EQ(warned(R"(, "materials": [{"alphaMode": "BLEND"}])", ""), "") << "opaque all the same";
}

TEST(Gltf, InstancesAreObjectsOfOneMesh) {
  Document document;
  // Moved by 0, (3, 0, 0) and (0, 5, 0), the last one turned a quarter about z.
  document.binary.add<float>(
      {0, 0, 0, 3, 0, 0, 0, 5, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0.70710678f, 0.70710678f});
  document.accessors = R"([{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
    {"bufferView": 0, "byteOffset": 36, "componentType": 5126, "count": 3, "type": "VEC3"},
    {"bufferView": 0, "byteOffset": 72, "componentType": 5126, "count": 3, "type": "VEC4"}])";
  const auto node = [](const char* attributes) {
    return R"([{"mesh": 0, "scale": [2, 2, 2], "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {)" +
           std::string(attributes) + "}}}}]";
  };
  document.nodes = node(R"("TRANSLATION": 1, "ROTATION": 2)");
  document.more = R"(, "extensionsRequired": ["EXT_mesh_gpu_instancing"])";
  const auto scene = document.load().value_or_throw();
  ASSERT_EQ(scene.objects.size(), 3u);
  EXPECT_EQ(scene.meshes.size(), 1u);
  EXPECT_LT(glm::distance(world_corner(scene, 0, 1), glm::vec3(2, 0, 0)), 1e-5f);
  EXPECT_LT(glm::distance(world_corner(scene, 1, 1), glm::vec3(8, 0, 0)), 1e-5f);
  EXPECT_LT(glm::distance(world_corner(scene, 2, 1), glm::vec3(0, 12, 0)), 1e-5f);
  document.nodes = node("");
  EXPECT_EQ(document.load().value_or_throw().objects.size(), 1u);
  document.nodes = node(R"("TRANSLATION": 9)");
  EXPECT_HAS(document.error(), "nodes[0].extensions.EXT_mesh_gpu_instancing.attributes.TRANSLATION");
  document.accessors.replace(document.accessors.rfind("\"count\": 3"), 10, "\"count\": 2");
  document.nodes = node(R"("TRANSLATION": 1, "ROTATION": 2)");
  EXPECT_HAS(document.error(), "have different counts");
}

TEST(Gltf, MorphTargetsCountByTheirWeights) {
  Document document;
  document.binary.add<float>({0, 0, 1, 0, 0, 2, 0, 0, 4});
  document.accessors = R"([{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
    {"bufferView": 0, "byteOffset": 36, "componentType": 5126, "count": 3, "type": "VEC3"}])";
  document.primitive = R"({"attributes": {"POSITION": 0}, "targets": [{"POSITION": 1}, {"POSITION": 1}]})";
  document.nodes = R"([{"mesh": 0}, {"mesh": 0, "weights": [0.5, 1]}, {"mesh": 0, "weights": [0.5, 1]}])";
  const auto scene = document.load().value_or_throw();
  EXPECT_EQ(world_corner(scene, 0, 2), glm::vec3(0, 1, 0));
  EXPECT_EQ(world_corner(scene, 1, 0), glm::vec3(0, 0, 1.5f));
  EXPECT_EQ(world_corner(scene, 1, 2), glm::vec3(0, 1, 6));
  EXPECT_EQ(scene.objects[1].mesh, scene.objects[2].mesh);
  document.nodes = R"([{"mesh": 0, "weights": [0.5, 1e300]}])";
  EXPECT_HAS(document.error(), "nodes[0].weights[1]");
  document.nodes = R"([{"mesh": 0, "weights": [1e6]}])";
  const float far = 1e38f;
  document.binary.data.replace(36, sizeof far, std::string(reinterpret_cast<const char*>(&far), sizeof far));
  EXPECT_HAS(document.error(), "meshes[0].primitives[0].targets[0].POSITION: with its weight");
  document.primitive = R"({"attributes": {"POSITION": 0}, "targets": [{"POSITION": 7}]})";
  EXPECT_HAS(document.error(), "meshes[0].primitives[0].targets[0].POSITION");
}

TEST(Gltf, MarksThatExcludeObjectsFromTheVoxels) {
  Document document;
  document.nodes =
      R"([{"mesh": 0}, {"mesh": 0, "name": "IGNORE_x"}, {"extras": {"brume_ignore": true}, "children": [3]},
    {"mesh": 0}, {"mesh": 0, "extras": [1]}, {"mesh": 0, "name": "Grenade", "translation": [3, 3, 3]}])";
  const auto scene = document.load().value_or_throw();
  ASSERT_EQ(scene.objects.size(), 4u);
  EXPECT_EQ(scene.objects[0].role, Role::wall);
  EXPECT_EQ(scene.objects[1].role, Role::ghost);
  EXPECT_EQ(scene.objects[2].role, Role::ghost) << "handed down";
  EXPECT_EQ(scene.objects[3].role, Role::wall);
  EXPECT_EQ(scene.grenade->name, "Grenade");
  EXPECT_EQ(glm::vec3(scene.grenade->world_from_mesh[3]), glm::vec3(0));
}

TEST(Gltf, RejectsBrokenStructure) {
  Document cycle;
  cycle.nodes = R"([{"mesh": 0}, {"children": [2]}, {"children": [1]}])";
  cycle.more = R"(, "scenes": [{"nodes": [1]}])";
  EXPECT_HAS(cycle.error(), "nodes[1]: is reached twice; expected a tree");
  Document unknown;
  unknown.more = R"(, "extensionsRequired": ["KHR_materials_unlit", "KHR_texture_basisu"])";
  EXPECT_HAS(unknown.error(), "extensionsRequired[1]: the file requires the extension KHR_texture_basisu");
  Document word;
  word.nodes = R"([{"mesh": 0, "translation": [0, "up", 0]}])";
  EXPECT_HAS(word.error(), "a.gltf: nodes[0].translation[1]: expected a number, found");
  Document syntax;
  syntax.nodes = "[\n  {]";
  EXPECT_EQ(syntax.error().substr(0, 14), "a.gltf:2:4: in");
  EXPECT_HAS(syntax.error(), "invalid JSON");
}

TEST(Gltf, RejectsValuesOfAWrongType) {
  const std::pair<const char*, const char*> nodes[] = {
      {R"([{"mesh": 4294967296}])", "nodes[0].mesh: names meshes[4294967296]"},
      {R"([{"mesh": "0"}])", "nodes[0].mesh: expected a whole number, found"},
      {R"([{"mesh": -1}])", "nodes[0].mesh: expected a whole number, found"},
      {R"([{"mesh": 0, "children": [true]}])", "nodes[0].children[0]: expected a whole number, found"},
      {R"([{"mesh": 0, "scale": [1, 1]}])", "nodes[0].scale: expected 3 numbers, found 2"},
      {R"({"mesh": 0})", "nodes: expected an array, found an object"},
      {R"([7])", "nodes[0]: expected an object, found"}};
  for (const auto& [value, message] : nodes) {
    Document document;
    document.nodes = value;
    EXPECT_HAS(document.error(), message);
  }
  Document primitive;
  primitive.primitive = R"({"attributes": {"POSITION": 0, "NORMAL": "0"}})";
  EXPECT_HAS(primitive.error(), "meshes[0].primitives[0].attributes.NORMAL: expected a whole number, found");
  primitive.primitive = "{}";
  EXPECT_HAS(primitive.error(), "meshes[0].primitives[0]: expected a member \"attributes\"");
  Document material;
  material.more = R"(, "materials": [{"pbrMetallicRoughness": {"roughnessFactor": 2}}])";
  EXPECT_HAS(material.error(), "materials[0].pbrMetallicRoughness.roughnessFactor: expected a number from 0");
}

TEST(Gltf, RejectsDeepNesting) {
  Document document;
  document.more = ", \"extras\": " + std::string(1000000, '[') + "1" + std::string(1000000, ']');
  EXPECT_HAS(document.error(), "is nested too deeply");
}

TEST(Gltf, RejectsImagesOutsideOfTheirBuffer) {
  for (const char* offset : {"0", "36", "4294967296"}) {
    Document document;
    document.views = std::string(R"([{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteLength": 37,
      "byteOffset": )") +
                     offset + "}]";
    document.more = R"(, "images": [{"bufferView": 1, "mimeType": "image/png"}])";
    EXPECT_HAS(document.error(), "bufferViews[1]: ends at byte");
  }
}

TEST(Gltf, FilesMayBeLongerThanTheirBuffer) {
  Document document;
  document.promised = 36;
  document.binary.add<float>({5});
  document.views = R"([{"buffer": 0, "byteLength": 36}])";
  EXPECT_TRUE(document.load());
}

TEST(Gltf, PlusInAnUriIsPartOfTheFileName) {
  MemoryFiles files;
  files.add_text("a+b.bin", triangle().data);
  Document document;
  document.uri = "a+b.bin";
  const std::string text = document.json();
  EXPECT_TRUE(parse_gltf(std::as_bytes(std::span(text)), "a.gltf", files));
}

TEST(Glb, LoadsAndRejectsEveryTruncation) {
  Document document;
  document.uri = "";
  const std::string glb = glb_of(document.json(), document.binary.data);
  const MemoryFiles files;
  const auto load = [&](std::size_t size) {
    return parse_gltf(std::as_bytes(std::span(glb).first(size)), "a.glb", files);
  };
  const auto whole = load(glb.size()).value_or_throw();
  EXPECT_EQ(world_corner(whole, 0, 2), glm::vec3(0, 1, 0));
  for (std::size_t size = 0; size < glb.size(); ++size) EXPECT_FALSE(load(size)) << size;
}

TEST(Glb, TheLengthOfItsJsonIsAMultipleOf4) {
  Document document;
  document.uri = "";
  std::string glb = glb_of(document.json(), document.binary.data);
  glb[12] = static_cast<char>(glb[12] | 1);
  const auto scene = parse_gltf(std::as_bytes(std::span(glb)), "a.glb", MemoryFiles());
  ASSERT_FALSE(scene);
  EXPECT_HAS(scene.failure().message, "a.glb: the JSON chunk of the GLB file has ");
  EXPECT_HAS(scene.failure().message, " bytes; expected a multiple of 4, filled up with blanks");
}

}  // namespace
}  // namespace brume::scene
