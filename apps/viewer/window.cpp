#include "apps/viewer/window.hpp"

// GLFW declares its Vulkan functions only if vulkan.h comes first.
#include "gpu/functions.hpp"
// Keeps clang-format from sorting the two.
#include <GLFW/glfw3.h>

#include "core/error.hpp"

namespace brume::viewer {
namespace {

std::string glfw_message() {
  const char* text = nullptr;
  ::glfwGetError(&text);
  std::string message = text ? text : "";
  while (!message.empty() && (message.back() == '\n' || message.back() == '.')) message.pop_back();
  return message;
}

[[noreturn]] void throw_no_window(const std::string& why) {
  throw Error(ErrorCode::no_device, "cannot open a window" + (why.empty() ? "" : " (" + why + ")") +
                                        "; use brume render if there is no display");
}

}  // namespace

Window::Window(glm::uvec2 size_px, const std::string& title, KeyMap keys) : keys_(keys) {
  if (!::glfwInit()) throw_no_window(glfw_message());
  if (!::glfwVulkanSupported()) {
    ::glfwTerminate();
    throw Error(ErrorCode::no_device,
                "the Vulkan loader cannot present to a window; install libvulkan1 and a driver such as "
                "mesa-vulkan-drivers");
  }
  ::glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  handle_ = ::glfwCreateWindow(static_cast<int>(size_px.x), static_cast<int>(size_px.y), title.c_str(),
                               nullptr, nullptr);
  if (!handle_) {
    const std::string why = glfw_message();
    ::glfwTerminate();
    throw_no_window(why);
  }
  ::glfwSetWindowUserPointer(handle_, this);
  ::glfwSetKeyCallback(handle_, on_key);
  ::glfwSetMouseButtonCallback(handle_, on_button);
  ::glfwSetCursorPosCallback(handle_, on_cursor);
  ::glfwSetScrollCallback(handle_, on_wheel);
  ::glfwSetWindowFocusCallback(handle_, on_focus);
  ::glfwSetDropCallback(handle_, on_drop);
  ::glfwSetWindowSizeCallback(handle_, on_size);
}

Window::~Window() {
  ::glfwDestroyWindow(handle_);
  ::glfwTerminate();
}

gpu::Presentation Window::presentation() const {
  gpu::Presentation presentation;
  std::uint32_t count = 0;
  const char** const names = ::glfwGetRequiredInstanceExtensions(&count);
  presentation.instance_extensions.assign(names, names + count);
  presentation.supported = [](VkInstance instance, VkPhysicalDevice device, std::uint32_t family) {
    return ::glfwGetPhysicalDevicePresentationSupport(instance, device, family) == GLFW_TRUE;
  };
  return presentation;
}

gpu::SurfaceMaker Window::surface() const {
  const auto make = [window = handle_](VkInstance instance) {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    gpu::check(::glfwCreateWindowSurface(instance, window, nullptr, &surface), "glfwCreateWindowSurface");
    return surface;
  };
  return {make, [this] { return size_px(); }};
}

glm::uvec2 Window::size_px() const {
  int width = 0, height = 0;
  ::glfwGetFramebufferSize(handle_, &width, &height);
  return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

bool Window::should_close() const {
  return ::glfwWindowShouldClose(handle_) == GLFW_TRUE;
}

void Window::poll(double wait_seconds) {
  if (wait_seconds > 0) {
    ::glfwWaitEventsTimeout(wait_seconds);
  } else {
    ::glfwPollEvents();
  }
}

Input Window::take_input() {
  Input taken = input_;
  input_.pressed.clear();
  input_.dropped.clear();
  input_.look_px = glm::dvec2(0);
  input_.wheel = 0;
  return taken;
}

void Window::capture_mouse(bool capture) {
  if (capture == captures_mouse_) return;
  captures_mouse_ = capture;
  cursor_known_ = false;
  ::glfwSetInputMode(handle_, GLFW_CURSOR, capture ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
}

glm::vec2 Window::cursor_px() const {
  double x = 0, y = 0;
  int width = 1, height = 1;
  ::glfwGetCursorPos(handle_, &x, &y);
  ::glfwGetWindowSize(handle_, &width, &height);
  // GLFW reports the cursor in screen coordinates, which differ from pixels on scaled displays.
  const glm::dvec2 scale = glm::dvec2(size_px()) / glm::dvec2(std::max(width, 1), std::max(height, 1));
  return glm::vec2(glm::dvec2(x, y) * scale);
}

void Window::toggle_full_screen() {
  if (::glfwGetWindowMonitor(handle_)) {
    ::glfwSetWindowMonitor(handle_, nullptr, windowed_.x, windowed_.y, windowed_.z, windowed_.w,
                           GLFW_DONT_CARE);
    return;
  }
  GLFWmonitor* const monitor = ::glfwGetPrimaryMonitor();
  const GLFWvidmode* const mode = monitor ? ::glfwGetVideoMode(monitor) : nullptr;
  if (!mode) return;
  ::glfwGetWindowPos(handle_, &windowed_.x, &windowed_.y);
  ::glfwGetWindowSize(handle_, &windowed_.z, &windowed_.w);
  ::glfwSetWindowMonitor(handle_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

void Window::change(bool mouse, int code, bool pressed, int modifiers) {
  // A key that is released ends whatever its press began, with or without modifiers.
  if (!pressed) {
    for (const KeyBinding& binding : key_bindings(keys_))
      if (binding.mouse == mouse && binding.code == code)
        input_.held[static_cast<std::size_t>(binding.action)] = false;
    return;
  }
  const Modifiers held{(modifiers & GLFW_MOD_SHIFT) != 0, (modifiers & GLFW_MOD_CONTROL) != 0};
  const auto action = action_of(mouse, code, held, keys_);
  if (!action) return;
  input_.held[static_cast<std::size_t>(*action)] = true;
  input_.pressed.push_back(*action);
}

void Window::on_key(GLFWwindow* window, int key, int, int change, int modifiers) {
  auto* const self = static_cast<Window*>(::glfwGetWindowUserPointer(window));
  ++self->events_;
  if (change == GLFW_REPEAT) return;
  // The press of Shift itself reports Shift as held.
  const bool is_shift = key == GLFW_KEY_LEFT_SHIFT || key == GLFW_KEY_RIGHT_SHIFT;
  self->change(false, key, change == GLFW_PRESS, is_shift ? modifiers & ~GLFW_MOD_SHIFT : modifiers);
}

void Window::on_button(GLFWwindow* window, int button, int change, int modifiers) {
  auto* const self = static_cast<Window*>(::glfwGetWindowUserPointer(window));
  ++self->events_;
  self->change(true, button, change == GLFW_PRESS, modifiers);
}

void Window::on_cursor(GLFWwindow* window, double x, double y) {
  auto* const self = static_cast<Window*>(::glfwGetWindowUserPointer(window));
  const glm::dvec2 now(x, y);
  ++self->events_;
  if (self->captures_mouse_ && self->cursor_known_) self->input_.look_px += now - self->last_cursor_;
  self->last_cursor_ = now;
  self->cursor_known_ = true;
}

void Window::on_wheel(GLFWwindow* window, double, double y) {
  auto* const self = static_cast<Window*>(::glfwGetWindowUserPointer(window));
  ++self->events_;
  self->input_.wheel += y;
}

void Window::on_drop(GLFWwindow* window, int count, const char** paths) {
  auto* const self = static_cast<Window*>(::glfwGetWindowUserPointer(window));
  self->input_.dropped.insert(self->input_.dropped.end(), paths, paths + count);
}

// The cursor has another place in a window of another size.
void Window::on_size(GLFWwindow* window, int, int) {
  static_cast<Window*>(::glfwGetWindowUserPointer(window))->cursor_known_ = false;
}

// The release of keys that are held when the window loses focus is never reported.
void Window::on_focus(GLFWwindow* window, int focused) {
  auto* const self = static_cast<Window*>(::glfwGetWindowUserPointer(window));
  if (!focused) self->input_.held.fill(false);
  self->cursor_known_ = false;
}

}  // namespace brume::viewer
