#include "tests/cli/kill_matrix.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <sys/mount.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>

#include "core/file.hpp"
#include "image/decode.hpp"
#include "image/png.hpp"

namespace brume::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTimeline =
    "version = 1\nscene = \"room.obj\"\nduration = 0.5\n[smoke]\nvoxels = 200\nbloom = 0.2\n"
    "[[camera]]\ntime = 0.0\nposition = [0.0, 1.7, 1.8]\ntarget = [0.0, 1.2, -1.0]\nfov = 70.0\n"
    "[[event]]\ntype = \"smoke\"\ntime = 0.0\nfrom = [0.0, 0.5, -1.0]\nat = [0.0, 0.5, -1.0]\n";

// An older file of the kind: short, and never what the program writes.
std::string old_file(const fs::path& name) {
  using namespace std::string_literals;
  const std::string extension = name.extension().string();
  if (extension == ".png") return "\x89PNG\r\n\x1a\nold";
  if (extension == ".exr") return "\x76\x2f\x31\x01old";
  if (extension == ".brv") return "BRUMEBRVold";
  if (extension == ".spheres") return "BRUMESPHold";
  if (extension == ".key") return "BRUMEKEY old";
  if (extension == ".mp4")
    return "\0\0\0\x08"
           "ftypold"s;
  if (extension == ".vxl") return "BRUMEVXLold";
  if (extension == ".brp") return "BRUMERPLold";
  if (extension == ".obj") return "# old\n";
  if (extension == ".toml") return "version = 1\n";
  if (extension == ".csv") return "frame,seconds,old\n";
  // What an atlas may replace, and any other output that is JSON.
  return R"({"format": "brume slice atlas"})";
}

bool is_part(const std::string& name) {
  return name.front() == '.' && name.find(".brume-part-") != std::string::npos;
}

}  // namespace

std::vector<WritingCommand> writing_commands() {
  const auto render = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"render", "room.toml", "--size", "32x18", "--threads", "1"});
    return more;
  };
  return {
      {{"voxelize", "-q", "room.obj", "-o", "out/a.vxl", "--obj", "out/a.obj", "--json", "out/a.json"}},
      {{"sim", "room.toml", "--record", "out/a.brp", "--json", "out/a.json"}},
      {render({"-o", "out/a.png", "--json", "out/a.json"})},
      {render({"-o", "out/f_%02d.png", "--frames", "1-6", "--json", "out/a.json"}), true},
      {render({"-o", "out/a.mp4", "--frames", "0-5"})},
      {{"diff", "a.png", "b.png", "-o", "out/map.png", "--json", "out/a.json"}},
      {{"bake", "pyroclastic", "--edge", "48", "-o", "out/a.brv", "--json", "out/a.json"}},
      {{"bake", "slices", "room.obj", "-o", "out/a.png", "--size", "16x16x16", "--mips", "--json",
        "out/r.json"}},
      {{"bake", "occlusion", "room.obj", "-o", "out/a.png", "--size", "8x8x8", "--rays", "16", "--separate"}},
      {{"bake", "spheres", "-o", "out/a.spheres", "--size", "50x50x50", "--count", "500", "--radius", "1-5",
        "--json", "out/a.json"}},
      {{"bake", "spheres", "-o", "out/t_%d.spheres", "--size", "50x50x50", "--count", "500", "--radius",
        "1-5", "--frames", "1-3"},
       true},
      {{"info", "room.obj", "--json", "out/a.json"}},
      {{"query", "room.toml", "--from", "0,1,1", "--to", "0,1,-1", "--time", "0.2", "--json", "out/a.json"}},
      {{"palettes", "sea", "-o", "out/a.png", "--json", "out/a.json"}},
      {{"devices", "--json", "out/a.json"}},
      {render({"-o", "out/a.exr"})},
      {{"sim", "room.toml", "--volumes", "out/s_%d.brv", "--frames", "4-6"}},
      {{"bench", "fill/1800", "--repetitions", "1", "--json", "out/a.json"}},
  };
}

KillMatrix::KillMatrix(WritingCommand command) : command_(std::move(command)) {
  folder_.write("room.obj", room_obj());
  folder_.write("room.toml", kTimeline);
  image::Image8 picture{64, 64, std::vector<std::uint8_t>(4 * 64 * 64, 255)};
  image::save_png(folder_.path() / "a.png", picture).value_or_throw();
  for (std::size_t i = 0; i < picture.rgba.size(); ++i)
    if (i % 4 != 3) picture.rgba[i] = static_cast<std::uint8_t>(i * i >> 7);
  image::save_png(folder_.path() / "b.png", picture).value_or_throw();
  fs::create_directory(folder_.path() / "out");

  RunOptions count;
  count.signal = SIGKILL;
  count.signal_at = ~std::uint64_t{0};
  const Outcome whole = run(count);
  EXPECT_EQ(whole.exit_code, 0) << whole.error;
  calls_ = whole.file_calls;
  EXPECT_GT(calls_, 0u);
  expected_ = files();
  EXPECT_FALSE(expected_.empty());
  for (const auto& [name, bytes] : expected_) old_[name] = old_file(name);
}

Outcome KillMatrix::run(RunOptions options, bool resume) const {
  std::vector<std::string> arguments = command_.arguments;
  if (resume) arguments.emplace_back("--resume");
  options.environment = command_.environment;
  return run_brume(folder_.path(), arguments, options);
}

KillMatrix::Files KillMatrix::files() const {
  Files files;
  for (const auto& entry : fs::directory_iterator(folder_.path() / "out"))
    files[entry.path().filename().string()] = *read_text_file(entry.path());
  return files;
}

void KillMatrix::empty_out() const {
  for (const auto& entry : fs::directory_iterator(folder_.path() / "out")) fs::remove(entry.path());
}

void KillMatrix::begin(bool with_old_files) {
  empty_out();
  if (!with_old_files) return;
  for (const auto& [name, bytes] : old_) folder_.write("out/" + name, bytes);
}

bool KillMatrix::is_whole(const std::string& name, const std::string& bytes) const {
  const std::string extension = fs::path(name).extension().string();
  if (extension == ".json") return nlohmann::json::accept(bytes);
  if (command_.exact) return bytes == expected_.at(name);
  if (extension == ".png")
    return static_cast<bool>(image::decode_image(std::as_bytes(std::span(bytes)), name));
  return !bytes.empty() && bytes.back() == '\n';
}

void KillMatrix::check_whole(bool parts_allowed) const {
  for (const auto& [name, bytes] : files()) {
    if (parts_allowed && is_part(name)) continue;
    ASSERT_TRUE(expected_.contains(name)) << name << " is left behind";
    EXPECT_TRUE(bytes == old_.at(name) || is_whole(name, bytes)) << name << " is torn";
  }
}

void KillMatrix::check_completion() const {
  const Outcome rest = run({}, command_.resumes);
  EXPECT_EQ(rest.exit_code, 0) << rest.error;
  const Files now = files();
  for (const auto& [name, bytes] : now) EXPECT_TRUE(expected_.contains(name)) << name << " is left behind";
  for (const auto& [name, bytes] : expected_) {
    ASSERT_TRUE(now.contains(name)) << name;
    EXPECT_TRUE(is_whole(name, now.at(name))) << name;
  }
}

// Whether the run ended early.
int KillMatrix::check_run(const Outcome& outcome, const std::vector<int>& codes, bool killed) const {
  EXPECT_TRUE(outcome.exit_code == 0 || std::count(codes.begin(), codes.end(), outcome.exit_code) == 1)
      << outcome.exit_code << ": " << outcome.error;
  if (outcome.exit_code != 0 && !killed) {
    // A limit of the file size may cut off the message too, since it goes to a file here.
    EXPECT_LE(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
    EXPECT_EQ(outcome.error.rfind("brume: ", 0), 0u) << outcome.error;
  }
  check_whole(killed);
  if (!killed && outcome.exit_code > 128) {  // Nothing was written.
    for (const auto& [name, bytes] : files()) EXPECT_TRUE(bytes == old_.at(name)) << name << " is written";
  }
  check_completion();
  return outcome.exit_code == 0 ? 0 : 1;
}

int KillMatrix::end_by_signal(int signal, std::uint64_t runs) {
  int ended = 0;
  for (std::uint64_t i = 0; i < runs; ++i) {
    RunOptions options;
    options.signal = signal;
    // The last calls publish files: with as many runs as calls, each call has its own.
    options.signal_at = calls_ - std::min(calls_ - 1, i * std::max<std::uint64_t>(1, calls_ / runs));
    SCOPED_TRACE("signal " + std::to_string(signal) + " at call " + std::to_string(options.signal_at));
    begin(i % 2 == 1);
    ended += check_run(run(options), {128 + signal, 6}, signal == SIGKILL);
  }
  return ended;
}

int KillMatrix::end_by_file_size(std::uint64_t runs) {
  std::size_t largest = 0;
  for (const auto& [name, bytes] : expected_) largest = std::max(largest, bytes.size());
  int ended = 0;
  for (std::uint64_t i = 0; i < runs; ++i) {
    RunOptions options;
    options.file_bytes = largest * (i + 1) / (runs + 1);
    SCOPED_TRACE("at most " + std::to_string(options.file_bytes) + " bytes");
    begin(i % 2 == 1);
    ended += check_run(run(options), {4, 6}, false);
  }
  return ended;
}

int KillMatrix::end_by_full_disk(std::uint64_t runs) {
  empty_out();
  // In a mount namespace of its own, so that nothing stays mounted when this process ends.
  if (::unshare(CLONE_NEWNS) == 0) ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr);
  const fs::path out = folder_.path() / "out";
  int ended = 0;
  for (std::uint64_t i = 0; i < runs; ++i) {
    const std::string pages = "nr_blocks=" + std::to_string(i + 1);
    if (::mount("tmpfs", out.c_str(), "tmpfs", 0, pages.c_str()) != 0) return ended;
    SCOPED_TRACE(pages);
    const Outcome full = run();
    EXPECT_TRUE(full.exit_code == 0 || full.exit_code == 4 || full.exit_code == 6) << full.error;
    check_whole(false);
    EXPECT_EQ(::mount("tmpfs", out.c_str(), "tmpfs", MS_REMOUNT, "nr_blocks=4096"), 0);
    check_completion();
    ended += full.exit_code != 0;
    ::umount2(out.c_str(), MNT_DETACH);
  }
  return ended;
}

}  // namespace brume::cli
