// Sessions are recorded and replay bit for bit.
#include <X11/keysym.h>
#include <signal.h>

#include "image/decode.hpp"
#include "scene/files/timeline_reader.hpp"
#include "scene/files/timeline_writer.hpp"
#include "scene/timeline.hpp"
#include "tests/viewer/small_tank.hpp"

namespace brume::viewer {
namespace {

class RecordingTest : public testing::Test {
 protected:
  RecordingTest() { write_room(folder_); }

  std::filesystem::path file(const std::string& name) const { return folder_.path() / name; }
  image::Image8 png(const std::string& name) const { return image::load_image(file(name)).value_or_throw(); }

  cli::WorkFolder folder_;
  Desktop desktop_;
};

void expect_same_but_for_rounding(const image::Image8& a, const image::Image8& b) {
  // Which ticks were drawn depends on the machine, and after the door so do the slots of bricks
  // (SmokeVolume). Texture coordinates then round elsewhere: by 2^-24 of an atlas of at most 100 texels, 6e-6
  // of a texel, which moves a channel by far less than 1 of 255: its code may become the next one, no other.
  EXPECT_LE(largest_difference(a, b), 1);
}

TEST_F(RecordingTest, PlaysBackTwiceWithEqualHashesAndImages) {
  constexpr int kShots = 10;
  {
    Program program(desktop_, folder_.path(),
                    {"room.toml", "--size", "192x128", "--quality", "quarter", "--word", "HI", "--record",
                     "made.toml", "--json", "made.json"});
    ASSERT_TRUE(program.wait_for_window()) << program.error();
    program.click(1);  // throw
    ASSERT_TRUE(program.wait_for_clock(1.2));
    for (int shot = 0; shot < kShots; ++shot) {
      program.move_mouse(shot % 5 * 6 - 12, shot / 5 * 4 - 6);
      program.click(3);
      program.wait_for_frames(2);
    }
    program.tap(XK_3);
    program.click(3);  // the word
    program.tap(XK_e);
    ASSERT_TRUE(program.wait_for_clock(0.2));
    program.tap(XK_f);
    // An orbit: sideways while turning back.
    program.key(XK_a, true);
    for (int i = 0; i < 6; ++i) {
      program.move_mouse(20, 0);
      program.wait_for_frames(2);
    }
    program.key(XK_a, false);
    // Past the tick of the last action.
    ASSERT_TRUE(program.wait_for_clock(0.3));
    program.close();
    ASSERT_EQ(program.wait(), 0) << program.error();
  }
  const auto made = scene::load_timeline(file("made.toml"));
  ASSERT_TRUE(made) << made.failure().message;
  EXPECT_EQ(made->smokes.size(), 1u);
  EXPECT_EQ(made->shots.size(), std::size_t{kShots});
  EXPECT_EQ(made->texts.size(), 1u);
  EXPECT_EQ(made->blasts.size(), 1u);
  EXPECT_EQ(made->doors.size(), 1u);
  EXPECT_GT(made->camera.size(), 4u);

  std::vector<std::string> hashes;
  std::vector<image::Image8> images;
  for (const std::string name : {"first", "second"}) {
    Program program(desktop_, folder_.path(),
                    {"--play", "made.toml", "--size", "96x64", "--exit-after",
                     std::to_string(static_cast<double>(made->duration)), "--screenshot", name + ".png",
                     "--json", name + ".json"});
    ASSERT_EQ(program.wait(), 0) << program.error();
    hashes.push_back(read_json(file(name + ".json")).at("state_hash"));
    images.push_back(png(name + ".png"));
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  expect_same_but_for_rounding(images[0], images[1]);
  EXPECT_GT(count_colours(images[0]), 100u);
  // The live session ended in the same state.
  const auto live = read_json(file("made.json")), played = read_json(file("first.json"));
  ASSERT_EQ(live.at("tick"), played.at("tick"));
  EXPECT_EQ(live.at("state_hash"), played.at("state_hash"));
}

// At reduced quality, too: the light in the smoke is then brought up to date in slices.
TEST_F(RecordingTest, AScreenshotEqualsRenderAndTheWindow) {
  int number = 0;
  for (const std::string quality : {"full", "smallest"}) {
    SCOPED_TRACE(quality);
    Program program(desktop_, folder_.path(),
                    {"room.toml", "--size", "200x120", "--bare", "--quality", quality});
    ASSERT_TRUE(program.wait_for_window()) << program.error();
    program.click(1);
    ASSERT_TRUE(program.wait_for_clock(1.5));
    program.click(3);
    ASSERT_TRUE(program.wait_for_clock(0.2));
    program.tap(XK_p);
    // The paused window shows the image of the screenshot.
    ASSERT_TRUE(program.wait_for_best());
    const image::Image8 window = program.contents();
    program.tap(XK_F12);
    ASSERT_TRUE(program.wait_for_frames(2));
    const std::string name = "brume_000" + std::to_string(++number);
    ASSERT_TRUE(std::filesystem::exists(file(name + ".png"))) << program.error();
    const image::Image8 screenshot = png(name + ".png");
    EXPECT_LE(largest_difference(window, screenshot), 1);

    const cli::Outcome rendered = cli::run_brume(
        folder_.path(), {"render", name + ".toml", "-o", "again.png", "--size", "200x120", "--samples", "4"});
    ASSERT_EQ(rendered.exit_code, 0) << rendered.error;
    EXPECT_LE(largest_difference(screenshot, png("again.png")), 1);
    std::filesystem::remove(file("again.png"));
    program.close();
    EXPECT_EQ(program.wait(), 0) << program.error();
  }
}

// Its paths gather while the window is paused.
TEST_F(RecordingTest, ATankInALevelReachesItsBestPictureAndIsSaved) {
  write_tank(folder_);
  write_room(folder_, "[[tank]]\nfile = \"tank.toml\"\nposition = [0.3, 1.4, 1.2]\n");
  Program program(desktop_, folder_.path(),
                  {"room.toml", "--size", "96x64", "--bare", "--quality", "smallest", "--validation",
                   "--json", "r.json"});
  ASSERT_TRUE(program.wait_for_window()) << program.error();
  program.tap(XK_p);
  ASSERT_TRUE(program.wait_for_best()) << program.error();
  const image::Image8 window = program.contents();
  program.tap(XK_F12);
  ASSERT_TRUE(program.wait_for_frames(2));
  EXPECT_LE(largest_difference(window, png("brume_0001.png")), 1);
  program.close();
  EXPECT_EQ(program.wait(), 0) << program.error();
  EXPECT_EQ(read_json(file("r.json")).at("validation_messages"), nlohmann::json::array());
  // The timeline beside it has the tank, too.
  auto saved = scene::load_timeline(file("brume_0001.toml")).value_or_throw();
  ASSERT_EQ(saved.tanks.size(), 1u);
  const auto rendered = [&](const std::string& name) {
    const cli::Outcome run = cli::run_brume(
        folder_.path(), {"render", name + ".toml", "-o", name + "_again.png", "--size", "96x64"});
    EXPECT_EQ(run.exit_code, 0) << run.error;
    return png(name + "_again.png");
  };
  const double with = mean_difference(window, rendered("brume_0001"));
  saved.tanks.clear();
  ASSERT_TRUE(scene::save_timeline(file("empty.toml"), saved));
  EXPECT_LT(4 * with, mean_difference(window, rendered("empty"))) << "another picture than render draws";
}

// Samples of lens and shutter gather until they are the image of `brume render`; what moves is sharp.
TEST_F(RecordingTest, APausedImageShowsLensAndShutter) {
  folder_.write("lens.toml",
                "version = 1\nscene = \"room.txt\"\nduration = 3.0\n[grid]\nvoxel = 0.25\n"
                "[[camera]]\ntime = 0.0\nposition = [0.5, 1.6, 3.2]\ntarget = [0.2, 1.3, -3.0]\n"
                "aperture = 0.2\nfocus = 1.5\nblades = 5\nshutter = 0.2\n"
                "[[camera]]\ntime = 3.0\nposition = [-0.5, 1.6, 3.2]\ntarget = [0.2, 1.3, -3.0]\n"
                "aperture = 0.2\nfocus = 1.5\nblades = 5\nshutter = 0.2\n");
  const auto render = [&](const char* name, std::vector<std::string> more) {
    more.insert(more.begin(), {"render", "lens.toml", "-o", name, "--size", "96x64", "--time", "1.5"});
    const cli::Outcome rendered = cli::run_brume(folder_.path(), more);
    EXPECT_EQ(rendered.exit_code, 0) << rendered.error;
    return png(name);
  };
  const image::Image8 blurred = render("blurred.png", {}), sharp = render("sharp.png", {"--samples", "1"});
  EXPECT_GT(mean_difference(blurred, sharp), 1);
  Program program(desktop_, folder_.path(),
                  {"--play", "lens.toml", "--time", "1.5", "--size", "96x64", "--bare"});
  ASSERT_TRUE(program.wait_for_window()) << program.error();
  ASSERT_TRUE(program.wait_for_best());
  EXPECT_LE(largest_difference(program.contents(), blurred), 1);
  program.close();
  EXPECT_EQ(program.wait(), 0) << program.error();
}

// A still becomes the best image in many short frames, and an input ends them.
TEST_F(RecordingTest, APausedImageIsRefinedInSteps) {
  Program program(desktop_, folder_.path(), {"room.toml", "--size", "192x128", "--quality", "smallest"});
  ASSERT_TRUE(program.wait_for_window()) << program.error();
  program.click(1);
  ASSERT_TRUE(program.wait_for_clock(1));
  program.tap(XK_p);
  ASSERT_TRUE(program.wait_for_best());
  const auto is_still = [](const Frame& frame) { return frame.picture == "still"; };
  const auto& frames = program.frames();
  EXPECT_EQ(std::count_if(frames.begin(), frames.end(), is_still), 2 + 8 + 3)
      << "until refined, slices of light, samples but for the last";
  program.tap(XK_v);
  EXPECT_TRUE(program.wait_for_frame([](const Frame& frame) { return frame.picture != "best"; }));
  EXPECT_TRUE(program.wait_for_best());
  program.close();
  EXPECT_EQ(program.wait(), 0) << program.error();
}

TEST_F(RecordingTest, ASceneWithoutATimelineGetsTheExposureThatRenderMeasures) {
  Program program(desktop_, folder_.path(),
                  {"room.txt", "--size", "192x128", "--exit-after", "0.05", "--record", "made.toml"});
  ASSERT_EQ(program.wait(), 0) << program.error();
  const auto made = scene::load_timeline(file("made.toml"));
  ASSERT_TRUE(made) << made.failure().message;
  EXPECT_NE(made->exposure, 0);
  const auto render = [&](const std::string& name, std::vector<std::string> more) {
    more.insert(more.begin(), {"render", "room.txt", "-o", name, "--size", "96x64"});
    const cli::Outcome rendered = cli::run_brume(folder_.path(), more);
    EXPECT_EQ(rendered.exit_code, 0) << rendered.error;
    return png(name);
  };
  const image::Image8 measured = render("measured.png", {});
  const image::Image8 given = render("given.png", {"--exposure", std::to_string(made->exposure)});
  EXPECT_LE(largest_difference(measured, given), 2);
}

// Its scale, ground and sun are in the screenshot's timeline.
TEST_F(RecordingTest, AScreenshotOfAModelEqualsRender) {
  std::string model;
  for (int i = 0; i < 8; ++i)
    model += "v " + std::to_string(20000 * (i & 1)) + " " + std::to_string(12000 * (i >> 1 & 1)) + " " +
             std::to_string(15000 * (i >> 2 & 1)) + "\n";
  folder_.write("model.obj", model + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{}, {"--scale", "0.0005", "--sun", "-30,20"}}) {
    std::vector<std::string> arguments{"model.obj",    "--size", "200x120",      "--bare", "--force",
                                       "--exit-after", "0.1",    "--screenshot", "s.png"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    Program program(desktop_, folder_.path(), arguments);
    ASSERT_EQ(program.wait(), 0) << program.error();
    EXPECT_EQ(program.error().find("scaled by") != std::string::npos, options.empty()) << program.error();
    const cli::Outcome rendered = cli::run_brume(
        folder_.path(),
        {"render", "s.toml", "-o", "again.png", "--size", "200x120", "--samples", "4", "--force"});
    ASSERT_EQ(rendered.exit_code, 0) << rendered.error;
    EXPECT_LE(largest_difference(png("s.png"), png("again.png")), 1);
    EXPECT_GT(count_colours(png("s.png")), 100u);
  }
}

// The autosave in the folder; its name has the number of the process.
std::filesystem::path autosave_in(const cli::WorkFolder& folder) {
  for (const std::string& name : folder.files())
    if (name.starts_with("autosave_")) return folder.path() / name;
  return {};
}

TEST_F(RecordingTest, AKilledSessionIsRecovered) {
  std::filesystem::path autosave;
  {
    Program program(desktop_, folder_.path(), {"room.toml", "--size", "192x128", "--quality", "smallest"});
    ASSERT_TRUE(program.wait_for_window()) << program.error();
    EXPECT_EQ(autosave_in(folder_), "") << "there is nothing to lose before the first action";
    program.click(1);  // throw
    while (autosave.empty() && program.wait_for_frames(1)) autosave = autosave_in(folder_);
    ASSERT_NE(autosave, "") << program.error();
    program.kill();
  }
  ASSERT_TRUE(std::filesystem::exists(autosave));
  {
    Program program(desktop_, folder_.path(), {"room.toml", "--size", "64x40", "--exit-after", "0.05"});
    EXPECT_EQ(program.wait(), 0) << program.error();
    EXPECT_NE(program.error().find("brume view --play ./recovered_0001.toml"), std::string::npos)
        << program.error();
  }
  EXPECT_FALSE(std::filesystem::exists(autosave));
  const auto recovered = scene::load_timeline(file("recovered_0001.toml"));
  ASSERT_TRUE(recovered) << recovered.failure().message;
  EXPECT_EQ(recovered->smokes.size(), 1u);
  const cli::Outcome played = cli::run_brume(folder_.path(), {"sim", "recovered_0001.toml"});
  EXPECT_EQ(played.exit_code, 0) << played.error;
}

TEST_F(RecordingTest, ATerminatedSessionIsSavedAsItIs) {
  Program program(desktop_, folder_.path(), {"room.toml", "--size", "64x40", "--quality", "smallest"});
  ASSERT_TRUE(program.wait_for_window()) << program.error();
  program.click(1);
  program.tap(XK_e);
  ASSERT_TRUE(program.wait_for_frames(2));
  program.terminate();
  // Its frame log is written.
  EXPECT_EQ(program.wait(), static_cast<int>(ErrorCode::partial)) << program.error();
  const std::filesystem::path autosave = autosave_in(folder_);
  EXPECT_NE(program.error().find("the session is saved in ./" + autosave.filename().string()),
            std::string::npos)
      << program.error();
  const auto saved = scene::load_timeline(autosave);
  ASSERT_TRUE(saved) << saved.failure().message;
  EXPECT_EQ(saved->smokes.size(), 1u);
  EXPECT_EQ(saved->blasts.size(), 1u);
}

TEST_F(RecordingTest, AClosedSessionLeavesNoAutosave) {
  Program program(desktop_, folder_.path(), {"room.toml", "--size", "64x40", "--quality", "smallest"});
  ASSERT_TRUE(program.wait_for_window()) << program.error();
  program.click(1);
  while (autosave_in(folder_).empty() && program.wait_for_frames(1)) {
  }
  ASSERT_NE(autosave_in(folder_), "") << program.error();
  program.close();
  EXPECT_EQ(program.wait(), 0) << program.error();
  EXPECT_EQ(autosave_in(folder_), "");
}

}  // namespace
}  // namespace brume::viewer
