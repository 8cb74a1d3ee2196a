#include "surfaces/surfaces.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/color.hpp"
#include "shared/pane.h"
#include "surfaces/motion.hpp"

namespace brume::surfaces {
namespace {

const std::array<float, 256>& linear_values() {
  static const std::array<float, 256> values = [] {
    std::array<float, 256> all{};
    for (std::size_t i = 0; i < all.size(); ++i)
      all[i] = static_cast<float>(scene::linear_from_srgb(static_cast<double>(i) / 255));
    return all;
  }();
  return values;
}

/// Bilinear; each texel's colours linear if `srgb`.
glm::vec4 image_at(const scene::Image& source, const glm::vec2& uv, bool srgb) {
  const image::Image8& image = source.pixels;
  const auto texels = [](float at, std::uint32_t size, scene::Wrap wrap) {
    const float scaled = scene::wrapped_coordinate(at, wrap) * static_cast<float>(size) - 0.5f;
    const float low = std::floor(scaled);
    const auto texel = static_cast<std::int64_t>(low);
    return std::tuple(scene::wrapped_texel(texel, size, wrap), scene::wrapped_texel(texel + 1, size, wrap),
                      scaled - low);
  };
  const auto [x0, x1, fx] = texels(uv.x, image.width, source.wraps.u);
  const auto [y0, y1, fy] = texels(uv.y, image.height, source.wraps.v);
  const auto texel = [&](std::uint32_t x, std::uint32_t y) {
    const std::uint8_t* const p = image.rgba.data() + std::size_t{4} * (std::size_t{y} * image.width + x);
    const auto& linear = linear_values();
    if (srgb) return glm::vec4(linear[p[0]], linear[p[1]], linear[p[2]], static_cast<float>(p[3]) / 255);
    return glm::vec4(p[0], p[1], p[2], p[3]) / 255.0f;
  };
  return glm::mix(glm::mix(texel(x0, y0), texel(x1, y0), fx), glm::mix(texel(x0, y1), texel(x1, y1), fx), fy);
}

/// The vertices of a triangle, interpolated at barycentric coordinates u and v.
template <typename Member>
auto interpolated(const scene::Mesh& mesh, std::uint32_t triangle, const glm::vec2& at, Member member) {
  const auto vertex = [&](std::uint32_t corner) -> const auto& {
    return mesh.vertices[mesh.indices[std::size_t{3} * triangle + corner]].*member;
  };
  return (1 - at.x - at.y) * vertex(0) + at.x * vertex(1) + at.y * vertex(2);
}

const scene::Image* image_of(const scene::Scene& scene, std::uint32_t index) {
  if (index == scene::kNone || scene.images[index].pixels.rgba.empty()) return nullptr;
  return &scene.images[index];
}

/// What a pane reflects and lets through, as shaders/lib/pane.glsl: of a hit whose albedo is the pane's
/// colour.
void make_pane(const scene::Material& material, float alpha, const glm::vec3& direction, SurfaceHit& hit) {
  const shared::PaneMaterial pane{material.opacity, material.transmission, material.blended ? 1.0f : 0.0f};
  const float weight = shared::pane_weight(pane, alpha);
  const float reflected = shared::pane_reflectance(weight, -glm::dot(hit.reflection.normal, direction));
  hit.is_pane = true;
  hit.passes = shared::pane_tint(pane, weight, hit.reflection.albedo) * (1 - reflected);
  hit.reflection.albedo = shared::pane_albedo(pane, weight, hit.reflection.albedo);
  hit.reflection.metallic = 0;
  hit.reflection.highlight = weight;
}

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

}  // namespace

Surfaces::Surfaces(const scene::Scene& scene, std::span<const planning::LevelState> levels, bool matte)
    : scene_(scene), matte_(matte) {
  const planning::LevelState& level = levels.front();
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i)
    if (!std::ranges::binary_search(level.hidden_objects, i))
      add(scene.objects[i], {scene.objects[i].world_from_mesh});
  for (std::size_t i = 0; i < level.moved.size(); ++i) {
    std::vector<glm::mat4> poses;
    for (const planning::LevelState& later : levels)
      if (i < later.moved.size() && later.moved[i].object == level.moved[i].object)
        poses.push_back(later.moved[i].world_from_mesh);
    add(scene.objects[level.moved[i].object], std::move(poses));
  }
  if (scene.grenade)
    for (const glm::mat4& world_from_mesh : level.grenades)
      add(*scene.grenade, {world_from_mesh * scene.grenade->world_from_mesh});
  build(opaque_, false);
  build(panes_, true);
}

void Surfaces::build(Tree& tree, bool of_panes) {
  std::vector<trace::TriangleMesh> meshes;
  for (std::uint32_t i = 0; i < parts_.size(); ++i) {
    const Part& part = *parts_[i];
    if (part.is_pane != of_panes) continue;
    tree.parts.push_back(i);
    const bool cut_out = part.alpha_cutoff > 0;
    trace::TriangleMesh& mesh = meshes.emplace_back();
    mesh = {part.corners_world.front(),
            part.mesh->indices,
            cut_out ? reject_cut_out : nullptr,
            parts_[i].get(),
            {}};
    for (std::size_t step = 1; step < part.corners_world.size(); ++step)
      mesh.moved.emplace_back(part.corners_world[step]);
  }
  tree.triangles.build("surfaces", meshes).value_or_throw();
}

void Surfaces::add(const scene::Object& object, std::vector<glm::mat4> world_from_mesh) {
  if (object.mesh == scene::kNone || scene_.meshes[object.mesh].indices.empty()) return;
  static const scene::Material kPlain;
  auto part = std::make_unique<Part>();
  part->scene = &scene_;
  part->mesh = &scene_.meshes[object.mesh];
  part->material = object.material == scene::kNone ? &kPlain : &scene_.materials[object.material];
  part->is_pane = scene::is_pane(object);
  part->alpha_cutoff = scene::cutoff_of(object, *part->material);
  // What rests while the shutter is open has one place.
  if (std::ranges::all_of(world_from_mesh,
                          [&](const glm::mat4& pose) { return pose == world_from_mesh.front(); }))
    world_from_mesh.resize(1);
  part->world_from_mesh = std::move(world_from_mesh);
  part->handedness = glm::determinant(glm::mat3(part->world_from_mesh.front())) < 0 ? -1.0f : 1.0f;
  for (const glm::mat4& pose : part->world_from_mesh) {
    std::vector<glm::vec3>& corners = part->corners_world.emplace_back();
    corners.reserve(part->mesh->vertices.size());
    for (const scene::Vertex& vertex : part->mesh->vertices)
      corners.emplace_back(pose * glm::vec4(vertex.position, 1));
  }
  add_emitters(*part);
  parts_.push_back(std::move(part));
}

void Surfaces::add_emitters(Part& part) {
  // Rays alone find emitters that move.
  if (part.material->emission == glm::vec3(0) || part.corners_world.size() > 1) return;
  part.first_emitter = static_cast<std::uint32_t>(emitters_.size());
  const std::vector<std::uint32_t>& indices = part.mesh->indices;
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const glm::vec3 a = part.corners_world.front()[indices[i]],
                    u = part.corners_world.front()[indices[i + 1]] - a,
                    v = part.corners_world.front()[indices[i + 2]] - a;
    emitters_.push_back({a, u, v, part.material->emission, 0.5f * glm::length(glm::cross(u, v))});
  }
}

std::optional<std::uint32_t> Surfaces::emitter_of(const SurfaceHit& hit) const {
  const std::uint32_t first = parts_[hit.part]->first_emitter;
  if (first == scene::kNone) return std::nullopt;
  return first + hit.triangle;
}

void Surfaces::reject_cut_out(const RTCFilterFunctionNArguments* arguments) {
  const Part& part = *static_cast<const Part*>(arguments->geometryUserPtr);
  for (unsigned int i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] == 0) continue;
    const glm::vec2 at(RTCHitN_u(arguments->hit, arguments->N, i),
                       RTCHitN_v(arguments->hit, arguments->N, i));
    const std::uint32_t triangle = RTCHitN_primID(arguments->hit, arguments->N, i);
    float alpha = interpolated(*part.mesh, triangle, at, &scene::Vertex::color).a;
    if (const scene::Image* image = image_of(*part.scene, part.material->base_color_image))
      alpha *= image_at(*image, interpolated(*part.mesh, triangle, at, &scene::Vertex::uv), true).a;
    if (alpha < part.alpha_cutoff) arguments->valid[i] = 0;
  }
}

std::optional<RTCRayHit> Surfaces::intersect(const Tree& tree, const Ray& ray) {
  if (tree.parts.empty()) return std::nullopt;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray = embree_ray(ray);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  trace::embree().Intersect1(tree.triangles.scene(), &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return query;
}

float Surfaces::distance(const Ray& ray) const {
  const std::optional<RTCRayHit> query = intersect(opaque_, ray);
  return query ? query->ray.tfar : ray.end;
}

std::optional<Surfaces::Place> Surfaces::place(const Ray& ray) const {
  const std::optional<RTCRayHit> query = intersect(opaque_, ray);
  if (!query) return std::nullopt;
  const Part& part = *parts_[opaque_.parts[query->hit.geomID]];
  const glm::vec3 across = part.handedness * glm::vec3(query->hit.Ng_x, query->hit.Ng_y, query->hit.Ng_z);
  const float length = glm::length(across);
  const glm::vec3 outward = length > 0 ? across / length : -ray.direction;
  const bool is_front = glm::dot(outward, ray.direction) < 0;
  return Place{ray.at(query->ray.tfar), is_front ? outward : -outward, is_front};
}

SurfaceHit Surfaces::shaded(const Tree& tree, const RTCRayHit& query, const Ray& ray) const {
  SurfaceHit hit;
  hit.t = query.ray.tfar;
  hit.part = tree.parts[query.hit.geomID];
  hit.triangle = query.hit.primID;
  shade(*parts_[hit.part], hit.triangle, {query.hit.u, query.hit.v}, ray, hit);
  return hit;
}

std::optional<SurfaceHit> Surfaces::hit(const Ray& ray) const {
  const std::optional<RTCRayHit> opaque = intersect(opaque_, ray);
  Ray before = ray;
  if (opaque) before.end = opaque->ray.tfar;
  if (const std::optional<RTCRayHit> pane = intersect(panes_, before)) return shaded(panes_, *pane, ray);
  if (!opaque) return std::nullopt;
  return shaded(opaque_, *opaque, ray);
}

std::optional<SurfaceHit> Surfaces::opaque_hit(const Ray& ray) const {
  const std::optional<RTCRayHit> query = intersect(opaque_, ray);
  if (!query) return std::nullopt;
  return shaded(opaque_, *query, ray);
}

glm::vec3 Surfaces::through_panes(Ray ray) const {
  constexpr int kMostPanes = 256;
  glm::vec3 passed(1);
  for (int i = 0; i < kMostPanes; ++i) {
    const std::optional<RTCRayHit> query = intersect(panes_, ray);
    if (!query) return passed;
    const SurfaceHit pane = shaded(panes_, *query, ray);
    passed *= pane.passes;
    const glm::vec3 from = off_surface(pane, ray.direction);
    ray.end -= glm::dot(from - ray.origin, ray.direction);
    ray.origin = from;
    if (passed == glm::vec3(0) || !(ray.end > 0)) return passed;
  }
  return glm::vec3(0);
}

bool Surfaces::occluded(const Ray& ray) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay query = embree_ray(ray);
  trace::embree().Occluded1(opaque_.triangles.scene(), &context, &query);
  return query.tfar < 0;
}

void Surfaces::shade(const Part& part, std::uint32_t triangle, const glm::vec2& at, const Ray& ray,
                     SurfaceHit& hit) const {
  // Place, at the ray's time. Barycentric coordinates are closer to the triangle than the ray's end.
  const auto corner = [&](std::uint32_t i) {
    const std::uint32_t vertex = part.mesh->indices[std::size_t{3} * triangle + i];
    std::array<glm::vec3, kMostSteps> steps;
    for (std::size_t step = 0; step < part.corners_world.size(); ++step)
      steps[step] = part.corners_world[step][vertex];
    return at_time(std::span<const glm::vec3>(steps.data(), part.corners_world.size()), ray.time);
  };
  const glm::vec3 a = corner(0), u = corner(1) - a, v = corner(2) - a;
  hit.position = a + at.x * u + at.y * v;
  const glm::vec3 across = glm::cross(u, v) * part.handedness;
  const float length = glm::length(across);
  // Counter-clockwise seen from outside.
  const bool front = glm::dot(across, ray.direction) < 0;
  hit.geometric_normal = length > 0 ? across / length : -ray.direction;
  if (!front) hit.geometric_normal = -hit.geometric_normal;

  // Material, as shaders/gbuffer.frag.
  const scene::Material& material = *part.material;
  const glm::vec2 uv = interpolated(*part.mesh, triangle, at, &scene::Vertex::uv);
  glm::vec4 base = interpolated(*part.mesh, triangle, at, &scene::Vertex::color);
  if (const scene::Image* image = image_of(scene_, material.base_color_image))
    base *= image_at(*image, uv, true);
  glm::vec2 rough_metal(1);
  if (const scene::Image* image = image_of(scene_, material.roughness_image)) {
    const glm::vec4 texel = image_at(*image, uv, false);
    rough_metal = {texel.g, texel.b};
  }
  hit.reflection.albedo = glm::clamp(glm::vec3(base) * material.base_color, 0.0f, 1.0f);
  hit.reflection.roughness = std::clamp(material.roughness * rough_metal.x, 0.0f, 1.0f);
  hit.reflection.metallic = std::clamp(material.metallic * rough_metal.y, 0.0f, 1.0f);
  if (matte_) hit.reflection.highlight = hit.reflection.metallic = 0;
  hit.emission = material.emission;

  // Normal. The cofactor matrix transforms normals correctly under any scale, mirroring included.
  const glm::mat3 linear(at_time<glm::mat4>(part.world_from_mesh, ray.time));
  const glm::mat3 cofactor(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                           glm::cross(linear[0], linear[1]));
  glm::vec3 n = part.handedness * (cofactor * interpolated(*part.mesh, triangle, at, &scene::Vertex::normal));
  n = glm::dot(n, n) > 0 ? glm::normalize(n) : hit.geometric_normal;
  if (const scene::Image* image = image_of(scene_, material.normal_image)) {
    const glm::vec4 stored = interpolated(*part.mesh, triangle, at, &scene::Vertex::tangent);
    const glm::vec3 along = linear * glm::vec3(stored), t = along - n * glm::dot(n, along);
    if (glm::dot(t, t) > 1e-12f) {
      const glm::vec3 mapped = glm::vec3(image_at(*image, uv, false)) * 2.0f - 1.0f,
                      tangent = glm::normalize(t);
      n = glm::normalize(mapped.x * tangent + mapped.y * stored.w * part.handedness * glm::cross(n, tangent) +
                         mapped.z * n);
    }
  }
  hit.reflection.normal = front ? n : -n;
  if (part.is_pane) make_pane(material, base.a, ray.direction, hit);
}

glm::vec3 Surfaces::off_surface(const SurfaceHit& hit, const glm::vec3& direction) {
  const glm::vec3 size = glm::abs(hit.position);
  const float off = 2e-6f * std::max({size.x, size.y, size.z, 5.0f});
  return hit.position + (glm::dot(direction, hit.geometric_normal) < 0 ? -off : off) * hit.geometric_normal;
}

}  // namespace brume::surfaces
