// Exported levels match the scene in Blender, in both formats; docs/guides/blender.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "core/file.hpp"
#include "image/decode.hpp"
#include "scene/event_fields.hpp"
#include "scene/files/load.hpp"
#include "scene/files/timeline_reader.hpp"
#include "scene/timeline.hpp"
#include "shared/spot.h"
#include "tests/blender/blender_fixture.hpp"
#include "tests/cli/run_program.hpp"
#include "tests/reference/triangle_box.hpp"

namespace brume::blender {
namespace {

using Json = nlohmann::json;

// Error bound of an exported position [m]: a float32 within 10 m is rounded by at most 5e-7 m, a few times.
constexpr double kNear = 1e-4;

struct Corner {
  glm::dvec3 point, normal;
  glm::dvec2 uv{0};
};

struct Triangle {
  std::array<Corner, 3> corners;
  std::string object;  // Blender's name, or Brume's.
  std::string role;    // Brume's name of it.
  bool has_uv = false;
};

// Blender is Z up: its x, z and -y are x, y and z here.
glm::dvec3 turned(const Json& p) {
  return {p[0].get<double>(), p[2].get<double>(), -p[1].get<double>()};
}

std::vector<Triangle> blenders_triangles(const Json& expected) {
  const double metres = expected["metres"];
  std::vector<Triangle> triangles;
  for (const Json& entry : expected["triangles"]) {
    Triangle t;
    t.object = entry["object"];
    t.role = entry["role"];
    for (std::size_t i = 0; i < 3; ++i) {
      const Json& corner = entry["corners"][i];
      t.corners[i] = {turned(corner["point"]) * metres, turned(corner["normal"]), {}};
      t.has_uv = !corner["uv"].is_null();
      // The v axis points down in Brume.
      if (t.has_uv) t.corners[i].uv = {corner["uv"][0].get<double>(), 1 - corner["uv"][1].get<double>()};
    }
    triangles.push_back(std::move(t));
  }
  return triangles;
}

std::vector<Triangle> brumes_triangles(const scene::Scene& scene) {
  std::vector<Triangle> triangles;
  for (const scene::Object& object : scene.objects) {
    const scene::Mesh& mesh = scene.meshes[object.mesh];
    const glm::dmat4 world(object.world_from_mesh);
    const glm::dmat3 normal_world = glm::transpose(glm::inverse(glm::dmat3(world)));
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      Triangle t;
      t.object = object.name;
      t.role = name_of(object.role);
      for (std::size_t k = 0; k < 3; ++k) {
        const scene::Vertex& v = mesh.vertices[mesh.indices[i + k]];
        t.corners[k] = {glm::dvec3(world * glm::dvec4(glm::dvec3(v.position), 1)),
                        glm::normalize(normal_world * glm::dvec3(v.normal)), glm::dvec2(v.uv)};
      }
      triangles.push_back(std::move(t));
    }
  }
  return triangles;
}

// The rotation that maps the corners of `b` to those of `a` if they are the same points; else -1.
int same_points(const Triangle& a, const Triangle& b) {
  for (std::size_t turn = 0; turn < 3; ++turn) {
    double farthest = 0;
    for (std::size_t k = 0; k < 3; ++k)
      farthest = std::max(farthest, glm::distance(a.corners[k].point, b.corners[(k + turn) % 3].point));
    if (farthest <= kNear) return static_cast<int>(turn);
  }
  return -1;
}

void expect_same_look(const Triangle& blender, const Triangle& brume, std::size_t turn, bool with_uv) {
  EXPECT_EQ(blender.role, brume.role) << blender.object << " as " << brume.object;
  for (std::size_t k = 0; k < 3; ++k) {
    const Corner &a = blender.corners[k], &b = brume.corners[(k + turn) % 3];
    // Blender's exporter and its 16-bit storage of custom normals round to four decimals.
    EXPECT_GT(glm::dot(a.normal, b.normal), 0.9999) << blender.object << " as " << brume.object;
    if (with_uv && blender.has_uv) {
      EXPECT_LT(glm::distance(a.uv, b.uv), 1e-5) << blender.object << " as " << brume.object;
    }
  }
}

class BlenderFormats : public Blender {};
INSTANTIATE_TEST_SUITE_P(, BlenderFormats, testing::Values("txt", "gltf"),
                         [](const auto& kind) { return std::string(kind.param); });

TEST_P(BlenderFormats, TrianglesMatchBlender) {
  for (const char* name : {"courtyard", "small"}) {
    SCOPED_TRACE(name);
    const Json expected = read_json(blender_run().folder / name / "expected.json");
    const std::vector<Triangle> blender = blenders_triangles(expected);
    const std::vector<Triangle> brume =
        brumes_triangles(scene::load_scene(level(name, GetParam())).value_or_throw());
    ASSERT_GT(blender.size(), 800u);
    EXPECT_EQ(blender.size(), brume.size());
    std::vector<bool> taken(brume.size());
    for (const Triangle& t : blender) {
      std::size_t at = 0;
      int turn = -1;
      for (; at < brume.size(); ++at) {
        if (!taken[at] && (turn = same_points(t, brume[at])) >= 0) break;
      }
      ASSERT_LT(at, brume.size()) << "a triangle of " << t.object << " is not there";
      taken[at] = true;
      // Scene.txt stores the colours of a door with several materials in a palette texture.
      const bool is_door = t.object == "entrance" || t.object == "handle";
      expect_same_look(t, brume[at], static_cast<std::size_t>(turn), !is_door);
      if (HasFailure()) return;
    }
  }
}

// Voxels that Blender's triangles touch, by brute force; each voxel is grown by `more` voxels on all sides.
std::size_t voxels_touched(const std::vector<Triangle>& triangles, const voxel::GridLayout& frame,
                           double more) {
  std::set<std::array<int, 3>> touched;
  for (const Triangle& t : triangles) {
    if (!stops_smoke(role_of_name(t.role).value())) continue;
    std::array<glm::dvec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = (t.corners[k].point - glm::dvec3(frame.origin_world)) / double{frame.voxel_size};
    const glm::dvec3 low = glm::min(glm::min(p[0], p[1]), p[2]) - more,
                     high = glm::max(glm::max(p[0], p[1]), p[2]) + more;
    const double size = 1 + 2 * more;
    for (int z = static_cast<int>(std::floor(low.z)); z <= static_cast<int>(std::floor(high.z)); ++z)
      for (int y = static_cast<int>(std::floor(low.y)); y <= static_cast<int>(std::floor(high.y)); ++y)
        for (int x = static_cast<int>(std::floor(low.x)); x <= static_cast<int>(std::floor(high.x)); ++x) {
          const glm::dvec3 corner = glm::dvec3(x, y, z) - more;
          // In units of the grown voxel, whose low corner is the origin.
          const std::array<glm::dvec3, 3> in_box{(p[0] - corner) / size, (p[1] - corner) / size,
                                                 (p[2] - corner) / size};
          if (reference::touches(in_box, glm::dvec3(0))) touched.insert({x, y, z});
        }
  }
  return touched.size();
}

TEST_P(BlenderFormats, VoxelsAreThoseThatBlendersTrianglesTouch) {
  const voxel::GridLayout frame{{66, 26, 52}, 0.2f, {-6.53f, -0.67f, -5.37f}};
  const auto triangles = blenders_triangles(read_json(blender_run().folder / "courtyard" / "expected.json"));
  const cli::Outcome run = cli::run_brume(
      blender_run().folder, {"voxelize", level("courtyard", GetParam()).string(), "--grid", "66x26x52",
                             "--voxel", "0.2", "--origin", "-6.53,-0.67,-5.37", "--json", "-"});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  const std::size_t solid = Json::parse(run.out)["solid"];
  // Positions have an error of kNear, which may change the voxels that are barely touched.
  EXPECT_GE(solid, voxels_touched(triangles, frame, -kNear / 0.2));
  EXPECT_LE(solid, voxels_touched(triangles, frame, kNear / 0.2));
}

// The box stands from 0.1 - 1.5 to 0.1 (turned by a quarter), 0.1 to 1.1 and -2.1 to -0.1: at voxels of 0.25
// it touches 7 x 5 x 9 voxels, and holds 5 x 3 x 7 that its surface does not touch.
TEST_P(BlenderFormats, ABoxHasTheExpectedVoxels) {
  const cli::Outcome run = cli::run_brume(
      blender_run().folder, {"voxelize", level("box", GetParam()).string(), "--grid", "16x16x16", "--voxel",
                             "0.25", "--origin", "-2,-1,-3", "--json", "-"});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  EXPECT_EQ(Json::parse(run.out)["solid"], 7 * 5 * 9 - 5 * 3 * 7);
}

TEST_P(BlenderFormats, NamesAreUniqueAndDoorsAreComplete) {
  const scene::Scene scene = scene::load_scene(level("courtyard", GetParam())).value_or_throw();
  std::map<std::string, int> count;
  for (const scene::Object& object : scene.objects) ++count[object.name];
  EXPECT_EQ(count["Wall"], 1);
  EXPECT_EQ(count["wall_2"], 1);
  EXPECT_EQ(count["Wall.lintel"], 1);
  EXPECT_EQ(count["Crate_tipped"], 1);
  EXPECT_EQ(count.count("measure") + count.count("not_rendered") + count.count("hidden"), 0u);
  for (const char* name : {"Kafig_grun_", "_con", "object", "_one", "_LIGHT_SOURCE"})
    EXPECT_EQ(count[name], 1) << name;
  // The leaf and its handle: one mesh in Scene.txt, two nodes with the same name in glTF.
  EXPECT_EQ(count["door_entrance"], std::string(GetParam()) == "txt" ? 1 : 2);
  EXPECT_EQ(count.count("handle"), 0u);
}

TEST_P(BlenderFormats, ObjectsShareMeshes) {
  const scene::Scene scene = scene::load_scene(level("courtyard", GetParam())).value_or_throw();
  std::set<std::uint32_t> meshes;
  int crates = 0;
  for (const scene::Object& object : scene.objects) {
    // The tipped one is rotated and scaled non-uniformly, which Scene.txt cannot express for a shared mesh.
    if (!object.name.starts_with("Crate") || object.name == "Crate_tipped") continue;
    meshes.insert(object.mesh);
    ++crates;
  }
  EXPECT_EQ(crates, 2);
  EXPECT_EQ(meshes.size(), 1u);
}

TEST_P(BlenderFormats, MeshesInEditModeAreExported) {
  const Box<float> bounds =
      scene::world_bounds(scene::load_scene(level("edited", GetParam())).value_or_throw());
  EXPECT_LT(glm::distance(bounds.high, glm::vec3(5, 5, 1)), kNear);
  EXPECT_LT(glm::distance(bounds.low, glm::vec3(-1, -1, -5)), kNear);
  EXPECT_EQ(read_json(blender_run().folder / "edited/facts.json")["mode"], "EDIT_MESH");
}

TEST_P(BlenderFormats, UnsupportedContentIsSkippedWithAWarning) {
  const scene::Scene scene = scene::load_scene(level("odd", GetParam())).value_or_throw();
  ASSERT_TRUE(scene.grenade.has_value());
  EXPECT_EQ(scene.grenade->name, "Grenade");
  EXPECT_FALSE(scene.camera.has_value());
  EXPECT_TRUE(scene.lights.empty());
  std::set<std::string> first_words;
  for (const scene::Object& object : scene.objects)
    first_words.insert(object.name.substr(0, object.name.find('.')));
  EXPECT_EQ(first_words, (std::set<std::string>{"cube", "flat", "Outdoor_stone"}));
  // A plane without volume that Blender shows.
  EXPECT_FLOAT_EQ(scene::world_bounds(scene).low.y, -3);
  for (const char* said :
       {"the light \"dark\" has negative power or colour",
        "the camera \"flat view\" is not a perspective camera", "the image \"gone\" has no pixels",
        "\"Outdoor stone\" has \"door\" in its name"}) {
    EXPECT_NE(blender_run().log.find(std::string("Brume: warning: ") + said), std::string::npos) << said;
  }
}

// An area light, a spot of 180 degrees, emits pi times its intensity along its axis.
void expect_power_of_area_lights(const scene::Scene& scene) {
  for (const scene::Light& light : scene.lights) {
    if (light.kind != scene::LightKind::spot || light.cos_outer > 1e-3f) continue;
    constexpr int kSteps = 1000;
    double power = 0;
    for (int i = 0; i < kSteps; ++i)
      power += 2 * std::acos(-1.0) / kSteps *
               double{shared::spot_falloff(light.cos_inner, light.cos_outer,
                                           (static_cast<float>(i) + 0.5f) / kSteps)};
    EXPECT_NEAR(power, std::acos(-1.0), 1e-3);
  }
}

// Radiant intensities [W/sr]: power / (4 pi) of points and spots; power / 4 of an area light along its axis.
TEST_P(BlenderFormats, LightsMatchBlender) {
  const double pi = std::acos(-1.0);
  for (const auto& sample : {std::pair{"courtyard", 1.0}, std::pair{"small", 0.25}}) {
    const double metres = sample.second;
    const scene::Scene scene = scene::load_scene(level(sample.first, GetParam())).value_or_throw();
    const bool is_txt = std::string(GetParam()) == "txt";
    ASSERT_EQ(scene.lights.size(), is_txt ? 3u : 4u);
    const auto expect_light = [&](glm::dvec3 blender, double red, scene::LightKind kind) {
      const glm::dvec3 at = glm::dvec3(blender.x, blender.z, -blender.y) * metres;
      const auto found = std::find_if(scene.lights.begin(), scene.lights.end(), [&](const scene::Light& l) {
        return glm::distance(glm::dvec3(l.position_world), at) < kNear;
      });
      ASSERT_NE(found, scene.lights.end()) << at.x << ' ' << at.y << ' ' << at.z;
      EXPECT_NEAR(double{found->intensity.r}, red, 1e-4 * red);
      EXPECT_EQ(found->kind, is_txt ? scene::LightKind::point : kind);
      if (found->kind == scene::LightKind::point) return;
      // Lights with a direction point at the target in build_lights().
      const glm::dvec3 aim = blender.z > 8   ? glm::dvec3(-2, 0, -3)
                             : blender.z > 3 ? glm::dvec3(0.2, 0.6, -0.9)
                                             : glm::dvec3(0, 0.5, -2);
      const glm::dvec3 direction = glm::normalize(aim * metres - at);
      EXPECT_LT(glm::distance(glm::dvec3(found->direction_world), direction), 1e-4);
    };
    const double area = metres * metres;
    expect_light({2.3, 0.9, 3.3}, 300 * area / (4 * pi), scene::LightKind::point);
    expect_light({-5.6, -1.4, 3.9}, 0.62 * 2600 * area / (4 * pi), scene::LightKind::spot);
    expect_light({0, 3.9, 2.6}, 300 * area / (is_txt ? 4 * pi : 4), scene::LightKind::spot);
    expect_power_of_area_lights(scene);
    if (!is_txt) expect_light({0, 0, 9}, 0.55 * 0.3, scene::LightKind::directional);
  }
}

TEST_P(BlenderFormats, TimelineMatchesTheScene) {
  const scene::Timeline timeline =
      scene::load_timeline(this->timeline("courtyard", GetParam())).value_or_throw();
  const scene::Scene scene = scene::load_scene(timeline.scene).value_or_throw();
  EXPECT_TRUE(scene::check_objects(timeline, scene));
  EXPECT_FLOAT_EQ(timeline.duration, 4);
  EXPECT_EQ(timeline.smoke.voxels, 1500u);
  EXPECT_FLOAT_EQ(timeline.sky.zenith.b, 0.055f);
  EXPECT_NEAR(timeline.sky.ambient.b, 0.055f / 0.75f, 1e-6f);

  ASSERT_EQ(timeline.smokes.size(), 1u);
  EXPECT_LT(glm::distance(timeline.smokes[0].at_world, glm::vec3(0.2f, 0.2f, -0.7f)), kNear);
  EXPECT_LT(glm::distance(timeline.smokes[0].from_world,
                          scene::camera_at(timeline, {}, timeline.smokes[0].time).position_world),
            1e-3);
  ASSERT_EQ(timeline.texts.size(), 1u);
  EXPECT_EQ(timeline.texts[0].text, "HI");
  EXPECT_LT(glm::distance(timeline.texts[0].toward_world, glm::vec3(-0.3f, 1.15f, -0.6f)), kNear);
  ASSERT_EQ(timeline.shots.size(), 2u);
  EXPECT_EQ(timeline.shots[0].shape, scene::ShotShape::box);
  EXPECT_NEAR(timeline.shots[0].roll, std::acos(-1.0) / 4, 1e-6);
  // Its arrow, z, laid flat by a quarter about x (to -y of Blender) and turned by 200 degrees about Blender's
  // z.
  const double turn = 200 * std::acos(-1.0) / 180;
  const glm::dvec3 arrow =
      glm::normalize(glm::dvec3(timeline.shots[0].toward_world) - glm::dvec3(timeline.shots[0].from_world));
  EXPECT_LT(glm::distance(arrow, glm::dvec3(std::sin(turn), 0, std::cos(turn))), 1e-5);
  EXPECT_EQ(timeline.shots[1].shape, scene::ShotShape::mask);
  EXPECT_EQ(read_text_file(timeline.shots[1].mask).value_or_throw(),
            read_text_file(blender_run().folder / "a star.png").value_or_throw());
  ASSERT_EQ(timeline.blasts.size(), 1u);
  EXPECT_FLOAT_EQ(timeline.blasts[0].radius, 1.5f);
  ASSERT_EQ(timeline.doors.size(), 1u);
  EXPECT_EQ(timeline.doors[0].object, "door_entrance");
  EXPECT_TRUE(timeline.doors[0].open);
}

// Blender's view at frame 49 (2 s): the eye, and the corners of the image one focal length ahead.
TEST_P(BlenderFormats, CameraMatchesBlender) {
  const scene::Timeline timeline =
      scene::load_timeline(this->timeline("courtyard", GetParam())).value_or_throw();
  EXPECT_GT(timeline.camera.size(), 8u);
  const scene::Camera camera = scene::camera_at(timeline, {}, 2);
  const Json view = read_json(blender_run().folder / "courtyard" / "expected.json")["frame_49"];
  const glm::dvec3 eye = turned(view["eye"]);
  // Keys are an eighth of a second apart; between them the curves of Brume and Blender differ.
  EXPECT_LT(glm::distance(glm::dvec3(camera.position_world), eye), 1e-3);
  glm::dvec3 middle(0), top(0), bottom(0);
  for (const Json& corner : view["corners"]) {
    const glm::dvec3 p = turned(corner) - eye;
    middle += p / 4.0;
    (p.y > (turned(view["corners"][0]).y + turned(view["corners"][2]).y) / 2 - eye.y ? top : bottom) +=
        p / 2.0;
  }
  const glm::dvec3 forward =
      glm::normalize(glm::dvec3(camera.target_world) - glm::dvec3(camera.position_world));
  EXPECT_GT(glm::dot(forward, glm::normalize(middle)), 1 - 1e-6);
  const double fov = std::acos(glm::dot(glm::normalize(top), glm::normalize(bottom)));
  EXPECT_NEAR(double{camera.vertical_fov}, fov, 1e-4);
}

template <typename Event>
std::vector<float> numbers_of(const Event& event) {
  std::vector<float> numbers;
  scene::visit_event_numbers(event,
                             [&](const scene::OptionInfo&, float number) { numbers.push_back(number); });
  return numbers;
}

// Timelines accept the limits of all properties, and the defaults of both are the same.
TEST_F(Blender, SettingsMatchTheRangesAndDefaultsOfTimelines) {
  for (const char* setting : {"least", "usual", "most"}) {
    const auto read = scene::load_timeline(blender_run().folder / (setting + std::string(".toml")));
    ASSERT_TRUE(read) << setting << ": " << read.failure().message;
    std::size_t kinds = 0;
    scene::for_each_event_list(*read, [&](const char*, const auto& list) { kinds += list.size(); });
    ASSERT_GE(kinds, 4u);
    if (setting != std::string("usual")) continue;
    const scene::SmokeOptions smoke;
    EXPECT_EQ(read->smoke.voxels, smoke.voxels);
    EXPECT_EQ(read->smoke.bloom, smoke.bloom);
    EXPECT_EQ(read->smoke.hold, smoke.hold);
    EXPECT_EQ(read->smoke.dissolve, smoke.dissolve);
    EXPECT_EQ(read->smoke.extinction, smoke.extinction);
    EXPECT_EQ(read->grid.voxel, scene::GridOptions{}.voxel);
    scene::for_each_event_list(*read, []<typename Event>(const char* kind, const std::vector<Event>& list) {
      for (const Event& event : list) EXPECT_EQ(numbers_of(event), numbers_of(Event())) << kind;
    });
    ASSERT_TRUE(read->shots.size() == 1 && read->texts.size() == 1);
    EXPECT_EQ(read->shots[0].shape, scene::ShotShape::cylinder);
    EXPECT_EQ(read->texts[0].text, "a \"b\" \\ \u00e9 \U0001f32b");
  }
}

TEST_F(Blender, ExportDoesNotChangeTheFile) {
  const Json expected = read_json(blender_run().folder / "courtyard" / "expected.json");
  EXPECT_EQ(expected["left_behind"], Json::array());
  EXPECT_EQ(expected["frame_after"], 49);
}

TEST_F(Blender, ImageFilesAreCopiedUnchanged) {
  const auto textures = blender_run().folder / "courtyard/txt/Textures";
  EXPECT_EQ(read_text_file(textures / "ground_diffuse.jpg").value_or_throw(),
            read_text_file(blender_run().folder / "paving stones.jpg").value_or_throw());
  EXPECT_FALSE(std::filesystem::exists(textures / "ground_diffuse.png"));
  // Brume reads all of them: the scene has no placeholders.
  const scene::Scene scene = scene::load_scene(level("courtyard", "txt")).value_or_throw();
  for (const scene::Image& image : scene.images) EXPECT_NE(image.name, "stand-in checker");
}

TEST_F(Blender, GltfContainsTheCamera) {
  const scene::Scene scene = scene::load_scene(level("courtyard", "gltf")).value_or_throw();
  ASSERT_TRUE(scene.camera.has_value());
  const scene::Timeline timeline = scene::load_timeline(this->timeline("courtyard", "gltf")).value_or_throw();
  EXPECT_NEAR(scene.camera->vertical_fov, scene::camera_at(timeline, {}, 2).vertical_fov, 1e-4f);
}

TEST_F(Blender, RenderWithBrumeShowsTheImage) {
  const image::Image8 picture = image::load_image(blender_run().folder / "render.png").value_or_throw();
  EXPECT_EQ(picture.width, 960u);
  EXPECT_EQ(picture.height, 540u);
  expect_a_picture(picture);
}

TEST_F(Blender, ImportedVoxelsAreInPlace) {
  const Json voxels = read_json(blender_run().folder / "voxels.json");
  EXPECT_EQ(voxels["role"], "LEFT_OUT");
  const cli::Outcome run =
      cli::run_brume(blender_run().folder,
                     {"voxelize", level("courtyard", "gltf").string(), "--voxel", "0.2", "--json", "-"});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  const Json told = Json::parse(run.out);
  EXPECT_EQ(voxels["solid"], told["solid"]);
  // Corners stand on the grid, in Blender's axes; the surface looks outward and encloses the voxels.
  for (const Json& point : voxels["points"]) {
    const glm::dvec3 p = turned(point);
    for (int axis = 0; axis < 3; ++axis) {
      const double at = (p[axis] - told["origin"][static_cast<std::size_t>(axis)].get<double>()) / 0.2;
      ASSERT_NEAR(at, std::round(at), 1e-4);
    }
  }
  const double volume = voxels["outward"].get<double>() / 3;
  EXPECT_NEAR(volume / (0.2 * 0.2 * 0.2), told["solid"].get<double>(), 0.5);
}

TEST_F(Blender, FailuresAreOneLine) {
  const Json lines = read_json(blender_run().folder / "failures.json");
  const auto expect_line = [&](const char* what, const char* part) {
    const std::string line = lines[what];
    EXPECT_NE(line.find(part), std::string::npos) << what << ": " << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  };
  expect_line("no program",
              "no brume here is not executable; set the path of brume in Preferences > Add-ons > Brume");
  expect_line("program fails", "brume ended with code 1");
  expect_line("no voxels", "scene.obj:2: expected voxels");
  expect_line("no folder", "cannot be written");
  expect_line("empty scene", "the scene has no visible mesh");
}

}  // namespace
}  // namespace brume::blender
