// Output targets of `render`: an image, a numbered image sequence or a film, chosen by the file name.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <variant>

#include "apps/command_line/frame_names.hpp"
#include "apps/command_line/number.hpp"
#include "apps/command_line/outputs.hpp"
#include "apps/command_line/unit_key.hpp"
#include "image/background.hpp"
#include "image/image.hpp"
#include "image/texels.hpp"

namespace brume::cli {

enum class TargetKind { picture, sequence, film };

/// .png or .exr; the same with one %d or %04d in its file name; .mp4; suffixes in any case. Throws Error
/// (usage) for anything else, and as is_numbered.
TargetKind target_kind(const std::filesystem::path& path);

/// The kind of the file, or of each frame, of a target: png, exr or mp4.
FileKind target_file_kind(const std::filesystem::path& path);

/// A frame as a file holds it: colours in a .png, numbers in an .exr.
using Picture = std::variant<image::Image8, image::LayeredImage>;

/// How frames that were drawn as numbers are written.
struct LayerForm {
  bool as_layers = false;  ///< Numbers; otherwise colours with alpha, as Background::none leaves them.
  image::Background background = image::Background::layer;
};
Picture to_picture(image::LayeredImage layers, const LayerForm& form, const image::Display& display);

/// Writes a picture in the format of its kind. Throws Error.
void save_picture(const std::filesystem::path& path, const Picture& picture,
                  const std::optional<image::ImageText>& text = std::nullopt);

struct FilmSettings {
  glm::uvec2 size_px{0};
  FrameRate rate;
  unsigned threads = 0;
  std::uint32_t warm_up = 0;  ///< As in SequenceSettings.
};

/// Draws the frames first to last, inclusive, and writes them as a film, with progress. Throws Error and
/// whatever `draw` throws; leaves no partial file.
void write_film(const std::filesystem::path& path, const FilmSettings& settings, std::uint32_t first,
                std::uint32_t last, Outputs& outputs,
                const std::function<image::Image8(std::uint32_t)>& draw);

struct SequenceSettings {
  std::filesystem::path pattern;
  std::uint32_t first = 0, last = 0;  ///< Inclusive.
  std::uint32_t warm_up = 0;          ///< Frames drawn before the first, not written; at most `first`.
  UnitKey key;                        ///< Everything that the frames depend on, but for their numbers.
  bool frames_depend = false;         ///< Each frame depends on those before, back to `first`.
  bool resume = false;                ///< Skips frames that are there already.
  bool is_shard = false;              ///< Others write the frames before and after these.
};

/// The text of a frame that carries its key (to_text), in a PNG or an OpenEXR file.
inline constexpr const char* kFrameKeyword = "Brume frame";

/// Draws the frames and writes each as a file, with progress. A frame carries its key. With `resume` it
/// skips frames of the right key that decode without an error, and writes all others again and prints why.
/// The result is the same byte for byte. Throws as write_film does: the frames that were finished stay, and
/// `outputs` knows them.
void write_sequence(const SequenceSettings& settings, Outputs& outputs,
                    const std::function<Picture(std::uint32_t)>& draw);

}  // namespace brume::cli
