#include "smoke/noise_tile.hpp"

#include <bit>
#include <cstring>

#include "core/error.hpp"
#include "core/float4.hpp"
#include "core/tasks.hpp"
#include "shared/erosion.h"
#include "shared/noise_functions.h"

namespace brume::smoke {
namespace {

using Byte16 = std::uint8_t __attribute__((vector_size(16)));
using Short8 = std::uint16_t __attribute__((vector_size(16)));

/// A texel's channels in [0, 255]. Zeros are interleaved twice: compilers convert vectors of four bytes one
/// by one.
Float4 channels_of(const glm::u8vec4& texel) {
  std::uint32_t word;
  std::memcpy(&word, &texel, sizeof word);
  const auto bytes = reinterpret_cast<Byte16>(Uint4{word, 0, 0, 0});
  const auto shorts = reinterpret_cast<Short8>(
      __builtin_shufflevector(bytes, Byte16{}, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23));
  return to_float(
      reinterpret_cast<Int4>(__builtin_shufflevector(shorts, Short8{}, 0, 8, 1, 9, 2, 10, 3, 11)));
}

Float4 lerp4(Float4 a, Float4 b, float f) {
  return a + f * (b - a);
}

/// A tile of the values at its texels, [0, 1], over all threads.
template <typename ValueAt>
NoiseTile make_tile(std::uint32_t size, const ValueAt& value_at) {
  NoiseTile tile{size, std::vector<glm::u8vec4>(std::size_t{size} * size * size)};
  parallel_for(tile.texels.size(), size, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto n = static_cast<std::uint32_t>(i);
      const glm::vec4 noise = value_at(glm::uvec3(n % size, n / size % size, n / (size * size)));
      tile.texels[i] = glm::u8vec4(glm::clamp(noise, 0.0f, 1.0f) * 255.0f + 0.5f);
    }
  });
  return tile;
}

}  // namespace

NoiseTile make_noise_tile(const shared::NoiseParams& params) {
  return make_tile(params.size,
                   [&](const glm::uvec3& texel) { return shared::smoke_noise_texel(params, texel); });
}

NoiseTile make_detail_tile(const NoiseTile& noise) {
  return make_tile(shared::kDetailTexels, [&](const glm::uvec3& texel) {
    const glm::vec3 p_tile = (glm::vec3(texel) + 0.5f) / float{shared::kDetailTexels};
    return glm::vec4(
        shared::detail_texel(noise_at(noise, p_tile), noise_at(noise, shared::finer_point(p_tile))), 0, 0);
  });
}

const NoiseTile& smoke_noise_tile() {
  static const NoiseTile tile = make_noise_tile(kSmokeNoise);
  return tile;
}

const SmokeNoise& smoke_noise() {
  static const SmokeNoise noise{smoke_noise_tile(), make_detail_tile(smoke_noise_tile())};
  return noise;
}

glm::vec4 noise_at(const NoiseTile& tile, glm::vec3 p_tile) {
  // From the centre of texel 0. The next texel's number wraps as the first's does.
  const auto size = static_cast<float>(tile.size);
  const Float4 p = Float4{p_tile.x, p_tile.y, p_tile.z, 0} * size - 0.5f;
  const Int4 low = floor_to_int(p);
  const Float4 f = p - to_float(low);
  const Uint4 mask = Uint4{} + (tile.size - 1);
  const Uint4 a = reinterpret_cast<Uint4>(low) & mask, b = reinterpret_cast<Uint4>(low + 1) & mask;

  const auto row = [&](std::uint32_t y, std::uint32_t z) {
    const glm::u8vec4* texels =
        tile.texels.data() + std::size_t{tile.size} * (y + std::size_t{tile.size} * z);
    return lerp4(channels_of(texels[a[0]]), channels_of(texels[b[0]]), f[0]);
  };
  const auto layer = [&](std::uint32_t z) { return lerp4(row(a[1], z), row(b[1], z), f[1]); };
  const Float4 noise = lerp4(layer(a[2]), layer(b[2]), f[2]) * (1.0f / 255);
  return {noise[0], noise[1], noise[2], noise[3]};
}

}  // namespace brume::smoke
