#include "voxel/obj_export.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <string>

#include "core/file.hpp"

namespace brume::voxel {
namespace {

using glm::ivec3;

constexpr std::size_t kWriteBytes = 1 << 20;

struct Face {
  int plane, h, w;  // The face's low corner along the axis, the height and the width.
  auto operator<=>(const Face&) const = default;  // NOLINT(modernize-use-nullptr): there is no pointer
};

// The faces of one direction along one axis, sorted by plane, row and position in the row.
std::vector<Face> faces_towards(const BitGrid& grid, int axis, bool positive) {
  ivec3 towards(0);
  towards[axis] = positive ? 1 : -1;
  std::vector<Face> faces;
  grid.for_each_brick([&](ivec3 at, const BitGrid::Brick& brick) {
    for (int z = 0; z < kBrickSize; ++z) {
      for (std::uint64_t word = brick[static_cast<unsigned>(z)]; word != 0; word &= word - 1) {
        const int bit = std::countr_zero(word);
        const ivec3 v = at * kBrickSize + ivec3(bit & 7, bit >> 3, z);
        if (!grid.solid(v + towards))
          faces.push_back({v[axis] + (positive ? 1 : 0), v[(axis + 2) % 3], v[(axis + 1) % 3]});
      }
    }
  });
  std::sort(faces.begin(), faces.end());
  return faces;
}

// Merges faces into runs along the width, and runs of equal position and length into rectangles.
void merge_faces(const std::vector<Face>& faces, int axis, bool positive, std::vector<FaceRectangle>& out) {
  // Faces into runs.
  struct Run {
    int plane, w, width, h;
    auto operator<=>(const Run&) const = default;  // NOLINT(modernize-use-nullptr): there is no pointer
  };
  std::vector<Run> runs;
  for (const Face& f : faces) {
    if (!runs.empty()) {
      Run& last = runs.back();
      if (last.plane == f.plane && last.h == f.h && last.w + last.width == f.w) {
        ++last.width;
        continue;
      }
    }
    runs.push_back({f.plane, f.w, 1, f.h});
  }

  // Runs into rectangles.
  std::sort(runs.begin(), runs.end());
  const std::size_t first = out.size();
  for (const Run& run : runs) {
    ivec3 low;
    low[axis] = run.plane;
    low[(axis + 1) % 3] = run.w;
    low[(axis + 2) % 3] = run.h;
    if (out.size() > first) {
      FaceRectangle& last = out.back();
      ivec3 next = last.low;
      next[(axis + 2) % 3] += last.height;
      if (last.width == run.width && next == low) {
        ++last.height;
        continue;
      }
    }
    out.push_back({axis, positive, low, run.width, 1});
  }
}

// Corners, counter-clockwise seen from the free side.
std::array<ivec3, 4> corners_of(const FaceRectangle& r) {
  ivec3 along_w(0), along_h(0);
  along_w[(r.axis + 1) % 3] = r.width;
  along_h[(r.axis + 2) % 3] = r.height;
  if (!r.positive) std::swap(along_w, along_h);
  return {r.low, r.low + along_w, r.low + along_w + along_h, r.low + along_h};
}

std::uint64_t packed(ivec3 corner) {
  const glm::u64vec3 c(corner);
  return c.x | c.y << 16 | c.z << 32;
}

// Buffers lines of text for the file.
class Writer {
 public:
  explicit Writer(AtomicFile& file) : file_(file) {}

  void word(const char* text) { buffer_ += text; }
  template <typename Number>
  void number(Number value) {
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    buffer_ += ' ';
    buffer_.append(digits.data(), end);
  }
  Result<void> end_line() {
    buffer_ += '\n';
    return buffer_.size() < kWriteBytes ? Result<void>() : flush();
  }
  Result<void> flush() {
    auto written = file_.write(std::as_bytes(std::span(buffer_)));
    buffer_.clear();
    return written;
  }

 private:
  AtomicFile& file_;
  std::string buffer_;
};

Result<void> write_lines(Writer& writer, const GridLayout& layout, const std::vector<std::uint64_t>& corners,
                         const std::vector<FaceRectangle>& rectangles) {
  writer.word("# Surface of the solid voxels: quads, metres, Y up");
  if (auto written = writer.end_line(); !written) return written;
  for (const std::uint64_t corner : corners) {
    const glm::dvec3 at(corner & 0xffff, corner >> 16 & 0xffff, corner >> 32);
    const glm::dvec3 world = at * double{layout.voxel_size} + glm::dvec3(layout.origin_world);
    writer.word("v");
    for (int axis = 0; axis < 3; ++axis) writer.number(static_cast<float>(world[axis]));
    if (auto written = writer.end_line(); !written) return written;
  }
  for (const FaceRectangle& r : rectangles) {
    writer.word("f");
    for (const ivec3& corner : corners_of(r))
      writer.number(std::lower_bound(corners.begin(), corners.end(), packed(corner)) - corners.begin() + 1);
    if (auto written = writer.end_line(); !written) return written;
  }
  return writer.flush();
}

}  // namespace

std::vector<FaceRectangle> surface_rectangles(const BitGrid& grid) {
  std::vector<FaceRectangle> rectangles;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool positive : {false, true})
      merge_faces(faces_towards(grid, axis, positive), axis, positive, rectangles);
  return rectangles;
}

Result<ObjCounts> export_obj(const BitGrid& grid, const std::filesystem::path& path) {
  auto file = AtomicFile::open(path);
  if (!file) return file.failure();
  const std::vector<FaceRectangle> rectangles = surface_rectangles(grid);
  ObjCounts counts;
  std::vector<std::uint64_t> corners;
  corners.reserve(4 * rectangles.size());
  for (const FaceRectangle& r : rectangles) {
    for (const ivec3& corner : corners_of(r)) corners.push_back(packed(corner));
    counts.faces += static_cast<std::uint64_t>(r.width) * static_cast<std::uint64_t>(r.height);
  }
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  counts.vertices = corners.size();
  counts.quads = rectangles.size();

  Writer writer(*file);
  if (auto written = write_lines(writer, grid.layout(), corners, rectangles); !written)
    return written.failure();
  if (auto committed = file->commit(); !committed) return committed.failure();
  return counts;
}

}  // namespace brume::voxel
