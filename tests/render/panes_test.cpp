// Panes over a picture: what they let through, and where media are before or behind them.
#include "render/renderer.hpp"
#include "scenario/frame.hpp"
#include "scenario/simulation.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/half.hpp"
#include "tests/render/rooms.hpp"

namespace brume::render {
namespace {

using scenario::frame_input;

/// What clear glass reflects of light that falls straight on it.
constexpr double kStraight = 0.04;
constexpr glm::vec3 kTint{0.5f, 0.25f, 0.125f};

class PanesTest : public gpu::GpuTest {
 protected:
  static constexpr glm::uvec2 kSize{33, 17};

  /// A hall from z = 0 to 12, whose end at 0 emits; the eye at 11 looks at it through a pane at 6.
  struct Hall {
    scene::Material pane = glass(glm::vec3(1));
    glm::vec3 emission{1};
    std::optional<float> smoke_z, light_z;
    int panes = 1;
  };
  static scene::Material glass(const glm::vec3& tint) {
    scene::Material material;
    material.base_color = tint;
    material.roughness = 0;
    return material;
  }
  static scenario::Scenario scenario_of_hall(const Hall& hall) {
    scene::Scene scene;
    add_box(scene.meshes.emplace_back(), {-1, -1, -0.4f}, {7, 7, 0});
    scene.materials.resize(2);
    scene.materials[0].base_color = glm::vec3(0);
    scene.materials[0].emission = hall.emission;
    scene.materials[1] = hall.pane;
    scene.objects = {{"end", 0, 0}};
    add_box(scene.meshes.emplace_back(), glm::vec3(-0.1f), glm::vec3(0.1f));
    for (int i = 0; i < hall.panes; ++i) {
      scene::Mesh& mesh = scene.meshes.emplace_back();
      for (const glm::vec2 at : {glm::vec2(-1, -1), glm::vec2(7, -1), glm::vec2(7, 7), glm::vec2(-1, 7)}) {
        scene::Vertex vertex;
        vertex.position = {at.x, at.y, 6.1f - 0.2f * static_cast<float>(i)};
        vertex.normal = {0, 0, 1};
        mesh.vertices.push_back(vertex);
      }
      mesh.indices = {0, 1, 2, 0, 2, 3};
      scene::Object pane{"pane", static_cast<std::uint32_t>(scene.meshes.size() - 1), 1};
      pane.role = Role::glass;
      scene.objects.push_back(pane);
    }
    scene.grenade = {"grenade", 1, 0, glm::mat4(1), Role::ghost};
    scene.camera = scene::Camera{{3, 3, 11}, {3, 3, 0}, 0.3f};
    if (hall.light_z) scene.lights = {scene_light({3, 5.5f, *hall.light_z}, glm::vec3(4))};
    scene::Timeline timeline;
    timeline.sky = {glm::vec3(0), glm::vec3(0), glm::vec3(0), 0, 0};
    timeline.smoke.voxels = 3000;
    timeline.smoke.bloom = 0.05f;
    timeline.smoke.hold = 100;
    timeline.smoke.extinction = 0.4f;
    timeline.smoke.albedo = glm::vec3(0.9f);
    timeline.smoke.erosion = 0;
    if (hall.smoke_z) timeline.smokes = {{0, {3, 1.1f, *hall.smoke_z}, {3, 1, *hall.smoke_z}}};
    return scenario_of(std::move(scene), std::move(timeline), {{12, 12, 24}, 0.5f, glm::vec3(0)});
  }
  /// Radiance and alpha of the pixels.
  static std::vector<glm::vec4> picture(const scenario::Scenario& scenario) {
    constexpr double kSeconds = 15;
    const auto simulation = scenario::Simulation::create(scenario).value_or_throw();
    Renderer renderer(context(), runner(), scenario.scene, {.size_px = kSize});
    simulation->advance_to(kSeconds);
    std::vector<shared::Hole> holes;
    renderer.draw(frame_input(scenario, *simulation, kSeconds, holes));
    return passes::from_half(read_back<passes::Half4>(renderer.radiance()));
  }
  static glm::vec4 middle(const std::vector<glm::vec4>& pixels) {
    return pixels[kSize.x * (kSize.y / 2) + kSize.x / 2];
  }
};

TEST_F(PanesTest, TintWhatIsBehind) {
  Hall hall;
  hall.pane = glass(kTint);
  for (const int panes : {1, 2, 3}) {
    hall.panes = panes;
    const glm::vec4 seen = middle(picture(scenario_of_hall(hall)));
    for (int c = 0; c < 3; ++c) {
      const double passes = std::pow(double{kTint[c]} * (1 - kStraight), panes);
      // Each blend rounds to a half.
      EXPECT_NEAR(seen[c] / passes, 1, 0.001 * (panes + 1)) << panes;
    }
  }
}

TEST_F(PanesTest, LetThroughByTheirAlpha) {
  Hall hall;
  hall.pane.blended = true;
  hall.pane.transmission = 0;
  hall.pane.opacity = 0.25f;
  const glm::vec4 seen = middle(picture(scenario_of_hall(hall)));
  EXPECT_NEAR(seen.g, 0.75 * (1 - kStraight), 0.002);
  EXPECT_NEAR(seen.a, 0.75 * (1 - kStraight), 0.002) << "what passes";
}

// What stops sight hides what is behind, though its material lets light through.
TEST_F(PanesTest, AreWallsByTheRoleOfWalls) {
  Hall hall;
  hall.pane.blended = true;
  hall.pane.transmission = 0;
  hall.pane.opacity = 0.25f;
  hall.pane.alpha_cutoff = 2;  // of a factor of 1/4
  auto scenario = scenario_of_hall(hall);
  scenario.scene.objects[1].see_through = true;
  EXPECT_GT(middle(picture(scenario)).g, 0.7f);
  scenario.scene.objects[1].role = Role::wall;
  EXPECT_EQ(middle(picture(scenario)).g, 0);
}

// A light behind a pane lights a wall before it as if there were none.
TEST_F(PanesTest, CastNoShadow) {
  Hall hall;
  hall.emission = glm::vec3(0);
  hall.light_z = 9;
  auto scenario = scenario_of_hall(hall);
  scenario.scene.materials[0].base_color = glm::vec3(0.5f);
  const float through = middle(picture(scenario)).g;
  EXPECT_GT(through, 0.002f);
  scenario.scene.objects[1].role = Role::ghost;
  scenario.scene.objects[1].see_through = false;
  scenario.scene.objects[1].world_from_mesh[3].z = 10;  // behind the eye and the light
  EXPECT_NEAR(through / middle(picture(scenario)).g, 1 - kStraight, 0.02);
}

// Glass stops smoke: it is before a pane, which then does not tint it, or behind.
TEST_F(PanesTest, SmokeIsTintedWhereItIsBehind) {
  for (const bool behind : {false, true}) {
    Hall hall;
    hall.emission = glm::vec3(0);
    hall.smoke_z = behind ? 3.0f : 8.5f;
    hall.light_z = behind ? 3.0f : 8.0f;
    const std::vector<glm::vec4> clear = picture(scenario_of_hall(hall));
    hall.pane = glass(kTint);
    const std::vector<glm::vec4> tinted = picture(scenario_of_hall(hall));
    double brightest = 0;
    for (std::size_t i = 0; i < clear.size(); ++i) {
      brightest = std::max(brightest, double{clear[i].g});
      for (int c = 0; c < 3; ++c) {
        const double expected = behind ? double{kTint[c]} : 1;
        EXPECT_NEAR(tinted[i][c], expected * double{clear[i][c]}, 0.01 * double{clear[i][c]} + 1e-5)
            << "behind: " << behind << ", pixel " << i << ", colour " << c;
      }
    }
    EXPECT_GT(brightest, 0.01) << "smoke is seen";
  }
}

// Whatever their order in the file.
TEST_F(PanesTest, ArePlacedByTheirDistance) {
  std::vector<glm::vec4> found;
  for (const bool inner_first : {false, true}) {
    Hall hall;
    hall.panes = 0;
    auto scenario = scenario_of_hall(hall);
    scene::Scene& scene = scenario.scene;
    scenario.timeline.sky.ambient = glm::vec3(1);
    for (const bool inner : {inner_first, !inner_first}) {
      const float half = inner ? 0.5f : 1.2f;
      add_box(scene.meshes.emplace_back(), glm::vec3(3, 3, 6) - half, glm::vec3(3, 3, 6) + half);
      scene::Material& film =
          scene.materials.emplace_back(glass(inner ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
      film.blended = true;
      film.transmission = 0;
      film.opacity = 0.45f;
      scene::Object box{inner ? "inner" : "outer", static_cast<std::uint32_t>(scene.meshes.size() - 1),
                        static_cast<std::uint32_t>(scene.materials.size() - 1)};
      box.role = Role::glass;
      scene.objects.push_back(box);
    }
    found.push_back(middle(picture(scenario)));
  }
  EXPECT_EQ(found[0], found[1]);
}

TEST_F(PanesTest, ReflectTheSkyThatTheyFace) {
  Hall hall;
  hall.emission = glm::vec3(0);
  auto scenario = scenario_of_hall(hall);
  scenario.timeline.sky.ambient = glm::vec3(1);
  const float seen = middle(picture(scenario)).g;
  // Between none and all of it: the hall is open but for its end.
  EXPECT_GT(seen, 0.25 * kStraight);
  EXPECT_LT(seen, 1.2 * kStraight);
}

}  // namespace
}  // namespace brume::render
