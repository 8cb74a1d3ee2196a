// `render --mode reference`.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/file.hpp"
#include "image/decode.hpp"
#include "image/exr.hpp"
#include "tests/cli/reference_kills.hpp"

namespace brume::cli {
namespace {

class ReferenceMode : public ReferenceFolder {};

TEST_F(ReferenceMode, WritesTheSamePictureForAnyNumberOfThreads) {
  for (const char* threads : {"1", "3"}) {
    const Outcome run =
        render({"-o", std::string(threads) + ".png", "--samples", "4", "--threads", threads, "--json", "-"});
    ASSERT_EQ(run.exit_code, 0) << run.error;
    EXPECT_EQ(run.error, "");
    const auto statistics = nlohmann::json::parse(run.out);
    EXPECT_EQ(statistics["mode"], "reference");
    EXPECT_EQ(statistics["samples_per_pixel"], 4);
  }
  EXPECT_EQ(bytes("1.png"), bytes("3.png"));
  const auto picture = image::load_image(folder_.path() / "1.png").value_or_throw();
  EXPECT_EQ(picture.width, 40u);
  EXPECT_EQ(picture.height, 24u);
}

TEST_F(ReferenceMode, LayersSayWhatIsInThem) {
  ASSERT_EQ(render({"-o", "a.exr", "--samples", "8"}).exit_code, 0);
  const auto image =
      image::decode_exr(read_file(folder_.path() / "a.exr").value_or_throw(), "a.exr").value_or_throw();
  std::vector<std::string> names;
  for (const image::Layer& layer : image.layers) names.push_back(layer.name);
  for (const char* name : {"R", "single.G", "multiple.B", "albedo.R", "normal.Y", "A", "Z", "error.V",
                           "samples.V", "transmittance.V"})
    EXPECT_NE(std::ranges::find(names, name), names.end()) << name;
}

TEST_F(ReferenceMode, EndsAtItsLimits) {
  Outcome run = render({"-o", "a.png", "--noise", "0.5", "--json", "-"});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  EXPECT_LE(nlohmann::json::parse(run.out)["largest_relative_error"], 0.5);
  run = render({"-o", "a.png", "--time-limit", "0.3", "--json", "-"});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  EXPECT_GE(nlohmann::json::parse(run.out)["seconds"], 0.3);
  // Whichever comes first.
  run = render({"-o", "a.png", "--noise", "0.0001", "--samples", "2", "--json", "-"});
  EXPECT_EQ(nlohmann::json::parse(run.out)["samples_per_pixel"], 2);
}

// No path through a volume that scatters all light of an extinction of 1e9 /m ends in time.
TEST_F(ReferenceMode, EndsAtItsTimeLimitInAMediumOfAnyExtinction) {
  const std::vector<float> ones(16 * 16 * 16, 1.0f);
  folder_.write("dense.raw", {reinterpret_cast<const char*>(ones.data()), ones.size() * sizeof(float)});
  folder_.write("dense.json",
                R"({"format": "brume raw volume", "version": 1, "raw": "dense.raw", "size": [16, 16, 16],
                    "class": "fog volume", "type": "float32"})");
  folder_.write("dense.toml",
                "version = 1\nscene = \"room.obj\"\nduration = 1.0\n[sky]\nambient = [1.0, 1.0, "
                "1.0]\n[[camera]]\ntime = 0.0\n"
                "position = [8.0, 8.0, 40.0]\ntarget = [8.0, 8.0, 8.0]\n[[volume]]\nfile = \"dense.json\"\n"
                "extinction = 1e9\nalbedo = [1.0, 1.0, 1.0]\n");
  for (const char* input : {"dense.toml", "dense.json"}) {
    const Outcome run = run_brume(folder_.path(), {"render", input, "-o", "dense.png", "--mode", "reference",
                                                   "--time-limit", "0.5", "--size", "64x48"});
    EXPECT_EQ(run.exit_code, 0) << run.error;
    if (std::string(input) == "dense.toml") {
      EXPECT_NE(run.error.find("--time-limit 0.5: ended before"), std::string::npos) << run.error;
    }
  }
}

TEST_F(ReferenceMode, NumberedFramesResume) {
  const std::vector<std::string> frames{"-o", "f_%d.png", "--frames", "2-4", "--samples", "2"};
  ASSERT_EQ(render(frames).exit_code, 0);
  const std::string third = bytes("f_3.png");
  EXPECT_NE(third, bytes("f_4.png"));
  std::filesystem::remove(folder_.path() / "f_3.png");
  std::vector<std::string> again = frames;
  again.emplace_back("--resume");
  ASSERT_EQ(render(again).exit_code, 0);
  EXPECT_EQ(bytes("f_3.png"), third);
}

TEST_F(ReferenceMode, RefusesOptionsOfTheOtherMode) {
  const auto refuse = [&](std::vector<std::string> more, const std::vector<std::string>& parts) {
    std::vector<std::string> arguments{"render", "room.toml", "-o", "a.png"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    expect_failure(folder_, arguments, 2, parts);
  };
  refuse({"--mode", "reference", "--march", "half"}, {"--march", "--mode realtime"});
  refuse({"--mode", "reference", "--device", "0"}, {"--device", "--mode realtime"});
  refuse({"--samples", "4", "--view", "depth"}, {"--samples", "debug view"});
  refuse({"--samples", "4", "--light-update-fraction", "0.5"}, {"--samples", "--temporal"});
  refuse({"--noise", "0.1"}, {"--noise", "--mode reference"});
  refuse({"--mode", "reference", "--samples", "0"}, {"--samples"});
  refuse({"--mode", "reference", "--noise", "-1"}, {"--noise"});
  refuse({"--mode", "reference", "--checkpoint", "room.toml"}, {"room.toml"});
  refuse({"--mode", "fast"}, {"--mode"});
  refuse({"--shutter", "-0.1"}, {"--shutter"});
}

TEST_F(ReferenceMode, RefusesCheckpointsOfOtherPictures) {
  ASSERT_EQ(render({"-o", "a.png", "--samples", "2", "--checkpoint", "a.brc"}).exit_code, 0);
  const std::string before = bytes("a.brc");
  for (const std::vector<std::string>& other : {std::vector<std::string>{"--time", "0.3"},
                                                {"--max-bounces", "1"},
                                                {"--shutter", "0.1"},
                                                {"--matte"},
                                                {"--camera", "0,1,1.5 0,1,0 50"}}) {
    std::vector<std::string> arguments{"-o", "b.png", "--samples", "4", "--checkpoint", "a.brc"};
    arguments.insert(arguments.end(), other.begin(), other.end());
    const Outcome run = render(arguments);
    EXPECT_EQ(run.exit_code, 3) << run.error;
    EXPECT_NE(run.error.find("a.brc: is of another picture"), std::string::npos) << run.error;
    EXPECT_EQ(bytes("a.brc"), before);
  }
}

TEST_F(ReferenceMode, GoesOnBitByBitAfterKills) {
  expect_equal_after_kills(2);
}

}  // namespace
}  // namespace brume::cli
