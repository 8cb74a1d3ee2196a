#include "bench/decals/ray_traced_occlusion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <numeric>

#include "shared/hash.h"

namespace brume::decals {
namespace {

constexpr std::size_t kLanes = 8;

/// Two unit vectors that are orthogonal to a unit normal and to each other: Duff et al. 2017, "Building an
/// Orthonormal Basis, Revisited".
std::array<glm::dvec3, 2> axes_across(glm::dvec3 n) {
  const double sign = n.z < 0 ? -1 : 1, a = -1 / (sign + n.z), b = n.x * n.y * a;
  return {glm::dvec3(1 + sign * n.x * n.x * a, sign * b, -sign * n.x),
          glm::dvec3(b, sign + n.y * n.y * a, -n.y)};
}

}  // namespace

RayTracedOcclusion::RayTracedOcclusion(std::span<const voxel::Triangle> triangles, int rays) {
  // The golden ratio distributes the angles, the square root the radii.
  constexpr double kGolden = 0.6180339887498949;
  for (int i = 0; i < rays; ++i) {
    const double radius_squared = (i + 0.5) / rays,
                 angle = glm::two_pi<double>() * std::fmod(i * kGolden, 1.0);
    directions_.emplace_back(std::sqrt(radius_squared) * std::cos(angle),
                             std::sqrt(radius_squared) * std::sin(angle), std::sqrt(1 - radius_squared));
  }
  std::vector<glm::vec3> corners;
  for (const voxel::Triangle& triangle : triangles)
    corners.insert(corners.end(), {triangle.a, triangle.b, triangle.c});
  std::vector<std::uint32_t> indices(corners.size());
  std::iota(indices.begin(), indices.end(), 0u);
  const std::array meshes{trace::TriangleMesh{corners, indices}};
  tree_.build("occlusion by rays", std::span(meshes).first(corners.empty() ? 0 : 1)).value_or_throw();
}

double RayTracedOcclusion::at(glm::dvec3 p_world, glm::dvec3 normal, std::uint32_t seed,
                              double offset) const {
  const auto [across, beside] = axes_across(normal);
  const double angle = glm::two_pi<double>() * shared::pcg3d({seed, 17u, 4u}).x * 0x1p-32;
  const glm::vec3 u(std::cos(angle) * across + std::sin(angle) * beside), n(normal);
  const glm::vec3 v(glm::cross(normal, glm::dvec3(u))), from(p_world + offset * normal);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  int hidden = 0;
  for (std::size_t begin = 0; begin < directions_.size(); begin += kLanes) {
    alignas(32) RTCRay8 packet;
    alignas(32) std::array<int, kLanes> active{};
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      active[lane] = begin + lane < directions_.size() ? -1 : 0;
      const glm::vec3 local = directions_[std::min(begin + lane, directions_.size() - 1)];
      const glm::vec3 direction = local.x * u + local.y * v + local.z * n;
      packet.org_x[lane] = from.x;
      packet.org_y[lane] = from.y;
      packet.org_z[lane] = from.z;
      packet.dir_x[lane] = direction.x;
      packet.dir_y[lane] = direction.y;
      packet.dir_z[lane] = direction.z;
      packet.tnear[lane] = packet.time[lane] = 0;
      packet.tfar[lane] = std::numeric_limits<float>::infinity();
      packet.mask[lane] = ~0u;
      packet.id[lane] = packet.flags[lane] = 0;
    }
    trace::embree().Occluded8(active.data(), tree_.scene(), &context, &packet);
    for (std::size_t lane = 0; lane < kLanes; ++lane) hidden += active[lane] && packet.tfar[lane] < 0;
  }
  return static_cast<double>(hidden) / static_cast<double>(directions_.size());
}

}  // namespace brume::decals
