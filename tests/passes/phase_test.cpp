#include "shared/phase.h"

#include "brume_test_shaders.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/probes.h"
#include "tests/reference/phase.hpp"

namespace brume::passes {
namespace {

constexpr double kEps = 1.0 / (1 << 24);  // rounding of a float

const std::vector<float> kDiameters{0.1f, 0.2f, 0.5f,  0.9f, 1.0f, 1.3f, 1.49f, 1.5f,
                                    2,    3,    4.99f, 5,    8,    20,   50};

std::vector<shared::Phase> all_phases() {
  std::vector<shared::Phase> phases;
  for (const float g : {-0.9f, -0.3f, 0.0f, 0.2f, 0.6f, 0.85f, 0.95f, 0.998f})
    phases.push_back(shared::phase_of_hg(g));
  for (const float diameter : kDiameters) phases.push_back(shared::phase_of_droplet(diameter));
  for (const float share : {0.0f, 0.25f, 0.5f})
    phases.push_back(shared::rounder_phase(shared::phase_of_droplet(8), share));
  phases.push_back({0, 0.7f, 1, 1});  // Cornette and Shanks 1992
  return phases;
}

std::vector<float> cosines() {
  std::vector<float> values{-1, 1, 0, std::nextafter(1.0f, 0.0f), 0.999999f, 0.9999f, -0.9999f};
  for (int i = 0; i <= 40; ++i) values.push_back(-1 + 0.05f * static_cast<float>(i));
  for (float& value : values) value = std::min(value, 1.0f);
  return values;
}

TEST(Phase, IntegratesToOneAndItsMeanCosineIsAsSaid) {
  for (const shared::Phase& phase : all_phases()) {
    const auto value = [&](double c) { return reference::phase_value(phase, c); };
    EXPECT_NEAR(reference::integrate_directions(value), 1, 1e-11) << phase.g_hg << ' ' << phase.g_draine;
    // mean_cosine rounds about ten times.
    EXPECT_NEAR(reference::integrate_directions([&](double c) { return c * value(c); }),
                double{shared::mean_cosine(phase)}, 10 * kEps);
  }
}

TEST(Phase, OfDropletsIsAPhaseFunction) {
  for (const float diameter : kDiameters) {
    const shared::Phase phase = shared::phase_of_droplet(diameter);
    for (const float share : {phase.g_hg, phase.g_draine, phase.draine_weight}) {
      EXPECT_GT(share, 0) << diameter;
      EXPECT_LT(share, 1) << diameter;
    }
    EXPECT_GT(phase.alpha, 0);
    // Mie's theory for water and visible light: from half a micrometre on far forward.
    if (diameter < 0.5f) continue;
    EXPECT_NEAR(shared::mean_cosine(phase), 0.83f, 0.07f) << diameter;
  }
  EXPECT_LT(shared::mean_cosine(shared::phase_of_droplet(0.1f)), 0.2f);
  // Out of range: the nearest that is in it.
  EXPECT_EQ(shared::phase_of_droplet(1000).g_hg, shared::phase_of_droplet(50).g_hg);
  EXPECT_EQ(shared::phase_of_droplet(0).alpha, shared::phase_of_droplet(0.1f).alpha);
}

TEST(Phase, CornetteAndShanksIsOneOfThem) {
  // 3/2 (1 - g^2) / (2 + g^2) (1 + mu^2) / (1 + g^2 - 2 g mu)^1.5 / 4 pi (Cornette and Shanks 1992).
  const double g = 0.7;
  for (const double mu : {-1.0, -0.2, 0.5, 1.0}) {
    const double expected = 1.5 * (1 - g * g) / (2 + g * g) * (1 + mu * mu) /
                            std::pow(1 + g * g - 2 * g * mu, 1.5) / (4 * std::numbers::pi);
    EXPECT_NEAR(reference::draine(g, 1, mu), expected, 1e-14 * expected);
  }
}

class PhaseTest : public gpu::GpuTest {};

TEST_F(PhaseTest, BothLanguagesComputeTheSame) {
  const std::vector<shared::Phase> phases = all_phases();
  const std::vector<float> at = cosines();
  const gpu::Buffer in_phases = upload(phases), in_cosines = upload(at), in_diameters = upload(kDiameters);
  constexpr VkBufferUsageFlags kOut = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
  const std::size_t count = phases.size() * at.size();
  const gpu::Buffer out_values(context(), count * sizeof(float), kOut),
      out_droplets(context(), kDiameters.size() * sizeof(shared::Phase), kOut);
  const gpu::ComputePipeline pipeline(context(), shaders::phase_probe_comp);
  runner().run([&](gpu::Recorder& recorder) {
    recorder.bind(pipeline, {{shared::kBindProbeIn, gpu::read(in_phases)},
                             {shared::kBindProbeIn2, gpu::read(in_cosines)},
                             {shared::kBindProbeOut, gpu::write(out_values)},
                             {shared::kBindProbeIn3, gpu::read(in_diameters)},
                             {shared::kBindProbeOut2, gpu::write(out_droplets)}});
    recorder.dispatch_threads(pipeline, static_cast<std::uint32_t>(count));
  });
  const auto values = read_back<float>(out_values, count);
  for (std::size_t i = 0; i < count; ++i) {
    const shared::Phase& phase = phases[i / at.size()];
    const float cos_angle = at[i % at.size()];
    const double exact = reference::phase_value(phase, double{cos_angle});
    // No step cancels: a dozen roundings here; there division and root may be off by three steps each.
    EXPECT_NEAR(shared::phase_value(phase, cos_angle), exact, 16 * kEps * exact)
        << phase.g_hg << ' ' << cos_angle;
    EXPECT_NEAR(values[i], exact, 32 * kEps * exact) << phase.g_hg << ' ' << cos_angle;
  }
  const auto droplets = read_back<shared::Phase>(out_droplets, kDiameters.size());
  for (std::size_t i = 0; i < droplets.size(); ++i) {
    const shared::Phase expected = shared::phase_of_droplet(kDiameters[i]);
    // Vulkan promises 2^-11 for sin and cos; they are multiplied by at most 0.38, and tan by less.
    EXPECT_NEAR(droplets[i].g_hg, expected.g_hg, 1e-5);
    EXPECT_NEAR(droplets[i].g_draine, expected.g_draine, 1e-3) << kDiameters[i];
    EXPECT_NEAR(droplets[i].alpha, expected.alpha, 1e-4 * expected.alpha);
    EXPECT_NEAR(droplets[i].draine_weight, expected.draine_weight, 1e-3);
  }
}

}  // namespace
}  // namespace brume::passes
