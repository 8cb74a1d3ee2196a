// What the media of a frame have on the device. Passes take them together and bind their bundles together: a
// further medium has its own here, and passes and their shaders have it from there.
#pragma once

#include <array>
#include <tuple>

#include "passes/hole_clusters.hpp"
#include "passes/smoke_upload.hpp"
#include "passes/volume_upload.hpp"
#include "shared/fine_light.h"
#include "shared/media.h"
#include "shared/volume_light.h"

namespace brume::passes {

/// The media that view rays meet, or that light meets.
struct MediaResources {
  std::uint32_t set = 0;  ///< Which there are: MediaPlan::media or MediaPlan::casters.
  const SmokeResources& smoke;
  const HoleResources& holes;  ///< In the smoke.
  VolumeResources volumes;

  /// All that shaders read of the media.
  auto bindings() const {
    return std::apply([](const auto&... one) { return std::to_array<gpu::BoundResource>({one...}); },
                      std::tuple_cat(smoke.bindings(), holes.bindings(), volumes.bindings()));
  }
};

/// The light in the media, for rays from the eye.
struct MediaLight {
  const gpu::Image& fine_light;    ///< FineLightPass::light.
  const gpu::Buffer& fine_pages;   ///< FineLightPass::pages.
  const gpu::Image& volume_light;  ///< VolumeLightPass::light.
  const gpu::Image& sun_depths;    ///< VolumeLightPass::sun_depths.

  /// All that shaders read of the light.
  auto bindings(const gpu::Sampler& linear) const {
    return std::to_array<gpu::BoundResource>({
        {shared::kBindFineLight, gpu::sampled(fine_light, linear)},
        {shared::kBindFinePages, gpu::read(fine_pages)},
        {shared::kBindVolumeLight, gpu::sampled(volume_light, linear)},
        {shared::kBindSunDepths, gpu::sampled(sun_depths, linear)},
    });
  }
};

}  // namespace brume::passes
