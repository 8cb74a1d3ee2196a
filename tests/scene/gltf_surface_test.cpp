// What of a glTF file reaches the look of its surfaces, and the answers to files of another kind.
#include <webp/encode.h>

#include <filesystem>

#include "core/file.hpp"
#include "tests/scene/gltf_maker.hpp"

namespace brume::scene {
namespace {

/// A lossless WebP picture of one colour.
std::string webp_of(std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  const std::uint8_t texels[] = {r, g, b, 255, r, g, b, 255};
  std::uint8_t* data = nullptr;
  const std::size_t size = WebPEncodeLosslessRGBA(texels, 2, 1, 8, &data);
  std::string file(reinterpret_cast<const char*>(data), size);
  WebPFree(data);
  return file;
}

/// A triangle with texture coordinates (0, 0), (1, 0), (0, 1), and its material.
Document textured(const std::string& material, const std::string& more) {
  Document document;
  document.binary.add<float>({0, 0, 1, 0, 0, 1});
  document.primitive = R"({"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0})";
  document.accessors = R"([{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
    {"bufferView": 0, "byteOffset": 36, "componentType": 5126, "count": 3, "type": "VEC2"}])";
  document.more = R"(, "materials": [)" + material + "]" + more;
  return document;
}

TEST(GltfTexture, WebpInABufferViewAndAsAFile) {
  Document document =
      textured(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
    "normalTexture": {"index": 1}})",
               R"(, "textures": [{"source": 1, "extensions": {"EXT_texture_webp": {"source": 0}}},
    {"extensions": {"EXT_texture_webp": {"source": 2}}}], "images": [{"bufferView": 1, "mimeType": "image/webp"},
    {"uri": "gone.png"}, {"uri": "b.webp"}], "extensionsRequired": ["EXT_texture_webp"])");
  const std::string red = webp_of(255, 0, 0);
  document.views = R"([{"buffer": 0, "byteLength": 60}, {"buffer": 0, "byteOffset": 60, "byteLength": )" +
                   std::to_string(red.size()) + "}]";
  document.binary.data += red;
  MemoryFiles files;
  files.add_text("data.bin", document.binary.data);
  files.add_text("b.webp", webp_of(10, 20, 30));
  const auto scene = load_gltf(document.json(), files).value_or_throw();
  expect_sound(scene);
  const Material& material = scene.materials[0];
  ASSERT_EQ(scene.images.size(), 2u) << "the PNG that WebP replaces is not read";
  document.uri = "";
  keep_as_seed("webp.glb", glb_of(document.json(), document.binary.data));
  EXPECT_EQ(scene.images[material.base_color_image].pixels.rgba,
            (std::vector<std::uint8_t>{255, 0, 0, 255, 255, 0, 0, 255}));
  EXPECT_EQ(scene.images[material.normal_image].pixels.rgba[2], 30);
}

TEST(GltfTexture, SamplersSayHowImagesContinue) {
  Document document =
      textured(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0},
    "metallicRoughnessTexture": {"index": 1}}, "normalTexture": {"index": 2}})",
               R"(, "textures": [{"source": 0, "sampler": 0}, {"source": 0, "sampler": 1}, {"source": 0}],
    "samplers": [{"wrapS": 33071, "wrapT": 33648}, {}], "images": [{"uri": "a.webp"}])");
  MemoryFiles files;
  files.add_text("data.bin", document.binary.data);
  files.add_text("a.webp", webp_of(10, 20, 30));
  const LogLines warnings;
  const auto scene = load_gltf(document.json(), files).value_or_throw();
  EXPECT_EQ(warnings.lines, std::vector<std::string>());
  ASSERT_EQ(scene.images.size(), 2u) << "one for each way";
  const Material& material = scene.materials[0];
  EXPECT_EQ(scene.images[material.base_color_image].wraps, (Wraps{Wrap::clamp, Wrap::mirror}));
  EXPECT_EQ(scene.images[material.roughness_image].wraps, Wraps());
  EXPECT_EQ(scene.images[material.roughness_image].pixels.rgba[2], 30);
  EXPECT_EQ(material.normal_image, material.roughness_image);
  document.more.replace(document.more.find("\"sampler\": 1"), 12, "\"sampler\": 2");
  EXPECT_HAS(document.error(), "textures[1].sampler");
}

TEST(GltfTexture, DataUrisOfAnyMediaType) {
  // A single white texel.
  const std::string png =
      "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAQAAAC1HAwCAAAAC0lEQVR42mP8/x8AAwMCAO+ip1sAAAAASUVORK5CYII=";
  for (const char* type : {"image/webp", "image/jpg", "", "image/png;charset=utf-8"}) {
    Document document = textured(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})",
                                 R"(, "textures": [{"source": 0}], "images": [{"uri": "data:)" +
                                     std::string(type) + ";base64," + png + "\"}]");
    const LogLines warnings;
    const auto scene = document.load();
    ASSERT_TRUE(scene) << type << scene.failure().message;
    EXPECT_TRUE(warnings.lines.empty()) << type << warnings.lines.front();
  }
}

TEST(GltfTexture, SpecularGlossinessIsRoughnessWithoutMetal) {
  const std::string glossy =
      R"("extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0.5, 0.25, 1, 1],
         "glossinessFactor": 0.75, "diffuseTexture": {"index": 0}}})";
  Document document = textured("{" + glossy + "}", R"(, "textures": [{}])");
  const auto scene = document.load().value_or_throw();
  const Material& material = scene.materials[scene.objects[0].material];
  EXPECT_EQ(material.base_color, glm::vec3(0.5f, 0.25f, 1));
  EXPECT_EQ(material.roughness, 0.25f);
  EXPECT_EQ(material.metallic, 0);
  EXPECT_NE(material.base_color_image, kNone);
  document =
      textured(R"({"pbrMetallicRoughness": {"metallicFactor": 1}, )" + glossy + "}", R"(, "textures": [{}])");
  EXPECT_EQ(document.load().value_or_throw().materials.at(scene.objects[0].material).metallic, 1);
  document = textured("{" + glossy + "}", "");
  EXPECT_HAS(document.error(), "diffuseTexture.index: names textures[0]");
}

TEST(GltfTexture, MissingNormalsAreNone) {
  Document document = textured(R"({"normalTexture": {"index": 0}})", R"(, "textures": [{}])");
  const auto scene = document.load().value_or_throw();
  EXPECT_EQ(scene.materials[scene.objects[0].material].normal_image, kNone);
}

TEST(GltfTexture, ExtensionsMustNameAnImage) {
  Document document =
      textured("{}", R"(, "textures": [{"extensions": {"EXT_texture_webp": {"source": 3}}}])");
  EXPECT_HAS(document.error(), "textures[0].extensions.EXT_texture_webp.source: names images[3]");
}

// The example of the extension's specification: the lower left quadrant of the image, rotated clockwise by 90
// degrees.
TEST(GltfTexture, TransformsMoveTheCoordinates) {
  const std::string transform = R"({"index": 0, "extensions": {"KHR_texture_transform":
    {"offset": [0, 1], "rotation": 1.57079632679, "scale": [0.5, 0.5], "texCoord": 0}}, "texCoord": 3})";
  Document document = textured(R"({"pbrMetallicRoughness": {"baseColorTexture": )" + transform + "}}",
                               R"(, "textures": [{}])");
  const auto scene = document.load().value_or_throw();
  document.uri = "";
  keep_as_seed("texture_transform.glb", glb_of(document.json(), document.binary.data));
  const std::vector<Vertex>& vertices = scene.meshes[0].vertices;
  EXPECT_LT(glm::distance(vertices[0].uv, glm::vec2(0, 1)), 1e-6f);
  EXPECT_LT(glm::distance(vertices[1].uv, glm::vec2(0, 0.5f)), 1e-6f);
  EXPECT_LT(glm::distance(vertices[2].uv, glm::vec2(0.5f, 1)), 1e-6f);
}

TEST(GltfTexture, TexturesThatDisagreeAreAWarning) {
  const std::string scaled = R"({"index": 0, "extensions": {"KHR_texture_transform": {"scale": [2, 3]}}})";
  const auto load = [&](const std::string& normal) {
    return textured(R"({"pbrMetallicRoughness": {"baseColorTexture": )" + scaled + R"(}, "normalTexture": )" +
                        normal + "}",
                    R"(, "textures": [{}])")
        .load();
  };
  const LogLines warnings;
  const auto agree = load(scaled).value_or_throw();
  EXPECT_FALSE(warnings.has("differ")) << "both textures move alike";
  EXPECT_EQ(agree.meshes[0].vertices[2].uv, glm::vec2(0, 3));
  ASSERT_TRUE(load(R"({"index": 0})"));
  EXPECT_TRUE(warnings.has("materials[0]: its textures differ in texCoord or KHR_texture_transform"));
}

TEST(GltfColor, VertexColoursOfAllTypes) {
  struct Case {
    std::string type;
    Bytes binary;
    glm::vec4 expected;
  };
  const Case cases[] = {
      {R"("componentType": 5126, "type": "VEC3")",
       Bytes().add<float>({0.25f, 2, -1, 0, 0, 0, 0, 0, 0}),
       {0.25f, 1, 0, 1}},
      {R"("componentType": 5121, "normalized": true, "type": "VEC4")",
       Bytes().add<std::uint8_t>({255, 0, 51, 102, 0, 0, 0, 0, 0, 0, 0, 0}),
       {1, 0, 0.2f, 0.4f}},
      {R"("componentType": 5123, "normalized": true, "type": "VEC4")",
       Bytes().add<std::uint16_t>({65535, 0, 13107, 26214, 0, 0, 0, 0, 0, 0, 0, 0}),
       {1, 0, 0.2f, 0.4f}},
  };
  for (const Case& c : cases) {
    Document document;
    document.binary.data += c.binary.data;
    document.primitive = R"({"attributes": {"POSITION": 0, "COLOR_0": 1}})";
    document.accessors = R"([{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
      {"bufferView": 0, "byteOffset": 36, "count": 3, )" +
                         c.type + "}]";
    const auto scene = document.load().value_or_throw();
    EXPECT_LT(glm::distance(scene.meshes[0].vertices[0].color, c.expected), 1e-6f) << c.type;
    EXPECT_EQ(scene.meshes[0].vertices[1].color.g, 0) << c.type;
    document.uri = "";
    keep_as_seed("vertex_colors.glb", glb_of(document.json(), document.binary.data));
  }
  EXPECT_EQ(Document().load()->meshes[0].vertices[0].color, glm::vec4(1)) << "white without any";
}

// Seeds that no longer load would lead the fuzzer nowhere.
TEST(GltfSeeds, EveryGlbLoads) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(BRUME_SOURCE_DIR "/fuzz/corpus/gltf")) {
    if (entry.path().extension() != ".glb") continue;  // whose buffers the fuzzer makes up
    const auto scene =
        parse_gltf(read_file(entry.path()).value_or_throw(), entry.path().filename().string(), MemoryFiles())
            .value_or_throw();
    expect_sound(scene);
    ++count;
  }
  EXPECT_GE(count, 9);
}

TEST(GltfKind, VersionOneIsNamed) {
  const std::string expected = "a.gltf: is glTF 1.0; convert it to 2.0";
  const auto error = [](const std::string& file) { return load_gltf(file, {}).failure().message; };
  EXPECT_EQ(error(R"({"asset": {"version": "1.0"}, "accessors": {}, "meshes": {}})"), expected);
  EXPECT_EQ(error(R"({"accessors": {"a": {}}, "meshes": {"b": {}}, "scene": "c"})"), expected);
  std::string glb = glb_of("{}", "");
  glb[4] = 1;
  EXPECT_EQ(error(glb), expected);
  glb[4] = 9;
  EXPECT_EQ(error(glb), "a.gltf: is GLB of version 9; expected 2");
  EXPECT_EQ(error(R"({"asset": {"version": "3.0"}})"),
            "a.gltf: is glTF of version \"3.0\"; convert it to 2.0");
}

TEST(GltfKind, OtherFilesAreNamed) {
  const auto error = [](const std::string& file) { return load_gltf(file, {}).failure().message; };
  EXPECT_HAS(error(std::string("\x89PNG\r\n\0\0", 8)), "a.gltf: is no glTF file");
  EXPECT_HAS(error(""), "a.gltf: is no glTF file: it is empty");
  EXPECT_HAS(error(std::string("glTF\2\0\0\0\x20\0\0\0\x0c\0\0\0JSONjunkjunkjunk", 32)),
             "a.gltf: the first chunk of the GLB file is no JSON");
  EXPECT_EQ(error(std::string("\xff\xfe{\0", 4)), "a.gltf: is UTF-16; save it as UTF-8");
}

}  // namespace
}  // namespace brume::scene
