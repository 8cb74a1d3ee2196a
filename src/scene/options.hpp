// Every number and choice of a timeline's settings in one place: key, unit, range and description. The reader
// and writer of timelines, the C interfaces, the program's options, the viewer's panels, Blender's add-on and
// the tables of the documentation take their ranges from it or are tested against it. Events:
// scene/event_fields.hpp.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

namespace brume::scene {

struct OptionInfo {
  const char* key;              ///< In the file.
  const char* unit;             ///< Empty: a fraction or factor. kDegrees: the member holds radians.
  const char* about;            ///< One line.
  double low, high;             ///< Inclusive range in `unit`; for vectors, of each component.
  const char* label = nullptr;  ///< In the viewer's panels; null: the words of the key.
};

/// A setting that is one of some names, by their order in the member, an enumeration.
struct ChoiceField {
  const char *key, *about;
  std::span<const char* const> names;
};

/// The unit of angles: degrees in the file and in OptionInfo, radians in the member.
constexpr const char* kDegrees = "degrees";
constexpr double kRadiansOfDegree = 3.14159265358979323846 / 180;
inline bool is_angle(const OptionInfo& info) {
  return std::string_view(info.unit) == kDegrees;
}

/// Latest time of an event or a key [s]; largest coordinate of a camera or a grid, per axis [m].
constexpr double kLatestTime = 3600, kFarthestPoint = 1e6;

/// Whether a member is within its range. Compared as floats: the file's lower bound may round down to a float
/// below it. False for what is not a number.
inline bool is_in_range(const OptionInfo& info, float member) {
  const double unit = is_angle(info) ? kRadiansOfDegree : 1;
  return member >= static_cast<float>(info.low * unit) && member <= static_cast<float>(info.high * unit);
}

/// Most samples of a pixel.
constexpr std::uint32_t kMostSamples = 1u << 24;

// Each function calls visit(info, member) for every setting of a struct, in file order; a const struct gives
// const members. The default is the value in a default-constructed struct. Members are float, std::uint32_t,
// glm::vec3, and std::optional of float, glm::vec3 or glm::ivec3. Choices are visit(ChoiceField, member).

template <typename Options, typename Visitor>
void visit_exposure_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"exposure", "EV", "radiance is multiplied by 2^exposure", -20, 20}, o.exposure);
}

template <typename Options, typename Visitor>
void visit_duration_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"duration", "s", "duration of the film", 0.01, kLatestTime, "length of the film"},
        o.duration);
}

/// What timelines and scenes of tanks begin with.
template <typename Options, typename Visitor>
void visit_film_options(Options& o, Visitor&& visit) {
  visit_duration_options(o, visit);
  visit_exposure_options(o, visit);
}

/// By their number in ToneCurve.
inline constexpr std::array kToneCurves{"neutral", "standard"};

template <typename Options, typename Visitor>
void visit_tone_options(Options& o, Visitor&& visit) {
  visit(ChoiceField{"tone", "tone curve", kToneCurves}, o.tone);
}

/// Largest mean cosine of a phase function, forwards or backwards: closer to 1, the peak of Henyey-Greenstein
/// times the light of a sun no longer fits half floats.
constexpr double kMostAnisotropy = 0.99;

/// Most bounces of indirect light.
constexpr std::uint32_t kMostBounces = 16;

template <typename Options, typename Visitor>
void visit_bounce_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"bounces", "", "how often surfaces and smoke pass light on to each other; 0: never", 0,
                   kMostBounces},
        o.bounces);
}

/// Members of PictureSettings.
template <typename Options, typename Visitor>
void visit_picture_options(Options& o, Visitor&& visit) {
  visit_exposure_options(o, visit);
  visit_bounce_options(o, visit);
  visit_tone_options(o, visit);
}

/// Replaces settings of pictures by those that are given.
template <typename Settings, typename GivenSettings>
void replace_given(Settings& settings, const GivenSettings& given) {
  visit_picture_options(given, [&](const auto& info, const auto& value) {
    visit_picture_options(settings, [&]<typename Member>(const auto& other, Member& member) {
      if constexpr (std::is_same_v<decltype(value.value()), const Member&>)
        if (value && other.key == std::string_view(info.key)) member = *value;
    });
  });
}

/// How the scene's file becomes the level: settings that a running simulation cannot change.
template <typename Options, typename Visitor>
void visit_level_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"origin", "units", "point of the scene file that becomes the world's origin", -1e9, 1e9},
        o.origin);
  visit(OptionInfo{"scale", "", "metres per unit of the scene file", 1e-9, 1e9}, o.scale);
  visit(OptionInfo{"ground", "m", "height of a ground that reaches to the horizon", -kFarthestPoint,
                   kFarthestPoint},
        o.ground);
}

/// All settings of a timeline outside of its tables: readers, writer, check and tests go through this list.
template <typename Options, typename Visitor>
void visit_timeline_options(Options& o, Visitor&& visit) {
  visit_duration_options(o, visit);
  visit_picture_options(o, visit);
  visit_level_options(o, visit);
}

template <typename Options, typename Visitor>
void visit_grid_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"voxel", "m", "edge length of a voxel", 0.015625, 64}, o.voxel);
  visit(OptionInfo{"size", "voxels", "size of the grid", 1, 4096}, o.size);
  visit(OptionInfo{"origin", "m", "low corner of the grid", -kFarthestPoint, kFarthestPoint}, o.origin_world);
}

template <typename Options, typename Visitor>
void visit_smoke_options(Options& o, Visitor&& visit) {
  // Its amount and its life.
  visit(OptionInfo{"voxels", "", "voxels that a grown smoke fills", 1, 1 << 24, "volume"}, o.voxels);
  visit(OptionInfo{"bloom", "s", "time from going off to full size", 0.05, 60, "time to grow"}, o.bloom);
  visit(OptionInfo{"hold", "s", "time at full size", 0, kLatestTime, "time at full size"}, o.hold);
  visit(OptionInfo{"dissolve", "s", "time to dissolve", 0.05, 60, "time to dissolve"}, o.dissolve);

  // Its light.
  visit(OptionInfo{"extinction", "1/m", "extinction at full density", 0.01, 100, "density"}, o.extinction);
  visit(OptionInfo{"albedo", "", "fraction of the lost light that is scattered", 0, 1, "colour"}, o.albedo);
  visit(OptionInfo{"anisotropy", "", "Henyey-Greenstein g; above 0: forward scattering", -kMostAnisotropy,
                   kMostAnisotropy, "glow against light"},
        o.anisotropy);
  visit(OptionInfo{"droplet", "um", "droplet diameter; replaces `anisotropy`", 0.1, 50, "droplet size"},
        o.droplet);
  visit(OptionInfo{"multiple_scattering", "", "weight of multiple scattering; 0: single scattering only", 0,
                   1, "inner glow"},
        o.multiple_scattering);

  // Its noise.
  visit(OptionInfo{"erosion", "", "how deeply noise erodes the rim", 0, 1, "raggedness"}, o.erosion);
  visit(OptionInfo{"noise_size", "m", "edge length of a noise cell", 0.05, 100, "size of billows"},
        o.noise_size);
  visit(OptionInfo{"detail", "", "strength of noise finer than that, down to 2 cm; 0: none", 0, 1,
                   "detail below that"},
        o.detail);
  visit(OptionInfo{"swirl", "m", "how far the noise swirls around its place", 0, 10}, o.swirl);
  visit(OptionInfo{"swirl_period", "s", "period of the swirl; the first turn is faster", 0.1, kLatestTime,
                   "time of a swirl"},
        o.swirl_period);
  visit(OptionInfo{"rise", "m/s", "speed at which the noise rises", -10, 10, "billows rise by"}, o.rise);
  visit(OptionInfo{"hole_rim", "m", "largest displacement of hole rims by noise", 0, 10, "ragged holes"},
        o.hole_rim);
}

template <typename Options, typename Visitor>
void visit_sky_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"zenith", "", "radiance at the zenith", 0, 1000, "sky above"}, o.zenith);
  visit(OptionInfo{"horizon", "", "radiance at the horizon", 0, 1000, "sky at the horizon"}, o.horizon);
  visit(OptionInfo{"ambient", "", "ambient radiance", 0, 1000, "light in shadows"}, o.ambient);
  visit(OptionInfo{"stars", "", "radiance of the brightest star", 0, 1000}, o.stars);
  visit(OptionInfo{"bounce", "",
                   "fraction of `ambient` that reaches places without a view of the sky, by interreflection",
                   0, 1, "light indoors"},
        o.bounce);
}

template <typename Options, typename Visitor>
void visit_sun_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"azimuth", kDegrees, "where the sun is, from +z towards +x", -360, 360}, o.azimuth);
  visit(OptionInfo{"elevation", kDegrees, "how high it is above the horizon", 0.1, 90}, o.elevation);
  visit(OptionInfo{"irradiance", "W/m^2", "irradiance of a surface that faces it", 0, 1e6}, o.irradiance);
}

/// Settings of VolumeOptions without its place.
template <typename Options, typename Visitor>
void visit_volume_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"rotation", "degrees each", "rotation about x, then y, then z", -360, 360}, o.rotation);
  visit(OptionInfo{"scale", "", "metres per unit of the file", 1e-9, 1e9}, o.scale);
  visit(OptionInfo{"x_axis", "", "where a step along the file's x leads, before `scale` and `rotation`", -1e9,
                   1e9},
        o.x_axis);
  visit(OptionInfo{"y_axis", "", "the same for y", -1e9, 1e9}, o.y_axis);
  visit(OptionInfo{"z_axis", "", "the same for z", -1e9, 1e9}, o.z_axis);

  // Its light, and the times of a sequence.
  visit(OptionInfo{"extinction", "1/m", "extinction where the density is 1", 0, 1e12, "density"},
        o.extinction);
  visit(OptionInfo{"albedo", "", "fraction of the lost light that is scattered", 0, 1, "colour"}, o.albedo);
  visit(OptionInfo{"anisotropy", "", "Henyey-Greenstein g; above 0: forward scattering", -kMostAnisotropy,
                   kMostAnisotropy, "glow against light"},
        o.anisotropy);
  visit(OptionInfo{"multiple_scattering", "", "weight of multiple scattering; 0: single scattering only", 0,
                   1, "inner glow"},
        o.multiple_scattering);
  visit(OptionInfo{"emission", "", "brightness of what glows", 0, 1e6, "brightness"}, o.emission);
  visit(OptionInfo{"kelvin", "K", "temperature where the heat is 1", 0, 1e5, "temperature"}, o.kelvin);
  visit(OptionInfo{"frame_rate", "1/s", "frames of a sequence a second", 0.001, 1000}, o.frame_rate);
  visit(OptionInfo{"start", "s", "time of the first frame of a sequence", -kLatestTime, kLatestTime},
        o.start);
  visit(OptionInfo{"glow", "", "fraction of the colours that is emitted, unlit, instead of scattered", 0, 1,
                   "unlit"},
        o.glow);
}

/// What a VolumeMask and a MaskKey share.
template <typename Options, typename Visitor>
void visit_mask_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"color", "", "colour of what the mask emits", 0, 1, "colour"}, o.color);
  visit(
      OptionInfo{"intensity", "1/m", "radiance that a metre emits where the mask is 1", 0, 1e6, "brightness"},
      o.intensity);
}

template <typename Options, typename Visitor>
void visit_disturbance_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"strength", "units", "largest displacement along each axis", 0, 1e6}, o.strength);
  visit(OptionInfo{"size", "units", "size of the noise's largest features", 1e-6, 1e6, "size of the noise"},
        o.size);
  visit(OptionInfo{"drift", "units/s", "how fast the noise moves", -1e6, 1e6}, o.drift);
  visit(OptionInfo{"grow", "units", "length along `drift` over which the strength grows from 0", 0, 1e6,
                   "grows over"},
        o.grow);
}

template <typename Options, typename Visitor>
void visit_detail_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"strength", "", "how much noise finer than the voxels wears away thin parts", 0, 1},
        o.strength);
  visit(
      OptionInfo{"size", "units", "size of its largest billows; 0: four voxels", 0, 1e6, "size of the noise"},
      o.size);
  visit(OptionInfo{"drift", "units/s", "how fast it moves", -1e6, 1e6}, o.drift);
}

template <typename Options, typename Visitor>
void visit_particle_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"particles", "", "quads that show the masks, instead of a march; 0: none", 0, 65536},
        o.particles);
  visit(OptionInfo{"particle_size", "", "radius of a quad relative to the box's shortest side", 0.001, 2,
                   "size of particles"},
        o.particle_size);
}

/// All of a CarrierKey but its time and position.
template <typename Options, typename Visitor>
void visit_carrier_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"rotation", "degrees each", "rotation about x, then y, then z", -36000, 36000},
        o.rotation);
}

/// Settings of TankOptions without its place.
template <typename Options, typename Visitor>
void visit_tank_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"rotation", "degrees each", "rotation about x, then y, then z", -360, 360}, o.rotation);
  visit(OptionInfo{"scale", "", "metres per metre of the tank", 1e-6, 1e6}, o.scale);
  visit(OptionInfo{"samples", "", "paths of each pixel in an image; one in each of its samples at least", 1,
                   64, "samples of a pixel"},
        o.samples);
}

/// Settings of DecalOptions without its place.
template <typename Options, typename Visitor>
void visit_decal_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"rotation", "degrees each", "rotation about x, then y, then z", -360, 360}, o.rotation);
  visit(OptionInfo{"scale", "", "metres per unit of the file", 1e-9, 1e9}, o.scale);
  visit(OptionInfo{"strength", "", "fraction of the occlusion that darkens", 0, 1}, o.strength);
  visit(OptionInfo{"gamma", "", "exponent of the occlusion at the middle slice; below 1 darkens", 0.1, 10},
        o.gamma);
  visit(OptionInfo{"correction", "", "how much of `gamma` applies at the middle slice", 0, 1}, o.correction);
  visit(OptionInfo{"falloff", "", "how fast that fades towards the first and the last slice", 0, 100},
        o.falloff);
  visit(OptionInfo{"fade", "", "part of the box, at each side, over which the decal fades out", 0, 0.5,
                   "fades at the sides"},
        o.fade);
  visit(OptionInfo{"scatter", "voxels", "how far noise scatters the samples", 0, 4}, o.scatter);
}

/// Field of view, lens and shutter: position, target and files are not settings.
template <typename Options, typename Visitor>
void visit_camera_options(Options& o, Visitor&& visit) {
  visit(OptionInfo{"fov", kDegrees, "vertical field of view", 1, 170, "field of view"}, o.vertical_fov);
  visit(OptionInfo{"aperture", "m", "radius of the lens; 0: all is sharp", 0, 100, "aperture radius"},
        o.lens.aperture);
  visit(OptionInfo{"focus", "m", "sharp distance along the view; 0: as far as the target", 0, kFarthestPoint,
                   "focus distance"},
        o.lens.focus);
  visit(OptionInfo{"blades", "", "edges of the lens's opening; below 3: round", 0, 64, "aperture blades"},
        o.lens.blades);
  visit(OptionInfo{"shutter", "s", "how long the shutter stays open, for motion blur", 0, 10, "shutter time"},
        o.shutter);
}

/// The description of one number, such as
/// info_of<SkyOptions>("stars", [](auto& o, auto& v) { visit_sky_options(o, v); }).
template <typename Options, typename Visit>
OptionInfo info_of(std::string_view key, Visit visit) {
  OptionInfo found{};
  const Options options{};
  const auto look = [&]<typename Info>(const Info& info, const auto&) {
    if constexpr (std::is_same_v<Info, OptionInfo>)
      if (info.key == key) found = info;
  };
  visit(options, look);
  return found;
}

}  // namespace brume::scene
