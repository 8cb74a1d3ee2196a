#include "scene/files/gltf_meshopt.hpp"

#include <meshoptimizer.h>

#include "core/checked.hpp"
#include "core/error.hpp"
#include "scene/text_reader.hpp"

namespace brume::scene {
namespace {

/// No codec of the extension expands its bytes more than this. The vertex codec comes closest: it stores 16
/// equal bytes in 2 bits.
constexpr std::uint64_t kMostInflation = 64;

class Decoder {
 public:
  Decoder(const MeshoptView& view, const std::string& place) : view_(view), place_(place) {}

  std::vector<std::byte> decode() const {
    check_parameters();
    const auto size = checked_mul(view_.count, view_.byte_stride);
    if (!size || *size / kMostInflation > view_.compressed.size()) {
      fail("count", std::to_string(view_.count) + " elements cannot be compressed to " +
                        std::to_string(view_.compressed.size()) + " bytes");
    }
    std::vector<std::byte> elements(*size);
    if (decode_stream(elements.data()) != 0)
      throw Error(ErrorCode::bad_input, place_ + ": the compressed data is damaged; export it again");
    apply_filter(elements.data());
    return elements;
  }

 private:
  [[noreturn]] void fail(const char* member, const std::string& what) const {
    throw Error(ErrorCode::bad_input, place_ + "." + member + ": " + what);
  }

  /// The library asserts these instead of reporting them.
  void check_parameters() const {
    const std::uint64_t stride = view_.byte_stride;
    const bool is_index = view_.mode == "TRIANGLES" || view_.mode == "INDICES";
    if (!is_index && view_.mode != "ATTRIBUTES")
      fail("mode", "expected ATTRIBUTES, TRIANGLES or INDICES, found " + in_quotes(view_.mode));
    if (is_index ? stride != 2 && stride != 4 : stride == 0 || stride % 4 != 0 || stride > 256) {
      fail("byteStride", std::string("expected ") + (is_index ? "2 or 4" : "a multiple of 4, at most 256") +
                             " for " + view_.mode);
    }
    if (view_.mode == "TRIANGLES" && view_.count % 3 != 0) fail("count", "expected a multiple of 3");

    const std::string& filter = view_.filter;
    if (filter == "NONE") return;
    if (filter != "OCTAHEDRAL" && filter != "QUATERNION" && filter != "EXPONENTIAL")
      fail("filter", "expected NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL, found " + in_quotes(filter));
    const bool fits =
        filter == "OCTAHEDRAL" ? stride == 4 || stride == 8 : filter != "QUATERNION" || stride == 8;
    if (is_index || !fits) fail("filter", filter + " does not fit the mode and the byteStride");
  }

  int decode_stream(std::byte* into) const {
    const auto* bytes = reinterpret_cast<const unsigned char*>(view_.compressed.data());
    const std::size_t size = view_.compressed.size();
    if (view_.mode == "ATTRIBUTES")
      return meshopt_decodeVertexBuffer(into, view_.count, view_.byte_stride, bytes, size);
    if (view_.mode == "TRIANGLES")
      return meshopt_decodeIndexBuffer(into, view_.count, view_.byte_stride, bytes, size);
    return meshopt_decodeIndexSequence(into, view_.count, view_.byte_stride, bytes, size);
  }

  void apply_filter(std::byte* elements) const {
    if (view_.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(elements, view_.count, view_.byte_stride);
    if (view_.filter == "QUATERNION") meshopt_decodeFilterQuat(elements, view_.count, view_.byte_stride);
    if (view_.filter == "EXPONENTIAL") meshopt_decodeFilterExp(elements, view_.count, view_.byte_stride);
  }

  const MeshoptView& view_;
  const std::string& place_;
};

}  // namespace

std::vector<std::byte> decode_meshopt(const MeshoptView& view, const std::string& place) {
  return Decoder(view, place).decode();
}

}  // namespace brume::scene
