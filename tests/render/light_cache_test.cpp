// Light in smoke that is cached from frame to frame equals light that is rebuilt, bit for bit.
#include <cmath>
#include <random>
#include <set>

#include "film/playback.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/render/two_smokes.hpp"
#include "tests/worlds.hpp"

namespace brume::render {
namespace {

class LightCacheTest : public gpu::GpuTest {
 protected:
  static constexpr glm::uvec2 kSize{80, 45};

  void begin(float noise) {
    scenario_.emplace(two_smokes(noise));
    simulation_ = scenario::Simulation::create(*scenario_).value_or_throw();
    RendererOptions options;
    options.size_px = kSize;
    cached_.emplace(context(), runner(), scenario_->scene, options);
    rebuilt_.emplace(context(), runner(), scenario_->scene, options);
    camera_ = scenario_->camera;
  }

  /// The work of a frame.
  struct Work {
    std::size_t rays = 0, bricks = 0;          // pages of rays followed, bricks gathered
    std::size_t all_rays = 0, all_bricks = 0;  // of the rebuilt frame
  };
  FrameInput input_at(double seconds) {
    simulation_->advance_to(seconds);
    FrameInput input = frame_input(*scenario_, *simulation_, seconds, holes_);
    input.view.camera = camera_;
    if (flash_ > 0)
      input.environment.flashes = {point_light({9, 1.5f, 1}, glm::vec3(flash_), shared::kShadowByVoxels)};
    return input;
  }
  static std::vector<std::uint64_t> smoke_of(Renderer& renderer, const FrameInput& input) {
    renderer.draw(input);
    return read_back<std::uint64_t>(renderer.media());
  }
  /// Draws a time by both, which must be equal.
  Work draw(double seconds) {
    FrameInput input = input_at(seconds);
    const auto cached = smoke_of(*cached_, input);
    input.quality.rebuild_light = true;
    const auto rebuilt = smoke_of(*rebuilt_, input);
    EXPECT_GT(std::set<std::uint64_t>(rebuilt.begin(), rebuilt.end()).size(), 60u) << "smoke is in view";
    EXPECT_EQ(cached, rebuilt) << "at " << seconds;
    return {cached_->light_plan().shadow_rays.size(), cached_->light_plan().gathers.size(),
            rebuilt_->light_plan().shadow_rays.size(), rebuilt_->light_plan().gathers.size()};
  }

  std::optional<scenario::Scenario> scenario_;
  std::unique_ptr<scenario::Simulation> simulation_;
  std::optional<Renderer> cached_, rebuilt_;
  std::vector<shared::Hole> holes_;
  scene::Camera camera_;
  float flash_ = 0;
};

TEST_F(LightCacheTest, IsTheRebuiltLightWhateverHappens) {
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
  // A light comes, dims and brightens.
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
  // A door opens: every light may shine on.
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

TEST_F(LightCacheTest, WhereNoiseMovesItHoldsOnlyWhileTimeStandsStill) {
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

/// Slices of a time, as a player sees them, and then all of it, as a screenshot shows it: the slices followed
/// rays through noise that was late in part.
TEST_F(LightCacheTest, AllOfATimeIsTheRebuiltOneHoweverItWasSliced) {
  begin(0.5f);
  std::minstd_rand random(1);
  const auto uniform = [&](float low, float high) {
    return low + (high - low) * static_cast<float>(random() % 1024) / 1023;
  };
  double seconds = 2;
  for (int round = 0; round < 24; ++round) {
    for (auto frames = random() % 4; frames-- > 0;) {
      seconds += random() % 4 == 0 ? 0 : uniform(0.01f, 0.1f);
      if (random() % 2 == 0)
        camera_.position_world += glm::vec3(uniform(-0.2f, 0.2f), uniform(-0.1f, 0.1f), 0);
      if (random() % 8 == 0) camera_.target_world.x = uniform(-6, 6);
      flash_ = random() % 4 == 0 ? uniform(1, 3) : 0;
      FrameInput input = input_at(seconds);
      input.quality.light_update_fraction = random() % 2 == 0 ? 0.125f : 0.25f;
      cached_->draw(input);
    }
    draw(seconds);
    EXPECT_EQ(read_back<std::uint64_t>(cached_->targets().radiance),
              read_back<std::uint64_t>(rebuilt_->targets().radiance))
        << "round " << round << " at " << seconds;
    if (round % 8 == 7) seconds += 2;
  }
}

/// Draws with an update fraction, by two renderers. In one of them all light glares before its first frame.
class SlicedLightTest : public LightCacheTest {
 protected:
  /// The smoke; expects that nothing glares.
  std::vector<std::uint64_t> draw_fraction(double seconds, float fraction) {
    FrameInput input = input_at(seconds);
    input.quality.light_update_fraction = fraction;
    const FramePlan plan = rebuilt_->plan(input);
    const gpu::Image& light = rebuilt_->smoke().resources().inscatter;
    const glm::uvec3 size = light.info().size;
    if (size != lit_size_) {
      const std::vector<std::uint16_t> glare(std::size_t{4} * size.x * size.y * size.z, 0x7bff);  // 65,504
      const gpu::Recorder::Region all{std::as_bytes(std::span(glare)), glm::ivec3(0), size};
      runner().run([&](gpu::Recorder& recorder) { recorder.upload(light, {&all, 1}); });
      lit_size_ = size;
    }
    runner().run([&](gpu::Recorder& recorder) { rebuilt_->record_frame(recorder, plan); });
    const auto smoke = smoke_of(*cached_, input);
    EXPECT_EQ(read_back<std::uint64_t>(rebuilt_->media()), smoke)
        << "light that was never computed, at " << seconds;
    return smoke;
  }
  void expect_fraction(float fraction);

  glm::uvec3 lit_size_{0};
};

/// Whatever happens no texel without light is visible, and a time that is drawn again gets its light.
void SlicedLightTest::expect_fraction(float fraction) {
  const auto still = [&](double seconds) {
    const int frames = static_cast<int>(std::ceil(1 / fraction)) + 1;
    std::vector<std::uint64_t> smoke;
    for (int i = 0; i < frames; ++i) smoke = draw_fraction(seconds, fraction);
    draw_fraction(seconds, fraction);
    EXPECT_TRUE(cached_->light_plan().parts.empty());
    Renderer fresh(context(), runner(), scenario_->scene, {kSize});
    EXPECT_EQ(smoke, smoke_of(fresh, input_at(seconds))) << "at " << seconds;
    EXPECT_EQ(read_back<std::uint64_t>(cached_->targets().radiance),
              read_back<std::uint64_t>(fresh.targets().radiance))
        << "shadows on surfaces, at " << seconds;
  };
  // It grows, another comes, the eye walks.
  for (const double seconds : {0.5, 0.6, 0.7, 2.0, 3.1, 3.3, 3.5}) {
    camera_.position_world.x += 0.1f;
    draw_fraction(seconds, fraction);
  }
  still(4.9);
  // A shot, its flash and its hole.
  for (const double seconds : {5.01, 5.1, 5.2}) draw_fraction(seconds, fraction);
  still(6.5);
  // Eyes that turn away and back, a light that comes and goes, a door.
  camera_.target_world = {-12, 0.5f, 0};
  draw_fraction(7.3, fraction);
  flash_ = 2;
  draw_fraction(7.6, fraction);
  camera_.target_world = {0, 0.5f, 0};
  draw_fraction(7.7, fraction);
  flash_ = 0;
  draw_fraction(9.1, fraction);
  still(9.2);
}

TEST_F(SlicedLightTest, IsNeverUnlitAndComesToRestAsAllOfIt) {
  begin(0.5f);
  expect_fraction(0.25f);
}

TEST_F(SlicedLightTest, WithoutNoiseToo) {
  begin(0);
  expect_fraction(0.5f);
}

TEST_F(SlicedLightTest, AllOfItAfterAFractionIsAllOfIt) {
  begin(0.5f);
  draw_fraction(2, 0.125f);
  draw_fraction(2.1, 0.125f);
  draw(2.2);
  draw_fraction(2.3, 0.25f);
  draw(2.3);
  EXPECT_EQ(read_back<std::uint64_t>(cached_->targets().radiance),
            read_back<std::uint64_t>(rebuilt_->targets().radiance));
}

}  // namespace
}  // namespace brume::render
