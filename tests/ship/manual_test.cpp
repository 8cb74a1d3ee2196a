// The manual pages and completions that the build writes name every option of every command.
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <regex>
#include <sstream>

#include "core/file.hpp"
#include "tests/cli/run_program.hpp"

namespace brume::cli {
namespace {

namespace fs = std::filesystem;

const fs::path kManual = BRUME_BUILD_DIR "/manual";

std::vector<std::string> words_of(const std::string& command) {
  std::istringstream words(command);
  return {std::istream_iterator<std::string>(words), {}};
}

/// The names of all options by command, as --help shows them.
std::map<std::string, std::vector<std::string>> options_in_help() {
  const WorkFolder folder;
  const std::string help = run_brume(folder.path(), {"--help"}).out;
  std::istringstream lines(help.substr(help.find("Commands:\n") + 10));
  std::map<std::string, std::vector<std::string>> options;
  for (std::string line; std::getline(lines, line);) {
    if (line.size() < 4 || line.rfind("  ", 0) != 0 || line[2] == ' ') continue;
    const std::string command = line.substr(2, line.find("  ", 2) - 2);
    std::vector<std::string> words = words_of(command);
    words.emplace_back("--help");
    const std::string text = run_brume(folder.path(), words).out;
    static const std::regex name("\n  ((?:-[A-Za-z],)?--[-a-z0-9]+)");
    for (std::sregex_iterator it(text.begin(), text.end(), name), end; it != end; ++it)
      for (std::string names = (*it)[1]; !names.empty();) {
        const std::size_t comma = names.find(',');
        options[command].push_back(names.substr(0, comma));
        names = comma == names.npos ? "" : names.substr(comma + 1);
      }
  }
  return options;
}

std::string page_of(std::string command) {
  std::replace(command.begin(), command.end(), ' ', '-');
  return "man1/brume-" + command + ".1";
}

TEST(Manual, NamesEveryOptionOfEveryCommand) {
  const auto options = options_in_help();
  EXPECT_GE(options.size(), 15u);
  const std::string bash = *read_text_file(kManual / "brume.bash"), zsh = *read_text_file(kManual / "_brume"),
                    fish = *read_text_file(kManual / "brume.fish"),
                    all = *read_text_file(kManual / "man1/brume.1");
  for (const auto& [command, names] : options) {
    SCOPED_TRACE(command);
    EXPECT_NE(all.find("\\fBbrume " + command + "\\fR\n"), std::string::npos);
    const std::string page = *read_text_file(kManual / page_of(command));
    const std::size_t at = bash.find("    '" + command + "') echo '-");
    const std::string bash_line = bash.substr(at, bash.find('\n', at) - at) + " ";
    const std::size_t begin = zsh.find("    '" + command + "')\n");
    const std::string zsh_part = zsh.substr(begin, zsh.find(";;", begin) - begin);
    EXPECT_GE(names.size(), 5u);
    for (const std::string& name : names) {
      const std::string escaped = std::regex_replace("\\fB" + name + "\\fR", std::regex("-"), "\\-");
      EXPECT_NE(page.find(escaped), std::string::npos) << name;
      EXPECT_TRUE(std::regex_search(bash_line, std::regex("[ ']" + name + "[ ']"))) << name;
      EXPECT_TRUE(std::regex_search(zsh_part, std::regex("[)*]" + name + "\\["))) << name;
      const bool is_long = name.starts_with("--");
      EXPECT_TRUE(
          std::regex_search(fish, std::regex("__brume_in \"" + command + "\"'[^\n]* -" +
                                             (is_long ? "l " : "s ") + name.substr(is_long ? 2 : 1) + " ")))
          << name;
    }
  }
}

TEST(Manual, IsFormattedWithoutAWarning) {
  if (std::system("command -v man > /dev/null") != 0) GTEST_SKIP() << "no man";
  const WorkFolder folder;
  const std::string log = (folder.path() / "log").string();
  int pages = 0;
  for (const auto& entry : fs::directory_iterator(kManual / "man1")) {
    EXPECT_EQ(std::system(("LC_ALL=C.UTF-8 MANWIDTH=80 man --warnings -E UTF-8 -l '" + entry.path().string() +
                           "' > /dev/null 2> '" + log + "'")
                              .c_str()),
              0);
    EXPECT_EQ(*read_text_file(log), "") << entry.path();
    ++pages;
  }
  EXPECT_GE(pages, 16);
}

TEST(Completion, ShellsAcceptTheirFiles) {
  for (const char* check :
       {"bash -n '%s/brume.bash'", "zsh -n '%s/_brume'", "fish --no-execute '%s/brume.fish'"}) {
    const std::string text = check, shell = text.substr(0, text.find(' '));
    if (std::system(("command -v " + shell + " > /dev/null").c_str()) != 0) continue;
    EXPECT_EQ(std::system(std::regex_replace(text, std::regex("%s"), kManual.string()).c_str()), 0) << shell;
  }
}

TEST(Completion, FishCompletesOptionsAndChoices) {
  if (std::system("command -v fish > /dev/null") != 0) GTEST_SKIP() << "no fish";
  const WorkFolder folder;
  const auto completions = [&](const std::string& line) {
    const std::string out = (folder.path() / "out").string();
    const std::string command = "HOME='" + folder.path().string() + "' fish -N -c \"source '" +
                                (kManual / "brume.fish").string() + "'; complete -C '" + line +
                                "'\" | cut -f 1 > '" + out + "'";
    EXPECT_EQ(std::system(command.c_str()), 0) << line;
    return *read_text_file(out);
  };
  EXPECT_EQ(completions("brume ren"), "render\n");
  EXPECT_EQ(completions("brume render --marc"), "--march\n");
  EXPECT_EQ(completions("brume render --march q"), "quarter\n");
  EXPECT_EQ(completions("brume bake sl"), "slab\nslices\n");
  EXPECT_EQ(completions("brume bake slices --pres"), "--preset\n");
}

// What bash completes a command line to: words, the last of which is begun.
std::string completions(const WorkFolder& folder, const std::string& words) {
  const std::string script = "PATH='" + fs::path(BRUME_PROGRAM).parent_path().string() +
                             "':$PATH; source '" BRUME_BUILD_DIR "/manual/brume.bash'; COMP_WORDS=(" + words +
                             "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _brume; echo \"${COMPREPLY[*]}\"";
  folder.write("complete.sh", script);
  const std::string out = (folder.path() / "out").string();
  const std::string command = "cd '" + folder.path().string() + "' && bash complete.sh > '" + out + "' 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << words;
  return *read_text_file(out);
}

TEST(Completion, BashCompletesCommandsOfOneAndTwoWords) {
  const WorkFolder folder;
  folder.write("slices.glb", "");
  EXPECT_EQ(completions(folder, "brume b"), "bake bench\n");
  EXPECT_EQ(completions(folder, "brume bake ''"), "slices occlusion spheres pyroclastic sphere slab torus\n");
  EXPECT_EQ(completions(folder, "brume bake sl"), "slices slab\n");
  EXPECT_EQ(completions(folder, "brume bake slices sl"), "slices.glb\n");
  EXPECT_EQ(completions(folder, "brume bake slices --p"), "--progress --padding --preset\n");
  EXPECT_EQ(completions(folder, "brume bake slices slices.glb -o a.png --ch"), "--channels\n");
  EXPECT_EQ(completions(folder, "brume bake occlusion --fall"), "--falloff\n");
  EXPECT_EQ(completions(folder, "brume bake sphere --rad"), "--radius\n");
  EXPECT_EQ(completions(folder, "brume render sl"), "slices.glb\n");
  EXPECT_EQ(completions(folder, "brume help bake o"), "occlusion\n");
}

TEST(Completion, BashCompletesChoices) {
  const WorkFolder folder;
  EXPECT_EQ(completions(folder, "brume ren"), "render\n");
  EXPECT_EQ(completions(folder, "brume -"), "-V --version -h --help\n");
  EXPECT_EQ(completions(folder, "brume render --ma"), "--max-bounces --matte --march\n");
  EXPECT_EQ(completions(folder, "brume render --march ''"), "full half quarter\n");
  EXPECT_EQ(completions(folder, "brume render --march q"), "quarter\n");
}

}  // namespace
}  // namespace brume::cli
