// Hostile arguments never crash the C interface.
#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "core/file.hpp"
#include "tests/api/hostile.hpp"
#include "tests/sanitized.hpp"
#include "tests/thorough.hpp"

namespace brume::api {
namespace {

const std::uint64_t kCalls = is_thorough("calls") ? 1'000'000 : kSanitized ? 8'000 : 60'000;

TEST(Hostile, ArgumentsGiveResultsInEveryFunction) {
  Hostile hostile(1);
  hostile.run(kCalls);
  EXPECT_GE(hostile.calls(), kCalls);

  // Every function succeeded and failed, but for those that do not fail.
  std::set<std::string> listed;
  std::istringstream list(*read_text_file(BRUME_SOURCE_DIR "/tests/api/symbols.txt"));
  for (std::string name; list >> name;)
    if (name != "brume_last_error" && name != "brume_result_name") listed.insert(name);
  std::set<std::string> called;
  for (const auto& [function, results] : hostile.results()) {
    called.insert(function);
    if (kSanitized) continue;
    EXPECT_TRUE(results.contains(BRUME_OK)) << function;
    EXPECT_TRUE(results.size() > 1 || function == "brume_version") << function;
  }
  EXPECT_EQ(called, listed);
}

}  // namespace
}  // namespace brume::api
