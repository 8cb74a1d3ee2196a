// Textures in the memory of someone else: their sizes, and what changed in them since the last update.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace brume::textures {

/// Channels and their type; values as in brume_texture_format.
enum class Format : std::uint32_t {
  none = 0,
  r8 = 1,
  rg8 = 2,
  rgba8 = 3,
  rgba16f = 4,
  rgba32f = 5,
  r16ui = 6,
  r32ui = 7,
  rg32ui = 8,
  rgba32ui = 9,
};

std::size_t bytes_per_texel(Format format);

struct Texture {
  Format format = Format::none;
  glm::ivec3 size{0};
  std::uint32_t generation = 0;  ///< Rises whenever the texture has to be made again.
};

/// A box of texels to be written, x fastest, then y, then z, without gaps.
struct Region {
  std::uint32_t texture = 0;
  glm::ivec3 origin{0}, size{0};
  std::size_t first_byte = 0, byte_count = 0;  ///< In TextureSet::bytes.
};

class TextureSet {
 public:
  explicit TextureSet(std::size_t count) : textures_(count) {}

  /// Forgets the regions.
  void begin_update();
  /// True where the texture has to be made again; all of it then has to be written.
  bool resize(std::uint32_t texture, Format format, glm::ivec3 size);
  /// Adds a region and returns its number. Invalidates what `texels` returned.
  std::size_t add(std::uint32_t texture, glm::ivec3 origin, glm::ivec3 size);
  /// Adds a region with its texels.
  void write(std::uint32_t texture, glm::ivec3 origin, glm::ivec3 size, std::span<const std::byte> texels);
  /// The memory of a region, to be filled.
  std::span<std::byte> texels(std::size_t region);

  const Texture& texture(std::uint32_t index) const { return textures_[index]; }
  std::span<const Texture> textures() const { return textures_; }
  std::span<const Region> regions() const { return regions_; }
  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::vector<Texture> textures_;
  std::vector<Region> regions_;
  std::vector<std::byte> bytes_;
};

}  // namespace brume::textures
