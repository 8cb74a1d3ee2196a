#include "trace/sphere_tree.hpp"

#include <algorithm>

namespace brume::trace {
namespace {

/// What a query hands to the filter.
struct Query {
  RTCIntersectContext context;  // first: Embree hands it on
  std::uint32_t skip;
};

void reject_skipped(const RTCFilterFunctionNArguments* arguments) {
  const auto* const query = reinterpret_cast<const Query*>(arguments->context);
  for (unsigned int i = 0; i < arguments->N; ++i)
    if (arguments->valid[i] != 0 && RTCHitN_primID(arguments->hit, arguments->N, i) == query->skip)
      arguments->valid[i] = 0;
}

}  // namespace

Result<void> SphereTree::build(const std::string& job, std::span<const spheres::Sphere> spheres) {
  if (const auto begun = scene_.begin(job, "the spheres; have fewer"); !begun) return begun;
  if (spheres.empty()) return scene_.commit();
  const Geometry geometry = scene_.make(RTC_GEOMETRY_TYPE_SPHERE_POINT);
  if (!geometry) return scene_.failure();
  void* const points = embree().SetNewGeometryBuffer(
      geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, sizeof(spheres::Sphere), spheres.size());
  if (!points) return scene_.failure();
  std::ranges::copy(spheres, static_cast<spheres::Sphere*>(points));
  embree().SetGeometryIntersectFilterFunction(geometry.get(), reject_skipped);
  if (const auto attached = scene_.attach(geometry); !attached) return attached;
  return scene_.commit();
}

SphereTree::Hit SphereTree::next(const glm::vec3& origin, const glm::vec3& direction, float from, float to,
                                 std::uint32_t skip) const {
  Query query{};
  rtcInitIntersectContext(&query.context);
  query.skip = skip;
  RTCRayHit ray{};
  ray.ray.org_x = origin.x;
  ray.ray.org_y = origin.y;
  ray.ray.org_z = origin.z;
  ray.ray.dir_x = direction.x;
  ray.ray.dir_y = direction.y;
  ray.ray.dir_z = direction.z;
  ray.ray.tnear = from;
  ray.ray.tfar = to;
  ray.ray.mask = UINT32_MAX;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  embree().Intersect1(scene_.get(), &query.context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  return {ray.hit.primID, ray.ray.tfar};
}

}  // namespace brume::trace
