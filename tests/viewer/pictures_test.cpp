// The images of docs/guides/viewer.md: checks their contents; writes them if BRUME_PICTURES names a folder.
#include <X11/keysym.h>

#include <cstdlib>

#include "core/file.hpp"
#include "tests/viewer/room.hpp"

namespace brume::viewer {
namespace {

class PicturesTest : public testing::Test {
 protected:
  static void keep(const image::Image8& image, const char* name) {
    if (const char* folder = std::getenv("BRUME_PICTURES"))
      image::save_png(std::filesystem::path(folder) / name, image).value_or_throw();
  }
  static image::Image8 settled(Program& program) {
    EXPECT_TRUE(program.wait_for_best());
    return program.contents();
  }

  cli::WorkFolder folder_;
  Desktop desktop_;
};

TEST_F(PicturesTest, ShowTheDemoWithPanelsHelpAndProbe) {
  Program program(desktop_, folder_.path(),
                  {"--play", BRUME_SOURCE_DIR "/scenes/demo.toml", "--time", "3.8", "--quality", "smallest",
                   "--size", "1120x630"});
  ASSERT_TRUE(program.wait_for_window()) << program.error();
  for (int tick = 0; tick < 20; ++tick) {  // frames for the graph
    program.tap(XK_period);
    program.wait_for_best();
  }
  const image::Image8 plain = settled(program);
  keep(plain, "viewer.png");

  program.place_mouse(470, 330);
  program.tap(XK_h);
  const image::Image8 help = settled(program);
  keep(help, "viewer_help.png");
  EXPECT_GT(mean_difference(help, plain), 5);
  program.tap(XK_h);

  // With the panels open the cursor is free: the ends of the probe go where it points.
  program.tap(XK_Tab);
  settled(program);
  for (const glm::ivec2 place : {glm::ivec2(330, 500), glm::ivec2(425, 330)}) {
    program.place_mouse(place.x, place.y);
    settled(program);
    program.tap(XK_l);
    settled(program);
  }
  const image::Image8 panels = settled(program);
  keep(panels, "viewer_panels.png");
  EXPECT_GT(mean_difference(panels, plain), 5);
  program.close();
  EXPECT_EQ(program.wait(), 0) << program.error();
}

TEST_F(PicturesTest, ShowATankWithItsPanels) {
  // The scene of the program with glass before it, and fewer samples.
  std::string scene = read_text_file(BRUME_SOURCE_DIR "/scenes/aquaria.toml").value_or_throw();
  scene.replace(scene.find("samples = 64"), 12, "samples = 8");
  folder_.write("aquaria.toml",
                scene + "\n[glass]\nposition = [-0.35, 0.1, 0.75]\nradii = [0.2, 0.2, 0.2]\n");
  Program program(desktop_, folder_.path(), {"aquaria.toml", "--size", "1120x630"});
  ASSERT_TRUE(program.wait_for_window()) << program.error();
  const image::Image8 plain = settled(program);
  EXPECT_GT(count_colours(plain), 10000u);
  program.tap(XK_Tab);
  const image::Image8 panels = settled(program);
  keep(panels, "viewer_tank.png");
  EXPECT_GT(mean_difference(panels, plain), 5);
  program.close();
  EXPECT_EQ(program.wait(), 0) << program.error();
}

}  // namespace
}  // namespace brume::viewer
