// Random command lines: none crashes, hangs, changes an input, or leaves an unnamed file.
//
// BRUME_OPTION_FUZZ_RUNS sets their number, BRUME_OPTION_FUZZ_SEED the first of their seeds.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <map>
#include <random>
#include <regex>
#include <set>
#include <sstream>

#include "core/file.hpp"
#include "image/png.hpp"
#include "tests/cli/run_program.hpp"

namespace brume::cli {
namespace {

using Arguments = std::vector<std::string>;

constexpr std::uint64_t kRuns = 2000;
/// CPU time of one run [s]; a hang uses up more.
constexpr rlim_t kMostSeconds = 10;

constexpr const char* kTimeline =
    "version = 1\nscene = \"room.obj\"\nduration = 0.5\n[smoke]\nvoxels = 200\nbloom = 0.2\n"
    "[[event]]\ntype = \"smoke\"\ntime = 0.0\nfrom = [0.0, 0.5, -1.0]\nat = [0.0, 0.5, -1.0]\n"
    "[[event]]\ntype = \"shot\"\ntime = 0.1\nfrom = [0.0, 1.5, 1.0]\ntoward = [0.0, 0.5, -1.0]\n";

/// An option as --help shows it.
struct Option {
  std::string name;
  bool takes_value = false;
};

class OptionFuzz : public testing::Test {
 protected:
  OptionFuzz() {
    folder_.write("room.obj", room_obj());
    folder_.write("room.toml", kTimeline);
    folder_.write("notes.txt", "my notes\n");
    folder_.write("empty.obj", "");
    folder_.write("palette.json", "[\"#ff0000\", \"#0000ff\"]");
    folder_.write(
        "tank.toml",
        "version = 1\n[tank]\nsize = [20, 20, 10]\nspheres = 9\nsamples = 1\npalette = \"palette.json\"\n");
    const image::Image8 picture{8, 8, std::vector<std::uint8_t>(4 * 8 * 8, 200)};
    for (const char* name : {"a.png", "b.png"})
      image::save_png(folder_.path() / name, picture).value_or_throw();
    EXPECT_EQ(run_brume(folder_.path(), {"voxelize", "room.obj", "-o", "room.vxl"}).exit_code, 0);
    EXPECT_EQ(run_brume(folder_.path(), {"sim", "room.toml", "--record", "room.brp"}).exit_code, 0);
    inputs_ = contents();
    for (const char* command : {"render", "sim", "voxelize", "bake", "bake slices", "bake occlusion",
                                "bake spheres", "info", "query", "diff", "palettes", "devices"})
      options_[command] = options_of(command);
  }

  std::vector<Option> options_of(const std::string& command) const {
    const std::string help = run_brume(folder_.path(), {command, "--help"}).out;
    static const std::regex line("\n  (?:-\\w,)?(-[-\\w]+)( \\S+)?");
    std::vector<Option> options;
    for (std::sregex_iterator it(help.begin(), help.end(), line), end; it != end; ++it)
      options.push_back({(*it)[1].str(), (*it)[2].matched && (*it)[2].str().size() > 1});
    EXPECT_GT(options.size(), 3u) << help;
    return options;
  }
  std::map<std::string, std::string> contents() const {
    std::map<std::string, std::string> all;
    for (const std::string& name : folder_.files())
      if (std::filesystem::is_regular_file(folder_.path() / name))
        all[name] = *read_text_file(folder_.path() / name);
    return all;
  }
  // The exit status as wait() gives it.
  int run(Arguments arguments) const {
    const pid_t child = ::fork();
    if (child == 0) {
      const int nowhere = ::open("/dev/null", O_RDWR);
      for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, descriptor);
      const rlimit seconds{kMostSeconds, kMostSeconds + 2};
      ::setrlimit(RLIMIT_CPU, &seconds);
      arguments.insert(arguments.begin(), BRUME_PROGRAM);
      std::vector<char*> pointers;
      for (std::string& argument : arguments) pointers.push_back(argument.data());
      pointers.push_back(nullptr);
      if (::chdir(folder_.path().c_str()) == 0) ::execv(BRUME_PROGRAM, pointers.data());
      ::_exit(127);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return status;
  }
  WorkFolder folder_;
  std::map<std::string, std::string> inputs_;
  std::map<std::string, std::vector<Option>> options_;
};

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {}
  std::size_t below(std::size_t count) { return random_() % count; }
  bool once_in(std::size_t count) { return below(count) == 0; }
  template <typename List>
  std::string one_of(const List& list) {
    return list[below(std::size(list))];
  }

 private:
  std::mt19937_64 random_;
};

/// Values of every kind that some option takes, and of some that none does.
const std::vector<std::string> kValues = [] {
  std::istringstream all(
      "0|1|2|3|-1|0.5|0.25|1e9|1e-9|nan|inf|-inf|24000/1001|1/0|23.976||0,1,0|0.5,1,-0.5|1e9,0,0|"
      "nan,0,0|0, 1, 0|1,2|0,1,1.5 0,1,0 60|0,1,1.5 0,1,0|0,0,0 0,0,0 60|16x16|32x18|1x1|0x0|33x17|"
      "4x4x4|16x12x16|0x1x1|-1x1x1|0-1|1-2|2-1|0-0|9-|full|half|quarter|neutral|standard|visible|"
      "hidden|density|depth|solid|none|y=1|x=nan|60,40|60,0|room.obj|room.toml|palette.json|tank.toml|"
      "room.vxl|room.brp|a.png|b.png|notes.txt|empty.obj|missing.glb|.|..|none/x.png|-|--|new.png|"
      "new_%d.png|new.mp4|new.vxl|new.brp|new.json|new.spheres|0.5-2|coral|noise|new.obj|NEW.PNG|"
      "%s.png|100%.png|\xff\xfe|room.toml/x|/dev/null|--json|\xc3\xa9|18446744073709551616|-0|+1|0x10");
  std::vector<std::string> values;
  for (std::string value; std::getline(all, value, '|');) values.push_back(value);
  return values;
}();

Arguments random_call(Dice& dice, const std::map<std::string, std::vector<Option>>& options) {
  static const std::string inputs[] = {"room.obj", "room.toml", "room.vxl", "room.brp", "a.png"};
  auto command = options.begin();
  std::advance(command, dice.below(options.size()));
  Arguments call{command->first};
  const bool takes_file = command->first != "devices" && command->first != "bake spheres";
  const bool positional = takes_file && !dice.once_in(16);
  if (positional) call.push_back(dice.once_in(8) ? dice.one_of(kValues) : dice.one_of(inputs));
  if (command->first == "diff" && !dice.once_in(8)) call.emplace_back("b.png");
  // What makes most calls valid, so that they get far.
  if (command->first == "render" && !dice.once_in(8)) call.insert(call.end(), {"-o", "new.png"});
  if (command->first == "bake spheres" && !dice.once_in(8)) call.insert(call.end(), {"-o", "new.spheres"});
  if (command->first == "query" && !dice.once_in(8))
    call.insert(call.end(), {"--from", "0,1,1", "--to", "0,1,-1", "--time", "0.2"});
  for (std::size_t count = dice.below(4); count > 0; --count) {
    const Option& option = command->second[dice.below(command->second.size())];
    call.push_back(option.name);
    if (option.takes_value != dice.once_in(16)) call.push_back(dice.one_of(kValues));
  }
  if (dice.once_in(16)) call.push_back(dice.one_of(kValues));
  // Rendering is what takes time: small, and seldom.
  if (command->first == "render") call.insert(call.end(), {"--size", "16x16"});
  return call;
}

/// Whether a file of the folder is an output of its own kind, or of any with --force, and not also what the
/// command reads.
bool may_be_replaced(const Arguments& call, const std::string& name) {
  static const std::set<std::string> kinds{".vxl", ".brp", ".png", ".spheres"};
  const auto has = [&](const char* word) { return std::find(call.begin(), call.end(), word) != call.end(); };
  const std::size_t arguments = call[0] == "diff" ? 3 : 2;
  for (std::size_t i = 1; i < call.size(); ++i)
    if (call[i] == name && i < arguments) return false;
  // The timeline's scene.
  if (name == "room.obj" && has("room.toml")) return false;
  // An empty file may become anything.
  const bool replaceable = kinds.contains(std::filesystem::path(name).extension()) || name == "empty.obj";
  return (replaceable || has("--force")) && has(name.c_str());
}

std::uint64_t number_from(const char* variable, std::uint64_t otherwise) {
  const char* text = std::getenv(variable);
  return text ? std::strtoull(text, nullptr, 10) : otherwise;
}

TEST_F(OptionFuzz, NothingCrashesHangsOrChangesAnInput) {
  static const std::set<int> known{0, 2, 3, 4, 5, 6, 7};
  const std::uint64_t first = number_from("BRUME_OPTION_FUZZ_SEED", 1);
  const std::uint64_t runs = number_from("BRUME_OPTION_FUZZ_RUNS", kRuns);
  for (std::uint64_t seed = first; seed < first + runs; ++seed) {
    Dice dice(seed);
    const Arguments call = random_call(dice, options_);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + testing::PrintToString(call));
    const int status = run(call);
    EXPECT_TRUE(WIFEXITED(status) && known.contains(WEXITSTATUS(status)))
        << (WIFSIGNALED(status) ? "signal " : "exit code ")
        << (WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status));

    // Inputs are the same; new files have names that were given.
    const auto now = contents();
    for (const auto& [name, bytes] : inputs_) {
      ASSERT_TRUE(now.contains(name)) << name << " is gone";
      EXPECT_TRUE(now.at(name) == bytes || may_be_replaced(call, name)) << name << " has changed";
      if (now.at(name) != bytes) folder_.write(name, bytes);
    }
    for (const auto& [name, bytes] : now) {
      if (inputs_.contains(name)) continue;
      EXPECT_EQ(name.find("brume-part"), std::string::npos) << name << " is left behind";
      std::filesystem::remove(folder_.path() / name);
    }
    if (testing::Test::HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace brume::cli
