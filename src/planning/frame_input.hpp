// What one frame shows, in groups that change at different rates.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "grids/dense_grid.hpp"
#include "planning/debug_request.hpp"
#include "planning/next_level.hpp"
#include "planning/particle_plan.hpp"
#include "planning/tank_input.hpp"
#include "scene/moved_objects.hpp"
#include "scene/scene.hpp"
#include "scene/tone.hpp"
#include "scene/volume_options.hpp"
#include "shared/frame.h"
#include "shared/hole.h"
#include "shared/light.h"
#include "sim/level_edit.hpp"
#include "sim/state.hpp"
#include "smoke/smoke_input.hpp"
#include "voxel/bit_grid.hpp"

namespace brume::planning {

/// The most lights of one frame beyond those of the scene.
constexpr std::size_t kMaxFlashes = 64;

/// A level at one time. The edits list what changed since the level was loaded; null: nothing.
struct LevelView {
  const voxel::BitGrid* grid = nullptr;  ///< Edits included; null: nothing is solid anywhere.
  std::shared_ptr<const sim::EditBlocks> edits;
  /// What stops light, where that is less: of the same layout, edits included.
  const voxel::BitGrid* opaque = nullptr;
  const voxel::BitGrid* light_grid() const { return opaque ? opaque : grid; }
  bool operator==(const LevelView&) const = default;
};

/// Which part of a camera's picture a frame is: what a pinhole on its lens sees.
struct ViewSample {
  glm::vec2 pixel{0};  ///< From the middle of each pixel to the point that it shows, y down [px].
  glm::vec2 lens{0};   ///< Where the pinhole is on the lens, x right and y up, in radii of it.
  /// Among the frames of a picture, which come one after the other; each shows the mean of those so far.
  std::uint32_t index = 0, count = 1;
};

/// The most views of one renderer, such as the eyes of a headset or the parts of a split screen.
constexpr std::uint32_t kMaxViews = 4;

/// Parallel: all rays run along the view axis, and the frustum of the camera, which it must have, has the
/// distances of its sides from the axis [m]. Only pictures of a host may be parallel.
enum class Projection { perspective, parallel };

struct View {
  scene::Camera camera;
  Projection projection = Projection::perspective;  ///< Also of the picture before.
  /// Which of the renderer's views this is, below kMaxViews: each accumulates on its own.
  std::uint32_t index = 0;
  /// Size of the picture [px], at most the renderer's size; the renderer's images hold it in their top left
  /// corner. 0: the renderer's size. Only pictures of a host may be smaller.
  glm::uvec2 size_px{0};
  ViewSample sample = {};
  float exposure = 1;  ///< Multiplies radiance before the tone curve; > 0.
  scene::ToneCurve tone = scene::ToneCurve::neutral;
  std::uint32_t frame_index = 0;  ///< Moves jitter and dither; equal numbers give equal images.
  /// The next frame of the view's film: a renderer that accumulates smoke over frames goes on from the frames
  /// before.
  bool continues = false;
  /// The camera of the picture before, in coordinates of this frame; empty: of the view's last frame, if the
  /// film continues. Motion leads there, and a frame that continues takes it for the last frame's camera.
  struct Previous {
    scene::Camera camera;
    ViewSample sample = {};
  };
  std::optional<Previous> previous = {};
};

struct Environment {
  shared::Sky sky{};
  std::vector<shared::Light> flashes;  ///< Lights of this frame.
  /// Lights that stand for what glows in volumes. Of these and the flashes before them, at most kMaxFlashes
  /// are lit, the first ones.
  std::vector<shared::Light> glow = {};
  /// How often surfaces and smoke pass light on to each other; 0: never.
  std::uint32_t bounces = 0;
};

struct LevelState {
  LevelView voxels;                           ///< Where the level is solid; always of the same level.
  std::vector<std::uint32_t> hidden_objects;  ///< Objects of the scene, rising: not drawn, without a shadow.
  std::vector<glm::mat4> grenades;            ///< world_from_mesh of each grenade in the air.
  /// Objects of the scene, rising; hidden ones, too, which are drawn here without a shadow.
  std::vector<scene::MovedObject> moved;
  /// The level of later frames, for what takes long to compute from it; null: unknown. Never decides what is
  /// shown.
  std::shared_ptr<const NextLevel> next = nullptr;
};

using smoke::SmokeInput;

struct Quality {
  /// Multiplies look.step_length, for devices that the usual steps are too expensive for; > 0. Light in the
  /// smoke does not depend on it.
  float step_scale = 1;
  /// Multiplies the error up to which pixels of a reduced march are interpolated, three steps of a display's
  /// 255; > 0. Above 1 fewer pixels are marched one by one, and the image may show what that of the full
  /// march hides.
  float resolve_error_scale = 1;
  /// Noise within a voxel shadows the smoke near the eye, where there is noise
  /// (shaders/shared/fine_light.h): billows are darker where they face away from the light.
  bool fine_shadows = true;
  /// The noise of smoke has its detail (shaders/shared/erosion.h): without it nothing is finer than a cell of
  /// the tile, and the march takes two thirds of the time.
  bool detail = true;
  /// About which fraction of the light that changed is updated in this frame; in (0, 1], 1: all. Below, light
  /// is as old as ceil(1 / light_update_fraction) frames where it changes slowly, and 1/16 is the least
  /// (SmokeLightCache); such a frame depends on the frames before. Up to 1/4 the shadows of smoke on surfaces
  /// (SmokeShadowCache) and the advection of slow noise (NoiseUpdates) are spread over four frames.
  float light_update_fraction = 1;
  /// About which fraction of the indirect light that changed is found in this frame; in (0, 1]. As
  /// light_update_fraction, which limits it.
  float indirect_update_fraction = 1;
  bool rebuild_light = false;  ///< Light smoke and surfaces again even where nothing changed.
  /// Bytes of volumes with a preview that are uploaded in this frame; 0: all that is missing. Below their
  /// size such a frame depends on the frames before (VolumeStreaming).
  std::uint64_t volume_upload_bytes = 0;
};

/// A grid of a volume that glows.
struct HeatInput {
  const volume::SparseVolume* volume = nullptr;  ///< Like VolumeInput::volume; null: nothing glows.
  glm::mat4 world_from_voxel{1};
  float kelvin = 1000;  ///< Temperature where its value is 1.
  float high = 1;       ///< Its largest value, > 0.
  float emission = 1;   ///< Multiplies the radiance.
  /// As VolumeInput::preview.
  const volume::SparseVolume* preview = nullptr;
  glm::mat4 world_from_preview{1};
};

/// How the values of a volume become opacity and colour (scene/transfer.hpp).
struct TransferInput {
  std::vector<scene::OpacityPoint> opacity;  ///< Empty: the value is the density.
  scene::ColorMap color_map;                 ///< Empty: VolumeLook::albedo.
  glm::vec2 range{0, 1};                     ///< The values that both span; x < y.
  float glow = 0;      ///< Fraction of the colours that is emitted instead of scattered, [0, 1].
  float emission = 1;  ///< Radiance of an opaque part per colour that is emitted.
  bool empty() const { return opacity.empty() && color_map.empty() && glow <= 0; }
  bool operator==(const TransferInput&) const = default;
};

/// Noise that moves the places at which a volume is sampled, at a time.
struct DisturbanceInput {
  glm::mat4 voxel_from_file{1};  ///< The disturbance is in units of the file.
  scene::Disturbance noise = {};
  float time = 0;  ///< [s]
  bool empty() const { return noise.strength <= 0; }
};

/// Noise below a volume's voxels, at a time.
struct VolumeDetailInput {
  glm::mat4 voxel_from_file{1};  ///< The detail is in units of the file.
  scene::VolumeDetail noise = {};
  float densest = 1;  ///< The largest density: value, or opacity by a transfer function.
  float time = 0;     ///< [s]
  bool empty() const { return noise.strength <= 0; }
};

/// A volume in the world besides the smoke, lit by all lights of the frame and by itself.
struct VolumeInput {
  /// One channel of half floats: its density, >= 0. It lies within the volume's bounds and bricks.
  const volume::SparseVolume* volume = nullptr;
  glm::mat4 world_from_voxel{1};  ///< Affine, with an inverse.
  shared::VolumeLook look{};
  HeatInput heat{};
  /// The same at a lower resolution, to be shown until enough of the volume is on the device; of the same
  /// bounds in the world. Null: all of the volume is uploaded at once.
  const volume::SparseVolume* preview = nullptr;
  glm::mat4 world_from_preview{1};
  TransferInput transfer = {};
  /// One channel of four half floats: colours in [0, 1] that multiply the albedo, in the same bricks and
  /// slots as `volume`; with tints, as many masks, of which up to two take two half floats. null: none.
  const volume::SparseVolume* colors = nullptr;
  std::vector<glm::vec3> tints = {};  ///< Radiance per metre where a mask is 1; at most four.
  DisturbanceInput disturbance = {};
  VolumeDetailInput detail = {};
  std::size_t index = 0;  ///< Among the volumes of the timeline.
  /// The optical depth along a voxel's shortest edge, where it is as dense as it usually is
  /// (grids::BrickVolume::usual): above shared::kDenseVoxelDepth it is lit as what is opaque.
  float voxel_depth = 0;
};

/// Baked occlusion that darkens the surfaces in its box.
struct DecalInput {
  glm::mat4 world_from_box{1};  ///< From the box of its volume, affine with an inverse.
  std::size_t volume = 0;  ///< In FrameInput::slices: occlusion of what faces up, and of what faces down.
  float strength = 1;
  float gamma = 1, correction = 1, falloff = 1;  ///< As bake::OcclusionCurve.
  float fade = 0;                                ///< Part of the box, at each side, over which it fades out.
  float scatter = 0;                             ///< How far noise scatters the samples [voxels].
  glm::vec3 middle{0};                           ///< The middle of what hides, in the box.
  float radius = 0;  ///< About how far that reaches; 0: unknown, walls have the mean of both channels.
};

/// What one frame shows. What `smoke`, `volumes` and `level` point to must outlive the frame's recording.
struct FrameInput {
  View view;
  Environment environment;
  LevelState level;
  SmokeInput smoke;
  std::vector<VolumeInput> volumes;  ///< At most shared::kMaxVolumes; they may overlap.
  /// Volumes that are sampled without a march; uploaded when they are others than before. null: none.
  std::shared_ptr<const grids::DenseVolumes> slices;
  std::vector<DecalInput> decals;  ///< At most shared::kMaxDecals.
  /// At most shared::kMaxParticleSystems; they may overlap. Smoke and volumes before them do not dim them.
  std::vector<ParticleInput> particles;
  std::vector<TankInput> tanks;  ///< Over a host's surfaces or the renderer's own level.
  Quality quality;
  DebugRequest debug;

  /// Makes it a new one, whose lists keep their memory.
  void clear();
};

inline void FrameInput::clear() {
  FrameInput fresh;
  const auto keep = [](auto& list, auto& from) {
    from.clear();
    list = std::move(from);
  };
  keep(fresh.environment.flashes, environment.flashes);
  keep(fresh.environment.glow, environment.glow);
  keep(fresh.level.hidden_objects, level.hidden_objects);
  keep(fresh.level.grenades, level.grenades);
  keep(fresh.level.moved, level.moved);
  keep(fresh.volumes, volumes);
  keep(fresh.decals, decals);
  keep(fresh.particles, particles);
  keep(fresh.tanks, tanks);
  *this = std::move(fresh);
}

}  // namespace brume::planning
