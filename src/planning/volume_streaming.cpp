#include "planning/volume_streaming.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

#include "core/box.hpp"

namespace brume::planning {

using volume::SparseVolume;

/// A sparse volume that is streamed.
struct VolumeStreaming::Item {
  std::size_t owner = 0;  ///< The volume of the frame.
  const SparseVolume* volume = nullptr;
  glm::mat4 world_from_voxel{1};
  bool has_preview = false;
  BrickUpload* upload = nullptr;
  State* state = nullptr;
  bool visible_missing = false;  ///< After this frame.

  std::uint64_t brick_bytes() const {
    std::uint64_t bytes = 0;
    for (std::uint32_t i = 0; i < volume->channel_count(); ++i)
      bytes += std::uint64_t{volume->format(volume::ChannelId{i}).bytes_per_texel} * shared::kTexelsPerBrick;
    return bytes;
  }
  std::uint64_t page_bytes() const {
    return volume->pages().root().size_bytes() + volume->pages().nodes().size_bytes();
  }
  /// Around a cube of voxels.
  WorldSphere sphere(glm::ivec3 first_voxel, int edge) const {
    const glm::vec3 low(first_voxel);
    const glm::mat3 axes(world_from_voxel);
    const float half = 0.5f * static_cast<float>(edge);
    // The longest of the four diagonals, each from a corner to the opposite one.
    float radius = 0;
    for (const glm::vec3 corner :
         {glm::vec3(1), glm::vec3(-1, 1, 1), glm::vec3(1, -1, 1), glm::vec3(1, 1, -1)})
      radius = std::max(radius, glm::length(axes * (half * corner)));
    return {glm::vec3(world_from_voxel * glm::vec4(low + half, 1)), radius};
  }
};

/// A node with bricks that are missing.
struct VolumeStreaming::Candidate {
  std::size_t item = 0, node = 0;
  bool visible = false;
  float distance = 0;  ///< From the eye to its sphere [m].
};

namespace {

float distance_to(const WorldSphere& sphere, glm::vec3 eye_world) {
  return std::max(glm::length(sphere.centre - eye_world) - sphere.radius, 0.0f);
}

constexpr int kNodeVoxels = shared::kNodeBricks * shared::kBrickVoxels;

}  // namespace

/// The uploads of one frame.
class VolumeStreaming::Frame {
 public:
  /// Without a frustum all is in view.
  Frame(std::span<Item> items, const ViewFrustum* frustum, glm::vec3 eye_world, std::uint64_t budget_bytes)
      : items_(items),
        frustum_(frustum),
        eye_world_(eye_world),
        remaining_(budget_bytes > 0 ? budget_bytes : std::numeric_limits<std::uint64_t>::max()) {}

  void plan() {
    for (Item& item : items_) upload_pages(item);
    std::vector<Candidate> candidates = find_candidates();
    for (const Candidate& candidate : candidates)
      if (candidate.visible) upload_node(candidate, true);
    for (const Candidate& candidate : candidates) upload_node(candidate, false);
    for (Item& item : items_) std::sort(item.upload->slots.begin(), item.upload->slots.end());
  }

 private:
  struct Brick {
    float distance = 0;
    std::uint32_t slot = 0;
    bool operator<(const Brick& other) const {
      return std::tie(distance, slot) < std::tie(other.distance, other.slot);
    }
  };

  bool may_be_visible(const WorldSphere& sphere) const {
    return !frustum_ || frustum_->may_intersect(sphere);
  }

  void upload_pages(Item& item) {
    if (item.state->pages) return;
    const std::uint64_t bytes = item.page_bytes();
    if (bytes > remaining_ && any_) return;
    item.state->pages = item.upload->pages = any_ = true;
    remaining_ -= std::min(bytes, remaining_);
  }

  std::vector<Candidate> find_candidates() {
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < items_.size(); ++i)
      for (std::size_t n = 0; n < items_[i].state->nodes.size(); ++n) {
        const Node& node = items_[i].state->nodes[n];
        if (node.missing == 0) continue;
        const WorldSphere sphere = items_[i].sphere(node.at * kNodeVoxels, kNodeVoxels);
        candidates.push_back({i, n, may_be_visible(sphere), distance_to(sphere, eye_world_)});
      }
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
      return std::tuple(!a.visible, a.distance, a.item, a.node) <
             std::tuple(!b.visible, b.distance, b.item, b.node);
    });
    return candidates;
  }

  /// Uploads missing bricks of a node, those in view alone or all, as long as the budget lasts.
  void upload_node(const Candidate& candidate, bool visible_only) {
    Item& item = items_[candidate.item];
    Node& node = item.state->nodes[candidate.node];
    if (node.missing == 0) return;
    if (!item.state->pages || remaining_ < item.brick_bytes()) {
      if (visible_only && !item.visible_missing)
        item.visible_missing = node.missing == node.bricks || !missing_bricks(item, node, true).empty();
      return;
    }
    for (const Brick& brick : missing_bricks(item, node, visible_only)) {
      if (remaining_ < item.brick_bytes()) {
        item.visible_missing |= visible_only;
        return;
      }
      remaining_ -= item.brick_bytes();
      any_ = true;
      item.state->resident[brick.slot] = true;
      --node.missing;
      --item.state->missing;
      item.upload->slots.push_back(brick.slot);
    }
  }

  std::vector<Brick> missing_bricks(const Item& item, const Node& node, bool visible_only) const {
    std::vector<Brick> bricks;
    const auto entries = item.volume->pages().nodes().subspan(std::size_t{node.number} * shared::kPageEntries,
                                                              shared::kPageEntries);
    for (const std::uint32_t entry : entries) {
      if (!volume::PageTable::is_slot(entry) || item.state->resident[entry - 1]) continue;
      const glm::ivec3 first = item.volume->brick_of(entry - 1) * shared::kBrickVoxels;
      const WorldSphere sphere = item.sphere(first, shared::kBrickVoxels);
      if (!visible_only || may_be_visible(sphere))
        bricks.push_back({distance_to(sphere, eye_world_), entry - 1});
    }
    std::sort(bricks.begin(), bricks.end());
    return bricks;
  }

  std::span<Item> items_;
  const ViewFrustum* frustum_;
  glm::vec3 eye_world_;
  std::uint64_t remaining_;  ///< Rest of the budget [bytes].
  bool any_ = false;         ///< Something is uploaded.
};

VolumeStreaming::State VolumeStreaming::make_state(const SparseVolume& volume) {
  State state;
  state.id = volume.id();
  state.resident.resize(volume.slot_count());
  const volume::PageTable& pages = volume.pages();
  const glm::ivec3 size = pages.size();
  std::size_t root = 0;
  for_each_in(Box<int>{glm::ivec3(0), size}, [&](glm::ivec3 at) {
    const std::uint32_t entry = pages.root()[root++];
    if (entry < shared::kFirstNode) return;
    const std::uint32_t node = entry - shared::kFirstNode;
    const auto entries =
        pages.nodes().subspan(std::size_t{node} * shared::kPageEntries, shared::kPageEntries);
    const auto bricks =
        static_cast<std::uint32_t>(std::ranges::count_if(entries, volume::PageTable::is_slot));
    state.nodes.push_back({pages.origin() + at, node, bricks, bricks});
    state.missing += bricks;
  });
  return state;
}

/// The state of a volume in a proposal, to be changed by it.
VolumeStreaming::State& VolumeStreaming::state_of(States& states, const SparseVolume& volume) {
  const auto found =
      std::ranges::find_if(states, [&](const auto& state) { return state->id == volume.id(); });
  if (found == states.end()) return *states.emplace_back(std::make_shared<State>(make_state(volume)));
  // A volume that is shown several times has one state; the previous frame's stays as it is.
  if (!(*found)->is_complete() && found->use_count() > 1) *found = std::make_shared<State>(**found);
  return **found;
}

bool VolumeStreaming::is_streamed(const SparseVolume* volume, const SparseVolume* preview) {
  return volume && (preview || volume->slot_count() > kSmallVolumeBricks);
}

/// What is streamed of the volumes; the states of others are dropped.
std::vector<VolumeStreaming::Item> VolumeStreaming::items_of(std::span<const VolumeInput> volumes,
                                                             std::vector<VolumeResidency>& result) {
  std::vector<Item> items;
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    const VolumeInput& in = volumes[i];
    if (is_streamed(in.volume, in.preview))
      items.push_back({i, in.volume, in.world_from_voxel, in.preview != nullptr, &result[i].volume});
    if (is_streamed(in.heat.volume, in.heat.preview))
      items.push_back(
          {i, in.heat.volume, in.heat.world_from_voxel, in.heat.preview != nullptr, &result[i].heat});
  }
  States& states = states_.propose();
  std::erase_if(states, [&](const auto& state) {
    return std::ranges::none_of(items, [&](const Item& item) { return item.volume->id() == state->id; });
  });
  for (Item& item : items) {
    item.state = &state_of(states, *item.volume);
    // One that is shown several times is uploaded once, with the first.
    item.upload = std::ranges::find(items, item.state, &Item::state)->upload;
    item.upload->streamed = true;
  }
  return items;
}

std::vector<VolumeResidency> VolumeStreaming::plan(std::span<const VolumeInput> volumes,
                                                   const ViewFrustum& frustum, glm::vec3 eye_world,
                                                   std::uint64_t budget_bytes) {
  std::vector<VolumeResidency> result(volumes.size());
  std::vector<Item> items = items_of(volumes, result);
  // What must be there comes whatever the budget.
  const auto end_of_whole =
      std::stable_partition(items.begin(), items.end(), [&](const Item& item) { return !item.has_preview; });
  const auto whole = static_cast<std::size_t>(end_of_whole - items.begin());
  Frame(std::span(items).first(whole), &frustum, eye_world, 0).plan();
  Frame(std::span(items).subspan(whole), &frustum, eye_world, budget_bytes).plan();
  for (const Item& item : items) {
    result[item.owner].shows_preview |= item.visible_missing || !item.state->pages;
    result[item.owner].lit_by_preview |= !item.state->is_complete();
  }
  return result;
}

std::vector<VolumeResidency> VolumeStreaming::plan_part(std::span<const VolumeInput> volumes,
                                                        std::uint64_t budget_bytes,
                                                        std::uint64_t part_bytes) {
  std::vector<VolumeResidency> result(volumes.size());
  std::vector<Item> items = items_of(volumes, result);
  if (budget_bytes > 0) std::erase_if(items, [](const Item& item) { return item.has_preview; });
  Frame(items, nullptr, glm::vec3(0), part_bytes).plan();
  return result;
}

bool VolumeStreaming::is_ready(std::span<const VolumeInput> volumes, std::uint64_t budget_bytes) const {
  const auto is_there = [&](const SparseVolume* volume, const SparseVolume* preview) {
    if (!is_streamed(volume, preview) || (preview && budget_bytes > 0)) return true;
    const auto is_it = [&](const auto& state) { return state->id == volume->id(); };
    const auto found = std::ranges::find_if(states_.now(), is_it);
    return found != states_.now().end() && (*found)->is_complete();
  };
  return std::ranges::all_of(volumes, [&](const VolumeInput& volume) {
    return is_there(volume.volume, volume.preview) && is_there(volume.heat.volume, volume.heat.preview);
  });
}

void VolumeStreaming::lose(std::uint64_t volume_id) {
  std::erase_if(states_.reset(), [&](const auto& state) { return state->id == volume_id; });
}

bool VolumeStreaming::complete() const {
  return std::ranges::all_of(states_.latest(), [](const auto& state) { return state->is_complete(); });
}

}  // namespace brume::planning
