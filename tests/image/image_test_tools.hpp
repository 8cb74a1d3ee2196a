// Helpers of the image tests.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <random>
#include <string>

#include "image/image.hpp"

namespace brume::image {

/// A temporary folder, removed with its contents.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / ("brume_" + name + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }
  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(path_), std::filesystem::directory_iterator()));
  }

 private:
  std::filesystem::path path_;
};

inline Image8 random_image(std::uint32_t width, std::uint32_t height, bool opaque, unsigned seed) {
  std::mt19937 random(seed);
  Image8 image{width, height, {}};
  image.rgba.resize(std::size_t{width} * height * 4);
  for (auto& value : image.rgba) value = static_cast<std::uint8_t>(random());
  if (opaque) {
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  }
  return image;
}

}  // namespace brume::image
