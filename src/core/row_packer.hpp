// Rectangles side by side in rows of an atlas.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

namespace brume {

/// Each row is as high as its highest rectangle, so that rectangles in falling order of their heights waste
/// the least.
class RowPacker {
 public:
  /// `size`: of the atlas.
  explicit RowPacker(glm::uvec2 size) : size_(size) {}

  /// The low corner of the next rectangle: beside the last one, or where a new row begins. Nothing where it
  /// does not fit; the packer is then of no further use.
  std::optional<glm::uvec2> place(glm::uvec2 rectangle) {
    if (rectangle.x > size_.x) return std::nullopt;
    if (rectangle.x > size_.x - at_.x) {
      at_ = {0, height()};
      row_height_ = 0;
    }
    if (rectangle.y > size_.y - at_.y) return std::nullopt;
    const glm::uvec2 low = at_;
    at_.x += rectangle.x;
    row_height_ = std::max(row_height_, rectangle.y);
    return low;
  }
  /// The height of all rows.
  std::uint32_t height() const { return at_.y + row_height_; }

 private:
  glm::uvec2 size_, at_{0};
  std::uint32_t row_height_ = 0;
};

}  // namespace brume
