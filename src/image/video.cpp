#include "image/video.hpp"

#include <cerrno>
#include <cstring>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/file.hpp"
#include "core/platform/child_process.hpp"
#include "image/formats.hpp"

namespace brume::image {
namespace {

std::vector<std::string> ffmpeg_arguments(const VideoOptions& options, const std::string& output) {
  const std::string rate =
      std::to_string(options.frames_per_second) + "/" + std::to_string(options.rate_divisor);
  const std::string size = std::to_string(options.width) + "x" + std::to_string(options.height);
  // Explicit, because players guess BT.601 or BT.709 by the image size.
  const std::string to_bt709 = "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd+full_chroma_int";
  return {"ffmpeg",      "-nostdin",   "-hide_banner", "-loglevel", "error",
          "-xerror",     "-f",         "rawvideo",     "-pix_fmt",  "rgb24",
          "-video_size", size,         "-framerate",   rate,        "-i",
          "pipe:0",      "-an",        "-vf",          to_bt709,    "-c:v",
          "libx264",     "-preset",    "medium",       "-crf",      "16",
          "-pix_fmt",    "yuv420p",    "-colorspace",  "bt709",     "-color_primaries",
          "bt709",       "-color_trc", "bt709",        "-threads",  std::to_string(options.threads),
          "-movflags",   "+faststart", "-f",           "mp4",       "-y",
          output};
}

}  // namespace

struct VideoWriter::Encoder {
  std::filesystem::path path;
  VideoOptions options;
  AtomicFile file;
  platform::Descriptor frames;  // Our end of ffmpeg's standard input.
  platform::ChildProcess process;
  std::vector<std::uint8_t> rgb;

  Encoder(std::filesystem::path target, const VideoOptions& film, AtomicFile&& output)
      : path(std::move(target)), options(film), file(std::move(output)) {}

  Result<void> start();
  /// The failure, once ffmpeg has exited.
  Failure stopped(const platform::ChildEnd& end) const;
};

Result<void> VideoWriter::Encoder::start() {
  auto stream = platform::make_child_input();
  if (!stream) {
    return Failure{ErrorCode::resource_limit,
                   path.string() + ": cannot start ffmpeg: " + std::strerror(errno)};
  }
  frames = std::move(stream->ours);

  // Start it. It writes to our open file, which has no name that a killed program could leave behind.
  const int error = process.start(ffmpeg_arguments(options, "file:" + file.path_for_child()),
                                  {.input = stream->childs.get(), .inherited = file.descriptor()});
  if (error == 0) return {};
  if (error == ENOENT) {
    return Failure{ErrorCode::no_device,
                   path.string() +
                       ": films require the program ffmpeg, which is not on the PATH; install it, or write "
                       "numbered frames, such as -o f_%04d.png"};
  }
  return Failure{ErrorCode::internal, path.string() + ": cannot start ffmpeg: " + std::strerror(error)};
}

Failure VideoWriter::Encoder::stopped(const platform::ChildEnd& end) const {
  const std::string text = process.messages();
  std::string reason = platform::last_line(text);
  using Cause = platform::ChildEnd::Cause;
  bool full = end.cause == Cause::file_size;
  for (const int error : platform::full_errors())
    full = full || text.find(std::strerror(error)) != std::string::npos;
  if (reason.empty() && end.cause != Cause::exited)
    reason = "signal " + std::to_string(end.code) + " ended it";
  if (reason.empty()) reason = "it ended with exit code " + std::to_string(end.code);
  return {full ? ErrorCode::resource_limit : ErrorCode::internal,
          path.string() + ": ffmpeg could not write the film: " + reason +
              (full ? "; free some space or choose another folder" : "")};
}

VideoWriter::VideoWriter(std::unique_ptr<Encoder> encoder) : encoder_(std::move(encoder)) {}
VideoWriter::VideoWriter(VideoWriter&& other) noexcept = default;
VideoWriter::~VideoWriter() = default;

Result<VideoWriter> VideoWriter::open(const std::filesystem::path& path, const VideoOptions& options) {
  if (auto size = check_size(options.width, options.height, path.string()); !size) return size.failure();
  if (options.width % 2 != 0 || options.height % 2 != 0) {
    return Failure{ErrorCode::usage, path.string() + ": a film of " + std::to_string(options.width) + "x" +
                                         std::to_string(options.height) +
                                         " is not possible: both sides must be even; change the size by one"};
  }
  if (options.frames_per_second == 0 || options.rate_divisor == 0) {
    return Failure{ErrorCode::usage, path.string() + ": a film needs at least 1 frame per second"};
  }
  auto file = AtomicFile::open(path);
  if (!file) return file.failure();
  auto encoder = std::make_unique<Encoder>(path, options, std::move(*file));
  if (auto started = encoder->start(); !started) return started.failure();
  return VideoWriter(std::move(encoder));
}

Result<void> VideoWriter::add_frame(const Image8& frame) {
  BRUME_ASSERT(encoder_ && encoder_->process.running(), "after finish or a failure");
  BRUME_ASSERT(frame.width == encoder_->options.width && frame.height == encoder_->options.height,
               std::to_string(frame.width) + "x" + std::to_string(frame.height));
  std::vector<std::uint8_t>& rgb = encoder_->rgb;
  rgb.resize(frame.rgba.size() / 4 * 3);
  for (std::size_t from = 0, to = 0; from < frame.rgba.size(); from += 4, to += 3) {
    std::memcpy(&rgb[to], &frame.rgba[from], 3);
  }
  for (std::size_t done = 0; done < rgb.size();) {
    const std::ptrdiff_t put =
        platform::send_some(encoder_->frames.get(), std::as_bytes(std::span(rgb)).subspan(done));
    if (put < 0) return encoder_->stopped(encoder_->process.wait());
    done += static_cast<std::size_t>(put);
  }
  return {};
}

Result<void> VideoWriter::finish() {
  BRUME_ASSERT(encoder_ && encoder_->process.running(), "after finish or a failure");
  encoder_->frames.close();  // End of input: ffmpeg completes the file and exits.
  const platform::ChildEnd end = encoder_->process.wait();
  // An error message counts even when the exit code is 0.
  if (!end.is_success() || !encoder_->process.messages().empty()) return encoder_->stopped(end);
  return encoder_->file.commit();
}

}  // namespace brume::image
