// Named values of files and grids: as bytes, and as text for people.
#pragma once

#include <string>
#include <vector>

#include "grids/bytes.hpp"
#include "grids/grid.hpp"

namespace brume::grids {

/// A count in 32 bits, then name, type and bytes of each, each after its length in 32 bits.
void write_metadata(ByteWriter& out, const std::vector<Metadata>& metadata);

/// Reads the same. Allocates no more than the bytes that it reads; what is missing makes `in` fail.
std::vector<Metadata> read_metadata(ByteReader& in);

/// The value as text: "fog volume", "0.5", "64, 64, 96". Bytes of a type that has no text here: "12 bytes".
std::string to_text(const Metadata& entry);

/// Name and value of the metadata of a density that is an extinction per metre: at extinction 1 it is shown
/// as it is.
Metadata extinction_per_metre();

/// Whether a grid's metadata says that it is an extinction per metre.
bool is_extinction_per_metre(const Grid& grid);

}  // namespace brume::grids
