// Films out: frames go down a pipe to the `ffmpeg` program, which encodes H.264 in an MP4 file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "core/error.hpp"
#include "image/image.hpp"

namespace brume::image {

struct VideoOptions {
  std::uint32_t width = 0, height = 0;  ///< Texels; even, because the format halves its colour planes.
  std::uint32_t frames_per_second = 24;
  unsigned threads = 0;  ///< That ffmpeg may use; 0: as many as it likes.
};

/// Writes one film. The file appears under its name only after a successful `finish`; a writer that is
/// destroyed before that stops ffmpeg and leaves nothing behind.
class VideoWriter {
 public:
  /// Starts ffmpeg. Fails with usage when a side is odd or zero, with bad_input when the folder does not
  /// exist or is not writable, and with internal when there is no ffmpeg program.
  static Result<VideoWriter> open(const std::filesystem::path& path, const VideoOptions& options);
  VideoWriter(VideoWriter&& other) noexcept;
  VideoWriter& operator=(VideoWriter&&) = delete;
  ~VideoWriter();

  /// Appends a frame of the film's size; its alpha is ignored. Waits while ffmpeg is behind. When ffmpeg has
  /// ended, fails with the last line that it said.
  Result<void> add_frame(const Image8& frame);

  /// Ends the film and gives the file its name. Fails when ffmpeg did.
  Result<void> finish();

 private:
  struct Encoder;
  explicit VideoWriter(std::unique_ptr<Encoder> encoder);
  std::unique_ptr<Encoder> encoder_;
};

}  // namespace brume::image
