// Light in smoke that is kept from frame to frame is the light that would be made anew, bit for bit.
#include <set>

#include "render/playback.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/render/boxes.hpp"

namespace brume::render {
namespace {

/// A floor, a wall with a door between two smokes, lamps around, one of them a spot, and a sun. Noise 0: the
/// smokes hold still once they have grown. A shot goes through the left one alone.
stage::Stage two_smokes(float noise) {
  scene::Scene scene;
  scene.meshes.resize(3);
  add_box(scene.meshes[0], {-12, -0.3f, -6}, {12, -0.1f, 6});
  add_box(scene.meshes[0], {-0.1f, -0.1f, -6}, {0.1f, 3, -1});
  add_box(scene.meshes[0], {-0.1f, -0.1f, 1}, {0.1f, 3, 6});
  add_box(scene.meshes[1], glm::vec3(-0.2f), glm::vec3(0.2f));
  add_box(scene.meshes[2], {-0.1f, -0.1f, -1}, {0.1f, 3, 1});
  scene.materials.resize(1);
  scene.objects.push_back({"ground", 0, 0, glm::mat4(1), true});
  scene.objects.push_back({"door", 2, 0, glm::mat4(1), true});
  scene.grenade = {"grenade", 1, 0, glm::mat4(1), false};
  for (const glm::vec3 place :
       {glm::vec3(-9, 2, 3), glm::vec3(-3, 1, -3), glm::vec3(8, 2, 2), glm::vec3(3, 2, -2)}) {
    scene::Light lamp;
    lamp.position_world = place;
    lamp.intensity = glm::vec3(1.5f);
    scene.lights.push_back(lamp);
  }
  scene.lights[1].kind = scene::LightKind::spot;
  scene.lights[1].direction_world = glm::normalize(glm::vec3(-1, 0, 1));
  scene::Light sun;
  sun.kind = scene::LightKind::directional;
  sun.direction_world = glm::normalize(glm::vec3(0.4f, -1, -0.5f));
  sun.intensity = glm::vec3(0.3f);
  scene.lights.push_back(sun);

  scene::Timeline timeline;
  timeline.sky = {glm::vec3(0.1f), glm::vec3(0.2f), glm::vec3(0.1f), 0};
  timeline.smoke.voxels = 120;
  timeline.smoke.noise = noise;
  timeline.smokes = {{0, {-6, 1, 0}, {-6, 0.2f, 0}}, {3, {6, 1, 0}, {6, 0.2f, 0}}};
  timeline.shots = {{5, {-10, 1, 0.3f}, {-2, 1, 0.3f}, 0.3f, {0.1f, 0.1f, 2.0f, 0.3f}}};
  timeline.doors = {{9, "door", true, ""}};
  const voxel::GridFrame frame{{50, 12, 26}, 0.5f, {-12.4f, -0.6f, -6.4f}};
  auto voxels = stage::load_or_voxelize(scene, frame, {}).value_or_throw();
  return {std::move(timeline), std::move(scene), {{0, 3, 11}, {0, 0.5f, 0}, 1.2f}, std::move(voxels)};
}

class KeptLightTest : public gpu::GpuTest {
 protected:
  static constexpr glm::uvec2 kSize{80, 45};

  void begin(float noise) {
    stage_.emplace(two_smokes(noise));
    simulation_ = stage::Simulation::create(*stage_).value_or_throw();
    RendererOptions options;
    options.size_px = kSize;
    kept_.emplace(context(), runner(), stage_->scene, options);
    anew_.emplace(context(), runner(), stage_->scene, options);
    camera_ = stage_->camera;
  }

  /// What a frame asked for.
  struct Work {
    std::size_t rays = 0, bricks = 0;          // blocks of rays followed, bricks put together
    std::size_t all_rays = 0, all_bricks = 0;  // of the frame made anew
  };
  /// Draws a moment by both, which must be equal.
  Work draw(double seconds) {
    simulation_->advance_to(seconds);
    FrameInput input = frame_input(*stage_, *simulation_, seconds, holes_);
    input.camera = camera_;
    if (flash_ > 0) {
      shared::Light light{};
      light.kind = shared::kLightPoint;
      light.position_world = {9, 1.5f, 1};
      light.intensity = glm::vec3(flash_);
      light.range = shared::light_range(flash_);
      light.shadow_layer = shared::kShadowByVoxels;
      input.flashes = {light};
    }
    const auto smoke_of = [&](Renderer& renderer) {
      renderer.prepare(input);
      runner().run([&](gpu::Recorder& recorder) { renderer.record_frame(recorder, input); });
      return read_back<std::uint64_t>(renderer.smoke());
    };
    const auto kept = smoke_of(*kept_);
    input.force_light = true;
    const auto anew = smoke_of(*anew_);
    EXPECT_GT(std::set<std::uint64_t>(anew.begin(), anew.end()).size(), 60u) << "smoke is in view";
    EXPECT_EQ(kept, anew) << "at " << seconds;
    return {kept_->light_plan().pairs.size(), kept_->light_plan().bricks.size(),
            anew_->light_plan().pairs.size(), anew_->light_plan().bricks.size()};
  }

  std::optional<stage::Stage> stage_;
  std::unique_ptr<stage::Simulation> simulation_;
  std::optional<Renderer> kept_, anew_;
  std::vector<shared::Hole> holes_;
  scene::Camera camera_;
  float flash_ = 0;
};

TEST_F(KeptLightTest, IsThatMadeAnewWhateverHappens) {
  begin(0);
  Work work = draw(2);
  EXPECT_EQ(work.rays, work.all_rays);
  EXPECT_GT(work.rays, 40u);
  // Nothing happens.
  work = draw(2.25);
  EXPECT_EQ(work.rays + work.bricks, 0u);
  // The eye moves: light is scattered to another place.
  camera_.position_world.x += 0.5f;
  work = draw(2.25);
  EXPECT_EQ(work.rays, 0u);
  EXPECT_EQ(work.bricks, work.all_bricks);
  // A second smoke comes, behind the wall and out of the way.
  draw(3.1);
  work = draw(3.5);
  EXPECT_GT(work.rays, 0u);
  work = draw(4.9);
  EXPECT_EQ(draw(4.95).rays, 0u);
  // A hole opens, with a flash, is open, and closes: rays that do not cross it stay.
  EXPECT_GT(draw(5.01).rays, 0u);
  work = draw(5.15);
  EXPECT_GT(work.rays, 0u);
  EXPECT_LT(work.rays, work.all_rays);
  draw(5.4);
  work = draw(6.5);
  EXPECT_EQ(work.rays + work.bricks, 0u);
  draw(7.3);
  draw(7.8);
  work = draw(8.5);
  // A lamp comes, dims and brightens.
  flash_ = 2;
  work = draw(8.5);
  EXPECT_GT(work.rays, 0u);
  EXPECT_LT(work.rays, work.all_rays / 4);
  flash_ = 1;
  work = draw(8.6);
  EXPECT_EQ(work.rays, 0u);
  EXPECT_GT(work.bricks, 0u);
  EXPECT_LT(work.bricks, work.all_bricks);
  flash_ = 3;
  EXPECT_GT(draw(8.6).rays, 0u);
  flash_ = 0;
  EXPECT_EQ(draw(8.7).rays, 0u);
  // A door opens: every lamp may shine on.
  work = draw(9.1);
  EXPECT_EQ(work.rays, work.all_rays);
  // Eyes that turn away and back, and time that runs back.
  camera_.target_world = {-12, 0.5f, 0};
  draw(9.2);
  camera_.target_world = {12, 0.5f, 0};
  draw(9.2);
  camera_.target_world = {0, 0.5f, 0};
  draw(9.2);
  work = draw(5.3);
  draw(2);
}

TEST_F(KeptLightTest, WhereNoiseDriftsOnlyAMomentKeepsItsLight) {
  begin(0.5f);
  Work work = draw(2);
  EXPECT_EQ(work.rays, work.all_rays);
  camera_.position_world.y += 0.5f;
  work = draw(2);
  EXPECT_EQ(work.rays, 0u);
  EXPECT_EQ(work.bricks, work.all_bricks);
  work = draw(2.05);
  EXPECT_EQ(work.rays, work.all_rays);
}

}  // namespace
}  // namespace brume::render
