#include "apps/vdb/formats.hpp"
#include "core/error.hpp"
namespace brume::vdb {
std::vector<grids::Metadata> read_nvdb(const std::string&, const grids::GridLimits&, const Reader&) {
  throw Error(ErrorCode::usage, "nvdb");
}
void write_nvdb(const grids::GridFile&) {
  throw Error(ErrorCode::usage, "nvdb");
}
}  // namespace brume::vdb
