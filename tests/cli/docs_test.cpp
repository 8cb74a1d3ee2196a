// The commands in the documents and in --help run as written.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <regex>
#include <set>
#include <sstream>

#include "apps/cli/demo_picture.hpp"
#include "core/file.hpp"
#include "image/png.hpp"
#include "tests/cli/run_program.hpp"
#ifdef BRUME_VIEWER
#include "tests/viewer/desktop.hpp"
#endif

namespace brume::cli {
namespace {

using Arguments = std::vector<std::string>;

// Splits a simple command as a shell does: words, "double quotes", and # to the end of the line.
Arguments words_of(const std::string& line) {
  Arguments words;
  static const std::regex word("\"([^\"]*)\"|(#.*)|(\\S+)");
  for (std::sregex_iterator it(line.begin(), line.end(), word), end; it != end; ++it) {
    if ((*it)[2].matched) break;
    words.push_back((*it)[1].matched ? (*it)[1].str() : (*it)[3].str());
  }
  return words;
}

// The arguments of every line that runs the program.
std::vector<Arguments> calls_in(const std::string& text) {
  std::vector<Arguments> calls;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    Arguments words = words_of(line);
    if (words.empty() || (words[0] != "brume" && words[0] != "build/release/brume")) continue;
    calls.emplace_back(words.begin() + 1, words.end());
  }
  return calls;
}

// The ```sh blocks of a Markdown text, lines joined where they end in a backslash.
std::string shell_blocks(const std::string& markdown) {
  std::string blocks, line;
  bool inside = false;
  std::istringstream lines(markdown);
  while (std::getline(lines, line)) {
    if (line.rfind("```", 0) == 0) {
      inside = !inside && line == "```sh";
    } else if (inside && !line.empty() && line.back() == '\\') {
      blocks += line.substr(0, line.size() - 1);
    } else if (inside) {
      blocks += line + "\n";
    }
  }
  return blocks;
}

// A folder with the files that documents mention: the scene of the demo under any name, and its voxels.
class Documents : public testing::Test {
 protected:
  Documents() {
    std::filesystem::create_directory_symlink(BRUME_SOURCE_DIR "/scenes", folder_.path() / "scenes");
    folder_.write("room.obj", room_obj());
    EXPECT_EQ(run_brume(folder_.path(), {"voxelize", "room.obj", "-o", "room.vxl"}).exit_code, 0);
  }
  void provide(const std::string& word) const {
    const std::filesystem::path path = folder_.path() / word;
    if (std::filesystem::path(word).is_absolute() || std::filesystem::exists(path)) return;
    std::filesystem::create_directories(path.parent_path());
    if (path.extension() == ".glb")
      std::filesystem::create_symlink(BRUME_SOURCE_DIR "/scenes/demo.glb", path);
    if (path.extension() == ".obj") folder_.write(word, room_obj());
    if (path.extension() == ".vdb" || path.extension() == ".json") provide_volume(word);
    if (path.extension() == ".png") {
      const image::Image8 picture{
          32, 18, std::vector<std::uint8_t>(4 * 32 * 18, 255)};  // the size that render is called with
      image::save_png(path, picture).value_or_throw();
    }
  }
  // A grid "density" of 2 x 2 x 2 voxels.
  void provide_volume(const std::string& word) const {
    folder_.write("volume.json",
                  R"({"format": "brume raw volume", "version": 1, "raw": "volume.raw", "size": [2, 2, 2]})");
    folder_.write("volume.raw", std::string(32, '?'));
    const Outcome made = run_brume(folder_.path(), {"convert", "volume.json", word});
    EXPECT_EQ(made.exit_code, 0) << made.error;
  }
  // Runs a command with few pixels and frames. `demo` and `bench` take minutes and are run by scripts.
  void expect_works(const std::string& source, Arguments call) {
    SCOPED_TRACE(source + ": brume " + testing::PrintToString(call));
    if (!run_.insert(call).second) return;
    if (call.empty() || call[0] == "demo" || call[0] == "bench") return;
    if (call.size() > 1) provide(call[1]);
    if (call[0] == "diff" && call.size() > 2) provide(call[2]);
    RunOptions options;
    if (call[0] == "view") {
#ifdef BRUME_VIEWER
      if (!desktop_) desktop_.emplace();
      options.environment = {{ "DISPLAY", desktop_->name() }};
      call.insert(call.end(), {"--size", "64x40", "--quality", "smallest", "--exit-after", "0.05"});
#else
      return;
#endif
    }
    if (call[0] == "render") {
      call.insert(call.end(), {"--size", "32x18"});
      const bool film = std::any_of(call.begin(), call.end(), [](const std::string& word) {
        return word.ends_with(".mp4") || word.find('%') != std::string::npos;
      });
      if (film) call.insert(call.end(), {"--frames", "0-1"});
    }
    const Outcome run = run_brume(folder_.path(), call, options);
    EXPECT_EQ(run.exit_code, 0) << run.error;
  }
  WorkFolder folder_;
  std::set<Arguments> run_;  ///< Some commands stand on several pages.
#ifdef BRUME_VIEWER
  std::optional<viewer::Desktop> desktop_;  ///< For `brume view`.
#endif
};

TEST_F(Documents, CommandsRun) {
  std::size_t count = 0;
  std::vector<std::filesystem::path> pages;
  for (const char* folder : {BRUME_SOURCE_DIR, BRUME_SOURCE_DIR "/docs"}) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().extension() == ".md") pages.push_back(entry.path());
    }
  }
  for (const auto& page : pages) {
    for (const Arguments& call : calls_in(shell_blocks(*read_text_file(page)))) {
      expect_works(page.filename().string(), call);
      ++count;
    }
  }
  EXPECT_GT(count, 0u);
}

TEST_F(Documents, ExamplesOfTheHelpRun) {
  const Outcome help = run_brume(folder_.path(), {"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_EQ(help.error, "");
  std::vector<std::string> commands{"demo",  "render", "voxelize", "bake",  "info", "convert",
                                    "query", "diff",   "devices",  "bench", "sim"};
#ifdef BRUME_VIEWER
  commands.push_back("view");
#endif
  for (const std::string& command : commands) {
    EXPECT_NE(help.out.find("\n  " + command + " "), std::string::npos) << command;
    const Outcome text = run_brume(folder_.path(), {command, "--help"});
    EXPECT_EQ(text.exit_code, 0) << command;
    // The examples come before the options.
    const std::string examples = text.out.substr(0, text.out.find("Usage:"));
    const auto calls = calls_in(examples);
    EXPECT_FALSE(calls.empty()) << command;
    for (const Arguments& call : calls) expect_works(command + " --help", call);
  }
}

TEST(DocumentRules, GalleryShowsTheFrameOfTheDemo) {
  std::ostringstream call;
  call << "`brume render scenes/demo.toml -o demo.png --time " << kPictureTime << ' ';
  const auto gallery = read_text_file(BRUME_SOURCE_DIR "/docs/gallery.md");
  EXPECT_NE(gallery->find(call.str()), std::string::npos) << call.str();
}

TEST(DocumentRules, FindTheCommandsOfABlock) {
  const std::string text =
      "brume no\n```sh\nbrume a \\\n  --b \"c d\"  # e\nls\n```\n```toml\nbrume no\n```\n";
  EXPECT_EQ(calls_in(shell_blocks(text)), (std::vector<Arguments>{{"a", "--b", "c d"}}));
}

}  // namespace
}  // namespace brume::cli
