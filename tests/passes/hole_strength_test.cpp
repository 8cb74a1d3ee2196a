#include "brume_test_shaders.hpp"
#include "passes/hole_clusters.hpp"
#include "passes/hole_masks.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/probes.h"
#include "tests/smoke/hole_pairs.hpp"

namespace brume::passes {
namespace {

using HoleStrength = gpu::GpuTest;

TEST_F(HoleStrength, EqualsTheModelInDoubleAt1000PointsAndTimes) {
  const smoke::HolePairs questions = smoke::make_hole_pairs(1000, 5);
  const gpu::ComputePipeline pipeline(context(), shaders::hole_probe_comp);
  const gpu::Sampler nearest(context(), {VK_FILTER_NEAREST});
  const gpu::Buffer pairs = upload(questions.pairs);
  const gpu::Buffer out(context(), questions.pairs.size() * sizeof(float),
                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  gpu::Image masks;
  runner().run([&](gpu::Recorder& recorder) {
    masks = make_hole_masks(context(), recorder, questions.atlas);
    recorder.bind(pipeline, {{shared::kBindProbeIn, gpu::read(pairs)},
                             {shared::kBindHoleMasks, gpu::sampled(masks, nearest)},
                             {shared::kBindProbeOut, gpu::write(out)}});
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

/// As remaining_probe.comp reads it.
struct RemainingQuery {
  glm::vec3 p_world;
  float time, rim_noise, rim;
};

TEST_F(HoleStrength, TheMarchLeavesWhatTheModelDoesNotRemove) {
  smoke::HolePairs pairs = smoke::make_hole_pairs(1000, 6);
  for (std::size_t i = 0; i < 1000; i += 2) pairs.pairs[i].hole.time_to_stay_open += 10;  // more wide open
  std::vector<RemainingQuery> queries;
  std::vector<shared::PackedHole> packed;
  std::ptrdiff_t wide_open = 0;
  for (const smoke::HolePair& q : pairs.pairs) {
    const float rim = 0.25f * q.hole.radius;
    queries.push_back({q.p_world, q.time, q.rim / rim, rim});
    packed.push_back(planning::pack_holes({&q.hole, 1}, q.time)[0]);
    wide_open += shared::hole_is_partial(packed.back().origin_radius) ? 0 : 1;
  }
  EXPECT_GT(wide_open, 100);
  EXPECT_LT(wide_open, 900);
  const gpu::ComputePipeline pipeline(context(), shaders::remaining_probe_comp);
  const gpu::Sampler nearest(context(), {VK_FILTER_NEAREST});
  const gpu::Buffer in = upload(queries), packed_holes = upload(packed);
  const gpu::Buffer out(context(), queries.size() * sizeof(float),
                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  gpu::Image masks;
  runner().run([&](gpu::Recorder& recorder) {
    masks = make_hole_masks(context(), recorder, pairs.atlas);
    recorder.bind(pipeline, {{shared::kBindProbeIn, gpu::read(in)},
                             {shared::kBindHoles, gpu::read(packed_holes)},
                             {shared::kBindHoleMasks, gpu::sampled(masks, nearest)},
                             {shared::kBindProbeOut, gpu::write(out)}});
    recorder.dispatch_threads(pipeline, static_cast<std::uint32_t>(queries.size()));
  });
  const std::vector<float> remaining = read_back<float>(out, queries.size());
  for (std::size_t i = 0; i < remaining.size(); ++i) {
    const reference::StrengthRange allowed = pairs.allowed(i);
    EXPECT_GE(1 - remaining[i], allowed.low) << "pair " << i;
    EXPECT_LE(1 - remaining[i], allowed.high) << "pair " << i;
  }
}

}  // namespace
}  // namespace brume::passes
