// `render --mode reference`.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>

#include "tests/cli/reference_kills.hpp"

namespace brume::cli {
namespace {

class ReferenceMode : public ReferenceFolder {
 protected:
  Json json_of_render(const Arguments& more) const { return json_of(kRenderReference, more); }
};

TEST_F(ReferenceMode, WritesTheSamePictureForAnyNumberOfThreads) {
  for (const char* threads : {"1", "3"}) {
    const Outcome run = render_well(
        {"-o", std::string(threads) + ".png", "--samples", "4", "--threads", threads, "--json", "-"});
    EXPECT_EQ(run.error, "");
    const Json statistics = Json::parse(run.out);
    EXPECT_EQ(statistics["mode"], "reference");
    EXPECT_EQ(statistics["samples_per_pixel"], 4);
  }
  EXPECT_EQ(bytes("1.png"), bytes("3.png"));
  const image::Image8 picture = png("1.png");
  EXPECT_EQ(picture.width, 40u);
  EXPECT_EQ(picture.height, 24u);
}

TEST_F(ReferenceMode, WarnsInOneLineThatItShowsNoTanks) {
  folder_.write("reef.toml", "version = 1\n[tank]\nsize = [8, 8, 8]\nspheres = 2\n");
  const std::string room = read_text_file(folder_.path() / "room.toml").value_or_throw();
  ASSERT_EQ(render({"-o", "without.png", "--samples", "1"}).error, "");
  folder_.write("room.toml", room + "[[tank]]\nfile = \"reef.toml\"\nposition = [0.0, 1.0, 0.0]\n");
  const Outcome run = render({"-o", "with.png", "--samples", "1"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.error, "brume: warning: room.toml: --mode reference shows no [[tank]]\n");
  EXPECT_EQ(bytes("with.png"), bytes("without.png"));
}

TEST_F(ReferenceMode, LayersSayWhatIsInThem) {
  render_well({"-o", "a.exr", "--samples", "8"});
  std::vector<std::string> names;
  for (const image::Layer& layer : exr("a.exr").layers) names.push_back(layer.name);
  for (const char* name : {"R", "single.G", "multiple.B", "albedo.R", "normal.Y", "A", "Z", "error.V",
                           "samples.V", "transmittance.V"})
    EXPECT_NE(std::ranges::find(names, name), names.end()) << name;
}

TEST_F(ReferenceMode, EndsAtItsLimits) {
  EXPECT_LE(json_of_render({"-o", "a.png", "--noise", "0.5"})["largest_relative_error"], 0.5);
  EXPECT_GE(json_of_render({"-o", "a.png", "--time-limit", "0.3"})["seconds"], 0.3);
  // Whichever comes first.
  const Json both = json_of_render({"-o", "a.png", "--noise", "0.0001", "--samples", "2"});
  EXPECT_EQ(both["samples_per_pixel"], 2);
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
  const Arguments frames{"-o", "f_%d.png", "--frames", "2-4", "--samples", "2"};
  render_well(frames);
  const std::string third = bytes("f_3.png");
  EXPECT_NE(third, bytes("f_4.png"));
  std::filesystem::remove(folder_.path() / "f_3.png");
  render_well(joined(frames, {"--resume"}));
  EXPECT_EQ(bytes("f_3.png"), third);
}

TEST_F(ReferenceMode, RefusesOptionsOfTheOtherMode) {
  const auto refuse = [&](const Arguments& more, const std::vector<std::string>& parts) {
    expect_failure(folder_, joined({"render", "room.toml", "-o", "a.png"}, more), 2, parts);
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
  render_well({"-o", "a.png", "--samples", "2", "--checkpoint", "a.brc"});
  const std::string before = bytes("a.brc");
  for (const Arguments& other : {Arguments{"--time", "0.3"},
                                 {"--max-bounces", "1"},
                                 {"--shutter", "0.1"},
                                 {"--matte"},
                                 {"--camera", "0,1,1.5 0,1,0 50"}}) {
    const Outcome run = render(joined({"-o", "b.png", "--samples", "4", "--checkpoint", "a.brc"}, other));
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
