#include "wire/world_archive.hpp"

#include <bit>

#include "sim/walk.hpp"
#include "voxel/voxelize.hpp"

namespace brume::wire {
namespace {

constexpr std::uint32_t kMaxTicksPerSecond = 1000;

}  // namespace

WorldArchive archive_of(const sim::State& state) {
  return {state.layout, state.ticks_per_second, state.masks, state.level_hash};
}

sim::State first_state(const WorldArchive& world) {
  sim::State state;
  state.layout = world.layout;
  state.ticks_per_second = world.ticks_per_second;
  state.masks = world.masks;
  state.level_hash = world.level_hash;
  return state;
}

void write_world(ByteWriter& out, const WorldArchive& world) {
  for (int axis = 0; axis < 3; ++axis) out.varint(static_cast<std::uint64_t>(world.layout.size[axis]));
  out.number(std::bit_cast<std::uint32_t>(world.layout.voxel_size));
  for (int axis = 0; axis < 3; ++axis)
    out.number(std::bit_cast<std::uint32_t>(world.layout.origin_world[axis]));
  out.varint(world.ticks_per_second);
  out.varint(world.masks.count);
  if (world.masks.count > 0) out.number(world.masks.hash);
  out.number(world.level_hash);
}

Result<WorldArchive> read_world(ByteReader& in) {
  WorldArchive world;
  for (int axis = 0; axis < 3; ++axis) world.layout.size[axis] = static_cast<int>(in.varint(voxel::kMaxAxis));
  world.layout.voxel_size = std::bit_cast<float>(in.number<std::uint32_t>());
  for (int axis = 0; axis < 3; ++axis)
    world.layout.origin_world[axis] = std::bit_cast<float>(in.number<std::uint32_t>());
  world.ticks_per_second = static_cast<std::uint32_t>(in.varint(kMaxTicksPerSecond));
  world.masks.count = static_cast<std::uint32_t>(in.varint(sim::kMaxMasks));
  if (world.masks.count > 0) world.masks.hash = in.number<std::uint64_t>();
  world.level_hash = in.number<std::uint64_t>();
  if (!in.ok() || world.ticks_per_second == 0)
    return Failure{
        ErrorCode::bad_input,
        "expected a grid of up to 4096 voxels per axis, 1 to 1000 ticks per second and at most 65536 masks"};
  if (auto checked = voxel::check_frame(world.layout); !checked)
    return Failure{ErrorCode::bad_input, checked.failure().message};
  try {
    static_cast<void>(sim::VoxelRuler(world.layout));
  } catch (const Error& error) {
    return error.failure();
  }
  return world;
}

}  // namespace brume::wire
