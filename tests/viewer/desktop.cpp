#include "tests/viewer/desktop.hpp"

#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/extensions/XTest.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <sstream>
#include <thread>

namespace brume::viewer {
namespace {

using Clock = std::chrono::steady_clock;
// Only ends tests that hang: a busy machine may take a hundred times as long as an idle one.
constexpr std::chrono::minutes kHang{10};
constexpr int kPollMs = 20;
// Polls more often than frames are drawn.
constexpr int kFramePollMs = 2;

/// Starts a program with DISPLAY added to the environment of the test; standard error goes to a file.
pid_t start(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
            const std::string& display, const std::filesystem::path& error_file, int inherited) {
  std::vector<char*> words;
  for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const pid_t child = ::fork();
  if (child != 0) return child;
  if (!display.empty()) ::setenv("DISPLAY", display.c_str(), 1);
  ::unsetenv("WAYLAND_DISPLAY");
  const int file = ::open(error_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  ::dup2(file, 2);
  ::dup2(file, 1);
  if (inherited >= 0) ::fcntl(inherited, F_SETFD, 0);
  if (::chdir(folder.c_str()) != 0) ::_exit(126);
  ::execvp(words[0], words.data());
  ::_exit(127);
}

// Windows may disappear while they are inspected.
int ignore_errors(Display*, XErrorEvent*) {
  return 0;
}

/// The largest visible window of the desktop; 0: none.
Window find_window(Display* display) {
  Window root = 0, parent = 0, *children = nullptr;
  unsigned count = 0;
  Window found = 0;
  if (!::XQueryTree(display, DefaultRootWindow(display), &root, &parent, &children, &count)) return 0;
  int largest = 1;  // GLFW keeps a helper window of one pixel
  for (unsigned i = 0; i < count; ++i) {
    XWindowAttributes attributes{};
    if (!::XGetWindowAttributes(display, children[i], &attributes)) continue;
    if (attributes.map_state != IsViewable || attributes.width * attributes.height <= largest) continue;
    largest = attributes.width * attributes.height;
    found = children[i];
  }
  if (children) ::XFree(children);
  return found;
}

bool has_content(const image::Image8& image) {
  for (std::size_t i = 0; i < image.rgba.size(); i += 4)
    if (image.rgba[i] > 8 || image.rgba[i + 1] > 8 || image.rgba[i + 2] > 8) return true;
  return false;
}

Frame frame_of(std::string line) {
  Frame frame;
  std::replace(line.begin(), line.end(), ',', ' ');
  double frame_ms = 0, tick_ms = 0, latency_ms = 0;
  std::istringstream(line) >> frame.number >> frame.seconds >> frame_ms >> tick_ms >> latency_ms >>
      frame.size_px.x >> frame.size_px.y >> frame.picture >> frame.mapped_bytes >> frame.heap_bytes >>
      frame.device_bytes >> frame.shader_faults;
  return frame;
}

/// A line of FrameLog::add_widgets after "widget,".
WidgetLine widget_of(const std::string& line) {
  WidgetLine widget;
  std::istringstream fields(line);
  const auto next = [&] {
    std::string field;
    std::getline(fields, field, ',');
    return field;
  };
  const auto number = [&] { return std::atoi(next().c_str()); };
  widget.id = next();
  widget.kind = next();
  widget.low_px.x = number();
  widget.low_px.y = number();
  widget.high_px.x = number();
  widget.high_px.y = number();
  widget.reachable = number() != 0;
  widget.in_popup = number() != 0;
  widget.uses = static_cast<std::uint64_t>(number());
  std::getline(fields, widget.label);
  return widget;
}

}  // namespace

Desktop::Desktop() {
  ::XSetErrorHandler(ignore_errors);
  int ends[2];
  if (::pipe(ends) != 0) return;
  // The server picks a free display number and prints it.
  server_ = start({"Xvfb", "-displayfd", std::to_string(ends[1]), "-screen", "0", "1280x720x24", "-nolisten",
                   "tcp", "+extension", "XTEST"},
                  "/", "", "/dev/null", ends[1]);
  ::close(ends[1]);
  char text[16] = {};
  ssize_t got = 0;
  std::string said;
  while (said.find('\n') == std::string::npos && (got = ::read(ends[0], text, sizeof text - 1)) > 0)
    said.append(text, static_cast<std::size_t>(got));
  ::close(ends[0]);
  if (said.empty()) {
    ADD_FAILURE() << "Xvfb does not start; install xvfb";
    return;
  }
  name_.push_back(':');
  name_.append(said.data(), said.find('\n'));
  display_ = ::XOpenDisplay(name_.c_str());
  EXPECT_NE(display_, nullptr) << name_;
}

Desktop::~Desktop() {
  if (display_) ::XCloseDisplay(display_);
  if (server_ <= 0) return;
  ::kill(server_, SIGTERM);
  ::waitpid(server_, nullptr, 0);
}

Program::Program(const Desktop& desktop, const std::filesystem::path& folder,
                 const std::vector<std::string>& arguments)
    : desktop_(desktop), error_file_(folder / "standard_error.txt"), log_file_(folder / "frames.csv") {
  std::filesystem::remove(log_file_);  // from a previous program
  std::vector<std::string> words{BRUME_PROGRAM, "view", "--frame-log", log_file_.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  process_ = start(words, folder, desktop.name(), error_file_, -1);
}

Program::~Program() {
  if (runs()) kill();
}

bool Program::runs() {
  if (process_ <= 0) return false;
  if (::waitpid(process_, &status_, WNOHANG) == 0) return true;
  process_ = -1;
  return false;
}

void Program::kill() {
  ::kill(process_, SIGKILL);
  ::waitpid(process_, &status_, 0);
  process_ = -1;
}

void Program::terminate() {
  if (process_ > 0) ::kill(process_, SIGTERM);
}

int Program::wait() {
  wait_until([] { return false; }, kPollMs);
  if (runs()) kill();
  return WIFSIGNALED(status_) ? 128 + WTERMSIG(status_) : WEXITSTATUS(status_);
}

std::string Program::error() const {
  std::ostringstream text;
  text << std::ifstream(error_file_).rdbuf();
  return text.str();
}

bool Program::wait_until(const std::function<bool()>& holds, int poll_ms) {
  const auto end = Clock::now() + kHang;
  while (runs() && Clock::now() < end) {
    if (holds()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(poll_ms));
  }
  return false;
}

bool Program::wait_for_window() {
  const auto shows = [&] {
    window_ = find_window(desktop_.display());
    return window_ && has_content(contents());
  };
  if (!wait_until(shows, kPollMs)) return false;
  ::XSetInputFocus(desktop_.display(), window_, RevertToParent, CurrentTime);
  ::XSync(desktop_.display(), False);
  return wait_for_frames(2);
}

void Program::key(unsigned long symbol, bool down) {
  ::XTestFakeKeyEvent(desktop_.display(), ::XKeysymToKeycode(desktop_.display(), symbol), down ? True : False,
                      0);
  ::XSync(desktop_.display(), False);
}

void Program::tap(unsigned long symbol) {
  key(symbol, true);
  key(symbol, false);
}

void Program::button(unsigned number, bool down) {
  ::XTestFakeButtonEvent(desktop_.display(), number, down ? True : False, 0);
  ::XSync(desktop_.display(), False);
}

void Program::click(unsigned number) {
  button(number, true);
  button(number, false);
}

void Program::move_mouse(int x, int y) {
  ::XTestFakeRelativeMotionEvent(desktop_.display(), x, y, 0);
  ::XSync(desktop_.display(), False);
}

void Program::place_mouse(int x, int y) {
  ::XWarpPointer(desktop_.display(), 0, window_, 0, 0, 0, 0, x, y);
  ::XSync(desktop_.display(), False);
}

void Program::resize(unsigned width, unsigned height) {
  ::XResizeWindow(desktop_.display(), window_, width, height);
  ::XSync(desktop_.display(), False);
}

void Program::hide() {
  ::XUnmapWindow(desktop_.display(), window_);
  ::XSync(desktop_.display(), False);
}

void Program::show() {
  ::XMapWindow(desktop_.display(), window_);
  ::XSetInputFocus(desktop_.display(), window_, RevertToParent, CurrentTime);
  ::XSync(desktop_.display(), False);
}

void Program::close() {
  Display* const display = desktop_.display();
  XEvent event{};
  event.xclient.type = ClientMessage;
  event.xclient.window = window_;
  event.xclient.message_type = ::XInternAtom(display, "WM_PROTOCOLS", False);
  event.xclient.format = 32;
  event.xclient.data.l[0] = static_cast<long>(::XInternAtom(display, "WM_DELETE_WINDOW", False));
  ::XSendEvent(display, window_, False, NoEventMask, &event);
  ::XSync(display, False);
}

image::Image8 Program::contents() {
  image::Image8 image;
  XWindowAttributes attributes{};
  if (!::XGetWindowAttributes(desktop_.display(), window_, &attributes)) return image;
  const auto width = static_cast<unsigned>(attributes.width),
             height = static_cast<unsigned>(attributes.height);
  XImage* const captured = ::XGetImage(desktop_.display(), window_, 0, 0, width, height, AllPlanes, ZPixmap);
  if (!captured) return image;
  image.width = width;
  image.height = height;
  image.rgba.reserve(std::size_t{4} * width * height);
  for (unsigned y = 0; y < height; ++y) {
    for (unsigned x = 0; x < width; ++x) {
      const unsigned long pixel = XGetPixel(captured, static_cast<int>(x), static_cast<int>(y));
      for (const int shift : {16, 8, 0}) image.rgba.push_back(static_cast<std::uint8_t>(pixel >> shift));
      image.rgba.push_back(255);
    }
  }
  XDestroyImage(captured);
  return image;
}

void Program::read_line(const std::string& line) {
  constexpr std::string_view kList = "widgets,", kWidget = "widget,";
  if (line.starts_with(kList)) {
    widgets_.clear();
  } else if (line.starts_with(kWidget)) {
    widgets_.push_back(widget_of(line.substr(kWidget.size())));
    widget_uses_[widgets_.back().id] = widgets_.back().uses;
  } else if (!line.empty() && std::isdigit(static_cast<unsigned char>(line[0]))) {  // not the header line
    frames_.push_back(frame_of(line));
  }
}

const std::vector<Frame>& Program::frames() {
  if (!log_.is_open()) log_.open(log_file_);
  std::ostringstream more;
  if (log_.is_open() && log_.peek() != std::ifstream::traits_type::eof()) more << log_.rdbuf();
  log_.clear();
  log_rest_ += more.str();
  // Whole frames only: what precedes the line of a frame belongs to it.
  std::size_t whole = 0;
  for (std::size_t begin = 0, end = 0; (end = log_rest_.find('\n', begin)) != std::string::npos;
       begin = end + 1)
    if (std::isdigit(static_cast<unsigned char>(log_rest_[begin]))) whole = end + 1;
  std::istringstream lines(log_rest_.substr(0, whole));
  for (std::string line; std::getline(lines, line);) read_line(line);
  log_rest_.erase(0, whole);
  return frames_;
}

const std::vector<WidgetLine>& Program::widgets() {
  frames();
  return widgets_;
}

std::uint64_t Program::widget_uses(const std::string& id) {
  frames();
  return widget_uses_[id];
}

bool Program::wait_for_contents(const std::function<bool(const image::Image8&)>& wanted) {
  return wait_until([&] { return wanted(contents()); }, kPollMs);
}

bool Program::wait_for_frame(const std::function<bool(const Frame&)>& wanted) {
  return wait_until([&] { return !frames().empty() && wanted(frames().back()); }, kFramePollMs);
}

bool Program::wait_for_frames(std::size_t count) {
  const std::size_t end = frames().size() + count;
  return wait_until([&] { return frames().size() >= end; }, kFramePollMs);
}

bool Program::wait_for_clock(double seconds) {
  if (!wait_for_frames(2)) return false;
  const double end = frames().back().seconds + seconds;
  return wait_for_frame([&](const Frame& frame) { return frame.seconds >= end; });
}

bool Program::wait_for_best() {
  // The window system may present a frame up to the number of swapchain images after the device has finished
  // it.
  constexpr std::size_t kImages = 8;
  return wait_for_frames(2) && wait_for_frame([](const Frame& frame) { return frame.picture == "best"; }) &&
         wait_for_frames(kImages);
}

}  // namespace brume::viewer
