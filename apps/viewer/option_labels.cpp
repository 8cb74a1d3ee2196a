#include "apps/viewer/option_labels.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace brume::viewer {
namespace {

constexpr std::array<std::pair<std::string_view, const char*>, 49> kLabels{{
    // Of the film and the grid.
    {"duration", "length of the film"},
    {"exposure", "exposure"},
    {"fov", "field of view"},
    // Of the smoke.
    {"voxels", "volume"},
    {"bloom", "time to grow"},
    {"hold", "time at full size"},
    {"dissolve", "time to dissolve"},
    {"extinction", "density"},
    {"albedo", "colour"},
    {"anisotropy", "glow against light"},
    {"droplet", "droplet size"},
    {"multiple_scattering", "inner glow"},
    {"erosion", "raggedness"},
    {"noise_size", "size of billows"},
    {"swirl", "swirl"},
    {"swirl_period", "time of a swirl"},
    {"rise", "billows rise by"},
    {"hole_rim", "ragged holes"},
    // Of volumes, where they differ.
    {"emission", "brightness"},
    {"kelvin", "temperature"},
    {"glow", "unlit"},
    // Of the sky.
    {"zenith", "sky above"},
    {"horizon", "sky at the horizon"},
    {"ambient", "light in shadows"},
    {"stars", "stars"},
    {"bounce", "light indoors"},
    // Of shots, letters and explosions.
    {"radius", "radius"},
    {"reach", "time to pierce"},
    {"expand", "time to open"},
    {"stay", "time open"},
    {"fade", "time to close"},
    {"roll", "roll"},
    {"flash", "flash"},
    {"size", "letter height"},
    {"spacing", "letter spacing"},
    {"interval", "time between letters"},
    {"speed", "speed of the front"},
    {"remaining", "smoke that remains"},
    {"refill_rim", "edge full after"},
    {"refill_middle", "middle full after"},
    // Of the body.
    {"half_width", "half its width"},
    {"height", "height"},
    {"eye", "height of the eye"},
    {"step", "highest step"},
    {"walk_speed", "walking speed"},
    {"fly_speed", "flying speed"},
    {"run", "running is faster by"},
    {"jump", "height of a jump"},
    {"gravity", "gravity"},
}};

}  // namespace

const char* label_of(std::string_view key) {
  const auto found =
      std::find_if(kLabels.begin(), kLabels.end(), [&](const auto& label) { return label.first == key; });
  return found == kLabels.end() ? "" : found->second;
}

}  // namespace brume::viewer
