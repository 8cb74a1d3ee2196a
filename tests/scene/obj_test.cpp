#include "scene/files/obj.hpp"

#include <random>

#include "scene/files/mesh_tools.hpp"
#include "scene/files/polygon.hpp"
#include "tests/scene/scene_test_tools.hpp"

namespace brume::scene {
namespace {

std::string obj_error(const std::string& text) {
  const auto model = parse_obj(text, "a.obj");
  return model ? "no error" : model.failure().message;
}

/// The area of the triangles, each counted as positive, and their directed sum.
struct Areas {
  double sum = 0;
  glm::dvec3 directed{0};
};
Areas areas(const std::vector<glm::vec3>& corners) {
  Areas result;
  for (const auto& t : triangulate(corners)) {
    const glm::dvec3 a(corners[t[0]]), b(corners[t[1]]), c(corners[t[2]]);
    const glm::dvec3 area = glm::cross(b - a, c - a) / 2.0;
    result.sum += glm::length(area);
    result.directed += area;
  }
  return result;
}

TEST(Polygon, TrianglesCoverStarShapedPolygonsExactly) {
  // Area vector of the triangles = that of the outline always; equal absolute area only without overlap.
  std::mt19937 random(7);
  std::uniform_real_distribution<float> radius(0.2f, 2.0f);
  for (int round = 0; round < 200; ++round) {
    const int count = 3 + round % 30;
    std::vector<glm::vec3> corners;
    for (int i = 0; i < count; ++i) {
      const float angle = 6.2831853f * static_cast<float>(i) / static_cast<float>(count), r = radius(random);
      const float u = r * std::cos(angle), v = r * std::sin(angle);
      corners.push_back(round % 3 == 0   ? glm::vec3(u, v, 0)
                        : round % 3 == 1 ? glm::vec3(0, u, v)
                                         : glm::vec3(v, 0.5f * u, u));
    }
    EXPECT_EQ(triangulate(corners).size(), corners.size() - 2);
    const Areas found = areas(corners);
    const double outline = glm::length(area_vector(corners)) / 2;
    EXPECT_NEAR(glm::length(found.directed), outline, 1e-5 * outline);
    EXPECT_NEAR(found.sum, outline, 1e-4 * outline) << round;
  }
}

TEST(Polygon, AConcaveQuadIsSplitAtItsReflexCorner) {
  const std::vector<glm::vec3> arrow = {{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {0.5f, 1, 0}};
  for (std::size_t shift = 0; shift < 4; ++shift) {
    std::vector<glm::vec3> corners;
    for (std::size_t i = 0; i < 4; ++i) corners.push_back(arrow[(i + shift) % 4]);
    EXPECT_NEAR(areas(corners).sum, 1.5, 1e-6) << shift;
  }
}

TEST(Polygon, DegeneratePolygonsKeepTheirTriangleCount) {
  EXPECT_EQ(triangulate(std::vector<glm::vec3>(5, glm::vec3(1))).size(), 3u);
  const std::vector<glm::vec3> bow_tie = {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(triangulate(bow_tie).size(), 2u);
}

TEST(Obj, NegativeIndicesCountFromTheEnd) {
  const auto a = parse_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nf 1 2 3\n", "a.obj");
  const auto b = parse_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\n", "b.obj");
  ASSERT_TRUE(a && b);
  ASSERT_EQ(a->vertices.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(a->vertices[i].position, b->vertices[i].position);
}

TEST(Obj, CornersWithEqualIndicesShareAVertex) {
  const auto model = parse_obj(
                         "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\nvn 0 0 2\n"
                         "f 1/1/1 2/1/1 3/1/1\nf 1/1/1 3/1/1 4/2/1\n",
                         "a.obj")
                         .value_or_throw();
  EXPECT_EQ(model.vertices.size(), 4u);
  EXPECT_EQ(model.vertices[0].normal, glm::vec3(0, 0, 1)) << "made unit length";
  EXPECT_EQ(model.vertices[0].uv, glm::vec2(0, 1)) << "v runs down";
  EXPECT_EQ(model.vertices[3].uv, glm::vec2(1, 0));
}

TEST(Obj, MissingNormalsAreComputedPerFace) {
  const auto model = parse_obj(kCubeObj, "cube.obj");
  ASSERT_TRUE(model);
  EXPECT_EQ(model->vertices.size(), 24u);
  for (const Vertex& vertex : model->vertices) EXPECT_NEAR(glm::dot(vertex.normal, vertex.position), 1, 1e-6);
}

TEST(Obj, LinesMayBeContinued) {
  const auto model = parse_obj("v 0 0 \\\n 0\nv 1 0 0\nv 0 1 0\nf 1 2 \\\n3\n", "a.obj").value_or_throw();
  EXPECT_EQ(model.vertices.size(), 3u);
}

TEST(Obj, ErrorsNameFileLineAndColumn) {
  EXPECT_EQ(obj_error("v 1 2\n"),
            "a.obj:1:6: expected a number for the third component of a position, found the end of the line");
  expect_mistakes(obj_error, "a.obj",
                  {{"v 1 x 3\n", "1:5", {"the second component of a position", "\"x\""}},
                   {"v 1 2 3\nf 1 1 0\n", "2:7", {"\"0\" names no position: there are 1 above this line"}},
                   {"v 1 2 3\nf 1 1 -2\n", "2:7", {"\"-2\" names no position: there are 1 above this line"}},
                   {"f 1 2 3\n\nv 1 2 3\nv 1 2 3\n", "1:7", {"\"3\" names no position: there are 2"}},
                   {"v 1 2 3\nf 1 1x 1\n", "2:5", {"a face corner like", "\"1x\""}},
                   {"v 1 2 3\nf 1 1\n", "2:6", {"at least 3 corners", "the end of the line"}},
                   {"v 1 2 3\nf 1 1 99999999999999999999\n", "2:7", {}}});
}

// Exporters write indices of attributes that they leave out.
TEST(Obj, AttributesThatDoNotExistCountAsNone) {
  const LogLines warnings;
  const auto model = parse_obj(
                         "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1 0 0\nf 1/1/1 2/0/1 3/-4/1\nf 1//2 2//9 3//-2\n"
                         "f 1/99999999999999999999 2 3\n",
                         "a.obj")
                         .value_or_throw();
  ASSERT_EQ(model.parts.at(0).indices.size(), 9u);
  for (std::size_t i = 0; i < 9; ++i) {
    const Vertex& vertex = model.vertices[model.parts[0].indices[i]];
    EXPECT_EQ(vertex.normal, i < 3 ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1)) << i;
    EXPECT_EQ(vertex.uv, glm::vec2(0)) << i;
  }
  EXPECT_EQ(warnings.lines,
            (std::vector<std::string>{"a.obj:5:3: \"1/1/1\" names no texture coordinate: there are 0, and "
                                      "they count from 1; ignored indices of this kind: 7"}));
}

TEST(Obj, FacesMayStandAboveTheirVertices) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\n";
  const std::string faces = "o a\nf 1/1 2/2 3/3\no b\nf 2/1 3/2 4/3\n";
  const LogLines warnings;
  const ObjModel below = parse_obj(vertices + faces, "a.obj").value_or_throw();
  // All above; texture coordinates alone below; and one face between that could be added at once.
  const std::string split = "v 0 0 0\nv 1 0 0\nv 0 1 0\no a\nf 1/1 2/2 3/3\n";
  const std::string rest = "v 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\no b\nf -3/-3 -2/-2 -1/-1\n";
  for (const std::string& text : {faces + vertices, split + rest}) {
    const ObjModel above = parse_obj(text, "b.obj").value_or_throw();
    ASSERT_EQ(above.parts.size(), 2u);
    EXPECT_EQ(above.parts[1].object, "b");
    ASSERT_EQ(above.vertices.size(), below.vertices.size());
    for (std::size_t i = 0; i < below.vertices.size(); ++i) {
      EXPECT_EQ(above.vertices[i].position, below.vertices[i].position);
      EXPECT_EQ(above.vertices[i].uv, below.vertices[i].uv);
      EXPECT_EQ(above.vertices[i].normal, below.vertices[i].normal);
    }
    for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(above.parts[i].indices, below.parts[i].indices);
  }
  EXPECT_TRUE(warnings.lines.empty());
}

TEST(Obj, UnknownStatementsAreNamedOnce) {
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  {
    const LogLines warnings;
    ASSERT_TRUE(parse_obj(triangle + "s off\nl 1 2\np 1\nvp 0 0\nlod 1\nshadow_obj a\n# ff\n\n", "a.obj"));
    EXPECT_TRUE(warnings.lines.empty());
    ASSERT_TRUE(parse_obj(triangle + "ff 1 2 3\nvertex 1 2 3\nff 1 2 3\n", "a.obj"));
    EXPECT_EQ(warnings.lines,
              (std::vector<std::string>{"a.obj:5: the statement \"ff\" is unknown and ignored",
                                        "a.obj:6: the statement \"vertex\" is unknown and ignored"}));
  }
  std::string prose = triangle;
  for (int i = 0; i < 100; ++i) prose += "word" + std::to_string(i) + " 1\n";
  const LogLines warnings;
  ASSERT_TRUE(parse_obj(prose, "a.obj"));
  ASSERT_EQ(warnings.lines.size(), 9u);
  EXPECT_EQ(warnings.lines.back(), "a.obj:13: more unknown statements from here on are ignored");
}

TEST(ObjScene, OptionsOfMapsMayTakeAWord) {
  for (const char* options : {"-colorspace sRGB", "-type sphere", "-imfchan r", "-imfchan\tl -s 1 1 1",
                              "-clamp on -colorspace linear -bm 0.5"}) {
    const auto materials = parse_mtl(std::string("newmtl a\nmap_Kd ") + options + " my tex.png\n", "m.mtl");
    ASSERT_TRUE(materials);
    EXPECT_EQ(materials->at(0).diffuse_map.file, "my tex.png") << options;
  }
}

TEST(ObjScene, OneObjectPerMaterial) {
  MemoryFiles files;
  files.add_text("m.mtl",
                 "newmtl red\nKd 1 0 0\nKe 0 2 0\nnewmtl old map\nKd 0.5\nNs 0\nmap_Kd -s 1 1 1 gone.png\n");
  const std::string text =
      "mtllib M.MTL\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl red\nf 1 2 3\nusemtl old map\nf 1 2 "
      "4\nusemtl red\nf 1 3 4\nusemtl lost\nf 2 3 4\n";
  const LogLines warnings;
  const auto scene = parse_obj_scene(text, "a.obj", files).value_or_throw();
  expect_sound(scene);
  ASSERT_EQ(scene.objects.size(), 3u);
  EXPECT_EQ(scene.meshes[scene.objects[0].mesh].indices.size(), 6u);
  EXPECT_EQ(scene.materials[0].base_color, glm::vec3(1, 0, 0));
  EXPECT_EQ(scene.materials[0].emission, glm::vec3(0, 2, 0));
  EXPECT_EQ(scene.materials[1].base_color, glm::vec3(0.5f));
  EXPECT_FLOAT_EQ(scene.materials[1].roughness, 1);
  EXPECT_TRUE(warnings.has("m.mtl:7: the image \"gone.png\" does not exist"));
  EXPECT_TRUE(warnings.has("a.obj:12: no material is called \"lost\"; it is grey"));
  EXPECT_EQ(scene.materials[2].base_color, glm::vec3(0.6f));
  EXPECT_EQ(scene.materials[2].base_color_image, kNone);
}

TEST(ObjScene, OneObjectPerNameAndMaterial) {
  const std::string text =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no ring\nf 1 2 3\ng beam\nf 1 2 3\nusemtl glass\nf 1 2 3\no ring\n"
      "usemtl glass\nf 1 2 3\nusemtl IGNORE_it\nf 1 2 3\n";
  const Scene scene = parse_obj_scene(text, "a.obj", MemoryFiles()).value_or_throw();
  std::vector<std::string> names;
  for (const Object& object : scene.objects) names.push_back(object.name);
  EXPECT_EQ(names, (std::vector<std::string>{"object", "ring", "beam", "beam", "ring", "ring"}));
  EXPECT_EQ(scene.objects[4].role, Role::wall);
  EXPECT_EQ(scene.objects[5].role, Role::ghost) << "by its material";
}

TEST(ObjScene, NamesMakeALimitedNumberOfObjects) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int i = 0; i < 5000; ++i) text += "g part" + std::to_string(i) + "\nf 1 2 3\n";
  const ObjModel model = parse_obj(text, "a.obj").value_or_throw();
  EXPECT_EQ(model.parts.size(), kMostObjObjects + 1);
  EXPECT_EQ(model.parts.back().indices.size(), 3 * (5000 - kMostObjObjects));
}

TEST(ObjScene, AMissingMaterialFileIsOneWarningAndGrey) {
  const std::string text =
      "mtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nusemtl b\nf 3 2 1\n";
  const LogLines warnings;
  const auto scene = parse_obj_scene(text, "a.obj", MemoryFiles()).value_or_throw();
  ASSERT_EQ(warnings.lines.size(), 1u);
  EXPECT_EQ(warnings.lines[0],
            "a.obj:1: the material file \"gone.mtl\" does not exist; its materials are grey");
  for (const Material& material : scene.materials) {
    EXPECT_EQ(material.base_color, glm::vec3(0.6f));
    EXPECT_EQ(material.base_color_image, kNone);
  }
}

// Exporters write several names on a line, paths from the file that names them, and those of their own
// machine.
TEST(ObjScene, FilesAreFoundWhereExportersMeanThem) {
  const auto colors_of = [](const std::string& library, const MemoryFiles& files) {
    const std::string text =
        "mtllib " + library + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nusemtl b\nf 3 2 1\n";
    const Scene scene = parse_obj_scene(text, "s.obj", files).value_or_throw();
    return std::pair(scene.materials.at(0).base_color, scene.materials.at(1).base_color);
  };
  MemoryFiles files;
  files.add_text("a.mtl", "newmtl a\nKd 1 0 0\n");
  files.add_text("b.mtl", "newmtl b\nKd 0 1 0\n");
  files.add_text("both of them.mtl", "newmtl a\nKd 0 0 1\nnewmtl b\nKd 0 0 1\n");
  const std::pair two(glm::vec3(1, 0, 0), glm::vec3(0, 1, 0));
  const LogLines warnings;
  EXPECT_EQ(colors_of("a.mtl b.mtl", files), two);
  EXPECT_EQ(colors_of("both of them.mtl", files), std::pair(glm::vec3(0, 0, 1), glm::vec3(0, 0, 1)));
  EXPECT_EQ(colors_of("C:\\Users\\me\\both of them.mtl", files).first, glm::vec3(0, 0, 1));
  EXPECT_TRUE(warnings.lines.empty());
  EXPECT_EQ(colors_of("a.mtl c.mtl", files).first, glm::vec3(1, 0, 0));
  EXPECT_TRUE(warnings.has("s.obj:1: the material file \"c.mtl\" does not exist"));
  colors_of("../up.mtl", files);
  EXPECT_TRUE(warnings.has("\"../up.mtl\" lies outside of the scene's folder"));
}

TEST(ObjScene, ImagesAreFoundFromTheirMaterialFile) {
  MemoryFiles files;
  const image::Image8 red{1, 1, {255, 0, 0, 255}};
  const auto png = png_of(red);
  for (const char* name : {"quad.png", "sub/own.png"}) files.files[name] = png;
  const auto is_found = [&](const std::string& map) {
    files.add_text("sub/m.mtl", "newmtl a\nmap_Kd " + map + "\n");
    const LogLines warnings;
    const Scene scene =
        parse_obj_scene("mtllib sub/m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n", "s.obj", files)
            .value_or_throw();
    return warnings.lines.empty() && scene.images.size() == 1 && scene.images[0].pixels.rgba == red.rgba;
  };
  for (const char* map :
       {"quad.png", "../quad.png", "own.png", "sub/own.png", "C:\\art\\quad.png", "/home/me/own.png"})
    EXPECT_TRUE(is_found(map)) << map;
  EXPECT_FALSE(is_found("gone.png"));
  EXPECT_FALSE(is_found("../../gone.png"));
}

// Normals that are missing are left out: those of a checker would dent the surface.
TEST(ObjScene, AMissingNormalMapIsLeftOut) {
  MemoryFiles files;
  files.add_text("m.mtl", "newmtl a\nmap_Bump gone.png\n");
  const LogLines warnings;
  const Scene scene =
      parse_obj_scene("mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n", "s.obj", files)
          .value_or_throw();
  EXPECT_EQ(scene.materials[0].normal_image, kNone);
  EXPECT_TRUE(warnings.has("m.mtl:2: the image \"gone.png\" does not exist; it is left out"));
}

TEST(ObjScene, VertexColours) {
  const auto scene =
      parse_obj_scene("v 0 0 0 1 0 0.5\nv 1 0 0 0 0 0\nv 0 1 0\nf 1 2 3\n", "a.obj", MemoryFiles())
          .value_or_throw();
  const std::vector<Vertex>& vertices = scene.meshes[0].vertices;
  EXPECT_LT(glm::distance(vertices[0].color, glm::vec4(1, 0, 0.21404f, 1)), 1e-5f) << "decoded from sRGB";
  EXPECT_EQ(vertices[1].color, glm::vec4(0, 0, 0, 1));
  EXPECT_EQ(vertices[2].color, glm::vec4(1)) << "without one";
  EXPECT_EQ(scene.materials[0].base_color, glm::vec3(1)) << "no grey on top";
  const auto weights =
      parse_obj_scene("v 0 0 0 0.5\nv 1 0 0 a b c\nv 0 1 0 1 1\nf 1 2 3\n", "a.obj", MemoryFiles())
          .value_or_throw();
  EXPECT_EQ(weights.meshes[0].vertices[0].color, glm::vec4(1)) << "other values are no colours";
}

TEST(ObjScene, Utf16InBothByteOrders) {
  // A name of one letter in one unit, and of one in two.
  const std::u16string text =
      u"\ufeffmtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl \u00e4\U0001f32b\nf 1 2 3\n";
  for (const bool big : {false, true}) {
    const auto encoded = [big](const std::u16string& units) {
      std::string bytes;
      for (const char16_t unit : units) {
        for (const int shift : {big ? 8 : 0, big ? 0 : 8}) bytes.push_back(static_cast<char>(unit >> shift));
      }
      return bytes;
    };
    MemoryFiles files;
    files.add_text("m.mtl", encoded(u"\ufeffnewmtl \u00e4\U0001f32b\nKd 1 0 0\n"));
    const auto scene = parse_obj_scene(encoded(text), "a.obj", files).value_or_throw();
    EXPECT_EQ(scene.materials[0].name, "\xc3\xa4\xf0\x9f\x8c\xab");
    EXPECT_EQ(scene.materials[0].base_color, glm::vec3(1, 0, 0));
  }
}

TEST(ObjScene, MtlErrorsNameFileAndLine) {
  const auto materials = parse_mtl("newmtl a\nKd red\n", "m.mtl");
  ASSERT_FALSE(materials);
  EXPECT_EQ(materials.failure().message, "m.mtl:2:4: expected a number for red, found \"red\"");
}

TEST(Tangents, FollowTheTextureOnASlantedQuad) {
  // u along (0, 1, 1), v (down the image) along -x, seen from the side of the normal.
  Mesh mesh;
  const glm::vec3 u = glm::normalize(glm::vec3(0, 1, 1)), down(-1, 0, 0);
  for (const glm::vec2 uv : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)}) {
    Vertex vertex;
    vertex.position = u * uv.x * 3.0f + down * uv.y * 2.0f;
    vertex.uv = uv;
    mesh.vertices.push_back(vertex);
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  compute_normals(mesh);
  compute_tangents(mesh);
  for (const Vertex& vertex : mesh.vertices) {
    const glm::vec3 tangent(vertex.tangent);
    EXPECT_LT(glm::distance(tangent, u), 1e-6f);
    EXPECT_LT(glm::distance(vertex.tangent.w * glm::cross(vertex.normal, tangent), -down), 1e-6f);
  }
}

TEST(Tangents, MirroredMeshesKeepTheBitangentInTheWorld) {
  Mesh mesh;
  for (const glm::vec2 uv : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)}) {
    Vertex vertex;
    vertex.position = glm::vec3(uv.x, -uv.y, 0);
    vertex.uv = uv;
    mesh.vertices.push_back(vertex);
  }
  mesh.indices = {0, 2, 1};
  compute_normals(mesh);
  compute_tangents(mesh);
  const Mesh copy = mirrored(mesh);
  EXPECT_EQ(copy.indices, (std::vector<std::uint32_t>{0, 1, 2}));
  const Vertex& vertex = copy.vertices[0];
  // In the world, x is mirrored; the image's up (+y) must stay so.
  const glm::vec3 tangent_world(-vertex.tangent.x, vertex.tangent.y, vertex.tangent.z);
  EXPECT_LT(glm::distance(vertex.tangent.w * glm::cross(vertex.normal, tangent_world), glm::vec3(0, 1, 0)),
            1e-6f);
}

}  // namespace
}  // namespace brume::scene
