// How pictures show what they measure.
#pragma once

#include <cstdint>

namespace brume::scene {

/// How radiance becomes display values.
enum class ToneCurve : std::uint32_t {
  neutral,   ///< Khronos PBR Neutral: compresses highlights.
  standard,  ///< None: clipped at 1, as Blender's "Standard".
};

}  // namespace brume::scene
