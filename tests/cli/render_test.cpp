#include <gtest/gtest.h>
#include <signal.h>

#include <nlohmann/json.hpp>

#include "core/file.hpp"
#include "image/decode.hpp"
#include "tests/cli/run_program.hpp"

namespace brume::cli {
namespace {

using Arguments = std::vector<std::string>;

constexpr const char* kTimeline =
    "version = 1\nscene = \"room.obj\"\nduration = 1.0\n"
    "[[camera]]\ntime = 0.0\nposition = [0.0, 1.7, 1.8]\ntarget = [0.0, 1.2, -1.0]\nfov = 70.0\n"
    "[[event]]\ntype = \"smoke\"\ntime = 0.0\nfrom = [0.0, 1.5, 1.0]\nat = [0.0, 0.5, -1.0]\n";

class Render : public testing::Test {
 protected:
  Render() {
    folder_.write("room.obj", room_obj());
    folder_.write("room.toml", kTimeline);
  }
  Outcome render(const Arguments& more, const RunOptions& options = {}) const {
    Arguments arguments{"render", "room.toml"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_brume(folder_.path(), arguments, options);
  }
  image::Image8 png(const std::string& name) const {
    return image::load_image(folder_.path() / name).value_or_throw();
  }
  WorkFolder folder_;
};

TEST_F(Render, ImagesAreReproducibleAndDependOnTheCamera) {
  for (const char* name : {"a.png", "b.png"}) {
    const Outcome run = render({"-o", name, "--size", "64x36", "--time", "0.8", "--json", "-"});
    ASSERT_EQ(run.exit_code, 0) << run.error;
    EXPECT_EQ(run.error, "");
    const auto statistics = nlohmann::json::parse(run.out);
    EXPECT_EQ(statistics["frames"], 1);
    EXPECT_NE(statistics["device"], "");
  }
  EXPECT_EQ(png("a.png").width, 64u);
  EXPECT_EQ(png("a.png").height, 36u);
  EXPECT_EQ(png("a.png").rgba, png("b.png").rgba);
  const Outcome other = render({"-o", "c.png", "--size", "64x36", "--time", "0.8", "--smoke", "0.5,1.5,-0.5",
                                "--camera", "1.5,1,1.5 -1,1,-1 60"});
  ASSERT_EQ(other.exit_code, 0) << other.error;
  EXPECT_NE(png("c.png").rgba, png("a.png").rgba);
}

TEST_F(Render, QualityOptionsTakeEffectWithinTheirRange) {
  for (const char* step : {"1", "2"}) {
    const Outcome run =
        render({"-o", std::string(step) + ".png", "--size", "64x36", "--time", "0.8", "--step", step});
    ASSERT_EQ(run.exit_code, 0) << run.error;
  }
  ASSERT_EQ(render({"-o", "usual.png", "--size", "64x36", "--time", "0.8"}).exit_code, 0);
  EXPECT_EQ(png("1.png").rgba, png("usual.png").rgba);
  EXPECT_NE(png("2.png").rgba, png("usual.png").rgba);
  for (const char* step : {"0.2", "4.5", "nan"})
    EXPECT_EQ(render({"-o", "no.png", "--step", step}).exit_code, 2) << step;
  for (const char* option : {"--resolve-error-scale", "--light-update-fraction"})
    for (const char* value : {"0.01", "17", "nan"})
      EXPECT_EQ(render({"-o", "no.png", option, value}).exit_code, 2) << option << value;
}

TEST_F(Render, DebugViewsAndSlices) {
  const Arguments small{"--size", "48x27", "--time", "0.8"};
  const auto draw = [&](const std::string& name, Arguments more) {
    more.insert(more.end(), {"-o", name});
    more.insert(more.end(), small.begin(), small.end());
    const Outcome run = render(more);
    EXPECT_EQ(run.exit_code, 0) << run.error;
    return png(name).rgba;
  };
  const auto depth = draw("depth.png", {"--view", "depth"});
  EXPECT_NE(depth, draw("solid.png", {"--view", "solid"}));
  const auto low = draw("low.png", {"--view", "density", "--slice", "y=0.4"});
  EXPECT_NE(low, draw("high.png", {"--view", "density", "--slice", "y=1.1"}));
  EXPECT_EQ(low, draw("again.png", {"--view", "density", "--slice", "y=0.4"}));
}

TEST_F(Render, InvalidViewsAndSlices) {
  const auto refused = [&](const Arguments& more, const std::string& part) {
    Arguments arguments{"-o", "a.png", "--size", "32x18"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome run = render(arguments);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_NE(run.error.find(part), std::string::npos) << run.error;
  };
  refused({"--view", "voxels"}, "solid");
  refused({"--slice", "y=1"}, "--view density");
  refused({"--view", "depth", "--slice", "y=1"}, "--view density");
  for (const char* slice : {"y", "w=1", "y=", "y=1m", "=1", "y=nan"})
    refused({"--view", "density", "--slice", slice}, "--slice '" + std::string(slice) + "'");
}

TEST_F(Render, ImageSequenceAndFilm) {
  const Outcome images = render({"-o", "p_%03d.png", "--frames", "2-4", "--fps", "10", "--size", "32x18"});
  ASSERT_EQ(images.exit_code, 0) << images.error;
  const Outcome film = render({"-o", "film.mp4", "--frames", "0-5", "--size", "32x18"});
  ASSERT_EQ(film.exit_code, 0) << film.error;
  EXPECT_EQ(folder_.files(),
            (Arguments{"film.mp4", "p_002.png", "p_003.png", "p_004.png", "room.obj", "room.toml"}));
}

TEST_F(Render, SceneWithoutATimeline) {
  const Outcome run = run_brume(
      folder_.path(), {"render", "room.obj", "-o", "a.png", "--size", "32x18", "--smoke", "0,1,-1"});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  const Outcome with = run_brume(
      folder_.path(), {"render", "room.obj", "--timeline", "room.toml", "-o", "b.png", "--size", "32x18"});
  ASSERT_EQ(with.exit_code, 0) << with.error;
}

TEST_F(Render, LeavesNothingWhenInterrupted) {
  for (const int signal : {SIGINT, SIGTERM}) {
    RunOptions interrupt;
    interrupt.signal = signal;
    // The temporary file exists: the film is being written.
    interrupt.signal_when = [&] { return folder_.files().size() > 2; };
    const Outcome run = render({"-o", "long.mp4", "--frames", "0-100000", "--size", "640x360"}, interrupt);
    EXPECT_EQ(run.exit_code, 128 + signal) << run.error;
    EXPECT_EQ(run.error, "brume: interrupted\n");
    EXPECT_EQ(folder_.files(), (Arguments{"room.obj", "room.toml"}));
  }
}

TEST_F(Render, FilmOnAFullDisk) {
  RunOptions small;
  small.file_bytes = 400;
  const Outcome run = render({"-o", "film.mp4", "--frames", "0-9", "--size", "64x36"}, small);
  EXPECT_EQ(run.exit_code, 4) << run.error;
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(folder_.files(), (Arguments{"room.obj", "room.toml"}));
}

}  // namespace
}  // namespace brume::cli
