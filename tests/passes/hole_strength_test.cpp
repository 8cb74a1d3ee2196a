#include "brume_test_shaders.hpp"
#include "passes/hole_masks.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/sim/hole_pairs.hpp"

namespace brume::passes {
namespace {

using HoleStrength = gpu::GpuTest;

TEST_F(HoleStrength, EqualsTheModelInDoubleAt1000PointsAndTimes) {
  const sim::HolePairs questions = sim::make_hole_pairs(1000, 5);
  const gpu::ComputePipeline pipeline(context(), shaders::hole_probe_comp,
                                      {gpu::kBuffer, gpu::kSampled, gpu::kBuffer}, 0, {64, 1, 1});
  const gpu::Sampler nearest(context(), {VK_FILTER_NEAREST});
  const gpu::Buffer pairs = upload(questions.pairs);
  const gpu::Buffer out(context(), questions.pairs.size() * sizeof(float),
                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  gpu::Image masks;
  runner().run([&](gpu::Recorder& recorder) {
    masks = make_hole_masks(context(), recorder, questions.atlas);
    recorder.bind(pipeline, {gpu::read(pairs), gpu::sampled(masks, nearest), gpu::write(out)});
    recorder.dispatch_threads(pipeline, static_cast<std::uint32_t>(questions.pairs.size()));
  });
  const std::vector<float> strengths = read_back<float>(out, questions.pairs.size());
  int removed = 0;
  double apart = 0;
  for (std::size_t i = 0; i < strengths.size(); ++i) {
    const reference::StrengthRange allowed = questions.allowed(i);
    EXPECT_GE(strengths[i], allowed.low) << "pair " << i;
    EXPECT_LE(strengths[i], allowed.high) << "pair " << i;
    removed += strengths[i] > 0;
    const sim::HolePair& q = questions.pairs[i];
    const float on_cpu = hole_strength_masked(q.hole, q.p_world, q.time, q.rim, questions.atlas);
    apart = std::max(apart, std::abs(double{strengths[i]} - double{on_cpu}));
  }
  EXPECT_GT(removed, 240);
  RecordProperty("farthest_from_the_cpu", std::to_string(apart));
}

}  // namespace
}  // namespace brume::passes
