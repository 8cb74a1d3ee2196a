// A small level for window tests, and image comparisons.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "image/png.hpp"
#include "tests/cli/run_program.hpp"
#include "tests/viewer/desktop.hpp"

namespace brume::viewer {

/// Writes a room with a door and a light into a folder, and room.toml with a camera in it and these events.
inline void write_room(const cli::WorkFolder& folder, const std::string& events = "") {
  std::filesystem::create_directory(folder.path() / "Meshes");
  const auto box = [](glm::vec3 low, glm::vec3 high, bool inward) {
    std::string text;
    for (int i = 0; i < 8; ++i) {
      const glm::vec3 p = glm::mix(low, high, glm::vec3(i & 1, i >> 1 & 1, i >> 2 & 1));
      text += "v " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "\n";
    }
    const std::array<const char*, 6> faces{"1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"};
    for (const std::string face : faces) {
      std::string turned = face;
      if (inward) std::reverse(turned.begin(), turned.end());
      text += "f " + turned + "\n";
    }
    return text;
  };
  folder.write("Meshes/Room.obj", box(glm::vec3(-4, 0, -4), glm::vec3(4, 3, 4), true));
  folder.write("Meshes/Door.obj", box(glm::vec3(-4, 0.01f, -1.1f), glm::vec3(1, 2.9f, -0.9f), false));
  folder.write("Meshes/Block.obj", box(glm::vec3(1.5f, 0.01f, -2.5f), glm::vec3(2.5f, 1, -1.5f), false));
  std::filesystem::create_directory(folder.path() / "Textures");
  const auto paint = [&](const char* material, glm::u8vec3 colour) {
    image::Image8 texture;
    texture.width = texture.height = 1;
    texture.rgba = {colour.r, colour.g, colour.b, 255};
    const std::string name = std::string("Textures/") + material + "_diffuse.png";
    image::save_png(folder.path() / name, texture).value_or_throw();
  };
  paint("walls", {200, 190, 180});
  paint("wood", {150, 90, 50});
  paint("stone", {70, 90, 140});
  folder.write("room.txt",
               "Room 0 0 0  0 0 0  1 1 1  walls\nDoor 0 0 0  0 0 0  1 1 1  wood\n"
               "Block 0 0 0  0 0 0  1 1 1  stone\nLIGHT_SOURCE 1 2.6 1  1 0.9 0.8  60\n");
  folder.write(
      "room.toml",
      std::string("version = 1\nscene = \"room.txt\"\nduration = 3.0\n[grid]\nvoxel = 0.25\n[smoke]\nvoxels "
                  "= 900\n") +
          "[[camera]]\ntime = 0.0\nposition = [0.5, 1.6, 3.2]\ntarget = [0.2, 1.3, -3.0]\nfov = 70.0\n" +
          events);
}

inline nlohmann::json read_json(const std::filesystem::path& path) {
  std::ifstream file(path);
  return nlohmann::json::parse(file, nullptr, false);
}

/// Mean absolute difference over all channels; 255 if the sizes differ.
inline double mean_difference(const image::Image8& a, const image::Image8& b) {
  if (a.rgba.size() != b.rgba.size() || a.rgba.empty()) return 255;
  double sum = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) sum += std::abs(int{a.rgba[i]} - int{b.rgba[i]});
  return sum / static_cast<double>(a.rgba.size());
}

/// Maximum absolute difference of a channel.
inline int largest_difference(const image::Image8& a, const image::Image8& b) {
  if (a.rgba.size() != b.rgba.size() || a.rgba.empty()) return 255;
  int largest = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i)
    largest = std::max(largest, std::abs(int{a.rgba[i]} - int{b.rgba[i]}));
  return largest;
}

/// Number of distinct colours.
inline std::size_t count_colours(const image::Image8& image) {
  std::set<std::uint32_t> colours;
  for (std::size_t i = 0; i + 3 < image.rgba.size(); i += 4)
    colours.insert(image.rgba[i] | image.rgba[i + 1] << 8u | image.rgba[i + 2] << 16u);
  return colours.size();
}

}  // namespace brume::viewer
