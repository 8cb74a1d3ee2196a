#include "apps/vdb/nvdb_file.hpp"

#include <blosc.h>
#include <nanovdb/util/IO.h>
#include <zlib.h>

#include <cstdlib>
#include <cstring>
#include <new>

#include "core/error.hpp"
#include "core/file.hpp"
#include "grids/bytes.hpp"
#include "grids/check.hpp"

namespace brume::vdb {
namespace {

using grids::ByteReader;
using nanovdb::io::Codec;
using View = std::span<const std::byte>;

constexpr std::uint64_t kBloscBlock = std::uint64_t{1} << 30;

Error damaged(const std::string& what) {
  return {ErrorCode::bad_input, "a damaged .nvdb file: " + what};
}

void check_header(const nanovdb::io::Header& header) {
  constexpr std::uint64_t kName = (std::uint64_t{1} << 56) - 1;  // "NanoVDB"
  if ((header.magic & kName) != (kFirstMagic & kName)) throw Error(ErrorCode::bad_input, "not a .nvdb file");
  const std::uint32_t major = header.version.getMajor();
  if (major != NANOVDB_MAJOR_VERSION_NUMBER)
    throw Error(ErrorCode::bad_input, "a .nvdb file of NanoVDB " + std::to_string(major) +
                                          ", whose grids differ from those of " +
                                          std::to_string(NANOVDB_MAJOR_VERSION_NUMBER) +
                                          "; convert it with that version's nanovdb_convert, to .vdb");
  if (header.magic != kFirstMagic && header.magic != kFileMagic)
    throw Error(ErrorCode::bad_input,
                std::string("a .nvdb file that begins with NanoVDB") + static_cast<char>(header.magic >> 56) +
                    "; expected NanoVDB0, 1 or 2; convert it with its version's nanovdb_convert, to .vdb");
  if (header.codec >= Codec::END) throw damaged("a compression that is not one");
}

void unzip(ByteReader& in, std::span<std::byte> grid) {
  const View packed = in.raw(in.number<std::uint64_t>());
  uLongf length = grid.size();
  if (!in.ok() ||
      ::uncompress(reinterpret_cast<Bytef*>(grid.data()), &length,
                   reinterpret_cast<const Bytef*>(packed.data()), packed.size()) != Z_OK ||
      length != grid.size())
    throw damaged("a grid does not unpack");
}

void unblosc(ByteReader& in, std::span<std::byte> grid) {
  for (std::size_t done = 0; done < grid.size();) {
    const std::size_t block = std::min<std::uint64_t>(grid.size() - done, kBloscBlock);
    const View packed = in.raw(in.number<std::uint64_t>());
    std::size_t length = 0;
    if (!in.ok() || ::blosc_cbuffer_validate(packed.data(), packed.size(), &length) < 0 || length != block ||
        ::blosc_decompress_ctx(packed.data(), &grid[done], block, 1) != static_cast<int>(block))
      throw damaged("a grid does not unpack");
    done += block;
  }
}

AlignedBytes read_grid(ByteReader& in, std::uint64_t size, Codec codec, const grids::GridLimits& limits) {
  grids::check_memory(size, limits).value_or_throw();
  if (codec == Codec::NONE) {
    const View stored = in.raw(size);
    if (!in.ok()) throw damaged("it is truncated");
    AlignedBytes grid(stored.size());
    std::memcpy(grid.bytes().data(), stored.data(), stored.size());
    return grid;
  }
  AlignedBytes grid(static_cast<std::size_t>(size));
  codec == Codec::ZIP ? unzip(in, grid.bytes()) : unblosc(in, grid.bytes());
  return grid;
}

/// Grids one after the other, without a head of the file.
void for_each_raw_grid(ByteReader& in, const grids::GridLimits& limits,
                       const std::function<void(const AlignedBytes&)>& use) {
  while (in.remaining() > 0) {
    ByteReader ahead = in;
    nanovdb::GridData head;
    const View bytes = ahead.raw(sizeof head);
    if (!ahead.ok()) throw damaged("it is truncated");
    std::memcpy(static_cast<void*>(&head), bytes.data(), sizeof head);
    if (head.mGridSize < sizeof head) throw damaged("the size of a grid is wrong");
    use(read_grid(in, head.mGridSize, Codec::NONE, limits));
  }
}

}  // namespace

AlignedBytes::AlignedBytes(std::size_t size) : size_(size) {
  const std::size_t whole =
      (size + NANOVDB_DATA_ALIGNMENT - 1) / NANOVDB_DATA_ALIGNMENT * NANOVDB_DATA_ALIGNMENT;
  data_.reset(static_cast<std::byte*>(
      std::aligned_alloc(NANOVDB_DATA_ALIGNMENT, std::max<std::size_t>(whole, NANOVDB_DATA_ALIGNMENT))));
  if (!data_) throw std::bad_alloc();
  std::memset(data_.get(), 0, size);
}

void AlignedBytes::Free::operator()(std::byte* data) const {
  std::free(data);
}

void for_each_nvdb_grid(const std::string& path, const grids::GridLimits& limits,
                        const std::function<void(const AlignedBytes&)>& use) {
  const auto file = read_file(path, limits.bytes).value_or_throw();
  if (file.empty()) throw Error(ErrorCode::bad_input, "not a .nvdb file: it is empty");
  ByteReader in(file);
  if (ByteReader ahead = in; ahead.number<std::uint64_t>() == kGridMagic && ahead.ok())
    return for_each_raw_grid(in, limits, use);
  while (in.remaining() > 0) {
    // A segment: what its grids are.
    nanovdb::io::Header header;
    const View head = in.raw(sizeof header);
    if (!in.ok()) throw damaged("it is truncated");
    std::memcpy(static_cast<void*>(&header), head.data(), sizeof header);
    check_header(header);
    std::vector<std::uint64_t> sizes;
    for (int i = 0; i < header.gridCount; ++i) {
      nanovdb::io::MetaData meta;
      const View bytes = in.raw(sizeof meta);
      if (!in.ok()) throw damaged("it is truncated");
      std::memcpy(static_cast<void*>(&meta), bytes.data(), sizeof meta);
      in.raw(meta.nameSize);
      sizes.push_back(meta.gridSize);
    }
    // The grids.
    for (const std::uint64_t size : sizes) use(read_grid(in, size, header.codec, limits));
  }
}

}  // namespace brume::vdb
