#include "tests/grids/mutations.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <random>
#include <thread>

#include "core/file.hpp"
#include "grids/check.hpp"
#include "grids/files/grid_files.hpp"
#include "tests/grids/child.hpp"
#include "tests/grids/sample_grids.hpp"

namespace brume::grids {
namespace {

using Bytes = std::vector<std::byte>;
using Random = std::mt19937;

constexpr GridLimits kLimits{.bytes = 64 << 20, .active_voxels = 1ull << 32, .seconds = 2};

struct Base {
  std::string suffix;
  Bytes bytes;
};

std::vector<Base> bases(const WorkFolder& folder) {
  std::vector<Base> list;
  const auto add = [&](const std::string& suffix, const Grid& grid) {
    const auto path = folder.path() / ("base" + suffix);
    save_grid_file(path, {{grid}, sample_metadata()}).value_or_throw();
    list.push_back({suffix, read_file(path).value_or_throw()});
  };
  for (const std::string suffix : {".vdb", ".nvdb"}) {
    // Small, of few nodes: what changes then matters more often.
    add(suffix, octant(smoke_grid("density", 5)));
    add(suffix, huge_tile());
    for (const ValueType type : {ValueType::boolean, ValueType::vec3f}) {
      Grid grid = octant(random_grid(type, 3, 60));
      grid.bricks.resize(2);
      grid.values.resize(2 * kBrickVoxels * bytes_of(type));
      std::erase_if(grid.tiles, [](const Tile& tile) { return tile.edge < 4096; });
      add(suffix, grid);
    }
  }
  return list;
}

// Checksums would refuse most changes of a .nvdb file before anything else does.
void drop_checksum(Base& base) {
  if (base.suffix != ".nvdb") return;
  std::uint32_t name_length = 0;
  std::memcpy(&name_length, &base.bytes[152], sizeof name_length);
  std::memset(&base.bytes[192 + name_length + 8], 0xff, 8);
}

void mutate(Bytes& bytes, Random& random) {
  const auto at = [&](std::size_t length) { return random() % (bytes.size() - length + 1); };
  // The beginning and the end hold more structure than voxels.
  const auto near = [&](std::size_t length) {
    const std::size_t reach = std::min<std::size_t>(bytes.size() - length + 1, 2048);
    const auto kind = random() % 3;
    return kind == 0   ? at(length)
           : kind == 1 ? random() % reach
                       : bytes.size() - length - random() % reach % (bytes.size() - length + 1);
  };
  for (std::uint32_t i = 0; i <= random() % 4; ++i) {
    switch (random() % 7) {
      case 0:
        bytes[near(1)] ^= static_cast<std::byte>(1u << (random() % 8));
        break;
      case 1:
        bytes[near(1)] = static_cast<std::byte>(random());
        break;
      case 2: {
        const auto any = static_cast<std::uint32_t>(random());
        const std::uint32_t values[] = {0, 1, UINT32_MAX, INT32_MAX, 1u << 31, any};
        std::memcpy(&bytes[near(4)], &values[random() % 6], 4);
        break;
      }
      case 3: {
        const std::uint64_t values[] = {0, UINT64_MAX, 1ull << 62, 1ull << 32, random()};
        std::memcpy(&bytes[near(8)], &values[random() % 5], 8);
        break;
      }
      case 4:
        bytes.resize(std::max<std::size_t>(16, random() % bytes.size()));
        break;
      case 5: {
        const std::size_t length = 1 + random() % std::min<std::size_t>(64, bytes.size() / 2);
        std::memmove(&bytes[at(length)], &bytes[at(length)], length);
        break;
      }
      default: {
        const std::size_t length = 1 + random() % 16, place = near(1);
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(place), length,
                     static_cast<std::byte>(random()));
      }
    }
  }
}

// Empty, or what is wrong with how a file was loaded.
std::string fault_of(const Result<GridFile>& file) {
  if (!file) {
    const ErrorCode code = file.failure().code;
    const bool refused = code == ErrorCode::bad_input || code == ErrorCode::resource_limit;
    return refused && file.failure().message.find('\n') == std::string::npos ? "" : file.failure().message;
  }
  std::uint64_t memory = 0;
  for (const Grid& grid : file->grids) {
    if (const auto valid = check_grid(grid); !valid) return valid.failure().message;
    if (count_active(grid) > kLimits.active_voxels) return "too many active voxels";
    memory += memory_of(grid);
  }
  return memory > kLimits.bytes ? "too much memory" : "";
}

}  // namespace

void load_mutations(std::uint32_t seed, int count) {
  const WorkFolder folder;
  const ChildProgram program;
  std::vector<Base> list = bases(folder);
  std::atomic<int> next{0}, accepted{0}, crashed{0};
  std::mutex mutex;
  const auto work = [&](int worker) {
    for (int i = next++; i < count; i = next++) {
      Random random(seed + static_cast<std::uint32_t>(i));
      Base base = list[random() % list.size()];
      if (random() % 4 != 0) drop_checksum(base);
      mutate(base.bytes, random);
      const auto path = folder.path() / (std::to_string(worker) + base.suffix);
      write_file_atomic(path, base.bytes).value_or_throw();
      const auto file = load_grid_file(path, kLimits);
      accepted += file ? 1 : 0;
      crashed += !file && file.failure().message.find("crashed") != std::string::npos ? 1 : 0;
      const std::string fault = fault_of(file);
      const std::lock_guard lock(mutex);
      EXPECT_EQ(fault, "") << "mutation " << i;
    }
  };
  std::thread other(work, 1);
  work(0);
  other.join();
  std::printf("%d of %d mutations are read, %d crash the reader\n", accepted.load(), count, crashed.load());
  // Not all are refused at once: the readers are reached.
  EXPECT_GT(accepted, count / 50);
}

}  // namespace brume::grids
