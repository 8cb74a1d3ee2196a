#include "render/volume_inputs.hpp"

#include <algorithm>
#include <functional>

#include "render/glow_lights.hpp"

namespace brume::render {
namespace {

static_assert(scene::kMostVolumes == shared::kMaxVolumes);

planning::VolumeInput input_of(const scene::VolumeOptions& options, const scenario::VolumeAt& volume,
                               const scenario::VolumeFrame& first) {
  const grids::BrickVolume& density = volume.frame->density;
  planning::VolumeInput input;
  input.volume = density.volume.get();
  input.world_from_voxel = volume.world_from_density;
  input.colors = volume.frame->colors.get();
  input.transfer = {options.opacity, options.color_map, scenario::range_of(options, first) / density.unit,
                    options.glow, options.emission};
  // Values are stored in a unit, which an opacity curve cancels.
  const float unit = options.opacity.empty() ? density.unit : 1;
  input.look = {options.albedo, options.extinction * unit, glm::vec3(0), options.anisotropy,
                options.multiple_scattering};
  if (const auto& heat = volume.frame->heat; heat && options.emission > 0)
    // What glows is a multiple of the look's extinction.
    input.heat = {heat->volume.get(), volume.world_from_heat, options.kelvin * heat->unit,
                  heat->high / heat->unit, options.emission / unit};
  if (const auto& preview = volume.preview; preview && preview->density) {
    input.preview = preview->density->volume.get();
    input.world_from_preview = volume.world_from_density_preview;
  }
  if (const auto& preview = volume.preview; preview && preview->heat && input.heat.volume) {
    input.heat.preview = preview->heat->volume.get();
    input.heat.world_from_preview = volume.world_from_heat_preview;
  }
  return input;
}

}  // namespace

void add_volumes(const scenario::Scenario& scenario, double seconds, scenario::VolumeWait wait,
                 planning::FrameInput& input) {
  if (!scenario.volumes) return;
  const std::vector<scene::VolumeOptions>& options = scenario.timeline.volumes;
  const std::vector<scenario::VolumeAt> volumes = scenario.volumes->at(options, seconds, wait);
  std::vector<shared::Light> lights;
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    if (!volumes[i].frame) continue;
    input.volumes.push_back(input_of(options[i], volumes[i], scenario.volumes->first_frame(i)));
    for (const shared::Light& light : glow_lights(options[i], volumes[i], input.view.exposure))
      lights.push_back(light);
  }
  // A frame takes a limited number of them.
  std::ranges::stable_sort(lights, std::greater(), &shared::Light::range);
  std::vector<shared::Light>& flashes = input.environment.flashes;
  flashes.insert(flashes.end(), lights.begin(), lights.end());
}

}  // namespace brume::render
