#include "grids/mask_bricks.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <optional>

#include "core/tasks.hpp"

namespace brume::grids {
namespace {

/// Values of a grid by their index; remembers the brick of the last one.
class MaskValues {
 public:
  explicit MaskValues(const Grid& grid) : grid_(&grid) {}

  float at(glm::ivec3 index) {
    const glm::ivec3 origin = (index >> 3) * 8;
    if (!brick_ || origin != origin_) {
      brick_ = find_brick(*grid_, origin).value_or(grid_->bricks.size());
      origin_ = origin;
    }
    if (*brick_ == grid_->bricks.size()) return of_tile(index);
    const glm::ivec3 in = index & 7;
    const auto voxel = static_cast<std::size_t>(in.x + 8 * (in.y + 8 * in.z));
    return number(grid_->values_of(*brick_).data() + voxel * bytes_of(grid_->type));
  }

 private:
  /// A number that half floats hold; NaN is 0.
  float number(const std::byte* value) const {
    const double number = to_number(grid_->type, value);
    return number > 0 ? static_cast<float>(std::min(number, 65504.0)) : 0.0f;
  }
  float of_tile(glm::ivec3 index) const {
    for (const Tile& tile : grid_->tiles)
      if (glm::all(glm::greaterThanEqual(index, tile.origin)) &&
          glm::all(glm::lessThan(index, tile.origin + static_cast<int>(tile.edge))))
        return number(tile.value.data());
    return 0;
  }

  const Grid* grid_;
  glm::ivec3 origin_{0};
  std::optional<std::size_t> brick_;  // its number; the number of all bricks: none
};

/// The values at a point of index space, linear between voxel centres.
float value_at(MaskValues& values, const glm::dvec3& p_index) {
  const glm::dvec3 low = glm::floor(p_index);
  if (!may_hold(low)) return 0;
  const glm::vec3 weight(p_index - low);
  float sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
    const glm::vec3 w = glm::mix(1.0f - weight, weight, glm::vec3(side));
    const float product = w.x * w.y * w.z;
    if (product > 0) sum += product * values.at(glm::ivec3(low) + side);
  }
  return sum;
}

glm::vec4 masks_at(std::vector<MaskValues>& masks, const glm::dvec3& p_index) {
  glm::vec4 four(0);
  for (std::size_t i = 0; i < masks.size(); ++i) four[static_cast<int>(i)] = value_at(masks[i], p_index);
  return four;
}

constexpr volume::ChannelId kMasks{0};

template <typename Texels, typename Function>
void fill(Texels texels, Function texel_at) {
  for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = texel_at(i);
}

}  // namespace

Result<Grid> joined_masks(std::span<const Grid* const> masks) {
  const Grid& first = *masks.front();
  // Masks must share their voxels, so that a brick of one is a brick of all.
  std::vector<glm::ivec3> origins;
  for (const Grid* mask : masks) {
    if (mask->type != ValueType::float32 && mask->type != ValueType::float64)
      return Failure{ErrorCode::bad_input, "grid " + mask->name + ": holds values of " + name_of(mask->type) +
                                               "; expected a mask of float32 or float64"};
    if (mask->world_from_index != first.world_from_index)
      return Failure{ErrorCode::bad_input, "grid " + mask->name +
                                               ": its voxels are not where those of grid " + first.name +
                                               " are; bake the masks into one file"};
    for (const Brick& brick : mask->bricks) origins.push_back(brick.origin);
    if (std::ranges::any_of(mask->tiles, [](const Tile& tile) { return tile.active; }))
      return Failure{ErrorCode::bad_input,
                     "grid " + mask->name + ": has tiles; bake it with brume bake slices"};
  }
  std::ranges::sort(origins, goes_before);
  origins.erase(std::unique(origins.begin(), origins.end()), origins.end());

  // The largest value counts: the joined grid says where anything is masked.
  Grid joined;
  joined.name = "masks";
  joined.grid_class = GridClass::fog_volume;
  joined.world_from_index = first.world_from_index;
  std::vector<MaskValues> values(masks.size(), MaskValues(first));
  for (std::size_t i = 0; i < masks.size(); ++i) values[i] = MaskValues(*masks[i]);
  for (const glm::ivec3 origin : origins) {
    Brick brick{origin};
    std::array<float, kBrickVoxels> most{};
    for (int voxel = 0; voxel < int{kBrickVoxels}; ++voxel) {
      const auto i = static_cast<std::size_t>(voxel);
      for (MaskValues& mask : values)
        most[i] = std::max(most[i], mask.at(origin + glm::ivec3(voxel % 8, voxel / 8 % 8, voxel / 64)));
      if (most[i] > 0) brick.active[i / 64] |= std::uint64_t{1} << (i % 64);
    }
    joined.bricks.push_back(brick);
    const auto bytes = std::as_bytes(std::span(most));
    joined.values.insert(joined.values.end(), bytes.begin(), bytes.end());
  }
  return joined;
}

std::unique_ptr<volume::SparseVolume> make_mask_bricks(std::span<const Grid* const> masks,
                                                       const BrickVolume& volume) {
  BRUME_ASSERT(!masks.empty() && masks.size() <= kMostMaskGrids, std::to_string(masks.size()));
  const glm::dmat4 index_from_voxel = glm::inverse(masks.front()->world_from_index) * volume.world_from_voxel;
  // Two masks fit into half the bytes of four.
  volume::SparseVolumeInfo info;
  const bool is_pair = masks.size() <= 2;
  info.channels = {{is_pair ? 4u : 8u}};
  auto bricks = std::make_unique<volume::SparseVolume>(info);
  const std::uint32_t slots = volume.volume->slot_count();
  bricks->begin_update();
  // The same bricks as the density: a sample reads both at one place.
  for (std::uint32_t slot = 0; slot < slots; ++slot) bricks->acquire(volume.volume->brick_of(slot));
  parallel_for(slots, 16, [&](std::size_t begin, std::size_t end) {
    std::vector<MaskValues> values;
    for (const Grid* mask : masks) values.emplace_back(*mask);
    for (std::size_t i = begin; i < end; ++i) {
      const auto slot = static_cast<std::uint32_t>(i);
      const glm::ivec3 first = 8 * volume.volume->brick_of(slot) - 1;
      const auto masks_of = [&](std::size_t texel) {
        const glm::ivec3 at =
            first + glm::ivec3(static_cast<int>(texel) % 10, static_cast<int>(texel) / 10 % 10,
                               static_cast<int>(texel) / 100);
        return masks_at(values, glm::dvec3(index_from_voxel * glm::dvec4(glm::dvec3(at) + 0.5, 1)));
      };
      if (is_pair)
        fill(bricks->texels<std::uint32_t>(kMasks, slot),
             [&](std::size_t texel) { return glm::packHalf2x16(glm::vec2(masks_of(texel))); });
      else
        fill(bricks->texels<std::uint64_t>(kMasks, slot),
             [&](std::size_t texel) { return glm::packHalf4x16(masks_of(texel)); });
    }
  });
  bricks->set_bounds(volume.volume->layout().bounds_min, volume.volume->layout().bounds_max);
  bricks->end_update();
  return bricks;
}

}  // namespace brume::grids
