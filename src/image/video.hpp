// Writes videos: pipes frames to the `ffmpeg` program, which encodes H.264 in an MP4 file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "core/error.hpp"
#include "image/image.hpp"

namespace brume::image {

struct VideoOptions {
  std::uint32_t width = 0, height = 0;  ///< Texels; even, because of 4:2:0 chroma subsampling.
  std::uint32_t frames_per_second = 24;
  unsigned threads = 0;            ///< Threads of ffmpeg; 0: its own choice.
  std::uint32_t rate_divisor = 1;  ///< The rate is frames_per_second / rate_divisor; not 0.
};

/// Writes one video. The file appears under its name only after a successful `finish`; a writer destroyed
/// before that stops ffmpeg and leaves no file; neither does a killed program. ffmpeg ends with the thread
/// that called `open`.
class VideoWriter {
 public:
  /// Starts ffmpeg. Fails with usage when a side is odd or zero, with bad_input when the folder does not
  /// exist or is not writable, and with no_device when there is no ffmpeg program.
  static Result<VideoWriter> open(const std::filesystem::path& path, const VideoOptions& options);
  VideoWriter(VideoWriter&& other) noexcept;
  VideoWriter& operator=(VideoWriter&&) = delete;
  ~VideoWriter();

  /// Appends a frame of the video's size; its alpha is ignored. Blocks while ffmpeg is busy. If ffmpeg has
  /// exited, fails with the last line of its output.
  Result<void> add_frame(const Image8& frame);

  /// Ends the video and gives the file its name. Fails if ffmpeg failed.
  Result<void> finish();

 private:
  struct Encoder;
  explicit VideoWriter(std::unique_ptr<Encoder> encoder);
  std::unique_ptr<Encoder> encoder_;
};

}  // namespace brume::image
