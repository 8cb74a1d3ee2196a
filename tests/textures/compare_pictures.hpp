// A picture of `brume render` beside that of another renderer, over the same surfaces.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <glm/gtc/packing.hpp>
#include <map>
#include <string>
#include <vector>

#include "core/file.hpp"
#include "image/exr.hpp"
#include "image/png.hpp"
#include "shared/tone.h"

namespace brume::textures {

/// The layers of an image as floats, by name.
class Layers {
 public:
  explicit Layers(const image::LayeredImage& image) {
    for (const image::Layer& layer : image.layers) {
      std::vector<float>& to = values_[layer.name];
      if (const auto* const floats = std::get_if<std::vector<float>>(&layer.values)) to = *floats;
      if (const auto* const halves = std::get_if<std::vector<std::uint16_t>>(&layer.values))
        for (const std::uint16_t half : *halves) to.push_back(glm::unpackHalf1x16(half));
    }
  }
  /// What `brume render` makes of a timeline at a time.
  static Layers rendered(const std::string& timeline, double seconds, int width, int height,
                         const std::filesystem::path& folder) {
    const std::string exr = (folder / "rendered.exr").string();
    const std::string command = std::string(BRUME_PROGRAM) + " render -q '" + timeline + "' -o '" + exr +
                                "' --size " + std::to_string(width) + "x" + std::to_string(height) +
                                " --time " + std::to_string(seconds);
    if (std::system(command.c_str()) != 0) throw std::runtime_error(command + " failed");
    const auto bytes = read_file(exr);
    if (!bytes) throw std::runtime_error(bytes.failure().message);
    const auto image = image::decode_exr(*bytes, exr);
    if (!image) throw std::runtime_error(image.failure().message);
    return Layers(*image);
  }
  float at(const std::string& name, std::size_t i) const { return values_.at(name)[i]; }
  glm::vec3 color(const std::string& start, std::size_t i) const {
    return {at(start + "R", i), at(start + "G", i), at(start + "B", i)};
  }

 private:
  std::map<std::string, std::vector<float>> values_;
};

/// The sums of differences of displayed colours, and the pictures.
class Comparison {
 public:
  Comparison(float exposure, int width, int height) : exposure_(exposure), width_(width), height_(height) {}
  /// Pixel `i` of the render, and of another renderer the smoke's radiance and in w what it lets through:
  /// both over the surfaces of the render.
  void add(const Layers& layers, std::size_t i, glm::vec4 smoke) {
    const float passed = layers.at("transmittance.V", i);
    const glm::vec3 whole = layers.color("", i) + layers.color("background.", i);
    const glm::vec3 surface = passed > 1e-3f ? (whole - layers.color("media.", i)) / passed : glm::vec3(0);
    add(whole, glm::vec3(smoke) + smoke.w * surface, passed < 0.99f);
    passed_apart_ += std::abs(double{passed - smoke.w});
    opposite_ += std::min(passed, smoke.w) < 0.02f && std::max(passed, smoke.w) > 0.98f;
  }
  double mean() const { return all_ / pixels(); }
  double smoky_mean() const { return smoky_ / std::max(smoky_count_, 1.0); }
  double smoky_part() const { return smoky_count_ / pixels(); }
  /// Mean difference of what the smoke lets through.
  double passed_apart() const { return passed_apart_ / pixels(); }
  /// The part of the pixels where one has opaque smoke and the other none.
  double opposite_part() const { return opposite_ / pixels(); }
  /// The render, the other picture, and their difference, four times as strong.
  void save(const std::string& path) const {
    image::Image8 image{static_cast<std::uint32_t>(3 * width_), static_cast<std::uint32_t>(height_), {}};
    for (std::size_t y = 0; y < static_cast<std::size_t>(height_); ++y)
      for (const std::vector<glm::vec3>& picture : pictures_)
        for (std::size_t x = 0; x < static_cast<std::size_t>(width_); ++x) {
          const glm::vec3 color =
              glm::clamp(picture[x + static_cast<std::size_t>(width_) * y] + 0.5f, 0.0f, 255.0f);
          for (int c = 0; c < 3; ++c) image.rgba.push_back(static_cast<std::uint8_t>(color[c]));
          image.rgba.push_back(255);
        }
    const auto saved = image::save_png(path, image);
    EXPECT_TRUE(saved);
  }

 private:
  double pixels() const { return double{1} * width_ * height_; }
  void add(glm::vec3 expected, glm::vec3 found, bool smoky) {
    const glm::vec3 a = display(expected), b = display(found), apart = glm::abs(a - b);
    const double mean = double{apart.x + apart.y + apart.z} / 3;
    all_ += mean;
    if (smoky) smoky_ += mean, ++smoky_count_;
    for (const glm::vec3 color : {a, b, 127.5f + 4.0f * (b - a)}) pictures_[number_++ % 3].push_back(color);
  }
  glm::vec3 display(glm::vec3 radiance) const {
    return 255.0f * shared::srgb_from_linear(shared::neutral_tone(exposure_ * radiance));
  }

  float exposure_;
  int width_, height_;
  double passed_apart_ = 0, opposite_ = 0, all_ = 0, smoky_ = 0, smoky_count_ = 0;
  std::size_t number_ = 0;
  std::array<std::vector<glm::vec3>, 3> pictures_;
};

}  // namespace brume::textures
