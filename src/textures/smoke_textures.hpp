// The smoke of a field as textures and constants for any renderer: what shaders/export/smoke.glsl reads.
//
//   Density       RG8 3D, linear: bricks of 10^3 texels, 8^3 voxels and an apron: density; 1 in a free voxel
//   Displacement  RGBA16F 3D, linear: 6^3 points of each brick, two voxels apart: displacement of the noise
//   [m] Pages         R16UI 3D: for each brick of the window, its place among the bricks of the textures + 1,
//   or 0 Cells         R32UI 3D: 9^3 cells of each brick: boundary cell + 1, or 0 Boundary      RGBA32UI 2D,
//   kBoundaryAcross in a row: the boundary cells (shared/smoke_volume.h) Corners       RG32UI 2D,
//   kCornersAcross in a row: their corner sets Holes         RGBA32F 2D: a row of six texels for each open
//   hole (smoke_textures.cpp, hole_row) Masks         R8 2D, linear: the images of holes Noise         RGBA8
//   3D, linear, repeats, with mip levels: the tile of noise Detail        RG8 3D, linear, repeats, with mip
//   levels: its detail
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>

#include "smoke/field.hpp"
#include "textures/light_volume.hpp"
#include "textures/noise_points.hpp"
#include "textures/texture_set.hpp"

namespace brume::textures {

/// Textures of a SmokeTextures, by their place in TextureSet.
enum SmokeTexture : std::uint32_t {
  kDensity,
  kDisplacement,
  kPages,
  kCells,
  kBoundary,
  kCorners,
  kHoles,
  kMasks,
  kNoise,
  kDetail,
  kLight,
  kSmokeTextures,
};

constexpr int kBoundaryAcross = 256;
constexpr int kCornersAcross = 1024;
/// Holes beyond these, the oldest, are left out.
constexpr std::size_t kMostHoles = 128;
/// Rows of four numbers that shaders read: BRUME_CONSTANT_* of smoke.glsl.
constexpr std::size_t kConstantRows = 10;
using Constants = std::array<glm::vec4, kConstantRows>;

struct SmokeTexturesSettings {
  smoke::NoiseLook noise;
  double swirl_period = smoke::SmokeInput().swirl_period;  ///< [s], > 0.
  std::uint32_t light_count = 0;                           ///< Lights of the light volume.
  bool sky = false;                                        ///< Whether it has the sky.
  int noise_spacing = 1;  ///< Distance of points of displacement, 1 or 2 [voxels].
};

class SmokeTextures {
 public:
  /// `masks` (null: none) must be those of the fields.
  SmokeTextures(const SmokeTexturesSettings& settings, std::shared_ptr<const smoke::MaskAtlas> masks);

  /// What a picture of the smoke depends on besides the field.
  struct Frame {
    double seconds = 0;  ///< After tick 0: the time of the field's state, or later.
    float extinction = 3;
    std::span<const Light> lights;
    float light_update_fraction = 1;  ///< Fraction of the texels whose light this update finds, (0, 1].
  };

  /// Follows a field, which must stay as it is meanwhile. Afterwards `set` has all that changed since the
  /// last update. Throws Error(resource_limit), with nothing changed, when the smoke has more than
  /// kMostBricks.
  void update(const smoke::Field& field, const Frame& frame);

  const TextureSet& set() const { return set_; }
  const Constants& constants() const { return constants_; }

  static constexpr std::uint32_t kMostBricks = 65534;

 private:
  void update_bricks(const smoke::SmokeVolume& volume, bool all);
  void write_bricks(const smoke::SmokeVolume& volume, bool all);
  void update_pages(const smoke::SmokeVolume& volume, bool all);
  void update_walls(const smoke::SmokeVolume& volume, bool all);
  void update_displacements();
  std::span<glm::u16vec4> displacements(std::size_t brick);
  void update_holes(std::span<const shared::Hole> holes, double seconds);
  void update_light(const smoke::Field& field, const Frame& frame);
  void write_static();
  void write_constants(const smoke::SmokeVolume& volume, const Frame& frame);

  SmokeTexturesSettings settings_;
  shared::SmokeLook look_{};
  std::shared_ptr<const smoke::MaskAtlas> masks_;
  TextureSet set_;
  Constants constants_{};
  NoisePoints points_;
  LightVolume light_;
  std::uint64_t volume_id_ = 0, revision_ = 0;  // volume and revision of the last update
  glm::ivec3 atlas_bricks_{0};
  glm::ivec3 window_low_{0}, window_size_{0};  // window of the pages [bricks]
  std::vector<std::uint16_t> pages_;
  std::vector<SmokyBrick> smoky_;       // in the order of slots
  std::vector<std::size_t> displaced_;  // their regions of displacement; empty without noise
  std::vector<shared::Hole> holes_;
  bool incomplete_ = true;  // nothing was written, or the last update failed
};

}  // namespace brume::textures
