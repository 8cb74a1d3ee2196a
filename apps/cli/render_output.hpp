// What `brume render` writes: a picture, numbered frames or a film, of whatever draws them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "apps/cli/command.hpp"
#include "apps/cli/render_options.hpp"
#include "apps/command_line/unit_key.hpp"

namespace brume::cli {

/// What is drawn, for its times and for the keys of numbered frames.
struct Film {
  double duration = 0;                       ///< [s]
  std::vector<std::filesystem::path> files;  ///< What it is made from, besides the files of the command line.
  std::vector<std::string> device;           ///< Texts that name what draws.
};

/// Draws a frame at a time [s].
using DrawFrame = std::function<Picture(double, std::uint32_t)>;

/// Draws and writes what the plan says. Throws Error and what `draw` throws.
void write(const RenderOptions& options, const Plan& plan, CommonOptions& common, const Film& film,
           const DrawFrame& draw);

/// --frames, or all of a film.
FrameRange frames_of(const Plan& plan, double duration);
/// Whether there is something to draw: a shard may have no frame.
bool has_frames(const Plan& plan, double duration);
/// --time, or the end.
double picture_time(const RenderOptions& options, double duration);
/// Times behind the end of a timeline show its end.
void warn_of_times(const RenderOptions& options, const Plan& plan, double end);

/// Everything that a frame of a sequence depends on, but for its number.
UnitKey sequence_key(const RenderOptions& options, std::vector<std::filesystem::path> files,
                     const std::vector<std::string>& device, const FrameRange& range);
/// The same for the checkpoint of a picture.
std::uint64_t checkpoint_key(const UnitKey& key);

}  // namespace brume::cli
