// Random input to the viewer, equal on every machine.
#pragma once

#include <X11/keysym.h>

#include <array>
#include <random>

#include "tests/viewer/desktop.hpp"

namespace brume::viewer {

/// All bound keys except for those that write files.
inline constexpr std::array<unsigned long, 23> kKeys{
    XK_w, XK_a, XK_s, XK_d, XK_space, XK_Shift_L, XK_g, XK_1,      XK_2,   XK_3, XK_4, XK_e,
    XK_f, XK_l, XK_r, XK_p, XK_comma, XK_period,  XK_v, XK_Escape, XK_Tab, XK_o, XK_h};

/// Sends random keys, clicks, mouse moves and resizes to a window of 160 x 96 pixels, one frame apart.
class RandomEvents {
 public:
  void send(Program& program, int count) {
    for (int event = 0; event < count && program.runs(); ++event) {
      send_one(program);
      program.wait_for_frames(1);
    }
  }

 private:
  unsigned pick(unsigned count) { return static_cast<unsigned>(random_() % count); }
  void send_one(Program& program) {
    switch (pick(8)) {
      case 0:
      case 1:
      case 2:
        program.tap(kKeys[pick(static_cast<unsigned>(kKeys.size()))]);
        break;
      case 3: {
        const unsigned long held = kKeys[pick(6)];
        program.key(held, true);
        program.wait_for_frames(2);
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
  }
  std::mt19937 random_{7};
};

}  // namespace brume::viewer
