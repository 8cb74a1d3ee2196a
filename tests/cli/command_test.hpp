// Commands of the program in a folder of their own, and what they leave there.
#pragma once

#include <gtest/gtest.h>

#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/file.hpp"
#include "image/decode.hpp"
#include "image/exr.hpp"
#include "tests/cli/run_program.hpp"

namespace brume::cli {

using Arguments = std::vector<std::string>;
using Json = nlohmann::json;

/// The words of a line, between blanks; 'one word' may have blanks itself.
inline Arguments words(const std::string& line) {
  std::istringstream in(line);
  Arguments all;
  for (std::string word; in >> std::quoted(word, '\'');) all.push_back(word);
  return all;
}

/// Arguments and those that follow them.
inline Arguments joined(Arguments arguments, const Arguments& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

class CommandTest : public testing::Test {
 protected:
  /// `more` follows the other arguments.
  Outcome run(const Arguments& arguments, const Arguments& more = {}, const RunOptions& options = {}) const {
    return run_brume(folder_.path(), joined(arguments, more), options);
  }
  /// The same, which succeeds.
  Outcome run_well(const Arguments& arguments, const Arguments& more = {}) const {
    SCOPED_TRACE(testing::PrintToString(joined(arguments, more)));
    Outcome done = run(arguments, more);
    EXPECT_EQ(done.exit_code, 0) << done.error;
    return done;
  }
  /// What it prints to standard output with --json -.
  Json json_of(const Arguments& arguments, const Arguments& more = {}) const {
    return Json::parse(run_well(arguments, joined(more, {"--json", "-"})).out, nullptr, false);
  }
  std::string bytes(const std::string& name) const {
    return read_text_file(folder_.path() / name).value_or_throw();
  }
  image::Image8 png(const std::string& name) const {
    return image::load_image(folder_.path() / name).value_or_throw();
  }
  image::LayeredImage exr(const std::string& name) const {
    return image::decode_exr(read_file(folder_.path() / name).value_or_throw(), name).value_or_throw();
  }
  WorkFolder folder_;
};

/// With room.obj.
class RoomTest : public CommandTest {
 protected:
  RoomTest() { folder_.write("room.obj", room_obj()); }
};

}  // namespace brume::cli
