#include <nanovdb/NanoVDB.h>
#include <nanovdb/util/GridChecksum.h>
#include <nanovdb/util/GridStats.h>
#include <nanovdb/util/IO.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <sstream>

#include "apps/vdb/formats.hpp"
#include "apps/vdb/nvdb.hpp"
#include "grids/bytes.hpp"
#include "grids/metadata.hpp"

namespace brume::vdb {
namespace {

using glm::ivec3;
using grids::Brick;
using grids::Grid;
using grids::GridClass;
using grids::kBrickVoxels;
using grids::Tile;
using grids::Value;
using grids::ValueType;
using Bytes = std::vector<std::byte>;
using Handle = nanovdb::GridHandle<nanovdb::HostBuffer>;

constexpr std::size_t align_up(std::size_t size) {
  return (size + NANOVDB_DATA_ALIGNMENT - 1) / NANOVDB_DATA_ALIGNMENT * NANOVDB_DATA_ALIGNMENT;
}

ivec3 align_down(ivec3 at, int edge) {
  return at & ~(edge - 1);
}

// The order of nodes in a file: by the entry in the root, then in each node, all from z to x.
bool goes_before_in_tree(ivec3 a, ivec3 b) {
  for (const int edge : {kUpperEdge, kLowerEdge, kLeafEdge})
    for (int axis = 0; axis < 3; ++axis) {
      const int first = a[axis] & ~(edge - 1), second = b[axis] & ~(edge - 1);
      if (first != second) return first < second;
    }
  return false;
}

// The nodes of an edge that hold these, in order.
std::vector<ivec3> nodes_around(std::vector<ivec3> origins, int edge) {
  for (ivec3& origin : origins) origin = align_down(origin, edge);
  std::sort(origins.begin(), origins.end(), goes_before_in_tree);
  origins.erase(std::unique(origins.begin(), origins.end()), origins.end());
  return origins;
}

std::size_t number_of(const std::vector<ivec3>& nodes, ivec3 origin) {
  return static_cast<std::size_t>(std::lower_bound(nodes.begin(), nodes.end(), origin, goes_before_in_tree) -
                                  nodes.begin());
}

std::vector<ivec3> tile_origins(const Grid& grid, int edge) {
  std::vector<ivec3> origins;
  for (const Tile& tile : grid.tiles)
    if (tile.edge == static_cast<std::uint32_t>(edge)) origins.push_back(tile.origin);
  return origins;
}

template <typename T>
T from_bytes(const std::byte* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

// NanoVDB restricts classes to types; the class itself is in the extra data.
nanovdb::GridClass to_class(const Grid& grid) {
  const bool is_real = grid.type == ValueType::float32 || grid.type == ValueType::float64;
  const bool is_vector = grid.type == ValueType::vec3f || grid.type == ValueType::vec3d;
  if (grid.type == ValueType::mask) return nanovdb::GridClass::Topology;
  if (grid.grid_class == GridClass::level_set && is_real) return nanovdb::GridClass::LevelSet;
  if (grid.grid_class == GridClass::fog_volume && is_real) return nanovdb::GridClass::FogVolume;
  if (grid.grid_class == GridClass::staggered && is_vector) return nanovdb::GridClass::Staggered;
  return nanovdb::GridClass::Unknown;
}

Bytes extra_data(const Grid& grid, const std::vector<grids::Metadata>& of_file) {
  grids::ByteWriter out;
  out.number(static_cast<std::uint8_t>(grid.grid_class));
  out.number(static_cast<std::uint8_t>(grid.saved_as_half ? 1 : 0));
  grids::write_metadata(out, grid.metadata);
  grids::write_metadata(out, of_file);
  return out.bytes();
}

/// Lays a grid out as NanoVDB has it in memory and in files:
///
///   GridData, TreeData, root, entries of the root, upper nodes, lower nodes, leaves, blind data
template <typename Build>
class TreeWriter {
  using Root = typename Nodes<Build>::Root;
  using RootTile = typename Nodes<Build>::RootTile;
  using Upper = typename Nodes<Build>::Upper;
  using Lower = typename Nodes<Build>::Lower;
  using Leaf = typename Nodes<Build>::Leaf;
  using T = typename Upper::ValueT;
  static constexpr bool kMask = std::is_same_v<Build, nanovdb::ValueMask>;

 public:
  TreeWriter(const Grid& grid, nanovdb::GridType type, const std::vector<grids::Metadata>& of_file)
      : grid_(grid), type_(type), extra_(extra_data(grid, of_file)) {}

  Handle write() {
    lay_out();
    fill_head();
    fill_tree();
    fill_leaves();
    fill_blind_data();
    auto& whole = *at<nanovdb::NanoGrid<Build>>(0);
    nanovdb::gridStats(whole, nanovdb::StatsMode::All);
    place_empty_nodes();
    nanovdb::updateChecksum(whole, nanovdb::ChecksumMode::Full);
    return std::move(handle_);
  }

 private:
  template <typename Node>
  Node* at(std::size_t offset) {
    return reinterpret_cast<Node*>(handle_.data() + offset);
  }
  Root* root() { return at<Root>(root_at_); }
  Upper* upper(std::size_t i) { return at<Upper>(upper_at_) + i; }
  Lower* lower(std::size_t i) { return at<Lower>(lower_at_) + i; }
  Leaf* leaf(std::size_t i) { return at<Leaf>(leaf_at_) + i; }

  void lay_out() {
    std::vector<ivec3> small = tile_origins(grid_, kLeafEdge), middle = tile_origins(grid_, kLowerEdge);
    for (const Brick& brick : grid_.bricks) leaves_.push_back(brick.origin);
    small.insert(small.end(), leaves_.begin(), leaves_.end());
    std::sort(leaves_.begin(), leaves_.end(), goes_before_in_tree);
    lowers_ = nodes_around(small, kLowerEdge);
    middle.insert(middle.end(), lowers_.begin(), lowers_.end());
    uppers_ = nodes_around(middle, kUpperEdge);
    roots_ = tile_origins(grid_, kUpperEdge);
    roots_.insert(roots_.end(), uppers_.begin(), uppers_.end());
    std::sort(roots_.begin(), roots_.end(), goes_before_in_tree);

    long_name_ = grid_.name.size() >= nanovdb::GridData::MaxNameSize;
    root_at_ = sizeof(nanovdb::GridData) + sizeof(nanovdb::TreeData<>);
    upper_at_ = root_at_ + sizeof(Root) + roots_.size() * sizeof(RootTile);
    lower_at_ = upper_at_ + uppers_.size() * sizeof(Upper);
    leaf_at_ = lower_at_ + lowers_.size() * sizeof(Lower);
    blind_at_ = leaf_at_ + leaves_.size() * sizeof(Leaf);
    const std::size_t size = blind_at_ + blind_count() * sizeof(nanovdb::GridBlindMetaData) +
                             align_up(extra_.size()) + (long_name_ ? align_up(grid_.name.size() + 1) : 0);
    handle_ = Handle(nanovdb::HostBuffer::create(size));
    std::memset(handle_.data(), 0, size);
  }

  std::uint32_t blind_count() const { return long_name_ ? 2 : 1; }

  void fill_head() {
    auto& head = *at<nanovdb::GridData>(0);
    head.mMagic = NANOVDB_MAGIC_NUMBER;
    head.mVersion = nanovdb::Version();
    head.setFlagsOff();
    head.setBreadthFirstOn();
    head.setLongGridNameOn(long_name_);
    head.mGridCount = 1;
    head.mGridSize = handle_.size();
    std::memcpy(head.mGridName, grid_.name.data(),
                std::min<std::size_t>(grid_.name.size(), sizeof head.mGridName - 1));
    const glm::dmat4 &m = grid_.world_from_index, inverse = glm::inverse(m);
    head.mMap.set(m, inverse, 1.0);
    head.mWorldBBox = nanovdb::BBox<nanovdb::Vec3R>();
    for (int i = 0; i < 3; ++i) head.mVoxelSize[i] = glm::length(glm::dvec3(m[i]));
    head.mGridClass = to_class(grid_);
    head.mGridType = type_;
    head.mBlindMetadataOffset = static_cast<std::int64_t>(blind_at_);
    head.mBlindMetadataCount = blind_count();
  }

  T background() const {
    if constexpr (kMask)
      return false;
    else
      return from_bytes<T>(grid_.background.data());
  }
  T to_value(const Tile& tile) const {
    if constexpr (kMask)
      return tile.active;
    else
      return from_bytes<T>(tile.value.data());
  }

  // A node whose entries are the background.
  template <typename Node>
  void clear(Node* node, ivec3 origin) {
    node->mBBox[0] = node->mBBox[1] = nanovdb::Coord(origin.x, origin.y, origin.z);
    for (auto& entry : node->mTable) entry.value = background();
  }

  void fill_tree() {
    // Where the nodes are.
    auto& tree = *at<nanovdb::TreeData<>>(sizeof(nanovdb::GridData));
    tree.setRoot(root());
    tree.mNodeOffset[2] = uppers_.empty() ? 0 : upper_at_ - sizeof(nanovdb::GridData);
    tree.mNodeOffset[1] = lowers_.empty() ? 0 : lower_at_ - sizeof(nanovdb::GridData);
    tree.mNodeOffset[0] = leaves_.empty() ? 0 : leaf_at_ - sizeof(nanovdb::GridData);
    const std::array counts{leaves_.size(), lowers_.size(), uppers_.size()};
    for (std::size_t i = 0; i < 3; ++i) tree.mNodeCount[i] = static_cast<std::uint32_t>(counts[i]);
    for (const Tile& tile : grid_.tiles)
      if (tile.active) ++tree.mTileCount[tile.edge == kLeafEdge ? 0 : tile.edge == kLowerEdge ? 1 : 2];
    tree.mVoxelCount = count_active(grid_);

    // Nodes, from the root.
    root()->mBBox = nanovdb::CoordBBox();
    root()->mBackground = root()->mMinimum = root()->mMaximum = background();
    root()->mTableSize = static_cast<std::uint32_t>(roots_.size());
    for (std::size_t i = 0; i < uppers_.size(); ++i) {
      const ivec3 o = uppers_[i];
      clear(upper(i), o);
      root()->tile(root_number(o))->setChild(nanovdb::Coord(o.x, o.y, o.z), upper_node(i), root());
    }
    for (std::size_t i = 0; i < lowers_.size(); ++i) {
      clear(lower(i), lowers_[i]);
      Upper* parent = upper(number_of(uppers_, align_down(lowers_[i], kUpperEdge)));
      const std::uint32_t n = upper_entry(lowers_[i]);
      parent->mChildMask.setOn(n);
      parent->setChild(n, lower(i));
    }
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
      Lower* parent = lower(number_of(lowers_, align_down(leaves_[i], kLowerEdge)));
      const std::uint32_t n = lower_entry(leaves_[i]);
      parent->mChildMask.setOn(n);
      parent->setChild(n, leaf(i));
    }
    for (const Tile& tile : grid_.tiles) fill_tile(tile);
  }

  std::uint32_t root_number(ivec3 origin) const {
    return static_cast<std::uint32_t>(number_of(roots_, origin));
  }
  const nanovdb::NanoUpper<Build>* upper_node(std::size_t i) {
    return reinterpret_cast<const nanovdb::NanoUpper<Build>*>(upper(i));
  }
  static std::uint32_t upper_entry(ivec3 origin) {
    return entry_number((origin & (kUpperEdge - 1)) / kLowerEdge, kUpperBits);
  }
  static std::uint32_t lower_entry(ivec3 origin) {
    return entry_number((origin & (kLowerEdge - 1)) / kLeafEdge, kLowerBits);
  }

  void fill_tile(const Tile& tile) {
    if (tile.edge == kUpperEdge) {
      const nanovdb::Coord at(tile.origin.x, tile.origin.y, tile.origin.z);
      return root()->tile(root_number(tile.origin))->setValue(at, tile.active, to_value(tile));
    }
    if (tile.edge == kLowerEdge) {
      Upper* node = upper(number_of(uppers_, align_down(tile.origin, kUpperEdge)));
      const std::uint32_t n = upper_entry(tile.origin);
      node->setValue(n, to_value(tile));
      node->mValueMask.set(n, tile.active);
    } else {
      Lower* node = lower(number_of(lowers_, align_down(tile.origin, kLowerEdge)));
      const std::uint32_t n = lower_entry(tile.origin);
      node->setValue(n, to_value(tile));
      node->mValueMask.set(n, tile.active);
    }
  }

  void fill_leaves() {
    const std::size_t brick_bytes = kBrickVoxels * grids::bytes_of(grid_.type);
    for (std::size_t i = 0; i < grid_.bricks.size(); ++i) {
      const Brick& brick = grid_.bricks[i];
      const std::byte* values = grid_.values.data() + i * brick_bytes;
      Leaf& to = *leaf(number_of(leaves_, brick.origin));
      to.mBBoxMin = nanovdb::Coord(brick.origin.x, brick.origin.y, brick.origin.z);
      for (std::uint32_t n = 0; n < kBrickVoxels; ++n) {
        const ivec3 at = entry_of(n, kLeafBits);
        const auto voxel = static_cast<std::size_t>(at.x + 8 * (at.y + 8 * at.z));
        to.mValueMask.set(n, brick.is_active(voxel));
        if constexpr (std::is_same_v<Build, bool>)
          to.mValues.set(n, from_bytes<T>(values + voxel));
        else if constexpr (!kMask)
          to.mValues[n] = from_bytes<T>(values + voxel * sizeof(T));
      }
    }
  }

  void fill_blind_data() {
    auto* list = at<nanovdb::GridBlindMetaData>(blind_at_);
    std::size_t next = blind_at_ + blind_count() * sizeof *list;
    const auto put = [&](nanovdb::GridBlindMetaData& meta, const char* name,
                         std::span<const std::byte> data) {
      std::memcpy(handle_.data() + next, data.data(), data.size());
      meta.setBlindData(handle_.data() + next);
      meta.mElementCount = data.size();
      std::strncpy(meta.mName, name, sizeof meta.mName - 1);
      next += align_up(data.size());
    };
    put(list[0], kExtraName, extra_);
    if (!long_name_) return;
    // With its terminator.
    put(list[1], "grid name", std::as_bytes(std::span(grid_.name.c_str(), grid_.name.size() + 1)));
    list[1].mDataClass = nanovdb::GridBlindDataClass::GridName;
  }

  // Statistics give a node without active voxels a box without a place, from which NanoVDB derives its
  // origin.
  void place_empty_nodes() {
    const auto place = [](auto* node, ivec3 origin) {
      if (!node->mBBox.empty()) return;
      node->mBBox[0] = nanovdb::Coord(origin.x, origin.y, origin.z);
      node->mBBox[1] = nanovdb::Coord(origin.x - 1, origin.y - 1, origin.z - 1);
    };
    for (std::size_t i = 0; i < uppers_.size(); ++i) place(upper(i), uppers_[i]);
    for (std::size_t i = 0; i < lowers_.size(); ++i) place(lower(i), lowers_[i]);
  }

  const Grid& grid_;
  nanovdb::GridType type_;
  Bytes extra_;
  bool long_name_ = false;
  /// Origins of the entries of the root, and of nodes, in the order of the file.
  std::vector<ivec3> roots_, uppers_, lowers_, leaves_;
  std::size_t root_at_ = 0, upper_at_ = 0, lower_at_ = 0, leaf_at_ = 0, blind_at_ = 0;
  Handle handle_;
};

template <typename Build>
Handle write_tree(const Grid& grid, nanovdb::GridType type, const std::vector<grids::Metadata>& of_file) {
  return TreeWriter<Build>(grid, type, of_file).write();
}

Handle handle_of(const Grid& grid, const std::vector<grids::Metadata>& of_file) {
  switch (grid.type) {
    case ValueType::float32:
      return write_tree<float>(grid, nanovdb::GridType::Float, of_file);
    case ValueType::float64:
      return write_tree<double>(grid, nanovdb::GridType::Double, of_file);
    case ValueType::int32:
      return write_tree<std::int32_t>(grid, nanovdb::GridType::Int32, of_file);
    case ValueType::int64:
      return write_tree<std::int64_t>(grid, nanovdb::GridType::Int64, of_file);
    case ValueType::boolean:
      return write_tree<bool>(grid, nanovdb::GridType::Boolean, of_file);
    case ValueType::mask:
      return write_tree<nanovdb::ValueMask>(grid, nanovdb::GridType::Mask, of_file);
    case ValueType::vec3f:
      return write_tree<nanovdb::Vec3f>(grid, nanovdb::GridType::Vec3f, of_file);
    case ValueType::vec3d:
      return write_tree<nanovdb::Vec3d>(grid, nanovdb::GridType::Vec3d, of_file);
    case ValueType::vec3i:
      break;
  }
  throw Error(ErrorCode::bad_input, "grid \"" + grid.name + "\": .nvdb files hold no " +
                                        std::string(name_of(grid.type)) + "; write a .vdb file");
}

}  // namespace

void write_nvdb(const grids::GridFile& file, int output) {
  if (file.grids.empty()) throw Error(ErrorCode::bad_input, "a .nvdb file holds at least one grid");
  // A segment for each grid, so that only one is in memory.
  for (std::size_t i = 0; i < file.grids.size(); ++i) {
    const Handle handle = handle_of(file.grids[i], i == 0 ? file.metadata : std::vector<grids::Metadata>());
    nanovdb::io::Segment segment;
    segment.add(handle);
    segment.meta[0].fileSize = handle.size();
    std::ostringstream head;
    segment.write(head);
    const std::string text = head.str();
    write_all(output, std::as_bytes(std::span(text))).value_or_throw();
    write_all(output, std::as_bytes(std::span(handle.data(), handle.size()))).value_or_throw();
  }
}

}  // namespace brume::vdb
