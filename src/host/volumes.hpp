// Volumes of files in a host's frames.
#pragma once

#include "host/objects.hpp"
#include "planning/frame_input.hpp"
#include "volumes/volumes.hpp"

namespace brume::host {

/// The volumes of a frame as they are at their times: holds what FrameInput points to.
using ShownVolumes = std::vector<volumes::VolumeAt>;

/// Adds the volumes of a frame, and the light of what glows in them. Loads what they wait for. Throws a
/// CallFailure for what brume_assets.h does not allow.
ShownVolumes add_volumes(api::Call& call, const brume_frame_params& params, planning::FrameInput& input);

/// What was read from a file. It fails as the file does, also where brume-vdb is missing.
template <typename T>
T loaded(Result<T> result) {
  if (!result && result.failure().code == ErrorCode::no_device)
    api::fail(BRUME_ERROR_DATA, result.failure().message);
  return api::unwrap(std::move(result), BRUME_ERROR_DATA);
}

}  // namespace brume::host
