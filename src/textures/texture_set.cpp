#include "textures/texture_set.hpp"

#include <algorithm>

#include "core/error.hpp"

namespace brume::textures {

std::size_t bytes_per_texel(Format format) {
  switch (format) {
    case Format::none:
      return 0;
    case Format::r8:
      return 1;
    case Format::rg8:
    case Format::r16ui:
      return 2;
    case Format::rgba8:
    case Format::r32ui:
      return 4;
    case Format::rgba16f:
    case Format::rg32ui:
      return 8;
    case Format::rgba32f:
    case Format::rgba32ui:
      return 16;
  }
  return 0;
}

void TextureSet::begin_update() {
  regions_.clear();
  bytes_.clear();
}

bool TextureSet::resize(std::uint32_t texture, Format format, glm::ivec3 size) {
  Texture& held = textures_[texture];
  if (held.format == format && held.size == size) return false;
  held = {format, size, held.generation + 1};
  return true;
}

std::size_t TextureSet::add(std::uint32_t texture, glm::ivec3 origin, glm::ivec3 size) {
  const glm::u64vec3 extent(size);
  const std::size_t count = extent.x * extent.y * extent.z * bytes_per_texel(textures_[texture].format);
  // Numbers in the texels are read in place: each region begins at a multiple of 16 bytes.
  const std::size_t first = (bytes_.size() + 15) & ~std::size_t{15};
  bytes_.resize(first + count);
  regions_.push_back({texture, origin, size, first, count});
  return regions_.size() - 1;
}

void TextureSet::write(std::uint32_t texture, glm::ivec3 origin, glm::ivec3 size,
                       std::span<const std::byte> texels) {
  const std::span<std::byte> to = this->texels(add(texture, origin, size));
  BRUME_ASSERT(to.size() == texels.size(), std::to_string(texels.size()));
  std::copy(texels.begin(), texels.end(), to.begin());
}

std::span<std::byte> TextureSet::texels(std::size_t region) {
  const Region& at = regions_[region];
  return std::span(bytes_).subspan(at.first_byte, at.byte_count);
}

}  // namespace brume::textures
