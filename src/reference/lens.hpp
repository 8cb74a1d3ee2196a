// Points on the opening of a lens.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace brume::reference {

/// A point of the unit disk, or of the regular polygon of `blades` edges, at least 3, whose corners lie on
/// its edge, one at (0, 1); evenly distributed for evenly distributed `u` in [0, 1)^2.
glm::vec2 point_on_lens(std::uint32_t blades, const glm::vec2& u);

}  // namespace brume::reference
