#include "bench/peers/single_scattering.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/tasks.hpp"

namespace brume::peers {
namespace {

/// Optical depths at which a ray ends: 1e-7 of the light remains.
constexpr double kOpaque = 16.2;

/// A ray in the local space of a field; t in metres.
struct Ray {
  glm::dvec3 origin, per_metre;
  glm::dvec3 at(double t) const { return origin + per_metre * t; }
};

Ray ray_in(const DenseField& field, const glm::dvec3& origin_world, const glm::dvec3& direction) {
  const glm::dmat4& matrix = field.local_from_world();
  return {glm::dvec3(matrix * glm::dvec4(origin_world, 1)), glm::dvec3(matrix * glm::dvec4(direction, 0))};
}

struct Span {
  double begin, end;
};

/// The part of a ray in front of its origin and inside the cells.
Span inside(const DenseField& field, const Ray& ray) {
  Span span{0, std::numeric_limits<double>::infinity()};
  for (int axis = 0; axis < 3; ++axis) {
    const double high = field.cells()[axis], origin = ray.origin[axis], along = ray.per_metre[axis];
    if (along == 0) {
      if (origin <= 0 || origin >= high) return {0, 0};
      continue;
    }
    const double a = -origin / along, b = (high - origin) / along;
    span = {std::max(span.begin, std::min(a, b)), std::min(span.end, std::max(a, b))};
  }
  return span;
}

/// Calls visit(cell, begin, end) for the cells along a ray in order, until it returns false (Amanatides and
/// Woo 1987, "A Fast Voxel Traversal Algorithm for Ray Tracing").
template <typename Visit>
void for_each_cell(const DenseField& field, const Ray& ray, Visit&& visit) {
  const Span span = inside(field, ray);
  if (span.begin >= span.end) return;
  const glm::dvec3 p = ray.at(span.begin);
  glm::ivec3 cell, step;
  glm::dvec3 next, apart;
  for (int axis = 0; axis < 3; ++axis) {
    const double along = ray.per_metre[axis];
    cell[axis] = std::clamp(static_cast<int>(std::floor(p[axis])), 0, field.cells()[axis] - 1);
    step[axis] = along > 0 ? 1 : -1;
    apart[axis] = along == 0 ? std::numeric_limits<double>::infinity() : 1 / std::abs(along);
    next[axis] = along == 0 ? std::numeric_limits<double>::infinity()
                            : (cell[axis] + (along > 0 ? 1 : 0) - ray.origin[axis]) / along;
  }
  for (double begin = span.begin; begin < span.end;) {
    const int axis = next.x < next.y ? (next.x < next.z ? 0 : 2) : (next.y < next.z ? 1 : 2);
    const double end = std::min(next[axis], span.end);
    if (end > begin && !visit(cell, begin, end)) return;
    begin = std::max(begin, end);
    cell[axis] += step[axis];
    next[axis] += apart[axis];
    if (cell[axis] < 0 || cell[axis] >= field.cells()[axis]) return;
  }
}

double density_in(const DenseField& field, const Ray& ray, glm::ivec3 cell, double t) {
  return field.in_cell(cell, ray.at(t) - glm::dvec3(cell));
}

/// The integral of the density over a part of a cell: exact for cubics.
double integral_in(const DenseField& field, const Ray& ray, glm::ivec3 cell, double begin, double end) {
  const double middle = 0.5 * (begin + end), away = (end - begin) / std::sqrt(12.0);
  return 0.5 * (end - begin) *
         (density_in(field, ray, cell, middle - away) + density_in(field, ray, cell, middle + away));
}

/// Optical depth of a ray from its origin on.
double depth_along(const DenseField& field, const Ray& ray, double extinction) {
  double depth = 0;
  for_each_cell(field, ray, [&](glm::ivec3 cell, double begin, double end) {
    depth += extinction * integral_in(field, ray, cell, begin, end);
    return depth < 2 * kOpaque;
  });
  return depth;
}

/// Abscissae in [0, 1] and weights that sum to 1.
struct Gauss {
  std::array<double, 4> at, weight;
};
constexpr std::array<Gauss, 4> kGauss{{
    {{0.5}, {1}},
    {{0.21132486540518713, 0.78867513459481287}, {0.5, 0.5}},
    {{0.11270166537925831, 0.5, 0.88729833462074169}, {5.0 / 18, 8.0 / 18, 5.0 / 18}},
    {{0.06943184420297371, 0.33000947820757187, 0.66999052179242813, 0.93056815579702629},
     {0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693}},
}};

class Integrator {
 public:
  Integrator(const DenseField& field, const SingleScattering& scene) : field_(field), scene_(scene) {
    forward_ = glm::normalize(scene.target - scene.eye);
    right_ = glm::normalize(glm::cross(forward_, glm::dvec3(0, 1, 0)));
    up_ = glm::cross(right_, forward_);
    sun_ = ray_in(field, glm::dvec3(0), scene.to_sun);
  }

  /// Calls radiance(ray) for each pixel.
  template <typename Radiance>
  Radiances image(Radiance&& radiance) const {
    Radiances values(std::size_t{scene_.width} * scene_.height);
    parallel_for(scene_.height, 1, [&](std::size_t first, std::size_t end) {
      for (std::size_t y = first; y < end; ++y)
        for (std::size_t x = 0; x < scene_.width; ++x)
          values[y * scene_.width + x] = static_cast<float>(radiance(ray_of(x, y)));
    });
    return values;
  }

  double by_cells(const Ray& ray, const Gauss& gauss, int points) const {
    double depth = 0, sum = 0;
    for_each_cell(field_, ray, [&](glm::ivec3 cell, double begin, double end) {
      for (int i = 0; i < points; ++i) {
        const double t = begin + gauss.at[i] * (end - begin), density = density_in(field_, ray, cell, t);
        if (density <= 0) continue;
        const double before = depth + scene_.extinction * integral_in(field_, ray, cell, begin, t);
        const double to_sun = depth_along(field_, Ray{ray.at(t), sun_.per_metre}, scene_.extinction);
        sum += gauss.weight[i] * (end - begin) * scene_.extinction * density * std::exp(-before - to_sun);
      }
      depth += scene_.extinction * integral_in(field_, ray, cell, begin, end);
      return depth < kOpaque;
    });
    return sum;
  }

  double by_steps(const Ray& ray, double step_m) const {
    double depth = 0, sum = 0;
    const Span span = inside(field_, ray);
    const double length = std::max(0.0, span.end - span.begin), count = std::ceil(length / step_m);
    for (double i = 0; i < count && depth < kOpaque; ++i) {
      const glm::dvec3 p = ray.at(span.begin + (i + 0.5) * length / count);
      const double passed = scene_.extinction * field_.at(p) * length / count;
      // Half of the step's own depth lies before its middle.
      if (passed > 0)
        sum += passed * std::exp(-depth - 0.5 * passed - depth_by_steps({p, sun_.per_metre}, step_m));
      depth += passed;
    }
    return sum;
  }

 private:
  Ray ray_of(std::size_t x, std::size_t y) const {
    const double half = std::tan(0.5 * scene_.fov), high = scene_.height;
    const double across = half * (2 * (static_cast<double>(x) + 0.5) - scene_.width) / high;
    const double upwards = half * (high - 2 * (static_cast<double>(y) + 0.5)) / high;
    return ray_in(field_, scene_.eye, glm::normalize(forward_ + right_ * across + up_ * upwards));
  }

  double depth_by_steps(const Ray& ray, double step_m) const {
    const Span span = inside(field_, ray);
    const double length = std::max(0.0, span.end - span.begin), count = std::ceil(length / step_m);
    double sum = 0;
    for (double i = 0; i < count; ++i) sum += field_.at(ray.at(span.begin + (i + 0.5) * length / count));
    return count > 0 ? scene_.extinction * sum * length / count : 0;
  }

  const DenseField& field_;
  const SingleScattering& scene_;
  glm::dvec3 forward_, right_, up_;
  Ray sun_;
};

}  // namespace

Result<DenseField> DenseField::from(const grids::Grid& grid) {
  const grids::Value zero{};
  if (grid.type != grids::ValueType::float32 || !grid.tiles.empty() || grid.background != zero)
    return Failure{ErrorCode::bad_input,
                   "grid " + grid.name + ": expected float32 without tiles, 0 outside, as brume bake writes"};
  const double determinant = glm::determinant(glm::dmat3(grid.world_from_index));
  if (grid.bricks.empty() || !std::isfinite(determinant) || determinant == 0)
    return Failure{ErrorCode::bad_input, "grid " + grid.name + ": empty, or flat along an axis"};
  glm::ivec3 low(std::numeric_limits<int>::max()), high(std::numeric_limits<int>::min());
  for (const grids::Brick& brick : grid.bricks) {
    low = glm::min(low, brick.origin - 1);
    high = glm::max(high, brick.origin + grids::kBrickEdge);
  }
  const glm::i64vec3 size = glm::i64vec3(high) - glm::i64vec3(low) + std::int64_t{1};
  if (size.x * size.y > (std::int64_t{1} << 31) / size.z)
    return Failure{ErrorCode::resource_limit, "grid " + grid.name + ": too large for a dense array"};

  DenseField field;
  field.samples_ = glm::ivec3(size);
  field.values_.assign(static_cast<std::size_t>(size.x * size.y * size.z), 0);
  for (std::size_t i = 0; i < grid.bricks.size(); ++i) {
    const glm::ivec3 first = grid.bricks[i].origin - low;
    const std::byte* const values = grid.values_of(i).data();
    for (int row = 0; row < grids::kBrickEdge * grids::kBrickEdge; ++row) {
      const std::int64_t y = first.y + row % grids::kBrickEdge, z = first.z + row / grids::kBrickEdge;
      std::memcpy(&field.values_[static_cast<std::size_t>((z * size.y + y) * size.x + first.x)],
                  values + row * grids::kBrickEdge * sizeof(float), grids::kBrickEdge * sizeof(float));
    }
  }
  field.local_from_world_ = glm::inverse(grid.world_from_index);
  field.local_from_world_[3] -= glm::dvec4(low, 0);
  return field;
}

double DenseField::in_cell(glm::ivec3 cell, const glm::dvec3& at) const {
  const std::size_t row = static_cast<std::size_t>(samples_.x),
                    plane = row * static_cast<std::size_t>(samples_.y);
  const float* const v = &values_[static_cast<std::size_t>(cell.z) * plane +
                                  static_cast<std::size_t>(cell.y) * row + static_cast<std::size_t>(cell.x)];
  const auto along_x = [&](const float* p) { return double{p[0]} + at.x * (double{p[1]} - double{p[0]}); };
  const auto in_plane = [&](const float* p) {
    const double a = along_x(p), b = along_x(p + row);
    return a + at.y * (b - a);
  };
  const double a = in_plane(v), b = in_plane(v + plane);
  return a + at.z * (b - a);
}

double DenseField::at(const glm::dvec3& p_local) const {
  if (glm::any(glm::lessThan(p_local, glm::dvec3(0))) ||
      glm::any(glm::greaterThan(p_local, glm::dvec3(cells()))))
    return 0;
  const glm::ivec3 cell = glm::min(glm::ivec3(p_local), cells() - 1);
  return in_cell(cell, p_local - glm::dvec3(cell));
}

Radiances integrate_cells(const DenseField& field, const SingleScattering& scene, int points) {
  BRUME_ASSERT(points >= 1 && points <= 4, std::to_string(points));
  const Gauss& gauss = kGauss[static_cast<std::size_t>(points - 1)];
  const Integrator integrator(field, scene);
  return integrator.image([&](const Ray& ray) { return integrator.by_cells(ray, gauss, points); });
}

Radiances integrate_steps(const DenseField& field, const SingleScattering& scene, double step_m) {
  BRUME_ASSERT(step_m > 0, std::to_string(step_m));
  const Integrator integrator(field, scene);
  return integrator.image([&](const Ray& ray) { return integrator.by_steps(ray, step_m); });
}

}  // namespace brume::peers
