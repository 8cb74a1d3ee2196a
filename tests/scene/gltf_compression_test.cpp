// Meshes that Draco, meshoptimizer and quantization compress. The libraries' own encoders make the files.
#include <draco/compression/expert_encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include <array>
#include <cmath>

#include "tests/scene/gltf_maker.hpp"

namespace brume::scene {
namespace {

/// A square of two triangles in the x-y plane.
constexpr std::array<glm::vec3, 4> kSquare{glm::vec3(0, 0, 0), {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
constexpr std::array<std::uint32_t, 6> kSquareIndices{0, 1, 2, 0, 2, 3};

double area(const Scene& scene) {
  double sum = 0;
  const Mesh& mesh = scene.meshes[scene.objects.at(0).mesh];
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const glm::vec3 a = world_corner(scene, 0, i), b = world_corner(scene, 0, i + 1),
                    c = world_corner(scene, 0, i + 2);
    sum += glm::length(glm::cross(b - a, c - a)) / 2;
  }
  return sum;
}

// ---- Draco

/// The square with positions and colours, whose ids are 0 and 1.
std::string draco_square(int method = draco::MESH_EDGEBREAKER_ENCODING) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(2);
  const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int color = builder.AddAttribute(draco::GeometryAttribute::COLOR, 4, draco::DT_UINT8);
  const std::uint8_t red[4] = {255, 0, 0, 255};
  for (std::uint32_t face = 0; face < 2; ++face) {
    const auto corner = [&](std::uint32_t i) { return &kSquare[kSquareIndices[3 * face + i]]; };
    const draco::FaceIndex at(face);
    builder.SetAttributeValuesForFace(position, at, corner(0), corner(1), corner(2));
    builder.SetAttributeValuesForFace(color, at, red, red, red);
  }
  const auto mesh = builder.Finalize();
  draco::ExpertEncoder encoder(*mesh);
  encoder.SetEncodingMethod(method);
  encoder.SetAttributeQuantization(position, 14);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeToBuffer(&buffer).ok());
  return {buffer.data(), buffer.size()};
}

/// Accessors without buffer views, as in files that require the extension.
Document draco_document(const std::string& compressed, int vertices = 4, int corners = 6) {
  Document document;
  document.binary.data = compressed;
  document.primitive = R"({"attributes": {"POSITION": 0, "COLOR_0": 2}, "indices": 1, "extensions":
    {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0, "COLOR_0": 1}}}})";
  const std::string count = std::to_string(vertices);
  document.accessors = R"([{"componentType": 5126, "count": )" + count + R"(, "type": "VEC3"},
    {"componentType": 5123, "count": )" +
                       std::to_string(corners) + R"(, "type": "SCALAR"},
    {"componentType": 5121, "normalized": true, "count": )" +
                       count + R"(, "type": "VEC4"}])";
  document.more = R"(, "extensionsRequired": ["KHR_draco_mesh_compression"])";
  return document;
}

TEST(Draco, BothMethodsKeepTheMesh) {
  for (const int method : {draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING}) {
    const auto scene = draco_document(draco_square(method)).load().value_or_throw();
    expect_sound(scene);
    EXPECT_EQ(scene.meshes[0].indices.size(), 6u);
    EXPECT_NEAR(area(scene), 4, 1e-3);
    EXPECT_EQ(scene.meshes[0].vertices[0].color, glm::vec4(1, 0, 0, 1));
  }
}

TEST(Draco, AGlbLoadsToo) {
  for (const int method : {draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING}) {
    Document document = draco_document(draco_square(method));
    document.uri = "";
    const std::string glb = glb_of(document.json(), document.binary.data);
    keep_as_seed(method == draco::MESH_EDGEBREAKER_ENCODING ? "draco.glb" : "draco_sequential.glb", glb);
    const auto scene = load_gltf(glb, {});
    ASSERT_TRUE(scene) << scene.failure().message;
    EXPECT_NEAR(area(*scene), 4, 1e-3);
  }
}

TEST(Draco, DeclaredCountsAreLimited) {
  const std::string square = draco_square();
  EXPECT_HAS(draco_document(square, 3, 6).error(), "declares more than its accessors");
  EXPECT_HAS(draco_document(square, 4, 3).error(), "declares more than its accessors");

  // The header of 11 bytes, then the number of triangles: 2 becomes 2^26, which would take gigabytes.
  std::string huge = draco_square(draco::MESH_SEQUENTIAL_ENCODING);
  ASSERT_EQ(huge[11], 2);
  huge.replace(11, 1, "\x80\x80\x80\x20");
  EXPECT_HAS(draco_document(huge, 4, 3 << 26).error(), "declares more than its accessors and its");
}

TEST(Draco, ErrorsNameTheExtension) {
  std::string old_version = draco_square();
  old_version[6] = 1;
  EXPECT_HAS(draco_document(old_version).error(), "expected version 2.2, found 2.1");
  EXPECT_HAS(draco_document("NO DRACO").error(),
             "a.gltf: meshes[0].primitives[0].extensions.KHR_draco_mesh_compression: the Draco mesh");
  Document wrong_id = draco_document(draco_square());
  wrong_id.primitive.replace(wrong_id.primitive.rfind('1'), 1, "7");
  EXPECT_HAS(wrong_id.error(), "the Draco mesh has no attribute 7");
}

TEST(Draco, DamagedMeshesAreErrorsOrMeshes) {
  for (const int method : {draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING}) {
    const std::string square = draco_square(method);
    for (std::size_t i = 1; i < square.size(); ++i) {
      EXPECT_FALSE(draco_document(square.substr(0, i)).load()) << i;
      for (const char bits : {'\x01', '\x40', '\xff'}) {
        std::string damaged = square;
        damaged[i] = static_cast<char>(damaged[i] ^ bits);
        if (const auto scene = draco_document(damaged).load()) expect_sound(*scene);
      }
    }
  }
}

// ---- meshoptimizer

struct MeshoptPart {
  std::string mode, filter;
  std::size_t count, stride;
  std::vector<unsigned char> bytes;

  /// A view of the buffer that has no data, compressed from byte `offset` of buffer 0.
  std::string view(std::size_t offset) const {
    const auto number = [](std::size_t value) { return std::to_string(value); };
    return R"({"buffer": 1, "byteLength": )" + number(count * stride) +
           (mode == "ATTRIBUTES" && stride % 4 == 0 ? R"(, "byteStride": )" + number(stride) : "") +
           R"(, "extensions": {"EXT_meshopt_compression": {"buffer": 0, "byteOffset": )" + number(offset) +
           R"(, "byteLength": )" + number(bytes.size()) + R"(, "byteStride": )" + number(stride) +
           R"(, "count": )" + number(count) + R"(, "mode": ")" + mode + R"(", "filter": ")" + filter +
           R"("}}})";
  }
};

MeshoptPart meshopt_attribute(const void* data, std::size_t count, std::size_t stride,
                              const std::string& filter = "NONE") {
  MeshoptPart part{"ATTRIBUTES", filter, count, stride, {}};
  part.bytes.resize(meshopt_encodeVertexBufferBound(count, stride));
  part.bytes.resize(meshopt_encodeVertexBuffer(part.bytes.data(), part.bytes.size(), data, count, stride));
  return part;
}

MeshoptPart meshopt_indices(const std::string& mode, std::size_t stride) {
  MeshoptPart part{mode, "NONE", kSquareIndices.size(), stride, {}};
  part.bytes.resize(1000);
  const auto encode = mode == "TRIANGLES" ? meshopt_encodeIndexBuffer<std::uint32_t>
                                          : meshopt_encodeIndexSequence<std::uint32_t>;
  part.bytes.resize(
      encode(part.bytes.data(), part.bytes.size(), kSquareIndices.data(), kSquareIndices.size()));
  return part;
}

/// The parts are positions, indices and, if there are three, normals. The second buffer has no data.
Document meshopt_document(const std::vector<MeshoptPart>& parts) {
  Document document;
  document.binary.data.clear();
  document.views = "[";
  for (const MeshoptPart& part : parts) {
    document.views += (document.views.size() > 1 ? ", " : "") + part.view(document.binary.size());
    document.binary.data.append(part.bytes.begin(), part.bytes.end());
  }
  document.views += "]";
  document.primitive = R"({"attributes": {"POSITION": 0)" +
                       std::string(parts.size() > 2 ? R"(, "NORMAL": 2)" : "") + R"(}, "indices": 1})";
  document.accessors = R"([{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
    {"bufferView": 1, "count": 6, "type": "SCALAR", "componentType": )" +
                       std::string(parts[1].stride == 2 ? "5123}" : "5125}");
  if (parts.size() > 2) {
    document.accessors +=
        R"(, {"bufferView": 2, "componentType": 5120, "normalized": true, "count": 4, "type": "VEC3"})";
  }
  document.accessors += "]";
  document.more = R"(, "extensionsRequired": ["EXT_meshopt_compression"])";
  return document;
}

/// Document makes one buffer; this adds the one without data.
std::string with_fallback(const Document& document) {
  std::string json = document.json();
  const std::size_t end = json.find(']', json.find("\"buffers\""));
  json.insert(end,
              R"(, {"byteLength": 100000, "extensions": {"EXT_meshopt_compression": {"fallback": true}}})");
  return json;
}

Result<Scene> load_meshopt(const Document& document) {
  MemoryFiles files;
  files.add_text("data.bin", document.binary.data);
  return load_gltf(with_fallback(document), files);
}

std::string meshopt_error(const Document& document) {
  const auto scene = load_meshopt(document);
  return scene ? "no error" : scene.failure().message;
}

MeshoptPart square_positions() {
  return meshopt_attribute(kSquare.data(), kSquare.size(), sizeof(glm::vec3));
}

TEST(Meshopt, AllModesAndIndexSizesKeepTheMesh) {
  for (const char* mode : {"TRIANGLES", "INDICES"}) {
    for (const std::size_t stride : {2u, 4u}) {
      const auto scene = load_meshopt(meshopt_document({square_positions(), meshopt_indices(mode, stride)}));
      ASSERT_TRUE(scene) << scene.failure().message;
      expect_sound(*scene);
      EXPECT_EQ(area(*scene), 4);
    }
  }
}

TEST(Meshopt, AGlbLoadsToo) {
  Document document = meshopt_document({square_positions(), meshopt_indices("TRIANGLES", 2)});
  document.uri = "";
  const std::string glb = glb_of(with_fallback(document), document.binary.data);
  keep_as_seed("meshopt.glb", glb);
  const auto scene = load_gltf(glb, {});
  ASSERT_TRUE(scene) << scene.failure().message;
  EXPECT_EQ(area(*scene), 4);
}

TEST(Meshopt, FiltersAreUndone) {
  // Normals as octahedra in 8 bits; positions as exponents and mantissas.
  const std::vector<glm::vec4> normals(4, glm::vec4(glm::normalize(glm::vec3(1, 2, 2)), 0));
  std::vector<std::int8_t> octahedra(16);
  meshopt_encodeFilterOct(octahedra.data(), 4, 4, 8, &normals[0].x);
  std::vector<std::uint32_t> exponents(12);
  meshopt_encodeFilterExp(exponents.data(), 4, sizeof(glm::vec3), 20, &kSquare[0].x);
  Document document = meshopt_document({meshopt_attribute(exponents.data(), 4, 12, "EXPONENTIAL"),
                                        meshopt_indices("TRIANGLES", 4),
                                        meshopt_attribute(octahedra.data(), 4, 4, "OCTAHEDRAL")});
  const auto scene = load_meshopt(document).value_or_throw();
  EXPECT_NEAR(area(scene), 4, 1e-4);
  document.uri = "";
  keep_as_seed("meshopt_filters.glb", glb_of(with_fallback(document), document.binary.data));
  EXPECT_LT(glm::distance(scene.meshes[0].vertices[2].normal, glm::vec3(1, 2, 2) / 3.0f), 0.02f);
}

TEST(Meshopt, ParametersAreChecked) {
  const auto error_of = [](auto change) {
    std::vector<MeshoptPart> parts{square_positions(), meshopt_indices("TRIANGLES", 4)};
    change(parts[0], parts[1]);
    return meshopt_error(meshopt_document(parts));
  };
  EXPECT_EQ(
      error_of([](MeshoptPart& positions, MeshoptPart&) { positions.mode = "POINTS"; }),
      "a.gltf: bufferViews[0].extensions.EXT_meshopt_compression.mode: expected ATTRIBUTES, TRIANGLES or "
      "INDICES, found \"POINTS\"");
  EXPECT_HAS(error_of([](MeshoptPart& positions, MeshoptPart&) { positions.filter = "SEPIA"; }),
             ".filter: expected");
  EXPECT_HAS(error_of([](MeshoptPart& positions, MeshoptPart&) { positions.filter = "QUATERNION"; }),
             "does not fit");
  EXPECT_HAS(error_of([](MeshoptPart& positions, MeshoptPart&) { positions.stride = 10; }),
             "a multiple of 4");
  EXPECT_HAS(error_of([](MeshoptPart& positions, MeshoptPart&) { positions.count = 1000; }),
             "1000 elements cannot be compressed to");
  EXPECT_HAS(error_of([](MeshoptPart&, MeshoptPart& indices) { indices.stride = 8; }), "expected 2 or 4");
  EXPECT_HAS(error_of([](MeshoptPart&, MeshoptPart& indices) { indices.count = 7; }), "a multiple of 3");

  Document longer = meshopt_document({square_positions(), meshopt_indices("TRIANGLES", 4)});
  longer.views.replace(longer.views.find("\"byteLength\": 48"), 16, "\"byteLength\": 52");
  EXPECT_HAS(meshopt_error(longer), "do not give the byteLength");
}

TEST(Meshopt, RangesAreChecked) {
  Document document = meshopt_document({square_positions(), meshopt_indices("TRIANGLES", 4)});
  const std::string views = document.views;
  document.views.replace(views.find("\"byteOffset\": 0"), 15, "\"byteOffset\": 900");
  EXPECT_HAS(meshopt_error(document), "EXT_meshopt_compression: ends at byte");
  document.views = views;
  document.views.replace(views.find("{\"buffer\": 0"), 12, "{\"buffer\": 1");
  EXPECT_HAS(meshopt_error(document), "bufferViews[0].buffer: the buffer has no data");
  document.views = R"([{"buffer": 1, "byteLength": 48}])";
  document.primitive = R"({"attributes": {"POSITION": 0}})";
  document.accessors = R"([{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}])";
  EXPECT_HAS(meshopt_error(document), "bufferViews[0].buffer: the buffer has no data");
  document.views = views;
  document.more = R"(, "images": [{"bufferView": 0, "mimeType": "image/png"}])";
  EXPECT_HAS(meshopt_error(document), "an image in a bufferView");
}

TEST(Meshopt, DamagedStreamsAreErrorsOrMeshes) {
  const MeshoptPart positions = square_positions(), indices = meshopt_indices("TRIANGLES", 4);
  for (std::size_t i = 0; i < positions.bytes.size(); ++i) {
    MeshoptPart damaged = positions;
    damaged.bytes[i] ^= 0x55;
    if (const auto scene = load_meshopt(meshopt_document({damaged, indices}))) expect_sound(*scene);
  }
  for (std::size_t i = 0; i < indices.bytes.size(); ++i) {
    MeshoptPart damaged = indices;
    damaged.bytes[i] ^= 0x55;
    if (const auto scene = load_meshopt(meshopt_document({positions, damaged}))) expect_sound(*scene);
    damaged = indices;
    damaged.bytes.resize(std::max<std::size_t>(i, 1));
    EXPECT_FALSE(load_meshopt(meshopt_document({positions, damaged}))) << i;
  }
}

// ---- Quantization

TEST(Quantization, IntegersAreScaledAsTheirAccessorsSay) {
  Document document;
  document.binary =
      Bytes()
          .add<std::uint16_t>({0, 0, 0, 0, 1000, 0, 0, 0, 0, 1000, 0, 0})          // positions, stride 8
          .add<std::int8_t>({0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0})            // normals, stride 4
          .add<std::int16_t>({-32767, 16384, 32767, 0, -32768, 0})                 // coordinates
          .add<std::int8_t>({127, 0, 0, -127, 127, 0, 0, -127, 127, 0, 0, -127});  // tangents
  document.views = R"([{"buffer": 0, "byteLength": 24, "byteStride": 8},
    {"buffer": 0, "byteOffset": 24, "byteLength": 12, "byteStride": 4},
    {"buffer": 0, "byteOffset": 36, "byteLength": 12}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}])";
  document.primitive = R"({"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2, "TANGENT": 3}})";
  document.accessors = R"([{"bufferView": 0, "componentType": 5123, "count": 3, "type": "VEC3"},
    {"bufferView": 1, "componentType": 5120, "normalized": true, "count": 3, "type": "VEC3"},
    {"bufferView": 2, "componentType": 5122, "normalized": true, "count": 3, "type": "VEC2"},
    {"bufferView": 3, "componentType": 5120, "normalized": true, "count": 3, "type": "VEC4"}])";
  document.nodes = R"([{"mesh": 0, "scale": [0.002, 0.002, 0.002], "translation": [5, 0, 0]}])";
  document.more = R"(, "extensionsRequired": ["KHR_mesh_quantization"])";
  const auto scene = document.load().value_or_throw();
  expect_sound(scene);
  document.uri = "";
  keep_as_seed("quantized.glb", glb_of(document.json(), document.binary.data));
  EXPECT_LT(glm::distance(world_corner(scene, 0, 1), glm::vec3(7, 0, 0)), 1e-5f);
  const Vertex& vertex = scene.meshes[0].vertices[0];
  EXPECT_EQ(vertex.normal, glm::vec3(0, 0, 1));
  EXPECT_EQ(vertex.tangent, glm::vec4(1, 0, 0, -1));
  EXPECT_EQ(vertex.uv, glm::vec2(-1, 16384 / 32767.0f));
  EXPECT_EQ(scene.meshes[0].vertices[2].uv.x, -1) << "-32768 counts as -32767";
}

}  // namespace
}  // namespace brume::scene
