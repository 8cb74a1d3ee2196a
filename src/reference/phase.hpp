// Directions of scattered light.
#pragma once

#include <glm/glm.hpp>

#include "shared/phase.h"
#include "surfaces/sampler.hpp"

namespace brume::reference {

using surfaces::Sampler;

/// A direction of light after scattering, as likely as shared::phase_value says; `direction` before, unit.
glm::vec3 sample_phase(const shared::Phase& phase, const glm::vec3& direction, Sampler& sampler);

}  // namespace brume::reference
