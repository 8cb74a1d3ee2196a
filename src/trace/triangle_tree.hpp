// Triangles as Embree traces them.
#pragma once

#include <embree3/rtcore.h>

#include <atomic>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "trace/embree_scene.hpp"

namespace brume::trace {

/// Triangles of one geometry. The callback and its data must outlive the tree.
struct TriangleMesh {
  std::span<const glm::vec3> corners;
  std::span<const std::uint32_t> indices;  ///< Three for each triangle, below corners.size().
  RTCFilterFunctionN filter = nullptr;     ///< Rejects hits; null: none.
  void* filter_data = nullptr;
  /// Where the corners are at further times, in equal steps up to 1, of rays' [0, 1]; empty: they rest.
  std::vector<std::span<const glm::vec3>> moved = {};
};

/// Without gaps between triangles, and the same whatever the number of threads.
class TriangleTree {
 public:
  /// Builds the tree, once; mesh i has the geometry id i. `job` begins the messages of failures. Fails with
  /// resource_limit without enough memory, no_device on processors that Embree does not support, and internal
  /// when `stopped` becomes true.
  Result<void> build(const std::string& job, std::span<const TriangleMesh> meshes,
                     const std::atomic<bool>* stopped = nullptr);

  RTCScene scene() const { return scene_.get(); }
  /// The first error since the start, of any thread.
  Result<void> check() const { return scene_.check(); }

 private:
  Result<void> add(const TriangleMesh& mesh);

  EmbreeScene scene_;
};

}  // namespace brume::trace
