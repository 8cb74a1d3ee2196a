#include "smoke/sight_packet.hpp"

#include <bit>

namespace brume::smoke {
namespace {

constexpr std::uint32_t kAllLanes = ~std::uint32_t{0} >> (32 - kPacketLanes);

constexpr std::uint32_t bit_of(std::size_t lane) {
  return std::uint32_t{1} << lane;
}

/// What lanes without a ray read.
constexpr std::array<Texel, shared::kTexelsPerBrick> kNoSmoke{};
constexpr std::uint32_t kNoEntry = 0;

template <typename Visit>
void for_each_bit(std::uint32_t bits, Visit visit) {
  for (; bits != 0; bits &= bits - 1) visit(static_cast<std::size_t>(std::countr_zero(bits)));
}

}  // namespace

SmokePacket::SmokePacket(const SmokeVolume& volume, bool holed, float enough, std::span<float> sums,
                         StepPacket step_packet)
    : volume_(volume), holed_(holed), enough_(enough), sums_(sums), step_packet_(step_packet) {
  if (holed_)
    for (LaneRay& ray : rays_) ray.holes.reserve();
  lanes_.texels.fill(kNoSmoke.data());
  lanes_.entries.fill(&kNoEntry);
}

std::size_t SmokePacket::free_lane() {
  while (busy_ == kAllLanes) step();
  return static_cast<std::size_t>(std::countr_one(busy_));
}

void SmokePacket::finish() {
  while (busy_ != 0) step();
}

void SmokePacket::start(std::size_t lane, const SmokeRay& ray, std::size_t number) {
  LaneRay& r = rays_[lane];
  r.bricks = BrickWalk(ray);
  r.sum = SmokeSum(volume_, ray, holed_ ? &r.holes : nullptr);
  r.number = number;
  busy_ |= bit_of(lane);
  const Float4 d = ray.direction, per_cell = r.bricks.exits_per_cell();
  const Int4 stride = r.bricks.stride();
  int row = 1, entry_row = 1;
  for (std::size_t axis = 0; axis < 3; ++axis, row *= kRow, entry_row *= kEntryRow) {
    lanes_.direction[axis][lane] = d[axis];
    lanes_.exits_per_cell[axis][lane] = per_cell[axis];
    lanes_.stride[axis][lane] = stride[axis];
    lanes_.place_stride[axis][lane] = stride[axis] * (row + (entry_row << 16));
  }
  lanes_.xy[lane] = d[0] * d[1];
  lanes_.xz[lane] = d[0] * d[2];
  lanes_.yz[lane] = d[1] * d[2];
  lanes_.length[lane] = ray.length;
  lanes_.next_hole[lane] = r.sum.next_hole();
  for (auto& total : lanes_.total) total[lane] = 0;
  enter_brick(lane);
}

void SmokePacket::step() {
  const PacketStep step = step_packet_(lanes_);
  for_each_bit(step.special & busy_, [&](std::size_t lane) { add_special(lane); });
  for_each_bit(step.stopped & busy_, [&](std::size_t lane) { leave_brick(lane); });
}

void SmokePacket::leave_brick(std::size_t lane) {
  BrickWalk& bricks = rays_[lane].bricks;
  bricks.t = lanes_.t[lane];
  bricks.cell = Int4{lanes_.cell[0][lane], lanes_.cell[1][lane], lanes_.cell[2][lane], 0};
  if (sum4(total_of(lane)) > enough_ * 255)
    end(lane);
  else
    enter_brick(lane);
}

void SmokePacket::enter_brick(std::size_t lane) {
  BrickWalk& bricks = rays_[lane].bricks;
  if (!bricks.find_brick(volume_)) {
    end(lane);
    return;
  }
  const Float4 exits = bricks.exits();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lanes_.at[axis][lane] = bricks.at[axis];
    lanes_.exits[axis][lane] = exits[axis];
    lanes_.cell[axis][lane] = bricks.cell[axis];
  }
  const auto place_of = [&](int row) {
    return static_cast<std::uint32_t>(bricks.cell[0] + row * (bricks.cell[1] + row * bricks.cell[2]));
  };
  lanes_.place[lane] = place_of(kRow) | place_of(kEntryRow) << 16;
  lanes_.t[lane] = bricks.t;
  lanes_.texels[lane] = volume_.texels(bricks.slot).data();
  lanes_.entries[lane] = volume_.cells(bricks.slot).data();
}

void SmokePacket::end(std::size_t lane) {
  sums_[rays_[lane].number] = sum4(total_of(lane)) * (1.0f / 255);
  busy_ &= ~bit_of(lane);
  // The lane stays where it is, in a brick without smoke.
  lanes_.length[lane] = lanes_.t[lane] = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lanes_.stride[axis][lane] = lanes_.place_stride[axis][lane] = 0;
    lanes_.exits[axis][lane] = lanes_.exits_per_cell[axis][lane] = 0;
  }
  lanes_.place[lane] = 0;
  lanes_.texels[lane] = kNoSmoke.data();
  lanes_.entries[lane] = &kNoEntry;
}

void SmokePacket::add_special(std::size_t lane) {
  const std::uint32_t place = lanes_.passed_place[lane];
  const std::uint32_t entry = lanes_.entries[lane][place >> 16];
  SmokeSum& sum = rays_[lane].sum;
  sum.total = total_of(lane);
  const Float4 at{lanes_.passed_at[0][lane], lanes_.passed_at[1][lane], lanes_.passed_at[2][lane], 0};
  const float from = lanes_.passed_from[lane], to = lanes_.passed_to[lane];
  if (entry != 0) {
    sum.add_boundary(volume_.boundary_cells()[entry - 1], at, from, to);
  } else {
    const TexelRows rows(lanes_.texels[lane] + (place & 0xffffu));
    if (rows.empty()) return;
    sum.add(rows.corners(), at, from, to);
  }
  for (std::size_t part = 0; part < 4; ++part) lanes_.total[part][lane] = sum.total[part];
  lanes_.next_hole[lane] = sum.next_hole();
}

}  // namespace brume::smoke
