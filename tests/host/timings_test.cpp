// Times of passes are taken where the host asks for them and the queue family has timestamps.
#include "tests/host/yard.hpp"

namespace brume::host {
namespace {

/// Calls of queries, and the valid bits of the timestamps that the device reports.
struct Queries {
  static inline int calls = 0;
  static inline std::uint32_t valid_bits = 64;
  template <typename Function, typename... Arguments>
  static auto call(Function real, Arguments... arguments) {
    ++calls;
    return real(arguments...);
  }
  static void call(PFN_vkGetPhysicalDeviceQueueFamilyProperties real, VkPhysicalDevice device,
                   std::uint32_t* count, VkQueueFamilyProperties* families) {
    real(device, count, families);
    for (std::uint32_t i = 0; families && i < *count; ++i) families[i].timestampValidBits = valid_bits;
  }
};

class TimingsTest : public YardTest {
 protected:
  TimingsTest() : YardTest(gpu::kUsualHost, {16, 9}) {
    Queries::calls = 0;
    for (const gpu::Replacement& replacement :
         {BRUME_INTERPOSED(Queries, CreateQueryPool), BRUME_INTERPOSED(Queries, GetQueryPoolResults),
          BRUME_INTERPOSED(Queries, CmdResetQueryPool), BRUME_INTERPOSED(Queries, CmdWriteTimestamp),
          BRUME_INTERPOSED(Queries, GetPhysicalDeviceQueueFamilyProperties)})
      replacements_.push_back(replacement);
  }
  /// The number of times after some frames of smoke.
  std::size_t times_of(bool timed, std::uint32_t valid_bits) {
    Queries::valid_bits = valid_bits;
    is_timed_ = timed;
    make({32, 16, 32}, 0.25f);
    smoke(1, {3, 0.6f, 3}, 500, 100);
    advance(40);
    for (int frame = 0; frame < 5; ++frame) draw({1, 2, 1}, {1, -0.1f, 1}, 0.7);
    std::vector<brume_timing> timings(64);
    std::size_t count = 0;
    EXPECT_OK(brume_renderer_timings(renderer_, timings.data(), timings.size(), &count));
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_GE(timings[i].milliseconds, 0);
      EXPECT_LT(timings[i].milliseconds, 1e6);
    }
    return count;
  }
};

TEST_F(TimingsTest, AreOffByDefault) {
  EXPECT_EQ(brume_renderer_defaults().timings, 0u);
  EXPECT_EQ(times_of(false, 64), 0u);
  EXPECT_EQ(Queries::calls, 0);
}

TEST_F(TimingsTest, AreTakenWhereTheHostAsks) {
  EXPECT_GT(times_of(true, 64), 3u);
  EXPECT_GT(Queries::calls, 0);
}

TEST_F(TimingsTest, AreRightWithFewerValidBits) {
  EXPECT_GT(times_of(true, 36), 3u);
}

TEST_F(TimingsTest, AreOffWithoutTimestamps) {
  EXPECT_EQ(times_of(true, 0), 0u);
  EXPECT_EQ(Queries::calls, 0);
}

}  // namespace
}  // namespace brume::host
