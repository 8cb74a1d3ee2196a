#include "apps/viewer/keys.hpp"

#include <GLFW/glfw3.h>

#include <array>

namespace brume::viewer {
namespace {

constexpr std::array kBindings{
    KeyBinding{Action::forward, false, GLFW_KEY_W, "W", "walk forward"},
    KeyBinding{Action::left, false, GLFW_KEY_A, "A", "walk to the left"},
    KeyBinding{Action::back, false, GLFW_KEY_S, "S", "walk back"},
    KeyBinding{Action::right, false, GLFW_KEY_D, "D", "walk to the right"},
    KeyBinding{Action::up, false, GLFW_KEY_SPACE, "Space", "fly up; jump"},
    KeyBinding{Action::down, false, GLFW_KEY_LEFT_SHIFT, "Shift", "fly down; run"},
    KeyBinding{Action::down, false, GLFW_KEY_RIGHT_SHIFT, "Right Shift", "the same"},
    KeyBinding{Action::fly, false, GLFW_KEY_G, "G", "fly or walk"},
    KeyBinding{Action::throw_smoke, true, GLFW_MOUSE_BUTTON_LEFT, "Mouse left", "throw a smoke grenade"},
    KeyBinding{Action::shoot, true, GLFW_MOUSE_BUTTON_RIGHT, "Mouse right", "shoot"},
    KeyBinding{Action::free_cursor, true, GLFW_MOUSE_BUTTON_MIDDLE, "Mouse middle",
               "held: frees the cursor; what is thrown or shot then goes where it points"},
    KeyBinding{Action::let_cursor_go, false, GLFW_KEY_ESCAPE, "Esc", "frees the cursor, and holds it again"},
    KeyBinding{Action::shape_bullet, false, GLFW_KEY_1, "1", "shoot bullets"},
    KeyBinding{Action::shape_glyph, false, GLFW_KEY_2, "2", "shoot letters, one a shot"},
    KeyBinding{Action::shape_word, false, GLFW_KEY_3, "3", "shoot the whole word"},
    KeyBinding{Action::shape_picture, false, GLFW_KEY_4, "4", "shoot the shape of a PNG picture"},
    KeyBinding{Action::blast, false, GLFW_KEY_E, "E", "an explosion where you look"},
    KeyBinding{Action::door, false, GLFW_KEY_F, "F", "open or shut the nearest door"},
    KeyBinding{Action::probe, false, GLFW_KEY_L, "L",
               "line of sight: the first end, the second end, away with it"},
    KeyBinding{Action::reset, false, GLFW_KEY_R, "R", "back to the beginning, without what was done"},
    KeyBinding{Action::pause, false, GLFW_KEY_P, "P", "pause, go on"},
    KeyBinding{Action::step_back, false, GLFW_KEY_COMMA, ",", "a tick back"},
    KeyBinding{Action::step_on, false, GLFW_KEY_PERIOD, ".", "a tick on"},
    KeyBinding{Action::next_view, false, GLFW_KEY_V, "V", "the next debug view"},
    KeyBinding{Action::screenshot, false, GLFW_KEY_F12, "F12",
               "a screenshot, and beside it the timeline that renders it again"},
    KeyBinding{Action::save_recording, false, GLFW_KEY_F5, "F5", "save what was done as a timeline"},
    KeyBinding{Action::panels, false, GLFW_KEY_TAB, "Tab", "the panels"},
    KeyBinding{Action::overlay, false, GLFW_KEY_O, "O", "the line of figures"},
    KeyBinding{Action::full_screen, false, GLFW_KEY_F11, "F11", "the whole screen, and back"},
    KeyBinding{Action::help, false, GLFW_KEY_H, "H", "this help"},
};

}  // namespace

std::span<const KeyBinding> key_bindings() {
  return kBindings;
}

}  // namespace brume::viewer
