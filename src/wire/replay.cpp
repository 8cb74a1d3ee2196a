#include "wire/replay.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <string>

#include "core/file.hpp"
#include "core/hash.hpp"
#include "wire/block_coding.hpp"
#include "wire/bytes.hpp"
#include "wire/event_log.hpp"
#include "wire/packet.hpp"
#include "wire/world_archive.hpp"

namespace brume::wire {
namespace {

using glm::ivec3;

constexpr std::array kMagic{std::byte{'B'}, std::byte{'R'}, std::byte{'U'}, std::byte{'M'},
                            std::byte{'E'}, std::byte{'R'}, std::byte{'P'}, std::byte{'L'}};
constexpr std::size_t kHashBytes = 8;

Failure damaged(const std::string& what) {
  return {ErrorCode::bad_input, what + "; record it again"};
}

// The solid voxels of a level as sorted blocks.
std::vector<sim::VoxelBlock> blocks_of(const voxel::BitGrid& level) {
  std::vector<sim::VoxelBlock> blocks;
  level.for_each_brick([&](ivec3 at, const voxel::BitGrid::Brick& brick) {
    for (int i = 0; i < 8; ++i) {
      const ivec3 corner(i & 1, i >> 1 & 1, i >> 2);
      std::uint64_t mask = 0;
      for (int z = 0; z < 4; ++z)
        for (int y = 0; y < 4; ++y) {
          const std::uint64_t slice = brick[static_cast<unsigned>(4 * corner.z + z)];
          mask |= (slice >> (4 * corner.x + 8 * (4 * corner.y + y)) & 0xf) << (4 * y + 16 * z);
        }
      if (mask != 0) blocks.push_back({glm::i16vec3(2 * at + corner), mask, 0});
    }
  });
  std::sort(blocks.begin(), blocks.end(),
            [](const auto& a, const auto& b) { return sim::block_before(a.at, b.at); });
  return blocks;
}

Result<std::vector<std::byte>> encode_level(const voxel::BitGrid& level) {
  std::vector<sim::VoxelBlock> blocks = blocks_of(level);
  std::uint64_t voxels = 0;
  for (const sim::VoxelBlock& block : blocks) voxels += cost_of(block);
  if (voxels > kMaxLevelVoxels)
    return Failure{ErrorCode::resource_limit, "replay: the level has more than " +
                                                  std::to_string(kMaxLevelVoxels) +
                                                  " solid voxels; use a coarser grid"};
  Encoder coder;
  const auto models = std::make_unique<BlockModels>();
  code_blocks(coder, *models, {level.size(), false, kMaxLevelVoxels}, ivec3(0), {}, blocks);
  return coder.finish();
}

Result<voxel::BitGrid> decode_level(std::span<const std::byte> bytes, const voxel::GridLayout& layout) {
  Decoder coder(bytes);
  const auto models = std::make_unique<BlockModels>();
  std::vector<sim::VoxelBlock> blocks;
  code_blocks(coder, *models, {layout.size, false, kMaxLevelVoxels}, ivec3(0), {}, blocks);
  if (!coder.at_end()) return damaged("a replay with an invalid level");
  voxel::BitGrid level(layout);
  for (const sim::VoxelBlock& block : blocks) {
    const sim::EditBlock edit{block.at, block.mask, 0};
    sim::apply_edits(level, {&edit, 1});
  }
  return level;
}

/// The voxels of glass and of grilles, where a level has any.
Result<void> decode_roles(ByteReader& in, Replay& replay) {
  const auto glass_bytes = in.section(), grille_bytes = in.section();
  if (!in.ok() || in.remaining().size() != kHashBytes)
    return damaged("a replay whose length does not match its number of ticks");
  const auto glass = decode_level(glass_bytes, replay.level.layout());
  if (!glass) return glass.failure();
  const auto grilles = decode_level(grille_bytes, replay.level.layout());
  if (!grilles) return grilles.failure();
  if (voxel::without(*glass, replay.level).count_solid() > 0 ||
      voxel::without(*grilles, replay.level).count_solid() != grilles->count_solid())
    return damaged("a replay whose roles do not fit its level");
  if (glass->count_solid() > 0) replay.roles.sight = voxel::without(replay.level, *glass);
  if (grilles->count_solid() > 0) replay.roles.bodies = voxel::united(replay.level, *grilles);
  return {};
}

}  // namespace

Replay make_replay(const voxel::Solids& level, const sim::WorldSettings& settings,
                   std::span<const sim::Event> events) {
  Replay replay{level.smoke, settings, {events.begin(), events.end()}, {}};
  if (&level.sight != &level.smoke) replay.roles.sight = level.sight;
  if (&level.bodies != &level.smoke) replay.roles.bodies = level.bodies;
  return replay;
}

Result<std::vector<std::byte>> encode_replay(const Replay& replay) {
  const auto level = encode_level(replay.level);
  if (!level) return level.failure();
  ByteWriter out;
  out.raw(kMagic);
  out.varint(kVersion);
  write_world(out, {replay.level.layout(), replay.settings.ticks_per_second, replay.settings.masks,
                    replay.settings.level_hash});
  out.section(*level);
  out.section(write_events(replay.events, replay.level.layout()));
  out.varint(replay.checksums.size());
  for (const std::uint32_t checksum : replay.checksums) out.number(checksum);
  if (!replay.roles.empty()) {
    const voxel::Solids solids(replay.level, replay.roles);
    for (const voxel::BitGrid& voxels :
         {voxel::without(solids.smoke, solids.sight), voxel::without(solids.bodies, solids.smoke)}) {
      const auto coded = encode_level(voxels);
      if (!coded) return coded.failure();
      out.section(*coded);
    }
  }
  out.number(hash_bytes(out.bytes()));
  return out.take();
}

Result<Replay> decode_replay(std::span<const std::byte> bytes) {
  // Signature, version and hash.
  ByteReader in(bytes);
  const auto magic = in.raw(kMagic.size());
  if (!in.ok() || !std::equal(magic.begin(), magic.end(), kMagic.begin())) return damaged("not a replay");
  const std::uint64_t version = in.varint(~std::uint64_t{0});
  if (!in.ok() || version != kVersion)
    return damaged("a replay of another version than " + std::to_string(kVersion));
  if (in.remaining().size() < kHashBytes) return damaged("a truncated replay");
  const std::size_t hashed = bytes.size() - kHashBytes;
  if (ByteReader(bytes.subspan(hashed)).number<std::uint64_t>() != hash_bytes(bytes.first(hashed)))
    return damaged("a damaged replay: its hash is wrong");

  // World, level, events and checksums.
  const auto world = read_world(in);
  if (!world) return damaged("replay: " + world.failure().message);
  const auto level_bytes = in.section();
  const auto event_bytes = in.section();
  if (!in.ok() || in.remaining().size() < kHashBytes) return damaged("a truncated replay");
  const std::uint64_t ticks = in.varint(in.remaining().size() / sizeof(std::uint32_t));
  if (!in.ok() || in.remaining().size() < ticks * sizeof(std::uint32_t) + kHashBytes)
    return damaged("a replay whose length does not match its number of ticks");
  auto level = decode_level(level_bytes, world->layout);
  if (!level) return level.failure();
  auto events = read_events(event_bytes, world->layout);
  if (!events) return damaged("replay: " + events.failure().message);
  Replay replay{
      std::move(*level), {world->ticks_per_second, world->masks, world->level_hash}, std::move(*events), {}};
  for (std::uint64_t tick = 0; tick < ticks; ++tick) replay.checksums.push_back(in.number<std::uint32_t>());
  if (in.remaining().size() > kHashBytes)
    if (auto done = decode_roles(in, replay); !done) return done.failure();
  return replay;
}

Result<void> save_replay(const std::filesystem::path& path, const Replay& replay) {
  const auto bytes = encode_replay(replay);
  if (!bytes) return bytes.failure();
  return write_file_atomic(path, *bytes);
}

Result<Replay> load_replay(const std::filesystem::path& path) {
  const auto bytes = read_file(path);
  if (!bytes) return bytes.failure();
  auto replay = decode_replay(*bytes);
  if (!replay) return Failure{replay.failure().code, path.string() + ": " + replay.failure().message};
  return replay;
}

Result<std::optional<Divergence>> play(const Replay& replay,
                                       const std::function<void(const sim::State&)>& visit) {
  sim::World world({replay.level, replay.roles}, replay.settings);
  if (auto appended = world.append(replay.events); !appended) return appended.failure();
  for (std::uint32_t tick = 0; tick < replay.checksums.size(); ++tick) {
    world.advance_to(tick);
    if (visit) visit(world.state());
    const std::uint32_t got = checksum_of(world.state());
    if (got != replay.checksums[tick]) return std::optional(Divergence{tick, replay.checksums[tick], got});
  }
  return std::optional<Divergence>();
}

}  // namespace brume::wire
