// The widgets of the panels: ImGui's, each of which also reports itself, so that a test can use every one.
// No other file of the viewer calls an ImGui function that takes a click (tests/viewer/widgets_test.cpp).
#pragma once

#include <imgui.h>

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <string>
#include <vector>

namespace brume::viewer {

/// A widget as a frame laid it out.
struct Widget {
  ImGuiID id = 0;
  const char* kind = "";  ///< "button", "slider", ...; "open" and "closed" for what can be unfolded.
  std::string label;      ///< As it shows; an identifier for a widget without a label.
  glm::vec2 low_px{0}, high_px{0};
  bool reachable = false;  ///< Its middle is not scrolled or clipped away.
  bool in_popup = false;
  std::uint64_t uses = 0;  ///< Clicks so far.
};

/// The widgets of a frame, in the order of their layout.
class WidgetLog {
 public:
  void begin_frame() { widgets_.clear(); }
  /// The widget that ImGui has just laid out.
  void add(ImGuiID id, const char* kind, const char* label);
  const std::vector<Widget>& widgets() const { return widgets_; }

 private:
  std::vector<Widget> widgets_;
  std::map<ImGuiID, std::uint64_t> uses_;
};

/// The log of the current ImGui context.
void set_widget_log(WidgetLog* log);

// As the functions of ImGui.
bool button(const char* label);
bool radio(const char* label, bool active);
bool checkbox(const char* label, bool* value);
bool header(const char* label, bool open);
bool begin_tree(const char* label);
bool selectable(const char* label, bool selected);
bool text_field(const char* label, std::string* text);
bool slider(const char* label, float* value, float low, float high, const char* format,
            ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp);
bool slider(const char* label, std::uint32_t* value, std::uint32_t low, std::uint32_t high,
            ImGuiSliderFlags flags);
bool slider(const char* label, double* value, double low, double high);
bool drag(const char* label, float* value, float speed, float low, float high, const char* format);
/// A patch of a colour that opens a popup of the same name.
bool swatch(const char* label, glm::vec3 srgb);
/// A list that opens below what it shows; end_combo() behind its choices where it is open.
bool begin_combo(const char* label, const char* shown);
void end_combo();
/// Closes all popups and lists that are open. Between frames ImGui forgets a key that is pressed and released
/// in one of them, so that this is an action of the window.
void close_popups();
/// An empty area as wide as its window, which takes clicks of the left and the right button and drags.
bool canvas(const char* label, float height);
bool colour_picker(const char* label, glm::vec3* srgb);

}  // namespace brume::viewer
