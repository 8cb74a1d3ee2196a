// --color-map, --opacity and --range of a volume without a timeline.
#include <gtest/gtest.h>

#include "image/decode.hpp"
#include "tests/cli/run_program.hpp"

namespace brume::cli {
namespace {

class TransferOptions : public testing::Test {
 protected:
  TransferOptions() {
    const Outcome baked =
        run_brume(folder_.path(), {"bake", "pyroclastic", "--edge", "32", "-o", "scan.brv"});
    EXPECT_EQ(baked.exit_code, 0) << baked.error;
    folder_.write("t.toml", "version = 1\nscene = \"scan.brv\"\n");
    folder_.write("room.obj", room_obj());
  }
  Outcome render(const std::string& input, const std::string& output,
                 const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"render", input, "-o", output, "--size", "48x36"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_brume(folder_.path(), arguments);
  }
  std::vector<std::uint8_t> png(const std::string& name) const {
    return image::load_image(folder_.path() / name).value_or_throw().rgba;
  }
  WorkFolder folder_;
};

TEST_F(TransferOptions, ChangeThePicture) {
  const std::vector<std::vector<std::string>> variants{{},
                                                       {"--color-map", "viridis"},
                                                       {"--color-map", "inferno"},
                                                       {"--opacity", "0:0,0.4:0,0.5:1,0.6:0"},
                                                       {"--opacity", "0:0,1:1", "--range", "0.5,2"}};
  std::vector<std::vector<std::uint8_t>> pictures;
  for (const auto& variant : variants) {
    const std::string name = std::to_string(pictures.size()) + ".png";
    const Outcome run = render("scan.brv", name, variant);
    ASSERT_EQ(run.exit_code, 0) << run.error;
    pictures.push_back(png(name));
    for (std::size_t i = 0; i + 1 < pictures.size(); ++i) EXPECT_NE(pictures[i], pictures.back()) << name;
  }
}

TEST_F(TransferOptions, MistakesAreOneLine) {
  const std::string of_timeline = "is for a volume without a timeline; set it in [[volume]] of the timeline";
  for (const auto& [input, more, message] :
       std::vector<std::tuple<std::string, std::vector<std::string>, std::string>>{
           {"scan.brv", {"--color-map", "virdis"}, "no colour map \"virdis\"; did you mean \"viridis\"?"},
           {"scan.brv", {"--opacity", "0:0"}, "expected 2 to 64 points [position, opacity], found 1"},
           {"scan.brv", {"--opacity", "0,1"}, "expected points position:opacity, such as 0:0,0.3:0,1:1"},
           {"scan.brv", {"--opacity", "0:0,nan:1"}, "expected points position:opacity"},
           {"scan.brv", {"--opacity", "0.5:0,0.25:1"}, "point 2: expected a position from 0.5 on"},
           {"scan.brv", {"--opacity", "0:0,1:2"}, "point 2: expected numbers from 0 to 1"},
           {"scan.brv", {"--range", "3,1"}, "expected the lower value first"},
           {"scan.brv", {"--range", "3"}, "expected the lowest and the highest value"},
           {"scan.brv", {"--color-map", "grey", "--raycast", "two-pass"}, "draws no transfer functions"},
           {"t.toml", {"--color-map", "grey"}, of_timeline},
           {"t.toml", {"--range", "0,1"}, of_timeline},
           {"room.obj", {"--opacity", "0:0,1:1"}, "is for a volume; room.obj is a scene"}}) {
    const Outcome run = render(input, "x.png", more);
    EXPECT_EQ(run.exit_code, 2) << more[1];
    EXPECT_NE(run.error.find(message), std::string::npos) << run.error;
    EXPECT_EQ(std::count(run.error.begin(), run.error.end(), '\n'), 1) << run.error;
  }
}

}  // namespace
}  // namespace brume::cli
