#include "smoke/mask_atlas.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <optional>
#include <string>

#include "core/hash.hpp"
#include "core/row_packer.hpp"

namespace brume::smoke {
namespace {

constexpr std::uint32_t kPad = 1;  // texels around each image
static_assert(kMaxMaskAxis + 2 * kPad == kMaxMaskAtlasAxis);

struct Layout {
  std::uint32_t width = 0, height = 0;
  std::vector<glm::uvec2> corners;  // where the images begin, without their padding
};

/// Rows of images, the highest first, in an atlas of this width.
std::optional<Layout> lay_out(std::span<const Mask> masks, std::span<const std::uint32_t> by_height,
                              std::uint32_t width) {
  Layout layout{width, 0, std::vector<glm::uvec2>(masks.size())};
  RowPacker packer({width, kMaxMaskAtlasAxis});
  for (const std::uint32_t i : by_height) {
    const auto low = packer.place({masks[i].width + 2 * kPad, masks[i].height + 2 * kPad});
    if (!low) return std::nullopt;
    layout.corners[i] = *low + kPad;
  }
  layout.height = std::bit_ceil(packer.height());
  return layout;
}

/// The smallest atlas; of two equally small, the narrower.
std::optional<Layout> best_layout(std::span<const Mask> masks) {
  std::vector<std::uint32_t> by_height(masks.size());
  std::iota(by_height.begin(), by_height.end(), 0u);
  std::stable_sort(by_height.begin(), by_height.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return masks[a].height > masks[b].height; });
  std::optional<Layout> best;
  for (std::uint32_t width = 4; width <= kMaxMaskAtlasAxis; width *= 2) {
    auto layout = lay_out(masks, by_height, width);
    if (!layout) continue;
    if (!best || std::uint64_t{width} * layout->height < std::uint64_t{best->width} * best->height)
      best = std::move(layout);
  }
  return best;
}

Result<void> check(std::span<const Mask> masks) {
  if (masks.size() > sim::kMaxMasks)
    return Failure{ErrorCode::resource_limit,
                   "masks: " + std::to_string(masks.size()) + ", at most " + std::to_string(sim::kMaxMasks)};
  for (const Mask& mask : masks) {
    const std::uint64_t texels = std::uint64_t{mask.width} * mask.height;
    if (texels == 0 || texels != mask.texels.size())
      return Failure{ErrorCode::bad_input, "masks: expected width x height texels, not none"};
    if (std::max(mask.width, mask.height) > kMaxMaskAxis)
      return Failure{ErrorCode::resource_limit, "masks: one of " + std::to_string(mask.width) + " x " +
                                                    std::to_string(mask.height) + " texels, at most " +
                                                    std::to_string(kMaxMaskAxis) + " an axis"};
  }
  return {};
}

}  // namespace

Result<MaskAtlas> MaskAtlas::pack(std::span<const Mask> masks) {
  MaskAtlas atlas;
  if (auto ok = check(masks); !ok) return ok.failure();
  if (masks.empty()) return atlas;

  // Where each mask lies.
  const auto layout = best_layout(masks);
  if (!layout)
    return Failure{ErrorCode::resource_limit,
                   "masks: " + std::to_string(masks.size()) + " do not fit into an atlas of " +
                       std::to_string(kMaxMaskAtlasAxis) + " x " + std::to_string(kMaxMaskAtlasAxis) +
                       " texels; use fewer or smaller ones"};
  atlas.width_ = layout->width;
  atlas.height_ = layout->height;
  atlas.texels_.assign(std::size_t{layout->width} * layout->height, 0);

  // Its texels, with the edge's once more around it.
  const glm::vec2 size(layout->width, layout->height);
  std::uint64_t hash = 0;
  for (std::size_t i = 0; i < masks.size(); ++i) {
    const Mask& mask = masks[i];
    const glm::uvec2 low = layout->corners[i], extent(mask.width, mask.height);
    atlas.rectangles_.push_back({glm::vec2(low) / size, glm::vec2(low + extent) / size});
    for (std::uint32_t y = 0; y < mask.height + 2 * kPad; ++y) {
      const std::size_t from = std::size_t{std::clamp(y, kPad, mask.height) - kPad} * mask.width;
      const std::size_t to = std::size_t{low.y + y - kPad} * layout->width + low.x - kPad;
      for (std::uint32_t x = 0; x < mask.width + 2 * kPad; ++x)
        atlas.texels_[to + x] = mask.texels[from + std::clamp(x, kPad, mask.width) - kPad];
    }
    hash = hash_values(std::span<const std::uint32_t>(std::array{mask.width, mask.height}), hash);
    hash = hash_values(std::span<const std::uint8_t>(mask.texels), hash);
  }
  atlas.key_ = {atlas.count(), hash};
  atlas.find_cells();
  return atlas;
}

float MaskAtlas::at(glm::vec2 uv) const {
  const glm::vec2 from_centres = uv * glm::vec2(width_, height_) - 0.5f;
  const glm::ivec2 low(glm::floor(from_centres)), last(glm::uvec2(width_, height_) - 1u);
  const glm::vec2 f = from_centres - glm::vec2(low);
  const glm::ivec2 a = glm::clamp(low, glm::ivec2(0), last), b = glm::clamp(low + 1, glm::ivec2(0), last);
  const auto texel = [&](int x, int y) {
    const std::size_t at = static_cast<std::size_t>(y) * width_ + static_cast<std::size_t>(x);
    return static_cast<float>(texels_[at]) / 255.0f;
  };
  const float top = glm::mix(texel(a.x, a.y), texel(b.x, a.y), f.x);
  const float bottom = glm::mix(texel(a.x, b.y), texel(b.x, b.y), f.x);
  return glm::mix(top, bottom, f.y);
}

void MaskAtlas::find_cells() {
  const std::size_t width = width_, count = width * height_;
  std::vector<std::uint8_t> kinds(count, MaskCell::mixed), even(count, 0), rows(count, 0), radii(count, 0);
  for (std::size_t y = 0; y + 1 < height_; ++y) {
    const std::uint8_t* top = texels_.data() + y * width;
    const std::uint8_t* bottom = top + width;
    for (std::size_t x = 0; x + 1 < width; ++x) {
      const int any = top[x] | top[x + 1] | bottom[x] | bottom[x + 1],
                all = top[x] & top[x + 1] & bottom[x] & bottom[x + 1];
      kinds[y * width + x] = static_cast<std::uint8_t>((any != 0 ? 1 : 0) + (all == 255 ? 1 : 0));
      even[y * width + x] = any == 0 || all == 255;
    }
  }

  // Cells next to each other share texels: even ones are of one kind. Each round keeps those whose neighbours
  // at a distance were kept, which doubles their radius. The last column and row are never even, so that no
  // round reaches from one end of a row to the other.
  for (std::size_t step = 1; step <= kMaxMaskRadius / 2 + 1 && 2 * step * width < count; step *= 2) {
    for (std::size_t i = step; i + step < count; ++i)
      rows[i] = static_cast<std::uint8_t>(even[i - step] & even[i] & even[i + step]);
    std::fill_n(even.begin(), step * width, std::uint8_t{0});
    std::fill_n(even.end() - static_cast<std::ptrdiff_t>(step * width), step * width, std::uint8_t{0});
    for (std::size_t i = step * width; i + step * width < count; ++i) {
      even[i] = static_cast<std::uint8_t>(rows[i - step * width] & rows[i] & rows[i + step * width]);
      radii[i] = static_cast<std::uint8_t>(radii[i] + step * even[i]);
    }
  }

  cells_.resize(count);
  for (std::size_t i = 0; i < count; ++i) cells_[i] = {static_cast<MaskCell::Kind>(kinds[i]), radii[i]};
}

std::array<std::uint8_t, 4> MaskView::corners(glm::ivec2 cell) const {
  const std::size_t stride = atlas->width();
  const std::uint8_t* texel = atlas->texels().data() + static_cast<std::size_t>(first.y + cell.y) * stride +
                              static_cast<std::size_t>(first.x + cell.x);
  return {texel[0], texel[1], texel[stride], texel[stride + 1]};
}

MaskView view_of(const MaskAtlas& masks, const shared::Hole& hole) {
  const glm::vec2 size(masks.width(), masks.height());
  const glm::ivec2 low(hole.uv_min * size), high(hole.uv_max * size);  // exact: the sides are powers of two
  return {&masks, low - static_cast<int>(kPad), high.x - low.x, high.y - low.y};
}

float hole_strength_masked(const shared::Hole& hole, glm::vec3 p_world, float time, float rim_noise_metres,
                           const MaskAtlas& masks) {
  const shared::HoleCut cut = shared::hole_cut(hole, p_world, time, rim_noise_metres);
  if (hole.shape != shared::kHoleMask || cut.strength <= 0) return cut.strength;
  return cut.strength * masks.at(cut.uv);
}

}  // namespace brume::smoke
