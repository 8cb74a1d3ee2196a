// The lit image at walls: along flat, slanted and round walls the smoke is as bright as it should be up to
// the last pixel before the wall, and behind a thin wall there is none. BRUME_LIT_WALLS names a CSV file for
// the profiles.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <numbers>
#include <sstream>

#include "core/file.hpp"
#include "film/playback.hpp"
#include "planning/device_camera.hpp"
#include "planning/device_lights.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/half.hpp"
#include "tests/reference/truth.hpp"
#include "tests/render/even_light.hpp"
#include "tests/render/truth_scenes.hpp"

namespace brume::render {
namespace {

using glm::dvec3;

constexpr glm::uvec2 kStrip{128, 4};
constexpr float kVoxel = 0.5f;
constexpr double kSigma = 0.3;           // [1/m]: thin enough to see what is at the wall
constexpr double kRoom = 12, kHigh = 6;  // a room of 12 x 6 x 12 m, full of smoke on one side of the wall
constexpr double kThick = 0.1;           // of the wall [m]
constexpr double kRadius = 3;            // of the round one [m]
constexpr double kSeconds = 15;

/// A wall in the room, by where its solid is and on which side of it the smoke is.
struct Wall {
  std::string name;
  scene::Mesh mesh;
  std::function<bool(dvec3)> solid, smoky;
  dvec3 source;  // of the smoke
};

/// A wall through the room's middle, turned by an angle around the vertical; smoke on the side of -z.
Wall straight_wall(const std::string& name, double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  const dvec3 along(std::cos(angle), 0, std::sin(angle)), normal(std::sin(angle), 0, -std::cos(angle));
  const dvec3 through = dvec3(6, 0, 6.13);  // on no face of a voxel
  Wall wall{name, {}, {}, {}, through + 3.0 * normal + dvec3(0, 2, 0)};
  wall.solid = [=](dvec3 p) {
    const double d = glm::dot(p - through, normal);
    return d <= 0 && d >= -kThick && std::abs(glm::dot(p - through, along)) <= 7.5;
  };
  wall.smoky = [=](dvec3 p) { return glm::dot(p - through, normal) > 0; };
  // A box along the axes, then turned.
  add_box(wall.mesh, {-7.5f, -0.2f, 0}, {7.5f, 6.2f, static_cast<float>(kThick)});
  for (scene::Vertex& vertex : wall.mesh.vertices) {
    const dvec3 p(vertex.position), n(vertex.normal);
    vertex.position = glm::vec3(through + p.x * along + dvec3(0, p.y, 0) - p.z * normal);
    vertex.normal = glm::vec3(n.x * along + dvec3(0, n.y, 0) - n.z * normal);
    vertex.tangent = {0, 1, 0, 1};
  }
  return wall;
}

/// A tube of 128 flat sides around the vertical; smoke outside of it.
Wall round_wall() {
  constexpr int kSides = 128;
  const dvec3 centre(6.11, 0, 5.87);
  const double inradius = kRadius * std::cos(std::numbers::pi / kSides);
  // How far outside of the faces' plane a point lies.
  const auto outside = [=](dvec3 p) {
    const double step = 2 * std::numbers::pi / kSides, turn = std::atan2(p.z - centre.z, p.x - centre.x);
    const double middle = (std::floor(turn / step) + 0.5) * step;
    return (p.x - centre.x) * std::cos(middle) + (p.z - centre.z) * std::sin(middle) - inradius;
  };
  Wall wall{"round", {}, {}, {}, {1, 2, 1}};
  wall.solid = [=](dvec3 p) { return outside(p) <= 0 && outside(p) >= -kThick; };
  wall.smoky = [=](dvec3 p) { return outside(p) > 0; };
  for (const double radius : {kRadius, kRadius - kThick}) {
    for (int i = 0; i < kSides; ++i) {
      const auto first = static_cast<std::uint32_t>(wall.mesh.vertices.size());
      for (const glm::ivec2 corner :
           {glm::ivec2(0, 0), glm::ivec2(0, 1), glm::ivec2(1, 1), glm::ivec2(1, 0)}) {
        const double turn = 2 * std::numbers::pi * (i + corner.x) / kSides;
        scene::Vertex vertex;
        vertex.normal = glm::vec3(std::cos(turn), 0, std::sin(turn));
        vertex.position = glm::vec3(centre) + static_cast<float>(radius) * vertex.normal;
        vertex.position.y = corner.y ? 6.2f : -0.2f;
        vertex.tangent = {0, 1, 0, 1};
        wall.mesh.vertices.push_back(vertex);
      }
      for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) wall.mesh.indices.push_back(first + k);
    }
  }
  return wall;
}

/// Where the eye is, and what it says.
struct View {
  std::string name;
  scene::Camera camera;
  bool near_side = true;
};

std::vector<View> views_of(const Wall& wall) {
  const float high = 2 * std::atan(0.5f * kStrip.y / kStrip.x);
  const auto view = [&](const char* name, dvec3 eye, dvec3 at, bool near_side) {
    return View{name, {glm::vec3(eye), glm::vec3(at), high}, near_side};
  };
  if (wall.name == "round")
    return {view("across", {-3, 3, 5.87}, {6.11, 3, 5.87}, true),
            view("along", {1, 3, 2.5}, {6.11, 3, 2.6}, true),
            view("behind", {6.11, 3, 5.87}, {8, 3, 7}, false)};
  const dvec3 along = wall.name == "flat" ? dvec3(1, 0, 0) : dvec3(std::sqrt(0.75), 0, 0.5);
  const dvec3 normal(along.z, 0, -along.x), middle = dvec3(6, 3, 6.13) - 0.5 * kThick * normal;
  return {view("across", middle - 10.0 * along, middle, true),
          view("along", middle - 4.0 * along + 1.0 * normal, middle + 3.0 * along - 0.8 * normal, true),
          view("behind", middle - 3.0 * along - 1.5 * normal, middle + 2.0 * along, false)};
}

scenario::Scenario scenario_of_wall(const Wall& wall, bool has_light) {
  scene::Scene scene;
  scene.meshes = {wall.mesh, {}};
  add_box(scene.meshes[1], glm::vec3(-0.1f), glm::vec3(0.1f));
  scene.materials.resize(1);
  scene.materials[0].base_color = glm::vec3(0);
  scene.objects = {{"wall", 0, 0, glm::mat4(1)}};
  scene.grenade = {"grenade", 1, 0, glm::mat4(1), Role::ghost};
  scene.camera = scene::Camera{};
  if (has_light) scene.lights = {scene_light({3, 14, 2}, glm::vec3(400))};
  scene::Timeline timeline;
  timeline.sky = {glm::vec3(0), glm::vec3(0), glm::vec3(has_light ? 0.0f : 1.0f), 0, 1};
  timeline.smoke.voxels = 200000;
  timeline.smoke.bloom = 0.05f;
  timeline.smoke.hold = 100;
  timeline.smoke.extinction = static_cast<float>(kSigma);
  timeline.smoke.albedo = glm::vec3(1);
  timeline.smoke.anisotropy = 0;
  timeline.smoke.multiple_scattering = has_light ? 0.0f : 1.0f;
  timeline.smoke.erosion = 0;
  timeline.smokes = {{0, glm::vec3(wall.source) + glm::vec3(0, 0.1f, 0), glm::vec3(wall.source)}};
  return scenario_of(std::move(scene), std::move(timeline), {{24, 12, 24}, kVoxel, glm::vec3(0)});
}

/// Green and transmittance of the smoke of each pixel, means over the rows.
struct Profile {
  std::vector<double> radiance, transmittance;
};

class LitWallsTest : public gpu::GpuTest {
 protected:
  static Profile mean_of_rows(const std::function<glm::dvec2(std::uint32_t, std::uint32_t)>& pixel) {
    Profile profile;
    for (std::uint32_t x = 0; x < kStrip.x; ++x) {
      glm::dvec2 sum(0);
      for (std::uint32_t y = 0; y < kStrip.y; ++y) sum += pixel(x, y) / double(kStrip.y);
      profile.radiance.push_back(sum.x);
      profile.transmittance.push_back(sum.y);
    }
    return profile;
  }
  /// A scenario whose smoke is grown, rendered from anywhere.
  struct Studio {
    explicit Studio(const scenario::Scenario& scenario)
        : simulation(scenario::Simulation::create(scenario).value_or_throw()),
          renderer(context(), runner(), scenario.scene, {.size_px = kStrip}) {
      simulation->advance_to(kSeconds);
      input = frame_input(scenario, *simulation, kSeconds, holes);
    }
    Profile draw(const scene::Camera& camera) {
      input.view.camera = camera;
      ++input.view.frame_index;
      renderer.draw(input);
      const auto texels = read_back<passes::Half4>(renderer.media());
      return mean_of_rows([&](std::uint32_t x, std::uint32_t y) {
        const glm::vec4 texel = passes::from_half(texels[x + std::size_t{kStrip.x} * y]);
        return glm::dvec2(texel.g, texel.a);
      });
    }
    std::unique_ptr<scenario::Simulation> simulation;
    Renderer renderer;
    std::vector<shared::Hole> holes;
    FrameInput input;
  };

  static std::ostringstream& csv() {
    static std::ostringstream rows;
    return rows;
  }
  static void keep(const Wall& wall, const View& view, const char* light, const Profile& drawn,
                   const Profile& expected) {
    for (std::uint32_t x = 0; x < kStrip.x; ++x)
      csv() << wall.name << ',' << view.name << ',' << light << ',' << x << ',' << drawn.radiance[x] << ','
            << expected.radiance[x] << '\n';
  }
  static void TearDownTestSuite() {
    const char* path = std::getenv("BRUME_LIT_WALLS");
    if (path == nullptr) return;
    EXPECT_TRUE(
        static_cast<bool>(write_file_atomic(path, "wall,view,light,pixel,drawn,expected\n" + csv().str())));
  }
  /// Nowhere along the profile may the image differ by more than three steps of 255 when its brightest is
  /// white (as little as docs/how/smoke.md allows), and where no smoke should be there is none.
  static void expect_no_line(const Wall& wall, const View& view, const Profile& drawn,
                             const Profile& expected) {
    const double brightest = *std::max_element(expected.radiance.begin(), expected.radiance.end());
    if (!view.near_side) {
      // Inside of a round wall smoke may run over by 0.6 v^2 / r (docs/how/smoke.md), which a sample of
      // the march takes for a whole step.
      const double run_over = wall.name == "round" ? 0.6 * kVoxel * kVoxel / kRadius : 0;
      const double step = run_over > 0 ? 0.4 * kVoxel : 0;
      ASSERT_EQ(brightest, 0);
      double mean = 0;
      for (const double passed : drawn.transmittance) {
        EXPECT_GE(passed, std::exp(-kSigma * step)) << wall.name;
        mean += passed / kStrip.x;
      }
      EXPECT_GE(mean, std::exp(-kSigma * run_over)) << wall.name;
      return;
    }
    const auto shown = [&](double radiance) { return 255 * encoded(radiance / brightest); };
    double most = 0;
    for (std::uint32_t x = 0; x < kStrip.x; ++x) {
      const double apart = std::abs(shown(drawn.radiance[x]) - shown(expected.radiance[x]));
      EXPECT_LE(apart, 3) << wall.name << ", " << view.name << ", pixel " << x;
      EXPECT_EQ(drawn.radiance[x] > 0, expected.radiance[x] > 0)
          << wall.name << ", " << view.name << ", pixel " << x;
      most = std::max(most, apart);
    }
    std::printf("%-8s %-7s off by %.2f of 255 at most\n", wall.name.c_str(), view.name.c_str(), most);
  }
  /// IEC 61966-2-1.
  static double encoded(double v) {
    return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(std::min(v, 1.0), 1 / 2.4) - 0.055;
  }
  static std::vector<Wall> walls() {
    return {straight_wall("flat", 0), straight_wall("slanted", 30), round_wall()};
  }
};

/// How far a pixel sees into smoke of full density, by small steps from the eye to the wall [m].
double smoke_before(const Wall& wall, const shared::Camera& camera, glm::dvec2 pixel) {
  const glm::dvec2 ndc = pixel / glm::dvec2(kStrip) * 2.0 - 1.0;
  const dvec3 way =
      glm::normalize(dvec3(camera.forward) + ndc.x * dvec3(camera.right) - ndc.y * dvec3(camera.up));
  constexpr double kStep = 0.005;
  double sum = 0;
  for (double t = 0.5 * kStep; t < 25; t += kStep) {
    const dvec3 p = dvec3(camera.eye_world) + t * way;
    if (wall.solid(p)) break;
    const bool in_room =
        glm::all(glm::greaterThan(p, dvec3(0))) && glm::all(glm::lessThan(p, dvec3(kRoom, kHigh, kRoom)));
    if (in_room && wall.smoky(p)) sum += kStep;
  }
  return sum;
}

// In even light smoke without absorption is as bright as it is dense: 1 - T, by the distance to the wall
// alone.
TEST_F(LitWallsTest, InEvenLightOnlyTheDistanceToTheWallCounts) {
  for (const Wall& wall : walls()) {
    const scenario::Scenario scenario = scenario_of_wall(wall, false);
    Studio studio(scenario);
    const voxel::BitGrid level = closed_level(scenario.voxels.grid.layout());
    light_evenly(studio.input, level, 1);
    for (const View& view : views_of(wall)) {
      const Profile drawn = studio.draw(view.camera);
      const shared::Camera camera = planning::device_camera(view.camera, kStrip);
      const Profile expected = mean_of_rows([&](std::uint32_t x, std::uint32_t y) {
        const double passed = std::exp(-kSigma * smoke_before(wall, camera, glm::dvec2(x, y) + 0.5));
        return glm::dvec2(1 - passed, passed);
      });
      keep(wall, view, "even", drawn, expected);
      expect_no_line(wall, view, drawn, expected);
    }
  }
}

TEST_F(LitWallsTest, ByALightTheWallShowsNoLine) {
  for (const Wall& wall : walls()) {
    const scenario::Scenario scenario = scenario_of_wall(wall, true);
    Studio studio(scenario);
    reference::TruthScene truth;
    truth.size_px = kStrip;
    truth.look = studio.input.smoke.look;
    truth.time = kSeconds;
    truth.volume = studio.input.smoke.volume;
    const auto lights = planning::device_lights(scenario.scene.lights, 64);
    truth.lights = lights;
    const auto triangles = reference::truth_triangles(scenario.scene);
    truth.triangles = triangles;
    for (const View& view : views_of(wall)) {
      const Profile drawn = studio.draw(view.camera);
      truth.camera = planning::device_camera(view.camera, kStrip);
      const auto pixels = trace_truth(truth);
      const Profile expected = mean_of_rows([&](std::uint32_t x, std::uint32_t y) {
        const auto& pixel = pixels[x + std::size_t{kStrip.x} * y];
        return glm::dvec2(pixel.smoke.g, pixel.transmittance);
      });
      keep(wall, view, "light", drawn, expected);
      expect_no_line(wall, view, drawn, expected);
    }
  }
}

}  // namespace
}  // namespace brume::render
