#include "scenario/volume_view.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "core/log.hpp"
#include "scene/daylight.hpp"
#include "scene/options.hpp"
#include "shared/volume.h"

namespace brume::scenario {
namespace {

/// From the side of the default camera, low enough to shade, warm before a blue sky.
constexpr scene::SunOptions kVolumeSun{1.83f, 0.49f, {3.4f, 3.0f, 2.5f}};
constexpr float kVolumeExposure = 0.5f;
/// Voxels of the smoke's grid across the volume.
constexpr float kVoxelsAcross = 48;

float chosen_scale(const std::filesystem::path& path, float extent, const FirstViewOptions& options) {
  if (options.scale) return *options.scale;
  const float scale = fitting_scale(extent);
  if (scale != 1) {
    char message[160];
    std::snprintf(message, sizeof message, ": %g units wide; scaled by %g to %g m: give --scale to choose",
                  double{extent}, double{scale}, double{extent * scale});
    log_warning(path.string() + message);
  }
  return scale;
}

/// The mean opacity of all voxels above 0.
double mean_opacity(const volumes::VolumeFrame& frame, const scene::VolumeOptions& options) {
  const grids::BrickVolume& density = frame.density;
  const glm::dvec2 range(volumes::range_of(options, frame));
  const auto factor = [&](double value) {
    const double at = std::clamp((value - range.x) / (range.y - range.x), 0.0, 1.0);
    return scene::opacity_at(options.opacity, at);
  };
  if (density.histogram.empty()) return factor(double{density.high});
  double sum = 0, count = 0;
  for (std::size_t bin = 0; bin < density.histogram.size(); ++bin) {
    const double part = (static_cast<double>(bin) + 0.5) / static_cast<double>(density.histogram.size());
    const auto voxels = static_cast<double>(density.histogram[bin]);
    sum += voxels * factor(glm::mix(double{density.low}, double{density.high}, part));
    count += voxels;
  }
  return sum / std::max(count, 1.0);
}

/// An optical depth of kViewDepth through its deep parts, but voxels that are not opaque one by one: they
/// would be lit as a surface is. Values that are far off on their own decide neither.
double chosen_extinction(const volumes::VolumeFrame& frame, const volumes::VolumeExtent& extent,
                         const scene::VolumeOptions& options) {
  constexpr double kLeastDepth = 4, kVoxelDepth = 0.9 * double{shared::kDenseVoxelDepth};
  const glm::dmat3 axes(frame.density.world_from_voxel);
  const double scale{options.scale};
  const double edge = std::min({glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])}) * scale;
  double depth = extent.depth * scale, usual{frame.density.usual};
  if (!options.opacity.empty() && frame.mean_density > 0) {
    const double opacity = mean_opacity(frame, options);
    depth *= opacity / frame.mean_density;
    usual = opacity;
  }
  if (!(depth > 0)) return 1;
  return std::max(std::min(kViewDepth / depth, kVoxelDepth / (usual * edge)), kLeastDepth / depth);
}

/// Radiance that leaves a column of heat: what it emits, less what it absorbs of that. [1 at 1,900 K]
double radiance_of(const grids::GlowColumn& column, double kelvin, const scene::VolumeOptions& volume) {
  const double extinction = double{volume.extinction} * double{volume.scale};
  const double emitted = double{volume.emission} * extinction * std::pow(kelvin / 1900, 4) * column.power;
  const double absorbed = extinction * column.density * (1 - double{volume.albedo.x});
  return absorbed > 1e-3 ? emitted * -std::expm1(-absorbed) / absorbed : emitted;
}

/// The exposure of daylight, or less, so that bright columns of the brightest frame that was measured, the
/// 95th percentile, are white at most [EV]. Red light is mostly in one channel, and counts as more than its
/// luminance.
float fire_exposure(const volumes::VolumeFrame& frame, const volumes::VolumeExtent& extent,
                    const scene::VolumeOptions& volume) {
  constexpr double kBright = 0.95, kWhite = 1900, kRed = 1000;  // [K]
  const double kelvin{volumes::kelvin_of(volume, frame)};
  double brightest = 0;
  for (const std::vector<grids::GlowColumn>& columns : extent.glow) {
    std::vector<double> radiances;
    for (const grids::GlowColumn& column : columns) radiances.push_back(radiance_of(column, kelvin, volume));
    if (radiances.empty()) continue;
    const auto bright =
        radiances.begin() + static_cast<std::ptrdiff_t>(kBright * static_cast<double>(radiances.size() - 1));
    std::ranges::nth_element(radiances, bright);
    brightest = std::max(brightest, *bright);
  }
  const double hottest = std::max(kelvin * double{extent.hottest}, kRed);
  const double red = std::pow(std::max(kWhite / hottest, 1.0), 3);
  return -static_cast<float>(std::log2(std::max(brightest * red, 1.0)));
}

}  // namespace

scene::Timeline prepare_volume_view(const std::filesystem::path& path, const volumes::VolumeFrame& frame,
                                    const volumes::VolumeExtent& extent, const FirstViewOptions& options) {
  scene::Timeline timeline;
  timeline.scene = path;

  // Its place: the middle of its bottom at the origin.
  scene::VolumeOptions volume;
  volume.file = path;
  volume.density = options.density;
  volume.heat = options.heat;
  volume.kelvin = options.kelvin.value_or(volume.kelvin);
  volume.frame_rate = options.volume_frame_rate.value_or(volume.frame_rate);
  const glm::vec3 size = extent.bounds.high - extent.bounds.low;
  const float largest = std::max({size.x, size.y, size.z});
  volume.scale = chosen_scale(path, largest, options);
  if (frame.z_is_up) volume.rotation.x = -90;
  const glm::mat4 turned = volumes::world_from_file(volume);
  Box<float> box = kEmptyBox;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::bvec3 high(corner & 1, corner & 2, corner & 4);
    const glm::vec3 p(turned * glm::vec4(glm::mix(extent.bounds.low, extent.bounds.high, high), 1));
    box = united(box, {p, p});
  }
  const glm::vec3 middle = 0.5f * (box.low + box.high);
  volume.position_world = -glm::vec3(middle.x, box.low.y, middle.z);

  // Its look.
  volume.opacity = options.opacity;
  volume.color_map = options.color_map;
  volume.range = options.range;
  volume.extinction = static_cast<float>(std::clamp(chosen_extinction(frame, extent, volume), 1e-36, 1e12));
  const bool glows = !extent.glow.empty();
  volume.albedo = glm::vec3(glows ? 0.7f : 0.99f);
  volume.anisotropy = glows ? 0.2f : 0.5f;
  if (frame.is_extinction && volume.opacity.empty()) {
    // As it is: just as opaque when it is scaled; its albedo is all in its colours, its phase isotropic.
    volume.extinction = 1 / volume.scale;
    volume.albedo = glm::vec3(1);
    volume.anisotropy = 0;
  }
  timeline.volumes.push_back(volume);

  // Light, ground and smoke.
  timeline.sun = options.sun.value_or(kVolumeSun);
  timeline.sky.zenith = {0.03f, 0.09f, 0.27f};
  timeline.sky.horizon = {0.13f, 0.22f, 0.40f};
  timeline.sky.ambient = {0.20f, 0.26f, 0.36f};
  const float dimmed = scene::dim_sky(timeline.sky, timeline.sun->elevation);
  timeline.exposure = glows ? fire_exposure(frame, extent, volume) : kVolumeExposure - std::log2(dimmed);
  // Clipped flames are yellow; compressed ones are pink.
  timeline.tone = glows ? scene::ToneCurve::standard : scene::ToneCurve::neutral;
  scene::replace_given(timeline, options.picture);
  timeline.bounces = 0;  // there is no level
  if (options.has_ground) timeline.ground = 0.0f;
  timeline.grid.voxel =
      options.voxel.value_or(std::clamp(largest * volume.scale / kVoxelsAcross, 0.015625f, 64.0f));
  timeline.smokes = options.smokes;
  return timeline;
}

}  // namespace brume::scenario
