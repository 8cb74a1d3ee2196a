#include "apps/viewer/option_labels.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace brume::viewer {
namespace {

struct Label {
  const char* key;
  const char* label;
  /// Only for settings of this unit: other tables have the same key for other things. Null: of any unit.
  const char* unit = nullptr;
};

constexpr std::array kLabels{
    // Film and camera.
    Label{"duration", "length of the film"},
    Label{"exposure", "exposure"},
    Label{"fov", "field of view"},
    Label{"aperture", "aperture radius"},
    Label{"focus", "focus distance"},
    Label{"blades", "aperture blades"},
    Label{"shutter", "shutter time"},
    // Tank.
    Label{"samples", "samples of a pixel"},
    Label{"bounces", "bounces"},
    Label{"photons", "light through the glass"},
    Label{"dither", "dither"},
    Label{"voxel", "edge of a voxel"},
    Label{"spheres", "spheres"},
    Label{"distribution", "small ones over large"},
    Label{"noise_size", "size of features", "voxels"},
    Label{"opacity", "opacity"},
    Label{"size", "size", "voxels"},
    Label{"smallest", "smallest radius"},
    Label{"largest", "largest radius"},
    Label{"seed", "seed"},
    Label{"position", "position"},
    Label{"radii", "radii"},
    Label{"index", "index of refraction"},
    Label{"intensity", "intensity", "W/sr"},
    // Smoke.
    Label{"voxels", "volume"},
    Label{"bloom", "time to grow"},
    Label{"hold", "time at full size"},
    Label{"dissolve", "time to dissolve"},
    Label{"extinction", "density"},
    Label{"albedo", "colour"},
    Label{"anisotropy", "glow against light"},
    Label{"droplet", "droplet size"},
    Label{"multiple_scattering", "inner glow"},
    Label{"erosion", "raggedness"},
    Label{"noise_size", "size of billows"},
    Label{"detail", "detail below that"},
    Label{"swirl", "swirl"},
    Label{"swirl_period", "time of a swirl"},
    Label{"rise", "billows rise by"},
    Label{"hole_rim", "ragged holes"},
    // Volumes, where they differ from smoke.
    Label{"emission", "brightness"},
    Label{"kelvin", "temperature"},
    Label{"glow", "unlit"},
    // Masks, disturbances and particles of volumes.
    Label{"color", "colour"},
    Label{"intensity", "brightness"},
    Label{"strength", "strength"},
    Label{"size", "size of the noise", "units"},
    Label{"drift", "drift"},
    Label{"grow", "grows over"},
    Label{"particles", "particles"},
    Label{"particle_size", "size of particles"},
    // Decals.
    Label{"scale", "scale"},
    Label{"gamma", "gamma"},
    Label{"correction", "correction"},
    Label{"falloff", "falloff"},
    Label{"fade", "fades at the sides", ""},
    Label{"scatter", "scatter"},
    // Sky.
    Label{"zenith", "sky above"},
    Label{"horizon", "sky at the horizon"},
    Label{"ambient", "light in shadows"},
    Label{"stars", "stars"},
    Label{"bounce", "light indoors"},
    // Shots, letters and explosions.
    Label{"radius", "radius"},
    Label{"reach", "time to pierce"},
    Label{"expand", "time to open"},
    Label{"stay", "time open"},
    Label{"fade", "time to close", "s"},
    Label{"roll", "roll"},
    Label{"flash", "flash"},
    Label{"size", "letter height", "m"},
    Label{"spacing", "letter spacing"},
    Label{"interval", "time between letters"},
    Label{"speed", "speed of the front"},
    Label{"remaining", "smoke that remains"},
    Label{"refill_rim", "edge full after"},
    Label{"refill_middle", "middle full after"},
    // The body of the player.
    Label{"half_width", "half its width"},
    Label{"height", "height"},
    Label{"eye", "height of the eye"},
    Label{"step", "highest step"},
    Label{"walk_speed", "walking speed"},
    Label{"fly_speed", "flying speed"},
    Label{"run", "running is faster by"},
    Label{"jump", "height of a jump"},
    Label{"gravity", "gravity"},
};

}  // namespace

const char* label_of(const scene::OptionInfo& info) {
  const auto found = std::ranges::find_if(kLabels, [&](const Label& label) {
    return std::string_view(label.key) == info.key &&
           (!label.unit || std::string_view(label.unit) == info.unit);
  });
  return found == kLabels.end() ? "" : found->label;
}

}  // namespace brume::viewer
