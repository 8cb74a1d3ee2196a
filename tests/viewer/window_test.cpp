// The window: input, panels, resizing, surface and device loss, shader reload.
#include "scene/files/timeline_reader.hpp"
#include "scene/timeline.hpp"
#include "tests/viewer/random_events.hpp"
#include "tests/viewer/room.hpp"

namespace brume::viewer {
namespace {

class WindowTest : public testing::Test {
 protected:
  WindowTest() { write_room(folder_); }

  std::filesystem::path file(const std::string& name) const { return folder_.path() / name; }
  std::vector<std::string> arguments(std::vector<std::string> more = {}) const {
    std::vector<std::string> words{"room.toml", "--size", "192x128", "--quality", "quarter", "--validation"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  static void expect_end(Program& program) {
    program.close();
    EXPECT_EQ(program.wait(), 0) << program.error();
  }

  cli::WorkFolder folder_;
  Desktop desktop_;
};

TEST(NoDisplayTest, FailsAndSuggestsRender) {
  const cli::WorkFolder folder;
  cli::RunOptions options;
  options.environment = {{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}};
  cli::expect_failure(folder, {"view", BRUME_SOURCE_DIR "/scenes/demo.toml"}, 5,
                      {"cannot open a window", "brume render"}, options);
}

TEST(ArgumentsTest, WhatIsUsedLaterIsCheckedFirst) {
  const cli::WorkFolder folder;
  const auto refuses = [&](std::vector<std::string> words, int code, const std::string& part) {
    words.insert(words.begin(), {"view", BRUME_SOURCE_DIR "/scenes/demo.toml"});
    cli::expect_failure(folder, words, code, {part});
  };
  refuses({"--shot", "none.png"}, 3, "--shot none.png");
  refuses({"--folder", "none"}, 3, "--folder none: no such folder");
  refuses({"--shaders", "none"}, 3, "--shaders none: no such folder");
  refuses({"--word", ""}, 2, "--word");
  refuses({"--word", " "}, 2, "--word");
}

// Even with --force, which allows to replace it.
TEST_F(WindowTest, AnEarlierFrameLogRemainsIfNothingIsDrawn) {
  folder_.write("frames.csv", "of another program\n");
  folder_.write("broken.toml", "version = 1\nscene =\n");
  folder_.write("tank.toml", "version = 1\n[tank]\nspheres = 3\n");
  cli::RunOptions on_desktop;
  on_desktop.environment = {{"DISPLAY", desktop_.name()}};
  const auto fails = [&](std::vector<std::string> words, int code, const std::string& part) {
    words.insert(words.begin(), {"view", "--frame-log", "frames.csv", "--force"});
    cli::expect_failure(folder_, words, code, {part}, on_desktop);
  };
  fails({"room.toml", "--device", "none of that name"}, 5, "none of that name");
  fails({"tank.toml", "--device", "none of that name"}, 5, "none of that name");
  fails({"broken.toml"}, 3, "broken.toml:2");
}

TEST_F(WindowTest, RunsFromItsTimeToItsEnd) {
  Program program(desktop_, folder_.path(),
                  arguments({"--time", "1", "--exit-after", "1.2", "--json", "r.json"}));
  ASSERT_EQ(program.wait(), 0) << program.error();
  EXPECT_NEAR(read_json(file("r.json")).at("seconds").get<double>(), 1.2, 1e-6);
}

// Help, undo and emptying by their keys; the help stops the time.
TEST_F(WindowTest, UndoesByKeys) {
  Program program(desktop_, folder_.path(), arguments({"--bare", "--record", "made.toml"}));
  ASSERT_TRUE(program.wait_for_window()) << program.error();
  const auto tap = [&](unsigned long key) {
    program.tap(key);
    ASSERT_TRUE(program.wait_for_frames(2));
  };
  const auto tap_with = [&](unsigned long modifier, unsigned long key) {
    program.key(modifier, true);
    tap(key);
    program.key(modifier, false);
    ASSERT_TRUE(program.wait_for_frames(2));
  };
  program.click(1);
  program.wait_for_frames(2);
  program.click(3);
  program.wait_for_frames(2);
  program.click(3);
  program.wait_for_frames(2);
  tap_with(XK_Control_L, XK_z);
  tap_with(XK_Shift_L, XK_r);
  tap_with(XK_Control_L, XK_z);
  tap_with(XK_Control_L, XK_z);
  tap_with(XK_Control_L, XK_y);
  tap(XK_h);
  const double then = program.frames().back().seconds;
  ASSERT_TRUE(program.wait_for_frames(5));
  EXPECT_EQ(program.frames().back().seconds, then);
  tap(XK_h);
  ASSERT_TRUE(program.wait_for_clock(0.1));
  expect_end(program);
  // A smoke and one of the two shots remain.
  const auto made = scene::load_timeline(file("made.toml")).value_or_throw();
  EXPECT_EQ(made.smokes.size(), 1u);
  EXPECT_EQ(made.shots.size(), 1u);
}

TEST_F(WindowTest, ThrowsAndShoots) {
  Program program(desktop_, folder_.path(), arguments({"--bare"}));
  ASSERT_TRUE(program.wait_for_window()) << program.error();
  const image::Image8 empty = program.contents();
  program.click(1);
  // Smoke fills the view.
  ASSERT_TRUE(program.wait_for_contents([&](const auto& now) { return mean_difference(now, empty) > 8; }))
      << mean_difference(program.contents(), empty);
  ASSERT_TRUE(program.wait_for_clock(1.5));
  // At the same tick, so that only the shot makes the two images differ; its flash is over by then.
  constexpr int kTicks = 16;
  const auto step = [&](unsigned long key) {
    for (int tick = 0; tick < kTicks; ++tick) {
      program.tap(key);
      program.wait_for_frames(2);  // GLFW treats immediate taps as repeats of a held key
    }
    return program.wait_for_best();
  };
  program.tap(XK_p);
  ASSERT_TRUE(step(XK_period));
  // A hole where the shot was aimed, and nowhere else.
  const auto part = [](const image::Image8& image, unsigned left, unsigned top) {
    image::Image8 cut;
    for (unsigned y = top; y < top + 12; ++y)
      for (unsigned x = 4 * left; x < 4 * (left + 12); ++x)
        cut.rgba.push_back(image.rgba[std::size_t{4} * image.width * y + x]);
    return cut;
  };
  const auto middle = [&](const image::Image8& image) { return part(image, 192 / 2 - 6, 128 / 2 - 6); };
  const auto corner = [&](const image::Image8& image) { return part(image, 4, 4); };
  const image::Image8 thick = program.contents();
  ASSERT_TRUE(step(XK_comma));
  program.click(3);
  ASSERT_TRUE(step(XK_period));
  const image::Image8 pierced = program.contents();
  EXPECT_GT(mean_difference(middle(pierced), middle(thick)), 10);
  EXPECT_LT(mean_difference(corner(pierced), corner(thick)), 3);
  expect_end(program);
}

// Right of the middle, below: between the weapon and where it aims.
TEST_F(WindowTest, AShotShowsATracer) {
  Program program(desktop_, folder_.path(), arguments({"--size", "320x240"}));
  ASSERT_TRUE(program.wait_for_window()) << program.error();
  const auto settled = [&](unsigned long key) {
    program.tap(key);
    EXPECT_TRUE(program.wait_for_best());
    const image::Image8 image = program.contents();
    image::Image8 cut;
    for (unsigned y = 130; y < 190; ++y)
      for (unsigned x = 4 * 172; x < 4 * 240; ++x)
        cut.rgba.push_back(image.rgba[std::size_t{4} * image.width * y + x]);
    return cut;
  };
  settled(XK_p);
  program.click(3);
  const image::Image8 shot = settled(XK_period);
  // The same without text and marks.
  EXPECT_GT(mean_difference(shot, settled(XK_o)), 3);
  settled(XK_o);
  for (int tick = 0; tick < 40; ++tick) {
    program.tap(XK_period);
    program.wait_for_frames(2);
  }
  const image::Image8 later = settled(XK_period);
  EXPECT_LT(mean_difference(later, settled(XK_o)), 0.1);
  expect_end(program);
}

TEST_F(WindowTest, OpensPanelsAndHelp) {
  Program program(desktop_, folder_.path(), arguments({"--size", "800x500", "--bare"}));
  ASSERT_TRUE(program.wait_for_window()) << program.error();
  program.tap(XK_p);
  ASSERT_TRUE(program.wait_for_best());
  const image::Image8 bare = program.contents();
  program.tap(XK_Tab);
  EXPECT_TRUE(program.wait_for_contents([&](const auto& now) { return mean_difference(now, bare) > 3; }));
  program.tap(XK_Tab);
  EXPECT_TRUE(program.wait_for_contents([&](const auto& now) { return mean_difference(now, bare) < 1; }));
  program.tap(XK_h);
  EXPECT_TRUE(program.wait_for_contents([&](const auto& now) { return mean_difference(now, bare) > 3; }));
  expect_end(program);
}

TEST_F(WindowTest, SurvivesResizingAndHiding) {
  Program program(desktop_, folder_.path(), arguments());
  ASSERT_TRUE(program.wait_for_window()) << program.error();
  for (const glm::uvec2 size : {glm::uvec2(333, 77), glm::uvec2(16, 200), glm::uvec2(640, 360),
                                glm::uvec2(1, 1), glm::uvec2(192, 128)}) {
    program.resize(size.x, size.y);
    EXPECT_TRUE(program.wait_for_contents(
        [&](const auto& now) { return now.width == size.x && now.height == size.y; }));
    EXPECT_TRUE(program.wait_for_frame([&](const Frame& now) { return now.size_px == size; }));
    EXPECT_TRUE(program.wait_for_frames(4));
  }
  program.hide();
  EXPECT_TRUE(program.wait_for_frames(4));  // X allows reading a hidden window
  program.show();
  EXPECT_TRUE(program.wait_for_contents([&](const auto& now) { return count_colours(now) > 20; }));
  expect_end(program);
}

// More of them, and the memory that they leave: viewer_events_tests.
TEST_F(WindowTest, SurvivesRandomEvents) {
  Program program(desktop_, folder_.path(), arguments({"--size", "160x96", "--json", "r.json"}));
  ASSERT_TRUE(program.wait_for_window()) << program.error();
  RandomEvents().send(program, 150);
  ASSERT_TRUE(program.runs()) << program.error();
  expect_end(program);
  const auto report = read_json(file("r.json"));
  ASSERT_TRUE(report.is_object());
  EXPECT_TRUE(report.at("validation_messages").empty()) << report.at("validation_messages").dump();
}

TEST_F(WindowTest, SurvivesSurfaceAndDeviceLoss) {
  Program program(
      desktop_, folder_.path(),
      arguments({"--lose-surface", "0.4", "--lose-device", "0.8", "--exit-after", "2", "--json", "r.json"}));
  ASSERT_EQ(program.wait(), 0) << program.error();
  const auto report = read_json(file("r.json"));
  EXPECT_EQ(report.at("devices_lost"), 1);
  EXPECT_TRUE(report.at("validation_messages").empty());
}

TEST_F(WindowTest, ReloadsShadersAndRejectsBrokenOnes) {
  std::filesystem::copy(BRUME_SHADERS_DIR, file("shaders"), std::filesystem::copy_options::recursive);
  Program program(desktop_, folder_.path(),
                  arguments({"--bare", "--shaders", "shaders", "--json", "r.json"}));
  ASSERT_TRUE(program.wait_for_window()) << program.error();
  // As editors do: the new file atomically replaces the old one. Its time differs whatever the resolution of
  // the file system.
  auto changed = std::filesystem::last_write_time(file("shaders/display.comp"));
  const auto rewrite = [&](const std::string& from, const std::string& to) {
    std::ifstream in(file("shaders/display.comp"));
    std::string text(std::istreambuf_iterator<char>(in), {});
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos);
    text.replace(at, from.size(), to);
    std::ofstream(file("shaders/display.new")) << text;
    std::filesystem::last_write_time(file("shaders/display.new"), changed += std::chrono::seconds(2));
    std::filesystem::rename(file("shaders/display.new"), file("shaders/display.comp"));
  };
  const std::string colour = "displayed(px, imageLoad(radiance_image, px).rgb, params.dither)";
  const std::string red = "vec4(1.0, 0.0, 0.0, 1.0)";
  const auto is_red = [](const image::Image8& now) {
    return count_colours(now) == 1 && now.rgba[0] == 255 && now.rgba[1] == 0;
  };
  rewrite(colour, red);
  EXPECT_TRUE(program.wait_for_contents(is_red));
  // Broken: the red one stays in use.
  rewrite(red, "vec4(1.0, 0.0, 0.0, unknown)");
  EXPECT_TRUE(program.wait_for_frame([](const Frame& now) { return now.shader_faults == 1; }));
  EXPECT_TRUE(program.wait_for_frames(4));
  EXPECT_TRUE(is_red(program.contents()));
  rewrite("vec4(1.0, 0.0, 0.0, unknown)", colour);
  EXPECT_TRUE(program.wait_for_contents([](const auto& now) { return count_colours(now) > 20; }));
  expect_end(program);
  EXPECT_EQ(read_json(file("r.json")).at("shader_reloads"), 2);
}

}  // namespace
}  // namespace brume::viewer
