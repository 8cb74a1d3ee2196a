// The textures of a field as whole layers, which is how Godot 3 uploads them.
#pragma once

#include <array>
#include <brume/brume_textures.hpp>
#include <cstdint>
#include <vector>

namespace brume::godot {

class SmokeTextures {
 public:
  SmokeTextures(const api::Field& field, std::uint32_t light_count, bool sky);

  /// Takes over the field at a time. `lights`: as many positions as there are lights; `suns`: 1 where it is
  /// the direction towards a sun. `light_fraction`: of the light, how much this update finds; 0: all.
  void update(const api::Field& field, double seconds, const std::vector<brume_point>& lights,
              const std::vector<std::uint8_t>& suns, double light_fraction);

  /// Format, width, height, depth, generation.
  std::vector<std::int32_t> layout(std::uint32_t kind) const;
  /// The layers that changed since the last call.
  std::vector<std::int32_t> changed_layers(std::uint32_t kind);
  /// All texels of a layer.
  std::vector<std::uint8_t> layer(std::uint32_t kind, std::uint32_t z) const;
  std::vector<float> constants() const;

 private:
  /// A texture's bytes, and which of its layers Godot does not have yet.
  struct Copy {
    brume_texture texture{};
    std::vector<std::uint8_t> texels;
    std::vector<bool> changed;
    std::size_t layer_bytes() const { return texture.depth == 0 ? 0 : texels.size() / texture.depth; }
  };
  const Copy& copy(std::uint32_t kind) const;
  static void write(Copy& copy, const brume_region& region);

  api::Textures textures_;
  std::uint32_t light_count_;
  std::array<Copy, BRUME_TEXTURE_COUNT> copies_;
};

}  // namespace brume::godot
