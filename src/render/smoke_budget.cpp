#include "render/smoke_budget.hpp"

#include <algorithm>

#include "planning/resident_smoke.hpp"
#include "shared/smoke_volume.h"
#include "volume/sparse_volume.hpp"

namespace brume::render {
namespace {

using planning::ResidentSmoke;

// The least that a frame is tried with.
constexpr std::uint32_t kLeastBricks = 32;
// How long after memory was refused more is tried, where nothing says that there is more.
constexpr std::uint32_t kFramesToWait = 600;
// How long room is kept that is not wanted: it takes time to fill it again.
constexpr std::uint32_t kSpareFrames = 256;

/// Device memory of a brick, on average: texels of all images of the atlas, cells, and the light's rays.
constexpr VkDeviceSize kBrickBytes = 40 * shared::kTexelsPerBrick;

}  // namespace

SmokeBudget::SmokeBudget(std::uint32_t reserved) : reserved_(reserved), most_(ResidentSmoke::kUnlimited) {}

bool SmokeBudget::is_unlimited() const {
  return most_ == ResidentSmoke::kUnlimited;
}

bool SmokeBudget::begin_frame(const gpu::Memory& memory, std::uint32_t room, std::uint32_t wanted) {
  atlas_ = volume::grown_atlas({}, room);
  const VkDeviceSize limit = memory.limit(), held = memory.device_bytes();
  ++frames_;
  // Too much is held.
  if (held > limit && room > reserved_) {
    std::uint32_t least = room;
    while (least > reserved_ && (room - least) * kBrickBytes < held - limit) least /= 2;
    most_ = std::max(least, reserved_);
    atlas_ = volume::grown_atlas({}, most_);
    frames_ = 0;
    limit_ = limit;
    return true;
  }
  if (held > limit) most_ = std::min(most_, reserved_);
  if (has_spare_room(room, wanted)) {
    atlas_ = volume::grown_atlas({}, std::max(2 * wanted_, reserved_));
    return true;
  }
  // There may be room for twice as much.
  const bool has_more = limit > limit_;
  limit_ = limit;
  if (is_unlimited() || (!has_more && frames_ < kFramesToWait)) return false;
  const VkDeviceSize needed = 2 * std::max<VkDeviceSize>(most_, room) * kBrickBytes;
  if (held >= limit || limit - held < needed) return false;
  frames_ = has_more ? kFramesToWait : 0;
  most_ = most_ < room ? room : 2 * most_;
  if (most_ >= volume::kMaxAtlasSlots) most_ = ResidentSmoke::kUnlimited;
  return false;
}

/// Whether a quarter of the room would have done for kSpareFrames.
bool SmokeBudget::has_spare_room(std::uint32_t room, std::uint32_t wanted) {
  if (room <= reserved_ || wanted > room / 4) {
    wanted_frames_ = wanted_ = 0;
    return false;
  }
  wanted_ = std::max(wanted_, wanted);
  return ++wanted_frames_ >= kSpareFrames;
}

bool SmokeBudget::reduce(std::uint32_t room) {
  if (room == 0 || most_ <= kLeastBricks) return false;
  frames_ = 0;
  atlas_ = volume::grown_atlas({}, room);
  const std::uint32_t less = most_ > room ? room : most_ / 2;
  most_ = most_ > reserved_ ? std::max(less, reserved_) : less;
  return true;
}

}  // namespace brume::render
