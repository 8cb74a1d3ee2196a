#include "image/video.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>

#include "image/decode.hpp"
#include "tests/image/image_test_tools.hpp"

namespace brume::image {
namespace {

// Replaces the search path for programs in a scope.
class SearchPath {
 public:
  explicit SearchPath(const std::string& path) : old_(std::getenv("PATH")) {
    ::setenv("PATH", path.c_str(), 1);
  }
  SearchPath(const SearchPath&) = delete;
  ~SearchPath() { ::setenv("PATH", old_.c_str(), 1); }

 private:
  std::string old_;
};

void write_program(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path) << "#!/bin/sh\n" << text << "\n";
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
}

Image8 plain(std::uint32_t width, std::uint32_t height, std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  Image8 image{width, height, {}};
  for (std::uint32_t i = 0; i < width * height; ++i) image.rgba.insert(image.rgba.end(), {r, g, b, 255});
  return image;
}

bool no_children() {
  return ::waitpid(-1, nullptr, WNOHANG) == -1;
}

TEST(Video, KeepsSizeCountAndColours) {
  const cli::WorkFolder folder;
  const auto film = folder.path() / "a film.mp4";
  auto writer = VideoWriter::open(film, {64, 34, 24, 1});
  ASSERT_TRUE(writer) << writer.failure().message;
  for (int i = 0; i < 12; ++i) ASSERT_TRUE(writer->add_frame(plain(64, 34, 200, 90, 30)));
  EXPECT_FALSE(std::filesystem::exists(film));
  const auto finished = writer->finish();
  ASSERT_TRUE(finished) << finished.failure().message;
  EXPECT_EQ(folder.files().size(), 1u);
  EXPECT_TRUE(no_children());

  // ffmpeg decodes it again, each frame to an image.
  const std::string command =
      "ffmpeg -nostdin -loglevel error -i '" + film.string() + "' '" + folder.path().string() + "/%02d.png'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(folder.files().size(), 13u);
  const auto frame = load_image(folder.path() / "12.png").value_or_throw();
  EXPECT_EQ(frame.width, 64u);
  EXPECT_EQ(frame.height, 34u);
  // Studio range has 219 steps of luma and 224 of chroma; BT.709 gives blue the largest factor, 1.86: half a
  // step of each and of the conversion back is at most 0.5 * (255 / 219 + 1.86 * 255 / 224) + 0.5 < 2.2, for
  // the quantizer of crf 16 on a plain image two more.
  for (std::size_t i = 0; i < frame.rgba.size(); i += 4) {
    ASSERT_NEAR(frame.rgba[i], 200, 4);
    ASSERT_NEAR(frame.rgba[i + 1], 90, 4);
    ASSERT_NEAR(frame.rgba[i + 2], 30, 4);
  }
}

TEST(Video, RejectsOddSizes) {
  const cli::WorkFolder folder;
  for (const auto& options : {VideoOptions{33, 18}, VideoOptions{32, 17}}) {
    const auto writer = VideoWriter::open(folder.path() / "a.mp4", options);
    ASSERT_FALSE(writer);
    EXPECT_EQ(writer.failure().code, ErrorCode::usage);
    EXPECT_NE(writer.failure().message.find("even"), std::string::npos);
  }
  EXPECT_EQ(VideoWriter::open(folder.path() / "a.mp4", {0, 2}).failure().code, ErrorCode::bad_input);
  EXPECT_EQ(VideoWriter::open(folder.path() / "a.mp4", {2, 2, 0}).failure().code, ErrorCode::usage);
  EXPECT_EQ(folder.files().size(), 0u);
}

TEST(Video, NamesTheMissingFolder) {
  const auto writer = VideoWriter::open("/nonexistent/a.mp4", {2, 2});
  ASSERT_FALSE(writer);
  EXPECT_EQ(writer.failure().code, ErrorCode::bad_input);
}

TEST(Video, NamesTheMissingProgramAndTheFix) {
  const cli::WorkFolder folder;
  const SearchPath search(folder.path().string());
  const auto writer = VideoWriter::open(folder.path() / "a.mp4", {2, 2});
  ASSERT_FALSE(writer);
  EXPECT_NE(writer.failure().message.find("require the program ffmpeg"), std::string::npos);
  EXPECT_EQ(folder.files().size(), 0u);
}

TEST(Video, ReportsTheLastMessageOfFfmpeg) {
  const cli::WorkFolder folder;
  write_program(folder.path() / "ffmpeg", "echo first >&2; echo 'the last line' >&2; exit 3");
  const SearchPath search(folder.path().string());
  auto writer = VideoWriter::open(folder.path() / "a.mp4", {64, 64});
  ASSERT_TRUE(writer) << writer.failure().message;
  // It reads nothing: eventually a write fails with a closed pipe, without a SIGPIPE.
  Result<void> added;
  for (int i = 0; i < 1000 && added; ++i) added = writer->add_frame(plain(64, 64, 1, 2, 3));
  ASSERT_FALSE(added);
  EXPECT_NE(added.failure().message.find("the last line"), std::string::npos);
  EXPECT_EQ(added.failure().message.find("first"), std::string::npos);
  EXPECT_TRUE(no_children());
}

TEST(Video, FailsAtTheEndWhenFfmpegDoes) {
  const cli::WorkFolder folder;
  write_program(folder.path() / "ffmpeg", "/bin/cat > /dev/null; exit 3");
  {
    const SearchPath search(folder.path().string());
    auto writer = VideoWriter::open(folder.path() / "a.mp4", {64, 64});
    ASSERT_TRUE(writer) << writer.failure().message;
    ASSERT_TRUE(writer->add_frame(plain(64, 64, 1, 2, 3)));
    const auto finished = writer->finish();
    ASSERT_FALSE(finished);
    EXPECT_NE(finished.failure().message.find("exit code 3"), std::string::npos);
  }
  EXPECT_EQ(folder.files().size(), 1u) << "only the program";
}

TEST(Video, LeavesNothingWhenDropped) {
  const cli::WorkFolder folder;
  {
    auto writer = VideoWriter::open(folder.path() / "a.mp4", {64, 64});
    ASSERT_TRUE(writer) << writer.failure().message;
    ASSERT_TRUE(writer->add_frame(plain(64, 64, 1, 2, 3)));
    const VideoWriter moved = std::move(*writer);
    EXPECT_EQ(folder.files().size(), 0u) << "has no name before it is complete";
  }
  EXPECT_EQ(folder.files().size(), 0u);
  EXPECT_TRUE(no_children());
}

// A file size limit simulates a full disk: it ends ffmpeg by a signal or, if that is ignored, makes its
// writes fail. The short film fits until its index is written.
TEST(Video, ReportsAFullDisk) {
  rlimit old{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old), 0);
  for (const auto handler : {SIG_DFL, SIG_IGN}) {
    for (const unsigned frames : {2u, 40u}) {
      const cli::WorkFolder folder;
      const auto old_handler = ::signal(SIGXFSZ, handler);
      const rlimit small{400, old.rlim_max};
      ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
      {
        auto writer = VideoWriter::open(folder.path() / "a.mp4", {64, 64, 24, 1});
        EXPECT_TRUE(writer) << writer.failure().message;
        Result<void> result;
        for (unsigned i = 0; i < frames && result; ++i)
          result = writer->add_frame(random_image(64, 64, true, i));
        if (result) result = writer->finish();
        EXPECT_FALSE(result) << frames;
        EXPECT_EQ(result.failure().code, ErrorCode::resource_limit) << result.failure().message;
      }
      ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &old), 0);
      ::signal(SIGXFSZ, old_handler);
      EXPECT_EQ(folder.files().size(), 0u);
    }
  }
}

}  // namespace
}  // namespace brume::image
