// Objects that move with carriers, and decals in whole frames.
#include <glm/gtc/matrix_transform.hpp>

#include "tests/render/volume_fixture.hpp"

namespace brume::render {
namespace {

/// Two plates, of which the right one also emits, under a light, and a cube that a carrier moves.
class DecalFramesTest : public VolumeFixture {
 protected:
  static constexpr glm::uvec2 kSize{64, 36};
  static constexpr float kEmission = 0.25f;
  static constexpr double kEdge = 1;  ///< Of the cube.

  static scene::Scene plates(bool with_cube) {
    scene::Scene scene;
    scene.materials.resize(2);
    add_boxes(scene, "left", {{{-6, -0.3f, -6}, {0, 0, 6}}});
    add_boxes(scene, "right", {{{0, -0.3f, -6}, {6, 0, 6}}}, 1);
    if (with_cube)
      add_boxes(scene, "cube", {{glm::vec3(-0.5f), glm::vec3(0.5f)}}).world_from_mesh =
          glm::translate(glm::mat4(1), glm::vec3(-2.5f, 1.2f, 0.5f));
    for (scene::Material& material : scene.materials) material.base_color = glm::vec3(0.5f);
    scene.materials[1].emission = glm::vec3(kEmission);
    scene.lights = {scene_light({0.3f, 4.5f, 0.2f}, glm::vec3(20))};
    scene.camera = {{0, 4, 8}, {0, 0.4f, 0}, 0.8f};
    return scene;
  }
  static scenario::Scenario make_scenario(scene::Scene scene, bool with_carrier) {
    scene::Timeline timeline;
    timeline.smoke.voxels = 100;
    timeline.sky = {glm::vec3(0.1f), glm::vec3(0.1f), glm::vec3(0.2f), 0};
    if (with_carrier)
      timeline.carriers = {
          {"drone", "cube", {{0, {1.5f, 1, 0}, {20, 40, 10}}, {2, {1.5f, 1, 2}, {0, 0, 90}}}}};
    scene::exclude_moved_objects(timeline.carriers, scene);
    return scenario_of(std::move(scene), std::move(timeline), {{48, 20, 48}, 0.25f, {-6, -0.6f, -6}});
  }
  /// A decal of one value in a box of 4 x 2 x 4 m around its carrier.
  static void add_decal(scenario::Scenario& scenario, float value) {
    scene::DecalOptions decal;
    decal.carrier = "drone";
    decal.fade = decal.scatter = 0;
    scenario.timeline.decals = {decal};
    grids::DenseGrid grid;
    grid.size = glm::uvec3(2);
    grid.box = {glm::dvec3(-2.5, -2, -2.5), glm::dvec3(2.5, 2, 2.5)};
    grid.values.assign(8, value);
    scenario.slices.volumes =
        std::make_shared<const grids::DenseVolumes>(1, std::make_shared<const grids::DenseVolume>(2, grid));
    scenario.slices.of_decals = {scenario::SliceVolume()};
  }

  struct Frame {
    std::vector<glm::vec4> radiance, media, occlusion;
    std::vector<float> depth;
    std::vector<bool> moves;
    shared::Camera camera;

    glm::dvec3 ray(std::size_t i) const {
      const glm::dvec2 ndc = (glm::dvec2(i % kSize.x, i / kSize.x) + 0.5) / glm::dvec2(kSize) * 2.0 - 1.0;
      return glm::dvec3(camera.forward) + ndc.x * glm::dvec3(camera.right) - ndc.y * glm::dvec3(camera.up);
    }
    glm::dvec3 p_world(std::size_t i) const {
      return glm::dvec3(camera.eye_world) + double{camera.near_z} / double{depth[i]} * ray(i);
    }
  };
  static std::vector<glm::vec4> texels_of(const gpu::Image& image) {
    return passes::from_half(read_back<passes::Half4>(image));
  }
  /// A frame of the scenario, with one volume more where there is one.
  Frame draw(const scenario::Scenario& scenario, double seconds,
             const std::optional<planning::VolumeInput>& volume = std::nullopt) {
    Renderer renderer(context(), runner(), scenario.scene, RendererOptions{kSize});
    const auto simulation = scenario::Simulation::create(scenario).value_or_throw();
    simulation->advance_to(seconds);
    std::vector<shared::Hole> holes;
    FrameInput input = frame_input(scenario, *simulation, seconds, holes);
    if (volume) input.volumes.push_back(*volume);
    renderer.draw(input);
    Frame frame;
    frame.camera = planning::FramePlan(input, kSize).camera;
    frame.radiance = texels_of(renderer.targets().radiance);
    frame.media = texels_of(renderer.media());
    if (renderer.occlusion()) frame.occlusion = texels_of(*renderer.occlusion());
    frame.depth = read_back<float>(renderer.targets().gbuffer.depth);
    // Without a surface there is no normal.
    for (const glm::vec4& texel : texels_of(renderer.targets().gbuffer.normal_metallic))
      frame.moves.push_back(frame.depth[frame.moves.size()] > 0 && shared::moves_of(texel.a));
    return frame;
  }

  /// Whether a ray meets a cube.
  static bool meets(const glm::dmat4& world_from_mesh, double edge, glm::dvec3 eye, glm::dvec3 ray) {
    const glm::dmat4 inverse = glm::inverse(world_from_mesh);
    const glm::dvec3 from(inverse * glm::dvec4(eye, 1)), along(inverse * glm::dvec4(ray, 0));
    double enter = 0, leave = 1e30;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (-edge / 2 - from[axis]) / along[axis], b = (edge / 2 - from[axis]) / along[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    return enter < leave;
  }
  static void expect_cube_at(const Frame& frame, const glm::dmat4& world_from_mesh) {
    // Its corners are off by what the device snaps them by, in pixels of 10 m / 36, and by rounding.
    const double off = 1e-3 + snapping_px() * 10 / 36;
    int hits = 0;
    for (std::size_t i = 0; i < frame.depth.size(); ++i) {
      const glm::dvec3 eye(frame.camera.eye_world);
      if (meets(world_from_mesh, kEdge - 2 * off, eye, frame.ray(i))) {
        EXPECT_TRUE(frame.moves[i]) << i;
        const glm::dvec3 p =
            glm::abs(glm::dvec3(glm::inverse(world_from_mesh) * glm::dvec4(frame.p_world(i), 1)));
        EXPECT_NEAR(std::max({p.x, p.y, p.z}), kEdge / 2, off) << i;
        ++hits;
      } else if (!meets(world_from_mesh, kEdge + 2 * off, eye, frame.ray(i))) {
        EXPECT_FALSE(frame.moves[i]) << i;
      }
    }
    EXPECT_GT(hits, 20);
  }
  /// Frames are equal to the last bit where nothing moves in the first.
  static void expect_equal_beside_the_cube(const Frame& frame, const Frame& without) {
    for (std::size_t i = 0; i < frame.depth.size(); ++i) {
      if (frame.moves[i]) continue;
      EXPECT_EQ(frame.depth[i], without.depth[i]) << i;
      EXPECT_EQ(frame.radiance[i], without.radiance[i]) << i;
    }
  }
};

TEST_F(DecalFramesTest, AMovedObjectIsWhereItsCarrierIsAndNowhereElse) {
  const scenario::Scenario scenario = make_scenario(plates(true), true);
  const scenario::Scenario without = make_scenario(plates(false), false);
  const Frame empty = draw(without, 0);
  for (const double seconds : {0.0, 1.0, 2.0}) {
    const Frame frame = draw(scenario, seconds);
    expect_cube_at(frame, glm::dmat4(scene::pose_at(scenario.timeline.carriers[0], seconds)));
    // Neither the cube nor its shadow is where the scene has it, and it casts none where it is now.
    expect_equal_beside_the_cube(frame, empty);
  }
  // What no carrier moves has a shadow.
  const Frame unmoved = draw(make_scenario(plates(true), false), 0);
  int darker = 0;
  for (std::size_t i = 0; i < empty.depth.size(); ++i) {
    EXPECT_FALSE(unmoved.moves[i]);
    darker += unmoved.depth[i] == empty.depth[i] && unmoved.radiance[i].x < 0.5f * empty.radiance[i].x;
  }
  EXPECT_GT(darker, 10);
}

TEST_F(DecalFramesTest, AMovedObjectHidesWithADoor) {
  scenario::Scenario scenario = make_scenario(plates(true), true);
  scenario.timeline.doors = {{1.0, "cube", true, ""}, {2.0, "cube", false, ""}};
  const Frame empty = draw(make_scenario(plates(false), false), 0);
  const Frame open = draw(scenario, 1.5), shut = draw(scenario, 2.5);
  expect_equal_beside_the_cube(open, empty);
  EXPECT_EQ(std::count(open.moves.begin(), open.moves.end(), true), 0);
  EXPECT_GT(std::count(shut.moves.begin(), shut.moves.end(), true), 20);
}

// Radiance is (emitted + reflected) T + media. Half floats store radiance before, after, media and emission,
// each off by 2^-11 of its value.
TEST_F(DecalFramesTest, DecalsDarkenWhatIsReflectedAlsoBehindAMedium) {
  scenario::Scenario scenario = make_scenario(plates(true), true);
  const scenario::Scenario plain = make_scenario(plates(true), true);
  add_decal(scenario, 0.75f);
  const volume::SparseVolume cloud = block(glm::ivec3(2));
  planning::VolumeInput medium{&cloud, glm::mat4(1), {}, {}};
  medium.world_from_voxel = glm::translate(glm::mat4(1), glm::vec3(-1, 0.5f, 2)) *
                            glm::scale(glm::mat4(1), glm::vec3(2.5f, 1.5f, 1) / 16.0f);
  medium.look = {glm::vec3(0.5f), 0.9f, glm::vec3(0.02f), 0, 0};
  for (const bool has_medium : {false, true}) {
    const auto volume = has_medium ? std::optional(medium) : std::nullopt;
    const Frame before = draw(plain, 0, volume), after = draw(scenario, 0, volume);
    EXPECT_TRUE(before.occlusion.empty());
    ASSERT_EQ(after.occlusion.size(), after.depth.size());
    int emitting = 0, reflecting = 0, dimmed = 0;
    for (std::size_t i = 0; i < after.depth.size(); ++i) {
      EXPECT_EQ(after.media[i], before.media[i]) << i;
      const double occlusion{after.occlusion[i].x};
      if (after.moves[i] || after.depth[i] == 0) {
        EXPECT_EQ(after.radiance[i], before.radiance[i]) << i;
        EXPECT_EQ(occlusion, 0) << i;
        continue;
      }
      const bool emits = after.p_world(i).x > 0;
      const double transmittance{after.media[i].a}, emitted = emits ? kEmission * transmittance : 0.0;
      const double media{after.media[i].x}, radiance{before.radiance[i].x};
      const double expected = media + emitted + (radiance - media - emitted) * (1 - occlusion);
      const double bound = std::ldexp(2 * radiance + media + emitted, -11) + 1e-6;
      EXPECT_NEAR(double{after.radiance[i].x}, expected, bound) << i;
      if (occlusion < 0.1) continue;
      EXPECT_NEAR(occlusion, 0.75, 1.0 / 1024);
      (emits ? emitting : reflecting) += 1;
      dimmed += transmittance < 0.8;
    }
    EXPECT_GT(emitting, 100);
    EXPECT_GT(reflecting, 20);
    EXPECT_EQ(dimmed > 20, has_medium);
  }
}

}  // namespace
}  // namespace brume::render
