#include "scene/files/gltf_draco.hpp"

#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace brume::scene {
namespace {

/// Decoding allocates memory by declared counts before it sees the data behind them. Limits on that memory: a
/// flat grid of 1,000,000 triangles, which compresses best, needs about 4 KiB per compressed byte.
constexpr std::uint64_t kMostBytes = std::uint64_t{4} << 30, kAlwaysAllowedBytes = std::uint64_t{64} << 20,
                        kMostBytesPerByte = 16384;
/// About what the library's tables take. An attribute with several values at a vertex has a table of seams.
constexpr std::uint64_t kBytesPerTriangle = 48, kBytesPerVertex = 32, kSeamBytesPerTriangle = 32;

struct Limits {
  std::uint64_t vertices, triangles, bytes;
};

/// A decoder of the library that refuses declared counts above the limits.
template <typename Decoder>
class LimitedDecoder : public Decoder {
 public:
  explicit LimitedDecoder(const Limits& limits) : limits_(limits) {}
  bool too_large() const { return too_large_; }

 protected:
  bool DecodeConnectivity() override {
    constexpr bool kEdgebreaker = std::is_same_v<Decoder, draco::MeshEdgebreakerDecoder>;
    draco::DecoderBuffer ahead = *this->buffer();
    std::uint32_t first = 0, second = 0;
    std::uint8_t seam_tables = 0;
    if (!draco::DecodeVarint(&first, &ahead) || !draco::DecodeVarint(&second, &ahead)) return false;
    if (kEdgebreaker && !ahead.Decode(&seam_tables)) return false;
    const std::uint64_t vertices = kEdgebreaker ? first : second, triangles = kEdgebreaker ? second : first;
    const std::uint64_t bytes =
        triangles * (kBytesPerTriangle + kSeamBytesPerTriangle * seam_tables) + vertices * kBytesPerVertex;
    too_large_ = vertices > limits_.vertices || triangles > limits_.triangles || bytes > limits_.bytes;
    if (too_large_) return false;
    if (!Decoder::DecodeConnectivity()) return false;
    // Vertices on seams of an attribute are split while the connectivity is decoded.
    too_large_ = this->mesh()->num_points() > limits_.vertices;
    return !too_large_;
  }

  /// Called when the attributes are declared and before their values are allocated.
  bool DecodeAllAttributes() override {
    std::uint64_t bytes = 0;  // Per vertex; some steps hold values as 32 bits.
    for (int i = 0; i < this->mesh()->num_attributes(); ++i) {
      const draco::PointAttribute& attribute = *this->mesh()->attribute(i);
      bytes += std::uint64_t{attribute.num_components()} *
               static_cast<std::uint64_t>(std::max(draco::DataTypeLength(attribute.data_type()), 4));
    }
    too_large_ = bytes * this->mesh()->num_points() > limits_.bytes;
    return !too_large_ && Decoder::DecodeAllAttributes();
  }

 private:
  Limits limits_;
  bool too_large_ = false;
};

int gltf_type(draco::DataType type) {
  switch (type) {
    case draco::DT_INT8:
      return TINYGLTF_COMPONENT_TYPE_BYTE;
    case draco::DT_UINT8:
      return TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
    case draco::DT_INT16:
      return TINYGLTF_COMPONENT_TYPE_SHORT;
    case draco::DT_UINT16:
      return TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
    case draco::DT_UINT32:
      return TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    case draco::DT_FLOAT32:
      return TINYGLTF_COMPONENT_TYPE_FLOAT;
    default:
      return 0;
  }
}

class DracoReader {
 public:
  DracoReader(std::span<const std::byte> bytes, std::uint64_t most_vertices, std::uint64_t most_triangles,
              const std::string& place)
      : bytes_(bytes),
        limits_{most_vertices, most_triangles,
                std::min(kMostBytes, kAlwaysAllowedBytes + kMostBytesPerByte * bytes.size())},
        place_(place) {}

  DracoMesh read() {
    const draco::DracoHeader header = read_header();
    if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING)
      decode<draco::MeshEdgebreakerDecoder>();
    else
      decode<draco::MeshSequentialDecoder>();

    DracoMesh result;
    result.vertices = mesh_.num_points();
    for (draco::FaceIndex face(0); face < mesh_.num_faces(); ++face) {
      for (const draco::PointIndex& corner : mesh_.face(face)) {
        if (corner.value() >= result.vertices) fail("a triangle refers to a vertex that does not exist");
        result.corners.push_back(corner.value());
      }
    }
    for (int i = 0; i < mesh_.num_attributes(); ++i) read_attribute(*mesh_.attribute(i), result);
    return result;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::bad_input, place_ + ": the Draco mesh cannot be read: " + what);
  }

  draco::DecoderBuffer buffer() const {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
    return buffer;
  }

  draco::DracoHeader read_header() const {
    draco::DecoderBuffer start = buffer();
    draco::DracoHeader header{};
    if (!draco::PointCloudDecoder::DecodeHeader(&start, &header).ok()) fail("it has no header of Draco");
    if (header.encoder_type != draco::TRIANGULAR_MESH) fail("it is a point cloud");
    if (header.version_major != 2 || header.version_minor != 2) {
      fail("expected version 2.2, found " + std::to_string(header.version_major) + "." +
           std::to_string(header.version_minor));
    }
    if (header.encoder_method > draco::MESH_EDGEBREAKER_ENCODING) fail("its method is unknown");
    return header;
  }

  template <typename Decoder>
  void decode() {
    LimitedDecoder<Decoder> decoder(limits_);
    draco::DecoderBuffer data = buffer();
    const draco::DecoderOptions options;
    draco::Status status;
    try {
      status = decoder.Decode(options, &data, &mesh_);
    } catch (const std::length_error&) {
      fail("a size in it is out of range");
    }
    if (decoder.too_large()) {
      fail("it declares more than its accessors and its " + std::to_string(bytes_.size()) + " bytes allow");
    }
    if (!status.ok())
      fail(status.error_msg_string().empty() ? "its data is damaged" : status.error_msg_string());
  }

  void read_attribute(const draco::PointAttribute& attribute, DracoMesh& result) const {
    PackedElements elements;
    elements.component_type = gltf_type(attribute.data_type());
    elements.components = attribute.num_components();
    if (elements.component_type == 0) return;
    if (!attribute.is_mapping_identity() && attribute.indices_map_size() < result.vertices)
      fail("an attribute lacks values");
    const auto size = static_cast<std::size_t>(draco::DataTypeLength(attribute.data_type())) *
                      static_cast<std::size_t>(elements.components);
    elements.bytes.resize(size * result.vertices);
    for (std::uint32_t i = 0; i < result.vertices; ++i) {
      const draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(i));
      if (value.value() >= attribute.size()) fail("a vertex refers to a value that does not exist");
      std::memcpy(elements.bytes.data() + i * size, attribute.GetAddress(value), size);
    }
    result.attributes[attribute.unique_id()] = std::move(elements);
  }

  std::span<const std::byte> bytes_;
  Limits limits_;
  const std::string& place_;
  draco::Mesh mesh_;
};

}  // namespace

DracoMesh decode_draco(std::span<const std::byte> bytes, std::uint64_t most_vertices,
                       std::uint64_t most_corners, const std::string& place) {
  return DracoReader(bytes, most_vertices, most_corners / 3, place).read();
}

}  // namespace brume::scene
