#include "grids/metadata.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <span>
#include <string_view>

namespace brume::grids {
namespace {

template <typename T>
std::string numbers(const Metadata& entry, std::size_t count) {
  ByteReader in(entry.bytes);
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    char number[64];
    const auto end = std::to_chars(number, number + sizeof number, in.number<T>()).ptr;
    text += (i > 0 ? ", " : "") + std::string(number, end);
  }
  return text;
}

// "vec3i" is three numbers of type i.
template <typename T>
std::optional<std::string> vectors(const Metadata& entry, const std::string& letter) {
  for (const std::size_t count : {2, 3, 4})
    if (entry.type == "vec" + std::to_string(count) + letter && entry.bytes.size() == count * sizeof(T))
      return numbers<T>(entry, count);
  return std::nullopt;
}

template <typename T>
std::optional<std::string> number(const Metadata& entry, const std::string& type) {
  if (entry.type == type && entry.bytes.size() == sizeof(T)) return numbers<T>(entry, 1);
  return std::nullopt;
}

}  // namespace

void write_metadata(ByteWriter& out, const std::vector<Metadata>& metadata) {
  out.number(static_cast<std::uint32_t>(metadata.size()));
  for (const Metadata& entry : metadata) {
    out.text(entry.name);
    out.text(entry.type);
    out.number(static_cast<std::uint32_t>(entry.bytes.size()));
    out.raw(entry.bytes);
  }
}

std::vector<Metadata> read_metadata(ByteReader& in) {
  std::vector<Metadata> metadata;
  const auto count = in.number<std::uint32_t>();
  for (std::uint32_t i = 0; i < count && in.ok(); ++i) {
    Metadata& entry = metadata.emplace_back();
    entry.name = in.text();
    entry.type = in.text();
    const auto bytes = in.raw(in.number<std::uint32_t>());
    entry.bytes.assign(bytes.begin(), bytes.end());
  }
  return metadata;
}

std::string to_text(const Metadata& entry) {
  if (entry.type == "string") return {reinterpret_cast<const char*>(entry.bytes.data()), entry.bytes.size()};
  if (entry.type == "bool" && entry.bytes.size() == 1)
    return entry.bytes[0] == std::byte{0} ? "false" : "true";
  for (const auto& text :
       {number<float>(entry, "float"), number<double>(entry, "double"), number<std::int32_t>(entry, "int32"),
        number<std::int64_t>(entry, "int64"), vectors<std::int32_t>(entry, "i"), vectors<float>(entry, "s"),
        vectors<double>(entry, "d")})
    if (text) return *text;
  return std::to_string(entry.bytes.size()) + " bytes";
}

Metadata extinction_per_metre() {
  constexpr std::string_view kValue = "extinction per metre";
  Metadata entry{"brume_density", "string", {}};
  const auto bytes = std::as_bytes(std::span(kValue));
  entry.bytes.assign(bytes.begin(), bytes.end());
  return entry;
}

bool is_extinction_per_metre(const Grid& grid) {
  return std::ranges::find(grid.metadata, extinction_per_metre()) != grid.metadata.end();
}

}  // namespace brume::grids
