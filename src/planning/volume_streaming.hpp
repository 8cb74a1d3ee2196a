// Which bricks of large volumes are uploaded in a frame, and at which resolution each volume is shown: a
// preview as long as a brick in view is not on the device, and lit by its preview as long as any brick is
// not.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "planning/frame_input.hpp"
#include "planning/proposed.hpp"
#include "planning/view_frustum.hpp"

namespace brume::planning {

/// What of one sparse volume is uploaded in a frame.
struct BrickUpload {
  bool streamed = false;  ///< False: all that changed, at once.
  bool pages = false;     ///< Its page table, before any of its texels.
  std::vector<std::uint32_t> slots;
};

/// What is uploaded and shown of a volume and of its heat.
struct VolumeResidency {
  BrickUpload volume, heat;
  bool shows_preview = false, lit_by_preview = false;
};

/// Volumes of at most this many bricks, without a preview, are uploaded at once.
inline constexpr std::uint32_t kSmallVolumeBricks = 4096;

/// What is on the device of large volumes and of those that have a preview.
class VolumeStreaming {
 public:
  /// Per volume of the frame. Uploads at most `budget_bytes` of bricks and page tables (0: no limit), but for
  /// a page table that is larger than that, which comes alone; volumes without a preview, and previews, come
  /// on top, at once. Bricks in the frustum come first, those in nodes of 8^3 bricks that are nearest to the
  /// eye before others, then the rest in the same order. From `commit` on it counts as done.
  std::vector<VolumeResidency> plan(std::span<const VolumeInput> volumes, const ViewFrustum& frustum,
                                    glm::vec3 eye_world, std::uint64_t budget_bytes);
  /// The next part of what the frame of these inputs must find on the device: volumes without a preview, and
  /// with budget_bytes = 0 all. To be uploaded before that frame, at most `part_bytes` as above, until
  /// is_ready(): parts take less staging memory than all at once. From `commit` on it counts as done.
  std::vector<VolumeResidency> plan_part(std::span<const VolumeInput> volumes, std::uint64_t budget_bytes,
                                         std::uint64_t part_bytes);
  /// Whether the frame of these inputs finds all that it must.
  bool is_ready(std::span<const VolumeInput> volumes, std::uint64_t budget_bytes) const;
  /// The frame or the part of the last plan was recorded.
  void commit() { states_.commit(); }
  /// Nothing of a volume is on the device any more.
  void lose(std::uint64_t volume_id);
  /// Whether all of the last plan's volumes are on the device when its frame is drawn.
  bool complete() const;

 private:
  /// 8^3 bricks.
  struct Node {
    glm::ivec3 at{0};
    std::uint32_t number = 0;   ///< In the page table.
    std::uint32_t bricks = 0;   ///< Bricks of the volume in it.
    std::uint32_t missing = 0;  ///< Bricks that are not on the device.
  };
  struct State {
    std::uint64_t id = 0;
    bool pages = false;
    std::vector<bool> resident;  ///< By slot.
    std::vector<Node> nodes;     ///< Rising.
    std::uint32_t missing = 0;   ///< Bricks of all nodes that are not on the device.
    bool is_complete() const { return pages && missing == 0; }
  };
  /// A complete state does not change, and proposals share it.
  using States = std::vector<std::shared_ptr<State>>;
  struct Item;
  struct Candidate;
  class Frame;

  static State make_state(const volume::SparseVolume& volume);
  static State& state_of(States& states, const volume::SparseVolume& volume);
  std::vector<Item> items_of(std::span<const VolumeInput> volumes, std::vector<VolumeResidency>& result);
  static bool is_streamed(const volume::SparseVolume* volume, const volume::SparseVolume* preview);

  Proposed<States> states_;
};

}  // namespace brume::planning
