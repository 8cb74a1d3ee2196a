// Every number of a timeline in one place: its key, unit, range and what it is. The reader and the writer of
// timelines, the viewer's panels and the table of docs/timeline.md follow it.
#pragma once

#include <string_view>

#include "scene/timeline.hpp"

namespace brume::scene {

struct OptionInfo {
  const char* key;    ///< In the file.
  const char* unit;   ///< Empty: a share or a factor. kDegrees: the member holds radians.
  const char* about;  ///< One line.
  double low, high;   ///< The range, both ends included, in `unit`; of vectors along each axis.
};

/// The unit of angles: degrees in the file and in OptionInfo, radians in the member.
constexpr const char* kDegrees = "degrees";
constexpr double kRadiansOfDegree = 3.14159265358979323846 / 180;
inline bool is_angle(const OptionInfo& info) {
  return std::string_view(info.unit) == kDegrees;
}

/// The latest time of an event or a key [s], and the farthest point of a camera or a grid, along each axis
/// [m].
constexpr double kLatestTime = 3600, kFarthestPoint = 1e6;

// Each function calls visit(info, member) for the members of a struct that are settings, in the order in
// which files name them; a const struct gives const members. The default is that of a struct that was just
// made. Members are float, std::uint32_t, glm::vec3 and std::optional of float, glm::vec3 or glm::ivec3.

template <typename Options, typename Visitor>
void visit_timeline_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"duration", "s", "length of the film", 0.01, kLatestTime}, o.duration);
  visit(OptionInfo{"exposure", "EV", "the picture is multiplied by 2^exposure", -20, 20}, o.exposure);
}

template <typename Options, typename Visitor>
void visit_grid_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"voxel", "m", "edge of a voxel", 0.015625, 10}, o.voxel);
  visit(OptionInfo{"size", "voxels", "the grid's size", 1, 4096}, o.size);
  visit(OptionInfo{"origin", "m", "the grid's low corner", -kFarthestPoint, kFarthestPoint}, o.origin_world);
}

template <typename Options, typename Visitor>
void visit_smoke_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"voxels", "", "how many voxels a grown smoke fills", 1, 1 << 24}, o.voxels);
  visit(OptionInfo{"bloom", "s", "from going off to full size", 0.05, 60}, o.bloom);
  visit(OptionInfo{"hold", "s", "from there until it begins to dissolve", 0, kLatestTime}, o.hold);
  visit(OptionInfo{"dissolve", "s", "from there until nothing is left", 0.05, 60}, o.dissolve);
  visit(OptionInfo{"extinction", "1/m", "in dense smoke", 0.01, 100}, o.extinction);
  visit(OptionInfo{"albedo", "", "share of light that is scattered", 0, 1}, o.albedo);
  visit(OptionInfo{"anisotropy", "", "Henyey-Greenstein's g; above 0: forward", -0.9, 0.9}, o.anisotropy);
  visit(OptionInfo{"droplet", "um", "instead of `anisotropy`: diameter of the droplets that it is made of",
                   0.1, 50},
        o.droplet);
  visit(OptionInfo{"multiple_scattering", "",
                   "share of the light that is scattered more than once: 0 shows single scattering", 0, 1},
        o.multiple_scattering);
  visit(OptionInfo{"erosion", "", "how deep the noise eats into the rim", 0, 1}, o.erosion);
  visit(OptionInfo{"noise_size", "m", "edge of a noise cell", 0.05, 100}, o.noise_size);
  visit(OptionInfo{"swirl", "m", "how far the noise rolls around its place", 0, 10}, o.swirl);
  visit(OptionInfo{"swirl_period", "s", "how long one roll takes; the first goes faster", 0.1, kLatestTime},
        o.swirl_period);
  visit(OptionInfo{"rise", "m/s", "how fast the noise rises", -10, 10}, o.rise);
  visit(OptionInfo{"hole_rim", "m", "how far noise moves the rims of holes at most", 0, 10}, o.hole_rim);
}

template <typename Options, typename Visitor>
void visit_sky_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"zenith", "", "radiance overhead", 0, 1000}, o.zenith);
  visit(OptionInfo{"horizon", "", "radiance at the horizon", 0, 1000}, o.horizon);
  visit(OptionInfo{"ambient", "", "radiance from everywhere", 0, 1000}, o.ambient);
  visit(OptionInfo{"stars", "", "radiance of the brightest star", 0, 1000}, o.stars);
  visit(OptionInfo{"bounce", "",
                   "share of `ambient` that comes, from surface to surface, to where no sky is seen", 0, 1},
        o.bounce);
}

/// The field of view alone; where the camera is, is no setting.
template <typename Options, typename Visitor>
void visit_camera_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"fov", kDegrees, "vertical field of view", 1, 170}, o.vertical_fov);
}

template <typename Options, typename Visitor>
void visit_hole_times(Options& o, Visitor&& visit) {
  visit(OptionInfo{"reach", "s", "until the hole's front is at the far end", 0, 60}, o.reach);
  visit(OptionInfo{"expand", "s", "the hole grows, at each depth", 0, 60}, o.expand);
  visit(OptionInfo{"stay", "s", "it is open", 0, 600}, o.stay);
  visit(OptionInfo{"fade", "s", "it closes", 0, 60}, o.fade);
}

/// Those of ShotEvent, with its HoleTimes.
template <typename Options, typename Visitor>
void visit_shot_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"radius", "m", "of the hole, half the edge of a box or mask", 0.01, 10}, o.radius);
  visit_hole_times(o.times, visit);
  visit(OptionInfo{"roll", kDegrees, "turns a box or mask clockwise as the shooter sees it", -360, 360},
        o.roll);
  visit(OptionInfo{"flash", "W/sr", "of the muzzle: light for 0.06 s", 0, 1e6}, o.flash);
}

/// Those of TextEvent, with its HoleTimes.
template <typename Options, typename Visitor>
void visit_text_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"size", "m", "height of a capital letter", 0.02, 10}, o.size);
  visit(OptionInfo{"spacing", "", "more room between letters, in heights of a capital", -0.5, 10}, o.spacing);
  visit(OptionInfo{"interval", "s", "from letter to letter", 0, 10}, o.interval);
  visit_hole_times(o.times, visit);
  visit(OptionInfo{"roll", kDegrees, "turns the row clockwise as the shooter sees it", -360, 360}, o.roll);
}

template <typename Options, typename Visitor>
void visit_blast_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"radius", "m", "of the cavity that it opens", 0.1, 100}, o.radius);
  visit(OptionInfo{"speed", "m/s", "of its front", 1, 10000}, o.speed);
  visit(OptionInfo{"remaining", "", "fraction of the density that remains", 0, 1}, o.remaining);
  visit(OptionInfo{"refill_rim", "s", "until the rim is full again", 0.01, 60}, o.refill_rim);
  visit(OptionInfo{"refill_middle", "s", "until the middle is; no less than `refill_rim`", 0.01, 60},
        o.refill_middle);
  visit(OptionInfo{"flash", "W/sr", "of the fire: light for 0.3 s", 0, 1e6}, o.flash);
}

}  // namespace brume::scene
