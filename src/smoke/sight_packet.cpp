#include "smoke/sight_packet.hpp"

#include <bit>
#include <type_traits>

#include "core/float4.hpp"

// Inlined into functions for one instruction set. Vectors pass by reference: how long ones pass by value
// depends on the instruction set.
#define BRUME_INLINE [[gnu::always_inline]] inline

namespace brume::smoke {
namespace {

/// As many numbers as one register of the instruction set holds.
struct Wide4 {
  using Float = Float4;
  using Int = Int4;
  using Uint = Uint4;
};
struct Wide8 {
  using Float = float __attribute__((vector_size(32)));
  using Int = std::int32_t __attribute__((vector_size(32)));
  using Uint = std::uint32_t __attribute__((vector_size(32)));
};

template <typename Vector, typename Number>
BRUME_INLINE const Vector& load(const Number* lanes) {
  return *reinterpret_cast<const Vector*>(lanes);
}
template <typename Vector, typename Number>
BRUME_INLINE void store(Number* lanes, const Vector& values) {
  *reinterpret_cast<Vector*>(lanes) = values;
}

/// Bit i is set where lane i of a mask is.
template <typename Int>
BRUME_INLINE std::uint32_t bits_of_lanes(const Int& mask) {
  if constexpr (std::is_same_v<Int, Int4>) return bits_of(mask);
  constexpr std::size_t kCount = sizeof(Int) / 4;
  alignas(64) std::int32_t lanes[kCount];
  store<Int>(lanes, mask);
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < kCount; i += 4) bits |= bits_of(load<Int4>(lanes + i)) << i;
  return bits;
}

/// What the rays' cells hold: rows of texels as in TexelRows, and entries.
struct alignas(64) CellsHere {
  std::uint32_t rows[4][kPacketLanes];
  std::uint32_t entry[kPacketLanes];
};

BRUME_INLINE void read_cells(const PacketLanes& lanes, CellsHere& cells) {
  for (std::size_t i = 0; i < kPacketLanes; ++i) {
    const std::uint32_t place = lanes.place[i];
    const TexelRows rows(lanes.texels[i] + (place & 0xffffu));
    for (std::size_t row = 0; row < 4; ++row) cells.rows[row][i] = rows.rows[row];
    cells.entry[i] = lanes.entries[i][place >> 16];
  }
}

/// CellIntegral in every lane: densities of corner y + 2 z for the lower and the higher x, and the middle of
/// the part of the ray.
template <typename Float>
struct LaneIntegral {
  Float low[4], high[4];
  Float x, y, z, length;

  BRUME_INLINE void add_to(PacketLanes& lanes, std::size_t i) const {
    const Float third = length * length * (1.0f / 12);
    const Float third_yz = third * load<Float>(&lanes.yz[i]);
    const Float xy = load<Float>(&lanes.xy[i]), xz = load<Float>(&lanes.xz[i]);
    const Float y0 = 1.0f - y, z0 = 1.0f - z;
    const Float weights[4]{y0 * z0 + third_yz, y * z0 - third_yz, y0 * z - third_yz, y * z + third_yz};
    const Float slopes[4]{-(xy * z0 + xz * y0), xy * z0 - xz * y, xz * y0 - xy * z, xy * z + xz * y};
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const Float along_x = high[corner] - low[corner], at_x = low[corner] + along_x * x;
      float* total = &lanes.total[corner][i];
      store<Float>(
          total, load<Float>(total) + (at_x * weights[corner] + along_x * (third * slopes[corner])) * length);
    }
  }
};

/// A step of the lanes from i on that one register holds.
template <typename Wide>
BRUME_INLINE void step_lanes(PacketLanes& lanes, const CellsHere& cells, std::size_t i, PacketStep& step) {
  using Float = typename Wide::Float;
  using Int = typename Wide::Int;
  using Uint = typename Wide::Uint;

  // The end of the cell.
  const Float exits[3]{load<Float>(&lanes.exits[0][i]), load<Float>(&lanes.exits[1][i]),
                       load<Float>(&lanes.exits[2][i])};
  const Float before = exits[0] < exits[1] ? exits[0] : exits[1];
  const Float first = before < exits[2] ? before : exits[2];
  const Float t = load<Float>(&lanes.t[i]), ray_length = load<Float>(&lanes.length[i]);
  const Float out = first < ray_length ? first : ray_length;
  const Int passed = out > t;

  // Its content, and the middle of the ray's part.
  LaneIntegral<Float> part;
  const Int special =
      passed & ((load<Uint>(&cells.entry[i]) != 0u) | (out > load<Float>(&lanes.next_hole[i])));
  const Uint plain = reinterpret_cast<Uint>(passed & ~special);
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const Uint row = load<Uint>(&cells.rows[corner][i]) & plain;
    part.low[corner] = __builtin_convertvector(reinterpret_cast<Int>(row & 255u), Float);
    part.high[corner] = __builtin_convertvector(reinterpret_cast<Int>(row >> 16 & 255u), Float);
  }
  Float at[3];
  for (std::size_t axis = 0; axis < 3; ++axis)
    at[axis] =
        load<Float>(&lanes.at[axis][i]) - __builtin_convertvector(load<Int>(&lanes.cell[axis][i]), Float);
  const Float middle = 0.5f * (t + out);
  part.x = at[0] + load<Float>(&lanes.direction[0][i]) * middle;
  part.y = at[1] + load<Float>(&lanes.direction[1][i]) * middle;
  part.z = at[2] + load<Float>(&lanes.direction[2][i]) * middle;
  part.length = out - t;
  part.add_to(lanes, i);
  const std::uint32_t special_bits = bits_of_lanes<Int>(special);
  if (special_bits != 0) {
    for (std::size_t axis = 0; axis < 3; ++axis) store<Float>(&lanes.passed_at[axis][i], at[axis]);
    store<Float>(&lanes.passed_from[i], t);
    store<Float>(&lanes.passed_to[i], out);
    store<Uint>(&lanes.passed_place[i], load<Uint>(&lanes.place[i]));
  }

  // On to the next cell.
  Int place = reinterpret_cast<Int>(load<Uint>(&lanes.place[i])), beyond{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Int crossed = exits[axis] <= first;
    const Int cell = load<Int>(&lanes.cell[axis][i]) + (load<Int>(&lanes.stride[axis][i]) & crossed);
    store<Int>(&lanes.cell[axis][i], cell);
    beyond |= cell;
    place += load<Int>(&lanes.place_stride[axis][i]) & crossed;
    const Int per_cell = reinterpret_cast<Int>(load<Float>(&lanes.exits_per_cell[axis][i]));
    store<Float>(&lanes.exits[axis][i], exits[axis] + reinterpret_cast<Float>(per_cell & crossed));
  }
  store<Uint>(&lanes.place[i], reinterpret_cast<Uint>(place));
  const Float now = out > t ? out : t;
  store<Float>(&lanes.t[i], now);
  step.stopped |= bits_of_lanes<Int>(((beyond & ~7) != 0) | (now >= ray_length)) << i;
  step.special |= special_bits << i;
}

template <typename Wide>
BRUME_INLINE PacketStep step_all(PacketLanes& lanes) {
  CellsHere cells;
  read_cells(lanes, cells);
  PacketStep step{};
  for (std::size_t i = 0; i < kPacketLanes; i += sizeof(typename Wide::Float) / 4)
    step_lanes<Wide>(lanes, cells, i, step);
  return step;
}

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

PacketStep step_packet_4(PacketLanes& lanes) {
  return step_all<Wide4>(lanes);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] PacketStep step_packet_8(PacketLanes& lanes) {
  return step_all<Wide8>(lanes);
}
#endif

StepPacket fastest_step() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) return step_packet_8;
#endif
  return step_packet_4;
}

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
  lanes_.entries[lane] = volume_.entries(bricks.slot);
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
    sum.add_boundary(volume_.boundary_cell(rays_[lane].bricks.slot, place >> 16, entry), at, from, to);
  } else {
    const TexelRows rows(lanes_.texels[lane] + (place & 0xffffu));
    if (rows.empty()) return;
    sum.add(rows.corners(), at, from, to);
  }
  for (std::size_t part = 0; part < 4; ++part) lanes_.total[part][lane] = sum.total[part];
  lanes_.next_hole[lane] = sum.next_hole();
}

}  // namespace brume::smoke

#undef BRUME_INLINE
