// Runs the commands of documents and of --help as they are written there.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tests/cli/run_program.hpp"
#ifdef BRUME_VIEWER
#include "tests/viewer/desktop.hpp"
#endif

namespace brume::cli {

/// The arguments of every line of a text that runs the program.
std::vector<std::vector<std::string>> calls_in(const std::string& text);

/// The ```sh blocks of a Markdown text, lines joined where they end in a backslash.
std::string shell_blocks(const std::string& markdown);

/// How far `brume render` goes.
enum class Pictures {
  drawn,
  up_to_device,  ///< Until a device is missed that there is not: all inputs and options are checked by then.
};

/// A folder with the files that documents mention: the scene of the demo under any name, and its voxels.
class Documents : public testing::Test {
 protected:
  Documents();
  /// Runs a command with few pixels and frames, once. `demo` and `bench` take minutes and are run by scripts.
  void expect_works(const std::string& source, std::vector<std::string> call,
                    Pictures pictures = Pictures::drawn);
  /// The same for all commands of a page.
  void expect_page_works(const std::filesystem::path& page, Pictures pictures = Pictures::drawn);

  WorkFolder folder_;

 private:
  void provide(const std::string& word) const;
  void provide_volume(const std::string& word) const;

  std::set<std::vector<std::string>> run_;  ///< Some commands stand on several pages.
#ifdef BRUME_VIEWER
  std::optional<viewer::Desktop> desktop_;  ///< For `brume view`.
#endif
};

}  // namespace brume::cli
