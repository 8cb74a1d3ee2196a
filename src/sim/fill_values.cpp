#include "sim/fill_values.hpp"

#include <algorithm>
#include <array>

#include "core/hash.hpp"
#include "sim/fill.hpp"
#include "sim/lattice_noise.hpp"

namespace brume::sim {
namespace {

/// Parts of a voxel's survival due to distance and to noise; the sum is 255.
constexpr std::uint32_t kSurvivalByDistance = 75, kSurvivalByNoise = 180;
/// Radius of the sphere on which the lobe noise is sampled, in 1/256 cell: a lobe spans about 36 degrees.
constexpr int kLobesWide = 3 * 256;

/// Value noise of one block, trilinear between its corners: lattice cells are blocks.
class BlockNoise {
 public:
  BlockNoise(glm::ivec3 block, std::uint32_t seed) {
    for (int i = 0; i < 8; ++i)
      corners_[static_cast<std::size_t>(i)] =
          lattice_noise(block + glm::ivec3(i & 1, i >> 1 & 1, i >> 2), seed);
  }
  /// At the centre of the voxel with this bit, [0, 255].
  std::uint32_t at(int bit) const {
    const auto x = static_cast<std::uint32_t>(2 * (bit & 3) + 1),
               y = static_cast<std::uint32_t>(2 * (bit >> 2 & 3) + 1),
               z = static_cast<std::uint32_t>(2 * (bit >> 4) + 1);
    std::uint32_t sum = 0;
    for (std::uint32_t i = 0; i < 8; ++i)
      sum += corners_[i] * (i & 1 ? x : 8 - x) * (i & 2 ? y : 8 - y) * (i & 4 ? z : 8 - z);
    return sum >> 9;
  }

 private:
  std::array<std::uint32_t, 8> corners_;
};

/// How far the smoke at a voxel lags behind the front: noise on a sphere around the source, so that lobes
/// have the same angular width in all directions and stay in place while the cloud grows.
std::uint8_t lag_of(glm::ivec3 from_source, std::uint32_t distance, std::uint32_t seed) {
  // The direction to the voxel scaled to the sphere's radius, offset so that no component is negative.
  const auto on_sphere = [&](int radius_256) {
    const auto far = static_cast<std::int64_t>(std::max(distance, kFaceStep));
    glm::ivec3 point;
    for (int axis = 0; axis < 3; ++axis)
      point[axis] = (64 << 8) + static_cast<int>(std::int64_t{from_source[axis]} *
                                                 static_cast<std::int64_t>(kFaceStep) * radius_256 / far);
    return point;
  };
  const std::uint32_t wide = value_noise(on_sphere(kLobesWide), seed);
  const std::uint32_t narrow = value_noise(on_sphere(2 * kLobesWide), seed + 1);
  const int sum = static_cast<int>(3 * wide + narrow) / 4;
  return static_cast<std::uint8_t>(std::clamp(128 + 5 * (sum - 128) / 2, 0, 255));
}

/// How long the smoke of a fill withstands the dissolve, by rank.
std::vector<std::uint8_t> survival_of(const BlockSet& fill, std::span<const std::uint32_t> distances,
                                      std::uint32_t max_distance, std::uint32_t seed) {
  std::vector<std::uint8_t> survival(fill.size());
  for (const VoxelBlock& block : fill.blocks()) {
    const BlockNoise noise(glm::ivec3(block.at), seed);
    std::uint32_t rank = block.first;
    for (std::uint64_t bits = block.mask; bits != 0; bits &= bits - 1, ++rank) {
      const std::uint64_t far =
          std::uint64_t{kSurvivalByDistance} * distances[rank] / std::max(max_distance, 1u);
      const std::uint32_t noisy = noise.at(std::countr_zero(bits)) * kSurvivalByNoise / 255;
      survival[rank] = static_cast<std::uint8_t>(kSurvivalByDistance - far + noisy);
    }
  }
  return survival;
}

}  // namespace

FillValues fill_values(glm::ivec3 source, std::uint32_t detonation_tick, const BlockSet& fill,
                       std::vector<std::uint32_t> distances) {
  const std::array<std::uint32_t, 4> seeds{static_cast<std::uint32_t>(source.x),
                                           static_cast<std::uint32_t>(source.y),
                                           static_cast<std::uint32_t>(source.z), detonation_tick};
  const auto seed = static_cast<std::uint32_t>(hash_values(std::span<const std::uint32_t>(seeds)));
  FillValues values;
  values.distances = std::move(distances);
  const std::uint32_t max_distance =
      fill.empty() ? 0 : *std::max_element(values.distances.begin(), values.distances.end());
  values.survival = survival_of(fill, values.distances, max_distance, seed);
  values.lag.resize(fill.size());
  fill.for_each([&](glm::ivec3 voxel, std::uint32_t i) {
    values.lag[i] = lag_of(voxel - source, values.distances[i], seed);
  });
  return values;
}

}  // namespace brume::sim
