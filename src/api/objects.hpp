// The objects behind the handles.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "api/call.hpp"
#include "sim/world.hpp"
#include "smoke/mask_atlas.hpp"
#include "voxel/level_hash.hpp"
#include "voxel/solids.hpp"
#include "voxel/surface_planes.hpp"
#include "wire/receiver.hpp"
#include "wire/sender.hpp"

namespace brume::api {

/// What levels share with their worlds and fields.
struct LevelData {
  LevelData(voxel::BitGrid voxels, voxel::SurfacePlanes surfaces, voxel::RoleGrids role_grids)
      : grid(std::move(voxels)),
        planes(std::move(surfaces)),
        roles(std::move(role_grids)),
        hash(voxel::level_hash(solids(), planes)) {}

  voxel::BitGrid grid;
  voxel::SurfacePlanes planes;
  voxel::RoleGrids roles;
  std::uint64_t hash;
  voxel::Solids solids() const { return {grid, roles}; }
};

glm::ivec3 to_ivec3(const brume_voxel& v);
/// Whether a point is finite and within 16384 m of the world's origin.
bool is_in_world(const brume_point& p);
/// The number of voxels of a box; throws a CallFailure unless it lies in the grid, has a voxel, and `count`
/// is right.
std::size_t checked_box(const voxel::GridLayout& layout, const brume_voxel& low, const brume_voxel& high,
                        std::size_t count);
/// The atlas of masks, or null.
std::shared_ptr<const smoke::MaskAtlas> atlas_of(Call& call, const brume_masks* masks);

}  // namespace brume::api

struct brume_context : brume::api::Handle {
  static constexpr auto kKind = brume::api::Kind::context;
  explicit brume_context(std::shared_ptr<brume::api::Settings> context_settings)
      : Handle(kKind, std::move(context_settings)) {}
};

struct brume_level : brume::api::Handle {
  static constexpr auto kKind = brume::api::Kind::level;
  brume_level(std::shared_ptr<brume::api::Settings> context_settings, brume::api::LevelData level)
      : Handle(kKind, std::move(context_settings)),
        data(std::make_shared<const brume::api::LevelData>(std::move(level))) {}

  std::shared_ptr<const brume::api::LevelData> data;
};

struct brume_masks : brume::api::Handle {
  static constexpr auto kKind = brume::api::Kind::masks;
  brume_masks(std::shared_ptr<brume::api::Settings> context_settings, brume::smoke::MaskAtlas masks)
      : Handle(kKind, std::move(context_settings)),
        atlas(std::make_shared<const brume::smoke::MaskAtlas>(std::move(masks))) {}

  std::shared_ptr<const brume::smoke::MaskAtlas> atlas;
};

struct brume_world : brume::api::Handle {
  static constexpr auto kKind = brume::api::Kind::world;
  brume_world(std::shared_ptr<brume::api::Settings> context_settings,
              std::shared_ptr<const brume::api::LevelData> level_data,
              const brume::sim::WorldSettings& world_settings)
      : Handle(kKind, std::move(context_settings)), level(std::move(level_data)) {
    world.emplace(level->solids(), world_settings);
  }

  std::shared_ptr<const brume::api::LevelData> level;
  std::optional<brume::sim::World> world;
};

struct brume_state : brume::api::Handle {
  static constexpr auto kKind = brume::api::Kind::state;
  brume_state(std::shared_ptr<brume::api::Settings> context_settings, brume::sim::State value)
      : Handle(kKind, std::move(context_settings)), state(std::move(value)) {}

  const brume::sim::State state;
  mutable std::vector<std::byte> saved;  // empty: not encoded yet
};

struct brume_sender : brume::api::Handle {
  static constexpr auto kKind = brume::api::Kind::sender;
  brume_sender(std::shared_ptr<brume::api::Settings> context_settings,
               const brume::wire::SenderSettings& sender_settings)
      : Handle(kKind, std::move(context_settings)), sender(sender_settings) {}

  brume::wire::Sender sender;
  std::optional<brume::sim::State> last;  // the state pushed
  std::vector<std::byte> packet;
  std::vector<std::byte> request, answer;  // the last of each since the push
};

struct brume_receiver : brume::api::Handle {
  static constexpr auto kKind = brume::api::Kind::receiver;
  brume_receiver(std::shared_ptr<brume::api::Settings> context_settings,
                 const brume::wire::ReceiverSettings& receiver_settings)
      : Handle(kKind, std::move(context_settings)), receiver(receiver_settings) {}

  brume::wire::Receiver receiver;
};
