// Where what one picture shows has moved in the next: motion vectors of flipbooks.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "image/flipbook.hpp"

namespace brume::image {

/// For each texel of `from` the way to where `to` shows the same [texels, x right, y down]: smooth, and by
/// brightness and alpha alone (Horn and Schunck 1981, "Determining Optical Flow", from coarse to fine, with
/// the second picture warped by what is known so far). Follows motion of up to about a quarter of the
/// picture; where both pictures are empty it continues what is around. Pictures of equal size.
std::vector<glm::vec2> optical_flow(const Texels& from, const Texels& to);

/// A picture at other places: of each texel what `picture` shows at the texel's centre plus `offset`
/// [texels], linearly interpolated; outside 0.
Texels warped(const Texels& picture, const std::vector<glm::vec2>& offset);

}  // namespace brume::image
