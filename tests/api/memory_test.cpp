// Where memory ends, calls fail with a result, and a state mends what broke.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <utility>

#include "tests/api/match.hpp"
#include "tests/sanitized.hpp"

namespace brume::api {
namespace {

/// Bytes of address space that this process has.
std::uint64_t address_space() {
  unsigned long long pages = 0;
  FILE* file = std::fopen("/proc/self/statm", "r");
  if (file) {
    if (std::fscanf(file, "%llu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

/// While it lives, no memory is free in this process.
class Shortage {
 public:
  Shortage() {
    limit(address_space());
    for (std::size_t size = 1 << 20; size >= 32; size /= 2)
      while (void* block = std::malloc(size)) blocks_ = new (block) Block{blocks_};
  }
  Shortage(const Shortage&) = delete;
  ~Shortage() {
    while (blocks_) std::free(std::exchange(blocks_, blocks_->next));
    limit(RLIM_INFINITY);
  }

 private:
  struct Block {
    Block* next;
  };
  static void limit(std::uint64_t bytes) {
    rlimit limit{};
    ::getrlimit(RLIMIT_AS, &limit);
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_AS, &limit);
  }
  Block* blocks_ = nullptr;
};

brume_event smoke() {
  brume_event event = brume_event_defaults(BRUME_EVENT_SMOKE, 1);
  event.u.smoke.from = {16384, 16384, 16384};
  event.u.smoke.at = {16385, 16384, 16384};
  event.u.smoke.voxels = 200'000;
  event.u.smoke.bloom_ticks = 1;
  return event;
}

void expect(int step, brume_result result, brume_result expected) {
  if (result == expected) return;
  std::fprintf(stderr, "step %d: %s, expected %s: %s\n", step, brume_result_name(result),
               brume_result_name(expected), brume_last_error());
  std::_Exit(step);
}

/// The steps of the test, in a process whose memory is limited; exits with 0 when all hold.
[[noreturn]] void run_out_of_memory() {
  brume_context_params settings = brume_context_defaults();
  settings.thread_count = 1;
  const Context context(settings);
  brume_voxels_params params = brume_voxels_defaults();
  params.layout = {{64, 64, 64}, 0.5f, {0, 0, 0}};
  const Bytes bits(64 * 64 * 8);
  params.bits = bits.data();
  params.byte_count = bits.size();
  const Level level(context, params);
  World world(level);
  Field field(level);
  const State before = world.state();
  world.append(smoke());
  std::uint64_t hash = 0;
  float depth = 0;
  const brume_segment line{{1, 1, 1}, {30, 30, 30}};

  // The world breaks, and a state mends it.
  {
    const Shortage shortage;
    expect(1, brume_world_advance_to(world.get(), 64), BRUME_ERROR_MEMORY);
  }
  expect(2, brume_world_hash(world.get(), &hash), BRUME_ERROR_BROKEN);
  expect(2, brume_world_step(world.get()), BRUME_ERROR_BROKEN);
  expect(3, brume_world_restore(world.get(), before.get()), BRUME_OK);
  const brume_event again = smoke();
  expect(4, brume_world_append(world.get(), &again, 1), BRUME_OK);
  expect(5, brume_world_advance_to(world.get(), 64), BRUME_OK);

  // So does a field.
  const State full = world.state();
  {
    const Shortage shortage;
    expect(6, brume_field_update(field.get(), full.get()), BRUME_ERROR_MEMORY);
  }
  expect(7, brume_field_optical_depths(field.get(), &line, 1, &depth), BRUME_ERROR_BROKEN);
  expect(8, brume_field_update(field.get(), full.get()), BRUME_OK);
  expect(9, brume_field_optical_depths(field.get(), &line, 1, &depth), BRUME_OK);

  // A receiver begins again.
  Sender sender(context);
  const Bytes packet = sender.push(full);
  Receiver receiver(context);
  const auto receive = [&] {
    return brume_receiver_receive(receiver.get(), packet.data(), packet.size(), nullptr);
  };
  {
    const Shortage shortage;
    expect(11, receive(), BRUME_ERROR_MEMORY);
  }
  expect(12, receive(), BRUME_ERROR_BROKEN);
  expect(13, brume_receiver_reset(receiver.get()), BRUME_OK);
  expect(14, receive(), BRUME_OK);
  std::_Exit(depth > 1 ? 0 : 10);
}

TEST(Memory, WhereItEndsCallsFailAndAStateMendsWhatBroke) {
  if (kSanitized) GTEST_SKIP() << "the sanitizers need more address space";
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(run_out_of_memory(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace brume::api
