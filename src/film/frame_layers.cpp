#include "film/frame_layers.hpp"

#include <array>
#include <bit>
#include <glm/gtc/packing.hpp>
#include <limits>
#include <span>

#include "gpu/read_back.hpp"
#include "planning/device_camera.hpp"
#include "scene/color.hpp"

namespace brume::film {
namespace {

using Half = std::uint16_t;
using Halves = std::vector<Half>;

/// A channel of an image with four values per pixel.
Halves channel_of(std::span<const Half> rgba, std::size_t channel) {
  Halves values(rgba.size() / 4);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = rgba[4 * i + channel];
  return values;
}

/// The linear value of each sRGB one.
std::array<Half, 256> linear_halves() {
  std::array<Half, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] = glm::packHalf1x16(static_cast<float>(scene::linear_from_srgb(static_cast<double>(i) / 255)));
  return table;
}

/// A channel of the albedo, 0 where the nearest surface is none of the level.
Halves linear_channel_of(std::span<const std::uint8_t> rgba, std::size_t channel,
                         std::span<const float> level_depth, std::span<const float> depth) {
  static const std::array<Half, 256> table = linear_halves();
  Halves values(rgba.size() / 4);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = depth[i] > 0 && depth[i] == level_depth[i] ? table[rgba[4 * i + channel]] : Half{0};
  return values;
}

}  // namespace

FrameLayers::FrameLayers(gpu::Context& context, glm::uvec2 size_px)
    : size_px_(size_px),
      context_(context),
      radiance_(gpu::readback_buffer(context, std::size_t{8} * size_px.x * size_px.y)),
      media_(gpu::readback_buffer(context, radiance_.size())),
      albedo_(gpu::readback_buffer(context, radiance_.size() / 2)),
      depth_(gpu::readback_buffer(context, radiance_.size() / 2)),
      entries_(gpu::readback_buffer(context, sizeof(std::uint32_t) + radiance_.size() / 2)) {}

void FrameLayers::record(gpu::Recorder& recorder, const render::Renderer& renderer) {
  const render::Targets& targets = renderer.targets();
  BRUME_ASSERT(targets.size_px == size_px_, "frames of another size");
  recorder.read_back(renderer.radiance(), radiance_);
  recorder.read_back(renderer.media(), media_);
  recorder.read_back(targets.gbuffer.albedo_roughness, albedo_);
  recorder.read_back(renderer.surfaces(), depth_);
  has_tanks_ = &renderer.surfaces() != &targets.gbuffer.depth;
  if (has_tanks_ && !level_depth_) level_depth_ = gpu::readback_buffer(context_, depth_.size());
  if (has_tanks_) recorder.read_back(targets.gbuffer.depth, level_depth_);
  recorder.read_back(renderer.march().counters(), entries_, entries_.size());
  has_decals_ = renderer.has_decals();
  has_occlusion_ = renderer.occlusion() != nullptr;
  if (!has_occlusion_) return;
  if (!occlusion_) occlusion_ = gpu::readback_buffer(context_, radiance_.size());
  recorder.read_back(*renderer.occlusion(), occlusion_);
}

image::LayeredImage FrameLayers::image() const {
  // As the device has them.
  const std::size_t count = std::size_t{size_px_.x} * size_px_.y;
  const auto radiance = gpu::values_of<Half>(radiance_), media = gpu::values_of<Half>(media_);
  const auto albedo = gpu::values_of<std::uint8_t>(albedo_);
  const auto depth = gpu::values_of<float>(depth_);
  const auto level_depth = has_tanks_ ? gpu::values_of<float>(level_depth_) : depth;
  const auto entries = gpu::values_of<float>(entries_).subspan(1);

  // What is computed from them.
  Halves alpha(count);
  std::vector<float> z(count);
  for (std::size_t i = 0; i < count; ++i) {
    const bool surface = depth[i] > 0;
    alpha[i] = glm::packHalf1x16(surface ? 1.0f : 1.0f - glm::unpackHalf1x16(media[4 * i + 3]));
    z[i] = surface ? planning::kNearPlane / depth[i] : std::numeric_limits<float>::infinity();
  }

  image::LayeredImage image{size_px_.x, size_px_.y, {}};
  const std::array<const char*, 3> names{"R", "G", "B"};
  for (std::size_t c = 0; c < 3; ++c) {
    const std::string name = names[c];
    image.layers.push_back({name, channel_of(radiance, c)});
    image.layers.push_back({"albedo." + name, linear_channel_of(albedo, c, level_depth, depth)});
    image.layers.push_back({"media." + name, channel_of(media, c)});
  }
  image.layers.push_back({"A", std::move(alpha)});
  image.layers.push_back({"Z", std::move(z)});
  image.layers.push_back({"transmittance.V", channel_of(media, 3)});
  if (has_decals_)
    image.layers.push_back(
        {"occlusion.V", has_occlusion_ ? channel_of(gpu::values_of<Half>(occlusion_), 0) : Halves(count, 0)});
  image.layers.push_back({"depth_in.V", std::vector<float>(entries.begin(), entries.end())});
  return image;
}

}  // namespace brume::film
