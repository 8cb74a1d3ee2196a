#include "grids/color_bricks.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>

#include "core/tasks.hpp"
#include "grids/grid.hpp"

namespace brume::grids {
namespace {

/// Voxels whose centres are off by rounding alone count as they are.
constexpr double kLeastWeight = 1e-4;

/// To [0, 1]; NaN is 0.
glm::vec3 limited(glm::dvec3 color) {
  for (int i = 0; i < 3; ++i) color[i] = color[i] > 0 ? std::min(color[i], 1.0) : 0.0;
  return glm::vec3(color);
}

glm::vec3 read_color(ValueType type, const std::byte* at) {
  glm::dvec3 color(0);
  if (type == ValueType::vec3d) {
    std::memcpy(&color, at, sizeof color);
  } else {
    glm::vec3 narrow;
    std::memcpy(&narrow, at, sizeof narrow);
    color = glm::dvec3(narrow);
  }
  return limited(color);
}

/// Looks up voxels of a grid; remembers the brick of the last one.
class Lookup {
 public:
  explicit Lookup(const Grid& grid) : grid_(&grid) {}
  const Grid& grid() const { return *grid_; }

  /// The value of an active voxel; null: it is not active.
  const std::byte* at(glm::ivec3 index) {
    const glm::ivec3 origin = (index >> 3) * 8;
    if (!known_ || origin != origin_) {
      brick_ = find_brick(*grid_, origin).value_or(grid_->bricks.size());
      origin_ = origin;
      known_ = true;
    }
    if (brick_ == grid_->bricks.size()) return of_tile(index);
    const glm::ivec3 in = index & 7;
    const auto voxel = static_cast<std::size_t>(in.x + 8 * (in.y + 8 * in.z));
    if (!grid_->bricks[brick_].is_active(voxel)) return nullptr;
    return grid_->values_of(brick_).data() + voxel * bytes_of(grid_->type);
  }

 private:
  const std::byte* of_tile(glm::ivec3 index) const {
    if (grid_->tiles.empty()) return nullptr;
    for (const int edge : {8, 128, 4096}) {
      const glm::ivec3 origin = index & ~(edge - 1);
      const auto tile =
          std::lower_bound(grid_->tiles.begin(), grid_->tiles.end(), origin,
                           [](const Tile& one, glm::ivec3 at) { return goes_before(one.origin, at); });
      if (tile == grid_->tiles.end() || tile->origin != origin || int(tile->edge) != edge) continue;
      return tile->active ? tile->value.data() : nullptr;
    }
    return nullptr;
  }

  const Grid* grid_;
  glm::ivec3 origin_{0};
  std::size_t brick_ = 0;  // its number; the number of all bricks: none
  bool known_ = false;
};

/// The colours of a grid of vectors.
class VectorColors {
 public:
  explicit VectorColors(const Grid& grid) : lookup_(grid) {}
  /// nullopt: the voxel has none.
  std::optional<glm::vec3> at(glm::ivec3 index) {
    const std::byte* const value = lookup_.at(index);
    return value ? std::optional(read_color(lookup_.grid().type, value)) : std::nullopt;
  }

 private:
  Lookup lookup_;
};

/// Colours of a grid for each channel, at the voxels of the first.
class ChannelColors {
 public:
  explicit ChannelColors(const ColorChannels& channels) : first_(channels.parts[0]->world_from_index) {
    for (const Grid* part : channels.parts) parts_.emplace_back(*part);
    if (channels.density) parts_.emplace_back(*channels.density);
  }

  std::optional<glm::vec3> at(glm::ivec3 index) {
    bool is_active = false;
    glm::dvec4 sums(0);
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const auto value = value_at(parts_[i], index);
      is_active = is_active || value;
      sums[static_cast<int>(i)] = value.value_or(0);
    }
    if (!is_active || (parts_.size() > 3 && !(sums.w > 0))) return std::nullopt;
    const glm::dvec3 color = parts_.size() > 3 ? glm::dvec3(sums) / sums.w : glm::dvec3(sums);
    return limited(color);
  }

 private:
  /// The value of one channel where the first has this voxel; nullopt: no voxel around it is active.
  std::optional<double> value_at(Lookup& part, glm::ivec3 index) const {
    const Grid& grid = part.grid();
    if (grid.world_from_index == first_) {
      const std::byte* const value = part.at(index);
      return value ? std::optional(to_number(grid.type, value)) : std::nullopt;
    }
    const glm::dvec3 p(glm::inverse(grid.world_from_index) * (first_ * glm::dvec4(index, 1)));
    const glm::dvec3 low = glm::floor(p + kLeastWeight), weight = glm::clamp(p - low, 0.0, 1.0);
    std::optional<double> sum;
    if (!may_hold(low)) return sum;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::ivec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
      const glm::dvec3 w = glm::mix(1.0 - weight, weight, glm::dvec3(side));
      const double product = w.x * w.y * w.z;
      if (!(product > kLeastWeight)) continue;
      if (const std::byte* const value = part.at(glm::ivec3(low) + side))
        sum = sum.value_or(0) + product * to_number(grid.type, value);
    }
    return sum;
  }

  glm::dmat4 first_;
  std::vector<Lookup> parts_;  // red, green, blue, and what they are multiplied by
};

/// The mean of colours by weight.
class Mean {
 public:
  void add(const std::optional<glm::vec3>& color, float weight) {
    if (!color || weight <= 0) return;
    sum_ += weight * *color;
    weight_ += weight;
  }
  bool empty() const { return weight_ <= 0; }
  glm::vec3 color() const { return sum_ / weight_; }

 private:
  glm::vec3 sum_{0};
  float weight_ = 0;
};

/// The colour at a point of index space.
template <typename Colors>
glm::vec3 color_at(Colors& lookup, glm::dvec3 p_index) {
  const glm::dvec3 low = glm::floor(p_index + kLeastWeight);
  if (!may_hold(low)) return glm::vec3(1);
  const glm::vec3 weight(glm::clamp(p_index - low, 0.0, 1.0));
  Mean filtered, around;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
    const glm::vec3 w = glm::mix(1.0f - weight, weight, glm::vec3(side));
    const float product = w.x * w.y * w.z;
    if (product > static_cast<float>(kLeastWeight)) filtered.add(lookup.at(glm::ivec3(low) + side), product);
  }
  if (!filtered.empty()) return filtered.color();
  for (int n = 0; n < 27; ++n)
    around.add(lookup.at(glm::ivec3(glm::round(p_index)) + glm::ivec3(n % 3, n / 3 % 3, n / 9) - 1), 1);
  return around.empty() ? glm::vec3(1) : around.color();
}

/// The colours at the centres of a volume's voxels, in the same bricks and slots. `grid` holds the transform.
template <typename Colors, typename Source>
Result<std::unique_ptr<volume::SparseVolume>> make_bricks(const Source& source, const Grid& grid,
                                                          const BrickVolume& volume) {
  const glm::dmat4 index_from_voxel = glm::inverse(grid.world_from_index) * volume.world_from_voxel;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!std::isfinite(index_from_voxel[column][row]))
        return Failure{ErrorCode::bad_input, "grid " + grid.name + ": its transform has no inverse"};

  volume::SparseVolumeInfo info;
  info.channels = {{sizeof(std::uint64_t)}};
  auto bricks = std::make_unique<volume::SparseVolume>(info);
  const volume::ChannelId channel{0};
  const std::uint32_t slots = volume.volume->slot_count();
  bricks->begin_update();
  // The same bricks as the density: a sample reads both at one place.
  for (std::uint32_t slot = 0; slot < slots; ++slot) bricks->acquire(volume.volume->brick_of(slot));
  parallel_for(slots, 16, [&](std::size_t begin, std::size_t end) {
    Colors lookup(source);
    for (std::size_t slot = begin; slot < end; ++slot) {
      const auto texels = bricks->texels<std::uint64_t>(channel, static_cast<std::uint32_t>(slot));
      const glm::ivec3 first = 8 * volume.volume->brick_of(static_cast<std::uint32_t>(slot)) - 1;
      for (int i = 0; i < int{shared::kTexelsPerBrick}; ++i) {
        const glm::dvec3 p_voxel = glm::dvec3(first + glm::ivec3(i % 10, i / 10 % 10, i / 100)) + 0.5;
        const glm::vec3 color = color_at(lookup, glm::dvec3(index_from_voxel * glm::dvec4(p_voxel, 1)));
        texels[static_cast<std::size_t>(i)] = glm::packHalf4x16(glm::vec4(color, 1));
      }
    }
  });
  bricks->set_bounds(volume.volume->layout().bounds_min, volume.volume->layout().bounds_max);
  bricks->end_update();
  return bricks;
}

}  // namespace

bool are_multiplied(const std::array<const Grid*, 3>& parts, const Grid& density) {
  for (const Grid* part : parts)
    if (part->world_from_index != density.world_from_index) return false;
  std::array<Lookup, 3> channels{Lookup(*parts[0]), Lookup(*parts[1]), Lookup(*parts[2])};
  const auto brightest_at = [&](glm::ivec3 index) {
    double brightest = 0;
    for (Lookup& channel : channels)
      if (const std::byte* const value = channel.at(index))
        brightest = std::max(brightest, to_number(channel.grid().type, value));
    return brightest;
  };
  // Sums of the density and of the brightest channel, where the density is below its mean and above.
  struct Sums {
    double density = 0, color = 0, voxels = 0;
  };
  const auto each = [&](const auto& use) {
    return for_each_active(density, [&](const ActiveValue& active) {
      const double value = to_number(density.type, active.value);
      return !(value > 0) || active.edge > 1 || use(value, brightest_at(active.low));
    });
  };
  Sums all;
  constexpr double kSlack = 1.01;
  if (!each([&](double value, double color) {
        all = {all.density + value, all.color + color, all.voxels + 1};
        return color <= kSlack * value;
      }))
    return false;
  const double mean = all.density / std::max(all.voxels, 1.0);
  Sums sums[2];
  each([&](double value, double color) {
    Sums& side = sums[value > mean];
    side = {side.density + value, side.color + color, side.voxels + 1};
    return true;
  });
  const auto& [low, high] = sums;
  if (!(low.color > 0 && high.color > 0)) return false;
  // Colours of their own do not fall with the density, multiplied ones do as much.
  const double per_density = (low.color / low.density) / (high.color / high.density);
  const double fall = (high.density / high.voxels) / (low.density / low.voxels);
  return per_density < std::sqrt(fall);
}

bool is_color_grid(const Grid& grid) {
  return grid.type == ValueType::vec3f || grid.type == ValueType::vec3d;
}

Result<std::unique_ptr<volume::SparseVolume>> make_color_bricks(const Grid& colors,
                                                                const BrickVolume& volume) {
  if (!is_color_grid(colors))
    return Failure{ErrorCode::bad_input, "grid " + colors.name + ": holds values of " + name_of(colors.type) +
                                             "; expected colours, which are vec3f or vec3d"};
  return make_bricks<VectorColors>(colors, colors, volume);
}

Result<std::unique_ptr<volume::SparseVolume>> make_color_bricks(const ColorChannels& channels,
                                                                const BrickVolume& volume) {
  for (const Grid* part : channels.parts)
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 4; ++row)
        if (!std::isfinite(glm::inverse(part->world_from_index)[column][row]))
          return Failure{ErrorCode::bad_input, "grid " + part->name + ": its transform has no inverse"};
  return make_bricks<ChannelColors>(channels, *channels.parts[0], volume);
}

}  // namespace brume::grids
