// No test program grows unnoticed.
#include "tests/house/budgets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "core/file.hpp"
#include "tests/work_folder.hpp"

namespace brume::house {
namespace {

namespace fs = std::filesystem;

TEST(Budgets, AreLinesOfANameAndSeconds) {
  EXPECT_EQ(parse_budgets("# why 3\nsim_tests 12\n\nrender_tests  40\n"),
            (Seconds{{"sim_tests", 12}, {"render_tests", 40}}));
}

TEST(Budgets, AreComparedByTheSlowerKindOfProgram) {
  EXPECT_EQ(cpu_programs("a a core cpu,threads 1 core\nb b gpu gpu 9 core,gpu\nc c sim cpu 3 core,sim\n"),
            (std::set<std::string>{"a", "c"}));
  // What a driver has in its cache takes less, and says nothing about the others.
  const Seconds budgets{{"a", 10}, {"b", 20}, {"c", 30}, {"d", 40}, {"e", 50}};
  const Seconds taken{{"a", 10}, {"b", 20}, {"c", 3}, {"d", 4}, {"e", 5}};
  EXPECT_EQ(pace_of(taken, budgets, {"a", "b"}), 1);
  EXPECT_EQ(pace_of({}, budgets, {"a", "b"}), 0);
  // A machine may run a driver's code twice as slowly as it does other code, or the other way round.
  EXPECT_EQ(pace_of({{"a", 10}, {"b", 20}, {"c", 60}, {"d", 80}, {"e", 100}}, budgets, {"a", "b"}), 2);
  EXPECT_EQ(pace_of({{"a", 20}, {"b", 40}, {"c", 30}, {"d", 40}, {"e", 50}}, budgets, {"a", "b"}), 2);
}

TEST(Budgets, HoldOnFastAndSlowMachines) {
  const Seconds budgets{{"a", 10}, {"b", 20}, {"c", 40}, {"d", 2}};
  const std::set<std::string> all{"a", "b", "c", "d", "short"};
  for (const double pace : {1.0 / 3, 1.0, 3.0}) {
    Seconds taken;
    for (const auto& [name, seconds] : budgets) taken[name] = pace * seconds;
    taken["short"] = pace;  // one second, as it is not listed
    ASSERT_DOUBLE_EQ(pace_of(taken, budgets, all), pace);
    EXPECT_TRUE(over_budget(taken, budgets, pace).empty());
    // One that grew by three quarters is found, however fast the machine is; by a third it may grow.
    taken["b"] = pace * 20 * 1.75;
    const auto over = over_budget(taken, budgets, pace_of(taken, budgets, all));
    ASSERT_EQ(over.size(), 1u);
    EXPECT_EQ(over[0].rfind("b took ", 0), 0u) << over[0];
    taken["b"] = pace * 20 * 4 / 3;
    EXPECT_TRUE(over_budget(taken, budgets, pace_of(taken, budgets, all)).empty());
  }
}

Seconds times_in(const fs::path& folder) {
  Seconds taken;
  for (const auto& file : fs::directory_iterator(folder)) {
    const std::string name = file.path().filename();
    if (!name.ends_with("_slow")) taken[name] = std::stod(*read_text_file(file.path()));
  }
  return taken;
}

// The CPU seconds of a program with the machine to itself. The driver's cache is that of the run: an empty
// one would cost a program what others of the run have paid for it.
double measured_alone(const std::string& name) {
  const cli::WorkFolder folder;
  const std::string times = folder.path() / "times", log = folder.path() / "log";
  fs::create_directory(times);
  const std::string command = "env -u GTEST_OUTPUT BRUME_TIMES=" + times +
                              " ctest --test-dir " BRUME_BUILD_DIR " -R '^" + name + "$' > " + log + " 2>&1";
  if (std::system(command.c_str()) != 0) ADD_FAILURE() << name << " fails: " << *read_text_file(log);
  const Seconds taken = times_in(times);
  return taken.contains(name) ? taken.at(name) : HUGE_VAL;
}

TEST(Budgets, CountTheLeastOfThreeMeasurements) {
  const Seconds budgets{{"a", 10}, {"b", 10}, {"c", 10}};
  std::vector<std::string> measured;
  const auto busy_once = [&](const std::string& name) {
    measured.push_back(name);
    return name == "b" ? 30.0 : measured.size() == 1 ? 25.0 : 9.0;
  };
  const auto over = over_budget_again({{"a", 20}, {"b", 20}, {"c", 15}}, budgets, 1, busy_once);
  ASSERT_EQ(over.size(), 1u);
  EXPECT_EQ(over[0].rfind("b took 20.0 ", 0), 0u) << over[0];
  EXPECT_EQ(measured, (std::vector<std::string>{"a", "b", "a", "b"}));
}

// Comes after all other tests of the run (tests/house/CMakeLists.txt).
TEST(Budgets, NoProgramTakesHalfAsMuchAgain) {
  const char* folder = std::getenv("BRUME_TIMES");
  if (folder == nullptr) GTEST_SKIP() << "script/test measures the programs";
  const Seconds taken = times_in(folder);
  const Seconds budgets = parse_budgets(*read_text_file(BRUME_SOURCE_DIR "/tests/budgets.txt"));
  const double pace = pace_of(taken, budgets, cpu_programs(*read_text_file(BRUME_BUILD_DIR "/tests.txt")));
  if (pace == 0) GTEST_SKIP() << "too few programs ran";
  for (const std::string& line : over_budget_again(taken, budgets, pace, measured_alone))
    ADD_FAILURE() << line;
}

}  // namespace
}  // namespace brume::house
