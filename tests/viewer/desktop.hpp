// A desktop without a screen (Xvfb), and a program on it whose keys and mouse the test moves.
#pragma once

// gtest before X11, whose macros it does not bear.
#include <gtest/gtest.h>
#include <sys/types.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "image/image.hpp"

struct _XDisplay;

namespace brume::viewer {

/// A virtual screen of 1280 x 720, ended with the test.
class Desktop {
 public:
  /// Fails the test when there is no Xvfb.
  Desktop();
  ~Desktop();
  Desktop(const Desktop&) = delete;
  Desktop& operator=(const Desktop&) = delete;
  _XDisplay* display() const { return display_; }
  const std::string& name() const { return name_; }  ///< ":7"

 private:
  pid_t server_ = -1;
  std::string name_;
  _XDisplay* display_ = nullptr;
};

/// A line of the frame log.
struct Frame {
  std::uint64_t number = 0;  ///< From 1.
  double seconds = 0;        ///< Of the viewer's clock.
  glm::uvec2 size_px{0};
  std::string picture;  ///< film, still or best.
  std::uint64_t process_bytes = 0, heap_bytes = 0, device_bytes = 0;
  std::size_t shader_faults = 0;
};

/// `brume view` on a desktop. Tests wait for frames that it drew, for its own clock or for a picture, never
/// for time to pass: a machine may be as slow as it likes.
class Program {
 public:
  Program(const Desktop& desktop, const std::filesystem::path& folder,
          const std::vector<std::string>& arguments);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// Waits until the window shows a picture, and gives it the keyboard. False when it never does.
  bool wait_for_window();
  bool runs();
  /// Waits for its end; the exit code, 128 + signal where one ended it.
  int wait();
  std::string error() const;  ///< What it wrote to standard error.

  void key(unsigned long symbol, bool down);
  void tap(unsigned long symbol);
  void button(unsigned number, bool down);  ///< 1: left, 2: middle, 3: right.
  void click(unsigned number);
  void move_mouse(int x, int y);   ///< By so many pixels.
  void place_mouse(int x, int y);  ///< In the window.
  void resize(unsigned width, unsigned height);
  void hide();  ///< As a minimized window.
  void show();
  void close();             ///< As the button of the window's frame does.
  image::Image8 picture();  ///< What the window shows now.

  /// All frames that it has drawn so far.
  const std::vector<Frame>& frames();
  // Each wait fails when the program ends or hangs.
  /// Looks at the window until `wanted` holds.
  bool wait_for_picture(const std::function<bool(const image::Image8&)>& wanted);
  /// Looks at the last frame until `wanted` holds.
  bool wait_for_frame(const std::function<bool(const Frame&)>& wanted);
  /// For so many more frames. After two, all that was sent before has been handled.
  bool wait_for_frames(std::size_t count);
  /// Until what was sent before has been handled, and the viewer's clock has then gone on by so much.
  bool wait_for_clock(double seconds);
  /// Of a paused program: until what was sent before has been handled, and the window shows the picture at
  /// its best.
  bool wait_for_best();

 private:
  bool wait_until(const std::function<bool()>& holds, int poll_ms);
  void kill();
  const Desktop& desktop_;
  std::filesystem::path error_file_, log_file_;
  std::ifstream log_;
  std::string log_rest_;  ///< The beginning of a line.
  std::vector<Frame> frames_;
  pid_t process_ = -1;
  int status_ = 0;
  unsigned long window_ = 0;
};

}  // namespace brume::viewer
