// How the light in the volumes of a frame is found (shaders/shared/volume_light.h), and whether the light
// of the frame before still holds.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "planning/hole_plan.hpp"
#include "planning/input_key.hpp"
#include "planning/media_plan.hpp"
#include "planning/noise_plan.hpp"
#include "planning/proposed.hpp"
#include "shared/light.h"
#include "shared/volume_light.h"

namespace brume::planning {

struct VolumeLightPlan {
  std::uint32_t sun = shared::kNoSun;       ///< MediaPlan::sun.
  std::uint32_t edge = 1;                   ///< Cells of a volume's cube of light along an axis.
  std::uint32_t sun_edge = 1;               ///< The same of its cube of the sun's depths.
  FrameVector<shared::VolumeSweep> sweeps;  ///< kSweepsOfVolume per volume in view.
  bool is_lit = true;                       ///< A volume in view scatters or emits by its extinction.
  bool is_alone = true;                     ///< Nothing else casts shadows into the volume.
  bool update = false;                      ///< False: the light of the frame before holds.
  bool casters_changed = false;             ///< Other media cast shadows than before (add_casters).
};

/// The cubes of light that the device holds: where a plan needs others, their light is lost.
struct VolumeLightRoom {
  std::uint32_t edge = 1, sun_edge = 1;  ///< Cells of a cube along an axis, as VolumeLightPlan.
  std::uint32_t volumes = 1;             ///< Cubes of each kind.
  std::uint32_t glowing_volumes = 0;     ///< The same of the fields of glow.
};

/// What the light in the volumes follows from.
struct VolumeLightInputs {
  const MediaPlan* media = nullptr;       ///< Not null.
  std::span<const VolumeInput> volumes;   ///< FrameInput::volumes.
  std::span<const shared::Light> lights;  ///< FramePlan::lights.
  const smoke::SmokeBricks* smoke = nullptr;
  shared::SmokeLook smoke_look{};
  float time = 0;                    ///< Time of the smoke's noise and holes [s].
  const NoisePlan* noise = nullptr;  ///< What moves the smoke's noise; null: nothing.
  const HolePlan* holes = nullptr;   ///< In the smoke; null: none.
  shared::Sky sky{};
  bool rebuild = false;  ///< The level changed, or light is to be found again for another reason.
  std::uint64_t indirect_version = 0;  ///< IndirectLightPlan::version.
  VolumeLightRoom room{};
};

/// Tracks what the device's light was computed from.
class VolumeLightCache {
 public:
  /// The plan of a frame. From `commit` on it counts as done.
  VolumeLightPlan plan(const VolumeLightInputs& inputs, Allocator memory = {});
  /// The frame of the last plan was recorded.
  void commit() { state_.commit(); }
  /// The device lost its light.
  void invalidate() { state_.reset().others.clear(); }

 private:
  struct State {
    InputKey casters;  ///< add_casters of the last plan.
    InputKey others;   ///< All other inputs of the last update; empty: there was none.
  };
  Proposed<State> state_;
};

/// The rays along `direction` (unit) through a volume's bounds.
shared::VolumeSweep sweep_through(const shared::VolumeInstance& volume, glm::vec3 direction);

}  // namespace brume::planning
