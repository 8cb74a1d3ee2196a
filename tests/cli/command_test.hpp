// Commands of the program in a folder of their own, and what they leave there.
#pragma once

#include <gtest/gtest.h>

#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/file.hpp"
#include "image/decode.hpp"
#include "tests/cli/run_program.hpp"

namespace brume::cli {

using Arguments = std::vector<std::string>;
using Json = nlohmann::json;

/// The words of a line, between blanks.
inline Arguments words(const std::string& line) {
  std::istringstream in(line);
  return {std::istream_iterator<std::string>(in), {}};
}

class CommandTest : public testing::Test {
 protected:
  /// `more` follows the other arguments.
  Outcome run(Arguments arguments, const Arguments& more = {}, const RunOptions& options = {}) const {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_brume(folder_.path(), arguments, options);
  }
  /// The same, which succeeds.
  Outcome run_well(const Arguments& arguments, const Arguments& more = {}) const {
    Outcome done = run(arguments, more);
    EXPECT_EQ(done.exit_code, 0) << done.error;
    return done;
  }
  /// What it prints to standard output with --json -.
  Json json_of(const Arguments& arguments, const Arguments& more = {}) const {
    Arguments all = more;
    all.insert(all.end(), {"--json", "-"});
    return Json::parse(run_well(arguments, all).out, nullptr, false);
  }
  std::string bytes(const std::string& name) const {
    return read_text_file(folder_.path() / name).value_or_throw();
  }
  image::Image8 png(const std::string& name) const {
    return image::load_image(folder_.path() / name).value_or_throw();
  }
  WorkFolder folder_;
};

/// With room.obj.
class RoomTest : public CommandTest {
 protected:
  RoomTest() { folder_.write("room.obj", room_obj()); }
};

}  // namespace brume::cli
