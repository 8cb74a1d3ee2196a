#include "textures/light_volume.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <limits>

#include "core/tasks.hpp"
#include "shared/erosion.h"
#include "shared/noise_advection.h"
#include "shared/sky_light.h"
#include "shared/smoke_light.h"

namespace brume::textures {
namespace {

constexpr int kTexels = shared::kBrickTexels;
using smoke::texel_at;
using smoke::texel_index;

std::uint8_t to_byte(float value) {
  return static_cast<std::uint8_t>(std::clamp(value, 0.0f, 1.0f) * 255.0f + 0.5f);
}

/// The displacement at a texel, or at the point before it where they are two voxels apart.
glm::vec3 displacement_at(std::span<const glm::u16vec4> points, std::uint32_t index) {
  if (points.empty()) return glm::vec3(0);
  if (points.size() == shared::kTexelsPerBrick) return glm::vec3(glm::unpackHalf(points[index]));
  const glm::ivec3 at = texel_at(index) / 2;
  constexpr int kPoints = shared::kDisplacementPoints;
  return glm::vec3(
      glm::unpackHalf(points[static_cast<std::size_t>(at.x + kPoints * (at.y + kPoints * at.z))]));
}

/// Behind this optical depth light counts as gone.
constexpr float kDeepest = 20;
constexpr std::uint32_t kPhases = shared::kLightPhases;
/// The bits of rays to the sky begin here.
constexpr std::uint32_t kFirstSkyBit = LightVolume::kMostLights;
static_assert(kFirstSkyBit + shared::kSkyRays <= 32);
constexpr float kFar = 1000;  // [m]
/// Shaders read light up to so many texels from where smoke is: between texels, and up to two off a wall.
constexpr int kReach = 3;

}  // namespace

LightVolume::LightVolume(std::uint32_t light_count, bool sky)
    : light_count_(light_count), sky_(sky), groups_((light_count + (sky ? 1 : 0) + 1) / 2) {}

bool LightVolume::Phases::has(std::uint32_t phase) const {
  return (phase + kPhases - first) % kPhases < count;
}

void LightVolume::update(const LitSmoke& smoke, std::span<const SmokyBrick> smoky, float fraction) {
  const auto count = static_cast<std::uint32_t>(std::ceil(fraction * static_cast<float>(kPhases)));
  const Phases phases{turn_, std::clamp(count, 1u, kPhases)};
  turn_ = (turn_ + phases.count) % kPhases;
  follow_bricks(*smoke.volume, smoky);
  forget_walls(smoke);
  const auto for_each = [&](std::size_t grain, auto body) {
    parallel_for(smoky.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) body(*bricks_[smoky[i].slot], smoky[i]);
    });
  };
  for_each(4, [&](Brick& brick, const SmokyBrick& from) {
    find_read(brick, from.smoke);
    find_retained(smoke, brick, from, phases);
    find_density(smoke, brick, from.slot);
  });
  for_each(1, [&](Brick& brick, const SmokyBrick&) { light(smoke, brick, phases); });
  for (const SmokyBrick& from : smoky) bricks_[from.slot]->lit = bricks_[from.slot]->read;
}

/// Bricks whose smoke is gone block no light.
void LightVolume::follow_bricks(const smoke::SmokeVolume& volume, std::span<const SmokyBrick> smoky) {
  std::vector<std::unique_ptr<Brick>> before = std::move(bricks_);
  before.resize(volume.slot_count());
  bricks_.clear();
  bricks_.resize(volume.slot_count());
  for (const SmokyBrick& from : smoky) {
    std::unique_ptr<Brick>& brick = bricks_[from.slot];
    brick = std::move(before[from.slot]);
    const glm::ivec3 at = volume.brick_of(from.slot);
    if (brick && brick->brick == at) continue;
    brick = std::make_unique<Brick>();
    brick->brick = at;
    brick->texels.resize(std::size_t{groups_} * shared::kTexelsPerBrick);
  }
}

/// What walls hide from lights that moved; all where walls changed.
void LightVolume::forget_walls(const LitSmoke& smoke) {
  std::uint32_t stale = smoke.edits == edits_ ? 0 : ~std::uint32_t{0};
  for (std::uint32_t n = 0; n < smoke.lights.size(); ++n)
    if (n >= lights_.size() || smoke.lights[n] != lights_[n]) stale |= 1u << n;
  edits_ = smoke.edits;
  lights_.assign(smoke.lights.begin(), smoke.lights.end());
  if (stale == 0) return;
  for (const std::unique_ptr<Brick>& brick : bricks_)
    if (brick)
      for (std::uint32_t& known : brick->known) known &= ~stale;
}

void LightVolume::find_read(Brick& brick, smoke::TexelSet smoke) {
  for (int i = 0; i < kReach; ++i) smoke = smoke::dilated(smoke);
  brick.read = smoke;
  const smoke::TexelSet gone = brick.lit & ~brick.read;
  brick.lit &= brick.read;
  for (std::size_t i = 0; i < brick.texels.size(); ++i)
    if (gone[i % shared::kTexelsPerBrick]) brick.texels[i] = glm::u8vec4(0);
}

bool LightVolume::is_due(const Brick& brick, std::uint32_t texel, const Phases& phases) {
  return brick.read[texel] &&
         (!brick.lit[texel] || phases.has(shared::light_phase(glm::uvec3(texel_at(texel)))));
}

std::span<const glm::u8vec4> LightVolume::texels(std::uint32_t slot, std::uint32_t group) const {
  return std::span(bricks_[slot]->texels)
      .subspan(std::size_t{group} * shared::kTexelsPerBrick, shared::kTexelsPerBrick);
}

/// What noise and holes leave of a density at a point.
float LightVolume::remaining(const LitSmoke& smoke, float density, glm::vec3 p_world,
                             glm::vec3 displacement) const {
  static const smoke::MaskAtlas kNoMasks;
  const smoke::MaskAtlas& masks = smoke.masks ? *smoke.masks : kNoMasks;
  float left = density;
  if (smoke.look.erosion > 0) {
    const glm::vec3 at = shared::noise_point(smoke.look, p_world + displacement, smoke.seconds);
    left = shared::effective_erode(smoke.look, density, smoke::noise_at(smoke::smoke_noise_tile(), at));
  }
  for (const shared::Hole& hole : smoke.holes)
    left *= 1 - smoke::hole_strength_masked(hole, p_world, smoke.seconds, 0, masks);
  return left;
}

void LightVolume::find_retained(const LitSmoke& smoke, Brick& brick, const SmokyBrick& from,
                                const Phases& phases) const {
  const shared::VolumeLayout& layout = smoke.volume->layout();
  const std::span<const smoke::Texel> texels = smoke.volume->texels(from.slot);
  for (std::uint32_t i = 0; i < shared::kTexelsPerBrick; ++i) {
    if (!is_due(brick, i, phases)) continue;
    const float density = static_cast<float>(texels[i].density) / 255;
    brick.retained[i] = 1;
    if (density <= 0) continue;
    // The mean of four points, the corners of a tetrahedron, as in shaders/noise_advection.comp.
    const glm::vec3 p_voxel = glm::vec3(shared::kBrickVoxels * brick.brick + texel_at(i)) - 0.5f;
    const glm::vec3 p_world = layout.origin_world + p_voxel * layout.voxel_size;
    const glm::vec3 displacement = displacement_at(from.displacements, i);
    glm::vec4 left;
    for (std::uint32_t k = 0; k < 4; ++k) {
      const glm::vec3 corner(k & 1u, k >> 1u, (k ^ k >> 1u) & 1u);
      left[static_cast<int>(k)] =
          remaining(smoke, density, p_world + (corner - 0.5f) * (0.5f * layout.voxel_size), displacement);
    }
    const float depth = smoke.look.extinction * layout.voxel_size;
    brick.retained[i] = shared::effective_density(left, depth) / density;
  }
}

/// Solid texels get the mean of the free ones around: light that grazes a wall meets the smoke in front of
/// it.
void LightVolume::find_density(const LitSmoke& smoke, Brick& brick, std::uint32_t slot) const {
  const std::span<const smoke::Texel> texels = smoke.volume->texels(slot);
  for (std::uint32_t i = 0; i < shared::kTexelsPerBrick; ++i)
    brick.density[i] = static_cast<float>(texels[i].density) / 255 * brick.retained[i];
  for (std::uint32_t i = 0; i < shared::kTexelsPerBrick; ++i) {
    if (texels[i].free != 0) continue;
    const glm::ivec3 at = texel_at(i), low = glm::max(at - 1, 0), high = glm::min(at + 1, kTexels - 1);
    float sum = 0, free = 0;
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
          const std::size_t near = texel_index({x, y, z});
          if (texels[near].free == 0) continue;
          sum += brick.density[near];
          ++free;
        }
    brick.density[i] = sum / std::max(free, 1.0f);
  }
}

void LightVolume::light(const LitSmoke& smoke, Brick& brick, const Phases& phases) const {
  const shared::VolumeLayout& layout = smoke.volume->layout();
  for (std::uint32_t i = 0; i < shared::kTexelsPerBrick; ++i) {
    if (!is_due(brick, i, phases)) continue;
    const glm::vec3 p_voxel = glm::vec3(shared::kBrickVoxels * brick.brick + texel_at(i)) - 0.5f;
    const Place place{brick, i, p_voxel, layout.origin_world + p_voxel * layout.voxel_size};
    for (std::uint32_t n = 0; n < 2 * groups_; ++n) {
      glm::u8vec2 value(255, 0);
      if (n < smoke.lights.size()) {
        value = light_texel(smoke, place, n);
      } else if (sky_ && n == light_count_) {
        value = sky_texel(smoke, place);
      }
      glm::u8vec4& texel = brick.texels[std::size_t{n / 2} * shared::kTexelsPerBrick + i];
      const int first = static_cast<int>(2 * (n % 2));
      texel[first] = value.x;
      texel[first + 1] = value.y;
    }
  }
}

float LightVolume::density_at(const LitSmoke& smoke, glm::vec3 p_voxel, bool& empty) const {
  const glm::ivec3 brick(glm::floor(p_voxel * 0.125f));
  const std::uint32_t slot = smoke.volume->slot_at(brick);
  empty = slot == smoke::SmokeVolume::kNoSlot || !bricks_[slot] || bricks_[slot]->brick != brick;
  if (empty) return 0;
  const glm::vec3 at = p_voxel - glm::vec3(shared::kBrickVoxels * brick) + 0.5f;
  const glm::vec3 low = glm::floor(at), f = at - low;
  const float* const d = bricks_[slot]->density.data() + texel_index(glm::ivec3(low));
  const auto row = [&](int offset) { return glm::mix(d[offset], d[offset + 1], f.x); };
  constexpr int kLayer = kTexels * kTexels;
  return glm::mix(glm::mix(row(0), row(kTexels), f.y), glm::mix(row(kLayer), row(kLayer + kTexels), f.y),
                  f.z);
}

/// As shaders/lib/optical_depth.glsl: steps of a voxel that grow with the distance.
float LightVolume::depth(const LitSmoke& smoke, glm::vec3 p_voxel, glm::vec3 direction, float reach_m,
                         float coarse) const {
  const shared::VolumeLayout& layout = smoke.volume->layout();
  const glm::vec3 inverse = 1.0f / (direction + glm::vec3(glm::equal(direction, glm::vec3(0))) * 1e-6f);
  const glm::vec3 t0 = (layout.bounds_min - p_voxel) * inverse, t1 = (layout.bounds_max - p_voxel) * inverse;
  const glm::vec3 near = glm::min(t0, t1), far = glm::max(t0, t1);
  const float begin = std::max({near.x, near.y, near.z, 0.0f});
  const float reach = std::min({far.x, far.y, far.z, reach_m / layout.voxel_size}) - begin;
  if (!(reach > 0)) return 0;
  const float per_voxel = layout.voxel_size * smoke.look.extinction;
  const float steps =
      std::min(std::ceil(reach), std::ceil(std::max(24.0f, std::sqrt(144 + 48 * reach) - 12) / coarse));
  float depth = 0;
  for (float i = 0; i < steps && depth * per_voxel <= kDeepest; ++i) {
    const float before = reach * (i / steps) * (0.5f + 0.5f * i / steps);
    const float after = reach * ((i + 1) / steps) * (0.5f + 0.5f * (i + 1) / steps);
    const glm::vec3 p = p_voxel + direction * (begin + 0.5f * (before + after));
    bool empty = false;
    depth += density_at(smoke, p, empty) * (after - before);
    if (!empty) continue;
    // To the step in which the ray leaves the empty brick.
    const glm::vec3 low = glm::floor(p * 0.125f) * 8.0f;
    const glm::vec3 a = (low - p) * inverse, b = (low + 8.0f - p) * inverse, out = glm::max(a, b);
    const float leaves = 0.5f * (before + after) + std::min({out.x, out.y, out.z}) - 0.01f;
    i = std::max(i, std::floor(steps * (std::sqrt(0.25f + 2 * leaves / reach) - 0.5f)) - 1);
  }
  return depth * per_voxel;
}

/// Whether walls let light through, remembered.
bool LightVolume::is_seen(const LitSmoke& smoke, const Place& from, glm::vec3 to_world, std::uint32_t bit) {
  std::uint32_t& known = from.brick.known[from.texel];
  std::uint32_t& seen = from.brick.seen[from.texel];
  if ((known >> bit & 1) == 0) {
    const auto visible = smoke.sight->visible(from.p_world, to_world, std::numeric_limits<float>::infinity());
    known |= 1u << bit;
    seen = (seen & ~(1u << bit)) | (visible && *visible ? 1u << bit : 0u);
  }
  return (seen >> bit & 1) != 0;
}

glm::u8vec2 LightVolume::light_texel(const LitSmoke& smoke, const Place& place, std::uint32_t number) const {
  const Light& light = smoke.lights[number];
  const glm::vec3 to = light.directional ? light.at_world * kFar : light.at_world - place.p_world;
  const float distance = glm::length(to);
  if (!(distance > 0)) return {255, 255};
  const bool seen = is_seen(smoke, place, place.p_world + to, number);
  // In shadow, too: between a texel in shadow and a lit one, shaders interpolate both numbers.
  const float passed = std::exp(-0.25f * depth(smoke, place.p_voxel, to / distance, distance, 1));
  return {to_byte(passed), to_byte(seen ? 1 : 0)};
}

glm::u8vec2 LightVolume::sky_texel(const LitSmoke& smoke, const Place& place) const {
  float escape = 0, seen = 0;
  for (std::uint32_t i = 0; i < shared::kSkyRays; ++i) {
    const glm::vec3 direction = shared::sky_ray(i);
    const float passed = std::exp(-depth(smoke, place.p_voxel, direction, kFar, 2)) / float{shared::kSkyRays};
    escape += passed;
    if (is_seen(smoke, place, place.p_world + kFar * direction, kFirstSkyBit + i))
      seen += passed * shared::sky_shape(direction.y);
  }
  return {to_byte(escape), to_byte(seen)};
}

}  // namespace brume::textures
