#include "brume_test_shaders.hpp"
#include "passes/hole_masks.hpp"
#include "passes/hole_clusters.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/smoke/hole_pairs.hpp"

namespace brume::passes {
namespace {

using HoleStrength = gpu::GpuTest;

TEST_F(HoleStrength, EqualsTheModelInDoubleAt1000PointsAndTimes) {
  const smoke::HolePairs questions = smoke::make_hole_pairs(1000, 5);
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
    const smoke::HolePair& q = questions.pairs[i];
    const float on_cpu = hole_strength_masked(q.hole, q.p_world, q.time, q.rim, questions.atlas);
    apart = std::max(apart, std::abs(double{strengths[i]} - double{on_cpu}));
  }
  EXPECT_GT(removed, 240);
  RecordProperty("farthest_from_the_cpu", std::to_string(apart));
}

/// As the shader reads them.
struct LeftQuestion {
  glm::vec3 p_world;
  float time, rim_noise, rim;
};

TEST_F(HoleStrength, TheMarchLeavesWhatTheModelDoesNotRemove) {
  smoke::HolePairs pairs = smoke::make_hole_pairs(1000, 6);
  for (std::size_t i = 0; i < 1000; i += 2) pairs.pairs[i].hole.time_to_stay_open += 10;  // more wide open
  std::vector<LeftQuestion> questions;
  std::vector<glm::vec4> rows;
  std::size_t steady = 0;
  for (const smoke::HolePair& q : pairs.pairs) {
    const float rim = 0.25f * q.hole.radius;
    questions.push_back({q.p_world, q.time, q.rim / rim, rim});
    planning::HolePlan plan;
    plan.holes = {q.hole};
    plan.time = q.time;
    const auto of_hole = planning::pack_holes(plan);
    steady += of_hole[0].w > 0 ? 1u : 0u;
    rows.insert(rows.end(), of_hole.begin(), of_hole.begin() + sizeof(shared::Hole) / sizeof(glm::vec4));
  }
  EXPECT_GT(steady, 100u);
  EXPECT_LT(steady, 900u);
  const gpu::ComputePipeline pipeline(
      context(), shaders::remaining_probe_comp,
      {gpu::kUniform, gpu::kBuffer, gpu::kBuffer, gpu::kSampled, gpu::kBuffer}, 0, {64, 1, 1});
  const gpu::Sampler nearest(context(), {VK_FILTER_NEAREST});
  const gpu::Buffer frame = upload(std::vector<shared::FrameConstants>(1));
  const gpu::Buffer asked = upload(questions), holes = upload(rows);
  const gpu::Buffer out(context(), questions.size() * sizeof(float),
                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  gpu::Image masks;
  runner().run([&](gpu::Recorder& recorder) {
    masks = make_hole_masks(context(), recorder, pairs.atlas);
    recorder.bind(pipeline, {gpu::uniform(frame), gpu::read(asked), gpu::read(holes),
                             gpu::sampled(masks, nearest), gpu::write(out)});
    recorder.dispatch_threads(pipeline, static_cast<std::uint32_t>(questions.size()));
  });
  const std::vector<float> left = read_back<float>(out, questions.size());
  for (std::size_t i = 0; i < left.size(); ++i) {
    const reference::StrengthRange allowed = pairs.allowed(i);
    EXPECT_GE(1 - left[i], allowed.low) << "pair " << i;
    EXPECT_LE(1 - left[i], allowed.high) << "pair " << i;
  }
}

}  // namespace
}  // namespace brume::passes
