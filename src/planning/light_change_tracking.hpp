// What changed between two frames that light in the smoke depends on.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "planning/smoke_visibility.hpp"
#include "shared/frame.h"
#include "shared/hole.h"
#include "shared/smoke_light.h"

namespace brume::planning {

/// What the device holds of the light in the smoke: a plan that needs more makes it lose all of that.
struct SmokeLightRoom {
  std::uint32_t texel_lists = ~0u, pages = ~0u;
};

/// What the light in the smoke of a frame follows from.
struct SmokeLightInputs {
  const smoke::SmokeBricks* volume = nullptr;  ///< Null: no smoke.
  /// All smoke, of which `volume` holds a part; its changes count wherever they are. Null: `volume`.
  const smoke::SmokeBricks* all_smoke = nullptr;
  const SmokeVisibility* visibility = nullptr;  ///< Not null where there is smoke.
  std::span<const shared::Light> lights;        ///< FramePlan::lights.
  std::span<const shared::Hole> holes;
  float time = 0;  ///< Time of holes and noise [s].
  shared::SmokeLook look{};
  shared::Sky sky{};
  glm::vec4 viewpoint{0};  ///< planning::viewpoint of the camera.
  bool rebuild = false;    ///< Something else changed, walls for instance: no cached ray holds.
  /// About the fraction of what changed that this frame updates, (0, 1].
  float update_fraction = 1;
  bool noise_changed = false;          ///< The noise changed, though the time may not have.
  std::uint64_t indirect_version = 0;  ///< IndirectLightPlan::version.
  SmokeLightRoom room{};
};

/// Whether a hole removes the same everywhere at two times [s].
bool same_opening(const shared::Hole& hole, float time_a, float time_b);

/// Compares a frame's inputs with the frame before.
class LightChangeTracker {
 public:
  /// Whether the volumes are the same as in the frame before, one revision later at most: older changes are
  /// not known.
  bool is_continuous(const SmokeLightInputs& inputs) const;
  /// Whether no cached ray holds, wherever it runs. Like all below, only where there is a frame before.
  bool all_rays_changed(const SmokeLightInputs& inputs) const;
  /// Whether densities or walls of the bricks at hand changed.
  bool smoke_changed(const SmokeLightInputs& inputs) const;
  /// Whether the noise moved, and all smoke with it.
  bool noise_moved(const SmokeLightInputs& inputs) const;
  /// Whether rays end elsewhere: where the box around the smoke does.
  bool caster_bounds_changed(const SmokeLightInputs& inputs) const;
  /// Whether light scatters to another eye, or comes from another sky or other surroundings; true where there
  /// is no frame before.
  bool gather_inputs_changed(const SmokeLightInputs& inputs) const;

  /// Adds where holes opened, closed, came or went.
  void add_hole_changes(const SmokeLightInputs& inputs, FrameVector<shared::LightChange>& changes) const;
  /// Adds where densities or walls changed.
  void add_smoke_changes(const SmokeLightInputs& inputs, FrameVector<shared::LightChange>& changes) const;

  /// From now on the frame is the frame before.
  void store_inputs(const SmokeLightInputs& inputs);
  /// There is no frame before.
  void reset() { last_.reset(); }
  /// The layout of the last stored frame's volume.
  const shared::VolumeLayout& layout() const { return layout_; }

 private:
  struct Last {
    std::uint64_t volume = 0, all_smoke = 0;  // ids
    std::uint64_t revision = 0, all_revision = 0;
    float time = 0;
    shared::SmokeLook look{};
    shared::Sky sky{};
    glm::vec4 viewpoint{0};
    Box<float> caster_bounds;
    std::uint64_t indirect_version = 0;
  };
  std::optional<Last> last_;
  shared::VolumeLayout layout_{}, all_layout_{};
  std::vector<shared::Hole> holes_;
  std::vector<glm::ivec3> brick_of_slot_;  // by slot of all smoke
  std::uint64_t generation_ = 0;
};

}  // namespace brume::planning
