// Errors, versions, logs and settings of the C interface.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <thread>

#include "tests/api/match.hpp"

namespace brume::api {
namespace {

struct Log {
  std::vector<std::string> lines;
  static void write(void* user, brume_result, const char* line) {
    static_cast<Log*>(user)->lines.emplace_back(line);
    brume_world_tick(nullptr, nullptr);  // Fails, and must not change the error that is reported.
  }
};

brume_voxels_params small_level(const Bytes& bits) {
  brume_voxels_params params = brume_voxels_defaults();
  params.layout.size = {4, 4, 4};
  params.bits = bits.data();
  params.byte_count = bits.size();
  return params;
}

class CallTest : public testing::Test {
 protected:
  Bytes bits_ = Bytes(8);
  Context context_;
  Level level_{context_, small_level(bits_)};
};

TEST_F(CallTest, NamesResults) {
  EXPECT_STREQ(brume_result_name(BRUME_OK), "BRUME_OK");
  for (int i = BRUME_OK; i <= BRUME_ERROR_INTERNAL; ++i)
    EXPECT_EQ(std::strncmp(brume_result_name(static_cast<brume_result>(i)), "BRUME_", 6), 0) << i;
  std::uint32_t major = 9, minor = 9, patch = 9;
  EXPECT_EQ(brume_version(&major, &minor, &patch), BRUME_OK);
  EXPECT_EQ(std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(patch),
            BRUME_PROJECT_VERSION);
  EXPECT_EQ(brume_version(nullptr, nullptr, nullptr), BRUME_OK);
}

TEST_F(CallTest, AnErrorIsOneLineOfItsThread) {
  World world(level_);
  EXPECT_EQ(brume_world_advance_to(world.get(), BRUME_MAX_TICK + 1), BRUME_ERROR_ARGUMENT);
  const std::string line = brume_last_error();
  EXPECT_EQ(line, "brume_world_advance_to: `tick` must be at most 536870912");
  std::jthread([] { EXPECT_STREQ(brume_last_error(), ""); }).join();
  EXPECT_EQ(brume_world_advance_to(world.get(), 5), BRUME_OK);
  EXPECT_EQ(brume_last_error(), line) << "success does not change it";
  try {
    world.advance_to(BRUME_MAX_TICK + 1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.what(), line);
    EXPECT_EQ(error.result(), BRUME_ERROR_ARGUMENT);
  }
}

TEST_F(CallTest, AContextLogsItsFailures) {
  Log log, other_log;
  brume_context_params params = brume_context_defaults();
  params.log = Log::write;
  params.log_user = &log;
  std::optional<Context> context(params);
  params.log_user = &other_log;
  const Context other(params);
  const Level level(*context, small_level(bits_));
  World world(level);
  EXPECT_EQ(brume_world_advance_to(world.get(), ~0u), BRUME_ERROR_ARGUMENT);
  ASSERT_EQ(log.lines.size(), 1u);
  EXPECT_EQ(log.lines[0], brume_last_error());
  EXPECT_TRUE(other_log.lines.empty());
  context.reset();
  EXPECT_EQ(brume_world_advance_to(world.get(), ~0u), BRUME_ERROR_ARGUMENT);
  EXPECT_EQ(log.lines.size(), 1u);
}

TEST_F(CallTest, WrongHandlesAreRejected) {
  World world(level_);
  std::uint64_t hash = 7;
  auto* as_world = reinterpret_cast<brume_world*>(level_.get());
  EXPECT_EQ(brume_world_hash(as_world, &hash), BRUME_ERROR_HANDLE);
  EXPECT_STREQ(brume_last_error(), "brume_world_hash: expected a world, not a level");
  EXPECT_EQ(brume_world_destroy(as_world), BRUME_ERROR_HANDLE);
  EXPECT_EQ(brume_world_hash(nullptr, &hash), BRUME_ERROR_HANDLE);
  alignas(16) std::array<std::uint64_t, 64> garbage{};
  EXPECT_EQ(brume_world_hash(reinterpret_cast<brume_world*>(&garbage), &hash), BRUME_ERROR_HANDLE);
  auto* odd = reinterpret_cast<brume_world*>(reinterpret_cast<char*>(&garbage) + 1);
  EXPECT_EQ(brume_world_hash(odd, &hash), BRUME_ERROR_HANDLE);
  EXPECT_EQ(brume_world_hash(world.get(), nullptr), BRUME_ERROR_ARGUMENT);
  EXPECT_EQ(hash, 7u);
  EXPECT_EQ(brume_world_destroy(nullptr), BRUME_OK);
  EXPECT_EQ(brume_context_destroy(nullptr), BRUME_OK);
}

TEST_F(CallTest, StructsOfNoVersionAreRejected) {
  // As large as the library reads, so that every size below is that of what is there.
  struct Padded {
    brume_world_params params = brume_world_defaults();
    std::array<unsigned char, 4096> after{};
  } given;
  brume_world* world = nullptr;
  const auto known = static_cast<std::uint32_t>(sizeof(brume_world_params));
  for (const std::uint32_t size : {0u, 4u, known - 8, known - 1, known + 1, known + 4, 4104u, ~0u}) {
    given.params.struct_size = size;
    EXPECT_EQ(brume_world_create(level_.get(), &given.params, &world), BRUME_ERROR_ARGUMENT) << size;
    EXPECT_EQ(std::string(brume_last_error()),
              "brume_world_create: `struct_size` is " + std::to_string(size) + ", expected " +
                  std::to_string(known) +
                  ": take the defaults from the *_defaults function of the same header");
  }
  brume_world_params params = brume_world_defaults();
  params.next = &params;
  EXPECT_EQ(brume_world_create(level_.get(), &params, &world), BRUME_ERROR_ARGUMENT);
  EXPECT_EQ(world, nullptr);
  for (const std::uint32_t size : {0u, static_cast<std::uint32_t>(sizeof(brume_event)) + 8}) {
    brume_event event = brume_event_defaults(BRUME_EVENT_MOVE, 0);
    event.struct_size = size;
    EXPECT_THROW(World(level_).append(event), Error);
  }
}

// What a caller gives whose header is newer than the library.
TEST_F(CallTest, StructsOfLaterVersionsWorkUntilTheySetWhatIsUnknown) {
  // Bytes rather than a struct with more members: those between the members would have any value.
  struct Later {
    brume_world_params params = brume_world_defaults();
    std::array<unsigned char, 16> members{};
  } later;
  static_assert(sizeof later == sizeof later.params + sizeof later.members);
  later.params.struct_size = sizeof later;
  later.params.ticks_per_second = 30;
  brume_world* world = nullptr;
  ASSERT_EQ(brume_world_create(level_.get(), &later.params, &world), BRUME_OK) << brume_last_error();
  brume_state* state = nullptr;
  brume_state_info info{};
  EXPECT_EQ(brume_world_state(world, &state), BRUME_OK);
  EXPECT_EQ(brume_state_describe(state, &info), BRUME_OK);
  EXPECT_EQ(info.ticks_per_second, 30u);
  EXPECT_EQ(brume_state_destroy(state), BRUME_OK);
  EXPECT_EQ(brume_world_destroy(world), BRUME_OK);

  world = nullptr;
  later.members.back() = 1;
  EXPECT_EQ(brume_world_create(level_.get(), &later.params, &world), BRUME_ERROR_ARGUMENT);
  EXPECT_NE(std::string(brume_last_error()).find("later version"), std::string::npos) << brume_last_error();
  EXPECT_EQ(world, nullptr);
}

TEST_F(CallTest, NumbersOutOfRangeAreRejectedWithTheEvent) {
  World world(level_);
  std::vector<brume_event> events(3, brume_event_defaults(BRUME_EVENT_MOVE, 4));
  events[2].u.move.to.x = BRUME_MAX_COORDINATE + 1;
  EXPECT_EQ(brume_world_append(world.get(), events.data(), events.size()), BRUME_ERROR_ARGUMENT);
  EXPECT_STREQ(
      brume_last_error(),
      "brume_world_append: event 2: move at tick 4: expected `to` within 16384 m of the world's origin");
  EXPECT_EQ(brume_world_append(world.get(), nullptr, 0), BRUME_OK);
  EXPECT_EQ(brume_world_append(world.get(), nullptr, 1), BRUME_ERROR_ARGUMENT);
  EXPECT_EQ(brume_world_append(world.get(), events.data(), std::numeric_limits<std::size_t>::max()),
            BRUME_ERROR_ARGUMENT);
  brume_position at{1, 2, 3};
  EXPECT_EQ(brume_position_from_metres(std::nan(""), 0, 0, &at), BRUME_ERROR_ARGUMENT);
  EXPECT_EQ(brume_position_from_metres(0, 16384.01, 0, &at), BRUME_ERROR_ARGUMENT);
  EXPECT_EQ(at.x, 1);
  EXPECT_EQ(position(0.5, -1, 16384).x, 512);
}

TEST_F(CallTest, LinesThatAreNotFiniteWriteNoResult) {
  const Field field(level_);
  std::vector<brume_segment> segments(3);
  segments[2].b.y = std::numeric_limits<float>::quiet_NaN();
  std::array<float, 3> depths{7, 7, 7};
  EXPECT_EQ(brume_field_optical_depths(field.get(), segments.data(), 3, depths.data()), BRUME_ERROR_ARGUMENT);
  EXPECT_EQ(depths, (std::array<float, 3>{7, 7, 7}));
  std::array<std::uint8_t, 3> visible{};
  EXPECT_EQ(brume_field_visible(field.get(), segments.data(), 2, -1, visible.data()), BRUME_ERROR_ARGUMENT);
  EXPECT_EQ(brume_field_visible(field.get(), segments.data(), 2, std::nanf(""), visible.data()),
            BRUME_ERROR_ARGUMENT);
}

TEST_F(CallTest, LevelsThatAreTooLargeAreRejected) {
  brume_level* level = nullptr;
  brume_voxels_params params = small_level(bits_);
  params.layout.size = {4097, 1, 1};
  EXPECT_EQ(brume_level_create_from_voxels(context_.get(), &params, &level), BRUME_ERROR_LIMIT);
  params.layout.size = {4096, 4096, 4096};
  EXPECT_EQ(brume_level_create_from_voxels(context_.get(), &params, &level), BRUME_ERROR_ARGUMENT)
      << "too few bytes";
  const std::array<brume_point, 3> points{{{-9000, 0, 0}, {9000, 0, 0}, {0, 9, 9}}};
  std::array<std::uint32_t, 3> indices{0, 1, 2};
  brume_triangles_params triangles = brume_triangles_defaults();
  triangles.points = points.data();
  triangles.point_count = points.size();
  triangles.indices = indices.data();
  triangles.index_count = indices.size();
  EXPECT_EQ(brume_level_create_from_triangles(context_.get(), &triangles, &level), BRUME_ERROR_LIMIT);
  triangles.layout.voxel_size = 8;
  indices[1] = 3;
  EXPECT_EQ(brume_level_create_from_triangles(context_.get(), &triangles, &level), BRUME_ERROR_ARGUMENT);
  EXPECT_EQ(level, nullptr);
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Defaults, FitStructsOfEarlierAndLaterVersions) {
  // Before hold_ticks and level, the limits alone.
  brume_receiver_params receiver;
  std::memset(&receiver, 0xee, sizeof receiver);
  constexpr std::uint32_t kEarlier = offsetof(brume_receiver_params, level);
  ASSERT_EQ(brume_receiver_params_init(&receiver, kEarlier), BRUME_OK);
  EXPECT_EQ(receiver.struct_size, kEarlier);
  EXPECT_EQ(receiver.max_bytes, brume_receiver_defaults().max_bytes);
  EXPECT_EQ(receiver.hold_ticks, 0xeeeeeeeeu) << "beyond the struct";

  struct Later {
    brume_world_params params;
    std::uint64_t added;
  } later{{}, 7};
  ASSERT_EQ(brume_world_params_init(&later.params, sizeof later), BRUME_OK);
  EXPECT_EQ(later.params.struct_size, sizeof later);
  EXPECT_EQ(later.params.ticks_per_second, 64u);
  EXPECT_EQ(later.added, 0u);

  EXPECT_EQ(brume_world_params_init(nullptr, sizeof later), BRUME_ERROR_ARGUMENT);
  EXPECT_EQ(brume_world_params_init(&later.params, 8), BRUME_ERROR_ARGUMENT);
  EXPECT_EQ(brume_event_init(nullptr, BRUME_EVENT_SHOT, 1), BRUME_ERROR_ARGUMENT);
}

TEST(Lengths, AreRoundedAndClamped) {
  EXPECT_EQ(brume_length(0), 0u);
  EXPECT_EQ(brume_length(1), 1024u);
  EXPECT_EQ(brume_length(0.2), 205u) << "204.8";
  EXPECT_EQ(brume_length(0.1), 102u) << "102.4";
  EXPECT_EQ(brume_length(0.5 / 1024), 1u) << "halves are rounded up";
  EXPECT_EQ(brume_length(std::nextafter(0.5, 0.0) / 1024), 0u);
  EXPECT_EQ(brume_length(2.5 / 1024), 3u);
  EXPECT_EQ(brume_length(16384 - 0.25 / 1024), 16777216u);
  EXPECT_EQ(brume_length(16384 - 0.75 / 1024), 16777215u);
  for (const double too_small : {-0.0, -1e-9, -5.0, -kInfinity, kNaN}) EXPECT_EQ(brume_length(too_small), 0u);
  for (const double too_large : {16384.0, 16385.0, 1e300, kInfinity})
    EXPECT_EQ(brume_length(too_large), std::uint32_t{BRUME_MAX_COORDINATE});
  // As positions are.
  for (int i = 0; i < 1000; ++i) {
    const double metres = 0.37 * i;
    EXPECT_EQ(brume_length(metres), static_cast<std::uint32_t>(position(metres, 0, 0).x)) << metres;
  }
}

TEST(Lengths, AmountsOfSmokeAreRoundedAndClamped) {
  EXPECT_EQ(brume_smoke_voxels(225, 0.5), 1800u);
  EXPECT_EQ(brume_smoke_voxels(225, 0.25), 14400u);
  EXPECT_EQ(brume_smoke_voxels(225, double{0.5f}), 1800u);
  EXPECT_EQ(brume_smoke_voxels(2.5, 1), 3u) << "halves are rounded up";
  EXPECT_EQ(brume_smoke_voxels(2.4, 1), 2u);
  for (const double too_small : {0.0, 0.4, -3.0, -kInfinity, kNaN})
    EXPECT_EQ(brume_smoke_voxels(too_small, 1), 1u);
  for (const double too_large : {134217728.0, 134217729.0, 1e300, kInfinity})
    EXPECT_EQ(brume_smoke_voxels(too_large, 1), BRUME_MAX_SMOKE_VOXELS);
  EXPECT_EQ(brume_smoke_voxels(1, 1e-200), BRUME_MAX_SMOKE_VOXELS);
  EXPECT_EQ(brume_smoke_voxels(1, kInfinity), 1u);
  for (const double no_edge : {0.0, -1.0, kNaN}) EXPECT_EQ(brume_smoke_voxels(1e9, no_edge), 1u);
}

}  // namespace
}  // namespace brume::api
