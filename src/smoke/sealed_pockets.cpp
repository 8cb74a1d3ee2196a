#include "smoke/sealed_pockets.hpp"

#include <bit>

namespace brume::smoke {
namespace {

std::uint64_t key_of(glm::ivec3 brick) {
  return static_cast<std::uint64_t>(brick.x) | static_cast<std::uint64_t>(brick.y) << 16 |
         static_cast<std::uint64_t>(brick.z) << 32;
}

glm::ivec3 neighbour(glm::ivec3 voxel, int face) {
  voxel[face >> 1] += face & 1 ? 1 : -1;
  return voxel;
}

}  // namespace

const SealedPockets::Page* SealedPockets::page_of(glm::ivec3 brick) const {
  const auto page = pages_.find(key_of(brick));
  return page == pages_.end() ? nullptr : page->second.get();
}

std::uint32_t SealedPockets::space_at(glm::ivec3 voxel) const {
  const Page* page = page_of(voxel >> 3);
  return page ? page->space[local_voxel(voxel)] : 0;
}

void SealedPockets::put(glm::ivec3 voxel, std::uint32_t space, std::vector<glm::ivec3>& bricks) {
  std::unique_ptr<Page>& page = pages_[key_of(voxel >> 3)];
  if (!page) page = std::make_unique<Page>();
  page->space[local_voxel(voxel)] = space;
  ++page->known;
  if (bricks.empty() || bricks.back() != voxel >> 3) bricks.push_back(voxel >> 3);
}

bool SealedPockets::sealed(const voxel::BitGrid& grid, const HasSmoke& has_smoke, glm::ivec3 voxel,
                           glm::ivec3 brick) {
  std::uint32_t number = space_at(voxel);
  if (number == 0) number = explore(grid, has_smoke, voxel);
  Space& space = spaces_[number];
  if (space.queried_by.empty() || space.queried_by.back() != brick) space.queried_by.push_back(brick);
  return space.sealed;
}

/// Floods the free voxels from one of them until it meets smoke, too many voxels, or a known space, of which
/// they are then a part. Returns the number of the space.
std::uint32_t SealedPockets::explore(const voxel::BitGrid& grid, const HasSmoke& has_smoke,
                                     glm::ivec3 voxel) {
  const std::uint32_t number = next_space_++;
  std::uint32_t into = number;
  bool closed = true;
  std::vector<glm::ivec3> bricks;
  put(voxel, number, bricks);
  reached_.assign(1, voxel);
  for (std::size_t i = 0; closed && i < reached_.size(); ++i)
    for (int face = 0; closed && face < 6; ++face) {
      const glm::ivec3 next = neighbour(reached_[i], face);
      if (!grid.free(next)) continue;
      const std::uint32_t known = space_at(next);
      if (known == number) continue;
      if (known != 0) into = known;
      closed = known == 0 && !has_smoke(next) && reached_.size() + 1 < kLeastRoom;
      if (!closed) continue;
      put(next, number, bricks);
      reached_.push_back(next);
    }

  // A space of its own, or a part of the one that it met.
  Space& space = spaces_[into];
  if (into == number) {
    space.sealed = closed;
    space.bricks = std::move(bricks);
    return number;
  }
  for (const glm::ivec3 v : reached_) pages_[key_of(v >> 3)]->space[local_voxel(v)] = into;
  space.bricks.insert(space.bricks.end(), bricks.begin(), bricks.end());
  return into;
}

void SealedPockets::changed(glm::ivec3 brick, const BrickBits& voxels, std::vector<glm::ivec3>& stale) {
  if (pages_.empty()) return;
  bool any = page_of(brick) != nullptr;
  for (int face = 0; face < 6; ++face) any |= page_of(neighbour(brick, face)) != nullptr;
  if (!any) return;
  for (int z = 0; z < 8; ++z)
    for (std::uint64_t bits = voxels[static_cast<std::size_t>(z)]; bits != 0; bits &= bits - 1) {
      const int bit = std::countr_zero(bits);
      const glm::ivec3 voxel = 8 * brick + glm::ivec3(bit & 7, bit >> 3, z);
      if (const std::uint32_t space = space_at(voxel); space != 0) invalidate(space, stale);
      for (int face = 0; face < 6; ++face)
        if (const std::uint32_t space = space_at(neighbour(voxel, face)); space != 0)
          invalidate(space, stale);
    }
}

void SealedPockets::invalidate(std::uint32_t number, std::vector<glm::ivec3>& stale) {
  const auto entry = spaces_.find(number);
  stale.insert(stale.end(), entry->second.queried_by.begin(), entry->second.queried_by.end());
  for (const glm::ivec3 brick : entry->second.bricks) {
    const auto page = pages_.find(key_of(brick));
    if (page == pages_.end()) continue;
    for (std::uint32_t& space : page->second->space) {
      if (space != number) continue;
      space = 0;
      --page->second->known;
    }
    if (page->second->known == 0) pages_.erase(page);
  }
  spaces_.erase(entry);
}

}  // namespace brume::smoke
