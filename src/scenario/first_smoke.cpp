#include "scenario/first_smoke.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "scene/ray.hpp"

namespace brume::scenario {
namespace {

/// The part of the ray origin + t * direction, t >= 0, inside a box; empty: x > y.
glm::vec2 span_inside(const Box<float>& box, glm::vec3 origin, glm::vec3 direction) {
  glm::vec2 span(0, 1e30f);
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) {
      if (origin[axis] < box.low[axis] || origin[axis] > box.high[axis]) return {1, 0};
      continue;
    }
    const float a = (box.low[axis] - origin[axis]) / direction[axis];
    const float b = (box.high[axis] - origin[axis]) / direction[axis];
    span = {std::max(span.x, std::min(a, b)), std::min(span.y, std::max(a, b))};
  }
  return span;
}

/// Whether a point is beyond the bounds of the level: the view of it enters them and leaves them again.
bool is_beyond(const Box<float>& bounds, glm::vec3 eye, glm::vec3 point) {
  if (bounds.empty()) return false;
  const glm::vec2 inside = span_inside(bounds, eye, point - eye);
  return inside.x > 0 && inside.x < inside.y && inside.y < 1;
}

/// The middle of a grown smoke, half in the floor that it went off on.
glm::vec3 middle_of_smoke(glm::vec3 place, float diameter) {
  return place + glm::vec3(0, 0.25f * diameter, 0);
}

struct ViewAxes {
  glm::vec3 forward, right, up;
};

ViewAxes axes_of(const scene::Camera& camera) {
  const glm::vec3 forward = glm::normalize(camera.target_world - camera.position_world);
  // Straight down, any direction is to the right.
  const glm::vec3 across = glm::cross(forward, glm::vec3(0, 1, 0));
  const glm::vec3 right = glm::length(across) > 1e-4f ? glm::normalize(across) : glm::vec3(1, 0, 0);
  return {forward, right, glm::cross(right, forward)};
}

bool is_in_view(const SmokeView& view, glm::vec3 point) {
  const ViewAxes axes = axes_of(view.camera);
  const glm::vec3 off = point - view.camera.position_world;
  const float depth = glm::dot(off, axes.forward), high = depth * std::tan(view.camera.vertical_fov / 2);
  return depth > 0 && std::abs(glm::dot(off, axes.up)) < high &&
         std::abs(glm::dot(off, axes.right)) < high * view.aspect;
}

/// A little before a surface as the camera sees it.
glm::vec3 before(const scene::Camera& camera, glm::vec3 surface, float diameter) {
  const glm::vec3 along = surface - camera.position_world;
  const float distance = glm::length(along);
  if (!(distance > 0)) return surface;
  return surface - along / distance * std::min(0.35f * diameter, 0.5f * distance);
}

/// The floor below a point, or the point where there is none.
glm::vec3 on_floor(const scene::Scene& scene, glm::vec3 point, float diameter) {
  const auto floor = scene::first_hit(scene, point, {0, -1, 0});
  return floor ? *floor + glm::vec3(0, 0.04f * diameter, 0) : point;
}

/// Points before which smoke may be seen where that before the subject is not, best first.
std::array<glm::vec3, 4> other_points(const scene::Scene& scene, const scene::Camera& camera,
                                      glm::vec3 subject, float diameter) {
  const glm::vec3 eye = camera.position_world;
  const ViewAxes axes = axes_of(camera);
  const Box<float> bounds = scene::level_bounds(scene);
  const glm::vec3 middle = bounds.empty() ? subject : 0.5f * (bounds.low + bounds.high);
  const glm::vec3 extent = bounds.empty() ? glm::vec3(0) : bounds.high - bounds.low;
  const float aside = 0.5f * glm::dot(extent, glm::abs(axes.right)) + 0.6f * diameter;
  const glm::vec2 inside = bounds.empty() ? glm::vec2(1, 0) : span_inside(bounds, eye, subject - eye);
  const glm::vec3 entry = inside.x > 0 && inside.x < inside.y ? glm::mix(eye, subject, inside.x) : subject;
  return {entry, middle + aside * axes.right, middle - aside * axes.right, glm::mix(eye, subject, 0.5f)};
}

/// Whether a grown smoke stands before most of a level that is seen from outside and hardly larger.
bool hides_level(const Box<float>& bounds, const SmokeView& view, glm::vec3 place, float diameter) {
  const glm::vec3 eye = view.camera.position_world;
  if (bounds.empty() || bounds.contains(eye)) return false;
  const glm::vec3 extent = bounds.high - bounds.low, middle = 0.5f * (bounds.low + bounds.high);
  const glm::vec3 along = middle - eye, smoke = middle_of_smoke(place, diameter) - eye;
  const float t = glm::dot(smoke, along) / glm::dot(along, along);
  return t > 0 && t < 1 && glm::length(smoke - t * along) < 0.5f * diameter &&
         std::max({extent.x, extent.y, extent.z}) < 4 * diameter;
}

/// Where a grown smoke stands beside the level, in view as a whole; empty: nowhere.
std::optional<glm::vec3> place_beside(const scene::Scene& scene, const SmokeView& view, float diameter) {
  const ViewAxes axes = axes_of(view.camera);
  const Box<float> bounds = scene::level_bounds(scene);
  const glm::vec3 middle = 0.5f * (bounds.low + bounds.high), extent = bounds.high - bounds.low;
  const float aside = 0.5f * glm::dot(extent, glm::abs(axes.right)) + 0.6f * diameter;
  std::array places{middle + aside * axes.right, middle - aside * axes.right};
  // First the one that is nearer to the middle of the view.
  const auto off = [&](glm::vec3 place) {
    return std::abs(glm::dot(place - view.camera.position_world, axes.right));
  };
  if (off(places[1]) < off(places[0])) std::swap(places[0], places[1]);
  for (glm::vec3 place : places) {
    place.y = bounds.low.y;
    const glm::vec3 smoke = middle_of_smoke(place, diameter);
    const bool is_whole = is_in_view(view, smoke + 0.5f * diameter * axes.right) &&
                          is_in_view(view, smoke - 0.5f * diameter * axes.right);
    if (is_whole && is_smoke_seen(scene, view, place, diameter)) return place;
  }
  return std::nullopt;
}

}  // namespace

glm::vec3 subject_point(const scene::Scene& scene, const scene::Camera& camera) {
  const glm::vec3 eye = camera.position_world, along = camera.target_world - eye;
  const glm::vec3 surface = scene::first_hit(scene, eye, along).value_or(camera.target_world);
  const Box<float> bounds = scene::level_bounds(scene);
  if (!is_beyond(bounds, eye, surface)) return surface;
  return eye + span_inside(bounds, eye, along).x * along;
}

bool is_smoke_seen(const scene::Scene& scene, const SmokeView& view, glm::vec3 place_world, float diameter) {
  const glm::vec3 eye = view.camera.position_world, middle = middle_of_smoke(place_world, diameter);
  if (is_beyond(scene::level_bounds(scene), eye, middle)) return false;
  if (view.is_fixed && !is_in_view(view, middle)) return false;
  const ViewAxes axes = axes_of(view.camera);
  const float aside = 0.35f * diameter;
  int hidden = 0;
  for (const glm::vec3 point : {middle, middle + aside * axes.right, middle - aside * axes.right,
                                middle + 0.3f * diameter * axes.up}) {
    const auto hit = scene::first_hit(scene, eye, point - eye);
    if (hit && glm::distance(eye, *hit) < 0.999f * glm::distance(eye, point)) ++hidden;
  }
  return hidden < 2;
}

glm::vec3 choose_smoke_place(const scene::Scene& scene, const SmokeView& view, float diameter) {
  const glm::vec3 subject = subject_point(scene, view.camera);
  const auto is_seen = [&](glm::vec3 place) { return is_smoke_seen(scene, view, place, diameter); };
  const glm::vec3 usual = on_floor(scene, before(view.camera, subject, diameter), diameter);
  if (view.is_of_scene && hides_level(scene::level_bounds(scene), view, usual, diameter))
    if (const auto beside = place_beside(scene, view, diameter)) return *beside;
  if (is_seen(usual)) return usual;
  const auto others = other_points(scene, view.camera, subject, diameter);
  for (const glm::vec3 point : others) {
    const glm::vec3 place = on_floor(scene, before(view.camera, point, diameter), diameter);
    if (is_seen(place)) return place;
  }
  // In the air, where no floor is in view.
  for (const glm::vec3 point : {subject, others.front(), others.back()}) {
    const glm::vec3 place = before(view.camera, point, diameter) - glm::vec3(0, 0.25f * diameter, 0);
    if (is_seen(place)) return place;
  }
  return usual;
}

}  // namespace brume::scenario
