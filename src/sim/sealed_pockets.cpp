#include "sim/sealed_pockets.hpp"

namespace brume::sim {
namespace {

std::uint64_t key_of(glm::ivec3 v) {
  return static_cast<std::uint64_t>(v.x) | static_cast<std::uint64_t>(v.y) << 16 |
         static_cast<std::uint64_t>(v.z) << 32;
}

}  // namespace

bool SealedPockets::sealed(glm::ivec3 voxel) {
  if (const auto found = known_.find(key_of(voxel)); found != known_.end()) return found->second;
  bool result = !has_smoke_(voxel);
  known_[key_of(voxel)] = true;
  reached_.assign(1, voxel);
  for (std::size_t i = 0; result && i < reached_.size(); ++i)
    for (int face = 0; result && face < 6; ++face) {
      glm::ivec3 next = reached_[i];
      next[face >> 1] += face & 1 ? 1 : -1;
      if (!grid_.free(next)) continue;
      if (has_smoke_(next)) result = false;
      const auto [entry, is_new] = known_.try_emplace(key_of(next), true);
      if (is_new) reached_.push_back(next);
      // What was known before is part of the same space.
      result = result && entry->second && reached_.size() < kLeastRoom;
    }
  for (const glm::ivec3 v : reached_) known_[key_of(v)] = result;
  return result;
}

}  // namespace brume::sim
