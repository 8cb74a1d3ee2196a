#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <barrier>
#include <filesystem>
#include <limits>
#include <memory>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/checked.hpp"
#include "core/file.hpp"
#include "core/hash.hpp"
#include "core/key.hpp"
#include "core/progress.hpp"
#include "core/similar.hpp"
#include "core/tasks.hpp"
#include "core/utf8.hpp"
#include "tests/work_folder.hpp"

namespace brume {
namespace {

class FileTest : public testing::Test {
 protected:
  std::size_t files() const { return work_folder_.files().size(); }
  const cli::WorkFolder work_folder_;
  const std::filesystem::path folder_ = work_folder_.path();
};

TEST_F(FileTest, WritesAndReadsBack) {
  ASSERT_TRUE(write_file_atomic(folder_ / "a", std::string("hello")));
  EXPECT_EQ(*read_text_file(folder_ / "a"), "hello");
  EXPECT_EQ(files(), 1u);
}

TEST_F(FileTest, LeavesNoFileWithoutCommit) {
  {
    auto file = AtomicFile::open(folder_ / "a");
    ASSERT_TRUE(file);
    ASSERT_TRUE(file->write(std::as_bytes(std::span("xyz"))));
  }
  EXPECT_EQ(files(), 0u);
}

TEST_F(FileTest, KeepsTheOldFileUntilCommit) {
  ASSERT_TRUE(write_file_atomic(folder_ / "a", std::string("old")));
  auto file = AtomicFile::open(folder_ / "a");
  ASSERT_TRUE(file->write(std::as_bytes(std::span("new", 3))));
  EXPECT_EQ(*read_text_file(folder_ / "a"), "old");
  ASSERT_TRUE(file->commit());
  EXPECT_EQ(*read_text_file(folder_ / "a"), "new");
}

TEST_F(FileTest, NamesTheMissingFolder) {
  const auto result = write_file_atomic(folder_ / "none" / "a", std::string("x"));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.failure().code, ErrorCode::bad_input);
  EXPECT_NE(result.failure().message.find("does not exist"), std::string::npos);
}

TEST_F(FileTest, RejectsAFolderAndALongFile) {
  EXPECT_EQ(read_text_file(folder_).failure().code, ErrorCode::bad_input);
  EXPECT_EQ(read_text_file(folder_ / "missing").failure().code, ErrorCode::bad_input);
  ASSERT_TRUE(write_file_atomic(folder_ / "a", std::string(100, 'x')));
  EXPECT_EQ(read_text_file(folder_ / "a", 99).failure().code, ErrorCode::resource_limit);
}

TEST(Checked, DetectsOverflow) {
  EXPECT_EQ(checked_mul(1u << 20, 1u << 20), 1ull << 40);
  EXPECT_FALSE(checked_mul(1ull << 32, 1ull << 32));
  EXPECT_FALSE(checked_mul(1ull << 30, 1ull << 30, 1ull << 30));
  EXPECT_FALSE(checked_add(std::numeric_limits<std::uint64_t>::max(), 1));
}

TEST(Tasks, RunsEveryIndexOnce) {
  for (const unsigned threads : {1u, 2u, 7u}) {
    set_thread_count(threads);
    std::vector<std::atomic<int>> hits(1001);
    parallel_for(hits.size(), 13, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) ++hits[i];
    });
    for (const auto& hit : hits) EXPECT_EQ(hit, 1);
  }
  set_thread_count(0);
}

TEST(Tasks, ScopesSetTheNumberOfThreadsOfTheirThreadAndItsHelpers) {
  const unsigned before = thread_count();
  {
    const TaskScope scope(3, nullptr);
    EXPECT_EQ(thread_count(), 3u);
    std::jthread([&] { EXPECT_EQ(thread_count(), before); });
    parallel_for(20, 1, [&](std::size_t, std::size_t) { EXPECT_EQ(thread_count(), 3u); });
    const TaskScope inner(0, nullptr);
    EXPECT_EQ(thread_count(), 3u);
  }
  EXPECT_EQ(thread_count(), before);
}

/// Runs jobs in threads that it starts, or none.
class TestRunner : public TaskRunner, public std::enable_shared_from_this<TestRunner> {
 public:
  explicit TestRunner(bool refuses = false) : refuses_(refuses) {}
  bool run(void (*job)(void*), void* data, unsigned count) override {
    if (refuses_) return false;
    ++runs;
    most = std::max(most, count);
    std::vector<std::jthread> threads;
    for (unsigned i = 0; i < count; ++i) threads.emplace_back(job, data);
    return true;
  }
  std::shared_ptr<TaskRunner> share() override { return shared_from_this(); }

  int runs = 0;
  unsigned most = 0;

 private:
  bool refuses_;
};

TEST(Tasks, ARunnerRunsLoopsAndInItsJobsTheyRunAlone) {
  const auto runner = std::make_shared<TestRunner>();
  const TaskScope scope({4, runner});
  std::array<std::atomic<int>, 100> visits{};
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<int> by_jobs = 0;
  parallel_for(10, 1, [&](std::size_t begin, std::size_t) {
    if (std::this_thread::get_id() != caller) {
      ++by_jobs;
      EXPECT_EQ(thread_count(), 1u);
    }
    parallel_for(10, 1, [&](std::size_t inner, std::size_t) { ++visits[10 * begin + inner]; });
  });
  for (const std::atomic<int>& each : visits) EXPECT_EQ(each, 1);
  EXPECT_EQ(by_jobs, 10) << "all ranges are done when the runner returns";
  EXPECT_EQ(runner->runs, 1);
  EXPECT_EQ(runner->most, 4u);
  EXPECT_EQ(task_settings().runner, runner);
  EXPECT_EQ(task_settings().thread_count, 4u);
}

TEST(Tasks, WhatARunnerLeavesIsDoneByTheCaller) {
  class Idle : public TestRunner {
    bool run(void (*)(void*), void*, unsigned) override { return true; }
  };
  std::atomic<int> sum = 0;
  const auto count = [&](const std::shared_ptr<TaskRunner>& runner) {
    const TaskScope scope({4, runner});
    parallel_for(100, 1, [&](std::size_t begin, std::size_t) { sum += static_cast<int>(begin); });
    return sum.exchange(0);
  };
  EXPECT_EQ(count(std::make_shared<Idle>()), 4950);
  EXPECT_EQ(count(std::make_shared<TestRunner>(true)), 4950);
}

TEST(Tasks, AFailureInAJobIsRethrown) {
  const auto runner = std::make_shared<TestRunner>();
  const TaskScope scope({3, runner});
  EXPECT_THROW(parallel_for(100, 1, [](std::size_t, std::size_t) { throw std::runtime_error("each"); }),
               std::runtime_error);
}

TEST(Tasks, PropagatesExceptions) {
  EXPECT_THROW(parallel_for(100, 1,
                            [](std::size_t begin, std::size_t) {
                              if (begin == 50) throw std::runtime_error("fifty");
                            }),
               std::runtime_error);
}

// Under the thread sanitizer this fails unless threads store their failure under a lock.
TEST(Tasks, OneOfSeveralFailuresAtOnceIsPropagated) {
  constexpr std::ptrdiff_t kThreads = 4;
  const TaskScope scope(kThreads, nullptr);
  std::barrier all_run(kThreads);
  EXPECT_THROW(parallel_for(kThreads, 1,
                            [&](std::size_t, std::size_t) {
                              all_run.arrive_and_wait();
                              throw std::runtime_error("each");
                            }),
               std::runtime_error);
}

TEST(Tasks, AcceptsNoWork) {
  parallel_for(0, 0, [](std::size_t, std::size_t) { FAIL(); });
}

TEST(Progress, ReportsRateAndRemainingTime) {
  const Progress::State state{"frames", 30, 120, 10.0};
  EXPECT_DOUBLE_EQ(state.seconds_left(), 30.0);
  EXPECT_EQ(progress_line(state, 60), "frames     [######..................] 30/120  3/s  30 s left");
  EXPECT_LT((Progress::State{"x", 0, 10, 0}.seconds_left()), 0);
  EXPECT_EQ(progress_line({"load", 0, 0, 12.4}, 60), "load       12 s");
  EXPECT_EQ(progress_line({"load", 0, 0, 6e10 + 7}, 60), "load       1000000000 min 07 s");
}

TEST(Progress, LinesFillTheWidthAndNeverExceedIt) {
  for (std::size_t width = 0; width < 200; ++width) {
    const std::string line = progress_line({"frames", 30, 120, 400.0}, width);
    EXPECT_LE(line.size(), width);
    EXPECT_TRUE(width < 60 || line.size() == width) << width;
  }
}

TEST(Progress, IsALineOfJson) {
  EXPECT_EQ(progress_json({"frames", 30, 120, 10.0}),
            R"({"progress": {"name": "frames", "done": 30, "total": 120, "rate": 3, "seconds_left": 30}})");
  EXPECT_EQ(progress_json({"load", 0, 0, 12.5}),
            R"({"progress": {"name": "load", "done": 0, "total": null, "rate": 0, "seconds_left": null}})");
  EXPECT_EQ(
      progress_json({"read \"a\\b\n\xff.vdb", 0, 3, 0, "error 2 %"}),
      R"({"progress": {"name": "read \"a\\b??.vdb", "done": 0, "total": 3, "rate": 0, "seconds_left": null)"
      R"(, "detail": "error 2 %"}})");
}

TEST(Progress, ShowsTheInnermostJobThatHasRunForLong) {
  EXPECT_FALSE(progress_to_show(0));
  Progress outer("outer", 10);
  outer.advance(3);
  EXPECT_EQ(progress_to_show(0)->name, "outer");
  EXPECT_EQ(progress_to_show(0)->done, 3u);
  {
    const Progress inner("inner", 5), uncounted("uncounted");
    EXPECT_EQ(progress_to_show(0)->name, "inner");
    EXPECT_FALSE(progress_to_show(1e6)) << "none has run for that long";
  }
  EXPECT_EQ(progress_to_show(0)->name, "outer");
}

TEST(Progress, DetailsMayBeReadWhileTheyChange) {
  Progress job("job", 10);
  std::atomic<bool> done{false};
  std::atomic<int> reads{0};
  std::jthread reader([&] {
    while (!done) {
      const auto shown = progress_to_show(0);
      EXPECT_TRUE(shown && (shown->detail.empty() || shown->detail == std::string(40, shown->detail[0])));
      ++reads;
    }
  });
  for (int i = 0; reads < 100; ++i) job.set_detail(std::string(40, static_cast<char>('a' + i % 26)));
  done = true;
}

TEST(SimilarName, EditDistance) {
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("same", "same"), 0u);
  EXPECT_EQ(edit_distance("tiem", "time"), 1u);
}

TEST(SimilarName, IsOfferedOnlyWhenNear) {
  const std::vector<std::string> keys{"time", "from", "smoke", "render", "light-update-fraction"};
  EXPECT_EQ(similar_name("tiem", keys), "time");
  EXPECT_EQ(similar_name("item", keys), std::nullopt) << "half of it differs";
  EXPECT_EQ(similar_name("tim", keys), "time");
  EXPECT_EQ(similar_name("Smoke", keys), "smoke");
  EXPECT_EQ(similar_name("rendr", keys), "render");
  EXPECT_EQ(similar_name("light", keys), "light-update-fraction");
  EXPECT_EQ(similar_name("radius", keys), std::nullopt);
  EXPECT_EQ(similar_name("x", keys), std::nullopt);
  EXPECT_EQ(suggestion("tim", keys, "'"), "; did you mean 'time'?");
  EXPECT_EQ(suggestion("radius", std::vector<std::string>{"a", "b"}, ""), "; expected one of a, b");
  std::vector<std::string> many(13, "abcdefgh");
  EXPECT_EQ(suggestion("radius", many, ""), "");
  for (const char* name : {"door_leaf", "Frame_front_door", "frontage"}) many.push_back(name);
  EXPECT_EQ(suggestion("front door", many, "'"), "; did you mean 'Frame_front_door'?") << "both words";
  EXPECT_EQ(suggestion("the door", many, "'"), "; did you mean one of 'door_leaf', 'Frame_front_door'?");
}

TEST(Utf8, MatchesTheStandard) {
  for (const char* good : {"", "plain", "\xc3\xa9", "\xe6\xbc\xa2 \xf0\x9f\x92\xa8", "\xf4\x8f\xbf\xbf"})
    EXPECT_TRUE(is_utf8(good)) << good;
  // A stray continuation byte, a lone lead byte, a truncated sequence, an overlong form, a surrogate, beyond
  // U+10FFFF.
  for (const char* bad :
       {"\x80", "\xc3", "a\xe6\xbc", "\xc0\xaf", "\xe0\x80\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xff"})
    EXPECT_FALSE(is_utf8(bad)) << bad;
  std::string_view text = "\xc3\xa9z";
  EXPECT_EQ(take_character(text), U'\u00e9');
  EXPECT_EQ(text, "z");
}

TEST(Utf8, CharactersAreAppendedAsTheyAreTaken) {
  for (const char32_t character :
       {U'\0', U'A', U'\x7f', U'\x80', U'\x7ff', U'\x800', U'\xffff', U'\x10000', U'\x1f600', U'\x10ffff'}) {
    std::string text = "a";
    append_utf8(text, character);
    std::string_view rest = std::string_view(text).substr(1);
    EXPECT_EQ(take_character(rest), character);
    EXPECT_TRUE(rest.empty());
  }
}

TEST(Utf8, LongTextsAreShortenedToWholeCharacters) {
  EXPECT_EQ(shortened("abcd", 4), "abcd");
  EXPECT_EQ(shortened("abcde", 4), "abcd...");
  EXPECT_EQ(shortened("ab\xc3\xa4"
                      "c",
                      3),
            "ab...");
  EXPECT_EQ(shortened("ab\xc3\xa4"
                      "c",
                      4),
            "ab\xc3\xa4...");
  EXPECT_EQ(shortened("\x80\x80\x80", 2), "...") << "no text at all";
}

TEST(Hash, DependsOnBytesAndSeed) {
  const std::vector<std::uint32_t> a{1, 2, 3}, b{1, 2, 4};
  EXPECT_NE(hash_values<std::uint32_t>(a), hash_values<std::uint32_t>(b));
  EXPECT_NE(hash_values<std::uint32_t>(a), hash_values<std::uint32_t>(a, 1));
}

TEST(Key, TellsListsApart) {
  const auto digest = [](const std::vector<std::string>& values) {
    KeyHasher hasher;
    for (const std::string& value : values) hasher.add(value);
    return hasher.digest();
  };
  // Where one value ends and the next begins counts.
  const std::vector<std::vector<std::string>> lists{{},         {""},       {"", ""}, {"ab"},
                                                    {"a", "b"}, {"ab", ""}, {"ba"}};
  std::set<std::string> digests;
  for (const auto& list : lists) {
    EXPECT_EQ(digest(list), digest(list));
    EXPECT_EQ(digest(list).size(), 32u);
    digests.insert(digest(list));
  }
  EXPECT_EQ(digests.size(), lists.size());
}

TEST_F(FileTest, KeysOfFilesAreThoseOfTheirContents) {
  // Longer than one part, and no multiple of it.
  std::string text(3'000'001, 'a');
  text.back() = 'b';
  ASSERT_TRUE(write_file_atomic(folder_ / "a", text));
  KeyHasher of_text, of_file, missing;
  of_text.add(text);
  std::size_t parts = 0;
  ASSERT_TRUE(of_file.add_file(folder_ / "a", [&] { ++parts; }));
  EXPECT_EQ(of_file.digest(), of_text.digest());
  EXPECT_GT(parts, 1u);
  EXPECT_FALSE(missing.add_file(folder_ / "b"));
  EXPECT_FALSE(missing.add_file(folder_));
}

}  // namespace
}  // namespace brume
