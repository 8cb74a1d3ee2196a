#include "apps/cli/render_output.hpp"

#include <cmath>
#include <span>

#include "apps/command_line/console.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/hash.hpp"
#include "core/log.hpp"
#include "core/utf8.hpp"
#include "grids/files/grid_files.hpp"
#include "scene/text_reader.hpp"

namespace brume::cli {

FrameRange frames_of(const Plan& plan, double duration) {
  // The duration is a float: rounding must not turn a whole number of frames into one more.
  constexpr double kRounding = 1e-3;
  const double frames = duration * plan.rate.per_second();
  const auto all = static_cast<std::uint32_t>(std::ceil(frames - kRounding));
  return plan.frames.value_or(FrameRange{0, std::max(all, 1u) - 1});
}

bool has_frames(const Plan& plan, double duration) {
  return plan.kind != TargetKind::sequence || part_of(frames_of(plan, duration), plan.shard);
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
// mean covers at most shared::kAccumulatedFrames, so that (7 / 8)^32 = 1.4 % of an older one remain.
std::uint32_t warm_up_of(const RenderOptions& options, std::uint32_t first) {
  constexpr std::uint32_t kWarmUp = 32;
  return frames_depend(options) ? std::min(first, kWarmUp) : 0;
}

}  // namespace

UnitKey sequence_key(const RenderOptions& options, std::vector<std::filesystem::path> files,
                     const std::vector<std::string>& device, const FrameRange& range) {
  // Names every option, so that a new one does not compile before someone decides whether it belongs here.
  const auto& [input, output, timeline, frame_range, size, march, camera, device_option, json, view, slice,
               fps, raycast, mode, shard, background, scene_options, reference, flipbook, time, orbit,
               shutter, samples, temporal, resume, step, light_update_fraction, resolve_error_scale,
               volume_memory] = options;
  files.push_back(to_path(timeline));
  if (!grids::is_grid_file(to_path(input)))
    files.push_back(to_path(input));  // Otherwise it is among the scenario's.

  std::vector<std::string> settings{size, march, camera, view, slice, fps, raycast, mode, background};
  for (const auto& more : {to_texts(scene_options), to_texts(reference)})
    settings.insert(settings.end(), more.begin(), more.end());
  for (const double number : {double{step}, double{light_update_fraction}, double{resolve_error_scale},
                              orbit.value_or(0), shutter.value_or(-1)})
    settings.push_back(exact_text(number));
  const bool depend = frames_depend(options);
  for (const std::uint32_t whole :
       {volume_memory, samples.value_or(0), temporal ? 1u : 0u, depend ? 1u : 0u, depend ? range.first : 0u,
        orbit ? range.first : 0u, orbit ? range.last : 0u})
    settings.push_back(std::to_string(whole));
  return {hash_of_files(files), hash_of_texts(settings), hash_of_texts(device), program_hash()};
}

std::uint64_t checkpoint_key(const UnitKey& key) {
  const std::string text = to_text(key, 0);
  return hash_bytes(std::as_bytes(std::span(text)));
}

void write(const RenderOptions& options, const Plan& plan, CommonOptions& common, const Film& film,
           const DrawFrame& draw) {
  if (plan.kind == TargetKind::picture) {
    const Picture picture = draw(picture_time(options, film.duration), 0);
    stop_if_interrupted();
    save_picture(plain_name(to_path(options.output)), picture);
    return;
  }
  const FrameRange range = frames_of(plan, film.duration);
  const std::uint32_t warm_up = warm_up_of(options, range.first);
  if (plan.kind == TargetKind::film) {
    write_film(plain_name(to_path(options.output)),
               {plan.renderer.size_px, plan.rate, common.threads, warm_up}, range.first, range.last,
               common.outputs,
               [&](std::uint32_t i) { return std::get<image::Image8>(draw(plan.rate.time_of(i), i)); });
    return;
  }
  const auto part = part_of(range, plan.shard);
  if (!part) return;
  // Frames that depend on those before are drawn from the first of the whole on, whatever the shard.
  const std::uint32_t before = frames_depend(options) ? part->first - range.first : 0;
  write_sequence({to_path(options.output), part->first, part->last, warm_up + before,
                  sequence_key(options, film.files, film.device, range), frames_depend(options),
                  options.resume, plan.shard.count > 1},
                 common.outputs, [&](std::uint32_t i) { return draw(plan.rate.time_of(i), i); });
}

}  // namespace brume::cli
