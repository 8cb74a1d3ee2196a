#include "scene/files/gltf_document.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "core/checked.hpp"
#include "core/log.hpp"
#include "scene/files/gltf_check.hpp"
#include "scene/files/gltf_meshopt.hpp"
#include "scene/files/gltf_rewrite.hpp"
#include "scene/text_reader.hpp"

namespace brume::scene {
namespace {

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
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return scaled(load<std::int8_t>(from));
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return scaled(load<std::uint8_t>(from));
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return scaled(load<std::int16_t>(from));
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return scaled(load<std::uint16_t>(from));
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return scaled(load<std::uint32_t>(from));
    default:
      return load<float>(from);
  }
}

bool is_index_type(int type) {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

std::uint32_t index_at(const std::byte* at, int type) {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE    ? load<std::uint8_t>(at)
         : type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? load<std::uint16_t>(at)
                                                          : load<std::uint32_t>(at);
}

std::size_t component_size(int type) {
  return static_cast<std::size_t>(
      std::max(0, tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type))));
}

/// File access for tinygltf, which reads all buffers in order before any image.
struct FileAccess {
  struct BufferFile {
    std::size_t buffer, bytes;
    std::string uri;
  };
  std::string name;
  const SceneFiles& files;
  std::vector<BufferFile> buffers;  ///< The buffers stored in separate files.
  std::size_t next = 0;
  std::string problem;  ///< The first failure; exceptions must not pass through tinygltf.

  FileAccess(const nlohmann::json& document, std::string name_of_document, const SceneFiles& scene_files)
      : name(std::move(name_of_document)), files(scene_files) {
    if (!document.contains("buffers")) return;
    const nlohmann::json& all = document["buffers"];
    for (std::size_t i = 0; i < all.size(); ++i) {
      const std::string uri = all[i].value("uri", "");
      const auto size = all[i]["byteLength"].get<std::size_t>();
      std::vector<unsigned char> decoded;
      std::string type;
      if (!uri.starts_with("data:")) {
        if (all[i].contains("uri")) buffers.push_back({i, size, uri});
      } else if (!tinygltf::DecodeDataURI(&decoded, type, uri, size, true)) {
        throw Error(ErrorCode::bad_input, name + ": buffers[" + std::to_string(i) +
                                              "].uri: expected a data: URI in base64 of " +
                                              std::to_string(size) + " bytes");
      }
    }
  }

  bool in_buffers() const { return next < buffers.size(); }
  std::string place() const {
    return name + ": " + (in_buffers() ? "buffers[" + std::to_string(buffers[next].buffer) + "]" : "images");
  }

  /// tinygltf decodes + as a blank, which is wrong for file names.
  std::optional<std::string> find(const std::string& file) const {
    const auto found = files.find(file);
    return found || !in_buffers() ? found : files.find(buffers[next].uri);
  }

  bool fail(const std::string& what) {
    if (problem.empty()) problem = place() + what;
    return false;
  }

  static bool exists(const std::string& file, void* user) {
    auto& self = *static_cast<FileAccess*>(user);
    if (!is_safe_relative(file) || file.find("://") != std::string::npos) {
      return self.fail(".uri: the file " + in_quotes(file) +
                       " is not below the scene's folder; move it there");
    }
    if (self.find(file)) return true;
    if (self.in_buffers())
      self.fail(".uri: the file " + in_quotes(file) + " does not exist below the scene's folder");
    return false;
  }

  static bool read(std::vector<unsigned char>* out, std::string*, const std::string& file, void* user) {
    auto& self = *static_cast<FileAccess*>(user);
    const auto bytes = self.files.read(*self.find(file));
    if (!bytes) return self.in_buffers() ? self.fail(".uri: " + bytes.failure().message) : false;
    std::size_t size = bytes->size();
    if (self.in_buffers()) {
      // tinygltf rejects files longer than the buffer; the format allows them.
      const std::size_t expected = self.buffers[self.next].bytes;
      if (size < expected) {
        return self.fail(": is truncated: expected " + std::to_string(expected) + " bytes, found " +
                         std::to_string(size));
      }
      size = expected;
      ++self.next;
    }
    const auto* first = reinterpret_cast<const unsigned char*>(bytes->data());
    out->assign(first, first + size);
    return true;
  }
};

bool keep_image(tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* bytes,
                int size, void*) {
  image->image.assign(bytes, bytes + size);
  return true;
}

/// The JSON of a GLB; tinygltf checks the rest of the container.
std::string_view json_of_glb(std::string_view glb, const std::string& name) {
  std::uint32_t version = 0, length = 0;
  if (glb.size() >= 8) std::memcpy(&version, glb.data() + 4, sizeof version);
  if (glb.size() >= 8 && version != 2) {
    throw Error(ErrorCode::bad_input,
                name + (version == 1 ? ": is glTF 1.0; convert it to 2.0"
                                     : ": is GLB of version " + std::to_string(version) + "; expected 2"));
  }
  if (glb.size() >= 20) std::memcpy(&length, glb.data() + 12, sizeof length);
  if (glb.size() < 20 || length > glb.size() - 20)
    throw Error(ErrorCode::bad_input, name + ": the GLB file is truncated; export or copy it again");
  if (length % 4 != 0)
    throw Error(ErrorCode::bad_input, name + ": the JSON chunk of the GLB file has " +
                                          std::to_string(length) +
                                          " bytes; expected a multiple of 4, filled up with blanks");
  const std::string_view json = glb.substr(20, length);
  if (const std::size_t start = json.find_first_not_of(" \t\r\n");
      start == std::string_view::npos || json[start] != '{')
    throw Error(ErrorCode::bad_input,
                name + ": the first chunk of the GLB file is no JSON; export or copy it again");
  return json;
}

/// Names the first node whose place is given twice; tinygltf drops what does not count.
void warn_of_nodes(const nlohmann::json& document, const std::string& name) {
  if (!document.contains("nodes")) return;
  std::size_t index = 0;
  for (const nlohmann::json& node : document["nodes"]) {
    const bool is_placed =
        node.contains("translation") || node.contains("rotation") || node.contains("scale");
    if (node.contains("matrix") && is_placed)
      return log_warning(name + ": nodes[" + std::to_string(index) +
                         "]: has a matrix, and a translation, rotation or scale; the matrix alone counts");
    ++index;
  }
}

}  // namespace

GltfDocument::GltfDocument(std::span<const std::byte> bytes, std::string name, const SceneFiles& files)
    : name_(std::move(name)) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.size() > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorCode::resource_limit, name_ + ": is larger than 4 GiB; split the scene");

  // Check the JSON, and set up access to files.
  const bool is_glb = text.starts_with("glTF");
  nlohmann::json document = checked_gltf_json(is_glb ? json_of_glb(text, name_) : text, name_);
  warn_of_nodes(document, name_);
  std::string rewritten;
  if (rewrite_for_tinygltf(document))
    rewritten = is_glb ? glb_with_json(text, document.dump()) : document.dump();
  const std::string_view input = rewritten.empty() ? text : rewritten;
  FileAccess access(document, name_, files);

  tinygltf::TinyGLTF reader;
  reader.SetFsCallbacks({&FileAccess::exists, [](const std::string& file, void*) { return file; },
                         &FileAccess::read, nullptr, &access});
  reader.SetImageLoader(keep_image, nullptr);

  // Load, and report the first problem.
  std::string error, warning;
  const auto size = static_cast<std::uint32_t>(input.size());
  bool loaded = false;
  try {
    loaded = is_glb ? reader.LoadBinaryFromMemory(&model_, &error, &warning,
                                                  reinterpret_cast<const unsigned char*>(input.data()), size)
                    : reader.LoadASCIIFromString(&model_, &error, &warning, input.data(), size, "");
  } catch (const std::out_of_range&) {
    error = "expected a buffer with bytes";
  }
  if (!access.problem.empty()) throw Error(ErrorCode::bad_input, access.problem);
  if (loaded && error.empty()) return;
  throw Error(ErrorCode::bad_input, name_ + ": is not valid glTF 2.0" +
                                        (error.empty() ? "" : ": " + in_quotes(error)) +
                                        "; export or copy it again");
}

std::string GltfDocument::place(const char* path, std::size_t index) const {
  return name_ + ": " + path + "[" + std::to_string(index) + "]";
}

void GltfDocument::fail(const std::string& place, const std::string& what) const {
  throw Error(ErrorCode::bad_input, place + ": " + what);
}

std::span<const std::byte> GltfDocument::view(int index) const {
  const tinygltf::BufferView& view = model_.bufferViews[static_cast<std::size_t>(index)];
  if (view.extensions.contains("EXT_meshopt_compression")) return decompressed(index);
  return std::as_bytes(std::span(model_.buffers[static_cast<std::size_t>(view.buffer)].data))
      .subspan(view.byteOffset, view.byteLength);
}

std::span<const std::byte> GltfDocument::decompressed(int index) const {
  if (const auto known = decompressed_.find(index); known != decompressed_.end()) return known->second;
  const auto at = static_cast<std::size_t>(index);
  const tinygltf::BufferView& view = model_.bufferViews[at];
  const tinygltf::Value& extension = view.extensions.at("EXT_meshopt_compression");
  const auto number = [&](const char* member) {
    return extension.Has(member) ? static_cast<std::size_t>(extension.Get(member).GetNumberAsInt()) : 0;
  };
  const auto text = [&](const char* member, const char* otherwise) {
    return extension.Has(member) ? extension.Get(member).Get<std::string>() : otherwise;
  };
  const std::string here = place("bufferViews", at) + ".extensions.EXT_meshopt_compression";

  // The size follows from the parameters: check it before memory is allocated for it.
  MeshoptView source{{}, number("count"), number("byteStride"), text("mode", ""), text("filter", "NONE")};
  if (source.count * source.byte_stride != view.byteLength)
    fail(here, "count and byteStride do not give the byteLength of the bufferView");
  decompressed_bytes_ += view.byteLength;
  if (decompressed_bytes_ > kMostDecompressedBytes)
    throw Error(ErrorCode::resource_limit, here + ": the document holds more than 4 GiB; split the scene");

  source.compressed = std::as_bytes(std::span(model_.buffers[number("buffer")].data))
                          .subspan(number("byteOffset"), number("byteLength"));
  return decompressed_[index] = decode_meshopt(source, here);
}

PackedElements GltfDocument::packed(std::size_t index) const {
  // The element type.
  const tinygltf::Accessor& accessor = model_.accessors[index];
  const std::string here = place("accessors", index);
  const std::size_t size = component_size(accessor.componentType);
  const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
  if (size == 0 || accessor.componentType == TINYGLTF_COMPONENT_TYPE_INT)
    fail(here + ".componentType", "is none of 5120-5123, 5125, 5126");
  const bool is_matrix =
      accessor.type == TINYGLTF_TYPE_MAT4 && accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT;
  if ((components > 4 && !is_matrix) || accessor.type == TINYGLTF_TYPE_MAT2)
    fail(here + ".type", "is none of SCALAR, VEC2, VEC3, VEC4 and, with floats, MAT4");
  const std::size_t element_size = size * static_cast<std::size_t>(components);

  // The elements: zeros, or gathered from the buffer view.
  PackedElements elements{accessor.componentType, components, {}};
  std::vector<std::byte>& result = elements.bytes;
  if (accessor.bufferView < 0) {
    if (accessor.count > kMostZeroElements) fail(here, "has too many elements without a bufferView");
    result.assign(accessor.count * element_size, std::byte{0});
  } else {
    const auto bytes = view(accessor.bufferView);
    const std::size_t given = model_.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;
    const std::size_t stride = given == 0 ? element_size : given;
    if (stride < element_size) fail(here, "the byteStride of its bufferView is shorter than one element");
    const auto steps = checked_mul(std::uint64_t{stride}, std::uint64_t{accessor.count - 1});
    const auto end =
        steps ? checked_add(*steps, std::uint64_t{accessor.byteOffset + element_size}) : std::nullopt;
    if (!end || *end > bytes.size()) {
      fail(here, "reaches past its bufferView: " + std::to_string(accessor.count) + " elements of " +
                     std::to_string(element_size) + " bytes from byte " +
                     std::to_string(accessor.byteOffset) + " do not fit into " +
                     std::to_string(bytes.size()));
    }
    result.resize(accessor.count * element_size);
    for (std::size_t i = 0; i < accessor.count; ++i) {
      std::memcpy(result.data() + i * element_size, bytes.data() + accessor.byteOffset + i * stride,
                  element_size);
    }
  }
  if (accessor.sparse.isSparse) apply_sparse(accessor, element_size, here + ".sparse", result);
  return elements;
}

void GltfDocument::apply_sparse(const tinygltf::Accessor& accessor, std::size_t element_size,
                                const std::string& here, std::vector<std::byte>& packed) const {
  const auto& sparse = accessor.sparse;
  const auto count = static_cast<std::size_t>(sparse.count);
  if (count > accessor.count) fail(here + ".count", "is more than the accessor has elements");
  const auto part = [&](int view_index, int byte_offset, std::size_t size) {
    const auto bytes = view(view_index);
    const auto offset = static_cast<std::size_t>(byte_offset);
    if (offset > bytes.size() || count * size > bytes.size() - offset)
      fail(here, "reaches past its bufferView");
    return bytes.subspan(offset, count * size);
  };

  // Overwrite the listed elements.
  const int type = sparse.indices.componentType;
  if (!is_index_type(type)) fail(here + ".indices.componentType", "is none of 5121, 5123, 5125");
  const auto indices = part(sparse.indices.bufferView, sparse.indices.byteOffset, component_size(type));
  const auto values = part(sparse.values.bufferView, sparse.values.byteOffset, element_size);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t index = index_at(indices.data() + i * component_size(type), type);
    if (index >= accessor.count) {
      fail(here, "index " + std::to_string(index) + " is out of range: there are " +
                     std::to_string(accessor.count) + " elements");
    }
    std::memcpy(packed.data() + index * element_size, values.data() + i * element_size, element_size);
  }
}

std::vector<float> GltfDocument::floats(int index, int components, const std::string& user) const {
  const auto at = static_cast<std::size_t>(index);
  if (model_.accessors[at].type != (components == 16 ? TINYGLTF_TYPE_MAT4 : components))
    fail(user, components == 16 ? "expected an accessor of MAT4"
                                : "expected an accessor of VEC" + std::to_string(components));
  return floats(index, packed(at), components, user);
}

std::vector<float> GltfDocument::floats(int index, const PackedElements& elements, int components,
                                        const std::string& user) const {
  if (elements.components != components)
    fail(user, "expected elements of " + std::to_string(components) + " components");
  const bool normalized = model_.accessors[static_cast<std::size_t>(index)].normalized;
  const std::size_t size = component_size(elements.component_type);
  std::vector<float> values(elements.bytes.size() / size);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = component(elements.bytes.data() + i * size, elements.component_type, normalized);
    if (!std::isfinite(values[i])) {
      fail(user, "element " + std::to_string(i / static_cast<std::size_t>(components)) + " of accessors[" +
                     std::to_string(index) + "] is not finite; repair the mesh");
    }
  }
  return values;
}

std::vector<std::uint32_t> GltfDocument::indices(int index, const std::string& user) const {
  const auto at = static_cast<std::size_t>(index);
  const tinygltf::Accessor& accessor = model_.accessors[at];
  const int type = accessor.componentType;
  if (accessor.type != TINYGLTF_TYPE_SCALAR || !is_index_type(type))
    fail(user, "expected a SCALAR accessor of unsigned integers");
  const std::vector<std::byte> bytes = packed(at).bytes;
  std::vector<std::uint32_t> values(accessor.count);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = index_at(bytes.data() + i * component_size(type), type);
  return values;
}

}  // namespace brume::scene
