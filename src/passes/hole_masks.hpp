// The masks of holes on the device.
#pragma once

#include "gpu/recorder.hpp"
#include "smoke/mask_atlas.hpp"

namespace brume::passes {

/// The atlas as an R8 image for lib/hole_mask.glsl. Throws resource_limit.
gpu::Image make_hole_masks(gpu::Context& context, gpu::Recorder& recorder, const smoke::MaskAtlas& masks);

}  // namespace brume::passes
