// A thousand keys, clicks, moves and sizes at random: nothing breaks, the validation layers say nothing, and
// memory stays as it is.
#include <X11/keysym.h>

#include <random>

#include "tests/viewer/room.hpp"

namespace brume::viewer {
namespace {

constexpr int kWarmUp = 500, kEvents = 1000;  // by then all that is made once was made

TEST(EventsTest, AThousandAtRandom) {
  const cli::WorkFolder folder;
  write_room(folder);
  const Desktop desktop;
  Program program(
      desktop, folder.path(),
      {"room.toml", "--size", "160x96", "--quality", "smallest", "--validation", "--json", "r.json"});
  ASSERT_TRUE(program.wait_for_window()) << program.error();
  // All keys that do something, but for those that write files.
  const std::vector<unsigned long> keys{
      XK_w, XK_a, XK_s, XK_d, XK_space, XK_Shift_L, XK_g, XK_1,      XK_2,   XK_3, XK_4, XK_e,
      XK_f, XK_l, XK_r, XK_p, XK_comma, XK_period,  XK_v, XK_Escape, XK_Tab, XK_o, XK_h};
  std::mt19937 random(7);
  const auto pick = [&](unsigned count) { return static_cast<unsigned>(random() % count); };
  // The whole screen and back: the largest picture is made before memory is looked at.
  program.tap(XK_F11);
  EXPECT_TRUE(program.wait_for_picture([](const image::Image8& now) { return now.width == 1280; }));
  sleep_ms(1500);
  program.tap(XK_F11);
  EXPECT_TRUE(program.wait_for_picture([](const image::Image8& now) { return now.width == 160; }));
  std::uint64_t warm_bytes = 0;
  for (int event = -kWarmUp; event < kEvents && program.runs(); ++event) {
    if (event == 0) warm_bytes = program.resident_bytes();
    switch (pick(8)) {
      case 0:
      case 1:
      case 2:
        program.tap(keys[pick(static_cast<unsigned>(keys.size()))]);
        break;
      case 3: {
        const unsigned long held = keys[pick(6)];
        program.key(held, true);
        sleep_ms(30);
        program.key(held, false);
        break;
      }
      case 4:
        program.click(1 + pick(3));
        break;
      case 5:
        program.place_mouse(static_cast<int>(pick(160)), static_cast<int>(pick(96)));
        break;
      case 6:
        program.move_mouse(static_cast<int>(pick(81)) - 40, static_cast<int>(pick(41)) - 20);
        break;
      default:
        if (pick(5) == 0) program.resize(1 + pick(240), 1 + pick(160));
    }
    sleep_ms(static_cast<int>(pick(30)));
  }
  ASSERT_TRUE(program.runs()) << program.error();
  const double grown = static_cast<double>(program.resident_bytes()) - static_cast<double>(warm_bytes);
  program.close();
  EXPECT_EQ(program.wait(), 0) << program.error();
  const auto report = read_json(folder.path() / "r.json");
  ASSERT_TRUE(report.is_object());
  EXPECT_TRUE(report.at("validation_messages").empty()) << report.at("validation_messages").dump();
  // The log of actions grows, by some kilobytes. A frame that forgot its smallest picture (160 x 96 pixels of 4
  // bytes) would be noticed after the 550 of them that any machine draws meanwhile.
  EXPECT_GT(report.at("frames"), 550);
  EXPECT_LT(grown, 550.0 * 160 * 96 * 4) << report.dump();
}

}  // namespace
}  // namespace brume::viewer
