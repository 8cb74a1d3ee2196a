// The media of frames of smoke alone.
#pragma once

#include "passes/media_resources.hpp"

namespace brume::passes {

/// All are referred to. `volumes`: for the bindings, which no ray reads.
inline MediaResources smoke_alone(const SmokeResources& smoke, const HoleClusters& holes,
                                  const VolumeUpload& volumes) {
  return {shared::kMediumSmoke, smoke, holes.resources(), volumes.resources()};
}

/// Light of smoke alone, without fine light: resources of the right types.
inline MediaLight no_light(const SmokeResources& smoke, const VolumeUpload& volumes) {
  const gpu::Image& any = volumes.resources().values;
  return {any, smoke.filled, any, any};
}

}  // namespace brume::passes
