#include "scenario/lens.hpp"

#include "core/error.hpp"
#include "trace/low_discrepancy.hpp"

namespace brume::scenario {
namespace {

float fraction(std::uint32_t of_2_to_32) {
  return static_cast<float>(of_2_to_32 >> 8) * 0x1p-24f;
}

/// Point i of a sequence in the unit square. Sequences of other numbers come in other orders, so that they
/// are independent of each other.
glm::vec2 point_of(std::uint32_t i, std::uint32_t sequence) {
  const std::uint32_t seed = 0x9e3779b9u * (sequence + 1);
  const std::uint32_t shuffled = trace::first_scrambled(trace::reversed_bits(i), seed);
  return {fraction(trace::first_scrambled(shuffled, seed ^ 0x85ebca6bu)),
          fraction(trace::second_scrambled(shuffled, seed ^ 0xc2b2ae35u))};
}

}  // namespace

const LensOpening* opening_of(const LensOpenings& openings, const scene::Lens& lens) {
  if (lens.opening.empty()) return nullptr;
  const auto found = openings.find(lens.opening);
  BRUME_ASSERT(found != openings.end(), lens.opening.string());
  return found->second.get();
}

std::vector<CameraSample> camera_samples(std::uint32_t count, const scene::Lens& lens,
                                         const LensOpening* opening) {
  if (count <= 1) return {CameraSample{}};
  std::vector<CameraSample> samples;
  for (std::uint32_t i = 0; i < count; ++i) {
    planning::ViewSample view{point_of(i, 0) - 0.5f, {0, 0}, i, count};
    if (lens.aperture > 0) view.lens = point_on_lens(lens.blades, opening, point_of(i, 1));
    const float time = (static_cast<float>(i) + point_of(i, 2).x) / static_cast<float>(count);
    samples.push_back({view, time});
  }
  return samples;
}

}  // namespace brume::scenario
