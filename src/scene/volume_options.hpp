// The volumes of a timeline: their files, places, looks, masks and noise.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scene/transfer.hpp"

namespace brume::scene {

/// The colour of a mask at one time.
struct MaskKey {
  double time = 0;  ///< [s], [0, 3600].
  glm::vec3 color{1};
  float intensity = 1;

  bool operator==(const MaskKey&) const = default;
};

/// A grid of a volume that glows in one colour: where its value is 1, color * intensity leaves each metre.
struct VolumeMask {
  std::string grid;
  glm::vec3 color{1};
  float intensity = 1;
  std::vector<MaskKey> keys;  ///< Replace both; sorted by time, no two times equal. Linear in between.

  bool operator==(const VolumeMask&) const = default;
};
inline constexpr std::size_t kMostMasks = 4;
/// Extinction of a volume with masks whose file states none: what only glows blocks no light.
inline constexpr float kMaskedExtinction = 0;

/// Radiance per metre of a mask at a time.
glm::vec3 glow_at(const VolumeMask& mask, double time);

/// Noise that moves the places at which a volume is sampled.
struct Disturbance {
  float strength = 0;  ///< Largest displacement along each axis, in units of the file; 0: none.
  float size = 0.1f;   ///< Size of the noise's largest features, likewise.
  glm::vec3 drift{0};  ///< How fast the noise moves, likewise [1/s].
  float grow = 0;      ///< Length along `drift` over which the strength grows from 0; 0: it is everywhere.
  bool operator==(const Disturbance&) const = default;
};

/// Noise below the voxels of a volume, which wears away its thin parts.
struct VolumeDetail {
  float strength = 0;  ///< 0: none; 1: only what is as dense as the densest stays.
  float size = 0;      ///< Size of its largest billows, in units of the file; 0: four voxels.
  glm::vec3 drift{0};  ///< How fast it moves, likewise [1/s].
  bool operator==(const VolumeDetail&) const = default;
};

/// Largest number of a frame of a sequence.
constexpr std::uint32_t kLastFrame = 1'000'000'000;

/// Volumes of a timeline at most: a frame shows as many.
inline constexpr std::size_t kMostVolumes = 32;

/// A volume of a file of grids (grids/files.hpp), placed in the world: its axes replaced, scaled, rotated
/// about x, then y, then z, moved.
struct VolumeOptions {
  /// Resolved. A sequence has the number of a frame as %d or %04d.
  std::filesystem::path file;
  std::optional<std::uint32_t> first = {}, last = {};  ///< Frames of a sequence; empty: those of its files.
  bool clip = false, ping_pong = false;                ///< Not together, nor with `loop`.
  glm::vec3 x_axis{1, 0, 0}, y_axis{0, 1, 0}, z_axis{0, 0, 1};
  std::string density = {};  ///< Name of the grid of densities; empty: the first of the usual names.
  std::string heat = {};     ///< The grid that glows; empty: the first of the usual names, or none.
  std::string color = {};    ///< The grid of colours that multiply the albedo; likewise.
  glm::vec3 position_world{0};
  glm::vec3 rotation{0};  ///< About x, y and z [degrees].
  float scale = 1;
  float extinction = 1;
  glm::vec3 albedo{0.9f};
  float anisotropy = 0.2f;
  float multiple_scattering = 1;
  float emission = 1;
  float kelvin = 1000;
  float frame_rate = 24;
  float start = 0;
  bool loop = false;
  // Transfer functions of the density's values.
  std::optional<glm::vec2> range = {};     ///< Values that they span; empty: those of the first frame.
  std::vector<OpacityPoint> opacity = {};  ///< Replaces the value as factor of the extinction.
  ColorMap color_map = {};                 ///< Replaces the albedo.
  float glow = 0;
  std::string carrier = {};            ///< What it moves with; empty: the world.
  std::vector<VolumeMask> masks = {};  ///< At most kMostMasks.
  Disturbance disturbance = {};
  VolumeDetail detail = {};
  std::uint32_t particles = 0;  ///< Quads that show its masks instead of a march; 0: none.
  float particle_size = 0.6f;
  std::string place = {};  ///< "file:line:column" for error messages.

  bool operator==(const VolumeOptions&) const = default;
};

}  // namespace brume::scene
