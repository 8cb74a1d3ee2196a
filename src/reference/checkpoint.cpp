// Saved states of a Render: a header, the samples of the tiles, the sums of the pixels, and a hash of all.
#include <array>
#include <cstring>

#include "core/file.hpp"
#include "core/hash.hpp"
#include "reference/render.hpp"

namespace brume::reference {
namespace {

constexpr std::array<char, 8> kMagic{'B', 'R', 'U', 'M', 'E', 'R', 'E', 'F'};
constexpr std::uint32_t kVersion = 2;

struct Header {
  std::array<char, 8> magic = kMagic;
  std::uint32_t version = kVersion, max_bounces = 0;
  std::uint64_t key = 0;
  std::uint32_t width = 0, height = 0;
  float clamp = 0;
  std::uint32_t tiles = 0;
};
static_assert(sizeof(Header) == 40);

}  // namespace

Result<void> Render::save(const std::filesystem::path& path, std::uint64_t key) const {
  Header header;
  header.key = key;
  header.width = settings_.size_px.x;
  header.height = settings_.size_px.y;
  header.max_bounces = settings_.limits.max_bounces;
  header.clamp = settings_.limits.clamp;
  header.tiles = static_cast<std::uint32_t>(tiles_.size());
  std::vector<std::uint32_t> samples;
  for (const Tile& tile : tiles_) samples.push_back(tile.samples);

  auto file = AtomicFile::open(path);
  if (!file) return file.failure();
  std::uint64_t hash = 0;
  const std::array<std::span<const std::byte>, 3> parts{std::as_bytes(std::span(&header, 1)),
                                                        std::as_bytes(std::span(samples)),
                                                        std::as_bytes(std::span(sums_))};
  for (const std::span<const std::byte> part : parts) {
    hash = hash_bytes(part, hash);
    if (auto written = file->write(part); !written) return written;
  }
  if (auto written = file->write(std::as_bytes(std::span(&hash, 1))); !written) return written;
  return file->commit();
}

Result<void> Render::load(const std::filesystem::path& path, std::uint64_t key) {
  const auto bytes = read_file(path);
  if (!bytes) return bytes.failure();
  const auto fault = [&](const std::string& text) {
    return Failure{ErrorCode::bad_input, path.string() + ": " + text};
  };
  Header header;
  if (bytes->size() < sizeof header) return fault("is no checkpoint; choose another name, or remove it");
  std::memcpy(&header, bytes->data(), sizeof header);
  if (header.magic != kMagic) return fault("is no checkpoint; choose another name, or remove it");
  if (header.version != kVersion)
    return fault("was made by another version of Brume; remove it to start over");
  if (glm::uvec2(header.width, header.height) != settings_.size_px || header.key != key ||
      header.max_bounces != settings_.limits.max_bounces || header.clamp != settings_.limits.clamp)
    return fault(
        "is of another picture: other inputs, size, time, camera or limits; remove it to start over");

  // All of one size, and unchanged.
  const std::size_t sample_bytes = tiles_.size() * sizeof(std::uint32_t),
                    sum_bytes = sums_.size() * sizeof(Sums);
  if (header.tiles != tiles_.size() ||
      bytes->size() != sizeof header + sample_bytes + sum_bytes + sizeof(std::uint64_t))
    return fault("is damaged: its size is wrong; remove it to start over");
  std::span<const std::byte> rest(*bytes);
  std::uint64_t hash = 0, stored = 0;
  std::vector<std::span<const std::byte>> parts;
  for (const std::size_t size : {sizeof header, sample_bytes, sum_bytes}) {
    parts.push_back(rest.first(size));
    rest = rest.subspan(size);
    hash = hash_bytes(parts.back(), hash);
  }
  std::memcpy(&stored, rest.data(), sizeof stored);
  if (stored != hash) return fault("is damaged: its hash is wrong; remove it to start over");

  std::vector<std::uint32_t> samples(tiles_.size());
  std::memcpy(samples.data(), parts[1].data(), sample_bytes);
  std::memcpy(static_cast<void*>(sums_.data()), parts[2].data(), sum_bytes);
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    tiles_[i].samples = samples[i];
    finish(tiles_[i]);
  }
  return {};
}

}  // namespace brume::reference
