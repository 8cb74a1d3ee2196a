#include <algorithm>
#include <cmath>
#include <limits>

#include "api/ranges.hpp"
#include "api/smoke_field.hpp"
#include "core/tasks.hpp"
#include "scene/smoke_options.hpp"
#include "shared/volume.h"
#include "sim/event_fields.hpp"

namespace brume::api {
namespace {

constexpr std::size_t kChunk = 65536;
constexpr std::size_t kGrain = 512;
/// Up to so many segments, one after the other is faster than a packet of them; the results are the same
/// bits.
constexpr std::size_t kFew = 4;

void create_field(Call& call, const brume_level* level, const brume_field_params* given,
                  brume_field** field) {
  const brume_level& owner = call.handle(level);
  required(field, "field");
  const brume_field_params params = params_or_defaults(given);
  // Beyond the range of a timeline's: 0 hides nothing, and queries have no picture that becomes too dark.
  require(params.extinction >= 0 && params.extinction <= 1e6f, "`extinction` must be from 0 to 10^6");
  create(field, owner.settings, owner.data, atlas_of(call, params.masks), params.extinction);
}

void update(brume_field& field, const sim::State& state) {
  // A field follows worlds of any tick rate.
  sim::State own;
  own.layout = field.level->grid.layout();
  own.level_hash = field.level->hash;
  own.ticks_per_second = state.ticks_per_second;
  own.masks = field.field->smoke().masks();
  if (const auto reason = sim::foreign_reason(state, own, "the field")) fail(BRUME_ERROR_MISMATCH, *reason);
  if (state.edits) unwrap(sim::check_event(sim::LevelEdit{0, *state.edits}, state.layout), BRUME_ERROR_DATA);
  if (field.broken) field.renew();
  field.field->update(state);
}

smoke::Segment to_segment(const brume_segment& s) {
  return {{s.a.x, s.a.y, s.a.z}, {s.b.x, s.b.y, s.b.z}};
}

template <typename Out>
void check_queries(const brume_segment* segments, std::size_t count, const Out* out) {
  require(count <= BRUME_MAX_QUERIES, "at most 2^28 segments");
  if (count == 0) return;
  required(segments, "segments");
  required(out, "the output");
  for (std::size_t i = 0; i < count; ++i)
    if (!is_in_world(segments[i].a) || !is_in_world(segments[i].b))
      refuse("segment " + std::to_string(i) +
             " must have finite coordinates within 16384 m of the world's origin");
}

const auto of_smoke = [](const SmokeField& field) { return &field.sight(); };

/// The sight of a field's smoke as it is drawn.
auto as_drawn(const brume_drawn_params* given) {
  return [given](const SmokeField& field) { return field.drawn_sight(noise_look_of(given)); };
}

/// Answers queries: query(segments of a chunk, their results).
template <typename Out, typename Query>
brume_result answer(const char* function, const brume_field* field, const brume_segment* segments,
                    std::size_t count, Out* out, Query query, const auto& sight_of) noexcept {
  return Call(function).run([&](Call& call) {
    const brume_field& object = call.handle(field);
    check_queries(segments, count, out);
    call.read(object, [&] {
      const auto sight = sight_of(*object.field);
      std::vector<smoke::Segment> chunk(std::min(count, kChunk));
      for (std::size_t first = 0; first < count; first += kChunk) {
        const std::size_t size = std::min(kChunk, count - first);
        std::transform(segments + first, segments + first + size, chunk.begin(), to_segment);
        query(*sight, std::span<const smoke::Segment>(chunk).first(size), std::span(out + first, size));
      }
    });
  });
}

void find_depths(const smoke::Sight& sight, std::span<const smoke::Segment> segments, std::span<float> out) {
  if (segments.size() > kFew) return unwrap(sight.optical_depths(segments, out));
  for (std::size_t i = 0; i < segments.size(); ++i)
    out[i] = unwrap(sight.optical_depth(segments[i].a_world, segments[i].b_world));
}

void find_visible(const smoke::Sight& sight, std::span<const smoke::Segment> segments, float threshold,
                  std::span<std::uint8_t> out) {
  if (segments.size() > kFew) return unwrap(sight.visible(segments, threshold, out));
  for (std::size_t i = 0; i < segments.size(); ++i)
    out[i] = unwrap(sight.visible(segments[i].a_world, segments[i].b_world, threshold)) ? 1 : 0;
}

void find_walls(const smoke::Sight& sight, std::span<const smoke::Segment> segments,
                std::span<brume_wall> out) {
  parallel_for(segments.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto wall = unwrap(sight.first_wall(segments[i].a_world, segments[i].b_world));
      out[i] = {};
      if (!wall) continue;
      out[i] = {1,
                {wall->voxel.x, wall->voxel.y, wall->voxel.z},
                {wall->normal.x, wall->normal.y, wall->normal.z},
                wall->distance};
    }
  });
}

/// Copies the densities of a box, row by row of a brick.
void read_densities(const smoke::SmokeVolume& volume, glm::ivec3 low, glm::ivec3 high, std::uint8_t* out) {
  const glm::ivec3 size = high - low;
  std::fill_n(
      out,
      static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z),
      std::uint8_t{0});
  constexpr int kTexels = shared::kBrickTexels;
  for (int z = low.z; z < high.z; ++z)
    for (int y = low.y; y < high.y; ++y)
      for (int x = low.x; x < high.x;) {
        const glm::ivec3 brick = glm::ivec3(x, y, z) >> 3;
        const int end = std::min(high.x, (brick.x + 1) * 8);
        if (const std::uint32_t slot = volume.slot_at(brick); slot != smoke::SmokeVolume::kNoSlot) {
          const auto row = volume.texels(slot).subspan(
              static_cast<std::size_t>(1 + kTexels * ((y & 7) + 1 + kTexels * ((z & 7) + 1))), 8);
          for (int i = x; i < end; ++i) out[i - x] = row[static_cast<std::size_t>(i & 7)].density;
        }
        out += end - x;
        x = end;
      }
}

}  // namespace

smoke::NoiseLook noise_look_of(const brume_drawn_params* given) {
  const brume_drawn_params params = params_or_defaults(given);
  scene::SmokeOptions options;
  options.erosion = params.erosion;
  options.noise_size = params.noise_size;
  options.detail = params.detail;
  options.hole_rim = params.hole_rim;
  options.swirl = params.swirl;
  options.rise = params.rise;
  scene::visit_smoke_options(options, RangeCheck("`"));
  return {params.erosion, params.noise_size, params.detail, params.hole_rim, params.swirl, params.rise};
}

}  // namespace brume::api

using namespace brume::api;
using brume::smoke::Segment;
using brume::smoke::Sight;

extern "C" {

brume_result brume_field_create(const brume_level* level, const brume_field_params* params,
                                brume_field** field) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) { create_field(call, level, params, field); });
}

brume_result brume_field_destroy(brume_field* field) BRUME_NOEXCEPT {
  return destroy(__func__, field);
}

brume_result brume_field_update(brume_field* field, const brume_state* state) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    brume_field& object = call.handle(field);
    const brume_state& from = call.handle(state);
    call.change(
        object, [&] { update(object, from.state); }, true);
  });
}

brume_result brume_field_changed_bricks(const brume_field* field, brume_voxel* bricks, size_t capacity,
                                        size_t* count) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_field& object = call.handle(field);
    call.read(object, [&] {
      const std::vector<brume_voxel> changed = object.field->changed_bricks();
      write_list(std::span<const brume_voxel>(changed), bricks, capacity, count);
    });
  });
}

brume_result brume_field_optical_depths(const brume_field* field, const brume_segment* segments, size_t count,
                                        float* depths) BRUME_NOEXCEPT {
  return answer(__func__, field, segments, count, depths, find_depths, of_smoke);
}

brume_result brume_field_visible(const brume_field* field, const brume_segment* segments, size_t count,
                                 float threshold, uint8_t* visible) BRUME_NOEXCEPT {
  return answer(
      __func__, field, segments, count, visible,
      [&](const Sight& sight, std::span<const Segment> chunk, std::span<std::uint8_t> out) {
        find_visible(sight, chunk, threshold, out);
      },
      of_smoke);
}

brume_result brume_field_drawn_depths(const brume_field* field, const brume_drawn_params* params,
                                      const brume_segment* segments, size_t count,
                                      float* depths) BRUME_NOEXCEPT {
  return answer(__func__, field, segments, count, depths, find_depths, as_drawn(params));
}

brume_result brume_field_drawn_visible(const brume_field* field, const brume_drawn_params* params,
                                       const brume_segment* segments, size_t count, float threshold,
                                       uint8_t* visible) BRUME_NOEXCEPT {
  return answer(
      __func__, field, segments, count, visible,
      [&](const Sight& sight, std::span<const Segment> chunk, std::span<std::uint8_t> out) {
        find_visible(sight, chunk, threshold, out);
      },
      as_drawn(params));
}

brume_result brume_field_first_walls(const brume_field* field, const brume_segment* segments, size_t count,
                                     brume_wall* walls) BRUME_NOEXCEPT {
  return answer(__func__, field, segments, count, walls, find_walls, of_smoke);
}

brume_result brume_field_densities(const brume_field* field, brume_voxel low, brume_voxel high,
                                   uint8_t* densities, size_t count) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_field& object = call.handle(field);
    checked_box(object.level->grid.layout(), low, high, count);
    required(densities, "densities");
    call.read(object, [&] {
      read_densities(object.field->smoke().volume(), to_ivec3(low), to_ivec3(high), densities);
    });
  });
}

}  // extern "C"
