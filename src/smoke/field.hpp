// The smoke of a level at one tick: the level with its edits, its surfaces, the volume of densities, and
// lines of sight through it. Scenarios, the C interface and Python all read their smoke from here.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "sim/edited_level.hpp"
#include "smoke/noise_look.hpp"
#include "smoke/sight.hpp"
#include "smoke/smoke_input.hpp"
#include "smoke/smoke_volume.hpp"
#include "voxel/patched_planes.hpp"

namespace brume::smoke {

/// How pictures show smoke.
struct DrawnLook {
  shared::SmokeLook smoke{};
  double swirl_period = SmokeInput().swirl_period;  ///< [s]
};
/// With this noise, and what it leaves open as SmokeInput has it.
DrawnLook drawn_look(const NoiseLook& noise);

/// What lines of sight pass.
struct SightLook {
  float extinction = SightSettings().extinction;  ///< Where density is 1 [1/m], [0, 10^6].
  glm::vec3 smoke_albedo = SightSettings().smoke_albedo;
  std::optional<DrawnLook> drawn =
      {};  ///< The smoke as it is drawn, eroded by noise; none: without its noise.
  bool operator==(const SightLook& other) const;
};

/// Follows the states of a world in any order. What it holds is a function of the level as loaded, the last
/// state and the patches alone: the same as in a new field after one update, whatever came before.
///
/// Surfaces are, in each cell: the planes of the last patch that contains it; else none where a corner of the
/// cell stops smoke and did not when the level was loaded, or the reverse, so that smoke ends at the faces of
/// edited voxels; else the surfaces of the level as loaded.
///
/// Any number of threads may call the const functions. What they return is valid until the next update.
class Field {
 public:
  /// Without smoke. `planes` are the surfaces of what stops smoke in `level`. The grids of `level`, `planes`
  /// and `masks` (null: none) must outlive it; grids and planes stay as they are.
  Field(const voxel::Solids& level, const voxel::SurfacePlanes& planes, const MaskAtlas* masks = nullptr);
  Field(const Field&) = delete;
  Field& operator=(const Field&) = delete;

  /// Takes over a state of the level's layout, with the masks of the field. It keeps a copy, and the level
  /// with the state's edits. Throws as SmokeVolume::update; the field is then of no further use.
  void update(const sim::State& state);
  /// The same with the state and the grids of a world of the level, which are not copied: the world must stay
  /// as it is while the field is read.
  void update(const sim::World& world);
  /// The surfaces of edits whose geometry is known, the oldest first; none is null. An update has to follow,
  /// which rebuilds the cells of patches that came or went.
  void set_patches(std::vector<std::shared_ptr<const voxel::PlanePatch>> patches);
  /// To be called where the world or the masks change before the next update: holes and sights that are kept
  /// are made again on their next use.
  void forget_sights();

  const sim::State& state() const { return *state_; }
  /// The level with the state's edits.
  const voxel::Solids& solids() const { return *now_; }
  const voxel::GridLayout& layout() const { return loaded_.smoke.layout(); }
  /// The surfaces.
  const PlaneSource& planes() const { return planes_; }
  const SmokeVolume& volume() const { return volume_; }
  sim::MaskKey masks() const { return masks_ ? masks_->key() : sim::MaskKey{}; }
  /// The state's holes at its time. Throws as make_holes.
  std::span<const shared::Hole> holes() const;
  /// Lines of sight at the state's time; the last sight with noise and the last without are kept. Throws as
  /// Sight and make_holes.
  std::shared_ptr<const Sight> sight(const SightLook& look) const;

 private:
  struct KeptSight {
    SightLook look;
    std::shared_ptr<const Sight> sight;  // null: none yet
  };

  std::span<const voxel::Plane> planes_at(glm::ivec3 cell) const;
  void follow(const sim::State& state, const voxel::Solids& now);
  void patch_changed(const voxel::PlanePatch& patch);
  std::span<const shared::Hole> find_holes() const;
  std::shared_ptr<const Sight> make_sight(const SightLook& look) const;

  const voxel::Solids loaded_;
  const voxel::SurfacePlanes& loaded_planes_;
  const MaskAtlas* masks_;
  sim::EditedLevel edited_;  // level of the last state that was copied
  sim::State copied_;        // a copy of that state
  const sim::State* state_;  // the last one
  std::optional<voxel::Solids> now_;
  std::vector<std::shared_ptr<const voxel::PlanePatch>> patches_;  // all, the oldest first
  voxel::PatchedPlanes patched_;                                   // with those that are not covered
  const PlaneSource planes_;
  SmokeVolume volume_;
  // Made on their first use.
  mutable std::mutex mutex_;
  mutable std::optional<std::vector<shared::Hole>> holes_;
  mutable std::array<KeptSight, 2> sights_;  // without noise, with noise
};

}  // namespace brume::smoke
