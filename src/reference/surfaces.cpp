#include "reference/surfaces.hpp"

#include <algorithm>

namespace brume::reference {
namespace {

RTCRay embree_ray(const Ray& ray) {
  return {ray.origin.x,
          ray.origin.y,
          ray.origin.z,
          0,
          ray.direction.x,
          ray.direction.y,
          ray.direction.z,
          ray.time,
          ray.end,
          ~0u,
          0,
          0};
}

void reject_cut_out(const RTCFilterFunctionNArguments* arguments) {
  const auto& part = *static_cast<const SurfaceParts::Part*>(arguments->geometryUserPtr);
  for (unsigned int i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] == 0) continue;
    const glm::vec2 at(RTCHitN_u(arguments->hit, arguments->N, i),
                       RTCHitN_v(arguments->hit, arguments->N, i));
    if (part.is_cut_out(RTCHitN_primID(arguments->hit, arguments->N, i), at)) arguments->valid[i] = 0;
  }
}

}  // namespace

Surfaces::Surfaces(const scene::Scene& scene, std::span<const planning::LevelState> levels, bool matte)
    : parts_(scene, levels, matte) {
  std::vector<trace::TriangleMesh> meshes;
  for (const auto& part : parts_.all()) {
    trace::TriangleMesh& mesh = meshes.emplace_back();
    mesh = {part->corners_world.front(),
            part->mesh->indices,
            part->has_holes() ? reject_cut_out : nullptr,
            part.get(),
            {}};
    for (std::size_t step = 1; step < part->corners_world.size(); ++step)
      mesh.moved.emplace_back(part->corners_world[step]);
  }
  tree_.build("reference", meshes).value_or_throw();
}

RTCRayHit Surfaces::intersect(const Ray& ray) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray = embree_ray(ray);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(tree_.scene(), &context, &query);
  return query;
}

float Surfaces::distance(const Ray& ray) const {
  return intersect(ray).ray.tfar;
}

std::optional<SurfaceHit> Surfaces::hit(const Ray& ray) const {
  const RTCRayHit query = intersect(ray);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  SurfaceHit hit;
  hit.t = query.ray.tfar;
  hit.part = query.hit.geomID;
  hit.triangle = query.hit.primID;
  parts_.shade({query.hit.u, query.hit.v}, ray, hit);
  return hit;
}

bool Surfaces::occluded(const Ray& ray) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay query = embree_ray(ray);
  rtcOccluded1(tree_.scene(), &context, &query);
  return query.tfar < 0;
}

glm::vec3 Surfaces::off_surface(const SurfaceHit& hit, const glm::vec3& direction) {
  const glm::vec3 size = glm::abs(hit.position);
  const float off = 2e-6f * std::max({size.x, size.y, size.z, 5.0f});
  return hit.position + (glm::dot(direction, hit.geometric_normal) < 0 ? -off : off) * hit.geometric_normal;
}

}  // namespace brume::reference
