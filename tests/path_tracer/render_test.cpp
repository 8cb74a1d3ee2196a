// Pictures: the same for any number of threads, and after any interruption.
#include "reference/render.hpp"

#include <atomic>
#include <filesystem>

#include "core/file.hpp"
#include "core/tasks.hpp"
#include "planning/device_camera.hpp"
#include "tests/path_tracer/box_medium.hpp"
#include "tests/path_tracer/statistics.hpp"

namespace brume::reference {
namespace {

bool never() {
  return false;
}

class RenderTest : public testing::Test {
 protected:
  RenderTest() {
    BoxMedium::Matter matter{[](const glm::vec3& p) { return 1 + std::sin(5 * p.x); }, 2,
                             glm::vec3(0.9f, 0.7f, 0.5f)};
    scene_ = scene_of(nothing_,
                      media_of(std::make_unique<BoxMedium>(Box<float>{glm::vec3(-1), glm::vec3(1)}, matter,
                                                           shared::phase_of_hg(0.3f), glm::ivec3(4))));
    scene_->environment = uniform_sky(0.5f);
    shared::Light sun{};
    sun.kind = shared::kLightDirectional;
    sun.direction = {0, -1, 0};
    sun.intensity = glm::vec3(2);
    scene_->lights = {sun};
    settings_.size_px = {37, 21};
    settings_.eyes = {{planning::device_camera({{2, 1, 3}, {0, 0, 0}, 0.8f}, settings_.size_px)}};
    settings_.samples = 12;
  }
  ~RenderTest() override {
    set_thread_count(0);
    std::filesystem::remove(file_);
  }
  std::vector<image::Layer> rendered() const {
    Render render(*scene_, settings_);
    while (!render.advance(10, never)) {
    }
    return render.layers().layers;
  }
  static void expect_equal(const std::vector<image::Layer>& a, const std::vector<image::Layer>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].values, b[i].values) << a[i].name;
  }

  const scene::Scene nothing_;
  std::unique_ptr<Scene> scene_;
  RenderSettings settings_;
  const std::filesystem::path file_ =
      std::filesystem::temp_directory_path() / ("brume_render_test_" + std::to_string(::getpid()));
};

TEST_F(RenderTest, IsTheSameForAnyNumberOfThreads) {
  set_thread_count(1);
  const auto one = rendered();
  for (const unsigned threads : {2u, 7u}) {
    set_thread_count(threads);
    expect_equal(rendered(), one);
  }
}

TEST_F(RenderTest, GoesOnBitByBitFromACheckpoint) {
  const auto whole = rendered();
  for (int stop = 1; stop < 14; ++stop) {
    Render before(*scene_, settings_);
    // Stops in the midst of a pass, at another tile each time.
    std::atomic<int> tiles = 0;
    before.advance(0, [&] { return ++tiles > stop; });
    before.advance(0, never);
    ASSERT_TRUE(before.save(file_, 7));
    Render after(*scene_, settings_);
    ASSERT_TRUE(after.load(file_, 7));
    while (!after.advance(10, never)) {
    }
    expect_equal(after.layers().layers, whole);
  }
}

// Paths in a medium of a huge majorant take for ever.
TEST_F(RenderTest, EndsWithinAPathAndGoesOnBitByBit) {
  std::atomic<int> paths{0}, stops{0};
  std::atomic<bool> stopped{false};
  Render render(
      [&](const Ray& ray, Sampler& sampler) {
        if (++paths % 3000 == 0) {
          stopped = true;
          while (true) sampler.random();
        }
        return trace_path(*scene_, ray, settings_.limits, sampler);
      },
      settings_);
  EXPECT_EQ(render.without_samples(), 1);
  for (bool done = false; !done; stops += done ? 0 : 1) {
    stopped = false;
    done = render.advance(1e9, [&] { return stopped.load(); });
  }
  EXPECT_GE(stops, 3);
  EXPECT_EQ(render.without_samples(), 0);
  expect_equal(render.layers().layers, rendered());
}

TEST_F(RenderTest, MoreSamplesGoOnFromACheckpoint) {
  Render few(*scene_, settings_);
  while (!few.advance(10, never)) {
  }
  ASSERT_TRUE(few.save(file_, 7));
  settings_.samples = 20;
  const auto whole = rendered();
  Render more(*scene_, settings_);
  ASSERT_TRUE(more.load(file_, 7));
  EXPECT_EQ(more.samples(), 12);
  while (!more.advance(10, never)) {
  }
  expect_equal(more.layers().layers, whole);
}

TEST_F(RenderTest, RefusesCheckpointsOfOtherPicturesAndDamagedOnes) {
  Render render(*scene_, settings_);
  render.advance(0, never);
  ASSERT_TRUE(render.save(file_, 7));
  EXPECT_FALSE(Render(*scene_, settings_).load(file_, 8));
  RenderSettings other = settings_;
  other.size_px.x = 36;
  EXPECT_FALSE(Render(*scene_, other).load(file_, 7));
  other = settings_;
  other.limits.max_bounces = 3;
  EXPECT_FALSE(Render(*scene_, other).load(file_, 7));
  const std::vector<std::byte> bytes = read_file(file_).value_or_throw();
  for (const std::size_t length : {std::size_t{0}, std::size_t{5}, std::size_t{40}, bytes.size() - 1}) {
    std::filesystem::resize_file(file_, length);
    EXPECT_FALSE(Render(*scene_, settings_).load(file_, 7)) << length;
    ASSERT_TRUE(render.save(file_, 7));
  }
  for (std::size_t at = 0; at < bytes.size(); at += 997) {
    std::vector<std::byte> changed = bytes;
    changed[at] ^= std::byte{1};
    ASSERT_TRUE(write_file_atomic(file_, changed));
    EXPECT_FALSE(Render(*scene_, settings_).load(file_, 7)) << at;
  }
}

TEST_F(RenderTest, TilesEndAtTheirError) {
  settings_.samples = 0;
  settings_.noise = 0.02f;
  Render render(*scene_, settings_);
  while (!render.advance(10, never)) {
  }
  EXPECT_LE(render.error(), 0.02);
  EXPECT_GT(render.samples(), 16);
  // The error that it states is that of its pixels: against a picture of many samples.
  const std::vector<glm::vec4> rough = render.radiance();
  settings_.noise = 0;
  settings_.samples = 2048 / kFewer;
  Render exact(*scene_, settings_);
  while (!exact.advance(10, never)) {
  }
  const std::vector<glm::vec4> fine = exact.radiance();
  double off = 0, sum = 0;
  for (std::size_t i = 0; i < rough.size(); ++i) {
    off += std::pow(double{rough[i].g - fine[i].g}, 2);
    sum += double{fine[i].g};
  }
  EXPECT_LT(std::sqrt(off / static_cast<double>(rough.size())) / (sum / static_cast<double>(rough.size())),
            0.025);
}

TEST_F(RenderTest, LayersAddUp) {
  const auto layers = rendered();
  const auto values = [&](const std::string& name) -> const std::vector<float>& {
    for (const image::Layer& layer : layers)
      if (layer.name == name) return std::get<std::vector<float>>(layer.values);
    throw std::out_of_range(name);
  };
  for (std::size_t i = 0; i < values("R").size(); ++i) {
    // Nothing emits, and the sky that paths saw at once is behind.
    EXPECT_NEAR(values("R")[i], values("single.R")[i] + values("multiple.R")[i], 1e-5f);
    EXPECT_NEAR(values("background.R")[i], 0.5f * values("transmittance.V")[i], 1e-5f);
    EXPECT_NEAR(values("A")[i], 1 - values("transmittance.V")[i], 1e-6f);
    EXPECT_EQ(values("samples.V")[i], 12);
    EXPECT_TRUE(std::isinf(values("Z")[i]));
  }
}

}  // namespace
}  // namespace brume::reference
