#include "host/volumes.hpp"

#include <cmath>
#include <string>

#include "api/ranges.hpp"
#include "core/utf8.hpp"
#include "host/frame.hpp"
#include "planning/volume_inputs.hpp"

using namespace brume::api;

namespace brume::host {
namespace {

/// Device memory of a brick of a volume: half floats.
constexpr std::uint64_t kBrickBytes = 2 * std::uint64_t{shared::kTexelsPerBrick};

std::string text_or_empty(const char* given) {
  return given ? given : "";
}

scene::VolumeOptions to_options(const brume_volume_params& params) {
  scene::VolumeOptions options;
  options.file = to_path(text_or_empty(&required(params.file, "file")));
  require(!options.file.empty(), "`file` is empty");
  require(params.no_processes == 0 || options.file.extension() == ".brv",
          "`file` must be a .brv file where `no_processes` is 1; brume convert makes one");
  options.density = text_or_empty(params.density);
  options.heat = text_or_empty(params.heat);
  options.color = text_or_empty(params.color);
  options.frame_rate = params.frame_rate;
  scene::visit_volume_options(options, RangeCheck("`"));
  require(params.repeat <= BRUME_REPEAT_CLIP, "`repeat` must be a brume_repeat");
  options.loop = params.repeat == BRUME_REPEAT_LOOP;
  options.ping_pong = params.repeat == BRUME_REPEAT_PING_PONG;
  options.clip = params.repeat == BRUME_REPEAT_CLIP;
  return options;
}

std::shared_ptr<VolumeData> load(const brume_volume_params& params) {
  auto data = std::make_shared<VolumeData>();
  data->options = to_options(params);
  data->wait = params.wait_for_frame != 0 ? volumes::VolumeWait::until_loaded : volumes::VolumeWait::never;
  data->volumes = loaded(volumes::Volumes::load(std::span(&data->options, 1), grids::load_volume_file));
  if (params.max_bytes > 0) {
    volumes::VolumeRoom room;
    room.bricks = std::min(room.bricks, params.max_bytes / kBrickBytes);
    loaded(data->volumes->limit(room));
  }
  data->volumes->make_previews();
  return data;
}

void place(const brume_shown_volume& shown, const std::string& name, scene::VolumeOptions& options) {
  options.position_world = position(shown.position, (name + ".position").c_str());
  const glm::vec3 x = vec3_of(shown.x_axis), y = vec3_of(shown.y_axis), z = vec3_of(shown.z_axis);
  if (!spans_space(glm::dvec3(x), glm::dvec3(y), glm::dvec3(z)))
    refuse(name + " must have finite axes that span space");
  options.x_axis = x;
  options.y_axis = y;
  options.z_axis = z;
}

void set_look(const brume_shown_volume& shown, const std::string& name, scene::VolumeOptions& options) {
  options.extinction = shown.extinction;
  options.albedo = vec3_of(shown.albedo);
  options.anisotropy = shown.anisotropy;
  options.multiple_scattering = shown.multiple_scattering;
  options.emission = shown.emission;
  options.kelvin = shown.kelvin;
  const std::string start = name + ": `";
  scene::visit_volume_options(options, RangeCheck(start.c_str()));
  if (!(std::abs(shown.seconds) <= 1e6)) refuse(name + ": `seconds` must be within 10^6");
}

}  // namespace

ShownVolumes add_volumes(Call& call, const brume_frame_params& params, planning::FrameInput& input) {
  require(params.volume_count <= shared::kMaxVolumes, "at most 32 volumes");
  if (params.volume_count > 0) required(params.volumes, "volumes");
  std::vector<scene::VolumeOptions> options;
  for (std::size_t i = 0; i < params.volume_count; ++i) {
    const std::string name = "volume " + std::to_string(i);
    options.push_back(call.handle(params.volumes[i].volume).data->options);
    set_look(params.volumes[i], name, options.back());
    // Its axes may be of other lengths than a timeline's, so that they come after the check of those.
    place(params.volumes[i], name, options.back());
  }
  ShownVolumes shown;
  for (std::size_t i = 0; i < options.size(); ++i) {
    VolumeData& data = *params.volumes[i].volume->data;
    const double seconds = params.volumes[i].seconds;
    const std::scoped_lock lock(data.mutex);
    shown.push_back(data.volumes->at(std::span(&options[i], 1), seconds, data.wait).front());
    if (shown.back().frame)
      planning::add_volume(options[i], shown.back(), data.volumes->typical_frame(0), seconds, input);
  }
  planning::sort_glow(input);
  return shown;
}

}  // namespace brume::host

extern "C" {

brume_result brume_volume_create(brume_context* context, const brume_volume_params* params,
                                 brume_volume** volume) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_context& owner = call.handle(context);
    required(volume, "volume");
    create(volume, owner.settings, brume::host::load(required_params(params)));
  });
}

brume_result brume_volume_destroy(brume_volume* volume) BRUME_NOEXCEPT {
  return destroy(__func__, volume);
}

brume_result brume_volume_describe(const brume_volume* volume, brume_volume_info* info) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    brume::host::VolumeData& data = *call.handle(volume).data;
    required(info, "info");
    const std::scoped_lock lock(data.mutex);
    const brume::volumes::VolumeFrame& first = data.volumes->typical_frame(0);
    const auto point = [](const glm::vec3& p) { return brume_point{p.x, p.y, p.z}; };
    *info = {point(first.bounds.low),
             point(first.bounds.high),
             first.density.high,
             first.heat ? 1u : 0u,
             first.z_is_up ? 1u : 0u,
             first.is_extinction ? 1u : 0u,
             static_cast<std::uint32_t>(first.density.level)};
  });
}

}  // extern "C"
