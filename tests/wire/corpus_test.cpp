// Runs the corpus of the fuzzers in every test run.
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

#include "core/file.hpp"
#include "fuzz/wire_checks.hpp"

namespace brume::wire {
namespace {

// A failed check aborts the program.
void replay_corpus(const std::string& name, const std::function<void(Input)>& check) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(BRUME_SOURCE_DIR "/fuzz/corpus/" + name)) {
    const auto bytes = read_file(entry.path());
    ASSERT_TRUE(bytes) << entry.path();
    SCOPED_TRACE(entry.path());
    check(*bytes);
    ++files;
  }
  EXPECT_GT(files, 0) << name;
}

TEST(Corpus, Packets) {
  replay_corpus("wire", check_packets);
}
TEST(Corpus, Replays) {
  replay_corpus("replay", check_replay);
}
TEST(Corpus, EventLogs) {
  replay_corpus("event_log", check_event_log);
}

}  // namespace
}  // namespace brume::wire
