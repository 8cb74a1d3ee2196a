#include <nanovdb/NanoVDB.h>
#include <nanovdb/util/GridChecksum.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "apps/vdb/formats.hpp"
#include "apps/vdb/nvdb.hpp"
#include "apps/vdb/nvdb_file.hpp"
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
using View = std::span<const std::byte>;

Error damaged(const std::string& what) {
  return {ErrorCode::bad_input, "a damaged .nvdb file: " + what};
}

/// The nodes of one level, which lie one behind another. Each is the child of one other node: a file in which
/// nodes share children would unfold without end.
class Level {
 public:
  /// `count` nodes of `stride` bytes from `offset` in the grid.
  Level(View grid, std::uint64_t offset, std::uint64_t count, std::uint64_t stride)
      : offset_(offset), stride_(stride), visited_(in_grid(grid, offset, count, stride) ? count : 0) {
    if (visited_.size() != count) throw damaged("its nodes lie outside of the grid");
  }
  /// Nodes of any length at these offsets, rising.
  explicit Level(std::vector<std::uint64_t> offsets)
      : offsets_(std::move(offsets)), visited_(offsets_.size()) {}

  /// Marks the node at this offset in the grid.
  void visit(std::uint64_t offset) {
    const std::size_t number = number_of(offset);
    if (number >= visited_.size()) throw damaged("a child is no node");
    if (visited_[number]) throw damaged("two nodes share a child");
    visited_[number] = true;
    ++count_;
  }
  bool all_visited() const { return count_ == visited_.size(); }

 private:
  static bool in_grid(View grid, std::uint64_t offset, std::uint64_t count, std::uint64_t stride) {
    return count == 0 || (offset % NANOVDB_DATA_ALIGNMENT == 0 && offset <= grid.size() &&
                          count <= (grid.size() - offset) / stride);
  }
  std::size_t number_of(std::uint64_t offset) const {
    if (offsets_.empty()) {
      if (stride_ == 0 || offset < offset_ || (offset - offset_) % stride_ != 0) return SIZE_MAX;
      return static_cast<std::size_t>((offset - offset_) / stride_);
    }
    const auto found = std::lower_bound(offsets_.begin(), offsets_.end(), offset);
    if (found == offsets_.end() || *found != offset) return SIZE_MAX;
    return static_cast<std::size_t>(found - offsets_.begin());
  }

  std::uint64_t offset_ = 0, stride_ = 0;
  std::vector<std::uint64_t> offsets_;
  std::vector<bool> visited_;
  std::size_t count_ = 0;
};

// Leaves of variable length, one behind another.
std::vector<std::uint64_t> offsets_of_packed_leaves(View grid, std::uint64_t offset, std::uint64_t count) {
  using Leaf = Nodes<nanovdb::FpN>::Leaf;
  constexpr int kMaxLogBits = 4;
  std::vector<std::uint64_t> offsets;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (offset % NANOVDB_DATA_ALIGNMENT != 0 || offset > grid.size() || grid.size() - offset < sizeof(Leaf))
      throw damaged("its nodes lie outside of the grid");
    const auto* leaf = reinterpret_cast<const Leaf*>(grid.data() + offset);
    if (leaf->mFlags >> 5 > kMaxLogBits || leaf->memUsage() > grid.size() - offset)
      throw damaged("a leaf lies outside of the grid");
    offsets.push_back(offset);
    offset += leaf->memUsage();
  }
  return offsets;
}

template <typename T>
Value to_value(const T& from) {
  // As bytes: a boolean of a damaged file may be any number.
  Value value{};
  std::memcpy(value.data(), &from, sizeof from);
  if constexpr (std::is_same_v<T, bool>) value[0] = value[0] == std::byte{0} ? value[0] : std::byte{1};
  return value;
}

/// Reads a tree, after it has checked that every node lies where one may.
template <typename Build>
class TreeReader {
  using Root = typename Nodes<Build>::Root;
  using RootTile = typename Nodes<Build>::RootTile;
  using Upper = typename Nodes<Build>::Upper;
  using Lower = typename Nodes<Build>::Lower;
  using Leaf = typename Nodes<Build>::Leaf;
  static constexpr bool kMask = std::is_same_v<Build, nanovdb::ValueMask>;
  static constexpr std::uint64_t kTreeAt = sizeof(nanovdb::GridData);
  static constexpr std::uint64_t kRootAt = kTreeAt + sizeof(nanovdb::TreeData<>);

 public:
  TreeReader(View bytes, Grid& grid)
      : bytes_(bytes), grid_(grid), tree_(tree_of(bytes)), root_(root_of(bytes)) {}

  void read(const grids::GridLimits& limits, std::uint64_t& used) {
    if constexpr (!kMask) grid_.background = to_value(root_.mBackground);
    read_nodes();
    check_checksum();
    const std::size_t brick_bytes = kBrickVoxels * grids::bytes_of(grid_.type);
    check_limits(grid_.name, active_,
                 leaves_.size() * (sizeof(Brick) + brick_bytes) + grid_.tiles.size() * sizeof(Tile), used,
                 limits);
    const auto in_order = [](const auto& a, const auto& b) { return grids::goes_before(a.origin, b.origin); };
    std::sort(leaves_.begin(), leaves_.end(), in_order);
    std::sort(grid_.tiles.begin(), grid_.tiles.end(), in_order);
    grid_.bricks.resize(leaves_.size());
    grid_.values.resize(leaves_.size() * brick_bytes);
    for (std::size_t i = 0; i < leaves_.size(); ++i)
      read_leaf(leaves_[i], grid_.bricks[i], grid_.values.data() + i * brick_bytes);
  }

 private:
  struct PlacedLeaf {
    const Leaf* leaf;
    ivec3 origin;
  };

  static const nanovdb::TreeData<>& tree_of(View bytes) {
    if (bytes.size() < kRootAt + sizeof(Root)) throw damaged("a grid is truncated");
    return *reinterpret_cast<const nanovdb::TreeData<>*>(bytes.data() + kTreeAt);
  }
  static const Root& root_of(View bytes) {
    const Root& root = *reinterpret_cast<const Root*>(bytes.data() + kRootAt);
    if (tree_of(bytes).mNodeOffset[3] != kRootAt - kTreeAt) throw damaged("its root lies elsewhere");
    if (root.mTableSize > (bytes.size() - kRootAt - sizeof(Root)) / sizeof(RootTile))
      throw damaged("its root has more entries than the grid holds");
    return root;
  }

  // The offset in the grid that a node's offset to its child leads to; far beyond the grid if it wraps.
  std::uint64_t offset_of(const void* node, std::int64_t child) const {
    return static_cast<std::uint64_t>(reinterpret_cast<const std::byte*>(node) - bytes_.data()) +
           static_cast<std::uint64_t>(child);
  }

  Level level(int number, std::uint64_t stride) const {
    return {bytes_, kTreeAt + tree_.mNodeOffset[number], tree_.mNodeCount[number], stride};
  }
  Level leaf_level() const {
    if constexpr (std::is_same_v<Build, nanovdb::FpN>)
      return Level(offsets_of_packed_leaves(bytes_, kTreeAt + tree_.mNodeOffset[0], tree_.mNodeCount[0]));
    else
      return level(0, sizeof(Leaf));
  }

  template <typename T>
  void add_tile(ivec3 origin, int edge, bool active, const T& from) {
    const Value value = kMask ? Value{} : to_value(from);
    if (active) active_ += std::uint64_t(edge) * std::uint64_t(edge) * std::uint64_t(edge);
    if (active || value != grid_.background)
      grid_.tiles.push_back({origin, static_cast<std::uint32_t>(edge), active, value});
  }

  void read_nodes() {
    Level uppers = level(2, sizeof(Upper)), lowers = level(1, sizeof(Lower)), leaves = leaf_level();
    std::vector<std::uint64_t> keys;
    for (std::uint32_t i = 0; i < root_.mTableSize; ++i) {
      const RootTile& tile = reinterpret_cast<const RootTile*>(&root_ + 1)[i];
      keys.push_back(tile.key);
      const ivec3 origin = origin_of(tile.key);
      if (tile.child == 0) {
        add_tile(origin, kUpperEdge, tile.state != 0, tile.value);
        continue;
      }
      const std::uint64_t at = offset_of(&root_, tile.child);
      uppers.visit(at);
      read_upper(*reinterpret_cast<const Upper*>(bytes_.data() + at), origin, lowers, leaves);
    }
    std::sort(keys.begin(), keys.end());
    if (std::adjacent_find(keys.begin(), keys.end()) != keys.end())
      throw damaged("two entries of its root are the same");
    if (!uppers.all_visited() || !lowers.all_visited() || !leaves.all_visited())
      throw damaged("a node has no parent");
  }

  // 20 bits of each axis fit into an index.
  static ivec3 origin_of(std::uint64_t key) {
    ivec3 origin(0);
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint64_t part = key >> (21 * (2 - axis)) & 0x1fffff;
      if (part > 0xfffff || key >> 62 != 0) throw damaged("an entry of its root lies outside of index space");
      origin[axis] = static_cast<std::int32_t>(static_cast<std::uint32_t>(part) << 12);
    }
    return origin;
  }

  void read_upper(const Upper& node, ivec3 origin, Level& lowers, Level& leaves) {
    for (std::uint32_t n = 0; n < 1u << (3 * kUpperBits); ++n) {
      const ivec3 at = origin + entry_of(n, kUpperBits) * kLowerEdge;
      if (!node.mChildMask.isOn(n)) {
        add_tile(at, kLowerEdge, node.mValueMask.isOn(n), node.mTable[n].value);
        continue;
      }
      const std::uint64_t child = offset_of(&node, node.mTable[n].child);
      lowers.visit(child);
      read_lower(*reinterpret_cast<const Lower*>(bytes_.data() + child), at, leaves);
    }
  }

  void read_lower(const Lower& node, ivec3 origin, Level& leaves) {
    for (std::uint32_t n = 0; n < 1u << (3 * kLowerBits); ++n) {
      const ivec3 at = origin + entry_of(n, kLowerBits) * kLeafEdge;
      if (!node.mChildMask.isOn(n)) {
        add_tile(at, kLeafEdge, node.mValueMask.isOn(n), node.mTable[n].value);
        continue;
      }
      const std::uint64_t child = offset_of(&node, node.mTable[n].child);
      leaves.visit(child);
      leaves_.push_back({reinterpret_cast<const Leaf*>(bytes_.data() + child), at});
      active_ += leaves_.back().leaf->mValueMask.countOn();
    }
  }

  void read_leaf(const PlacedLeaf& from, Brick& brick, std::byte* values) const {
    const Leaf& leaf = *from.leaf;
    brick.origin = from.origin;
    for (std::uint32_t n = 0; n < kBrickVoxels; ++n) {
      const ivec3 at = entry_of(n, kLeafBits);
      const auto voxel = static_cast<std::size_t>(at.x + 8 * (at.y + 8 * at.z));
      if (leaf.mValueMask.isOn(n)) brick.active[voxel / 64] |= std::uint64_t{1} << (voxel % 64);
      if constexpr (!kMask) {
        const auto value = leaf.getValue(n);
        std::memcpy(values + voxel * sizeof value, &value, sizeof value);
      }
    }
  }

  // Only now: the checksum follows all nodes.
  void check_checksum() const {
    const auto& grid = *reinterpret_cast<const nanovdb::NanoGrid<Build>*>(bytes_.data());
    if (grid.checksum() != nanovdb::GridChecksum::EMPTY &&
        !nanovdb::validateChecksum(grid, nanovdb::ChecksumMode::Full))
      throw damaged("the checksum of a grid is wrong");
  }

  View bytes_;
  Grid& grid_;
  const nanovdb::TreeData<>& tree_;
  const Root& root_;
  std::vector<PlacedLeaf> leaves_;
  std::uint64_t active_ = 0;
};

/// The grids of NanoVDB that we have.
struct Kind {
  nanovdb::GridType nano;
  ValueType type;
  void (*read)(View, Grid&, const grids::GridLimits&, std::uint64_t&);
};

template <typename Build>
void read_tree(View bytes, Grid& grid, const grids::GridLimits& limits, std::uint64_t& used) {
  TreeReader<Build>(bytes, grid).read(limits, used);
}

constexpr Kind kKinds[] = {
    {nanovdb::GridType::Float, ValueType::float32, read_tree<float>},
    {nanovdb::GridType::Double, ValueType::float64, read_tree<double>},
    {nanovdb::GridType::Int32, ValueType::int32, read_tree<std::int32_t>},
    {nanovdb::GridType::Int64, ValueType::int64, read_tree<std::int64_t>},
    {nanovdb::GridType::Boolean, ValueType::boolean, read_tree<bool>},
    {nanovdb::GridType::Mask, ValueType::mask, read_tree<nanovdb::ValueMask>},
    {nanovdb::GridType::Vec3f, ValueType::vec3f, read_tree<nanovdb::Vec3f>},
    {nanovdb::GridType::Vec3d, ValueType::vec3d, read_tree<nanovdb::Vec3d>},
    {nanovdb::GridType::Fp4, ValueType::float32, read_tree<nanovdb::Fp4>},
    {nanovdb::GridType::Fp8, ValueType::float32, read_tree<nanovdb::Fp8>},
    {nanovdb::GridType::Fp16, ValueType::float32, read_tree<nanovdb::Fp16>},
    {nanovdb::GridType::FpN, ValueType::float32, read_tree<nanovdb::FpN>},
};

// The bytes of blind data; empty if they lie outside of the grid.
View blind_data(View bytes, const nanovdb::GridData& head, const nanovdb::GridBlindMetaData& meta) {
  const auto at = static_cast<std::uint64_t>(reinterpret_cast<const std::byte*>(&meta) - bytes.data()) +
                  static_cast<std::uint64_t>(meta.mByteOffset);
  if (at > head.mGridSize || meta.mElementCount > head.mGridSize - at) return {};
  return bytes.subspan(static_cast<std::size_t>(at), static_cast<std::size_t>(meta.mElementCount));
}

// What a grid's blind data adds: a long name, and what kExtraName describes.
void read_blind_data(View bytes, const nanovdb::GridData& head, Grid& grid,
                     std::vector<grids::Metadata>& of_file) {
  const auto offset = static_cast<std::uint64_t>(head.mBlindMetadataOffset);
  if (head.mBlindMetadataCount == 0) return;
  // The list must lie in the grid: files are untrusted.
  if (offset % NANOVDB_DATA_ALIGNMENT != 0 || offset > bytes.size() ||
      head.mBlindMetadataCount > (bytes.size() - offset) / sizeof(nanovdb::GridBlindMetaData))
    throw damaged("its blind data lies outside of the grid");
  const auto* list = reinterpret_cast<const nanovdb::GridBlindMetaData*>(bytes.data() + offset);
  for (std::uint32_t i = 0; i < head.mBlindMetadataCount; ++i) {
    const View data = blind_data(bytes, head, list[i]);
    if (list[i].mDataClass == nanovdb::GridBlindDataClass::GridName) {
      const auto* text = reinterpret_cast<const char*>(data.data());
      grid.name.assign(text, ::strnlen(text, data.size()));
    }
    // What brume-vdb itself wrote beside the grid.
    if (std::strncmp(list[i].mName, kExtraName, sizeof list[i].mName) != 0) continue;
    grids::ByteReader in(data);
    const auto grid_class = in.number<std::uint8_t>(), half = in.number<std::uint8_t>();
    grid.metadata = grids::read_metadata(in);
    const auto metadata = grids::read_metadata(in);
    if (!in.ok() || grid_class > static_cast<std::uint8_t>(GridClass::staggered) || half > 1)
      throw damaged("its metadata is truncated");
    grid.grid_class = static_cast<GridClass>(grid_class);
    grid.saved_as_half = half == 1;
    of_file.insert(of_file.end(), metadata.begin(), metadata.end());
  }
}

GridClass to_class(nanovdb::GridClass grid_class) {
  switch (grid_class) {
    case nanovdb::GridClass::LevelSet:
      return GridClass::level_set;
    case nanovdb::GridClass::FogVolume:
      return GridClass::fog_volume;
    case nanovdb::GridClass::Staggered:
      return GridClass::staggered;
    default:
      return GridClass::unknown;
  }
}

void read_grid(View bytes, const grids::GridLimits& limits, const Reader& reader, std::uint64_t& used,
               std::vector<grids::Metadata>& of_file) {
  // Its head.
  if (bytes.size() < sizeof(nanovdb::GridData)) throw damaged("a grid is truncated");
  const auto& head = *reinterpret_cast<const nanovdb::GridData*>(bytes.data());
  if ((head.mMagic != kFirstMagic && head.mMagic != kGridMagic) ||
      head.mVersion.getMajor() != NANOVDB_MAJOR_VERSION_NUMBER)
    throw damaged("a grid begins with other bytes");
  if (head.mGridSize != bytes.size()) throw damaged("the size of a grid is wrong");
  if ((head.mFlags & static_cast<std::uint32_t>(nanovdb::GridFlags::IsBreadthFirst)) == 0)
    throw damaged("its nodes are not in breadth-first order");
  Grid grid;
  grid.name.assign(head.mGridName, ::strnlen(head.mGridName, sizeof head.mGridName));
  const Kind* kind = std::find_if(std::begin(kKinds), std::end(kKinds),
                                  [&](const Kind& k) { return k.nano == head.mGridType; });
  if (kind == std::end(kKinds)) {
    const bool named = head.mGridType < nanovdb::GridType::End;
    reader.warn("grid \"" + grid.name + "\" of type " +
                (named ? nanovdb::toStr(head.mGridType)
                       : std::to_string(static_cast<std::uint32_t>(head.mGridType))) +
                " is skipped");
    return;
  }

  // Its fields.
  grid.type = kind->type;
  grid.grid_class = to_class(head.mGridClass);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      grid.world_from_index[column][row] = head.mMap.mMatD[3 * row + column];
    grid.world_from_index[3][row] = head.mMap.mVecD[row];
  }
  read_blind_data(bytes, head, grid, of_file);
  kind->read(bytes, grid, limits, used);
  reader.add(grid);
}

}  // namespace

std::vector<grids::Metadata> read_nvdb(const std::string& path, const grids::GridLimits& limits,
                                       const Reader& reader) {
  std::uint64_t used = 0;
  std::vector<grids::Metadata> of_file;
  for_each_nvdb_grid(path, limits, [&](const AlignedBytes& grid) {
    read_grid(grid.bytes(), limits, reader, used, of_file);
  });
  return of_file;
}

}  // namespace brume::vdb
