#include "tests/cli/documents.hpp"

#include <algorithm>
#include <regex>
#include <sstream>

#include "core/file.hpp"
#include "image/png.hpp"
#include "spheres/file.hpp"

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

bool is_atlas_bake(const Arguments& call) {
  return call[0] == "bake" && call.size() > 2 && (call[1] == "slices" || call[1] == "occlusion");
}

// Smaller pictures, shorter films, fewer rays.
void make_quick(Arguments& call) {
  if (call[0] == "render") {
    call.insert(call.end(), {"--size", "32x18"});
    const bool film = std::any_of(call.begin(), call.end(), [](const std::string& word) {
      return word.ends_with(".mp4") || word.find('%') != std::string::npos;
    });
    if (film) call.insert(call.end(), {"--frames", "0-1"});
  }
  const bool numbered =
      std::ranges::any_of(call, [](const std::string& word) { return word.find("%04d") != word.npos; });
  if (numbered && (call[0] == "convert" || call[0] == "bake")) call.insert(call.end(), {"--frames", "0-1"});
  if (is_atlas_bake(call) && call[1] == "occlusion") {
    const auto rays = std::find(call.begin(), call.end(), "--rays");
    if (rays == call.end())
      call.insert(call.end(), {"--rays", "2"});
    else if (rays + 1 != call.end())
      rays[1] = "2";
  }
}

}  // namespace

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

Documents::Documents() {
  std::filesystem::create_directory_symlink(BRUME_SOURCE_DIR "/scenes", folder_.path() / "scenes");
  folder_.write("room.obj", room_obj());
  EXPECT_EQ(run_brume(folder_.path(), {"voxelize", "room.obj", "-o", "room.vxl"}).exit_code, 0);
}

void Documents::provide(const std::string& word) const {
  if (const std::size_t number = word.find("%04d"); number != std::string::npos) {
    for (const char* digits : {"0000", "0001"}) provide(std::string(word).replace(number, 4, digits));
    return;
  }
  const std::filesystem::path path = folder_.path() / word;
  if (std::filesystem::path(word).is_absolute() || std::filesystem::exists(path)) return;
  std::filesystem::create_directories(path.parent_path());
  // The examples of bakes name the objects of the thruster.
  const std::string scene = path.stem() == "thruster" ? "thruster/thruster.glb" : "demo.glb";
  if (path.extension() == ".glb") std::filesystem::create_symlink(BRUME_SOURCE_DIR "/scenes/" + scene, path);
  if (path.extension() == ".obj") folder_.write(word, room_obj());
  if (path.extension() == ".vdb" || path.extension() == ".brv" || path.extension() == ".json")
    provide_volume(word);
  if (path.extension() == ".spheres") {
    const spheres::Tank tank{
        {16, 12, 8}, 0.1f, {{{5, 6, 4}, 3}, {{11, 5, 4}, 2.5f}}, {0xff2040e0, 0x60e0c020}};
    spheres::save_tank(path, tank).value_or_throw();
  }
  if (path.extension() == ".png") {
    const image::Image8 picture{
        32, 18, std::vector<std::uint8_t>(4 * 32 * 18, 255)};  // the size that render is called with
    image::save_png(path, picture).value_or_throw();
  }
}

// A grid "density" of 2 x 2 x 2 voxels.
void Documents::provide_volume(const std::string& word) const {
  folder_.write("volume.json",
                R"({"format": "brume raw volume", "version": 1, "raw": "volume.raw", "size": [2, 2, 2]})");
  folder_.write("volume.raw", std::string(32, '?'));
  const Outcome made = run_brume(folder_.path(), {"convert", "volume.json", word});
  EXPECT_EQ(made.exit_code, 0) << made.error;
}

void Documents::expect_works(const std::string& source, Arguments call, Pictures pictures) {
  SCOPED_TRACE(source + ": brume " + testing::PrintToString(call));
  if (!run_.insert(call).second) return;
  if (call.empty() || call[0] == "demo" || call[0] == "bench") return;
  if (call.size() > 1) provide(call[is_atlas_bake(call) ? 2 : 1]);
  if (call[0] == "diff" && call.size() > 2) provide(call[2]);
  RunOptions options;
  if (call[0] == "view") {
#ifdef BRUME_VIEWER
    if (!desktop_) desktop_.emplace();
    options.environment = {{"DISPLAY", desktop_->name()}};
    call.insert(call.end(), {"--size", "64x40", "--exit-after", "0.05"});
    // A tank of spheres has no quality: its picture gathers samples.
    const auto is_tank = [](const std::string& part) {
      return part.ends_with(".spheres") || part.find("aquaria") != std::string::npos;
    };
    if (std::ranges::none_of(call, is_tank)) call.insert(call.end(), {"--quality", "smallest"});
#else
    return;
#endif
  }
  make_quick(call);
  const bool is_drawn = pictures == Pictures::drawn || call[0] != "render";
  if (!is_drawn) call.insert(call.end(), {"--device", "none such"});
  const Outcome run = run_brume(folder_.path(), call, options);
  EXPECT_EQ(run.exit_code, is_drawn ? 0 : static_cast<int>(ErrorCode::no_device)) << run.error;
}

void Documents::expect_page_works(const std::filesystem::path& page, Pictures pictures) {
  const auto calls = calls_in(shell_blocks(*read_text_file(page)));
  for (const Arguments& call : calls) expect_works(page.filename().string(), call, pictures);
}

}  // namespace brume::cli
