// The user interface over the image: overlay, help, panels and time slider.
#pragma once

#include <string>
#include <vector>

#include "apps/viewer/document.hpp"
#include "apps/viewer/widgets.hpp"

namespace brume::viewer {

/// Dear ImGui for a window, with the project's font and colours.
class Ui {
 public:
  explicit Ui(const Window& window);
  ~Ui();
  Ui(const Ui&) = delete;
  Ui& operator=(const Ui&) = delete;

  void begin_frame();
  /// Lays out everything; ImGui::GetDrawData() holds the result until the next frame begins.
  UiRequests lay_out(Document& document, const Status& status);
  /// Lays out what shows while a document loads: with `overlay` its name, and the work that goes on. Returns
  /// whether the work shall stop.
  bool lay_out_loading(const std::string& name, const Work& work, bool overlay);
  /// Whether the panels currently capture the mouse or the keyboard.
  bool takes_mouse() const;
  bool takes_keys() const;
  /// Whether a popup or a list is open.
  bool has_popup() const;
  /// Whether a widget is held or edited.
  bool is_editing() const;
  const std::vector<Widget>& widgets() const { return widgets_.widgets(); }

 private:
  WidgetLog widgets_;
};

}  // namespace brume::viewer
