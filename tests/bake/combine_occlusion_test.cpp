#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

#include "bake/occlusion.hpp"

namespace brume::bake {
namespace {

/// Random values in slices across y.
Occlusion random_occlusion(std::uint32_t slices) {
  std::mt19937 random(slices);
  std::uniform_real_distribution<float> uniform(0, 1);
  Occlusion occlusion;
  for (grids::DenseGrid* grid : {&occlusion.up, &occlusion.down}) {
    grid->size = {5, slices, 3};
    for (std::uint32_t i = 0; i < 15 * slices; ++i) grid->values.push_back(i % 7 == 0 ? 0 : uniform(random));
  }
  return occlusion;
}

/// Calls visit(slice, larger value, combined value).
template <typename Visit>
void for_each_combined(const Occlusion& occlusion, const OcclusionCurve& curve, Visit visit) {
  const grids::DenseGrid combined = combine_occlusion(occlusion, curve);
  EXPECT_EQ(combined.name, "combined");
  EXPECT_EQ(combined.size, occlusion.up.size);
  ASSERT_EQ(combined.values.size(), occlusion.up.values.size());
  for (std::size_t i = 0; i < combined.values.size(); ++i)
    visit(i / 5 % combined.size.y, std::max(occlusion.up.values[i], occlusion.down.values[i]),
          combined.values[i]);
}

TEST(CombinedOcclusion, IsTheLargerOfBothWithoutACurve) {
  for (const OcclusionCurve& curve : {OcclusionCurve{}, {1, 1, 0}, {0.3, 0, 0}, {3, 0, 2}})
    for (const std::uint32_t slices : {1u, 4u, 7u})
      for_each_combined(random_occlusion(slices), curve,
                        [](std::size_t, float larger, float combined) { EXPECT_EQ(combined, larger); });
}

TEST(CombinedOcclusion, FadesFromTheMiddleToTheEnds) {
  constexpr float kUlps = 2e-7f;  // of values up to 1
  // Of five slices, the middles are at distances of 0.8, 0.4, 0, 0.4 and 0.8.
  for_each_combined(random_occlusion(5), {0.5, 0.5, 2}, [](std::size_t slice, float larger, float combined) {
    const std::array<float, 5> fades{0.04f, 0.36f, 1, 0.36f, 0.04f};
    EXPECT_NEAR(combined, std::pow(larger, 1 - 0.25f * fades[slice]), kUlps);
    EXPECT_GE(combined, larger);
  });
  // A falloff of 0 fades nowhere, a steep one next to the middle.
  for_each_combined(random_occlusion(4), {3, 1, 0}, [](std::size_t, float larger, float combined) {
    EXPECT_NEAR(combined, larger * larger * larger, kUlps);
  });
  for_each_combined(random_occlusion(3), {3, 1, 1e6}, [](std::size_t slice, float larger, float combined) {
    EXPECT_NEAR(combined, slice == 1 ? larger * larger * larger : larger, kUlps);
  });
}

TEST(CombinedOcclusion, IsTheSameAtBothEnds) {
  for (const std::uint32_t slices : {2u, 9u, 64u}) {
    Occlusion occlusion = random_occlusion(slices);
    occlusion.up.values.assign(occlusion.up.values.size(), 0.3f);
    occlusion.down.values.assign(occlusion.down.values.size(), 0.2f);
    const grids::DenseGrid combined = combine_occlusion(occlusion, {0.4, 0.9, 1.5});
    for (std::uint32_t y = 0; y < slices; ++y)
      EXPECT_EQ(combined.values[combined.index({1, y, 2})],
                combined.values[combined.index({1, slices - 1 - y, 2})]);
  }
}

}  // namespace
}  // namespace brume::bake
