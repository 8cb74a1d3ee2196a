#include "smoke/cell_forms.hpp"

#include <algorithm>
#include <cstring>

namespace brume::smoke {
namespace {

/// The 3x3x3 voxels around each corner of the cell.
constexpr std::array<Neighbourhood64, 8> neighbourhoods_of_corners() {
  std::array<Neighbourhood64, 8> around{};
  for (int corner = 0; corner < 8; ++corner)
    for (int i = 0; i < 27; ++i) {
      const int x = (corner & 1) + i % 3, y = (corner >> 1 & 1) + i / 3 % 3, z = (corner >> 2) + i / 9;
      around[static_cast<std::size_t>(corner)] |= Neighbourhood64{1} << (x + 4 * y + 16 * z);
    }
  return around;
}
constexpr auto kAroundCorner = neighbourhoods_of_corners();

/// For each corner the weight of each voxel by its distance: 144 / distance^2, whole numbers that fit 8 bits.
/// The corner itself counts where it is not on the side in question.
constexpr std::array<std::array<std::uint8_t, 64>, 8> weights_of_corners() {
  std::array<std::array<std::uint8_t, 64>, 8> weights{};
  for (int corner = 0; corner < 8; ++corner)
    for (int bit = 0; bit < 64; ++bit) {
      const int x = (bit & 3) - (corner & 1) - 1, y = (bit >> 2 & 3) - (corner >> 1 & 1) - 1,
                z = (bit >> 4) - (corner >> 2) - 1;
      const int square = x * x + y * y + z * z;
      weights[static_cast<std::size_t>(corner)][static_cast<std::size_t>(bit)] =
          static_cast<std::uint8_t>(square == 0 ? 1 : 144 / square);
    }
  return weights;
}
constexpr auto kCornerWeights = weights_of_corners();

/// What the corners take from on one side: themselves where they are on it, else the nearest voxels that are
/// visible from this side of the cell.
FormSide form_side(Neighbourhood64 own_side, Neighbourhood64 visible) {
  FormSide side;
  side.visible = visible;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const Neighbourhood64 itself = neighbour_bit(corner_offset(static_cast<int>(corner)) + 1);
    const Neighbourhood64 near = visible & kAroundCorner[corner];
    side.from[corner] = (own_side & itself) != 0 ? itself : near != 0 ? near : visible;
    for (Neighbourhood64 bits = side.from[corner]; bits != 0; bits &= bits - 1)
      side.total[corner] = static_cast<std::uint16_t>(
          side.total[corner] + kCornerWeights[corner][static_cast<std::size_t>(std::countr_zero(bits))]);
  }
  return side;
}

/// The bytes that are not 0, a bit each.
Neighbourhood64 bytes_set(const CellDensities& bytes) {
  constexpr std::uint64_t kLow7 = 0x7f7f7f7f7f7f7f7fu;
  Neighbourhood64 set = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    std::uint64_t eight;
    std::memcpy(&eight, bytes.data() + 8 * i, 8);
    // The top bit of each byte, then those bits next to each other.
    const std::uint64_t any = (((eight & kLow7) + kLow7) | eight) & ~kLow7;
    set |= ((any >> 7) * 0x0102040810204080u >> 56) << (8 * i);
  }
  return set;
}

/// The density of a corner.
std::uint32_t corner_density(const FormSide& side, std::size_t corner, const CellDensities& densities,
                             Neighbourhood64 smoky, Neighbourhood64 full) {
  const Neighbourhood64 from = side.from[corner];
  if ((from & smoky) == 0) return 0;
  if ((from & ~full) == 0) return 255;
  std::uint32_t sum = side.total[corner] / 2u;
  for (Neighbourhood64 bits = from & smoky; bits != 0; bits &= bits - 1) {
    const auto bit = static_cast<std::size_t>(std::countr_zero(bits));
    sum += std::uint32_t{kCornerWeights[corner][bit]} * densities[bit];
  }
  return sum / side.total[corner];
}

}  // namespace

void CellFormer::move_to(glm::ivec3 brick) {
  planes_.move_to(8 * brick - 1);
}

/// The voxels of `among` in pockets that smoke never enters.
Neighbourhood64 CellFormer::sealed_voxels(const CellSurroundings& cell, Neighbourhood64 among,
                                          const Sealed& sealed) {
  Neighbourhood64 result = 0;
  for (Neighbourhood64 bits = among; bits != 0; bits &= bits - 1) {
    const int bit = std::countr_zero(bits);
    if (sealed(cell.cell - 1 + neighbour_offset(bit))) result |= Neighbourhood64{1} << bit;
  }
  return result;
}

/// How far to move a plane along its normal so that smoke on one side of it reaches the surface everywhere in
/// the cell [voxels]. Only where there are nothing but sealed pockets behind it: the excess ends inside of
/// them. 0 where there is air on both sides.
float CellFormer::distance_to_surface(int plane, const std::array<Neighbourhood64, 8>& visible,
                                      Neighbourhood64 smoke, Neighbourhood64 sealed) const {
  const float deviation = sight_.deviation(plane);
  for (const int behind : {0, 1}) {
    bool fits = true, any_smoke = false, any_sealed = false;
    for (int side = 0; side < sight_.side_count(); ++side) {
      if ((side >> plane & 1) != behind) continue;
      const Neighbourhood64 from_side = visible[static_cast<std::size_t>(side)];
      const Neighbourhood64 smoke_before = visible[static_cast<std::size_t>(side ^ 1 << plane)] & smoke;
      any_smoke |= smoke_before != 0;
      any_sealed |= (from_side & ~sealed) == 0;
      // Air on both sides may only be the same air: the plane ends there.
      if ((from_side & ~sealed) != 0) fits &= smoke_before == 0 || (smoke_before & from_side) != 0;
    }
    if (fits && any_smoke && any_sealed) return behind == 1 ? deviation : -deviation;
  }
  return 0;
}

/// Where a surface bends, a piece of it that barely enters the cell, and the pieces of the cells around it,
/// may hide all smoke from the sliver before it: then the planes of the cell alone decide. And smoke has to
/// reach the surface though that lies off its plane.
void CellFormer::reach_bent_surfaces(const CellSurroundings& cell, const Sealed& sealed_voxel,
                                     std::array<Neighbourhood64, 8>& visible, CellForm& form) {
  for (int plane = 0; plane < sight_.plane_count(); ++plane) form.bent |= sight_.deviation(plane) > 0;
  if (!form.bent) return;

  // Slivers from which nothing is visible but sealed pockets.
  Neighbourhood64 all = 0;
  for (const Neighbourhood64 from_side : visible) all |= from_side;
  const Neighbourhood64 sealed = sealed_voxels(cell, all & ~cell.smoke, sealed_voxel);
  if ((all & ~sealed) == 0)
    for (int side = 0; side < sight_.side_count(); ++side) {
      Neighbourhood64& from_side = visible[static_cast<std::size_t>(side)];
      if (from_side == 0) from_side = sight_.on_side(side, cell.smoke);
    }

  // Planes that lie off their surface.
  for (int plane = 0; plane < sight_.plane_count(); ++plane) {
    const float distance = distance_to_surface(plane, visible, cell.smoke, sealed);
    if (distance != 0) form.planes[static_cast<std::size_t>(plane)] = sight_.moved_plane(plane, distance);
  }
}

CellForm CellFormer::form(const CellSurroundings& cell, const Sealed& sealed) {
  sight_.look_at(cell.cell);
  CellForm form;
  form.planes = {sight_.record().plane0, sight_.record().plane1, sight_.record().plane2};
  form.side_count = sight_.side_count();

  // What is visible from each side of the cell's planes.
  std::array<Neighbourhood64, 8> visible{};
  for (int side = 0; side < form.side_count; ++side)
    visible[static_cast<std::size_t>(side)] = sight_.visible(side, cell.free);
  reach_bent_surfaces(cell, sealed, visible, form);
  for (int side = 0; side < form.side_count; ++side)
    form.sides[static_cast<std::size_t>(side)] =
        form_side(sight_.on_side(side, cell.free), visible[static_cast<std::size_t>(side)]);
  return form;
}

std::uint32_t CellForms::number_of(const CellForm& form) {
  Stored stored{form.planes, static_cast<std::uint16_t>(form.side_count), form.bent, 0, {}};
  for (std::size_t side = 0; side < static_cast<std::size_t>(form.side_count); ++side) {
    stored.sides[side] = sides_.number_of(form.sides[side]);
    stored.hidden |= std::uint32_t{form.sides[side].visible == 0} << side;
  }
  return forms_.number_of(stored);
}

void CellForms::clear() {
  forms_.clear();
  sides_.clear();
}

/// The side that a side takes its densities from when no air is visible from it: it is then inside of
/// something solid and never on screen; it continues the side fewest planes away from which most smoke is
/// visible, so that smoke reaches a curved surface also where that bulges through its plane.
int CellForms::side_to_follow(const Stored& form, int side, Neighbourhood64 smoke) const {
  int best = side, best_rank = -1;
  for (int other = 0; other < form.side_count; ++other) {
    if ((form.hidden >> other & 1) != 0) continue;
    const int planes_between = std::popcount(static_cast<unsigned>(side ^ other));
    const Neighbourhood64 visible = sides_[form.sides[static_cast<std::size_t>(other)]].visible;
    const int rank = 65 * (3 - planes_between) + std::popcount(visible & smoke);
    if (rank <= best_rank) continue;
    best = other;
    best_rank = rank;
  }
  return best;
}

std::span<const glm::uvec2> CellForms::corner_sets(std::uint32_t number, const CellDensities& densities,
                                                   Neighbourhood64 smoke) {
  const Stored& form = forms_[number];
  const auto count = std::size_t{form.side_count};
  const Neighbourhood64 smoky = bytes_set(densities);
  if (smoky == 0) {
    sets_ = {};
    return std::span(sets_).first(count);
  }
  CellDensities inverse;
  for (std::size_t i = 0; i < 64; ++i) inverse[i] = static_cast<std::uint8_t>(~densities[i]);
  const Neighbourhood64 full = ~bytes_set(inverse);

  // Sides from which something is visible, and one that has nothing to follow.
  const bool all_hidden = form.hidden == (1u << count) - 1;
  for (std::size_t i = 0; i < count; ++i) {
    if ((form.hidden >> i & 1) != 0 && !all_hidden) continue;
    const FormSide& side = sides_[form.sides[i]];
    const auto density = [&](std::size_t corner) {
      return corner_density(side, corner, densities, smoky, full);
    };
    sets_[i] = {density(0) | density(1) << 8 | density(2) << 16 | density(3) << 24,
                density(4) | density(5) << 8 | density(6) << 16 | density(7) << 24};
  }
  // The others.
  for (std::uint32_t bits = all_hidden ? 0 : form.hidden; bits != 0; bits &= bits - 1) {
    const int side = std::countr_zero(bits);
    sets_[static_cast<std::size_t>(side)] =
        sets_[static_cast<std::size_t>(side_to_follow(form, side, smoke))];
  }
  return std::span(sets_).first(count);
}

}  // namespace brume::smoke
