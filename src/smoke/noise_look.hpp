// What noise does to smoke, in the terms of scenes and hosts.
#pragma once

#include "shared/frame.h"

namespace brume::smoke {

struct NoiseLook {
  float erosion = 0.5f;     ///< How much noise erodes, [0, 1].
  float noise_size = 1.5f;  ///< Size of its largest billows [m], > 0.
  float detail = 1;         ///< What is finer than its tile, [0, 1].
  float hole_rim = 0.06f;   ///< How far noise frays the rims of holes [m], >= 0.
  float swirl = 0.2f;       ///< How far noise swirls [m], >= 0.
  float rise = 0.12f;       ///< How fast noise rises [m/s].

  bool operator==(const NoiseLook&) const = default;
};

/// Sets the members of `look` that say so.
void set_noise(shared::SmokeLook& look, const NoiseLook& noise);

}  // namespace brume::smoke
