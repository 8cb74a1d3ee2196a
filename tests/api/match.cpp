#include "tests/api/match.hpp"

#include <algorithm>

#include "tests/api/event_structs.hpp"
#include "voxel/level_hash.hpp"

namespace brume::api {
namespace {

constexpr brume_voxel kDoorLow{23, 1, 16}, kDoorHigh{25, 7, 21};
constexpr std::uint32_t kMaskSide = 24;

}  // namespace

Match::Match(unsigned seed) : random_(seed) {
  // The level.
  add_quad({0, 0.3f, 0}, {24, 0.3f, 0}, {24, 0.3f, 20}, {0, 0.3f, 20});
  for (const float x : {0.2f, 12.1f, 23.8f}) {
    add_quad({x, 0, 0}, {x, 6, 0}, {x, 6, 8}, {x, 0, 8});
    add_quad({x, 3.5f, 8}, {x, 6, 8}, {x, 6, 10.5f}, {x, 3.5f, 10.5f});
    add_quad({x, 0, 10.5f}, {x, 6, 10.5f}, {x, 6, 20}, {x, 0, 20});
  }
  for (const float z : {0.2f, 19.8f}) add_quad({0, 0, z}, {24, 0, z}, {24, 6, z}, {0, 6, z});
  add_quad({14, 0.3f, 2}, {18, 0.3f, 3}, {18, 3.2f, 7}, {14, 2.9f, 6});

  // The masks.
  for (auto& mask : texels)
    for (std::uint32_t i = 0; i < kMaskSide * kMaskSide; ++i)
      mask.push_back(static_cast<std::uint8_t>(i / 5 % 3 == 0 ? below(256) : 255 * below(2)));

  // The events.
  for (std::uint32_t tick = 0; tick < kTicks; ++tick) {
    brume_event move = brume_event_defaults(BRUME_EVENT_MOVE, tick);
    move.u.move = {tick % 3, place()};
    if (tick % 7 == 0) events.push_back(move);
    brume_event smoke = brume_event_defaults(BRUME_EVENT_SMOKE, tick);
    smoke.u.smoke = {place(), place(), static_cast<std::uint32_t>(300 + below(900)), 30, 120, 60};
    if (tick % 60 == 5) events.push_back(smoke);
    if (tick % 9 == 4) add_shot(tick, tick / 9);
    brume_event blast = brume_event_defaults(BRUME_EVENT_BLAST, tick);
    blast.u.blast.at = place();
    if (tick % 110 == 80) events.push_back(blast);
    brume_event door = brume_event_defaults(BRUME_EVENT_EDIT, tick);
    door.u.edit = {kDoorLow, kDoorHigh, tick % 180 == 90};
    if (tick % 90 == 0 && tick > 0) events.push_back(door);
  }
}

void Match::add_quad(brume_point a, brume_point b, brume_point c, brume_point d) {
  const auto first = static_cast<std::uint32_t>(points.size());
  points.insert(points.end(), {a, b, c, d});
  for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) indices.push_back(first + i);
}

brume_position Match::place() {
  const int x = 1024 + below(22 * 1024);
  const int y = 700 + below(4 * 1024);
  const int z = 1024 + below(18 * 1024);
  return {x, y, z};
}

void Match::add_shot(std::uint32_t tick, std::uint32_t number) {
  brume_event event = brume_event_defaults(BRUME_EVENT_SHOT, tick);
  brume_shot_event& shot = event.u.shot;
  shot.origin = place();
  shot.toward = place();
  shot.radius_1024 = static_cast<std::uint32_t>(100 + below(400));
  shot.shape = number % 3;
  if (shot.shape == BRUME_HOLE_MASK) shot.mask_index = number / 3 % kMasks;
  if (shot.shape != BRUME_HOLE_CYLINDER) shot.roll_65536 = static_cast<std::uint32_t>(below(65536));
  events.push_back(event);
}

brume_layout Match::layout() const {
  return {{48, 12, 40}, 0.5f, {0, 0, 0}};
}

voxel::GridLayout Match::grid_layout() const {
  return {{48, 12, 40}, 0.5f, glm::vec3(0)};
}

std::vector<voxel::Triangle> Match::triangles() const {
  const auto corner = [&](std::size_t i) {
    const brume_point& p = points[indices[i]];
    return glm::vec3(p.x, p.y, p.z);
  };
  std::vector<voxel::Triangle> out;
  for (std::size_t i = 0; i < indices.size(); i += 3)
    out.push_back({corner(i), corner(i + 1), corner(i + 2)});
  return out;
}

std::vector<smoke::Mask> Match::sim_masks() const {
  std::vector<smoke::Mask> out;
  for (const auto& mask : texels) out.push_back({kMaskSide, kMaskSide, mask});
  return out;
}

sim::World Match::sim_world(const voxel::BitGrid& level) const {
  const std::uint64_t hash = voxel::level_hash(level, voxel::SurfacePlanes::build(triangles(), level));
  sim::World world(level, {.masks = smoke::MaskAtlas::pack(sim_masks())->key(), .level_hash = hash});
  for (const brume_event& event : events) world.append(sim_event(event, grid_layout())).value_or_throw();
  return world;
}

brume_triangles_params Match::triangle_params() const {
  brume_triangles_params params = brume_triangles_defaults();
  params.layout = layout();
  params.points = points.data();
  params.point_count = points.size();
  params.indices = indices.data();
  params.index_count = indices.size();
  return params;
}

Masks Match::masks(const Context& context) const {
  std::vector<brume_mask_image> images;
  for (const auto& mask : texels) images.push_back({kMaskSide, kMaskSide, mask.data()});
  return Masks(context, images);
}

std::vector<brume_segment> Match::segments(std::size_t count, unsigned seed) const {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> fraction(-0.05f, 1.05f);
  const auto point = [&] {
    const float x = 24 * fraction(random);
    const float y = 6 * fraction(random);
    const float z = 20 * fraction(random);
    return brume_point{x, y, z};
  };
  std::vector<brume_segment> out;
  for (std::size_t i = 0; i < count; ++i) {
    const brume_point a = point();
    out.push_back({a, point()});
  }
  return out;
}

}  // namespace brume::api
