#include "scene/gltf_buffers.hpp"

#include <array>
#include <cmath>
#include <cstring>

#include "core/checked.hpp"
#include "scene/text_reader.hpp"

namespace brume::scene {
namespace {

enum ComponentType { kByte = 5120, kUnsignedByte, kShort, kUnsignedShort, kUnsignedInt = 5125, kFloat };

constexpr std::uint64_t kMostBytes = 1ull << 32;

std::size_t component_size(int type) {
  switch (type) {
    case kByte:
    case kUnsignedByte:
      return 1;
    case kShort:
    case kUnsignedShort:
      return 2;
    case kUnsignedInt:
    case kFloat:
      return 4;
    default:
      return 0;
  }
}

std::size_t components_of(const std::string& type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "VEC4") return 4;
  return 0;
}

template <typename T>
T load(const std::byte* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

float component(const std::byte* from, int type, bool normalized) {
  const auto scaled = [normalized](auto value) {
    const float most = static_cast<float>(std::numeric_limits<decltype(value)>::max());
    return normalized ? std::max(static_cast<float>(value) / most, -1.0f) : static_cast<float>(value);
  };
  switch (type) {
    case kByte:
      return scaled(load<std::int8_t>(from));
    case kUnsignedByte:
      return scaled(load<std::uint8_t>(from));
    case kShort:
      return scaled(load<std::int16_t>(from));
    case kUnsignedShort:
      return scaled(load<std::uint16_t>(from));
    case kUnsignedInt:
      return scaled(load<std::uint32_t>(from));
    default:
      return load<float>(from);
  }
}

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  if (c == '/' || c == '_') return 63;
  return -1;
}

std::optional<std::vector<std::byte>> decode_base64(std::string_view text) {
  while (text.ends_with('=')) text.remove_suffix(1);
  std::vector<std::byte> bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    const int digit = base64_digit(c);
    if (digit < 0) return std::nullopt;
    bits = (bits << 6 | static_cast<std::uint32_t>(digit)) & 0xffffffu;
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes.push_back(static_cast<std::byte>(bits >> held & 0xffu));
  }
  return bytes;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// "%20" and the like into bytes.
std::string percent_decoded(const std::string& uri) {
  std::string name;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool escape =
        uri[i] == '%' && i + 2 < uri.size() && hex_digit(uri[i + 1]) >= 0 && hex_digit(uri[i + 2]) >= 0;
    name += escape ? static_cast<char>(hex_digit(uri[i + 1]) * 16 + hex_digit(uri[i + 2])) : uri[i];
    if (escape) i += 2;
  }
  return name;
}

}  // namespace

GltfContainer split_gltf(std::span<const std::byte> bytes, const std::string& name) {
  constexpr std::uint32_t kMagic = 0x46546c67, kJson = 0x4e4f534a, kBinary = 0x004e4942;
  const auto word = [&](std::size_t at) { return load<std::uint32_t>(bytes.data() + at); };
  if (bytes.size() < 4 || word(0) != kMagic) {
    return {{reinterpret_cast<const char*>(bytes.data()), bytes.size()}, std::nullopt};
  }
  const auto truncated = [&](const std::string& what) {
    return Error(ErrorCode::bad_input,
                 name + ": the GLB file is cut short in " + what + "; export or copy it again");
  };
  if (bytes.size() < 20) throw truncated("its header");
  if (word(4) != 2)
    throw Error(ErrorCode::bad_input, name + ": GLB version " + std::to_string(word(4)) + "; expected 2");
  if (word(8) > bytes.size()) throw truncated("its chunks");

  GltfContainer container;
  std::size_t at = 12;
  for (bool first = true; at + 8 <= bytes.size(); first = false) {
    const std::uint32_t length = word(at), type = word(at + 4);
    at += 8;
    if (length > bytes.size() - at) throw truncated(type == kJson ? "its JSON" : "its binary chunk");
    const auto chunk = bytes.subspan(at, length);
    if (first) {
      if (type != kJson)
        throw Error(ErrorCode::bad_input, name + ": the first chunk of the GLB file is not JSON");
      container.json = {reinterpret_cast<const char*>(chunk.data()), chunk.size()};
    } else if (type == kBinary && !container.binary) {
      container.binary = chunk;
    }
    at += std::min<std::size_t>((length + 3ull) / 4 * 4, bytes.size() - at);
  }
  return container;
}

std::string gltf_file_name(const GltfValue& value) {
  const std::string& uri = value.text();
  if (uri.starts_with("data:")) return {};
  const std::string name = percent_decoded(uri);
  if (!is_safe_relative(name) || name.find("://") != std::string::npos) {
    value.fail("the file " + in_quotes(name) + " is not below the scene's own folder; move it there");
  }
  return name;
}

GltfValue gltf_element(const GltfValue& document, const char* array, std::uint64_t index,
                       const GltfValue& asker) {
  const auto elements = document.find(array);
  const std::size_t count = elements ? elements->size() : 0;
  if (index >= count) {
    asker.fail("names " + std::string(array) + "[" + std::to_string(index) + "], but the document has " +
               std::to_string(count) + " of them");
  }
  return (*elements)[index];
}

GltfBuffers::GltfBuffers(GltfValue document, const SceneFiles& files,
                         std::optional<std::span<const std::byte>> binary)
    : document_(std::move(document)), files_(files), binary_(binary) {}

std::vector<std::byte> GltfBuffers::uri_bytes(const GltfValue& value) const {
  const std::string& uri = value.text();
  if (uri.starts_with("data:")) {
    const std::size_t comma = uri.find(',');
    const bool is_base64 = comma != std::string::npos && uri.substr(0, comma).ends_with(";base64");
    auto bytes = is_base64 ? decode_base64(std::string_view(uri).substr(comma + 1)) : std::nullopt;
    if (!bytes) value.fail("expected a data: URI in base64");
    return *std::move(bytes);
  }
  const std::string name = gltf_file_name(value);
  const auto found = files_.find(name);
  if (!found) value.fail("the file " + in_quotes(name) + " does not exist beside the scene");
  auto bytes = files_.read(*found);
  if (!bytes) value.fail(bytes.failure().message);
  return *std::move(bytes);
}

std::span<const std::byte> GltfBuffers::buffer(std::uint64_t index, const GltfValue& asker) {
  const GltfValue description = gltf_element(document_, "buffers", index, asker);
  const std::uint64_t length = description.member("byteLength").whole(kMostBytes);
  const auto uri = description.find("uri");
  std::span<const std::byte> bytes;
  if (uri) {
    auto known = loaded_.find(index);
    if (known == loaded_.end()) known = loaded_.emplace(index, uri_bytes(*uri)).first;
    bytes = known->second;
  } else {
    if (index != 0 || !binary_) description.fail("has no \"uri\", and the file no binary chunk for it");
    bytes = *binary_;
  }
  if (bytes.size() < length) {
    description.fail("is cut short: " + std::to_string(length) + " bytes are promised, " +
                     std::to_string(bytes.size()) + " are there");
  }
  return bytes.first(length);
}

std::span<const std::byte> GltfBuffers::view(std::uint64_t index, const GltfValue& asker) {
  const GltfValue description = gltf_element(document_, "bufferViews", index, asker);
  const auto bytes = buffer(description.member("buffer").whole(1u << 20), description);
  const auto offset_value = description.find("byteOffset");
  const std::uint64_t offset = offset_value ? offset_value->whole(kMostBytes) : 0;
  const std::uint64_t length = description.member("byteLength").whole(kMostBytes);
  if (offset > bytes.size() || length > bytes.size() - offset) {
    description.fail("ends at byte " + std::to_string(offset + length) + " of a buffer of " +
                     std::to_string(bytes.size()));
  }
  return bytes.subspan(offset, length);
}

GltfBuffers::Accessor GltfBuffers::read_accessor(std::uint64_t index, const GltfValue& asker) {
  const GltfValue description = gltf_element(document_, "accessors", index, asker);
  Accessor accessor;
  accessor.count = description.member("count").whole(kMostBytes);
  accessor.component_type = static_cast<int>(description.member("componentType").whole(kFloat));
  accessor.components = components_of(description.member("type").text());
  if (const auto normalized = description.find("normalized")) accessor.normalized = normalized->is_true();
  const std::size_t size = component_size(accessor.component_type);
  if (size == 0) description.member("componentType").fail("is none of 5120-5123, 5125, 5126");
  if (accessor.components == 0) description.member("type").fail("is none of SCALAR, VEC2, VEC3, VEC4");
  const std::size_t element_size = size * accessor.components;
  if (accessor.count == 0) description.member("count").fail("is 0; expected at least one element");

  const auto view_index = description.find("bufferView");
  if (!view_index) {
    if (accessor.count > kMostZeroElements) description.fail("has too many elements without a bufferView");
    accessor.packed.assign(accessor.count * element_size, std::byte{0});
  } else {
    const GltfValue view_value =
        gltf_element(document_, "bufferViews", view_index->whole(1u << 30), *view_index);
    const auto bytes = view(view_index->whole(1u << 30), *view_index);
    const auto stride_value = view_value.find("byteStride");
    const std::uint64_t stride = stride_value ? stride_value->whole(252) : element_size;
    if (stride < element_size) view_value.fail("its byteStride is shorter than one element");
    const auto offset_value = description.find("byteOffset");
    const std::uint64_t offset = offset_value ? offset_value->whole(kMostBytes) : 0;
    const auto steps = checked_mul(stride, accessor.count - 1);
    const auto end = steps ? checked_add(*steps, offset + element_size) : std::nullopt;
    if (!end || *end > bytes.size()) {
      description.fail("reaches past its bufferView: " + std::to_string(accessor.count) + " elements of " +
                       std::to_string(element_size) + " bytes from byte " + std::to_string(offset) +
                       " do not fit into " + std::to_string(bytes.size()));
    }
    accessor.packed.resize(accessor.count * element_size);
    for (std::uint64_t i = 0; i < accessor.count; ++i) {
      std::memcpy(accessor.packed.data() + i * element_size, bytes.data() + offset + i * stride,
                  element_size);
    }
  }
  if (const auto sparse = description.find("sparse")) apply_sparse(accessor, element_size, *sparse);
  return accessor;
}

void GltfBuffers::apply_sparse(Accessor& accessor, std::size_t element_size, const GltfValue& sparse) {
  const std::uint64_t count = sparse.member("count").whole(accessor.count);
  const auto part = [&](const char* key, std::uint64_t size) {
    const GltfValue description = sparse.member(key);
    const GltfValue view_index = description.member("bufferView");
    const auto bytes = view(view_index.whole(1u << 30), view_index);
    const auto offset_value = description.find("byteOffset");
    const std::uint64_t offset = offset_value ? offset_value->whole(kMostBytes) : 0;
    if (offset > bytes.size() || count * size > bytes.size() - offset) {
      description.fail("reaches past its bufferView");
    }
    return bytes.subspan(offset, count * size);
  };
  const GltfValue type_value = sparse.member("indices").member("componentType");
  const auto type = static_cast<int>(type_value.whole(kFloat));
  if (type != kUnsignedByte && type != kUnsignedShort && type != kUnsignedInt) {
    type_value.fail("is none of 5121, 5123, 5125");
  }
  const auto indices = part("indices", component_size(type));
  const auto values = part("values", element_size);
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::byte* at = indices.data() + i * component_size(type);
    const std::uint32_t index = type == kUnsignedByte    ? load<std::uint8_t>(at)
                                : type == kUnsignedShort ? load<std::uint16_t>(at)
                                                         : load<std::uint32_t>(at);
    if (index >= accessor.count) {
      sparse.fail("index " + std::to_string(index) + " is out of range: there are " +
                  std::to_string(accessor.count) + " elements");
    }
    std::memcpy(accessor.packed.data() + index * element_size, values.data() + i * element_size,
                element_size);
  }
}

std::vector<float> GltfBuffers::floats(std::uint64_t index, std::size_t components, const GltfValue& asker) {
  const Accessor accessor = read_accessor(index, asker);
  if (accessor.components != components) {
    asker.fail("expected an accessor of VEC" + std::to_string(components));
  }
  const std::size_t size = component_size(accessor.component_type);
  std::vector<float> values(accessor.count * components);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = component(accessor.packed.data() + i * size, accessor.component_type, accessor.normalized);
    if (!std::isfinite(values[i])) {
      asker.fail("element " + std::to_string(i / components) + " of accessors[" + std::to_string(index) +
                 "] is not finite; repair the mesh");
    }
  }
  return values;
}

std::vector<std::uint32_t> GltfBuffers::indices(std::uint64_t index, const GltfValue& asker) {
  const Accessor accessor = read_accessor(index, asker);
  const int type = accessor.component_type;
  if (accessor.components != 1 || (type != kUnsignedByte && type != kUnsignedShort && type != kUnsignedInt)) {
    asker.fail("expected a SCALAR accessor of unsigned integers");
  }
  std::vector<std::uint32_t> values(accessor.count);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::byte* at = accessor.packed.data() + i * component_size(type);
    values[i] = type == kUnsignedByte    ? load<std::uint8_t>(at)
                : type == kUnsignedShort ? load<std::uint16_t>(at)
                                         : load<std::uint32_t>(at);
  }
  return values;
}

}  // namespace brume::scene
