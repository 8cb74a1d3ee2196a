#include "passes/slice_textures.hpp"

#include <algorithm>
#include <array>
#include <glm/gtc/packing.hpp>
#include <string>

namespace brume::passes {
namespace {

using Half4 = std::uint64_t;

constexpr grids::AtlasAxes kStraightAxes{{{0, false}, {1, false}, {2, false}}};
constexpr float kLargestHalf = 65504;

std::optional<std::string> fault_of_channels(std::span<const grids::DenseGrid> channels) {
  if (channels.empty() || channels.size() > kMostSliceChannels)
    return std::to_string(channels.size()) + " channels; expected 1 to " + std::to_string(kMostSliceChannels);
  for (const grids::DenseGrid& channel : channels)
    if (channel.size != channels[0].size || channel.box.low != channels[0].box.low ||
        channel.box.high != channels[0].box.high)
      return "its channels \"" + channels[0].name + "\" and \"" + channel.name +
             "\" differ in their size or box; resample one to the voxels of the other";
  return std::nullopt;
}

float storable(float value) {
  return value == value ? std::clamp(value, -kLargestHalf, kLargestHalf) : 0.0f;
}

Half4 texel_of(std::span<const grids::DenseGrid> channels, std::size_t voxel) {
  glm::vec4 value(0);
  for (std::size_t i = 0; i < channels.size(); ++i)
    value[static_cast<int>(i)] = storable(channels[i].values[voxel]);
  return glm::packHalf4x16(value);
}

/// The texel of a tile that a texel of its padded place repeats.
glm::uvec2 mirrored_texel(glm::uvec2 in_place, const grids::SliceLayout& layout) {
  const glm::ivec2 at = glm::ivec2(in_place) - static_cast<int>(layout.padding);
  return glm::uvec2(glm::clamp(at, glm::ivec2(0), glm::ivec2(layout.tile()) - 1));
}

/// All texels of a volume's part of the image, 0 where no tile is.
std::vector<Half4> texels_of(std::span<const grids::DenseGrid> channels, const grids::SliceLayout& layout) {
  const glm::uvec2 size = layout.image_size(), place = layout.tile() + 2 * layout.padding;
  std::vector<Half4> texels(std::size_t{size.x} * size.y, 0);
  for (std::uint32_t slice = 0; slice < layout.tiles(); ++slice) {
    const glm::uvec2 first = layout.texel(slice, {0, 0}) - layout.padding;
    for (std::uint32_t y = 0; y < place.y; ++y)
      for (std::uint32_t x = 0; x < place.x; ++x) {
        const glm::uvec3 voxel = layout.voxel(slice, mirrored_texel({x, y}, layout));
        texels[first.x + x + std::size_t{size.x} * (first.y + y)] =
            texel_of(channels, channels[0].index(voxel));
      }
  }
  return texels;
}

gpu::Image slice_image(gpu::Context& context, glm::uvec2 size) {
  return gpu::Image(context,
                    gpu::sampled_image(size, VK_FORMAT_R16G16B16A16_SFLOAT, VK_IMAGE_USAGE_TRANSFER_SRC_BIT));
}

gpu::Recorder::Region slice_region(const std::vector<Half4>& texels, glm::uvec2 first, glm::uvec2 size) {
  return {std::as_bytes(std::span(texels)), {glm::ivec2(first), 0}, {size, 1}};
}

}  // namespace

shared::SliceTexture SlicePacking::texture(std::size_t volume) const {
  const grids::SliceLayout& layout = layouts[volume];
  const glm::dvec2 image(image_size);
  return {glm::vec2(layout.tile()),
          static_cast<float>(layout.padding),
          static_cast<float>(layout.tiles()),
          static_cast<float>(layout.columns),
          static_cast<float>(layout.rows()),
          glm::vec2(glm::dvec2(first_texels[volume]) / image),
          glm::vec2(glm::dvec2(layout.image_size()) / image)};
}

Result<SlicePacking> pack_slices(std::span<const glm::uvec3> sizes, std::uint32_t most_texels) {
  SlicePacking packing;
  std::uint64_t width = 1, height = 0;
  for (const glm::uvec3 size : sizes) {
    grids::SliceLayout layout{size, kStraightAxes, 1, 1};
    layout.columns = grids::near_square_columns(layout, false);
    if (const auto fault = fault_of(layout))
      return Failure{ErrorCode::resource_limit,
                     "volume " + std::to_string(packing.layouts.size()) + ": " + *fault};
    packing.layouts.push_back(layout);
    packing.first_texels.emplace_back(0, static_cast<std::uint32_t>(height));
    width = std::max<std::uint64_t>(width, layout.image_size().x);
    height += layout.image_size().y;
    if (width > most_texels || height > most_texels || width * height > grids::kMostAtlasTexels)
      return Failure{ErrorCode::resource_limit,
                     "the slices of volumes 0 to " + std::to_string(packing.layouts.size() - 1) +
                         " take an image of " + std::to_string(width) + " x " + std::to_string(height) +
                         " texels: at most " + std::to_string(most_texels) + " along each axis and " +
                         std::to_string(grids::kMostAtlasTexels) + " in all; use fewer volumes or voxels"};
  }
  packing.image_size = {static_cast<std::uint32_t>(width),
                        static_cast<std::uint32_t>(std::max<std::uint64_t>(height, 1))};
  return packing;
}

SliceTextures::SliceTextures(gpu::Context& context, gpu::CommandStream& stream)
    : image_(slice_image(context, glm::uvec2(1))) {
  const std::vector<Half4> nothing(1, 0);
  const gpu::Recorder::Region all = slice_region(nothing, {0, 0}, {1, 1});
  stream.run([&](gpu::Recorder& recorder) { recorder.upload(image_, {&all, 1}); });
}

Result<SliceTextures> SliceTextures::create(gpu::Context& context, gpu::CommandStream& stream,
                                            std::span<const std::span<const grids::DenseGrid>> volumes) {
  if (volumes.empty()) return SliceTextures(context, stream);
  std::vector<glm::uvec3> sizes;
  for (const std::span<const grids::DenseGrid> channels : volumes) {
    if (const auto fault = fault_of_channels(channels))
      return Failure{ErrorCode::bad_input, "volume " + std::to_string(sizes.size()) + ": " + *fault};
    sizes.push_back(channels[0].size);
  }
  const auto packing = pack_slices(sizes, context.limits().maxImageDimension2D);
  if (!packing) return packing.failure();

  gpu::Image image = slice_image(context, packing->image_size);
  std::vector<shared::SliceTexture> textures;
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    const grids::SliceLayout& layout = packing->layouts[i];
    // One at a time: staging memory holds no more than the largest.
    const std::vector<Half4> texels = texels_of(volumes[i], layout);
    const gpu::Recorder::Region part = slice_region(texels, packing->first_texels[i], layout.image_size());
    stream.run([&](gpu::Recorder& recorder) { recorder.upload(image, {&part, 1}); });
    textures.push_back(packing->texture(i));
  }
  return SliceTextures(std::move(image), std::move(textures));
}

}  // namespace brume::passes
