#include "apps/command_line/targets.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "apps/command_line/console.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/progress.hpp"
#include "image/decode.hpp"
#include "image/exr.hpp"
#include "image/png.hpp"
#include "image/video.hpp"
#include "scene/files/load.hpp"

namespace brume::cli {
namespace {

image::ImageText frame_text(const UnitKey& key, std::uint32_t frame) {
  return {kFrameKeyword, to_text(key, frame)};
}

// Its text of a key; nothing: it has none or is no image.
std::optional<std::string> found_text(std::span<const std::byte> bytes, bool is_exr) {
  if (!is_exr) return image::find_png_text(bytes, kFrameKeyword);
  const auto parts = image::decode_exr_parts(bytes, "");
  if (!parts || parts->size() != 1) return std::nullopt;
  for (const image::ImageText& text : parts->front().texts)
    if (text.keyword == kFrameKeyword) return text.text;
  return std::nullopt;
}

bool is_truncated(std::span<const std::byte> bytes, bool is_exr, const std::string& failure) {
  if (is_exr) return failure.find("truncated") != std::string::npos;
  constexpr std::string_view kEnd = "IEND\xae\x42\x60\x82";
  return bytes.size() < kEnd.size() ||
         std::memcmp(bytes.data() + bytes.size() - kEnd.size(), kEnd.data(), kEnd.size()) != 0;
}

// Why the file of the frame is not complete or made from other inputs; empty: it is the frame.
std::string reason_of(const SequenceSettings& settings, std::uint32_t frame) {
  const std::filesystem::path file = sequence_name(settings.pattern, frame);
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return "missing";
  const auto bytes = read_file(file);
  if (!bytes) return "unreadable";
  const bool is_exr = target_file_kind(settings.pattern) == FileKind::exr;
  const auto text = found_text(*bytes, is_exr);
  const std::string fault = difference(text.value_or(""), settings.key, frame);
  if (text && !fault.empty()) return fault;
  std::string failure;
  bool is_intact = true;  // Beside its pixels.
  if (is_exr) {
    const auto length = image::exr_length(*bytes, "");
    if (!length) failure = length.failure().message;
    is_intact = length && *length == bytes->size();
  } else {
    if (const auto image = image::decode_image(*bytes, ""); !image) failure = image.failure().message;
    is_intact = image::is_intact_png(*bytes);
  }
  if (!failure.empty()) return is_truncated(*bytes, is_exr, failure) ? "truncated" : "damaged";
  return is_intact ? fault : "damaged";
}

}  // namespace

Picture to_picture(image::LayeredImage layers, const LayerForm& form, const image::Display& display) {
  image::set_background(layers, form.background);
  if (form.as_layers) return layers;
  return image::to_colors(image::displayed_straight(image::to_texels(layers), display));
}

TargetKind target_kind(const std::filesystem::path& path) {
  const std::string extension = scene::lower_extension(path);
  if (extension != ".png" && extension != ".exr" && extension != ".mp4")
    throw Error(ErrorCode::usage,
                "-o " + path.string() + ": cannot write this file type; expected .png, .exr or .mp4");
  const bool numbered = is_numbered("-o", path);
  if (extension != ".mp4") return numbered ? TargetKind::sequence : TargetKind::picture;
  if (numbered)
    throw Error(ErrorCode::usage, "-o " + path.string() + ": numbered frames are .png or .exr files");
  return TargetKind::film;
}

FileKind target_file_kind(const std::filesystem::path& path) {
  const std::string extension = scene::lower_extension(path);
  return extension == ".exr" ? FileKind::exr : extension == ".mp4" ? FileKind::mp4 : FileKind::png;
}

void save_picture(const std::filesystem::path& path, const Picture& picture,
                  const std::optional<image::ImageText>& text) {
  if (const auto* colours = std::get_if<image::Image8>(&picture)) {
    image::save_png(path, *colours, text).value_or_throw();
  } else {
    image::save_exr(path, std::get<image::LayeredImage>(picture), text).value_or_throw();
  }
}

void write_film(const std::filesystem::path& path, const FilmSettings& settings, std::uint32_t first,
                std::uint32_t last, Outputs& outputs,
                const std::function<image::Image8(std::uint32_t)>& draw) {
  image::VideoWriter writer =
      image::VideoWriter::open(path, {settings.size_px.x, settings.size_px.y, settings.rate.numerator,
                                      settings.threads, settings.rate.denominator})
          .value_or_throw();
  const std::uint32_t count = last - first + 1;
  Progress progress("frames", count + settings.warm_up);
  for (std::uint32_t i = 0; i < settings.warm_up; ++i) {
    stop_if_interrupted();
    draw(first - settings.warm_up + i);
    progress.advance();
  }
  for (std::uint32_t drawn = 0; drawn < count; ++drawn) {
    outputs.film_progress(path, drawn, count);
    stop_if_interrupted();
    writer.add_frame(draw(first + drawn)).value_or_throw();
    progress.advance();
  }
  stop_if_interrupted();
  writer.finish().value_or_throw();
}

void write_sequence(const SequenceSettings& settings, Outputs& outputs,
                    const std::function<Picture(std::uint32_t)>& draw) {
  // What is there already.
  const std::uint32_t count = settings.last - settings.first + 1;
  std::vector<std::string> reasons(count, "to do");
  outputs.set_frames_depend(settings.frames_depend || settings.is_shard);
  for (std::uint32_t i = 0; settings.resume && i < count; ++i) {
    stop_if_interrupted();
    reasons[i] = reason_of(settings, settings.first + i);
    if (reasons[i].empty()) outputs.frame_done(settings.first + i);
  }
  const auto is_done = [](const std::string& reason) { return reason.empty(); };
  const auto missing = count - static_cast<std::uint64_t>(std::ranges::count_if(reasons, is_done));
  const auto end = static_cast<std::uint32_t>(reasons.rend() -
                                              std::find_if_not(reasons.rbegin(), reasons.rend(), is_done));
  if (settings.resume) print_reasons(settings.first, reasons);
  if (missing < count)
    print_on_terminal(std::to_string(count - missing) + " of " + std::to_string(count) + " frames are there");

  // The rest. Where frames depend on each other, all up to the last missing one are drawn.
  Progress progress("frames", missing + (missing > 0 ? settings.warm_up : 0));
  for (std::uint32_t i = 0; missing > 0 && i < settings.warm_up; ++i) {
    stop_if_interrupted();
    draw(settings.first - settings.warm_up + i);
    progress.advance();
  }
  for (std::uint32_t i = 0; i < end; ++i) {
    stop_if_interrupted();
    const std::uint32_t frame = settings.first + i;
    const bool done = is_done(reasons[i]);
    if (done && !settings.frames_depend) continue;
    const Picture picture = draw(frame);
    if (done) continue;
    save_picture(sequence_name(settings.pattern, frame), picture, frame_text(settings.key, frame));
    outputs.frame_done(frame);
    progress.advance();
  }
}

}  // namespace brume::cli
