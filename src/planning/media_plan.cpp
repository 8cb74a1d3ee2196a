#include "planning/media_plan.hpp"

#include <algorithm>
#include <cmath>

#include "planning/transfer_table.hpp"
#include "shared/opaque.h"
#include "smoke/noise_tile.hpp"

namespace brume::planning {
namespace {

/// Around a box of a volume's voxel space in the world.
Box<float> world_box(const glm::mat4& world_from_voxel, const Box<float>& box) {
  Box<float> world = kEmptyBox;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 at(corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                       corner & 4 ? box.high.z : box.low.z);
    const glm::vec3 p(world_from_voxel * glm::vec4(at, 1));
    world = united(world, {p, p});
  }
  return world;
}

bool is_dense(const VolumeInput& volume) {
  return volume.voxel_depth > shared::kDenseVoxelDepth;
}

/// The shortest edge of a voxel [m]: filtered values are linear in between, and half as long a step changes
/// the image of a cloud by 0.07 of 255 on average. Two of them for what only glows, which is a plain sum: the
/// exhaust of a thruster is off by 0.8 % (brume bench particles/march; by 0.2 % with one). Half of one where
/// a voxel is opaque: its light changes within it.
float step_of(const VolumeInput& volume) {
  const glm::mat4& world_from_voxel = volume.world_from_voxel;
  float shortest = glm::length(glm::vec3(world_from_voxel[0]));
  for (int axis = 1; axis < 3; ++axis)
    shortest = std::min(shortest, glm::length(glm::vec3(world_from_voxel[axis])));
  const bool only_glows = !volume.tints.empty() && !(volume.look.extinction > 0);
  if (only_glows) return 2 * shortest;
  return is_dense(volume) ? shortest / 2 : shortest;
}

shared::Affine inverse_of(const glm::mat4& world_from_voxel) {
  const glm::dmat4 inverse = glm::inverse(glm::dmat4(world_from_voxel));
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!std::isfinite(inverse[column][row]))
        throw Error(ErrorCode::bad_input,
                    "the transform of a volume has no inverse; give each axis a length");
  return shared::affine_of(glm::mat4x3(glm::mat4(inverse)));
}

/// The bounds of a volume along the world's axes.
Box<float> world_box(const shared::VolumeLayout& layout) {
  return {layout.origin_world + layout.bounds_min * layout.voxel_size,
          layout.origin_world + layout.bounds_max * layout.voxel_size};
}

shared::MediaBox media_box(const Box<float>& box) {
  return {box.low, 0, box.high, 0};
}

/// Adds a medium inside a box in the world to what the march goes through. `step` is the longest that suits
/// it [m].
void add_medium(MediaPlan& plan, std::uint32_t bits, const Box<float>& box, float extinction, float step) {
  shared::FrameMedia& frame = plan.frame;
  const bool first = plan.media == 0;
  plan.media |= bits;
  frame.bounds_min = first ? box.low : glm::min(frame.bounds_min, box.low);
  frame.bounds_max = first ? box.high : glm::max(frame.bounds_max, box.high);
  frame.step_length = first ? step : std::min(frame.step_length, step);
  frame.extinction = (first ? 0 : frame.extinction) + extinction;
}

/// Adds a medium inside a box in the world to what light meets. `mean_cosine`: of its phase function.
void add_caster(MediaPlan& plan, std::uint32_t bits, const Box<float>& box, float mean_cosine) {
  plan.casters |= bits;
  plan.caster_bounds = united(plan.caster_bounds, box);
  if (++plan.caster_count == 1) plan.mean_cosine = mean_cosine;
}

bool has_heat(const VolumeInput& volume) {
  return volume.heat.volume && volume.heat.volume->slot_count() > 0;
}

/// The look of a volume where it has no colours of its own.
shared::VolumeLook look_of(const VolumeInput& volume) {
  shared::VolumeLook look = volume.look;
  if (transfer_kind(volume.transfer) == shared::kTransferNone) return look;
  const shared::VolumeTransfer transfer = device_transfer(volume.transfer);
  // For where a cell of light has no extinction; samples have colours of their own.
  const glm::vec3 color = mean_color(volume.transfer, look.albedo);
  look.albedo = transfer.scattered * color;
  look.emission = transfer.emitted * color;
  return look;
}

/// What the colours of a volume are.
std::uint32_t colors_of(const VolumeInput& volume) {
  if (!volume.colors) return shared::kColorsNone;
  if (volume.tints.empty()) return shared::kColorsAlbedo;
  return volume.tints.size() <= 2 ? shared::kColorsPair : shared::kColorsMasks;
}

glm::vec3 lengths_of(const glm::mat3& axes) {
  return {glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])};
}

/// The tiles of a detail's noise per voxel.
glm::vec3 detail_per_voxel(const VolumeDetailInput& detail) {
  const glm::vec3 voxels_per_unit = lengths_of(glm::mat3(detail.voxel_from_file));
  constexpr float kVoxels = 4;  // size of the largest billows, if the file does not say
  const auto cells = static_cast<float>(smoke::kSmokeNoise.coarse_cells);
  const glm::vec3 size = detail.noise.size > 0 ? detail.noise.size * voxels_per_unit : glm::vec3(kVoxels);
  return 1.0f / (cells * size);
}

shared::VolumeInstance instance_of(const VolumeInput& volume, std::size_t number) {
  const shared::VolumeLayout& layout = volume.volume->layout();
  shared::VolumeInstance instance{};
  instance.voxel_from_world = inverse_of(volume.world_from_voxel);
  instance.world_from_voxel = shared::affine_of(glm::mat4x3(volume.world_from_voxel));
  instance.bounds_min = layout.bounds_min;
  instance.bounds_max = layout.bounds_max;
  instance.look = look_of(volume);
  if (has_heat(volume)) {
    instance.heat_from_world = inverse_of(volume.heat.world_from_voxel);
    instance.heat_per_value = 1 / volume.heat.high;
  }
  instance.transfer = device_transfer(volume.transfer);
  instance.transfer_kind = transfer_kind(volume.transfer);
  instance.color_kind = colors_of(volume);
  instance.is_dense = is_dense(volume) ? 1 : 0;
  instance.detail = volume_detail(volume);
  instance.number = static_cast<std::uint32_t>(number);
  return instance;
}

ShownGrids grids_of(const VolumeInput& volume) {
  return {volume.volume, volume.heat.volume, volume.colors};
}

/// Displacements of at most `amplitude` voxels along each axis.
void set_disturbance(const DisturbanceInput& input, shared::VolumeEffect& effect) {
  const scene::Disturbance& noise = input.noise;
  const glm::mat3 voxel_from_file(input.voxel_from_file);
  const glm::vec3 voxels_per_unit = lengths_of(voxel_from_file);
  // The features of a tile of noise are half as large as it.
  const float tile = 2 * noise.size;
  effect.tiles_per_voxel = 1.0f / (tile * voxels_per_unit);
  effect.tile_offset = -glm::fract(noise.drift * (input.time / tile));
  effect.amplitude = noise.strength * voxels_per_unit;
  effect.growth = glm::vec4(0, 0, 0, 1);
}

/// Where the strength grows from 0: from the side of the bounds from which the noise comes.
void set_growth(const VolumeInput& volume, shared::VolumeEffect& effect) {
  const scene::Disturbance& noise = volume.disturbance.noise;
  if (!(noise.grow > 0) || noise.drift == glm::vec3(0)) return;
  const glm::mat3 file_from_voxel = glm::inverse(glm::mat3(volume.disturbance.voxel_from_file));
  const glm::vec3 along = glm::transpose(file_from_voxel) * (glm::normalize(noise.drift) / noise.grow);
  const shared::VolumeLayout& layout = volume.volume->layout();
  float least = 1e30f;
  for (int corner = 0; corner < 8; ++corner)
    least = std::min(least, glm::dot(along, glm::mix(layout.bounds_min, layout.bounds_max,
                                                     glm::bvec3(corner & 1, corner & 2, corner & 4))));
  effect.growth = glm::vec4(along, -least);
}

void set_detail(const VolumeDetailInput& detail, shared::VolumeEffect& effect) {
  effect.detail_per_voxel = detail_per_voxel(detail);
  const glm::vec3 drift_voxels = lengths_of(glm::mat3(detail.voxel_from_file)) * detail.noise.drift;
  effect.detail_offset = -glm::fract(drift_voxels * effect.detail_per_voxel * detail.time);
}

/// The bits of a volume.
std::uint32_t media_of(const VolumeInput& volume) {
  std::uint32_t media = shared::kMediumVolumes;
  if (transfer_kind(volume.transfer) != shared::kTransferNone) media |= shared::kMediumTransfer;
  if (colors_of(volume) == shared::kColorsAlbedo) media |= shared::kMediumColors;
  if (!volume.tints.empty() && volume.colors) media |= shared::kMediumMasks;
  if (!volume.disturbance.empty()) media |= shared::kMediumDisturbed;
  if (!volume.detail.empty()) media |= shared::kMediumVolumeDetail;
  const shared::VolumeLook look = look_of(volume);
  const glm::vec3 light = look.albedo + look.emission;
  if (look.extinction > 0 && std::max({light.r, light.g, light.b}) > 0) media |= shared::kMediumLit;
  if (is_dense(volume)) media |= shared::kMediumDense;
  if (has_heat(volume)) media |= shared::kMediumHeat;
  return media;
}

/// Adds a volume that may be in view.
void add_visible(MediaPlan& plan, const VolumeInput& volume, const Box<float>& world) {
  add_medium(plan, media_of(volume), world, volume.look.extinction, step_of(volume));
  if (++plan.frame.volume_count > 1) plan.media |= shared::kMediumSeveral;
}

/// The boxes of a volume, and of the preview that may stand in for it.
void add_boxes(const VolumeInput& volume, FrameVector<Box<float>>& boxes) {
  const glm::vec3 reach = volume_effect(volume).amplitude;
  for (const Box<float>& box : volume.volume->boxes())
    boxes.push_back(world_box(volume.world_from_voxel, {box.low - reach, box.high + reach}));
  if (!volume.preview) return;
  for (const Box<float>& box : volume.preview->boxes())
    boxes.push_back(world_box(volume.world_from_preview, box));
}

/// Bounds the media by these boxes in the world, joined to as many as a frame has.
void set_boxes(MediaPlan& plan, FrameVector<Box<float>>& boxes) {
  constexpr std::size_t kMostBoxes = 16;  // beyond, to join them takes too long
  if (boxes.size() < 2 || boxes.size() > kMostBoxes) {
    plan.frame.box_0 = media_box({plan.frame.bounds_min, plan.frame.bounds_max});
    return;
  }
  join_nearest(boxes, shared::kMaxMediaBoxes);
  shared::FrameMedia& frame = plan.frame;
  shared::MediaBox* const out[] = {&frame.box_0, &frame.box_1, &frame.box_2, &frame.box_3};
  static_assert(std::size(out) == shared::kMaxMediaBoxes);
  frame.box_count = 0;
  for (const Box<float>& box : boxes) *out[frame.box_count++] = media_box(box);
}

/// What glows in a volume, and what of its noise that light depends on.
void add_glow(InputKey& key, const PlacedVolume& visible, const VolumeInput& input) {
  if (!shared::glows(visible.instance)) return;
  key.add(visible.instance.heat_from_world);
  key.add(visible.instance.heat_per_value);
  key.add(visible.grids.heat ? visible.grids.heat->id() : 0);
  key.add(visible.grids.heat ? visible.grids.heat->revision() : 0);
  key.add(glm::vec3(input.heat.kelvin, input.heat.high, input.heat.emission));
  key.add(visible.effect.tints);
  key.add(visible.instance.detail);
  if (visible.instance.detail.strength <= 0) return;
  key.add(visible.effect.detail_per_voxel);
  key.add(visible.effect.detail_offset);
}

void add_transfer(InputKey& key, const TransferInput& transfer) {
  for (const scene::OpacityPoint& point : transfer.opacity) key.add(point);
  for (const scene::ColorPoint& point : transfer.color_map.points) key.add(point);
  for (const char letter : transfer.color_map.name) key.add(letter);
  key.add(transfer.opacity.size());
  key.add(transfer.color_map.points.size());
}

/// Adds volumes that may be in view and their boxes, or all others.
void add_volumes(MediaPlan& plan, std::span<const VolumeInput> volumes, const ViewFrustum& frustum,
                 std::span<const bool> previews, bool in_view, FrameVector<Box<float>>& boxes) {
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    const VolumeInput& volume = volumes[i];
    const shared::VolumeLayout& layout = volume.volume->layout();
    const glm::vec3 reach = volume_effect(volume).amplitude;
    const Box<float> world =
        world_box(volume.world_from_voxel, {layout.bounds_min - reach, layout.bounds_max + reach});
    if (volume.volume->slot_count() == 0 || frustum.may_intersect(world) != in_view) continue;
    // What has no extinction dims nothing.
    if (!in_view && !(volume.look.extinction > 0)) continue;
    const bool preview = !previews.empty() && previews[i];
    const VolumeInput shown = shown_volume(volume, preview);
    plan.volumes.push_back(
        {i, world, instance_of(shown, i), volume_effect(shown), preview, grids_of(shown), {}});
    add_caster(plan, media_of(shown), world, shown.look.anisotropy);
    if (++plan.frame.caster_count > 1) plan.casters |= shared::kMediumSeveral;
    if (!in_view) continue;
    add_visible(plan, shown, world);
    add_boxes(volume, boxes);
  }
}

/// Adds the smoke that may be in view, and its box.
void add_smoke(MediaPlan& plan, const FrameInput& input, FrameVector<Box<float>>& boxes) {
  const shared::SmokeLook& look = input.smoke.look;
  std::uint32_t bits = shared::kMediumSmoke;
  if (input.quality.fine_shadows && look.erosion > 0) bits |= shared::kMediumFineShadows;
  if (input.quality.detail && look.erosion > 0 && look.detail > 0) bits |= shared::kMediumDetail;
  boxes.push_back(world_box(plan.smoke));
  add_medium(plan, bits, boxes.back(), look.extinction, look.step_length);
}

/// The sun of the volumes: the first directional light.
void add_sun(MediaPlan& plan, std::span<const shared::Light> lights) {
  const auto sun = std::ranges::find(lights, shared::kLightDirectional, &shared::Light::kind);
  if (sun == lights.end()) return;
  plan.sun = static_cast<std::uint32_t>(sun - lights.begin());
  if (plan.frame.volume_count > 0) plan.media |= shared::kMediumSun;
  plan.frame.to_sun = -sun->direction;
  plan.frame.sun_irradiance = sun->intensity;
}

}  // namespace

shared::VolumeEffect volume_effect(const VolumeInput& volume) {
  shared::VolumeEffect effect{};
  glm::mat4x3 tints(0);
  for (std::size_t i = 0; i < std::min<std::size_t>(volume.tints.size(), 4); ++i)
    tints[static_cast<int>(i)] = volume.tints[i];
  effect.tints = shared::affine_of(tints);
  if (!volume.disturbance.empty()) {
    set_disturbance(volume.disturbance, effect);
    set_growth(volume, effect);
  }
  if (!volume.detail.empty()) set_detail(volume.detail, effect);
  return effect;
}

shared::VolumeDetail volume_detail(const VolumeInput& volume) {
  if (volume.detail.empty()) return {};
  const glm::vec3 per_metre =
      detail_per_voxel(volume.detail) / lengths_of(glm::mat3(volume.world_from_voxel));
  return {volume.detail.noise.strength, 1 / volume.detail.densest,
          std::max({per_metre.x, per_metre.y, per_metre.z})};
}

shared::FrameMedia smoke_media(const shared::VolumeLayout& smoke, const shared::SmokeLook& look) {
  const Box<float> box = world_box(smoke);
  shared::FrameMedia media{};
  media.bounds_min = box.low;
  media.bounds_max = box.high;
  media.extinction = look.extinction;
  media.step_length = look.step_length;
  media.smooth_length = smoke.voxel_size;
  media.opaque_transmittance = look.opaque_transmittance;
  media.coarse_transmittance = shared::coarse_below(look.opaque_transmittance);
  media.to_sun = glm::vec3(0, 1, 0);
  media.box_count = 1;
  media.box_0 = media_box(box);
  return media;
}

VolumeInput shown_volume(const VolumeInput& volume, bool preview) {
  VolumeInput shown = volume;
  if (preview && volume.preview) {
    shown.volume = volume.preview;
    shown.world_from_voxel = volume.world_from_preview;
    shown.colors = nullptr;
    shown.tints.clear();
    shown.disturbance = {};
    shown.detail = {};
  }
  if (preview && volume.heat.preview) {
    shown.heat.volume = volume.heat.preview;
    shown.heat.world_from_voxel = volume.heat.world_from_preview;
  }
  return shown;
}

void set_tables(MediaPlan& plan, std::span<const VolumeTables> tables) {
  for (PlacedVolume& placed : plan.volumes) placed.tables = tables[placed.index];
}

FrameVector<Box<float>> caster_boxes(const MediaPlan& plan, const SmokeVisibility& visibility,
                                     const smoke::SmokeBricks* smoke, Allocator memory) {
  FrameVector<Box<float>> boxes(memory);
  if (smoke) boxes = smoke_boxes(*smoke, visibility, memory);
  for (const PlacedVolume& volume : plan.volumes)
    if (volume.instance.look.extinction > 0) boxes.push_back(volume.bounds_world);
  return boxes;
}

void add_casters(InputKey& key, const MediaPlan& media, std::span<const VolumeInput> volumes) {
  for (const PlacedVolume& visible : media.volumes) {
    const VolumeInput& input = volumes[visible.index];
    const volume::SparseVolume& volume = *shown_volume(input, visible.is_preview).volume;
    key.add(volume.id());
    key.add(volume.revision());
    key.add(visible.instance.voxel_from_world);
    key.add(visible.instance.bounds_min);
    key.add(visible.instance.bounds_max);
    key.add(visible.instance.look);
    key.add(visible.instance.transfer);
    key.add(visible.instance.transfer_kind);
    key.add(visible.instance.color_kind);
    key.add(visible.instance.is_dense);
    add_glow(key, visible, input);
    add_transfer(key, input.transfer);
    key.add(input.colors ? input.colors->id() : 0);
    key.add(input.colors ? input.colors->revision() : 0);
  }
}

std::array<std::uint32_t, 4> media_of_all_qualities(std::uint32_t media) {
  if ((media & shared::kMediumSmoke) == 0) return {media, media, media, media};
  const std::uint32_t plain = media & ~shared::kMediaOfSmoke;
  return {plain, plain | shared::kMediumFineShadows, plain | shared::kMediumDetail,
          plain | shared::kMediaOfSmoke};
}

std::span<const PlacedVolume> volumes_in_view(const MediaPlan& plan) {
  return std::span(plan.volumes).first(plan.frame.volume_count);
}

void choose_previews(MediaPlan& plan, std::span<const VolumeInput> volumes, std::span<const bool> previews) {
  for (PlacedVolume& placed : plan.volumes) {
    placed.is_preview = !previews.empty() && previews[placed.index];
    const VolumeInput shown = shown_volume(volumes[placed.index], placed.is_preview);
    placed.instance = instance_of(shown, placed.index);
    placed.effect = volume_effect(shown);
    placed.grids = grids_of(shown);
  }
}

MediaPlan plan_media(const FrameInput& input, const SmokeVisibility& visibility, const ViewFrustum& frustum,
                     std::span<const shared::Light> lights, std::span<const bool> previews,
                     const smoke::SmokeBricks* smoke, Allocator memory) {
  if (input.volumes.size() > shared::kMaxVolumes)
    throw Error(ErrorCode::bad_input, "a frame of " + std::to_string(input.volumes.size()) +
                                          " volumes; at most " + std::to_string(shared::kMaxVolumes));
  MediaPlan plan{.volumes = FrameVector<PlacedVolume>(memory)};
  const bool has_smoke = smoke && input.smoke.volume && input.smoke.volume->slot_count() > 0;
  plan.smoke.voxel_size = 1;  // by which shaders divide
  if (has_smoke) plan.smoke = smoke->layout();
  plan.smoke.bounds_min = visibility.visible_bounds.low;
  plan.smoke.bounds_max = visibility.visible_bounds.high;
  plan.frame = smoke_media(plan.smoke, input.smoke.look);

  // Each medium: where it is in view, and where light meets it.
  FrameVector<Box<float>> boxes(memory);
  if (visibility.visible_count > 0) add_smoke(plan, input, boxes);
  if (has_smoke)
    add_caster(plan, shared::kMediumSmoke, world_box(input.smoke.volume->layout()),
               shared::mean_cosine(input.smoke.look.phase));
  for (const bool in_view : {true, false})
    add_volumes(plan, input.volumes, frustum, previews, in_view, boxes);

  // All of them.
  set_boxes(plan, boxes);
  add_sun(plan, lights);
  plan.needs_noise = (has_smoke && smoke->slot_count() > 0) || (plan.media & shared::kMediaWithNoise) != 0;
  plan.frame.step_length *= input.quality.step_scale;
  // Without any, the pipelines are those of smoke, which later frames probably need.
  if (plan.media == 0) plan.media = shared::kMediumSmoke;
  if (input.view.projection == Projection::parallel) plan.media |= shared::kRaysParallel;
  if (plan.casters == 0) plan.casters = shared::kMediumSmoke;
  return plan;
}

}  // namespace brume::planning
