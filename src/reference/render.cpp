#include "reference/render.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/tasks.hpp"
#include "planning/device_camera.hpp"
#include "scenario/lens.hpp"
#include "surfaces/motion.hpp"

namespace brume::reference {
namespace {

using surfaces::at_time;

constexpr std::uint32_t kTileEdge = 16;
/// Tiles are judged after 2^n samples, from here on: earlier, the error itself is too uncertain.
constexpr std::uint32_t kFirstJudged = 16;

double luminance(const glm::dvec3& c) {
  return glm::dot(c, glm::dvec3(0.2126, 0.7152, 0.0722));
}

/// Between two eyes, for rays alone.
Eye mixed(const Eye& a, const Eye& b, float f) {
  Eye eye;
  eye.camera.eye_world = glm::mix(a.camera.eye_world, b.camera.eye_world, f);
  eye.camera.forward = glm::mix(a.camera.forward, b.camera.forward, f);
  eye.camera.right = glm::mix(a.camera.right, b.camera.right, f);
  eye.camera.up = glm::mix(a.camera.up, b.camera.up, f);
  eye.aperture = glm::mix(a.aperture, b.aperture, f);
  eye.focus = glm::mix(a.focus, b.focus, f);
  return eye;
}

}  // namespace

Eye make_eye(const scene::Camera& camera, glm::uvec2 size_px) {
  return {planning::device_camera(camera, size_px), camera.lens.aperture, scene::focus_distance(camera)};
}

Render::Render(const Scene& scene, const RenderSettings& settings)
    : Render([&scene, limits = settings.limits](
                 const Ray& ray, Sampler& sampler) { return trace_path(scene, ray, limits, sampler); },
             settings) {}

Render::Render(Trace trace, const RenderSettings& settings) : trace_(std::move(trace)), settings_(settings) {
  const glm::uvec2 size = settings.size_px;
  if (std::uint64_t{size.x} * size.y > kMostPixels)
    throw Error(ErrorCode::resource_limit,
                "the reference renderer makes at most 2^26 pixels; choose a smaller size");
  sums_.resize(std::size_t{size.x} * size.y);
  for (std::uint32_t y = 0; y < size.y; y += kTileEdge)
    for (std::uint32_t x = 0; x < size.x; x += kTileEdge)
      tiles_.push_back({{x, y}, glm::min(glm::uvec2(x, y) + kTileEdge, size)});
}

Ray Render::eye_ray(glm::uvec2 pixel, Sampler& sampler) const {
  const glm::vec2 at = (glm::vec2(pixel) + sampler.next_2d()) / glm::vec2(settings_.size_px) * 2.0f - 1.0f;
  Ray ray;
  if (settings_.eyes.size() > 1) ray.time = sampler.next_1d();
  const Eye eye = at_time(std::span<const Eye>(settings_.eyes), ray.time, mixed);
  const shared::Camera& camera = eye.camera;
  const glm::vec3 through = camera.forward + at.x * camera.right - at.y * camera.up;
  ray.origin = camera.eye_world;
  ray.direction = glm::normalize(through);
  if (!(eye.aperture > 0)) return ray;
  // All rays of a point that is sharp meet there.
  const glm::vec2 on_lens =
      eye.aperture * scenario::point_on_lens(settings_.blades, settings_.opening, sampler.next_2d());
  ray.origin += on_lens.x * glm::normalize(camera.right) + on_lens.y * glm::normalize(camera.up);
  ray.direction = glm::normalize(camera.eye_world + eye.focus * through - ray.origin);
  return ray;
}

void Render::sample(Tile& tile, const std::function<bool()>& stopped) {
  // As the sums were, should the tile not be completed.
  std::array<Sums, std::size_t{kTileEdge} * kTileEdge> before;
  const std::uint32_t width = tile.end.x - tile.low.x;
  const auto each_row = [&](const auto& copy) {
    for (std::uint32_t y = tile.low.y; y < tile.end.y; ++y)
      copy(sums_.begin() + static_cast<std::ptrdiff_t>(index(tile.low.x, y)),
           before.begin() + std::ptrdiff_t{kTileEdge} * (y - tile.low.y));
  };
  each_row([&](auto sums, auto kept) { std::copy_n(sums, width, kept); });
  try {
    add_paths(tile, stopped);
  } catch (const Sampler::Stopped&) {
    each_row([&](auto sums, auto kept) { std::copy_n(kept, width, sums); });
    return;
  }
  ++tile.samples;
  finish(tile);
}

/// A path through each pixel of a tile.
void Render::add_paths(const Tile& tile, const std::function<bool()>& stopped) {
  for (std::uint32_t y = tile.low.y; y < tile.end.y; ++y)
    for (std::uint32_t x = tile.low.x; x < tile.end.x; ++x) {
      Sampler sampler({x, y}, tile.samples);
      sampler.stop_by(&stopped);
      const Ray ray = eye_ray({x, y}, sampler);
      const PathSample found = trace_(ray, sampler);

      // Radiance, by how often it was scattered.
      Sums& sums = sums_[index(x, y)];
      sums.seen += found.seen;
      sums.single += found.single;
      sums.multiple += found.multiple;
      const double all =
          luminance(glm::dvec3(found.seen) + glm::dvec3(found.single) + glm::dvec3(found.multiple));
      sums.squares += all * all;

      // The nearest surface, and what lies before it.
      sums.albedo += found.albedo;
      sums.normal += found.normal;
      const bool hit = std::isfinite(found.distance);
      if (hit) sums.depth += found.distance * glm::dot(ray.direction, settings_.eyes.front().camera.forward);
      sums.hits += hit ? 1.0f : 0.0f;
      if (!hit && found.through_media) {
        sums.clear += 1;
        sums.background += found.seen;
      }
      sums.passed += found.through_media ? 1.0f : 0.0f;
    }
}

void Render::finish(Tile& tile) const {
  if (settings_.samples > 0 && tile.samples >= settings_.samples) tile.done = true;
  if (settings_.noise > 0 && tile.samples >= kFirstJudged && std::has_single_bit(tile.samples) &&
      error_of(tile) <= double{settings_.noise})
    tile.done = true;
}

double Render::error_of(const Tile& tile) const {
  if (tile.samples < 2) return std::numeric_limits<double>::infinity();
  const double n = tile.samples;
  double variance = 0, mean = 0, pixels = 0;
  for (std::uint32_t y = tile.low.y; y < tile.end.y; ++y)
    for (std::uint32_t x = tile.low.x; x < tile.end.x; ++x) {
      const Sums& sums = sums_[index(x, y)];
      const double of_pixel = luminance(sums.seen + sums.single + sums.multiple) / n;
      variance += std::max(sums.squares / n - of_pixel * of_pixel, 0.0) / (n - 1);
      mean += of_pixel;
      ++pixels;
    }
  return mean > 0 ? std::sqrt(variance / pixels) / (mean / pixels) : 0;
}

bool Render::advance(double seconds, const std::function<bool()>& stopped) {
  const auto start = std::chrono::steady_clock::now();
  const auto is_late = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() >= seconds;
  };
  do {
    std::vector<Tile*> open;
    for (Tile& tile : tiles_)
      if (!tile.done) open.push_back(&tile);
    if (open.empty()) return true;
    // Tiles with fewer samples first: a stop may have left some.
    const auto least = std::ranges::min(open, {}, &Tile::samples)->samples;
    std::erase_if(open, [&](const Tile* tile) { return tile->samples > least; });
    parallel_for(open.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end && !stopped(); ++i) sample(*open[i], stopped);
    });
  } while (!is_late() && !stopped());
  return std::ranges::all_of(tiles_, &Tile::done);
}

double Render::without_samples() const {
  double pixels = 0;
  for (const Tile& tile : tiles_)
    if (tile.samples == 0) pixels += (tile.end.x - tile.low.x) * (tile.end.y - tile.low.y);
  return pixels / static_cast<double>(std::max<std::size_t>(sums_.size(), 1));
}

double Render::samples() const {
  double sum = 0;
  for (const Tile& tile : tiles_) sum += tile.samples;
  return tiles_.empty() ? 0 : sum / static_cast<double>(tiles_.size());
}

double Render::error() const {
  double largest = 0;
  for (const Tile& tile : tiles_) largest = std::max(largest, error_of(tile));
  return largest;
}

template <typename Visit>
void Render::for_each_pixel(const Visit& visit) const {
  for (const Tile& tile : tiles_)
    for (std::uint32_t y = tile.low.y; y < tile.end.y; ++y)
      for (std::uint32_t x = tile.low.x; x < tile.end.x; ++x)
        visit(index(x, y), sums_[index(x, y)], tile.samples);
}

std::vector<glm::vec4> Render::radiance() const {
  std::vector<glm::vec4> pixels(sums_.size());
  for_each_pixel([&](std::size_t i, const Sums& sums, std::uint32_t samples) {
    const glm::dvec3 sum = sums.seen + sums.single + sums.multiple;
    pixels[i] = glm::vec4(glm::dvec4(sum / std::max(1.0, static_cast<double>(samples)), 1));
  });
  return pixels;
}

image::LayeredImage Render::layers() const {
  image::LayeredImage image{settings_.size_px.x, settings_.size_px.y, {}};
  const auto add = [&](const std::string& name, const auto& value) {
    std::vector<float> values(sums_.size());
    for_each_pixel([&](std::size_t i, const Sums& sums, std::uint32_t samples) {
      values[i] = static_cast<float>(value(sums, std::max(1.0, static_cast<double>(samples))));
    });
    image.layers.push_back({name, std::move(values)});
  };
  const auto add_three = [&](const std::array<std::string, 3>& names, const auto& value) {
    for (int c = 0; c < 3; ++c)
      add(names[static_cast<std::size_t>(c)],
          [&](const Sums& sums, double n) { return glm::dvec3(value(sums))[c] / n; });
  };

  // What is before the sky and the sky, its parts, the surface, and how sure the mean is.
  add_three({"R", "G", "B"},
            [](const Sums& sums) { return sums.seen - sums.background + sums.single + sums.multiple; });
  add_three({"background.R", "background.G", "background.B"},
            [](const Sums& sums) { return sums.background; });
  add_three({"single.R", "single.G", "single.B"}, [](const Sums& sums) { return sums.single; });
  add_three({"multiple.R", "multiple.G", "multiple.B"}, [](const Sums& sums) { return sums.multiple; });
  add_three({"albedo.R", "albedo.G", "albedo.B"}, [](const Sums& sums) { return sums.albedo; });
  add_three({"normal.X", "normal.Y", "normal.Z"}, [](const Sums& sums) { return sums.normal; });
  add("A", [](const Sums& sums, double n) { return 1 - double{sums.clear} / n; });
  add("transmittance.V", [](const Sums& sums, double n) { return double{sums.passed} / n; });
  add("Z", [](const Sums& sums, double) {
    return sums.hits > 0 ? double{sums.depth} / double{sums.hits} : std::numeric_limits<double>::infinity();
  });
  add("error.V", [](const Sums& sums, double n) {
    const double mean = luminance(sums.seen + sums.single + sums.multiple) / n;
    return n < 2 ? std::numeric_limits<double>::infinity()
                 : std::sqrt(std::max(sums.squares / n - mean * mean, 0.0) / (n - 1));
  });
  add("samples.V", [](const Sums&, double n) { return n; });
  return image;
}

}  // namespace brume::reference
