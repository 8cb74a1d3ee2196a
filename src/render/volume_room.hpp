// How much of volumes a device has room for.
#pragma once

#include "gpu/context.hpp"
#include "volumes/volume_frame.hpp"

namespace brume::render {

/// Room for all volumes of a frame: at most three quarters of the device's memory, and `memory_bytes` (0: no
/// such limit); as much as one 3D texture and one storage buffer hold. At least what small volumes take.
volumes::VolumeRoom volume_room(const gpu::Context& context, std::uint64_t memory_bytes = 0);

}  // namespace brume::render
