// Transfer functions as the device reads them (shaders/lib/volume_transfer.glsl).
#pragma once

#include <vector>

#include "planning/frame_input.hpp"
#include "shared/volume.h"

namespace brume::planning {

/// kTransferNone for an empty function.
std::uint32_t transfer_kind(const TransferInput& transfer);

/// What shaders read of a valid function.
shared::VolumeTransfer device_transfer(const TransferInput& transfer);

/// The shared::kTransferEntries entries of its table. `albedo` is its colour without a map.
std::vector<glm::vec4> transfer_table(const TransferInput& transfer, glm::vec3 albedo);

/// The mean colour over the range, by opacity; over the whole range where nothing is opaque.
glm::vec3 mean_color(const TransferInput& transfer, glm::vec3 albedo);

}  // namespace brume::planning
