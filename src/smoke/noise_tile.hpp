// The tile of noise that erodes smoke.
#pragma once

#include "shared/noise.h"

namespace brume::smoke {

/// Parameters of the smoke's noise: the smallest billows are five texels wide.
constexpr shared::NoiseParams kSmokeNoise{64, 4, 7};

}  // namespace brume::smoke
