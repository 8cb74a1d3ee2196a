#include "reference/lens.hpp"

#include <cmath>
#include <numbers>

namespace brume::reference {

glm::vec2 point_on_lens(std::uint32_t blades, const glm::vec2& u) {
  constexpr float kTurn = 2 * std::numbers::pi_v<float>;
  const float out = std::sqrt(u.y);
  if (blades < 3) return out * glm::vec2(std::sin(kTurn * u.x), std::cos(kTurn * u.x));
  // A triangle between the middle and two corners.
  const float scaled = u.x * static_cast<float>(blades), wedge = std::floor(scaled);
  const auto corner = [&](float i) {
    const float angle = kTurn * i / static_cast<float>(blades);
    return glm::vec2(std::sin(angle), std::cos(angle));
  };
  return out * glm::mix(corner(wedge), corner(wedge + 1), scaled - wedge);
}

}  // namespace brume::reference
