#include "apps/viewer/ui.hpp"

#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

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
  style.Colors[ImGuiCol_SliderGrab] = ImVec4(0.93f, 0.66f, 0.30f, 1);
  style.Colors[ImGuiCol_CheckMark] = style.Colors[ImGuiCol_SliderGrab];
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
  const std::filesystem::path font = image::default_font();
  if (std::error_code error; std::filesystem::exists(font, error))
    io.Fonts->AddFontFromFileTTF(font.c_str(), kTextPixels);
  ImGui_ImplGlfw_InitForOther(window.handle(), true);
}

Ui::~Ui() {
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void Ui::begin_frame() {
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
}

UiRequests Ui::lay_out(Choices& choices, Session& session, Player& player, const Figures& figures,
                       const Notices& notices) {
  UiRequests requests;
  lay_out_marks(choices, session, player);
  if (choices.overlay) lay_out_overlay(choices, session, player, figures, notices);
  if (choices.panels) {
    lay_out_panels(choices, session, player, figures, notices, requests);
    lay_out_time_bar(session, requests);
  }
  if (choices.help) lay_out_help();
  ImGui::Render();
  return requests;
}

bool Ui::takes_mouse() const {
  return ImGui::GetIO().WantCaptureMouse;
}

bool Ui::takes_keys() const {
  return ImGui::GetIO().WantTextInput;
}

}  // namespace brume::viewer
