#include "apps/viewer/keys.hpp"

#include <GLFW/glfw3.h>

#include <array>

namespace brume::viewer {
namespace {

constexpr std::array kBindings{
    KeyBinding{Action::forward, false, GLFW_KEY_W, "W", "walk forward"},
    KeyBinding{Action::left, false, GLFW_KEY_A, "A", "walk left"},
    KeyBinding{Action::back, false, GLFW_KEY_S, "S", "walk back"},
    KeyBinding{Action::right, false, GLFW_KEY_D, "D", "walk right"},
    KeyBinding{Action::up, false, GLFW_KEY_SPACE, "Space", "fly up; jump"},
    KeyBinding{Action::down, false, GLFW_KEY_LEFT_SHIFT, "Shift", "fly down; run"},
    KeyBinding{Action::down, false, GLFW_KEY_RIGHT_SHIFT, "Right Shift", "fly down; run"},
    KeyBinding{Action::fly, false, GLFW_KEY_G, "G", "fly or walk"},
    KeyBinding{Action::throw_smoke, true, GLFW_MOUSE_BUTTON_LEFT, "Mouse left", "throw a smoke grenade"},
    KeyBinding{Action::shoot, true, GLFW_MOUSE_BUTTON_RIGHT, "Mouse right", "shoot"},
    KeyBinding{Action::free_cursor, true, GLFW_MOUSE_BUTTON_MIDDLE, "Mouse middle",
               "hold: free the cursor, and aim with it"},
    KeyBinding{Action::toggle_cursor, false, GLFW_KEY_ESCAPE, "Esc", "free the cursor, or capture it again"},
    KeyBinding{Action::shape_bullet, false, GLFW_KEY_1, "1", "shoot bullets"},
    KeyBinding{Action::shape_glyph, false, GLFW_KEY_2, "2", "shoot letters, one per shot"},
    KeyBinding{Action::shape_word, false, GLFW_KEY_3, "3", "shoot the whole word"},
    KeyBinding{Action::shape_picture, false, GLFW_KEY_4, "4", "shoot the shape of an image"},
    KeyBinding{Action::blast, false, GLFW_KEY_E, "E", "set off an explosion where you look"},
    KeyBinding{Action::door, false, GLFW_KEY_F, "F", "open or close the nearest door"},
    KeyBinding{Action::probe, false, GLFW_KEY_L, "L",
               "line of sight: set the first end, the second end, remove it"},
    KeyBinding{Action::reset, false, GLFW_KEY_R, "R", "reset: back to the start, discarding all actions"},
    KeyBinding{Action::pause, false, GLFW_KEY_P, "P", "pause or resume"},
    KeyBinding{Action::step_back, false, GLFW_KEY_COMMA, ",", "step one tick back"},
    KeyBinding{Action::step_on, false, GLFW_KEY_PERIOD, ".", "step one tick forward"},
    KeyBinding{Action::next_view, false, GLFW_KEY_V, "V", "next debug view"},
    KeyBinding{Action::screenshot, false, GLFW_KEY_F12, "F12",
               "save a screenshot and the timeline that reproduces it"},
    KeyBinding{Action::save_recording, false, GLFW_KEY_F5, "F5", "save the session as a timeline"},
    KeyBinding{Action::panels, false, GLFW_KEY_TAB, "Tab", "show or hide the panels"},
    KeyBinding{Action::overlay, false, GLFW_KEY_O, "O", "show or hide the statistics"},
    KeyBinding{Action::full_screen, false, GLFW_KEY_F11, "F11", "toggle full screen"},
    KeyBinding{Action::help, false, GLFW_KEY_H, "H", "this help"},
};

}  // namespace

std::span<const KeyBinding> key_bindings() {
  return kBindings;
}

}  // namespace brume::viewer
