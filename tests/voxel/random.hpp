// Random numbers of the voxel tests.
#pragma once

#include <random>

namespace brume::voxel {

using Random = std::mt19937_64;

/// Uniform in [low, high), the same on every standard library.
inline float uniform(Random& random, float low, float high) {
  return low + (high - low) * static_cast<float>(random() >> 40) / 16777216.0f;
}

}  // namespace brume::voxel
