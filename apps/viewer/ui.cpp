#include "apps/viewer/ui.hpp"

#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "apps/viewer/ui_parts.hpp"
#include "image/font.hpp"

namespace brume::viewer {
namespace {

constexpr float kTextPixels = 15;

void choose_style() {
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 4;
  style.FrameRounding = 3;
  style.GrabRounding = 3;
  style.WindowBorderSize = 0;
  style.Colors[ImGuiCol_WindowBg] = ImVec4(0.06f, 0.07f, 0.09f, 0.88f);
  style.Colors[ImGuiCol_FrameBg] = ImVec4(0.16f, 0.18f, 0.22f, 1);
  style.Colors[ImGuiCol_Header] = ImVec4(0.17f, 0.23f, 0.30f, 1);
  // Slider grabs are transparent: the number is behind them.
  style.Colors[ImGuiCol_SliderGrab] = ImVec4(0.93f, 0.66f, 0.30f, 0.55f);
  style.Colors[ImGuiCol_SliderGrabActive] = ImVec4(0.98f, 0.74f, 0.40f, 0.75f);
  style.Colors[ImGuiCol_CheckMark] = ImVec4(0.93f, 0.66f, 0.30f, 1);
}

/// Work that cannot be stopped, in the middle of an empty window.
void lay_out_steps(const std::string& name, const Work& work) {
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float row = 1.5f * ImGui::GetFontSize();
  const auto line = [&](const std::string& text, float rows, ImU32 colour) {
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    list.AddText(ImVec2(0.5f * (display.x - size.x), 0.5f * display.y + rows * row), colour, text.c_str());
  };
  char time[32];
  std::snprintf(time, sizeof time, "%.0f s", std::floor(work.seconds));
  line("loading " + name, -1.5f, IM_COL32(235, 235, 235, 255));
  line(work.title, -0.5f, IM_COL32(160, 165, 175, 255));
  if (work.seconds >= 1) line(time, 0.5f, IM_COL32(160, 165, 175, 255));
}

}  // namespace

Ui::Ui(const Window& window) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // no imgui.ini in the current folder
  io.ConfigFlags |= ImGuiConfigFlags_NoMouseCursorChange;
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  choose_style();
  // The regular face of the font that letters are shot with, which is bold.
  std::filesystem::path font = image::default_font().parent_path() / "DejaVuSans.ttf";
  if (std::error_code error; !std::filesystem::exists(font, error)) font = image::default_font();
  if (std::error_code error; std::filesystem::exists(font, error))
    io.Fonts->AddFontFromFileTTF(font.c_str(), kTextPixels);
  ImGui_ImplGlfw_InitForOther(window.handle(), true);
  set_widget_log(&widgets_);
}

Ui::~Ui() {
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void Ui::begin_frame() {
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  widgets_.begin_frame();
}

UiRequests Ui::lay_out(Document& document, const Status& status) {
  UiRequests requests;
  const WindowChoices& choices = document.choices();
  document.lay_out_marks();
  if (choices.overlay) lay_out_overlay(document, status);
  if (choices.panels) {
    lay_out_panels(document, status, requests);
    lay_out_time_bar(document, requests);
  }
  if (status.work) requests.stop = lay_out_work(*status.work);
  if (choices.help) lay_out_help(document.keys(), document.help_note());
  ImGui::Render();
  return requests;
}

bool Ui::lay_out_loading(const std::string& name, const Work& work, bool overlay) {
  bool stops = false;
  if (overlay && work.can_stop) {
    Work named = work;
    named.title = name + ": " + work.title;
    stops = lay_out_work(named);
  } else if (overlay) {
    lay_out_steps(name, work);
  }
  ImGui::Render();
  return stops;
}

bool Ui::takes_mouse() const {
  return ImGui::GetIO().WantCaptureMouse;
}

bool Ui::takes_keys() const {
  return ImGui::GetIO().WantTextInput;
}

bool Ui::has_popup() const {
  return ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup);
}

bool Ui::is_editing() const {
  return ImGui::IsAnyItemActive();
}

}  // namespace brume::viewer
