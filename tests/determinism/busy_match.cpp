// Plays the busy match and prints hashes, one line each: TICK KIND HASH.
//
//   state    sim::State::hash(), every tick          level    voxels and planes of the level, at tick 0
//   voxels   densities of all voxels, every 16       sight    optical depths and what is visible, every 64
//   second   the state hashes of 64 ticks, every 64       drawn    optical depths of drawn smoke, every 320
//
//   busy_match [--threads N] [--calls N] [--mode straight|rollback|late|snapshot] [--expect FILE]
//
// The hashes are the same in all modes (docs/how/simulation.md). --calls: how often the world is advanced per
// second, to whatever tick is current then. --expect: prints only the first line that differs from that of
// the same tick and kind in the file, or is missing there, and fails with 7.
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "core/hash.hpp"
#include "core/tasks.hpp"
#include "sim/world.hpp"
#include "smoke/drawn_smoke.hpp"
#include "smoke/holes.hpp"
#include "smoke/noise_look.hpp"
#include "smoke/sight.hpp"
#include "smoke/smoke_volume.hpp"
#include "tests/determinism/match.hpp"
#include "voxel/level_hash.hpp"

namespace brume::determinism {
namespace {

struct Options {
  std::uint32_t threads = 0, calls = 64;
  std::string mode = "straight", expect;
};

/// Prints hashes, or compares them with those of a file.
class Report {
 public:
  explicit Report(const std::string& expected_file) : comparing_(!expected_file.empty()) {
    if (!comparing_) return;
    std::ifstream file(expected_file);
    std::uint32_t tick = 0;
    for (std::string kind, hash; file >> tick >> kind >> hash;) expected_[{tick, kind}] = hash;
    if (expected_.empty())
      throw Error(ErrorCode::bad_input, expected_file + ": expected lines TICK KIND HASH");
  }

  void add(std::uint32_t tick, const char* kind, std::uint64_t hash) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    if (!comparing_) {
      std::printf("%u %s %s\n", tick, kind, text);
      return;
    }
    const auto line = expected_.find({tick, kind});
    if (line == expected_.end()) return;
    if (line->second != text && differing_.empty())
      differing_ = "tick " + std::to_string(tick) + " " + kind + ": " + text + ", expected " + line->second;
    ++compared_;
  }

  /// The exit status.
  int finish() const {
    if (!comparing_) return 0;
    if (differing_.empty() && compared_ >= expected_.size()) return 0;
    std::cerr << "busy_match: "
              << (differing_.empty() ? std::to_string(expected_.size() - compared_) + " lines are missing"
                                     : differing_)
              << "; where this is meant, script/determinism --update writes the new file\n";
    return static_cast<int>(ErrorCode::comparison_failed);
  }

 private:
  bool comparing_;
  std::map<std::pair<std::uint32_t, std::string>, std::string> expected_;
  std::size_t compared_ = 0;
  std::string differing_;
};

/// The densities of all voxels that may contain smoke.
std::uint64_t hash_densities(const sim::State& state) {
  std::vector<glm::ivec3> voxels;
  for (const sim::LiveCloud& live : state.clouds)
    live.cloud->voxels().for_each([&](glm::ivec3 voxel, std::uint32_t) { voxels.push_back(voxel); });
  const sim::BlockSet all(voxels);
  voxels.clear();
  all.for_each([&](glm::ivec3 voxel, std::uint32_t) { voxels.push_back(voxel); });
  std::vector<std::uint8_t> densities(voxels.size());
  parallel_for(voxels.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) densities[i] = state.density(voxels[i]);
  });
  std::uint64_t hash = hash_values(std::span<const std::uint8_t>(densities));
  for (const sim::VoxelBlock& block : all.blocks()) {
    const std::int16_t place[3] = {block.at.x, block.at.y, block.at.z};
    hash = hash_values(std::span<const std::int16_t>(place), hash);
    hash = hash_values(std::span<const std::uint64_t>(&block.mask, 1), hash);
  }
  return hash;
}

std::uint64_t hash_sight(const smoke::SmokeVolume& volume, const sim::World& world,
                         const smoke::MaskAtlas& masks) {
  Random random(world.tick());
  std::vector<smoke::Segment> segments(256);
  const auto metres = [&] {
    return glm::vec3(sim::metres_from_position(random.position(kLowCorner, kHighCorner)));
  };
  for (smoke::Segment& segment : segments) segment = {metres(), metres()};
  const auto holes = smoke::make_holes(world.state(), &masks);
  const smoke::Sight sight(volume, world.grid(), holes, world.state().seconds(world.tick()),
                           {.masks = &masks});
  std::vector<float> depths(segments.size());
  std::vector<std::uint8_t> visible(segments.size());
  sight.optical_depths(segments, depths).value_or_throw();
  sight.visible(segments, 2, visible).value_or_throw();
  return hash_values(std::span<const float>(depths), hash_values(std::span<const std::uint8_t>(visible)));
}

/// A tile of few texels: noise is the same at any size.
const smoke::SmokeNoise& smoke_noise() {
  static const smoke::NoiseTile tile = smoke::make_noise_tile({16, 4, 7});
  static const smoke::SmokeNoise noise{tile, smoke::make_detail_tile(tile)};
  return noise;
}

std::uint64_t hash_drawn(const smoke::SmokeVolume& volume, const sim::World& world,
                         const smoke::MaskAtlas& masks) {
  Random random(world.tick());
  const auto metres = [&] {
    return glm::vec3(sim::metres_from_position(random.position(kLowCorner, kHighCorner)));
  };
  const auto holes = smoke::make_holes(world.state(), &masks);
  const float time = world.state().seconds(world.tick());
  smoke::SmokeInput input{.volume = &volume, .state = &world.state(), .holes = holes, .time = time};
  smoke::set_noise(input.look, {});
  const smoke::DrawnSmoke drawn(input, smoke_noise, &masks);
  const smoke::Sight sight(volume, world.grid(), holes, time, {.masks = &masks, .drawn = &drawn});
  std::vector<smoke::Segment> segments(48);
  for (smoke::Segment& segment : segments) segment = {metres(), metres()};
  std::vector<float> depths(segments.size());
  sight.optical_depths(segments, depths).value_or_throw();
  return hash_values(std::span<const float>(depths));
}

/// A world that reports its hashes at every tick that it reaches.
class Match {
 public:
  Match(const MatchLevel& level, Report& report)
      : level_(level), report_(report), volume_(level.grid, level.planes) {
    restart();
  }

  sim::World& world() { return *world_; }
  void append(const sim::Event& event) { world_->append(event).value_or_throw(); }
  /// Replaces the world.
  void restart() {
    world_ = std::make_unique<sim::World>(level_.grid, sim::WorldSettings{.masks = masks_.key()});
  }

  void play_to(std::uint32_t tick) {
    world_->advance_to(tick);
    const std::uint64_t hash = world_->state_hash();
    report_.add(tick, "state", hash);
    if (tick == next_) {
      second_ = hash_values(std::span<const std::uint64_t>(&hash, 1), second_);
      if (tick % 64 == 0) report_.add(tick, "second", std::exchange(second_, 0));
      ++next_;
    }
    const bool came_here = std::exchange(last_, tick) != tick;
    if (tick % 16 != 0 || !came_here) return;
    report_.add(tick, "voxels", hash_densities(world_->state()));
    volume_.update(*world_);
    if (tick % 64 == 0) report_.add(tick, "sight", hash_sight(volume_, *world_, masks_));
    if (tick % 320 == 0) report_.add(tick, "drawn", hash_drawn(volume_, *world_, masks_));
  }

 private:
  const MatchLevel& level_;
  const smoke::MaskAtlas masks_ = make_masks();
  Report& report_;
  std::unique_ptr<sim::World> world_;
  smoke::SmokeVolume volume_;
  std::uint32_t next_ = 0;  // ticks before it are in second_ or reported
  std::uint32_t last_ = ~0u;
  std::uint64_t second_ = 0;
};

/// Advances tick by tick, or to the ticks given by --calls.
void play_straight(Match& match, const std::vector<sim::Event>& events, std::uint32_t calls) {
  for (const sim::Event& event : events) match.append(event);
  for (std::uint32_t call = 0; call <= kMatchTicks * calls / 64; ++call) match.play_to(call * 64 / calls);
}

/// Rolls back 60 ticks from time to time and advances again.
void play_rollback(Match& match, const std::vector<sim::Event>& events) {
  for (const sim::Event& event : events) match.append(event);
  for (std::uint32_t tick = 0; tick <= kMatchTicks; ++tick) {
    match.play_to(tick);
    if (tick < 60 || tick % 40 != 0) continue;
    for (std::uint32_t again = tick - 60; again <= tick; ++again) match.play_to(again);
  }
}

/// Adds the events of each half second after it is over, in reverse order.
void play_late(Match& match, const std::vector<sim::Event>& events) {
  constexpr std::uint32_t kTicks = 32;
  auto next = events.begin();
  for (std::uint32_t begin = 0; begin <= kMatchTicks; begin += kTicks) {
    const std::uint32_t end = std::min(begin + kTicks, kMatchTicks + 1);
    match.world().advance_to(end - 1);
    const auto first = next;
    while (next != events.end() && tick_of(*next) < end) ++next;
    // Events of the same tick keep their order.
    for (auto last = next; last != first;) {
      auto same = std::prev(last);
      while (same != first && tick_of(*std::prev(same)) == tick_of(*same)) --same;
      for (auto event = same; event != last; ++event) match.append(*event);
      last = same;
    }
    for (std::uint32_t tick = begin; tick < end; ++tick) match.play_to(tick);
  }
}

/// Repeatedly restores the state in another world and continues there.
void play_snapshot(Match& match, const std::vector<sim::Event>& events) {
  for (const sim::Event& event : events) match.append(event);
  for (std::uint32_t tick = 0; tick <= kMatchTicks; ++tick) {
    match.play_to(tick);
    if (tick % 23 != 0) continue;
    const sim::State snapshot = match.world().state();
    match.restart();
    match.world().restore(snapshot).value_or_throw();
    for (const sim::Event& event : events)
      if (tick_of(event) > tick) match.append(event);
  }
}

int play(const Options& options) {
  set_thread_count(options.threads);
  const MatchLevel level = make_level();
  const std::vector<sim::Event> events = make_events(level.grid.layout());
  Report report(options.expect);
  report.add(0, "level", voxel::level_hash(level.grid, level.planes));
  Match match(level, report);
  if (options.mode == "straight") play_straight(match, events, options.calls);
  if (options.mode == "rollback") play_rollback(match, events);
  if (options.mode == "late") play_late(match, events);
  if (options.mode == "snapshot") play_snapshot(match, events);
  return report.finish();
}

std::optional<Options> parse(int count, char** arguments) {
  Options options;
  const auto number = [](const std::string& text, std::uint32_t& value) {
    return std::from_chars(text.data(), text.data() + text.size(), value).ptr == text.data() + text.size();
  };
  for (int i = 1; i < count; i += 2) {
    if (i + 1 == count) return std::nullopt;
    const std::string name = arguments[i], value = arguments[i + 1];
    const bool ok = name == "--threads" ? number(value, options.threads)
                    : name == "--calls" ? number(value, options.calls) && options.calls > 0
                    : name == "--mode"  ? (options.mode = value, value == "straight" || value == "rollback" ||
                                                                    value == "late" || value == "snapshot")
                                        : name == "--expect" && !(options.expect = value).empty();
    if (!ok) return std::nullopt;
  }
  return options;
}

}  // namespace
}  // namespace brume::determinism

int main(int count, char** arguments) {
  using namespace brume;
  const auto options = determinism::parse(count, arguments);
  if (!options) {
    std::cerr << "usage: busy_match [--threads N] [--calls N] [--mode straight|rollback|late|snapshot] "
                 "[--expect FILE]\n";
    return static_cast<int>(ErrorCode::usage);
  }
  try {
    return determinism::play(*options);
  } catch (const Error& error) {
    std::cerr << "busy_match: " << error.what() << '\n';
    return static_cast<int>(error.code());
  }
}
