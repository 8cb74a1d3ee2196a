// shared/erosion.h: what noise leaves of smoke.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "brume_test_shaders.hpp"
#include "passes/noise.hpp"
#include "shared/erosion.h"
#include "shared/volume_detail.h"
#include "smoke/noise_tile.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/probes.h"

namespace brume::passes {
namespace {

/// The noise of the tile at a point, and its detail.
struct Noise {
  glm::vec4 tile;
  glm::vec2 detail{0};
};
static_assert(sizeof(Noise) == 24);

class ErosionTest : public gpu::GpuTest {
 protected:
  std::vector<float> erode(const gpu::Buffer& noises, std::size_t count, float density, float erosion,
                           float detail) {
    struct Parameters {
      float density, erosion, detail;
    };
    const gpu::Buffer out(context(), count * sizeof(float),
                          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    runner().run([&](gpu::Recorder& recorder) {
      recorder.bind(probe_,
                    {{shared::kBindProbeIn, gpu::read(noises)}, {shared::kBindProbeOut, gpu::write(out)}},
                    Parameters{density, erosion, detail});
      recorder.dispatch_threads(probe_, static_cast<std::uint32_t>(count));
    });
    return read_back<float>(out, count);
  }
  /// The texels of the tile that smoke is eroded with.
  static std::vector<Noise> smoke_noises() {
    const NoisePass pass(context());
    const gpu::Image tile = make_noise_tile(context(), smoke::kSmokeNoise.size);
    runner().run([&](gpu::Recorder& recorder) { pass.record(recorder, tile, smoke::kSmokeNoise); });
    std::vector<Noise> noises;
    for (const auto& texel : read_back<std::array<std::uint8_t, 4>>(tile))
      noises.push_back({glm::vec4(texel[0], texel[1], texel[2], texel[3]) / 255.0f});
    return noises;
  }
  static std::vector<Noise> random_noises() {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0, 1), detail(-shared::kMostDetail, shared::kMostDetail);
    std::vector<Noise> noises(500);
    for (Noise& one : noises)
      one = {{unit(random), unit(random), unit(random), unit(random)}, {detail(random), detail(random)}};
    return noises;
  }

 private:
  gpu::ComputePipeline probe_{context(), shaders::erosion_probe_comp};
};

TEST_F(ErosionTest, RisesWithDensityFromNothing) {
  const auto noises = random_noises();
  const auto buffer = upload(noises);
  for (const float detail : {0.0f, 0.5f, 1.0f}) {
    for (const float erosion : {0.0f, 0.3f, 0.8f, 1.0f}) {
      std::vector<float> before(noises.size(), 0.0f);
      for (int d = 0; d <= 32; ++d) {
        const auto left = erode(buffer, noises.size(), static_cast<float>(d) / 32, erosion, detail);
        for (std::size_t i = 0; i < noises.size(); ++i) {
          EXPECT_TRUE(d > 0 || left[i] == 0.0f);
          EXPECT_GE(left[i], before[i] - 1e-5f) << erosion << " " << d << " " << i;
          EXPECT_LE(left[i], 1 + 0.5f * erosion + 1e-5f);
        }
        before = left;
      }
    }
  }
}

TEST_F(ErosionTest, RisesWithEachChannel) {
  const auto noises = random_noises();
  for (int channel = 0; channel < 6; ++channel) {
    auto brighter = noises;
    for (Noise& one : brighter) {
      float& value = channel < 4 ? one.tile[channel] : one.detail[channel - 4];
      value = std::min(value + 0.1f, 1.0f);
    }
    const auto buffer = upload(noises), brighter_buffer = upload(brighter);
    for (const float detail : {0.0f, 1.0f}) {
      for (const float density : {0.1f, 0.4f, 0.7f, 1.0f}) {
        const auto left = erode(buffer, noises.size(), density, 0.8f, detail);
        const auto more = erode(brighter_buffer, noises.size(), density, 0.8f, detail);
        for (std::size_t i = 0; i < noises.size(); ++i) EXPECT_GE(more[i], left[i] - 1e-5f) << channel;
      }
    }
  }
}

TEST_F(ErosionTest, NoErosionLeavesAllThatIsDense) {
  const auto noises = random_noises();
  for (const float detail : {0.0f, 1.0f})
    for (const float left : erode(upload(noises), noises.size(), 1, 0, detail)) EXPECT_EQ(left, 1.0f);
}

/// Adds detail to each noise of the tile, sampled at random places.
std::vector<Noise> with_detail(const std::vector<Noise>& noises) {
  std::mt19937 random(11);
  std::uniform_int_distribution<std::size_t> any(0, noises.size() - 1);
  std::vector<Noise> all;
  for (const Noise& noise : noises)
    all.push_back({noise.tile, shared::detail_of(shared::detail_texel(noises[any(random)].tile,
                                                                      noises[any(random)].tile))});
  return all;
}

// Line of sight knows no noise: in the mean the noise leaves dense smoke as it is, and of a rim about as much
// as there is.
TEST_F(ErosionTest, KeepsTheMeanDensity) {
  const auto tile = smoke_noises();
  for (const float detail : {0.0f, 0.5f, 1.0f}) {
    const auto noises = with_detail(tile);
    const auto buffer = upload(noises);
    const auto mean = [&](float density, float erosion) {
      double sum = 0;
      for (const float left : erode(buffer, noises.size(), density, erosion, detail)) sum += double{left};
      return sum / static_cast<double>(noises.size());
    };
    for (const float erosion : {0.3f, 0.5f, 0.8f, 1.0f})
      for (const float density : {0.9f, 0.95f, 1.0f})
        EXPECT_NEAR(mean(density, erosion) / double{density}, 1, 0.15)
            << detail << " " << erosion << " " << density;
    // A line through a rim, its density rising evenly.
    double before = 0, after = 0;
    for (int i = 1; i <= 16; ++i) {
      before += i / 16.0;
      after += mean(static_cast<float>(i) / 16, 0.8f);
    }
    EXPECT_NEAR(after / before, 1, 0.15) << detail;
    std::printf("detail %.1f: %.3f of a rim remains; of densities 0.1 to 1:", double{detail}, after / before);
    for (int i = 1; i <= 10; ++i) std::printf(" %.2f", mean(static_cast<float>(i) / 10, 0.8f));
    std::printf("\n");
  }
}

TEST_F(ErosionTest, DetailMattersWhereverItChangesWhatRemains) {
  const auto noises = random_noises();
  int left_out = 0, changed = 0;
  for (const float detail : {0.3f, 1.0f}) {
    shared::SmokeLook look{};
    look.erosion = 0.8f;
    look.detail = detail;
    for (int i = 0; i < 20000; ++i) {
      const Noise& noise = noises[static_cast<std::size_t>(i) % noises.size()];
      const float density = static_cast<float>(i % 101) / 100;
      const float without = shared::erode(look, density, noise.tile, glm::vec2(0), 0);
      const float with = shared::erode(look, density, noise.tile, noise.detail, detail);
      const float threshold = shared::erosion_threshold(look, density, shared::billows_and_wisps(noise.tile));
      if (shared::detail_matters(look, density, threshold, detail)) {
        changed += with != without;
      } else {
        ++left_out;
        EXPECT_EQ(with, without);
      }
    }
    EXPECT_FALSE(shared::detail_matters(look, 0.5f, 0.5f, 0));
  }
  EXPECT_GT(left_out, 8000);
  EXPECT_GT(changed, 5000);
}

TEST_F(ErosionTest, DetailIsAroundNothing) {
  const auto detailed = with_detail(smoke_noises());
  glm::dvec2 sum(0);
  for (const Noise& noise : detailed) {
    sum += glm::dvec2(noise.detail);
    for (int c = 0; c < 2; ++c) EXPECT_LE(std::abs(noise.detail[c]), shared::kMostDetail);
  }
  for (int c = 0; c < 2; ++c) EXPECT_NEAR(sum[c] / static_cast<double>(detailed.size()), 0, 0.02) << c;
}

// For light, which is coarser than detail: between the mean density and the density of the thinnest paths.
TEST_F(ErosionTest, LightMeetsWhatLetsAsMuchThrough) {
  const auto all = smoke_noises();
  std::vector<Noise> some;  // as many different ones as there is time for
  for (std::size_t i = 0; i < all.size(); i += 65537 / 8 + 2) some.push_back(all[i]);
  const auto details = with_detail(all);
  shared::SmokeLook look{};
  look.erosion = 0.8f;
  look.detail = 1;
  look.noise_frequency = 1.0f / 6;
  double most = 0, sum = 0;
  int count = 0;
  for (const Noise& noise : some) {
    for (int i = 1; i <= 10; ++i) {
      const float density = static_cast<float>(i) / 10;
      double mean = 0;
      for (std::size_t k = 0; k < details.size(); k += 37)
        mean += double{shared::erode(look, density, noise.tile, details[k].detail, 1)};
      mean /= static_cast<double>((details.size() + 36) / 37);
      look.extinction = 0;
      const float thin = shared::effective_erode(look, density, noise.tile);
      most = std::max(most, std::abs(double{thin} - mean));
      sum += double{thin} - mean;
      ++count;
      float before = thin;
      for (const float extinction : {0.5f, 2.0f, 7.0f, 30.0f, 1000.0f}) {
        look.extinction = extinction;
        const float dense = shared::effective_erode(look, density, noise.tile);
        EXPECT_LE(dense, before + 1e-5f);
        EXPECT_GE(dense, 0);
        before = dense;
      }
    }
  }
  // The distribution of detail is taken as even, and the rim as straight where thresholds change its slope.
  std::printf("mean of detail off by up to %.3f, by %.4f on average\n", most, sum / count);
  EXPECT_LT(most, 0.25);
  EXPECT_LT(std::abs(sum / count), 0.02);
  look.detail = 0;
  for (const Noise& noise : random_noises())
    for (const float density : {0.0f, 0.3f, 0.7f, 1.0f})
      EXPECT_NEAR(shared::effective_erode(look, density, noise.tile),
                  shared::erode(look, density, noise.tile, noise.detail, 0), 1e-5);
}

// The number in shared::relief.
TEST_F(ErosionTest, DetailHalfAPathApartIsAlike) {
  const smoke::NoiseTile detail = smoke::make_detail_tile(smoke::make_noise_tile(smoke::kSmokeNoise));
  // A twentieth of the tile.
  const std::uint32_t edge = detail.size, apart = (edge + 10) / 20;
  double sum = 0, squares = 0, products = 0;
  for (std::uint32_t i = 0; i < detail.texels.size(); ++i) {
    const std::uint32_t x = i % edge;
    const auto here = static_cast<double>(detail.texels[i].x);
    const auto there = static_cast<double>(detail.texels[i - x + (x + apart) % edge].x);
    sum += here;
    squares += here * here;
    products += here * there;
  }
  const auto count = static_cast<double>(detail.texels.size());
  const double mean = sum / count;
  EXPECT_NEAR((products / count - mean * mean) / (squares / count - mean * mean), 0.6, 0.1);
}

TEST_F(ErosionTest, DetailFadesBeforeItsBillowsAreNarrowerThanPixels) {
  shared::SmokeLook look{};
  look.detail = 1;
  look.noise_frequency = 1.0f / 6;
  const float billow = 6 / 5.3f / 16, texel = 6 / 5.3f / float{shared::kDetailTexels};
  float weight = shared::detail_weight(look, 0), level = shared::detail_level(look, 0);
  EXPECT_EQ(weight, 1);
  EXPECT_EQ(level, 0);
  for (int i = 1; i <= 400; ++i) {
    const float pixel = 0.0005f * static_cast<float>(i);
    EXPECT_LE(shared::detail_weight(look, pixel), weight);
    EXPECT_GE(shared::detail_level(look, pixel), level);
    weight = shared::detail_weight(look, pixel);
    level = shared::detail_level(look, pixel);
    if (pixel <= 0.5f * billow) {
      EXPECT_NEAR(weight, 1, 1e-5);
    }
    if (pixel >= 1.51f * billow) {
      EXPECT_EQ(weight, 0);
    }
    EXPECT_NEAR(std::exp2(level), std::max(pixel / texel, 1.0f), 1e-3f * std::max(pixel / texel, 1.0f));
  }
}

// What samples of rays are compared with: the mean over detail, nearly.
TEST_F(ErosionTest, TheMeanThatSamplesAreComparedWithIsThatOfDetail) {
  const auto all = smoke_noises();
  const auto details = with_detail(all);
  shared::SmokeLook look{};
  look.erosion = 0.8f;
  look.detail = 1;
  look.noise_frequency = 1.0f / 6;
  double off = 0;
  int count = 0;
  for (std::size_t n = 0; n < all.size(); n += 65537 / 8 + 2) {
    const glm::vec2 noise = shared::billows_and_wisps(all[n].tile);
    for (int i = 0; i <= 10; ++i) {
      const float density = static_cast<float>(i) / 10;
      double mean = 0;
      for (std::size_t k = 0; k < details.size(); k += 37)
        mean += double{shared::eroded_fraction(look, density, noise + details[k].detail)};
      mean /= static_cast<double>((details.size() + 36) / 37);
      look.extinction = 0;
      const float found =
          shared::mean_fraction(look, density, shared::erosion_threshold(look, density, noise));
      EXPECT_GE(found, 0);
      EXPECT_LE(found, 1);
      off += double{found} - mean;
      ++count;
      for (const float extinction : {7.0f, 1000.0f}) {
        look.extinction = extinction;
        const float dense =
            shared::mean_fraction(look, density, shared::erosion_threshold(look, density, noise));
        EXPECT_GE(dense, 0);
        EXPECT_LE(dense, found);
      }
    }
  }
  // Light would be off by as much: a fiftieth of relief's range is not seen.
  EXPECT_LT(std::abs(off / count), 0.02);
}

// What a sample keeps for a second threshold is enough: it is the same where the tile's noise is within its
// limits.
TEST_F(ErosionTest, AThresholdWithDetailNeedsTheOneWithoutAlone) {
  shared::SmokeLook look{};
  look.erosion = 0.9f;
  std::mt19937 random(7);
  std::uniform_real_distribution<float> fraction(0, 1), detail(-shared::kMostDetail, shared::kMostDetail);
  for (int i = 0; i < 10000; ++i) {
    const glm::vec2 noise(fraction(random), fraction(random));
    glm::vec2 fine(detail(random), detail(random));
    const float density = fraction(random), weight = fraction(random);
    const float without = shared::erosion_threshold(look, density, noise);
    EXPECT_EQ(shared::threshold_with(look, density, without, fine, 0), without);
    // The sum within its limits, too: thresholds limit each channel, threshold_with their mix.
    fine = (glm::clamp(noise + weight * fine, 0.0f, 1.0f) - noise) / std::max(weight, 1e-3f);
    EXPECT_NEAR(shared::threshold_with(look, density, without, fine, weight),
                shared::erosion_threshold(look, density, noise + weight * fine), 1e-5f);
  }
}

// What light in a volume with detail counts with: the mean over the noise.
TEST_F(ErosionTest, LightInVolumesCountsWithTheMeanOfTheirDetail) {
  const auto all = smoke_noises();
  const auto details = with_detail(all);
  for (const float strength : {0.3f, 0.6f, 1.0f})
    for (int i = 0; i <= 10; ++i) {
      const float value = static_cast<float>(i) / 10;
      const shared::VolumeDetail detail{strength, 1, 1};
      double mean = 0;
      int count = 0;
      for (std::size_t n = 0; n < all.size(); n += 61, ++count) {
        const glm::vec2 noise = shared::billows_and_wisps(all[n].tile);
        mean +=
            double{shared::volume_fraction(detail, value, noise, details[37 * n % details.size()].detail, 1)};
      }
      // Where even the densest is worn away, the rim is steeper than the mean's.
      const double off = strength == 1 && value >= 0.8f ? 0.1 : 0.04;
      EXPECT_NEAR(double{shared::mean_volume_fraction(detail, value)}, mean / count, off)
          << strength << " " << value;
    }
}

// Smoke between a point and the light darkens it, a gap lights it, and the light of one side most. Dense
// smoke has more such smoke around it, which counts for the light of one side alone.
TEST_F(ErosionTest, ReliefDarkensBehindMoreSmokeThanTheMean) {
  shared::SmokeLook look{};
  look.extinction = 7;
  look.noise_frequency = 1.0f / 6;
  const auto relief = [&](float here, float there, float fraction, float cosine) {
    return shared::relief(look, shared::relief_terms(look, here, 0.5f, fraction, cosine), there);
  };
  for (const float fraction : {0.0f, 0.5f, 1.0f}) {
    EXPECT_EQ(relief(0.5f, 0.5f, fraction, 0), 1);
    float before = 10;
    for (int i = 0; i <= 10; ++i) {
      const float shade = relief(0.5f, 0.1f * static_cast<float>(i), fraction, 0);
      EXPECT_LT(shade, before);
      before = shade;
    }
    EXPECT_GE(relief(0.5f, 1, fraction, 1), relief(0.5f, 1, 1, 1));
    if (fraction < 1) {
      EXPECT_GT(relief(1, 0.5f, fraction, 0), relief(0, 0.5f, fraction, 0));
    }
    EXPECT_EQ(relief(1, 0.5f, 1, 0), relief(0, 0.5f, 1, 0));
  }
  // Light from behind shows shadows, light from the eye none.
  EXPECT_LT(relief(0.5f, 1, 1, 1), relief(0.5f, 1, 1, 0));
  EXPECT_LT(relief(0.5f, 1, 1, 0), relief(0.5f, 1, 1, -1));
  EXPECT_EQ(relief(0.5f, 1, 1, -1), 1);
  look.albedo = glm::vec3(1);
  EXPECT_EQ(relief(1, 0.2f, 0, 0), 1) << "no shadows in even light";
}

}  // namespace
}  // namespace brume::passes
