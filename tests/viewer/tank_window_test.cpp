// The window of a tank of spheres: pictures, input, packing, files, and the loss of its device.
#include <X11/keysym.h>

#include <algorithm>
#include <regex>

#include "core/file.hpp"
#include "image/decode.hpp"
#include "scene/files/tank_reader.hpp"
#include "scene/tank_scene.hpp"
#include "spheres/file.hpp"
#include "tests/viewer/small_tank.hpp"

namespace brume::viewer {
namespace {

class TankWindowTest : public testing::Test {
 protected:
  TankWindowTest() { write_tank(folder_); }

  std::filesystem::path file(const std::string& name) const { return folder_.path() / name; }
  void run(const std::vector<std::string>& more = {}, const std::string& size = "240x160") {
    std::vector<std::string> words{"tank.toml", "--size", size, "--validation", "--json", "r.json"};
    words.insert(words.end(), more.begin(), more.end());
    program_.emplace(desktop_, folder_.path(), words);
  }
  void run_and_wait(const std::vector<std::string>& more = {}, const std::string& size = "240x160") {
    run(more, size);
    ASSERT_TRUE(program_->wait_for_window()) << program_->error();
    ASSERT_TRUE(program_->wait_for_best()) << program_->error();
  }
  /// Its report, after its end without messages of the validation layers.
  nlohmann::json finish() {
    program_->close();
    return report();
  }
  nlohmann::json report() {
    EXPECT_EQ(program_->wait(), 0) << program_->error();
    const auto report = read_json(file("r.json"));
    EXPECT_EQ(report.value("validation_messages", nlohmann::json("none")), nlohmann::json::array());
    return report;
  }
  void tap(unsigned long key) {
    program_->tap(key);
    program_->wait_for_frames(3);
    program_->wait_for_best();
  }
  /// Holds a button at a place and moves the mouse to another one.
  void drag(unsigned button, glm::ivec2 from, glm::ivec2 to) {
    program_->place_mouse(from.x, from.y);
    program_->wait_for_frames(3);
    program_->button(button, true);
    program_->wait_for_frames(3);
    program_->place_mouse(to.x, to.y);
    program_->wait_for_frames(3);
    program_->button(button, false);
    program_->wait_for_frames(3);
    program_->wait_for_best();
  }
  bool has_widget(const std::string& label) {
    const auto& all = program_->widgets();
    return std::ranges::find(all, label, &WidgetLine::label) != all.end();
  }
  WidgetLine widget(const std::string& label) {
    const auto& all = program_->widgets();
    const auto found = std::ranges::find(all, label, &WidgetLine::label);
    if (found != all.end()) return *found;
    ADD_FAILURE() << label << " is not there; " << program_->error();
    return {};
  }
  void click(glm::ivec2 place) {
    program_->place_mouse(place.x, place.y);
    program_->wait_for_frames(2);
    program_->click(1);
    program_->wait_for_frames(4);
  }
  void click(const std::string& label) {
    const WidgetLine at = widget(label);
    click((at.low_px + at.high_px) / 2);
  }
  /// `brume render` of a scene in the window's size.
  image::Image8 rendered(const std::string& scene, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"render", scene, "-o", "again.png", "--size", "240x160"};
    words.insert(words.end(), more.begin(), more.end());
    const cli::Outcome outcome = cli::run_brume(folder_.path(), words);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.error;
    return image::load_image(file("again.png")).value_or_throw();
  }
  scene::TankScene saved(const std::string& name) {
    return scene::load_tank_scene(file(name)).value_or_throw();
  }

  cli::WorkFolder folder_;
  Desktop desktop_;
  std::optional<Program> program_;
};

TEST_F(TankWindowTest, ItsScreenshotIsWhatRenderDraws) {
  run({"--exit-after", "0.5", "--screenshot", "shot.png"});
  const auto result = report();
  EXPECT_EQ(result.at("seconds"), 0.5);
  EXPECT_EQ(result.at("samples_per_pixel"), 6);
  EXPECT_EQ(result.at("size"), (std::vector<int>{240, 160}));
  EXPECT_GT(result.at("spheres").get<int>(), 50);
  const image::Image8 shot = image::load_image(file("shot.png")).value_or_throw();
  EXPECT_GT(count_colours(shot), 500u);
  // Sums of the same samples in other groups, and one rounding to a byte.
  EXPECT_LE(largest_difference(shot, rendered("tank.toml", {"--time", "0.5"})), 1);
  EXPECT_LE(largest_difference(shot, rendered("shot.toml")), 1);
}

TEST_F(TankWindowTest, BatchesOfLightPathsAreThoseOfRender) {
  write_tank(folder_, "35");  // more than two batches
  run_and_wait({"--bare"});
  const image::Image8 shown = program_->contents();
  finish();
  EXPECT_LE(largest_difference(shown, rendered("tank.toml", {"--time", "0"})), 1);
  // Without light through the glass, it is another picture.
  folder_.write("dark.toml", std::regex_replace(read_text_file(file("tank.toml")).value_or_throw(),
                                                std::regex("photons = 100000"), "photons = 0"));
  EXPECT_GT(largest_difference(shown, rendered("dark.toml", {"--time", "0"})), 20);
}

TEST_F(TankWindowTest, TheWindowShowsThePictureOfRender) {
  run_and_wait({"--bare"});
  EXPECT_LE(largest_difference(program_->contents(), rendered("tank.toml", {"--time", "0"})), 1);
  // The view with voxels, too.
  tap(XK_v);
  tap(XK_F12);
  EXPECT_EQ(saved("brume_0001.toml").view, scene::TankView::voxels);
  const image::Image8 shot = image::load_image(file("brume_0001.png")).value_or_throw();
  EXPECT_LE(largest_difference(shot, rendered("brume_0001.toml")), 1);
  EXPECT_LE(largest_difference(shot, program_->contents()), 1);
  finish();
}

TEST_F(TankWindowTest, TheMouseMovesCameraAndLights) {
  run_and_wait();
  const scene::TankScene file_scene = saved("tank.toml");
  // Beside the marks, and below the text in the corner.
  drag(1, {40, 140}, {70, 130});
  tap(XK_F5);
  const scene::TankScene turned = saved("tank_0001.toml");
  ASSERT_EQ(turned.camera.size(), 1u);
  EXPECT_NE(turned.camera[0].camera.position_world, file_scene.camera[0].camera.position_world);
  EXPECT_EQ(turned.camera[0].camera.target_world, file_scene.camera[0].camera.target_world);
  drag(3, {40, 140}, {50, 130});
  tap(XK_Home);
  tap(XK_F5);
  EXPECT_EQ(saved("tank_0002.toml").camera[0].camera.position_world,
            file_scene.camera[0].camera.position_world);

  // The glass: 240x160 pixels, 42 degrees, 1.9 m away: its mark is at (120 + 11, 80 + 11).
  drag(1, {131, 91}, {151, 91});
  tap(XK_F5);
  const scene::TankScene moved = saved("tank_0003.toml");
  EXPECT_GT(moved.glass->position_world.x, file_scene.glass->position_world.x + 0.1f);
  EXPECT_EQ(moved.glass->position_world.z, file_scene.glass->position_world.z);
  // Undo.
  program_->key(XK_Control_L, true);
  tap(XK_z);
  program_->key(XK_Control_L, false);
  program_->wait_for_frames(2);
  tap(XK_F5);
  EXPECT_EQ(saved("tank_0004.toml").glass->position_world, file_scene.glass->position_world);
  finish();
}

TEST_F(TankWindowTest, SavesTheSceneAndTheSpheresAsTheyAre) {
  run_and_wait();
  tap(XK_F5);
  tap(XK_F6);
  const auto result = finish();
  EXPECT_EQ(read_text_file(file("tank_0001.toml")).value_or_throw().find("version = 1"), 0u);
  const spheres::Tank tank = spheres::load_tank(file("spheres_0001.spheres")).value_or_throw();
  EXPECT_EQ(tank.spheres.size(), result.at("spheres").get<std::size_t>());
  // A tank alone shows, too.
  program_.emplace(desktop_, folder_.path(),
                   std::vector<std::string>{"spheres_0001.spheres", "--size", "240x160", "--validation",
                                            "--exit-after", "0.1", "--json", "r.json"});
  EXPECT_EQ(report().at("spheres"), tank.spheres.size());
}

TEST_F(TankWindowTest, TimeRunsWithPlayAndStopsByKey) {
  program_.emplace(desktop_, folder_.path(),
                   std::vector<std::string>{"--play", "tank.toml", "--size", "240x160", "--validation",
                                            "--json", "r.json"});
  ASSERT_TRUE(program_->wait_for_window()) << program_->error();
  ASSERT_TRUE(program_->wait_for_frame([](const Frame& frame) { return frame.seconds > 0.2; }));
  program_->tap(XK_p);
  ASSERT_TRUE(program_->wait_for_best());
  const double then = program_->frames().back().seconds;
  program_->wait_for_frames(3);
  EXPECT_EQ(program_->frames().back().seconds, then);
  tap(XK_r);
  EXPECT_EQ(program_->frames().back().seconds, 0);
  finish();
}

TEST_F(TankWindowTest, SurvivesResizingAndTheLossOfDeviceAndSurface) {
  program_.emplace(
      desktop_, folder_.path(),
      std::vector<std::string>{"--play", "tank.toml", "--size", "240x160", "--validation", "--json", "r.json",
                               "--lose-device", "0.1", "--lose-surface", "0.2"});
  ASSERT_TRUE(program_->wait_for_window()) << program_->error();
  program_->resize(200, 120);
  ASSERT_TRUE(program_->wait_for_frame(
      [](const Frame& frame) { return frame.size_px == glm::uvec2(200, 120) && frame.seconds > 0.3; }));
  EXPECT_EQ(program_->contents().width, 200u);
  EXPECT_EQ(finish().at("devices_lost"), 1);
}

TEST_F(TankWindowTest, AnEmptyTankIsAPictureOfTheSky) {
  folder_.write("empty.toml", "version = 1\n[tank]\nspheres = 0\nsamples = 1\n");
  program_.emplace(desktop_, folder_.path(),
                   std::vector<std::string>{"empty.toml", "--size", "240x160", "--validation", "--exit-after",
                                            "0.1", "--screenshot", "shot.png", "--json", "r.json"});
  EXPECT_EQ(report().at("spheres"), 0);
}

TEST_F(TankWindowTest, PacksOthersInTheBackground) {
  run_and_wait({"--panels", "--log-widgets"}, "640x700");
  for (const char* label : {"Picture", "Lights", "Packing"}) click(label);  // folds two, unfolds one
  // Half of the slider, of spheres.
  const WidgetLine spheres = widget("##spheres ");
  click((spheres.low_px + spheres.high_px) / 2);
  click("Pack");
  ASSERT_TRUE(program_->wait_for_frame([&](const Frame&) { return !has_widget("Stop here"); }));
  tap(XK_F5);
  const auto result = finish();
  EXPECT_EQ(result.at("packings"), 1);
  EXPECT_NE(saved("tank_0001.toml").pack.count, saved("tank.toml").pack.count);
}

TEST_F(TankWindowTest, EscapeClosesTheColourPickerOfALight) {
  run_and_wait({"--panels", "--log-widgets"}, "640x700");
  EXPECT_FALSE(has_widget("##picker"));
  click("##swatch");
  EXPECT_TRUE(has_widget("##picker"));
  tap(XK_Escape);
  EXPECT_FALSE(has_widget("##picker"));
  finish();
}

TEST_F(TankWindowTest, PackingStopsWithTheSpheresSoFar) {
  // More than there is room for: that takes minutes.
  folder_.write("tank.toml",
                "version = 1\n[tank]\nsize = [800, 600, 500]\nspheres = 8000000\nradius = [1, 3]\n"
                "samples = 1\n");
  run({"--log-widgets"});
  ASSERT_TRUE(program_->wait_for_window()) << program_->error();
  ASSERT_TRUE(program_->wait_for_frame([&](const Frame&) { return has_widget("Stop here"); }));
  click("Stop here");
  ASSERT_TRUE(program_->wait_for_best()) << program_->error();
  const auto result = finish();
  EXPECT_LT(result.at("spheres").get<std::uint32_t>(), 8000000u);
}

// The errors of scenes and options are those of the command line.
TEST_F(TankWindowTest, RefusesWhatDoesNotFit) {
  folder_.write("wrong.toml", "version = 1\n[tank]\nsamples = 0\n");
  const auto run_to_end = [&](const std::vector<std::string>& words) {
    program_.emplace(desktop_, folder_.path(), words);
    return program_->wait();
  };
  EXPECT_EQ(run_to_end({"wrong.toml"}), 3);
  EXPECT_NE(program_->error().find("samples"), std::string::npos) << program_->error();
  for (const char* option : {"--quality=half", "--word=A", "--sun=1,2", "--record=a.toml"}) {
    EXPECT_EQ(run_to_end({"tank.toml", option}), 2) << option;
    EXPECT_NE(program_->error().find("is not for a tank"), std::string::npos) << program_->error();
  }
}

}  // namespace
}  // namespace brume::viewer
