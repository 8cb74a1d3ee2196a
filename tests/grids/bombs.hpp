// Small files that claim to be huge, or that lead a trusting reader out of them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace brume::grids {

struct Bomb {
  std::string name;  ///< "vdb: number of root tiles"; the part before the colon is the suffix of its file.
  std::vector<std::byte> bytes;
};

/// Bombs of each format. The files that they are made of are written in `folder`.
std::vector<Bomb> vdb_bombs(const std::string& folder);
std::vector<Bomb> nvdb_bombs(const std::string& folder);
std::vector<Bomb> brv_bombs();

}  // namespace brume::grids
