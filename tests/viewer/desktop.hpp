// A desktop without a screen (Xvfb), and a program on it whose keys and mouse the test moves.
#pragma once

// gtest before X11, whose macros it does not bear.
#include <gtest/gtest.h>
#include <sys/types.h>

#include <filesystem>
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

/// `brume view` on a desktop.
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
  std::uint64_t resident_bytes() const;  ///< Memory that it holds; 0 when it does not run.
  /// Waits for its end; the exit code, 128 + signal where one ended it. Kills it after `seconds`.
  int wait(int seconds = 120);
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
  /// Looks at the window until `wanted` holds, at most so long. Whether it did.
  bool wait_for_picture(const std::function<bool(const image::Image8&)>& wanted, int seconds = 60);

 private:
  const Desktop& desktop_;
  std::filesystem::path error_file_;
  pid_t process_ = -1;
  int status_ = 0;
  unsigned long window_ = 0;
};

/// Waits a moment.
void sleep_ms(int milliseconds);

}  // namespace brume::viewer
