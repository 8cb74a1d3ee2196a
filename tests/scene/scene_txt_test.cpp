#include "scene/files/scene_txt.hpp"

#include <filesystem>
#include <numbers>

#include "core/file.hpp"
#include "scene/files/load.hpp"
#include "scene/files/stand_ins.hpp"
#include "tests/scene/scene_test_tools.hpp"

namespace brume::scene {
namespace {

Result<Scene> parse(const std::string& text) {
  MemoryFiles files;
  files.add_text("Meshes/Box.obj", kCubeObj);
  files.add_text("Meshes/IGNORE_Peg.obj", kCubeObj);
  files.add_text("Meshes/Grenade.obj", "v 1 1 1\nv 3 1 1\nv 1 5 1\nf 1 2 3\n");
  files.add_text("Meshes/Broken.obj", "v 0 0 0\nv 1 0 nan\n");
  files.add_text("Meshes/OutOfRange.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n");
  return parse_scene_txt(text, "Scene.txt", files);
}

std::string error_of(const std::string& text) {
  const auto scene = parse(text);
  if (scene) return "no error";
  EXPECT_EQ(scene.failure().code, ErrorCode::bad_input);
  EXPECT_EQ(scene.failure().message.find('\n'), std::string::npos) << "one line";
  return scene.failure().message;
}

glm::vec3 image_of(const Scene& scene, glm::vec3 point) {
  return glm::vec3(scene.objects.at(0).world_from_mesh * glm::vec4(point, 1));
}

void expect_near(glm::vec3 a, glm::vec3 b) {
  EXPECT_LT(glm::distance(a, b), 1e-5f) << a.x << " " << a.y << " " << a.z;
}

TEST(SceneTxt, Utf16) {
  std::string text = "\xff\xfe";
  for (const char letter : std::string("Box 1 2 3 0 0 0 1 1 1\r\n")) text += {letter, '\0'};
  const auto scene = parse(text).value_or_throw();
  expect_near(image_of(scene, {0, 0, 0}), {1, 2, 3});
}

TEST(SceneTxt, Utf16MayEndInHalfALetter) {
  std::string text = "\xff\xfe";
  for (const char letter : std::string("Box 1 2 3 0 0 0 1 1 1\n")) text += {letter, '\0'};
  for (const char* half : {"\x3c\xd8", "\x2b\xdf"}) {
    text.append(half, 2);
    const std::string exact(text.begin(), text.end());  // The address sanitizer knows where it ends.
    EXPECT_EQ(error_of(exact).rfind("Scene.txt:2", 0), 0u) << error_of(exact);
    text.resize(text.size() - 2);
  }
}

TEST(SceneTxt, RotationsAreNegatedOneAxisAtATime) {
  // A quarter turn about an axis by the negated angle: x: y -> -z; y: z -> -x; z: x -> -y.
  const auto about_x = parse("Box 0 0 0 1.5707963 0 0 1 1 1\n");
  const auto about_y = parse("Box 0 0 0 0 1.5707963 0 1 1 1\n");
  const auto about_z = parse("Box 0 0 0 0 0 1.5707963 1 1 1\n");
  ASSERT_TRUE(about_x && about_y && about_z);
  expect_near(image_of(*about_x, {0, 1, 0}), {0, 0, -1});
  expect_near(image_of(*about_y, {0, 0, 1}), {-1, 0, 0});
  expect_near(image_of(*about_z, {1, 0, 0}), {0, -1, 0});
}

TEST(SceneTxt, TheMatrixIsTranslationTimesScaleTimesXTimesYTimesZ) {
  // z first: x -> -y; then x: -y -> +z; then the world's axes are scaled; then moved.
  const auto scene = parse("Box\t10 20 30\t1.5707963 0 1.5707963\t2 3 4\n");
  ASSERT_TRUE(scene);
  expect_near(image_of(*scene, {1, 0, 0}), {10, 20, 34});
  // z: y -> x; x leaves it; scaled by 2.
  expect_near(image_of(*scene, {0, 1, 0}), {12, 20, 30});
}

TEST(SceneTxt, NegativeScalesKeepTrianglesOutward) {
  for (const std::string scale : {"1 1 1", "-1 1 1", "1 -2 1", "-1 -1 1", "-1 -1 -3"}) {
    const auto scene = parse("Box 5 0 0 0.3 0.2 0.1 " + scale + "\n");
    ASSERT_TRUE(scene);
    EXPECT_GT(signed_volume(*scene, scene->objects[0]), 7.9) << scale;
    expect_sound(*scene);
  }
}

TEST(SceneTxt, RepeatedMeshesAreLoadedOnce) {
  const auto scene =
      parse("Box 0 0 0 0 0 0 1 1 1\nBox 1 0 0 0 0 0 1 1 1\nBox 2 0 0 0 0 0 -1 1 1\nBox 3 0 0 0 0 0 -1 1 1\n");
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->objects[0].mesh, scene->objects[1].mesh);
  EXPECT_EQ(scene->objects[2].mesh, scene->objects[3].mesh);
  EXPECT_NE(scene->objects[0].mesh, scene->objects[2].mesh);
}

TEST(SceneTxt, LightsSpreadTheirPowerOverTheSphere) {
  const auto scene = parse("LIGHT_SOURCE -1 2 3\t1.0 0.5 0.25\t30.0 # warm\nBox 0 0 0 0 0 0 1 1 1\n");
  ASSERT_TRUE(scene);
  ASSERT_EQ(scene->lights.size(), 1u);
  EXPECT_EQ(scene->lights[0].kind, LightKind::point);
  expect_near(scene->lights[0].position_world, {-1, 2, 3});
  EXPECT_NEAR(scene->lights[0].intensity.r * 4 * std::numbers::pi, 30, 1e-4);
  EXPECT_NEAR(scene->lights[0].intensity.b * 4 * std::numbers::pi, 7.5, 1e-4);
}

TEST(SceneTxt, AcceptsCommentsBlankLinesAndCarriageReturns) {
  const auto scene =
      parse("\xef\xbb\xbf# head\r\n\r\n  Box  0 0 0  0 0 0  1 1 1 \r\n\t# end").value_or_throw();
  EXPECT_EQ(scene.objects.size(), 1u);
}

TEST(SceneTxt, IgnoredObjectsAreDrawnButNotVoxelized) {
  const auto scene = parse("IGNORE_Peg 0 0 0 0 0 0 1 1 1\nBox 0 0 0 0 0 0 1 1 1\n");
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->objects[0].role, Role::ghost);
  EXPECT_EQ(scene->objects[1].role, Role::wall);
}

TEST(SceneTxt, TheGrenadeIsCentredAndNotAnObject) {
  const auto scene = parse("Grenade 7 8 9 0 0 0 2 2 2\nBox 0 0 0 0 0 0 1 1 1\n");
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->objects.size(), 1u);
  EXPECT_EQ(scene->grenade->name, "Grenade");
  const Mesh& mesh = scene->meshes[scene->grenade->mesh];
  expect_near(mesh.vertices[0].position + mesh.vertices[1].position, {0, -4, 0});
  expect_near(glm::vec3(scene->grenade->world_from_mesh * glm::vec4(1, 0, 0, 1)), {2, 0, 0});
}

TEST(SceneTxt, WithoutGrenadeTakesABuiltInOne) {
  auto scene = parse("Box 0 0 0 0 0 0 1 1 1\n");
  ASSERT_TRUE(scene);
  EXPECT_FALSE(scene->grenade.has_value());
  add_built_in_grenade(*scene);
  ASSERT_TRUE(scene->grenade.has_value());
  EXPECT_GT(signed_volume(*scene, *scene->grenade), 1e-4) << "a closed, outward mesh of about 0.3 l";
  expect_sound(*scene);
}

TEST(SceneTxt, MissingFilesAreWarningsWithStandIns) {
  const LogLines warnings;
  const auto scene = parse("# one\nNoSuchMesh 0 0 0 0 0 0 1 1 1 NoSuchImage 0\n");
  ASSERT_TRUE(scene);
  EXPECT_TRUE(warnings.has("Scene.txt:2: the mesh \"Meshes/NoSuchMesh.obj\""));
  EXPECT_TRUE(warnings.has("Scene.txt:2: the image \"Textures/NoSuchImage_diffuse.png\""));
  EXPECT_NEAR(signed_volume(*scene, scene->objects[0]), 1, 1e-6);
  const Material& material = scene->materials[scene->objects[0].material];
  ASSERT_NE(material.base_color_image, kNone);
  EXPECT_EQ(scene->images[material.base_color_image].pixels.rgba[1], 0) << "magenta has no green";
  EXPECT_FLOAT_EQ(material.roughness, 0.05f) << "0 means unset";
}

TEST(SceneTxt, RejectsNamesOutsideOfTheFolder) {
  const LogLines warnings;
  const auto scene = parse("../../secret 0 0 0 0 0 0 1 1 1\n");
  ASSERT_TRUE(scene);
  EXPECT_TRUE(warnings.has("does not exist; a cube stands in"));
}

TEST(SceneTxt, BadLinesNameFileLineColumnAndWhatWasExpected) {
  EXPECT_EQ(error_of("\nBox 0 abc 0 0 0 0 1 1 1\n"),
            "Scene.txt:2:7: expected a number for the y position, found \"abc\"");
  const std::string box = "Box 0 0 0 0 0 0 1 1";
  expect_mistakes(
      error_of, "Scene.txt",
      {{box, "1:20", {"the z scale", "the end of the line"}},
       {box + " inf", "1:21", {"a finite number for the z scale", "\"inf\""}},
       {box + " 1e99", "1:21", {"a finite number for the z scale", "\"1e99\""}},
       {box + " 1 Wood 0.5 more", "1:32", {"expected the end of the line", "\"more\""}},
       {box + " 1 Wood rough", "1:28", {"the roughness", "\"rough\""}},
       {"LIGHT_SOURCE 0 0 0 1 1 1", "1:25", {"the light's power", "the end of the line"}},
       {"LIGHT_SOURCE 0 0 0 1 1 1 -5", "1", {"colour and power must not be negative"}},
       {"Broken 0 0 0 0 0 0 1 1 1", "1", {" Meshes/Broken.obj:2:7: ", "finite", "\"nan\""}},
       {"OutOfRange 0 0 0 0 0 0 1 1 1", "1", {" Meshes/OutOfRange.obj:4:7: ", "\"4\" names no"}}});
}

TEST(SceneTxt, RejectsDistantScenes) {
  EXPECT_NE(error_of("Box 0 0 0 0 0 0 1e38 1 1\n").find("\"Box\" reaches farther"), std::string::npos);
  EXPECT_NE(error_of("Box 1e30 0 0 0 0 0 1 1 1\n").find("\"Box\" reaches farther"), std::string::npos);
}

TEST(SceneTxt, SkipsAnObjectScaledToZero) {
  const LogLines warnings;
  const auto scene = parse("Box 0 0 0 0 0 0 1 0 1\nBox 0 0 0 0 0 0 1 1 1\n");
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->objects.size(), 1u);
  EXPECT_TRUE(warnings.has("Scene.txt:1: \"Box\" is scaled to nothing"));
}

TEST(LoadScene, MissingAndUnknownFiles) {
  const auto missing = load_scene("no/such/Scene.txt");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.failure().code, ErrorCode::bad_input);
  EXPECT_NE(missing.failure().message.find("no/such/Scene.txt"), std::string::npos);
  const auto unknown = load_scene("scene.fbx");
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.failure().message.find("expected .txt, .gltf, .glb or .obj"), std::string::npos);
}

TEST(LoadScene, FindsFilesIgnoringLetterCase) {
  const cli::WorkFolder folder;
  std::filesystem::create_directories(folder.path() / "meshes");
  folder.write("meshes/bOx.OBJ", kCubeObj);
  folder.write("Scene.TXT", "Box 0 0 0 0 0 0 1 1 1\n");
  const LogLines warnings;
  const auto scene = load_scene(folder.path() / "Scene.TXT").value_or_throw();
  EXPECT_NEAR(signed_volume(scene, scene.objects[0]), 8, 1e-6);
  EXPECT_FALSE(warnings.has("does not exist"));
}

TEST(DefaultCamera, FillsFourFifthsOfTheImage) {
  for (const char* text :
       {"Box 3 4 5 0 0 0 10 1 2\n", "Box 1 1 1 0 0 0 0.02 30 0.02\n", "Box 0 0 0 0 0 0 1 1 1\n"})
    for (const float aspect : {16.0f / 9, 1.0f, 0.4f}) {
      const auto scene = parse(text);
      ASSERT_TRUE(scene);
      const Box<float> bounds = world_bounds(*scene);
      const Camera camera = default_camera(*scene, aspect);
      const glm::vec3 forward = glm::normalize(camera.target_world - camera.position_world);
      const glm::vec3 right = glm::normalize(glm::cross(forward, {0, 1, 0})), up = glm::cross(right, forward);
      glm::vec2 low(1e9f), high(-1e9f);
      for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 p(corner & 1 ? bounds.low.x : bounds.high.x,
                          corner & 2 ? bounds.low.y : bounds.high.y,
                          corner & 4 ? bounds.low.z : bounds.high.z);
        const glm::vec3 off = p - camera.position_world;
        const float depth = glm::dot(off, forward), tangent = std::tan(camera.vertical_fov / 2);
        ASSERT_GT(depth, 0);
        const glm::vec2 ndc = glm::vec2(glm::dot(off, right) / aspect, glm::dot(off, up)) / (depth * tangent);
        low = glm::min(low, ndc);
        high = glm::max(high, ndc);
      }
      // One axis is filled, and centred as the other is.
      EXPECT_NEAR(std::max(high.x, high.y), 0.8f, 1e-3f) << text << aspect;
      EXPECT_GE(std::min(low.x, low.y), -0.801f) << text << aspect;
    }
}

}  // namespace
}  // namespace brume::scene
