// The decals of a frame as the device samples them.
#pragma once

#include "core/frame_memory.hpp"
#include "planning/frame_input.hpp"
#include "planning/view_frustum.hpp"
#include "shared/decal.h"

namespace brume::planning {

/// A decal that may be in view.
struct PlacedDecal {
  shared::Decal decal{};   ///< All but where its volume is in the image of slices.
  std::size_t volume = 0;  ///< DecalInput::volume.
};

/// The decals that may be in view, in `memory`. Throws bad_input for more than shared::kMaxDecals and for a
/// transform without an inverse.
FrameVector<PlacedDecal> plan_decals(const FrameInput& input, const ViewFrustum& frustum, Allocator memory);

}  // namespace brume::planning
