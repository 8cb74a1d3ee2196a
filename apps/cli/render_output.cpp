#include "apps/cli/render_output.hpp"

#include <array>
#include <cmath>
#include <span>

#include "apps/cli/console.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/hash.hpp"
#include "core/log.hpp"
#include "grids/files.hpp"
#include "scene/text_reader.hpp"

namespace brume::cli {

FrameRange frames_of(const Plan& plan, double duration) {
  // A duration of a whole number of frames must not become one more by rounding.
  constexpr double kRounding = 1e-6;
  const double frames = duration * plan.rate.per_second();
  const auto all = static_cast<std::uint32_t>(std::ceil(frames - kRounding));
  return plan.frames.value_or(FrameRange{0, std::max(all, 1u) - 1});
}

double picture_time(const RenderOptions& options, double duration) {
  return options.time.value_or(duration);
}

void warn_of_times(const RenderOptions& options, const Plan& plan, double end) {
  const std::string after = " after the end of the timeline at " + scene::shown(end) + " s";
  if (options.time && *options.time > end)
    log_warning("--time " + scene::shown(*options.time) + ": is" + after);
  if (!plan.frames) return;
  const double last = plan.rate.time_of(plan.frames->last);
  if (last > end)
    log_warning("--frames " + options.frames + ": the last is at " + scene::shown(last) + " s," + after);
}

namespace {

// Frames to draw before a range whose frames depend on those before: all that leave a trace. Each frame's
// mean is that of at most shared::kAccumulatedFrames, so that (7 / 8)^32 = 1.4 % of an older one remain.
std::uint32_t warm_up_of(const RenderOptions& options, std::uint32_t first) {
  constexpr std::uint32_t kWarmUp = 32;
  return frames_depend(options) ? std::min(first, kWarmUp) : 0;
}

}  // namespace

std::uint64_t sequence_key(const RenderOptions& options, std::vector<std::filesystem::path> files,
                           const std::vector<std::string>& device, const FrameRange& range) {
  // Names every option, so that a new one does not compile before someone decides whether it belongs here.
  const auto& [input, output, timeline, frame_range, size, march, camera, device_option, json, view, slice,
               fps, raycast, mode, scene_options, reference, time, orbit, shutter, samples, temporal, resume,
               step, light_update_fraction, resolve_error_scale, volume_memory] = options;

  // Files.
  files.insert(files.end(), {timeline, "/proc/self/exe"});
  if (!grids::is_grid_file(input)) files.emplace_back(input);  // Otherwise it is among the scenario's.
  std::uint64_t key = 0;
  for (const std::filesystem::path& file : files) {
    stop_if_interrupted();
    const auto bytes = file.empty() ? std::vector<std::byte>() : read_file(file).value_or_throw();
    key = hash_bytes(bytes, key);
  }

  // RenderOptions and device.
  std::vector<std::string> texts{size, march, camera, view, slice, fps, raycast, mode};
  for (const auto& more : {device, texts_of(scene_options), texts_of(reference)})
    texts.insert(texts.end(), more.begin(), more.end());
  for (const std::string& text : texts) key = hash_bytes(std::as_bytes(std::span(text)), key);
  const std::array<float, 3> numbers{step, light_update_fraction, resolve_error_scale};
  key = hash_values(std::span<const float>(numbers), key);
  const std::array<double, 2> real{orbit.value_or(0), shutter.value_or(-1)};
  key = hash_values(std::span<const double>(real), key);
  const std::array<std::uint32_t, 7> whole{volume_memory,
                                           samples.value_or(0),
                                           temporal ? 1u : 0u,
                                           frames_depend(options) ? 1u : 0u,
                                           frames_depend(options) ? range.first : 0u,
                                           orbit ? range.first : 0u,
                                           orbit ? range.last : 0u};
  return hash_values(std::span<const std::uint32_t>(whole), key);
}

void write(const RenderOptions& options, const Plan& plan, CommonOptions& common, const Film& film,
           const DrawFrame& draw) {
  if (plan.kind == TargetKind::picture) {
    const Picture picture = draw(picture_time(options, film.duration), 0);
    stop_if_interrupted();
    save_picture(plain_name(options.output), picture);
    return;
  }
  const FrameRange range = frames_of(plan, film.duration);
  const std::uint32_t warm_up = warm_up_of(options, range.first);
  if (plan.kind == TargetKind::film) {
    write_film(plain_name(options.output), {plan.renderer.size_px, plan.rate, common.threads, warm_up},
               range.first, range.last, common.outputs,
               [&](std::uint32_t i) { return std::get<image::Image8>(draw(plan.rate.time_of(i), i)); });
    return;
  }
  write_sequence(
      {options.output, range.first, range.last, warm_up, plan.renderer.size_px,
       sequence_key(options, film.files, film.device, range), frames_depend(options), options.resume},
      common.outputs, [&](std::uint32_t i) { return draw(plan.rate.time_of(i), i); });
}

}  // namespace brume::cli
