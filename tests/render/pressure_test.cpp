// Where device memory is short, smoke still hides what line of sight says it hides.
#include "smoke/sight.hpp"
#include "tests/render/fairness.hpp"
#include "tests/render/hall.hpp"

namespace brume::render {
namespace {

class PressureTest : public FairnessTest {
 protected:
  using Pixel = std::array<std::uint8_t, 4>;
  ~PressureTest() override { context().memory().set_limit(gpu::Memory::kNoLimit); }

  /// By how much a sign changes its pixels on average, 0..255.
  static double of_sign(const Shot& with, const std::vector<Pixel>& without, const Pair& pair) {
    const float z = glm::length(pair.eye - pair.target);
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < without.size(); ++i) {
      if (std::abs(0.05f / with.depth[i] - z) > 0.05f) continue;
      for (std::size_t c = 0; c < 3; ++c) sum += (with.display[i][c] - without[i][c]) / 3.0;
      ++count;
    }
    return count > 0 ? std::abs(sum) / count : 0;
  }
};

TEST_F(PressureTest, SmokeHidesTheSameWhateverMemoryThereIs) {
  // Line of sight knows no noise.
  const scenario::Scenario scenario = hall({.voxels_per_metre = 8, .extinction = 3, .erosion = 0});
  const auto simulation = scenario::Simulation::create(scenario).value_or_throw();
  simulation->advance_to(kSeconds);
  std::vector<shared::Hole> holes;
  const FrameInput input = frame_input(scenario, *simulation, kSeconds, holes);
  const smoke::Sight sight(simulation->volume(), simulation->world().grid(), input.smoke.holes,
                           input.smoke.time, {.extinction = input.smoke.look.extinction});
  gpu::Memory& memory = context().memory();
  const VkDeviceSize before = memory.device_bytes();
  Eye eye(context(), runner(), scenario, *simulation);
  const auto pairs = random_pairs(scenario, {-5.8f, 0.3f, -5.8f}, {5.8f, 3.5f, 5.8f}, 12, 200);
  eye.look(pairs.front(), 1);
  const VkDeviceSize needed = memory.device_bytes();
  std::mt19937 random(3);
  std::array<int, planning::ResidentSmoke::kMostLevel + 1> at_level{};
  int hidden = 0, shown = 0;
  double most = -1e9;
  for (const Pair& pair : pairs) {
    // From nothing at all to more than is needed.
    const double part = std::uniform_real_distribution<double>(0, 1.3)(random);
    memory.set_limit(before + static_cast<VkDeviceSize>(part * static_cast<double>(needed - before)));
    Shot seen = shot(eye, pair, 1);
    ++at_level[static_cast<std::size_t>(eye.renderer().smoke_level())];
    // Of the sign's radiance, 4, less than 4 exp(-9) passes: 1.6 steps of a display where it is darkest,
    // which is where its curve is steepest.
    float depth = 1e9f;
    for (int i = 0; i < 25; ++i) {
      const glm::vec2 at = glm::vec2(i % 5, i / 5) / 4.0f - 0.5f;
      const glm::vec3 point(sign_of(pair) * glm::vec4(at, 0, 1));
      depth = std::min(depth, sight.optical_depth(pair.eye, point).value_or_throw());
    }
    shown += contrast(seen, seen.depth, pair) > 8;
    if (depth < 9) continue;
    ++hidden;
    // Without the sign, between two equal pictures with it: what the device holds, and with it the light in
    // the smoke, may still follow the limit.
    std::vector<Pixel> without;
    bool is_steady = false;
    for (int tries = 0; !is_steady && tries < 6; ++tries) {
      without = read_back<Pixel>(eye.look_past().targets().display);
      Shot again = shot(eye, pair, 1);
      is_steady = again.display == seen.display;
      seen = std::move(again);
    }
    EXPECT_TRUE(is_steady);
    const double difference = of_sign(seen, without, pair);
    most = std::max(most, difference);
    EXPECT_LT(difference, 2) << "at an optical depth of " << depth;
  }
  std::printf("%d hidden, at most %.2f of their signs; %d shown; levels %d %d %d %d\n", hidden, most, shown,
              at_level[0], at_level[1], at_level[2], at_level[3]);
  EXPECT_GT(hidden, 20);
  EXPECT_GT(shown, 20);
  EXPECT_GT(at_level[0], 10);
  EXPECT_GT(at_level[1] + at_level[2] + at_level[3], 10);
}

}  // namespace
}  // namespace brume::render
