// What light reaches, and what its rays cross.
#pragma once

#include <glm/glm.hpp>

#include "shared/light.h"

namespace brume::planning {

/// The greatest of the intensities of a light.
float brightest(const shared::Light& light);

/// Whether a light reaches anything within a sphere; true too for some that it just misses. Spots: Wronski
/// 2017, "Cull that cone!".
bool reaches(const shared::Light& light, glm::vec3 centre, float radius);

/// Square of the least distance between two stretches of lines (Ericson 2005, "Real-Time Collision
/// Detection", 5.1.9).
float distance2(glm::vec3 a, glm::vec3 to_a, glm::vec3 b, glm::vec3 to_b);

/// Whether a stretch has a point in a box.
bool intersects_box(glm::vec3 from, glm::vec3 to, glm::vec3 low, glm::vec3 high);

}  // namespace brume::planning
