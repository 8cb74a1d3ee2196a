// Which rays of light through the smoke a frame needs, and which of them are still as they were.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "planning/smoke_visibility.hpp"
#include "shared/frame.h"
#include "shared/hole.h"
#include "shared/light.h"
#include "shared/smoke_light.h"

namespace brume::planning {

/// Work for the device, in lists as shaders/shared/smoke_light.h reads them.
struct SmokeLightPlan {
  std::vector<shared::TexelList> rows;        ///< Bricks whose texels are to be listed.
  std::vector<shared::ShadowRays> pairs;      ///< Rays to be followed.
  std::vector<shared::LightGather> bricks;    ///< Whose light is to be put together.
  std::vector<shared::LightChange> changes;  ///< That rows refer to.
  std::vector<glm::uvec2> lights;             ///< Of those bricks: (light of the frame, block).
  /// What is done in one go. More than one only where the blocks of all would not fit.
  struct Part {
    volume::IndexRange rows, pairs, bricks;
    /// How many of these pairs and bricks, the last ones, ask for no more than `phases` phases.
    std::uint32_t few_pairs = 0, few_bricks = 0, phases = 0;
  };
  std::vector<Part> parts;
  std::uint32_t row_count = 0, page_count = 0;  ///< That there must be room for.
};

/// What the light of a frame follows from.
struct SmokeLightInputs {
  const smoke::SmokeVolume* volume = nullptr;  ///< null: no smoke.
  const SmokeVisibility* needs = nullptr;         ///< Not null where there is smoke.
  std::span<const shared::Light> lights;     ///< Of the frame.
  std::span<const shared::Hole> holes;
  float time = 0;  ///< Of holes and noise [s].
  shared::SmokeLook look{};
  shared::Sky sky{};
  glm::vec3 eye_world{0};
  bool anew = false;  ///< Something else changed, walls for instance: nothing is kept.
  /// Of what is not as it was, about how much is made anew in this frame; in (0, 1].
  float share = 1;
  bool noise_changed = false;  ///< The noise is not as it was, though the time may be.
};

/// Most blocks of rays at a time; of shared::kTexelsPerBrick words: 128 MB.
constexpr std::uint32_t kMaxRayPages = 1u << 15;

/// Remembers what the device holds. A ray is followed anew when its light, or anything that may lie on its
/// way, is not what it was; a brick's light is put together anew when a ray of its own was, or the eye, the
/// sky or a light of it changed. Where noise drifts every inputs changes all smoke, and all rays with it.
///
/// With a share below 1 that is spread over frames: the texels of all bricks are in kLightPhases phases
/// (shared::light_phase), and a frame makes anew those of some. 1 / share, rounded up, frames later all that
/// is in view was made anew once. Done at once nevertheless: texels that have no light yet, as smoke grew;
/// texels in holes that open or close; lights that come, go or change. Bricks that come into view are made
/// anew four times as fast as the others.
class SmokeLightCache {
 public:
  explicit SmokeLightCache(std::uint32_t max_pages = kMaxRayPages) : max_pages_(max_pages) {}

  /// The work of a frame. Its lists hold until the next call; what they ask for counts as done from then on.
  const SmokeLightPlan& plan(const SmokeLightInputs& inputs);
  /// The device lost what it held.
  void forget();

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  static constexpr std::uint32_t kPrioritySpeed = 4;  // times as fast
  static constexpr std::uint32_t kAllPhases = (1u << shared::kLightPhases) - 1;
  struct Kept {
    std::uint32_t light = kNone;  // its number here
    std::uint32_t block = kNone;
    std::uint64_t listing = 0;          // of the row, whose texels all have rays; 0: none has
    std::uint32_t stale = kAllPhases;  // phases whose rays no longer hold
    std::uint64_t planned = 0;          // the last frame that asked for it
    // Where the light reached when the rays were followed: beyond they say nothing.
    float range = 0, intensity = 0;
  };
  struct Row {
    std::uint32_t slot = 0, number = 0;
    glm::ivec3 brick{0};
    bool listed = false, by_phase = false;
    std::uint64_t listing = 0;          // of its texels, never the same twice; 0: none
    std::uint32_t stale = kAllPhases;  // phases that must be put together
    std::uint64_t gathered_lights = 0;       // hash of the lights that its light was put together from
    std::uint64_t epoch = 0;            // when it was, or became stale
    std::uint64_t planned = 0;          // the last frame that had it in view
    std::uint32_t priority = 0;            // frames in which it is made anew faster
    Kept sky;
    std::vector<Kept> lights;
  };
  struct KnownLight {
    shared::Light light{};
    std::uint64_t version = 0;       // of `light`, never the same twice
    std::uint64_t last_frame = 0;    // that had it
    std::uint32_t in_frame = kNone;  // its number there
  };

  bool must_invalidate(const SmokeLightInputs& inputs) const;
  bool inputs_differ(const SmokeLightInputs& inputs) const;
  void remember(const SmokeLightInputs& inputs);
  void drop_all_rays();
  void invalidate_rays();
  void add_hole_changes(const SmokeLightInputs& inputs, std::vector<shared::LightChange>& changes) const;
  void add_smoke_changes(const SmokeLightInputs& inputs, std::vector<shared::LightChange>& changes);
  bool invalidate_crossing(const SmokeLightInputs& inputs, std::span<const shared::LightChange> changes);
  void match_lights(std::span<const shared::Light> lights);
  KnownLight& match_light(const shared::Light& light, std::size_t hint, std::size_t most);
  void find_lights_in_reach(const SmokeLightInputs& inputs);
  std::span<const std::uint32_t> reaching(std::size_t seen_index) const;
  std::size_t pages_missing(const SmokeLightInputs& inputs) const;
  const Row* find_entry(std::uint32_t slot) const;
  Row& row_of(const SmokeLightInputs& inputs, std::uint32_t slot);
  void allocate_pages(Kept& kept, std::uint32_t count);
  Kept& cached_rays_of(Row& row, std::uint32_t light, std::size_t hint);
  /// Phases one after the other.
  struct Run {
    std::uint32_t first = 0, end = 0;
    std::uint32_t mask() const { return (1u << end) - (1u << first); }
    std::uint32_t texels() const { return shared::phase_range(first, end); }
  };
  /// What of a brick is done in a frame.
  struct Task {
    bool all = false, fresh = false, run = false;
  };
  bool shares() const { return phases_ < shared::kLightPhases; }
  std::uint32_t priority_phases() const { return std::min(kPrioritySpeed * phases_, shared::kLightPhases); }
  void choose_slice(float share);
  Run phase_range_of(const Row& row) const;
  volume::IndexRange changes_in(const Row& row);
  bool update_texel_list(Row& row);
  Task work_for(const Row& row, const Kept& kept, std::uint64_t before, Run run) const;
  template <typename Item>
  void ask(const Task& task, Run run, Item item, std::vector<Item>& list, std::vector<Item>& few);
  void follow(const Row& row, Kept& kept, std::uint32_t light, std::uint32_t blocks, const Task& task,
              Run run);
  void schedule_gather(Row& row, std::span<const std::uint32_t> lights, std::uint32_t first_light, Task put,
                    Run run);
  void plan_brick(Row& row, std::span<const std::uint32_t> lights);
  void plan_incremental(const SmokeLightInputs& inputs);
  void plan_in_parts(const SmokeLightInputs& inputs);
  std::uint64_t light_versions_hash(std::span<const std::uint32_t> lights) const;

  std::uint32_t max_pages_;
  SmokeLightPlan plan_;
  std::vector<Row> rows_;  // the first row_count_ are in use
  std::uint32_t row_count_ = 0;
  std::vector<std::uint32_t> row_of_slot_;
  std::vector<glm::ivec3> brick_of_slot_;  // of all slots, as of the last frame
  std::vector<KnownLight> known_lights_;
  std::uint32_t page_end_ = 0;
  // Of the frame: how many phases are made anew and where they begin; lists of what takes no more than some.
  std::uint32_t phases_ = shared::kLightPhases, first_phase_ = 0, most_phases_ = 0;
  std::vector<shared::LightChange> hole_changes_;  // where holes changed
  std::vector<shared::ShadowRays> few_pairs_;
  std::vector<shared::LightGather> few_bricks_;
  // The lights that reach each slot in view: their list, and where each slot's begin.
  std::vector<std::uint32_t> lights_in_reach_, lights_in_reach_first_;
  std::uint64_t versions_ = 0, frames_ = 0, epoch_ = 0;  // epoch: of eye and sky
  std::uint64_t listings_ = 0, turns_ = 0;               // turns: frames that made a share anew
  std::optional<SmokeLightInputs> last_;                 // its pointers are not followed
  std::vector<shared::Hole> holes_;                      // its
  std::uint64_t revision_ = 0, generation_ = 0;
  shared::VolumeLayout layout_{};
  smoke::SmokeBounds bounds_;
};

/// Whether a hole takes the same away everywhere at two moments.
bool same_opening(const shared::Hole& hole, float time_a, float time_b);

}  // namespace brume::planning
