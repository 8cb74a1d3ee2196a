// The one source that includes OpenVDB.
#include <openvdb/io/Archive.h>
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "apps/vdb/formats.hpp"
#include "core/error.hpp"

namespace brume::vdb {
namespace {

using grids::Brick;
using grids::Grid;
using grids::GridClass;
using grids::kBrickVoxels;
using grids::Metadata;
using grids::Tile;
using grids::Value;
using grids::ValueType;

/// The last part of the metadata is written from the grid's own fields.
constexpr const char *kName = "name", *kClass = "class", *kHalf = "is_saved_as_half_float";
/// Describes how one file stores a grid.
constexpr const char* kDelayedLoad = "file_delayed_load";

/// OpenVDB numbers the voxels of a leaf from z to x, we from x to z.
std::size_t leaf_voxel(std::size_t voxel) {
  return voxel % 8 * 64 + voxel / 8 % 8 * 8 + voxel / 64;
}

glm::ivec3 to_vector(const openvdb::Coord& at) {
  return {at.x(), at.y(), at.z()};
}

openvdb::Coord to_coord(glm::ivec3 at) {
  return {at.x, at.y, at.z};
}

template <typename T>
Value to_value(const T& value) {
  Value bytes{};
  static_assert(sizeof value <= sizeof bytes);
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

template <typename T>
T from_bytes(const std::byte* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

// Metadata.

std::vector<Metadata> to_metadata(const openvdb::MetaMap& map) {
  std::vector<Metadata> list;
  for (auto at = map.beginMeta(); at != map.endMeta(); ++at) {
    std::ostringstream out;
    at->second->write(out);  // Its size in 32 bits, then the value.
    const std::string text = out.str().substr(4);
    Metadata& entry = list.emplace_back();
    entry.name = at->first;
    entry.type = at->second->typeName();
    entry.bytes.resize(text.size());
    std::memcpy(entry.bytes.data(), text.data(), text.size());
  }
  return list;
}

void put_metadata(openvdb::MetaMap& map, const std::vector<Metadata>& list) {
  for (const Metadata& entry : list) {
    openvdb::Metadata::Ptr value = openvdb::Metadata::isRegisteredType(entry.type)
                                       ? openvdb::Metadata::createMetadata(entry.type)
                                       : openvdb::Metadata::Ptr(new openvdb::UnknownMetadata(entry.type));
    const auto length = static_cast<std::uint32_t>(entry.bytes.size());
    std::string text(reinterpret_cast<const char*>(&length), sizeof length);
    text.append(reinterpret_cast<const char*>(entry.bytes.data()), entry.bytes.size());
    std::istringstream in(text);
    value->read(in);
    if (!in || value->size() != length)
      throw Error(ErrorCode::bad_input, "the metadata \"" + entry.name + "\" is no " + entry.type);
    map.insertMeta(entry.name, *value);
  }
}

GridClass to_class(const openvdb::GridBase& grid) {
  switch (grid.getGridClass()) {
    case openvdb::GRID_LEVEL_SET:
      return GridClass::level_set;
    case openvdb::GRID_FOG_VOLUME:
      return GridClass::fog_volume;
    case openvdb::GRID_STAGGERED:
      return GridClass::staggered;
    default:
      return GridClass::unknown;
  }
}

openvdb::GridClass to_class(GridClass grid_class) {
  constexpr std::array kClasses{openvdb::GRID_UNKNOWN, openvdb::GRID_LEVEL_SET, openvdb::GRID_FOG_VOLUME,
                                openvdb::GRID_STAGGERED};
  return kClasses.at(static_cast<std::size_t>(grid_class));
}

void read_head(const openvdb::GridBase& from, Grid& grid) {
  grid.name = from.getName();
  grid.grid_class = to_class(from);
  grid.saved_as_half = from.saveFloatAsHalf();
  // Row vectors there, column vectors here: row i of theirs is column i of ours.
  const openvdb::Mat4d matrix = from.transform().baseMap()->getAffineMap()->getMat4();
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) grid.world_from_index[i][j] = matrix(i, j);
  grid.metadata = to_metadata(from);
  std::erase_if(grid.metadata, [&](const Metadata& entry) {
    return entry.name == kDelayedLoad || (entry.name == kName && entry.type == "string") ||
           (entry.name == kClass && grid.grid_class != GridClass::unknown) ||
           (entry.name == kHalf && grid.saved_as_half);
  });
}

// The simplest map of the same bits: a file of uniform voxels says so again.
openvdb::math::MapBase::Ptr map_of(const glm::dmat4& m) {
  openvdb::Mat4d matrix;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) matrix(i, j) = m[i][j];
  const openvdb::math::AffineMap::Ptr affine(new openvdb::math::AffineMap(matrix));
  const openvdb::math::MapBase::Ptr simple = openvdb::math::simplify(affine);
  const openvdb::Mat4d again = simple->getAffineMap()->getMat4();
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      if (std::bit_cast<std::uint64_t>(again(i, j)) != std::bit_cast<std::uint64_t>(m[i][j])) return affine;
  return simple;
}

void write_head(const Grid& grid, openvdb::GridBase& to) {
  to.setTransform(openvdb::math::Transform::Ptr(new openvdb::math::Transform(map_of(grid.world_from_index))));
  put_metadata(to, grid.metadata);
  to.setName(grid.name);
  if (grid.grid_class != GridClass::unknown) to.setGridClass(to_class(grid.grid_class));
  if (grid.saved_as_half) to.setSaveFloatAsHalf(true);
}

// Voxels. A mask's values are its active states.

template <typename Leaf>
void read_leaf(const Leaf& leaf, Brick& brick, std::byte* values) {
  using T = typename Leaf::ValueType;
  constexpr bool kMask = std::is_same_v<typename Leaf::BuildType, openvdb::ValueMask>;
  brick.origin = to_vector(leaf.origin());
  for (std::size_t voxel = 0; voxel < kBrickVoxels; ++voxel) {
    const auto at = static_cast<openvdb::Index>(leaf_voxel(voxel));
    if (leaf.isValueOn(at)) brick.active[voxel / 64] |= std::uint64_t{1} << (voxel % 64);
    if constexpr (!kMask) {
      const T value = leaf.getValue(at);
      std::memcpy(values + voxel * sizeof(T), &value, sizeof(T));
    }
  }
}

template <typename Leaf>
void write_leaf(const Brick& brick, const std::byte* values, Leaf& leaf) {
  using T = typename Leaf::ValueType;
  constexpr bool kMask = std::is_same_v<typename Leaf::BuildType, openvdb::ValueMask>;
  for (std::size_t voxel = 0; voxel < kBrickVoxels; ++voxel) {
    const auto at = static_cast<openvdb::Index>(leaf_voxel(voxel));
    if constexpr (!kMask) leaf.setValueOnly(at, from_bytes<T>(values + voxel * sizeof(T)));
    leaf.setActiveState(at, brick.is_active(voxel));
  }
}

// The tiles of a node that differ from the background outside of all.
template <typename Node>
void read_tiles(const Node& node, std::uint32_t edge, bool is_mask, Grid& grid) {
  for (auto at = node.cbeginValueAll(); at; ++at) {
    const Value value = is_mask ? Value{} : to_value(*at);
    if (!at.isValueOn() && value == grid.background) continue;
    grid.tiles.push_back({to_vector(at.getCoord()), edge, at.isValueOn(), value});
  }
}

template <typename GridT>
Grid read_grid(const openvdb::GridBase& base, ValueType type, const grids::GridLimits& limits,
               std::uint64_t& used) {
  const auto& from = static_cast<const GridT&>(base);
  const auto& root = from.tree().root();
  const bool is_mask = type == ValueType::mask;
  Grid grid;
  grid.type = type;
  read_head(from, grid);
  if (!is_mask) grid.background = to_value(root.background());

  // Tiles, counting the leaves.
  std::vector<const typename GridT::TreeType::LeafNodeType*> leaves;
  read_tiles(root, 4096, is_mask, grid);
  for (auto upper = root.cbeginChildOn(); upper; ++upper) {
    read_tiles(*upper, 128, is_mask, grid);
    for (auto lower = upper->cbeginChildOn(); lower; ++lower) {
      read_tiles(*lower, 8, is_mask, grid);
      for (auto leaf = lower->cbeginChildOn(); leaf; ++leaf) leaves.push_back(&*leaf);
    }
  }
  const std::size_t brick_bytes = kBrickVoxels * grids::bytes_of(type);
  check_limits(grid.name, from.activeVoxelCount(),
               leaves.size() * (sizeof(Brick) + brick_bytes) + grid.tiles.size() * sizeof(Tile), used,
               limits);

  // Leaves.
  const auto in_order = [](glm::ivec3 a, glm::ivec3 b) { return grids::goes_before(a, b); };
  std::sort(leaves.begin(), leaves.end(), [&](const auto* a, const auto* b) {
    return in_order(to_vector(a->origin()), to_vector(b->origin()));
  });
  std::sort(grid.tiles.begin(), grid.tiles.end(),
            [&](const Tile& a, const Tile& b) { return in_order(a.origin, b.origin); });
  grid.bricks.resize(leaves.size());
  grid.values.resize(leaves.size() * brick_bytes);
  for (std::size_t i = 0; i < leaves.size(); ++i)
    read_leaf(*leaves[i], grid.bricks[i], grid.values.data() + i * brick_bytes);
  return grid;
}

template <typename GridT>
openvdb::GridBase::Ptr write_grid(const Grid& grid) {
  using Tree = typename GridT::TreeType;
  using Leaf = typename Tree::LeafNodeType;
  using T = typename GridT::ValueType;
  const bool is_mask = grid.type == ValueType::mask;
  const T background = is_mask ? T{} : from_bytes<T>(grid.background.data());
  // The library's own constructor: one here would compile all virtual functions of the tree again.
  const openvdb::GridBase::Ptr to = openvdb::GridBase::createGrid(GridT::gridType());
  write_head(grid, *to);
  Tree& tree = static_cast<GridT&>(*to).tree();
  tree.root().setBackground(background, /*updateChildNodes=*/false);
  for (const Tile& tile : grid.tiles) {
    const openvdb::Index level = tile.edge == 8 ? 1 : tile.edge == 128 ? 2 : 3;
    T value = is_mask ? T(tile.active) : from_bytes<T>(tile.value.data());
    tree.addTile(level, to_coord(tile.origin), value, tile.active);
  }
  const std::size_t brick_bytes = kBrickVoxels * grids::bytes_of(grid.type);
  for (std::size_t i = 0; i < grid.bricks.size(); ++i) {
    auto leaf = std::make_unique<Leaf>(to_coord(grid.bricks[i].origin), background, false);
    write_leaf(grid.bricks[i], grid.values.data() + i * brick_bytes, *leaf);
    tree.addLeaf(leaf.release());
  }
  return to;
}

/// The grids of OpenVDB that we have.
struct Kind {
  ValueType type;
  std::string (*name)();
  Grid (*read)(const openvdb::GridBase&, ValueType, const grids::GridLimits&, std::uint64_t&);
  openvdb::GridBase::Ptr (*write)(const Grid&);
};

template <typename GridT>
Kind kind_of(ValueType type) {
  return {type, [] { return std::string(GridT::gridType()); }, read_grid<GridT>, write_grid<GridT>};
}

const std::array<Kind, 9>& kinds() {
  static const std::array<Kind, 9> all{
      kind_of<openvdb::FloatGrid>(ValueType::float32), kind_of<openvdb::DoubleGrid>(ValueType::float64),
      kind_of<openvdb::Int32Grid>(ValueType::int32),   kind_of<openvdb::Int64Grid>(ValueType::int64),
      kind_of<openvdb::BoolGrid>(ValueType::boolean),  kind_of<openvdb::MaskGrid>(ValueType::mask),
      kind_of<openvdb::Vec3fGrid>(ValueType::vec3f),   kind_of<openvdb::Vec3dGrid>(ValueType::vec3d),
      kind_of<openvdb::Vec3IGrid>(ValueType::vec3i)};
  return all;
}

const Kind* kind_named(const std::string& grid_type) {
  for (const Kind& kind : kinds())
    if (kind.name() == grid_type) return &kind;
  return nullptr;
}

const Kind& kind_of_values(ValueType type) {
  return *std::find_if(kinds().begin(), kinds().end(), [&](const Kind& kind) { return kind.type == type; });
}

// Few threads: each takes address space, of which the program has a limited amount.
struct Library {
  tbb::global_control threads{tbb::global_control::max_allowed_parallelism, 1};
  Library() { openvdb::initialize(); }
};

/// Writes to a stream whose errors are exceptions, as openvdb::io::File does to one whose errors it ignores.
class Archive : public openvdb::io::Archive {
 public:
  void write_to(std::ostream& out, const openvdb::GridPtrVec& grids, const openvdb::MetaMap& metadata) const {
    write(out, grids, true, metadata);
  }
};

}  // namespace

std::vector<Metadata> read_vdb(const std::string& path, const grids::GridLimits& limits,
                               const Reader& reader) {
  const Library library;
  openvdb::io::File file(path);
  file.open(/*delayLoad=*/false);
  std::uint64_t used = 0;
  for (auto name = file.beginName(); name != file.endName(); ++name) {
    const openvdb::GridBase::Ptr head = file.readGridMetadata(*name);
    const Kind* kind = kind_named(head->type());
    if (kind == nullptr) {
      reader.warn("grid \"" + *name + "\" of type " + head->type() + " is skipped");
      continue;
    }
    if (!head->transform().isLinear()) {
      reader.warn("grid \"" + *name + "\" in a frustum is skipped");
      continue;
    }
    const openvdb::GridBase::Ptr grid = file.readGrid(*name);
    reader.add(kind->read(*grid, kind->type, limits, used));
  }
  return to_metadata(*file.getMetadata());
}

void write_vdb(const grids::GridFile& file, int output) {
  const Library library;
  openvdb::GridPtrVec list;
  for (const Grid& grid : file.grids) list.push_back(kind_of_values(grid.type).write(grid));
  openvdb::MetaMap metadata;
  put_metadata(metadata, file.metadata);
  // Its first errors end it: a full disk is one.
  std::ofstream out;
  out.exceptions(std::ios::failbit | std::ios::badbit);
  try {
    out.open("/proc/self/fd/" + std::to_string(output), std::ios::binary);
    Archive().write_to(out, list, metadata);
    out.close();
  } catch (const std::ios_base::failure&) {
    throw Error(ErrorCode::resource_limit, std::string("cannot write: ") + std::strerror(errno));
  }
}

}  // namespace brume::vdb
