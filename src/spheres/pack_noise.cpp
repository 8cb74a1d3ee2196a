#include "spheres/pack_noise.hpp"

#include "spheres/pack_random.hpp"

namespace brume::spheres {

double gradient_noise(std::uint64_t seed, const glm::dvec3& at) {
  const glm::dvec3 low = glm::floor(at), f = at - low;
  const glm::dvec3 w = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
  const auto corner = [&](int x, int y, int z) {
    const glm::u64vec3 cell = glm::u64vec3(glm::i64vec3(low) + glm::i64vec3(x, y, z));
    const std::uint64_t bits = PackRandom::mix(seed + cell.x * 0x9e3779b97f4a7c15u +
                                               cell.y * 0xc2b2ae3d27d4eb4fu + cell.z * 0x165667b19e3779f9u);
    // One of the 12 edges of a cube: which two axes, and both signs.
    const glm::dvec3 d = f - glm::dvec3(x, y, z);
    const std::uint64_t axis = (bits >> 32) * 3 >> 32;
    const double a = axis == 0 ? d.y : d.x, b = axis == 2 ? d.y : d.z;
    return (bits & 1 ? -a : a) + (bits & 2 ? -b : b);
  };
  const auto along_x = [&](int y, int z) { return corner(0, y, z) * (1 - w.x) + corner(1, y, z) * w.x; };
  const auto along_y = [&](int z) { return along_x(0, z) * (1 - w.y) + along_x(1, z) * w.y; };
  return along_y(0) * (1 - w.z) + along_y(1) * w.z;
}

}  // namespace brume::spheres
