#include "reference/phase.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "surfaces/surface.hpp"

namespace brume::reference {
namespace {

using surfaces::basis_around;

/// The inverse of the integral of Henyey and Greenstein's function.
float cosine_of_hg(float g, float u) {
  if (std::abs(g) < 1e-3f) return 1 - 2 * u;
  const float term = (1 - g * g) / (1 + g - 2 * g * u);
  return std::clamp((1 + g * g - term * term) / (2 * g), -1.0f, 1.0f);
}

}  // namespace

glm::vec3 sample_phase(const shared::Phase& phase, const glm::vec3& direction, Sampler& sampler) {
  const glm::vec2 u = sampler.next_2d();
  float cosine = 0;
  if (phase.draine_weight > 0 && sampler.random() < phase.draine_weight) {
    // Draine's is Henyey and Greenstein's times 1 + alpha cos^2, but for a factor: by rejection.
    cosine = cosine_of_hg(phase.g_draine, u.x);
    while (sampler.random() * (1 + phase.alpha) > 1 + phase.alpha * cosine * cosine)
      cosine = cosine_of_hg(phase.g_draine, sampler.random());
  } else {
    cosine = cosine_of_hg(phase.g_hg, u.x);
  }
  glm::vec3 x, y;
  basis_around(direction, x, y);
  const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
  const float angle = 2 * std::numbers::pi_v<float> * u.y;
  return glm::normalize(cosine * direction + sine * (std::cos(angle) * x + std::sin(angle) * y));
}

}  // namespace brume::reference
