// A tank of spheres, its lights, its glass and the camera before it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "scene/camera_path.hpp"
#include "scene/sky.hpp"
#include "scene/tone.hpp"
#include "spheres/pack.hpp"

namespace brume::scene {

// Units, ranges and meanings of all settings: scene/tank_options.hpp.

/// Where something is at one time.
struct PlaceKey {
  double time = 0;  ///< [s], [0, kLatestTime].
  glm::vec3 position_world{0};
};

/// A ball that shines evenly in all directions. Invisible itself, and blocks no light.
struct TankLight {
  glm::vec3 position_world{0, 2, 0};
  glm::vec3 color{1};
  float intensity = 4;  ///< [W/sr], times `color`.
  float radius = 0.05f;
  std::vector<PlaceKey> keys = {};  ///< Replace the position; sorted by time, no two times equal.
};
constexpr std::size_t kMostTankLights = 16;

/// The glass at one time.
struct GlassKey {
  double time = 0;
  glm::vec3 position_world{0};
  glm::vec3 radii{0.5f};
};

/// An ellipsoid of glass along the world's axes.
struct TankGlass {
  glm::vec3 position_world{0, 0, 1.5f};
  glm::vec3 radii{0.5f};
  float index = 1.5f;               ///< Index of refraction.
  std::vector<GlassKey> keys = {};  ///< Replace position and radii.
};

/// What stands for the spheres.
enum class TankView : std::uint32_t {
  spheres,  ///< The spheres themselves: exact surfaces, light by paths.
  voxels,   ///< The voxels painted with them, lit through them.
};

/// How the light of voxels is found.
enum class TankLighting : std::uint32_t {
  maps,   ///< Along rays from the lights, in proportion to the number of voxels: interactive.
  exact,  ///< Every voxel walks to every light: the truth that `maps` is measured by.
};

/// How points of the lens are chosen. The same lens.
enum class LensPoints : std::uint32_t {
  remap,      ///< Well distributed points of a square, mapped.
  rejection,  ///< Random points until one lies on it: noisier, for comparison.
};

/// What camera rays gather with distance inside of the tank: radiance color * (1 - exp(-extinction *
/// distance)).
struct TankFog {
  float extinction = 0;  ///< [1/m]
  glm::vec3 color{0.02f, 0.05f, 0.08f};
};

struct TankScene {
  std::filesystem::path file;  ///< The tank's file, resolved; empty: it is packed.
  spheres::PackOptions pack;   ///< Without its palette.
  std::string palette;         ///< "NAME:0.2-0.6" (palettes/choice.hpp), a file resolved; empty: white.
  std::string palette_space = "oklab";  ///< Where its colours are interpolated (palettes::Space).
  TankView view = TankView::spheres;
  TankLighting lighting = TankLighting::maps;  ///< How TankView::voxels are lit.
  LensPoints lens_points = LensPoints::remap;
  float dither = 1;  ///< Noise of the rounding to 8 bits, in steps of them; 0: bands.
  float duration = 4;
  float exposure = 0;  ///< [EV]
  ToneCurve tone = ToneCurve::neutral;
  std::uint32_t samples = 64;  ///< Samples of a picture.
  std::uint32_t bounces = 2;   ///< Most scattering events of a path.
  std::uint32_t photons = 0;   ///< Paths of light that are traced from the lights through the glass.
  SkyOptions sky;  ///< Zenith and horizon: what is behind the tank. Ambient: what spheres see of it.
  TankFog fog;
  std::vector<TankLight> lights;  ///< At most kMostTankLights.
  std::optional<TankGlass> glass;
  std::vector<CameraKey> camera;  ///< Sorted by time, no two times equal; empty: before the tank.
};

// Their names in the file.
const char* view_name(TankView view);
const char* lighting_name(TankLighting lighting);
const char* lens_points_name(LensPoints points);
const char* arrangement_name(spheres::Arrangement arrangement);
constexpr std::uint32_t kArrangements = 4;
const char* coloring_name(spheres::Coloring coloring);
constexpr std::uint32_t kColorings = 4;

/// Finds one of `count` values by its name, in which '-' stands for '_', too. If there is none, fails with
/// usage and `expected "a", "b" or "c"`.
template <typename Choice>
Result<Choice> choice_of(std::string text, std::uint32_t count, const char* (*name_of)(Choice)) {
  std::replace(text.begin(), text.end(), '-', '_');
  std::string names;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::string name = name_of(Choice{i});
    if (text == name) return Choice{i};
    names += (i == 0 ? "" : i + 1 < count ? ", " : " or ") + ('"' + name + '"');
  }
  return Failure{ErrorCode::usage, "expected " + names};
}

/// The lights and the glass at a time [s]: position and radii pass through their keys, at rest before the
/// first and after the last.
TankLight light_at(const TankLight& light, double time);
TankGlass glass_at(const TankGlass& glass, double time);
/// The camera likewise, or one that shows all of a tank of this size [m].
Camera camera_at(const TankScene& scene, const glm::vec3& tank_size, double time);

}  // namespace brume::scene
