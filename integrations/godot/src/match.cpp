#include "match.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace brume::godot {
namespace {

brume_position position(const brume_point& point) {
  return api::position(point.x, point.y, point.z);
}

}  // namespace

Match::Running::Running(api::Level made, const api::Masks& masks)
    : level(std::move(made)),
      world(level,
            [&] {
              brume_world_params params = brume_world_defaults();
              params.masks = masks.get();
              return params;
            }()),
      field(level, [&] {
        brume_field_params params = brume_field_defaults();
        params.masks = masks.get();
        return params;
      }()) {}

std::int64_t Match::add_mask(std::uint32_t width, std::uint32_t height, std::vector<std::uint8_t> texels) {
  if (std::uint64_t{width} * height != texels.size())
    throw std::invalid_argument("a mask of " + std::to_string(width) + " x " + std::to_string(height) +
                                " texels has a byte for each, not " + std::to_string(texels.size()));
  masks_.push_back({width, height, std::move(texels)});
  try {
    masks();
  } catch (...) {
    masks_.pop_back();
    throw;
  }
  return static_cast<std::int64_t>(masks_.size()) - 1;
}

api::Masks Match::masks() const {
  std::vector<brume_mask_image> images;
  for (const Mask& mask : masks_) images.push_back({mask.width, mask.height, mask.texels.data()});
  return api::Masks(context_, images);
}

void Match::level_from_boxes(const std::vector<Box>& boxes, double voxel_size) {
  constexpr std::array<std::int32_t, 36> kFaces{0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                                2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  std::vector<brume_point> points;
  std::vector<std::int32_t> indices;
  for (const Box& box : boxes) {
    const auto first = static_cast<std::int32_t>(points.size());
    for (int i = 0; i < 8; ++i)
      points.push_back(
          {i & 1 ? box.high.x : box.low.x, i & 2 ? box.high.y : box.low.y, i & 4 ? box.high.z : box.low.z});
    for (const std::int32_t corner : kFaces) indices.push_back(first + corner);
  }
  level_from_triangles(points, indices, {}, voxel_size);
}

void Match::level_from_triangles(const std::vector<brume_point>& points,
                                 const std::vector<std::int32_t>& indices,
                                 const std::vector<std::uint8_t>& roles, double voxel_size) {
  if (!roles.empty() && roles.size() != indices.size() / 3)
    throw std::invalid_argument("a role for each triangle is expected: " +
                                std::to_string(indices.size() / 3) + ", not " + std::to_string(roles.size()));
  // An index below 0 becomes one that the library refuses.
  const std::vector<std::uint32_t> corners(indices.begin(), indices.end());
  brume_triangles_params params = brume_triangles_defaults();
  params.layout.voxel_size = static_cast<float>(voxel_size);
  params.points = points.data();
  params.point_count = points.size();
  params.indices = corners.data();
  params.index_count = corners.size();
  params.roles = roles.empty() ? nullptr : roles.data();
  running_ = std::make_unique<Running>(api::Level(context_, params), masks());
}

std::vector<float> Match::layout() {
  const brume_layout layout = running().level.layout();
  return {layout.origin.x,
          layout.origin.y,
          layout.origin.z,
          static_cast<float>(layout.size.x),
          static_cast<float>(layout.size.y),
          static_cast<float>(layout.size.z),
          layout.voxel_size};
}

void Match::throw_smoke(brume_point from, brume_point at, double cubic_metres) {
  brume_event event = next_event(BRUME_EVENT_SMOKE);
  event.u.smoke.from = position(from);
  event.u.smoke.at = position(at);
  event.u.smoke.voxels =
      brume_smoke_voxels(cubic_metres, static_cast<double>(running().level.layout().voxel_size));
  world().append(event);
}

void Match::shoot(brume_point origin, brume_point toward, double radius) {
  brume_event event = next_event(BRUME_EVENT_SHOT);
  event.u.shot.origin = position(origin);
  event.u.shot.toward = position(toward);
  event.u.shot.radius_1024 = brume_length(radius);
  world().append(event);
}

void Match::shoot_mask(brume_point origin, brume_point toward, double half_size, std::uint32_t mask,
                       double stay_open_seconds) {
  brume_event event = next_event(BRUME_EVENT_SHOT);
  event.u.shot.origin = position(origin);
  event.u.shot.toward = position(toward);
  event.u.shot.radius_1024 = brume_length(half_size);
  event.u.shot.shape = BRUME_HOLE_MASK;
  event.u.shot.mask_index = mask;
  event.u.shot.stay_open_ms = static_cast<std::uint32_t>(std::clamp(stay_open_seconds, 0.0, 1e6) * 1000);
  world().append(event);
}

void Match::blast(brume_point at, double radius) {
  brume_event event = next_event(BRUME_EVENT_BLAST);
  event.u.blast.at = position(at);
  event.u.blast.radius_1024 = brume_length(radius);
  world().append(event);
}

void Match::move(std::uint32_t body, brume_point to) {
  brume_event event = next_event(BRUME_EVENT_MOVE);
  event.u.move.body = body;
  event.u.move.to = position(to);
  world().append(event);
}

void Match::edit(const Box& box, bool solid) {
  const brume_layout layout = running().level.layout();
  // The first voxel whose middle is not below a coordinate.
  const auto voxel = [&](float at, float origin) {
    return static_cast<std::int32_t>(std::ceil((at - origin) / layout.voxel_size - 0.5f));
  };
  const auto corner = [&](const brume_point& point) {
    return brume_voxel{voxel(point.x, layout.origin.x), voxel(point.y, layout.origin.y),
                       voxel(point.z, layout.origin.z)};
  };
  brume_event event = next_event(BRUME_EVENT_EDIT);
  event.u.edit.low = corner(box.low);
  event.u.edit.high = corner(box.high);
  event.u.edit.solid = solid;
  world().append(event);
}

void Match::append(std::uint32_t kind, std::uint32_t tick, const std::vector<std::int32_t>& members) {
  brume_event event = brume_event_defaults(kind, tick);
  if (members.size() > std::size(event.u.reserved))
    throw std::invalid_argument("an event has at most 32 members, not " + std::to_string(members.size()));
  if (!members.empty()) std::memcpy(event.u.reserved, members.data(), members.size() * sizeof members[0]);
  world().append(event);
}

std::vector<brume_segment> Match::lines_of(const std::vector<brume_point>& ends) {
  if (ends.size() % 2 != 0)
    throw std::invalid_argument("pairs of points are expected, not " + std::to_string(ends.size()) +
                                " points");
  std::vector<brume_segment> lines;
  for (std::size_t i = 0; i < ends.size(); i += 2) lines.push_back({ends[i], ends[i + 1]});
  return lines;
}

std::vector<float> Match::depths(const std::vector<brume_point>& ends) {
  return field().optical_depths(lines_of(ends));
}

std::vector<float> Match::drawn_depths(const std::vector<brume_point>& ends) {
  return field().drawn_depths(lines_of(ends));
}

bool Match::sees(brume_point a, brume_point b, double threshold) {
  return field().visible({a, b}, static_cast<float>(threshold));
}

void Match::make_textures(std::uint32_t light_count, bool sky) {
  running().textures.emplace(field(), light_count, sky);
}

void Match::update_textures(double seconds, const std::vector<brume_point>& lights,
                            const std::vector<std::uint8_t>& suns, double light_fraction) {
  textures().update(field(), seconds, lights, suns, light_fraction);
}

SmokeTextures& Match::textures() {
  Running& now = running();
  if (!now.textures) throw std::logic_error("there are no textures: call make_textures");
  return *now.textures;
}

Match::Running& Match::running() {
  if (!running_) throw std::logic_error("there is no level: call level_from_boxes or level_from_triangles");
  return *running_;
}

api::Field& Match::field() {
  Running& now = running();
  const std::uint64_t hash = now.world.hash();
  if (now.in_field != hash) {
    now.field.update(now.world.state());
    now.in_field = hash;
  }
  return now.field;
}

brume_event Match::next_event(brume_event_kind kind) {
  return brume_event_defaults(kind, world().tick() + 1);
}

}  // namespace brume::godot
