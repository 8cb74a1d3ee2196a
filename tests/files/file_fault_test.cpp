// Every call of the system that writes or reads a file fails once: the file is as before or whole, nothing is
// left beside it, and a sentence names it.
#include <dlfcn.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstring>
#include <functional>

#include "core/file.hpp"
#include "grids/files/grid_files.hpp"
#include "grids/files/raw_file.hpp"
#include "image/exr.hpp"
#include "image/png.hpp"
#include "scene/files/timeline_writer.hpp"
#include "spheres/export.hpp"
#include "spheres/file.hpp"
#include "tests/work_folder.hpp"
#include "vxl/file.hpp"
#include "wire/replay.hpp"

namespace {

/// Calls of the system until one fails.
struct Faults {
  static inline bool counts = false;
  static inline int calls = 0, fails_at = 0, error = EIO;  // fails_at 0: none
  static bool fails() {
    if (!counts || ++calls != fails_at) return false;
    errno = error;
    return true;
  }
};

template <typename Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

// Functions of the C library, in place of its own.
extern "C" {

int open(const char* path, int flags, ...) {
  std::va_list more;
  va_start(more, flags);
  const bool has_mode = (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE;
  const mode_t mode = has_mode ? va_arg(more, mode_t) : 0;
  va_end(more);
  return Faults::fails() ? -1 : real<int(const char*, int, ...)>("open")(path, flags, mode);
}
ssize_t read(int file, void* bytes, std::size_t size) {
  return Faults::fails() ? -1 : real<ssize_t(int, void*, std::size_t)>("read")(file, bytes, size);
}
ssize_t write(int file, const void* bytes, std::size_t size) {
  return Faults::fails() ? -1 : real<ssize_t(int, const void*, std::size_t)>("write")(file, bytes, size);
}
int fsync(int file) {
  return Faults::fails() ? -1 : real<int(int)>("fsync")(file);
}
int fstat(int file, struct stat* info) noexcept {
  return Faults::fails() ? -1 : real<int(int, struct stat*)>("fstat")(file, info);
}
int stat(const char* path, struct stat* info) noexcept {
  return Faults::fails() ? -1 : real<int(const char*, struct stat*)>("stat")(path, info);
}
int lstat(const char* path, struct stat* info) noexcept {
  return Faults::fails() ? -1 : real<int(const char*, struct stat*)>("lstat")(path, info);
}
int access(const char* path, int mode) noexcept {
  return Faults::fails() ? -1 : real<int(const char*, int)>("access")(path, mode);
}
int flock(int file, int operation) noexcept {
  return Faults::fails() ? -1 : real<int(int, int)>("flock")(file, operation);
}
int rename(const char* from, const char* to) noexcept {
  return Faults::fails() ? -1 : real<int(const char*, const char*)>("rename")(from, to);
}
int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) noexcept {
  return Faults::fails() ? -1
                         : real<int(int, const char*, int, const char*, int)>("linkat")(from_folder, from,
                                                                                        to_folder, to, flags);
}
int fchown(int file, uid_t user, gid_t group) noexcept {
  return Faults::fails() ? -1 : real<int(int, uid_t, gid_t)>("fchown")(file, user, group);
}
int fchmod(int file, mode_t mode) noexcept {
  return Faults::fails() ? -1 : real<int(int, mode_t)>("fchmod")(file, mode);
}

}  // extern "C"

namespace brume {
namespace {

using Save = std::function<Result<void>(const std::filesystem::path&)>;
using Load = std::function<Result<bool>(const std::filesystem::path&)>;  // whether it is what was saved

class FileFaultTest : public testing::Test {
 protected:
  ~FileFaultTest() override { Faults::counts = false; }

  /// Fails call after call until none is left to fail. Returns how many there were.
  template <typename Run>
  static int fail_each(Run run, int error) {
    Faults::error = error;
    int number = 0;
    bool reached = true;
    while (reached && !HasFatalFailure()) {
      Faults::fails_at = ++number;
      SCOPED_TRACE("call " + std::to_string(number) + ": " + std::strerror(error));
      run();
      reached = Faults::calls >= number;
    }
    return number - 1;
  }
  template <typename Call>
  static auto counted(Call call) {
    Faults::calls = 0;
    Faults::counts = true;
    auto result = call();
    Faults::counts = false;
    return result;
  }

  void expect_whole_or_not_at_all(const std::string& name, const Save& save, const Load& load = {}) {
    const cli::WorkFolder folder;
    const std::filesystem::path path = folder.path() / name;
    ASSERT_TRUE(save(path));
    const std::string whole = read_text_file(path).value_or_throw();
    for (const std::string old : {"", "what was there before"})
      for (const int error : {EIO, ENOSPC}) {
        const int calls = fail_each([&] { expect_one(folder, path, old, whole, save); }, error);
        EXPECT_GE(calls, 5) << "they go past this test";
      }
    if (!load) return;
    ASSERT_TRUE(save(path));
    const int calls = fail_each(
        [&] {
          const Result<bool> loaded = counted([&] { return load(path); });
          EXPECT_TRUE(!loaded || *loaded);
          if (!loaded) {
            EXPECT_NE(loaded.failure().message.find(name), std::string::npos) << loaded.failure().message;
          }
        },
        EIO);
    EXPECT_GE(calls, 3);
  }

 private:
  static void expect_one(const cli::WorkFolder& folder, const std::filesystem::path& path,
                         const std::string& old, const std::string& whole, const Save& save) {
    std::filesystem::remove(path);
    if (!old.empty()) folder.write(path.filename(), old);
    const Result<void> saved = counted([&] { return save(path); });
    const std::vector<std::string> files = folder.files();
    EXPECT_LE(files.size(), 1u);
    const bool exists = std::filesystem::exists(path);
    const std::string now = exists ? read_text_file(path).value_or_throw() : "";
    if (saved) {
      EXPECT_TRUE(now == whole);
      return;
    }
    EXPECT_TRUE(now == old);
    EXPECT_EQ(exists, !old.empty());
    EXPECT_NE(saved.failure().message.find(path.filename()), std::string::npos) << saved.failure().message;
  }
};

TEST_F(FileFaultTest, Bytes) {
  const std::string text(100'000, 'x');
  expect_whole_or_not_at_all(
      "text.txt", [&](const auto& path) { return write_file_atomic(path, text); },
      [&](const auto& path) -> Result<bool> {
        const auto read = read_text_file(path);
        if (!read) return read.failure();
        return *read == text;
      });
}

TEST_F(FileFaultTest, Pictures) {
  const image::Image8 picture{3, 2, std::vector<std::uint8_t>(24, 100)};
  expect_whole_or_not_at_all("picture.png", [&](const auto& path) { return image::save_png(path, picture); });
  const image::LayeredImage layers{3, 2, {{"Z", std::vector<float>(6, 1.5f)}}};
  expect_whole_or_not_at_all("picture.exr", [&](const auto& path) { return image::save_exr(path, layers); });
}

TEST_F(FileFaultTest, Voxels) {
  const vxl::Contents contents{voxel::BitGrid({{33, 17, 5}, 0.25f, {0, 0, 0}}), {}, 7};
  expect_whole_or_not_at_all(
      "level.vxl", [&](const auto& path) { return vxl::save(path, contents, 9); },
      [&](const auto& path) -> Result<bool> {
        const auto loaded = vxl::load(path, 9);
        if (!loaded) return loaded.failure();
        return loaded->has_value() && (*loaded)->triangles == 7;
      });
}

TEST_F(FileFaultTest, Replays) {
  const wire::Replay replay = wire::make_replay(voxel::BitGrid({{33, 17, 5}, 0.25f, {0, 0, 0}}), {}, {});
  expect_whole_or_not_at_all(
      "match.replay", [&](const auto& path) { return wire::save_replay(path, replay); },
      [&](const auto& path) -> Result<bool> {
        const auto loaded = wire::load_replay(path);
        if (!loaded) return loaded.failure();
        return loaded->events.empty();
      });
}

TEST_F(FileFaultTest, TanksAndTimelines) {
  spheres::Tank tank;
  tank.size = {7, 7, 7};
  expect_whole_or_not_at_all(
      "tank.spheres", [&](const auto& path) { return spheres::save_tank(path, tank); },
      [&](const auto& path) -> Result<bool> {
        const auto loaded = spheres::load_tank(path);
        if (!loaded) return loaded.failure();
        return loaded->size == tank.size;
      });
  expect_whole_or_not_at_all("tank.ply",
                             [&](const auto& path) { return spheres::save_tank_ply(path, tank); });
  scene::Timeline timeline;
  timeline.scene = "/room.obj";
  expect_whole_or_not_at_all("film.toml",
                             [&](const auto& path) { return scene::save_timeline(path, timeline); });
}

TEST_F(FileFaultTest, Volumes) {
  grids::GridFile file;
  expect_whole_or_not_at_all(
      "smoke.brv", [&](const auto& path) { return grids::save_grid_file(path, file); },
      [&](const auto& path) -> Result<bool> {
        const auto loaded = grids::load_grid_file(path);
        if (!loaded) return loaded.failure();
        return loaded->grids.empty();
      });
}

}  // namespace
}  // namespace brume
