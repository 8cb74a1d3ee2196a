// What a server of many smokes does in a tick: the world, the field that lines of sight read, late events.
#include <algorithm>
#include <array>
#include <random>

#include "bench/bench.hpp"
#include "core/tasks.hpp"
#include "sim/level_edit.hpp"
#include "sim/world.hpp"
#include "smoke/field.hpp"
#include "voxel/voxelize.hpp"

namespace brume::bench {
namespace {

constexpr voxel::GridLayout kWarehouse{{512, 24, 512}, 0.5f, {0, 0, 0}};
constexpr int kRoomVoxels = 32, kRooms = 16;   // along an axis
constexpr std::uint32_t kThrowTicks = 7 * 64;  // in which all smokes are thrown
constexpr std::uint32_t kFirstMeasured = 70;   // from here on smokes bloom all the time
constexpr std::uint32_t kLateTicks = 30, kLateEvery = 16;

/// A hall of 256 rooms, 256 m long and wide, with two openings a room and shelves.
struct Warehouse {
  std::vector<voxel::Triangle> triangles;
  voxel::BitGrid grid{kWarehouse};
  voxel::SurfacePlanes planes;

  Warehouse() {
    const float size = kRoomVoxels * kWarehouse.voxel_size, length = kRooms * size;
    add_box({0, 0, 0}, {length, 0.3f, length});
    add_box({0, 11.6f, 0}, {length, 11.9f, length});
    for (int line = 0; line <= kRooms; ++line)
      for (int room = 0; room < kRooms; ++room) {
        const float at = static_cast<float>(line) * size, from = static_cast<float>(room) * size;
        add_wall(0, at, from, size);
        add_wall(2, at, from, size);
      }
    for (int x = 0; x < kRooms; ++x)
      for (int z = 0; z < kRooms; ++z)
        for (const float shelf : {5.2f, 9.2f}) {
          const float low_x = static_cast<float>(x) * size + shelf, low_z = static_cast<float>(z) * size + 4;
          add_box({low_x, 0, low_z}, {low_x + 0.9f, 4.1f, low_z + 8});
        }
    grid = voxel::voxelize(triangles, kWarehouse).value_or_throw();
    planes = voxel::SurfacePlanes::build(triangles, grid);
  }

  /// The wall of a room with an opening of 2 m in its middle.
  void add_wall(int axis, float at, float from, float size) {
    const auto piece = [&](float begin, float end, float bottom) {
      glm::vec3 low(0, bottom, 0), high(0, 11.8f, 0);
      low[axis] = at - 0.1f;
      high[axis] = at + 0.1f;
      low[2 - axis] = from + begin;
      high[2 - axis] = from + end;
      add_box(low, high);
    };
    piece(0, size / 2 - 1, 0);
    piece(size / 2 - 1, size / 2 + 1, 2.6f);
    piece(size / 2 + 1, size, 0);
  }

  void add_box(glm::vec3 low, glm::vec3 high) {
    for (int axis = 0; axis < 3; ++axis)
      for (const float side : {low[axis], high[axis]}) {
        std::array<glm::vec3, 4> corners;
        for (unsigned i = 0; i < 4; ++i) {
          corners[i][axis] = side;
          corners[i][(axis + 1) % 3] = i == 1 || i == 2 ? high[(axis + 1) % 3] : low[(axis + 1) % 3];
          corners[i][(axis + 2) % 3] = i >= 2 ? high[(axis + 2) % 3] : low[(axis + 2) % 3];
        }
        triangles.push_back({corners[0], corners[1], corners[2]});
        triangles.push_back({corners[0], corners[2], corners[3]});
      }
  }
};

class Players {
 public:
  sim::Position place() {
    const auto metres = [&] { return std::uniform_real_distribution<double>(1, 255)(random_); };
    const double x = metres(), z = metres();
    return sim::position_from_metres({x, 1.6, z});
  }
  sim::ThrowSmoke smoke(std::uint32_t tick) {
    sim::ThrowSmoke event;
    event.tick = tick;
    event.from = event.at = place();
    return event;
  }
  sim::Shot shot(std::uint32_t tick) {
    sim::Shot event;
    event.tick = tick;
    event.origin = place();
    event.toward = event.origin + sim::Position(9000, 100, static_cast<int>(random_() % 9000));
    return event;
  }
  /// A door of a room opens or shuts.
  sim::LevelEdit door(std::uint32_t tick) {
    const int x = kRoomVoxels * static_cast<int>(1 + random_() % (kRooms - 1));
    const int z = kRoomVoxels * static_cast<int>(random_() % kRooms) + kRoomVoxels / 2;
    return {tick, sim::edit_box(kWarehouse, {x - 1, 1, z - 2}, {x + 1, 5, z + 2}, random_() % 2 == 0)};
  }

 private:
  std::mt19937 random_{1};
};

/// The events of a match with `count` smokes in seven seconds, shots and doors.
std::vector<sim::Event> match(std::uint32_t count) {
  Players players;
  std::vector<sim::Event> events;
  for (std::uint32_t i = 0; i < count; ++i) events.push_back(players.smoke(1 + i * kThrowTicks / count));
  for (std::uint32_t tick = 1; tick < kThrowTicks; ++tick) {
    events.push_back(players.shot(tick));
    if (tick % kLateEvery == 0) events.push_back(players.door(tick));
  }
  return events;
}

/// CPU times of the parts of a tick [ms]; the field with its lines of sight.
struct Times {
  std::vector<double> world, field;
  double mean_depth = 0;  // of the lines
};

/// Lines of sight between players that are at most 32 m apart along each axis.
class Lines {
 public:
  Lines(std::size_t count, const smoke::Field& field) : field_(field), segments_(count), depths_(count) {}
  void query() {
    if (segments_.empty()) return;
    const auto metres = [&](float low, float high) {
      return std::uniform_real_distribution<float>(std::max(low, 1.0f), std::min(high, 255.0f))(random_);
    };
    for (smoke::Segment& line : segments_) {
      line.a_world = {metres(1, 255), metres(1, 2), metres(1, 255)};
      line.b_world = {metres(line.a_world.x - 32, line.a_world.x + 32), metres(1, 2),
                      metres(line.a_world.z - 32, line.a_world.z + 32)};
    }
    field_.sight({})->optical_depths(segments_, depths_).value_or_throw();
    for (const float depth : depths_) sum_ += double{depth};
    queried_ += segments_.size();
  }
  double mean_depth() const { return queried_ == 0 ? 0 : sum_ / static_cast<double>(queried_); }

 private:
  const smoke::Field& field_;
  std::vector<smoke::Segment> segments_;
  std::vector<float> depths_;
  std::mt19937 random_{2};
  double sum_ = 0;
  std::size_t queried_ = 0;
};

/// Plays the match with so many lines of sight a tick; an event of `late` comes kLateTicks after its tick.
Times play(const Warehouse& level, std::uint32_t count, bool late, std::size_t line_count) {
  Players players;
  sim::World world(level.grid);
  world.append(match(count)).value_or_throw();
  smoke::Field field(level.grid, level.planes);
  Lines lines(line_count, field);
  Times times;
  for (std::uint32_t tick = 1; tick < kThrowTicks; ++tick) {
    const double start = thread_cpu_ms();
    if (late && tick % kLateEvery == 0 && tick > kLateTicks)
      world.append(players.smoke(tick - kLateTicks)).value_or_throw();
    world.advance_to(tick);
    if (tick > 64) world.forget_before(tick - 64);
    const double moved = thread_cpu_ms();
    field.update(world.state());
    lines.query();
    if (tick < kFirstMeasured) continue;
    times.world.push_back(moved - start);
    times.field.push_back(thread_cpu_ms() - moved);
  }
  times.mean_depth = lines.mean_depth();
  return times;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// The mean tick of a match, and its worst.
Result<std::vector<Measurement>> server(Bench& bench, std::uint32_t count, bool late, std::size_t lines) {
  const std::string name = "server/" + std::to_string(count) + (late ? "late" : "");
  const unsigned threads = thread_count();
  set_thread_count(1);
  const Warehouse level;
  std::vector<double> world, field;
  double world_worst = 0, field_worst = 0, mean_depth = 0;
  for (unsigned i = 0; i < bench.repetitions(3); ++i) {
    const Times times = play(level, count, late, lines);
    world.push_back(mean_of(times.world));
    field.push_back(mean_of(times.field));
    world_worst = std::max(world_worst, *std::ranges::max_element(times.world));
    field_worst = std::max(field_worst, *std::ranges::max_element(times.field));
    mean_depth = times.mean_depth;
  }
  set_thread_count(threads);
  const std::string with = lines == 0 ? "" : "+" + std::to_string(lines);
  auto of_world = summarize(name + "/world", "ms", "cpu", std::move(world));
  auto of_field = summarize(name + "/field" + with, "ms", "cpu", std::move(field));
  of_world.details = {{"worst tick [ms]", world_worst}};
  of_field.details = {{"worst tick [ms]", field_worst}};
  if (lines == 0) return std::vector{of_world, of_field};
  of_field.details["mean optical depth"] = mean_depth;
  return std::vector{of_field};
}

}  // namespace

std::vector<Case> server_cases() {
  constexpr std::uint32_t kSmokes = 1000;
  return {
      {"server/1000", "a tick with 1,000 smokes thrown within 7 s in 256 rooms, one thread: world and field",
       [](Bench& b) { return server(b, kSmokes, false, 0); }},
      {"server/1000+64", "the field and 64 lines of sight of up to 32 m an axis",
       [](Bench& b) { return server(b, kSmokes, false, 64); }},
      {"server/1000+2000", "the field and 2,000 lines of sight",
       [](Bench& b) { return server(b, kSmokes, false, 2000); }},
      {"server/1000late", "the same with a smoke that comes 30 ticks late each 16 ticks",
       [](Bench& b) { return server(b, kSmokes, true, 0); }},
  };
}

}  // namespace brume::bench
