#include "trace/triangle_bvh.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/box.hpp"
#include "core/error.hpp"
#include "core/float4.hpp"

namespace brume::trace {
namespace {

/// Boxes of a node, and triangles of a leaf.
constexpr std::uint32_t kLanes = 4;
constexpr std::uint32_t kBins = 16;
/// From this depth on halves have as many triangles, so that the tree of any triangles has a limited depth.
constexpr std::uint32_t kMostUnevenDepth = 40;
constexpr std::size_t kMostDepth = kMostUnevenDepth + 32;
constexpr float kNever = std::numeric_limits<float>::infinity();

using Triangle = TriangleBvh::Triangle;
using Points = std::array<Float4, 3>;  // x, y, z

Box<float> bounds_of(const Triangle& t) {
  return {glm::min(t[0], glm::min(t[1], t[2])), glm::max(t[0], glm::max(t[1], t[2]))};
}

/// Half of the surface's area.
float half_area(const Box<float>& box) {
  if (box.empty()) return 0;
  const glm::vec3 size = box.high - box.low;
  return size.x * size.y + size.y * size.z + size.z * size.x;
}

int widest_axis(const glm::vec3& size) {
  const int axis = size.y > size.x ? 1 : 0;
  return size.z > size[axis] ? 2 : axis;
}

/// What a ray finds of the triangles of a leaf.
struct PacketHits {
  Float4 t, v, w;     ///< v and w: barycentric coordinates.
  std::uint32_t met;  ///< Bit i: triangle i is met.
};

/// a * b - c * d, with the sign of the exact result. Rounded products are in the order of the exact ones, or
/// equal; where they are equal, those in double precision decide, which are exact.
Float4 difference(const Float4& a, const Float4& b, const Float4& c, const Float4& d) {
  Float4 result = a * b - c * d;
  if (const std::uint32_t zeros = bits_of(result == 0.0f)) [[unlikely]]
    for (int i = 0; i < 4; ++i)
      if (zeros >> i & 1)
        result[i] = static_cast<float>(double{a[i]} * double{b[i]} - double{c[i]} * double{d[i]});
  return result;
}

/// A ray for watertight tests: Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection". Its largest
/// axis is z; x and y are sheared so that it runs along z. Both triangles at an edge decide alike.
class ShearedRay {
 public:
  ShearedRay(const glm::vec3& origin, const glm::vec3& direction) : z_(widest_axis(glm::abs(direction))) {
    x_ = (z_ + 1) % 3;
    y_ = (z_ + 2) % 3;
    origin_ = {origin[x_], origin[y_], origin[z_]};
    shear_ = {direction[x_] / direction[z_], direction[y_] / direction[z_], 1 / direction[z_]};
  }

  PacketHits meet(const std::array<Points, 3>& corners) const {
    const Points a = sheared(corners[0]), b = sheared(corners[1]), c = sheared(corners[2]);
    const Float4 u = difference(c[0], b[1], c[1], b[0]), v = difference(a[0], c[1], a[1], c[0]),
                 w = difference(b[0], a[1], b[1], a[0]);
    const Float4 sum = u + v + w;
    const Int4 inside = ((u >= 0.0f) & (v >= 0.0f) & (w >= 0.0f)) | ((u <= 0.0f) & (v <= 0.0f) & (w <= 0.0f));
    const Float4 part_v = v / sum, part_w = w / sum;
    return {u / sum * a[2] + part_v * b[2] + part_w * c[2], part_v, part_w, bits_of(inside & (sum != 0.0f))};
  }

 private:
  Points sheared(const Points& corners) const {
    const auto of = [&](int axis) { return corners[static_cast<std::size_t>(axis)]; };
    const Float4 along = of(z_) - origin_.z;
    return {of(x_) - origin_.x - shear_.x * along, of(y_) - origin_.y - shear_.y * along, shear_.z * along};
  }

  int z_, x_ = 0, y_ = 0;
  glm::vec3 origin_{0}, shear_{0};
};

/// A ray for boxes.
class BoxRay {
 public:
  BoxRay(const glm::vec3& origin, const glm::vec3& direction) : origin_(origin) {
    for (int axis = 0; axis < 3; ++axis)
      inverse_[axis] =
          std::abs(direction[axis]) > 1e-30f ? 1 / direction[axis] : std::copysign(1e30f, direction[axis]);
  }

  /// Where it enters each box before `end`; kNever where it does not, nor those whose bounds are exchanged.
  Float4 enters(const Points& low, const Points& high, float end) const {
    // Ize 2013, "Robust BVH Ray Traversal": three roundings on either side.
    constexpr float kRounding = 1 + 6 * std::numeric_limits<float>::epsilon();
    Float4 from{}, to = splat(kNever);
    for (std::size_t i = 0; i < 3; ++i) {
      const float at = origin_[static_cast<int>(i)], inverse = inverse_[static_cast<int>(i)];
      const Float4 near = ((inverse < 0 ? high : low)[i] - at) * inverse,
                   far = ((inverse < 0 ? low : high)[i] - at) * inverse;
      from = max4(near, from);
      to = min4(far, to);
    }
    to *= kRounding;
    return ((from <= to) & (from <= end)) ? from : splat(kNever);
  }

 private:
  glm::vec3 origin_, inverse_{0};
};

}  // namespace

/// Up to four triangles; lanes without one repeat the first.
struct TriangleBvh::Packet {
  std::array<Points, 3> corners{};
  std::array<std::uint32_t, kLanes> numbers{};
  std::uint32_t used = 0;  ///< Bit i: lane i has a triangle.
};

/// Up to four boxes, and what is in them; bounds of lanes without one are exchanged.
struct TriangleBvh::Node {
  Points low, high;
  /// A packet if `is_leaf`, else a node.
  std::array<std::uint32_t, kLanes> child{};
  std::array<bool, kLanes> is_leaf{};

  Node() {
    low.fill(splat(kNever));
    high.fill(splat(-kNever));
  }
};

/// Splits triangles where the surface area heuristic, in bins of their middles, expects the least work of
/// rays.
class TriangleBvh::Builder {
 public:
  Builder(TriangleBvh& tree, std::span<const Triangle> triangles)
      : tree_(tree), triangles_(triangles), order_(triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    bounds_.reserve(triangles.size());
    for (const Triangle& triangle : triangles) bounds_.push_back(bounds_of(triangle));
  }

  void build() {
    struct Open {
      std::uint32_t node;
      Range range;
    };
    tree_.nodes_.emplace_back();
    std::vector<Open> open{{0, range_of(0, static_cast<std::uint32_t>(order_.size()), 0)}};
    while (!open.empty()) {
      const Open next = open.back();
      open.pop_back();
      const std::vector<Range> parts = parts_of(next.range);
      for (std::size_t lane = 0; lane < parts.size(); ++lane) {
        const Range& part = parts[lane];
        const bool is_leaf = part.count() <= kLanes;
        const auto child = static_cast<std::uint32_t>(is_leaf ? tree_.packets_.size() : tree_.nodes_.size());
        set_lane(tree_.nodes_[next.node], lane, part, child, is_leaf);
        if (is_leaf) {
          tree_.packets_.push_back(packet_of(part));
        } else {
          tree_.nodes_.emplace_back();
          open.push_back({child, part});
        }
      }
    }
  }

 private:
  /// The triangles order_[begin .. end).
  struct Range {
    std::uint32_t begin, end, depth;
    Box<float> bounds;

    std::uint32_t count() const { return end - begin; }
  };
  struct Bin {
    Box<float> bounds = kEmptyBox;
    std::uint32_t count = 0;
  };

  Range range_of(std::uint32_t begin, std::uint32_t end, std::uint32_t depth) const {
    Range range{begin, end, depth, kEmptyBox};
    for (std::uint32_t i = begin; i < end; ++i) range.bounds = united(range.bounds, bounds_[order_[i]]);
    return range;
  }

  static void set_lane(Node& node, std::size_t lane, const Range& range, std::uint32_t child, bool is_leaf) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      node.low[axis][lane] = range.bounds.low[static_cast<int>(axis)];
      node.high[axis][lane] = range.bounds.high[static_cast<int>(axis)];
    }
    node.child[lane] = child;
    node.is_leaf[lane] = is_leaf;
  }

  Packet packet_of(const Range& range) const {
    Packet packet;
    packet.used = (1u << range.count()) - 1;
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
      const std::uint32_t number = order_[range.begin + (lane < range.count() ? lane : 0)];
      packet.numbers[lane] = number;
      for (std::size_t corner = 0; corner < 3; ++corner)
        for (std::size_t axis = 0; axis < 3; ++axis)
          packet.corners[corner][axis][lane] = triangles_[number][corner][static_cast<int>(axis)];
    }
    return packet;
  }

  /// Up to four parts of a range, split where the largest one is.
  std::vector<Range> parts_of(const Range& range) {
    std::vector<Range> parts{range};
    while (parts.size() < kLanes) {
      const auto area = [](const Range& part) {
        return part.count() <= kLanes ? -1 : half_area(part.bounds);
      };
      const auto largest = std::ranges::max_element(parts, {}, area);
      if (largest->count() <= kLanes) break;
      const Range whole = *largest;
      const std::uint32_t middle = split(whole);
      *largest = range_of(whole.begin, middle, whole.depth + 1);
      parts.push_back(range_of(middle, whole.end, whole.depth + 1));
    }
    return parts;
  }

  glm::vec3 middle_of(std::uint32_t triangle) const {
    return 0.5f * bounds_[triangle].low + 0.5f * bounds_[triangle].high;
  }

  /// Sorts the triangles into two halves, neither empty: where the second one begins.
  std::uint32_t split(const Range& range) {
    Box<float> middles = kEmptyBox;
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
      const glm::vec3 middle = middle_of(order_[i]);
      middles = united(middles, {middle, middle});
    }
    const glm::vec3 size = middles.high - middles.low;
    const int axis = widest_axis(size);
    if (range.depth >= kMostUnevenDepth || !(size[axis] > 0)) return halve(range, axis);
    const std::uint32_t middle = split_by_area(range, axis, middles);
    return middle == range.begin || middle == range.end ? halve(range, axis) : middle;
  }

  /// As many triangles on both sides.
  std::uint32_t halve(const Range& range, int axis) {
    const std::uint32_t middle = range.begin + range.count() / 2;
    const auto first = order_.begin();
    std::nth_element(first + range.begin, first + middle, first + range.end,
                     [&](std::uint32_t a, std::uint32_t b) {
                       const float at_a = middle_of(a)[axis], at_b = middle_of(b)[axis];
                       return at_a != at_b ? at_a < at_b : a < b;
                     });
    return middle;
  }

  std::uint32_t split_by_area(const Range& range, int axis, const Box<float>& middles) {
    const float low = middles.low[axis], size = middles.high[axis] - low;
    const auto bin_of = [&](std::uint32_t triangle) {
      const float at = (middle_of(triangle)[axis] - low) / size * float{kBins};
      return std::min(static_cast<std::uint32_t>(std::max(at, 0.0f)), kBins - 1);
    };
    std::array<Bin, kBins> bins;
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
      Bin& bin = bins[bin_of(order_[i])];
      bin.bounds = united(bin.bounds, bounds_[order_[i]]);
      ++bin.count;
    }
    // The work of those before each bin, then of those from it on.
    std::array<float, kBins> work{};
    Bin side;
    for (std::uint32_t i = 1; i < kBins; ++i) {
      side = {united(side.bounds, bins[i - 1].bounds), side.count + bins[i - 1].count};
      work[i] = half_area(side.bounds) * static_cast<float>(side.count);
    }
    side = {};
    for (std::uint32_t i = kBins - 1; i > 0; --i) {
      side = {united(side.bounds, bins[i].bounds), side.count + bins[i].count};
      work[i] += half_area(side.bounds) * static_cast<float>(side.count);
    }
    const auto best =
        static_cast<std::uint32_t>(std::ranges::min_element(work.begin() + 1, work.end()) - work.begin());
    const auto first = order_.begin();
    const auto middle = std::partition(first + range.begin, first + range.end,
                                       [&](std::uint32_t triangle) { return bin_of(triangle) < best; });
    return static_cast<std::uint32_t>(middle - first);
  }

  TriangleBvh& tree_;
  std::span<const Triangle> triangles_;
  std::vector<std::uint32_t> order_;
  std::vector<Box<float>> bounds_;
};

TriangleBvh::TriangleBvh() = default;
TriangleBvh::~TriangleBvh() = default;
TriangleBvh::TriangleBvh(TriangleBvh&&) noexcept = default;
TriangleBvh& TriangleBvh::operator=(TriangleBvh&&) noexcept = default;

TriangleBvh::TriangleBvh(std::span<const Triangle> triangles) {
  BRUME_ASSERT(triangles.size() <= std::size_t{1} << 30, std::to_string(triangles.size()));
  if (!triangles.empty()) Builder(*this, triangles).build();
}

std::optional<TriangleBvh::Hit> TriangleBvh::nearest(const glm::vec3& origin, const glm::vec3& direction,
                                                     float end, const Accepts& accepts) const {
  struct Entered {
    float t;
    std::uint32_t child;
    bool is_leaf;
  };
  const BoxRay ray(origin, direction);
  const ShearedRay sheared(origin, direction);
  std::array<Entered, kMostDepth*(kLanes - 1) + kLanes> open;
  std::size_t count = 0;
  std::optional<Hit> best;
  if (!nodes_.empty()) open[count++] = {0, 0, false};
  while (count > 0) {
    const Entered entered = open[--count];
    if (entered.t > end) continue;
    if (entered.is_leaf) {
      const Packet& packet = packets_[entered.child];
      const PacketHits hits = sheared.meet(packet.corners);
      for (std::uint32_t met = hits.met & packet.used; met != 0; met &= met - 1) {
        const int i = std::countr_zero(met);
        if (!(hits.t[i] > 0 && hits.t[i] <= end)) continue;
        const Hit hit{hits.t[i], {hits.v[i], hits.w[i]}, packet.numbers[static_cast<std::size_t>(i)]};
        if (!accepts(hit)) continue;
        best = hit;
        end = hit.t;
      }
      continue;
    }
    const Node& node = nodes_[entered.child];
    const Float4 enters = ray.enters(node.low, node.high, end);
    // The nearest one last, which comes next.
    const std::size_t first = count;
    for (std::uint32_t met = bits_of(enters < kNever); met != 0; met &= met - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(met));
      const float t = enters[i];
      std::size_t at = count++;
      for (; at > first && open[at - 1].t < t; --at) open[at] = open[at - 1];
      open[at] = {t, node.child[i], node.is_leaf[i]};
    }
  }
  return best;
}

}  // namespace brume::trace
