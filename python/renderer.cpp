// Pictures: the class Renderer of the module.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>

#include "film/playback.hpp"
#include "gpu/context.hpp"
#include "image/background.hpp"
#include "image/png.hpp"
#include "python/scenario.hpp"
#include "render/volume_room.hpp"
#include "scene/files/load.hpp"
#include "scene/options.hpp"
#include "scene/text_reader.hpp"

namespace brume::python {
namespace {

/// Frames of a scenario on a device, as brume render draws them.
class Renderer {
 public:
  Renderer(std::shared_ptr<Loaded> loaded, const render::RendererOptions& options, const std::string& device)
      : loaded_(std::move(loaded)), options_(options), context_({device, false}) {
    const std::lock_guard lock(loaded_->drawing);
    scenario::Scenario& scenario = loaded_->scenario;
    if (scenario.volumes) scenario.volumes->limit(render::volume_room(context_)).value_or_throw();
    playback_.emplace(context_, scenario, options_);
  }

  bool is_linear() const { return options_.smoke.record_entries; }
  glm::uvec2 size() const { return options_.size_px; }
  double duration() const { return double{loaded_->scenario.timeline.duration}; }
  const std::string& device() const { return context_.info().name; }

  image::Image8 draw(double seconds, const std::optional<scene::Camera>& camera,
                     std::optional<std::uint32_t> samples) {
    const std::lock_guard lock(loaded_->drawing);
    prepare(camera, samples);
    return playback_->draw(seconds, 0);
  }
  image::LayeredImage draw_layers(double seconds, const std::optional<scene::Camera>& camera,
                                  std::optional<std::uint32_t> samples) {
    const std::lock_guard lock(loaded_->drawing);
    prepare(camera, samples);
    image::LayeredImage image = playback_->draw_layers(seconds, 0);
    image::set_background(image, image::Background::in);
    return image;
  }

 private:
  void prepare(const std::optional<scene::Camera>& camera, std::optional<std::uint32_t> samples) {
    if (camera)
      playback_->set_camera(*camera);
    else
      playback_->set_camera(scenario::CameraAt());
    playback_->set_samples(samples);
    if (loaded_->scenario.measure_exposure && !(measured_ && same(*measured_, camera))) {
      playback_->measure_exposure();
      measured_ = camera;
    }
  }
  static bool same(const std::optional<scene::Camera>& a, const std::optional<scene::Camera>& b) {
    if (!a || !b) return !a && !b;
    return a->position_world == b->position_world && a->target_world == b->target_world &&
           a->vertical_fov == b->vertical_fov;
  }

  std::shared_ptr<Loaded> loaded_;
  render::RendererOptions options_;
  gpu::Context context_;
  std::optional<film::Playback> playback_;
  /// The camera that the exposure was measured for, as brume render does for its --camera; none: not yet.
  std::optional<std::optional<scene::Camera>> measured_;
};

std::shared_ptr<Renderer> make_renderer(const Scenario& scenario, std::pair<std::int64_t, std::int64_t> size,
                                        const std::string& march, bool linear, const std::string& device) {
  const auto fits = [](std::int64_t pixels) { return pixels > 0 && pixels <= image::kMaxAxis; };
  if (!fits(size.first) || !fits(size.second))
    refuse("size", "expected (width, height), each 1 to " + std::to_string(image::kMaxAxis) + " pixels");
  if (march != "full" && march != "half" && march != "quarter")
    refuse("march", "expected 'full', 'half' or 'quarter', got '" + march + "'");
  render::RendererOptions options;
  options.size_px = glm::uvec2(size.first, size.second);
  options.smoke.march_scale = march == "full" ? 1 : march == "half" ? 2 : 4;
  options.smoke.record_entries = linear;
  return released([&] { return std::make_shared<Renderer>(scenario.loaded(), options, device); });
}

py::array colours(const image::Image8& image) {
  py::array_t<std::uint8_t> result({image.height, image.width, 3u});
  std::uint8_t* out = result.mutable_data();
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) out = std::copy_n(&image.rgba[i], 3, out);
  return result;
}

/// R, G, B of the layers.
py::array radiance(const image::LayeredImage& image) {
  py::array result(py::dtype("float16"), std::vector<std::size_t>{image.height, image.width, 3});
  auto* const out = static_cast<std::uint16_t*>(result.mutable_data());
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const std::string name(1, "RGB"[channel]);
    const auto layer = std::ranges::find(image.layers, name, &image::Layer::name);
    const auto& halves = std::get<std::vector<std::uint16_t>>(layer->values);
    for (std::size_t i = 0; i < halves.size(); ++i) out[3 * i + channel] = halves[i];
  }
  return result.attr("astype")("float32").cast<py::array>();
}

py::array draw_picture(Renderer& renderer, std::optional<double> time, const py::object& camera,
                       std::optional<std::int64_t> samples) {
  const double seconds = time.value_or(renderer.duration());
  if (!(seconds >= 0 && seconds <= scene::kLatestTime))
    refuse("time", "expected 0 to 3600 s, got " + scene::shown(seconds));
  if (samples && !(*samples >= 1 && *samples <= std::int64_t{scene::kMostSamples}))
    refuse("samples", "expected 1 to 2^24");
  const std::optional<scene::Camera> from = camera_of(camera);
  const auto count = samples ? std::optional(static_cast<std::uint32_t>(*samples)) : std::nullopt;
  py::array result;
  if (renderer.is_linear())
    result = radiance(released([&] { return renderer.draw_layers(seconds, from, count); }));
  else
    result = colours(released([&] { return renderer.draw(seconds, from, count); }));
  stop_if_interrupted();
  return result;
}

void save_picture(const std::filesystem::path& path, const py::array& picture) {
  if (picture.dtype().kind() != 'u' || picture.dtype().itemsize() != 1)
    throw py::type_error("picture: expected an array of uint8");
  if (picture.ndim() != 3 || (picture.shape(2) != 3 && picture.shape(2) != 4))
    refuse("picture",
           "expected the shape (height, width, 3) or (height, width, 4), got " + shape_text(picture));
  if (scene::lower_extension(path) != ".png") refuse("path", path.string() + ": expected the suffix .png");
  for (int axis = 0; axis < 2; ++axis)
    if (picture.shape(axis) < 1 || picture.shape(axis) > py::ssize_t{image::kMaxAxis})
      refuse("picture", "expected 1 to " + std::to_string(image::kMaxAxis) + " pixels along each axis");
  const auto values = py::array_t<std::uint8_t, py::array::c_style>::ensure(picture);
  const auto channels = static_cast<std::size_t>(picture.shape(2));
  image::Image8 image{
      static_cast<std::uint32_t>(picture.shape(1)), static_cast<std::uint32_t>(picture.shape(0)), {}};
  image.rgba.assign(std::size_t{4} * image.width * image.height, 255);
  for (std::size_t i = 0; i < image.rgba.size() / 4; ++i)
    std::copy_n(values.data() + i * channels, channels, &image.rgba[4 * i]);
  released([&] { of_file(image::save_png(path, image), path, FileUse::write); });
}

}  // namespace

std::optional<scene::Camera> camera_of(const py::object& value) {
  if (value.is_none()) return {};
  if (!py::isinstance<py::sequence>(value) || py::isinstance<py::str>(value))
    throw py::type_error("camera: expected (position, target) or (position, target, degrees)");
  const auto parts = value.cast<py::sequence>();
  if (parts.size() != 2 && parts.size() != 3)
    refuse("camera", "expected (position, target) or (position, target, degrees)");
  const glm::vec3 position(vector_of("camera", parts[0])), target(vector_of("camera", parts[1]));
  const double degrees = parts.size() == 3 ? parts[2].cast<double>() : 60;
  if (!(degrees > 0 && degrees < 180)) refuse("camera", "expected an angle in (0, 180) degrees");
  if (position == target) refuse("camera", "expected two distinct points");
  for (const glm::vec3 p : {position, target})
    for (int axis = 0; axis < 3; ++axis)
      if (double{std::abs(p[axis])} > scene::kFarthestPoint) refuse("camera", "is farther than 1,000,000 m");
  return scene::Camera{position, target, static_cast<float>(degrees * std::numbers::pi / 180)};
}

void bind_renderer(py::module_& module) {
  using namespace py::literals;
  py::class_<Renderer, std::shared_ptr<Renderer>>(
      module, "Renderer",
      "Draws pictures of a Scenario on a Vulkan device, as brume render does. Loads the scene onto it once.")
      .def(py::init(&make_renderer), "scenario"_a, py::kw_only(), "size"_a = std::pair(1280, 720),
           "march"_a = "full", "linear"_a = false, "device"_a = "",
           R"(size: (width, height) of the pictures [px], each 1 to 16384.
march: rays through the smoke: "full" (one per pixel), "half" (per 2 x 2) or "quarter" (per 4 x 4).
linear: radiance before exposure and tone curve, instead of colours.
device: number or part of the name of a Vulkan device, as brume devices lists them; default: the fastest.

Raises RuntimeError without a device, MemoryError where it has too little memory, ValueError.)")
      .def("draw", &draw_picture, "time"_a = py::none(), py::kw_only(), "camera"_a = py::none(),
           "samples"_a = py::none(),
           R"(The picture at a time, whatever was drawn before.

time: [s], 0 to 3600; default: the end of the timeline.
camera: (position, target) or (position, target, degrees): where it is, a point in the middle of the picture
    [m], and the vertical angle of view, 60 by default. Default: the timeline's.
samples: frames that a picture is the mean of, for an aperture or a shutter; default: 64 with one, else 1.

Returns an array of the shape (height, width, 3), rows from the top: uint8 as in the .png of brume render, or
float32 where the renderer is linear. Ctrl-C takes effect after the picture.)")
      .def_property_readonly("device", &Renderer::device, "Name of its Vulkan device.");
  module.def("save_png", &save_picture, "path"_a, "picture"_a,
             R"(Writes a picture as a .png file, completely or not at all.

picture: uint8, shape (height, width, 3) or, with alpha, (height, width, 4); sRGB, rows from the top.

Raises OSError where it cannot be written, TypeError and ValueError for another array or suffix.)");
}

}  // namespace brume::python
