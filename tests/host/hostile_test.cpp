// Hostile arguments never crash the C interface of the renderer, nor reach Vulkan.
#include <algorithm>
#include <set>
#include <sstream>

#include "core/file.hpp"
#include "grids/files/grid_files.hpp"
#include "grids/generate.hpp"
#include "tests/host/hostile_frames.hpp"
#include "tests/thorough.hpp"
#include "tests/work_folder.hpp"

namespace brume::host {
namespace {

const bool kMany = is_thorough("calls");
const int kFrames = kMany ? 300 : 6;
const HostileFrames::Scales kScales = kMany ? HostileFrames::Scales::all : HostileFrames::Scales::full;
constexpr int kMostMore = 60;

std::set<std::string> declared_functions() {
  std::set<std::string> declared;
  std::string text;
  for (const char* header : {"brume_assets.h", "brume_vulkan.h"})
    text += *read_text_file(std::string(BRUME_SOURCE_DIR "/include/brume/") + header);
  for (std::size_t at = 0; (at = text.find("BRUME_API brume_result ", at)) != text.npos; ++at) {
    const std::size_t name = at + std::string("BRUME_API brume_result ").size();
    declared.insert(text.substr(name, text.find('(', name) - name));
  }
  return declared;
}

TEST(HostileFrames, ArgumentsGiveResultsInEveryFunction) {
  const cli::WorkFolder folder;
  const std::string file = (folder.path() / "cloud.brv").string();
  const grids::Grid cloud =
      grids::generate_cloud({.kind = grids::CloudKind::sphere, .edge = 24, .voxel_size = 0.1, .radius = 1});
  grids::save_grid_file(file, {{cloud}, {}}).value_or_throw();
  HostileFrames hostile(1, file, kScales);
  const std::set<std::string> declared = declared_functions();
  const auto is_done = [&] {
    return std::ranges::all_of(declared, [&](const std::string& function) {
      const auto found = hostile.results().find(function);
      return found != hostile.results().end() && found->second.contains(BRUME_OK) && found->second.size() > 1;
    });
  };
  // Which functions a few random frames reach is luck: more frames follow until all have been.
  hostile.run_frames(kFrames);
  for (int more = 0; more < kMostMore && !is_done(); ++more) hostile.run_frames(1);
  for (const std::string& message : hostile.take_messages()) ADD_FAILURE() << message;

  std::set<std::string> called;
  for (const auto& [function, results] : hostile.results()) {
    if (!declared.contains(function)) continue;
    called.insert(function);
    EXPECT_TRUE(results.contains(BRUME_OK)) << function;
    EXPECT_GT(results.size(), 1u) << function;
  }
  EXPECT_EQ(called, declared);
}

}  // namespace
}  // namespace brume::host
