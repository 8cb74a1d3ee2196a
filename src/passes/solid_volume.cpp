#include "passes/solid_volume.hpp"

#include <algorithm>

#include "voxel/coarse_solid.hpp"

namespace brume::passes {
namespace {

constexpr std::uint8_t kFreeTexel = 255;

/// A box around the voxels where two lists of edits differ.
Box<int> difference_of(const sim::EditBlocks& a, const sim::EditBlocks& b) {
  Box<int> box{glm::ivec3(1 << 24), glm::ivec3(-(1 << 24))};
  const auto add = [&](const sim::EditBlock& block) {
    const glm::ivec3 low = glm::ivec3(block.at) * sim::kBlockSize;
    box.low = glm::min(box.low, low);
    box.high = glm::max(box.high, low + sim::kBlockSize);
  };
  for (const auto& [one, other] : {std::pair(&a, &b), std::pair(&b, &a)})
    for (const sim::EditBlock& block : *one) {
      const auto found = std::find(other->begin(), other->end(), block);
      if (found == other->end()) add(block);
    }
  return box;
}

}  // namespace

SolidVolume::SolidVolume(gpu::Context& context) : context_(context) {
  make({glm::ivec3(1), 1.0f, glm::vec3(0)});
  grid_layout_ = {};  // no level's
}

void SolidVolume::make(const voxel::GridLayout& grid) {
  const int voxels_per_texel = voxel::coarse_edge(grid.size, kMaxSolidTexels, kMaxSolidAxis);
  const glm::ivec3 size = voxel::coarse_size(grid.size, voxels_per_texel);
  const auto words = static_cast<std::size_t>(shared::solid_row_words(size.x) * size.y * size.z);
  std::vector<std::uint32_t> bits(words, 0);

  gpu::Image texels(
      context_, gpu::sampled_image_3d(glm::uvec3(size), VK_FORMAT_R8_UNORM, VK_IMAGE_USAGE_TRANSFER_SRC_BIT));
  gpu::Buffer buffer(context_, words * sizeof(std::uint32_t),
                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                         VK_BUFFER_USAGE_TRANSFER_SRC_BIT);

  // All or nothing: where memory was refused, another try makes all of it.
  texels_ = std::move(texels);
  words_ = std::move(buffer);
  bits_ = std::move(bits);
  grid_layout_ = grid;
  voxels_per_texel_ = voxels_per_texel;
  frame_.origin_world = grid.origin_world;
  frame_.texel_size = grid.voxel_size * static_cast<float>(voxels_per_texel);
  frame_.size = size;
  invalidate();
}

void SolidVolume::reserve(const LevelView& level) {
  if (level.grid && !(level.grid->layout() == grid_layout_)) make(level.grid->layout());
}

void SolidVolume::invalidate() {
  Held& held = held_.change(context_);
  held.edits = nullptr;
  held.everything = true;
}

bool SolidVolume::record(gpu::Recorder& recorder, const LevelView& level) {
  Box<int> changed{glm::ivec3(0), frame_.size};
  const bool is_lost = held_.is_dropped(context_);  // the bits are of a record that was dropped
  Held& held = recorder.change(held_);
  held.everything |= is_lost || (level.grid != nullptr) != held.has_grid;
  held.has_grid = level.grid != nullptr;
  if (!held.everything) {
    if (!level.grid || level.edits == held.edits) return false;
    static const sim::EditBlocks none;
    const Box<int> voxels = difference_of(held.edits ? *held.edits : none, level.edits ? *level.edits : none);
    if (voxels.empty()) return false;
    changed = intersection(
        changed, {voxels.low / voxels_per_texel_, voxel::coarse_size(voxels.high, voxels_per_texel_)});
  }
  if (level.grid)
    fill_bits(*level.light_grid(), changed);
  else
    std::ranges::fill(bits_, 0u);
  upload(recorder, changed);
  held.everything = false;
  held.edits = level.edits;
  return true;
}

void SolidVolume::fill_bits(const voxel::BitGrid& grid, const Box<int>& texels) {
  const int row_words = shared::solid_row_words(frame_.size.x);
  const std::vector<bool> solid = voxel::coarse_solid(grid, voxels_per_texel_, texels);
  auto next = solid.begin();
  for_each_in(texels, [&](glm::ivec3 t) {
    std::uint32_t& word = bits_[static_cast<std::size_t>(t.x / 32 + row_words * (t.y + frame_.size.y * t.z))];
    const std::uint32_t bit = 1u << (t.x % 32);
    word = *next++ ? word | bit : word & ~bit;
  });
}

void SolidVolume::upload(gpu::Recorder& recorder, const Box<int>& texels) const {
  const int row_words = shared::solid_row_words(frame_.size.x);
  std::vector<std::uint8_t> bytes;
  for_each_in(texels, [&](glm::ivec3 t) {
    const std::uint32_t word =
        bits_[static_cast<std::size_t>(t.x / 32 + row_words * (t.y + frame_.size.y * t.z))];
    bytes.push_back(word >> (t.x % 32) & 1 ? 0 : kFreeTexel);
  });
  const gpu::Recorder::Region region{std::as_bytes(std::span(bytes)), texels.low,
                                     glm::uvec3(texels.high - texels.low)};
  recorder.upload(texels_, {&region, 1});

  // Words lie slice by slice.
  const auto slice = static_cast<std::size_t>(row_words * frame_.size.y);
  const std::size_t first = slice * static_cast<std::size_t>(texels.low.z),
                    count = slice * static_cast<std::size_t>(texels.high.z - texels.low.z);
  recorder.upload(words_, first * sizeof(std::uint32_t),
                  std::as_bytes(std::span(bits_).subspan(first, count)));
}

}  // namespace brume::passes
