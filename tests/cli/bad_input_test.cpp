// Every failure prints one line to standard error that names the place and nothing to standard output, has
// the exit code of docs/reference/command-line.md, and leaves no file behind.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <unistd.h>

#include <tuple>

#include "tests/cli/command_test.hpp"

namespace brume::cli {
namespace {

class BadInput : public RoomTest {};

Arguments voxelize(const std::string& scene, const Arguments& more = {}) {
  return joined({"voxelize", scene, "-o", "result.vxl", "--json", "result.json"}, more);
}

TEST_F(BadInput, MissingFile) {
  expect_failure(folder_, voxelize("missing.obj"), 3, {"missing.obj"});
  expect_failure(folder_, {"info", "missing.vxl"}, 3, {"missing.vxl"});
  expect_failure(folder_, {"info", "missing.png"}, 3, {"missing.png"});
  expect_failure(folder_, {"render", "missing.toml", "-o", "a.png"}, 3, {"missing.toml"});
}

TEST_F(BadInput, FilesWithMistakes) {
  for (const auto& [name, text, parts] : std::vector<std::tuple<std::string, std::string, Arguments>>{
           {"Scene.txt",
            "# objects\nWall 0 0 0  0 zero 0  1 1 1 Brick 0.5\n",
            {"Scene.txt:2:", "zero", "number"}},
           {"nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n", {"nan.obj:2:"}},
           {"index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", {"index.obj:4:", "9"}},
           {"empty.obj", "", {"empty.obj"}},
           {"Scene.txt", "# nothing\n", {"Scene.txt"}}}) {
    folder_.write(name, text);
    expect_failure(folder_, voxelize(name), 3, parts);
  }
  folder_.write("a.toml", "version = 1\nscene = \"room.obj\"\ndurration = 3.0\n");
  expect_failure(folder_, {"render", "a.toml", "-o", "a.png"}, 3, {"a.toml:3:", "durration", "duration"});
  folder_.write("a.png", "not a picture");
  expect_failure(folder_, {"info", "a.png"}, 3, {"a.png"});
}

TEST_F(BadInput, InvalidGrids) {
  expect_failure(folder_, voxelize("room.obj", {"--grid", "0x10x10"}), 2, {"0"});
  expect_failure(folder_, voxelize("room.obj", {"--grid", "-4x10x10"}), 2, {"--grid", "-4x10x10"});
  expect_failure(folder_, voxelize("room.obj", {"--grid", "10x10"}), 2, {"--grid", "120x20x120"});
  expect_failure(folder_, voxelize("room.obj", {"--grid", "1000000x1000000x1000000"}), 4,
                 {"1000000", "4096"});
  expect_failure(folder_, voxelize("room.obj", {"--grid", "8x8x8", "--voxel", "0"}), 2, {"voxel"});
  expect_failure(folder_, voxelize("room.obj", {"--voxel", "0.00001"}), 4, {"4096"});
  expect_failure(folder_, voxelize("room.obj", {"--voxel", "1e-300"}), 2, {"--voxel", "1e-06"});
  expect_failure(folder_, voxelize("room.obj", {"--grid", "8x8x8", "--origin", "0,0,inf"}), 2, {"--origin"});
}

TEST_F(BadInput, InvalidArguments) {
  expect_failure(folder_, {"fly"}, 2, {"fly", "--help"});
  expect_failure(folder_, {"voxelize"}, 2, {"SCENE"});
  expect_failure(folder_, {"voxelize", "room.obj", "--frobnicate"}, 2, {"--frobnicate"});
  expect_failure(folder_, {"render", "room.obj", "-o", "a.gif"}, 2, {"a.gif", ".png"});
  expect_failure(folder_, {"render", "room.obj", "-o", "a%s.png"}, 2, {"a%s.png", "%04d"});
  expect_failure(folder_, {"render", "room.obj", "-o", "a.png", "--size", "12"}, 2, {"--size", "1280x720"});
  expect_failure(folder_, {"render", "room.obj", "-o", "a.mp4", "--size", "33x16"}, 2, {"--size", "even"});
  expect_failure(folder_, {"render", "room.obj", "-o", "a.png", "--camera", "0,0,0 0,0,0 60"}, 2,
                 {"--camera"});
  expect_failure(folder_, {"render", "room.obj", "-o", "a.mp4", "--frames", "9-3"}, 2, {"--frames"});
  expect_failure(folder_, {"render", "room.obj", "-o", "a.mp4", "--time", "1"}, 2, {"--time", "--frames"});
  expect_failure(folder_, {"info", "room.blend"}, 2, {"room.blend", ".glb"});
}

TEST_F(BadInput, MissingOutputFolder) {
  expect_failure(folder_, {"voxelize", "room.obj", "-o", "none/a.vxl"}, 2, {"none", "does not exist"});
  expect_failure(folder_, {"voxelize", "room.obj", "--obj", "none/a.obj"}, 2, {"none", "does not exist"});
  expect_failure(folder_, {"voxelize", "room.obj", "--json", "none/a.json"}, 2, {"none", "does not exist"});
  expect_failure(folder_, {"render", "room.obj", "-o", "none/a.png"}, 2, {"none", "does not exist"});
  expect_failure(folder_, {"render", "room.obj", "-o", "none/a_%d.png"}, 2, {"none", "does not exist"});
  expect_failure(folder_, {"demo", "--out", "none"}, 2, {"none", "does not exist"});
  // A file instead of a folder, and vice versa.
  expect_failure(folder_, {"voxelize", "room.obj", "-o", "room.obj/a.vxl"}, 2, {"room.obj"});
  expect_failure(folder_, {"voxelize", "room.obj", "--obj", "."}, 2, {"folder"});
}

// The old file survives when the new one does not fit.
TEST_F(BadInput, FileSizeLimit) {
  folder_.write("old.obj", "# old\n");
  RunOptions small;
  small.file_bytes = 512;
  expect_failure(folder_, {"voxelize", "room.obj", "--obj", "old.obj"}, 4, {"old.obj", "space"}, small);
  EXPECT_EQ(*read_text_file(folder_.path() / "old.obj"), "# old\n");
  expect_failure(folder_, {"voxelize", "room.obj", "-o", "a.vxl"}, 4, {"a.vxl", "space"}, small);
}

/// A mount namespace of this process while it lives: nothing stays mounted, and afterwards the process finds
/// its own file as before.
class MountNamespace {
 public:
  MountNamespace() : before_(::open("/proc/self/ns/mnt", O_RDONLY | O_CLOEXEC)) {
    if (::unshare(CLONE_NEWNS) == 0) ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr);
  }
  MountNamespace(const MountNamespace&) = delete;
  ~MountNamespace() {
    std::error_code ignored;
    if (::setns(before_, CLONE_NEWNS) == 0) std::filesystem::current_path(folder_, ignored);
    ::close(before_);
  }

 private:
  int before_;
  std::filesystem::path folder_ = std::filesystem::current_path();
};

TEST_F(BadInput, FullDisk) {
  const auto disk = folder_.path() / "disk";
  std::filesystem::create_directory(disk);
  const MountNamespace own;
  if (::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=4k") != 0) {
    GTEST_SKIP() << "no small disk can be mounted here, which takes root; FileSizeLimit has run";
  }
  expect_failure(folder_, {"voxelize", "room.obj", "--voxel", "0.05", "-o", "disk/a.vxl"}, 4,
                 {"disk/a.vxl", "space"});
  EXPECT_TRUE(std::filesystem::is_empty(disk));
  ::umount2(disk.c_str(), MNT_DETACH);
}

TEST_F(BadInput, FullStandardOutput) {
  RunOptions full;
  full.out_file = "/dev/full";
  expect_failure(folder_, {"info", "room.obj", "--json", "-"}, 4, {"standard output", "space"}, full);
}

TEST_F(BadInput, NoDevice) {
  RunOptions none;
  none.environment = {{"VK_DRIVER_FILES", "/nonexistent"}, {"VK_ICD_FILENAMES", "/nonexistent"}};
  expect_failure(folder_, {"devices"}, 5, {"Vulkan"}, none);
  expect_failure(folder_, {"render", "room.obj", "-o", "a.png", "--size", "16x16"}, 5, {"Vulkan"}, none);
  expect_failure(folder_, {"render", "room.obj", "-o", "a.png", "--device", "no such device"}, 5,
                 {"no such device"});
}

}  // namespace
}  // namespace brume::cli
