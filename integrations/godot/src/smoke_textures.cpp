#include "smoke_textures.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace brume::godot {
namespace {

brume_textures_params params_of(std::uint32_t light_count, bool sky) {
  brume_textures_params params = brume_textures_defaults();
  params.light_count = light_count;
  params.sky = sky;
  return params;
}

/// The size of a texel.
std::size_t bytes_of(std::uint32_t format) {
  switch (format) {
    case BRUME_FORMAT_R8:
      return 1;
    case BRUME_FORMAT_RG8:
    case BRUME_FORMAT_R16UI:
      return 2;
    case BRUME_FORMAT_RGBA8:
    case BRUME_FORMAT_R32UI:
      return 4;
    case BRUME_FORMAT_RGBA16F:
    case BRUME_FORMAT_RG32UI:
      return 8;
    case BRUME_FORMAT_RGBA32F:
    case BRUME_FORMAT_RGBA32UI:
      return 16;
    default:
      return 0;
  }
}

}  // namespace

SmokeTextures::SmokeTextures(const api::Field& field, std::uint32_t light_count, bool sky)
    : textures_(field, params_of(light_count, sky)), light_count_(light_count) {}

void SmokeTextures::update(const api::Field& field, double seconds, const std::vector<brume_point>& lights,
                           const std::vector<std::uint8_t>& suns, double light_fraction) {
  if (lights.size() != light_count_ || suns.size() != light_count_)
    throw std::invalid_argument(std::to_string(light_count_) + " lights are expected, not " +
                                std::to_string(lights.size()) + " with " + std::to_string(suns.size()) +
                                " kinds");
  std::vector<brume_texture_light> positions;
  for (std::size_t i = 0; i < lights.size(); ++i) positions.push_back({suns[i], lights[i]});
  brume_textures_frame frame = brume_textures_frame_defaults();
  frame.seconds = seconds;
  frame.lights = positions.data();
  frame.light_update_fraction = static_cast<float>(light_fraction);
  textures_.update(field, frame);

  const auto list = textures_.list();
  for (std::uint32_t kind = 0; kind < list.size(); ++kind) {
    Copy& copy = copies_[kind];
    if (copy.texture.generation == list[kind].generation) continue;
    copy.texture = list[kind];
    copy.texels.assign(
        bytes_of(copy.texture.format) * copy.texture.width * copy.texture.height * copy.texture.depth, 0);
    copy.changed.assign(copy.texture.depth, true);
  }
  for (const brume_region& region : textures_.regions()) write(copies_[region.texture], region);
}

void SmokeTextures::write(Copy& copy, const brume_region& region) {
  const std::size_t row = region.byte_count / (std::size_t{region.height} * region.depth);
  const std::size_t texel = row / region.width;
  const auto* source = static_cast<const std::uint8_t*>(region.texels);
  for (std::uint32_t z = region.z; z < region.z + region.depth; ++z) {
    copy.changed[z] = true;
    for (std::uint32_t y = region.y; y < region.y + region.height; ++y, source += row) {
      const std::size_t first = (std::size_t{z} * copy.texture.height + y) * copy.texture.width + region.x;
      std::copy_n(source, row, copy.texels.data() + first * texel);
    }
  }
}

const SmokeTextures::Copy& SmokeTextures::copy(std::uint32_t kind) const {
  if (kind >= copies_.size()) throw std::invalid_argument("there is no texture " + std::to_string(kind));
  return copies_[kind];
}

std::vector<std::int32_t> SmokeTextures::layout(std::uint32_t kind) const {
  const brume_texture& texture = copy(kind).texture;
  std::vector<std::int32_t> numbers;
  for (const std::uint32_t number :
       {texture.format, texture.width, texture.height, texture.depth, texture.generation})
    numbers.push_back(static_cast<std::int32_t>(number));
  return numbers;
}

std::vector<std::int32_t> SmokeTextures::changed_layers(std::uint32_t kind) {
  copy(kind);
  std::vector<bool>& changed = copies_[kind].changed;
  std::vector<std::int32_t> layers;
  for (std::size_t z = 0; z < changed.size(); ++z)
    if (changed[z]) layers.push_back(static_cast<std::int32_t>(z));
  changed.assign(changed.size(), false);
  return layers;
}

std::vector<std::uint8_t> SmokeTextures::layer(std::uint32_t kind, std::uint32_t z) const {
  const Copy& of_kind = copy(kind);
  if (z >= of_kind.texture.depth) throw std::invalid_argument("there is no layer " + std::to_string(z));
  const std::size_t bytes = of_kind.layer_bytes();
  const auto first = of_kind.texels.begin() + static_cast<std::ptrdiff_t>(z * bytes);
  return {first, first + static_cast<std::ptrdiff_t>(bytes)};
}

std::vector<float> SmokeTextures::constants() const {
  const auto constants = textures_.constants();
  return {constants.begin(), constants.end()};
}

}  // namespace brume::godot
