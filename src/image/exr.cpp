#include "image/exr.hpp"

#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <cstdio>
#include <cstring>

#include "core/file.hpp"
#include "core/hash.hpp"
#include "image/formats.hpp"

namespace brume::image {
namespace {

constexpr const char* kChecksum = "Brume checksum";

// Where OpenEXR writes: it returns to the table of offsets when all blocks are written.
class MemoryOut : public Imf::OStream {
 public:
  explicit MemoryOut(const std::string& name) : Imf::OStream(name.c_str()) {}
  void write(const char from[], int count) override {
    const auto length = static_cast<std::size_t>(count);
    bytes_.resize(std::max(bytes_.size(), at_ + length));
    std::memcpy(bytes_.data() + at_, from, length);
    at_ += length;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t at) override { at_ = static_cast<std::size_t>(at); }
  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
  std::size_t at_ = 0;
};

class MemoryIn : public Imf::IStream {
 public:
  MemoryIn(std::span<const std::byte> bytes, const std::string& name)
      : Imf::IStream(name.c_str()), bytes_(bytes) {}
  bool read(char to[], int count) override {
    const auto length = static_cast<std::uint64_t>(count);
    // Only a damaged offset leads beyond the end; a file that ends early ends within what is read.
    if (count < 0 || at_ > bytes_.size()) throw IEX_NAMESPACE::InputExc("an offset is damaged");
    if (length > bytes_.size() - at_) throw IEX_NAMESPACE::InputExc("it is truncated");
    std::memcpy(to, bytes_.data() + at_, length);
    at_ += length;
    end_ = std::max(end_, at_);
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t at) override { at_ = at; }
  /// Where the last byte that was read ends.
  std::uint64_t end() const { return end_; }

 private:
  std::span<const std::byte> bytes_;
  std::uint64_t at_ = 0, end_ = 0;
};

Imf::PixelType type_of(const Layer& layer) {
  return layer.values.index() == 0 ? Imf::HALF : Imf::FLOAT;
}

std::span<const std::byte> bytes_of(const Layer& layer) {
  return std::visit([](const auto& values) { return std::as_bytes(std::span(values)); }, layer.values);
}

// Slices of all layers, for reading and writing.
Imf::FrameBuffer make_slices(const LayeredImage& image) {
  Imf::FrameBuffer slices;
  for (const Layer& layer : image.layers) {
    const std::size_t texel = type_of(layer) == Imf::HALF ? 2 : 4;
    // One type of slice serves both directions; OutputFile does not write to it.
    char* const begin = reinterpret_cast<char*>(const_cast<std::byte*>(bytes_of(layer).data()));
    slices.insert(layer.name, Imf::Slice(type_of(layer), begin, texel, texel * image.width));
  }
  return slices;
}

// A hash of all values: most damage of a file does not make it unreadable.
std::string checksum_of(const LayeredImage& image) {
  std::vector<const Layer*> sorted;
  for (const Layer& layer : image.layers) sorted.push_back(&layer);
  std::sort(sorted.begin(), sorted.end(), [](const Layer* a, const Layer* b) { return a->name < b->name; });
  std::uint64_t hash = 0;
  for (const Layer* layer : sorted) hash = hash_bytes(bytes_of(*layer), hash);
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

Failure is_bad(const std::string& name, const std::string& why) {
  return {ErrorCode::bad_input, name + ": cannot read the OpenEXR image: " + why};
}

// Runs a reader; exceptions of OpenEXR become failures.
template <typename T, typename Read>
Result<T> reading(const std::string& name, Read read) {
  // The library refuses larger windows before it allocates for them.
  Imf::Header::setMaxImageSize(static_cast<int>(kMaxAxis), static_cast<int>(kMaxAxis));
  try {
    return read();
  } catch (const std::exception& e) {
    // Some messages span lines.
    std::string why = e.what();
    std::replace(why.begin(), why.end(), '\n', ' ');
    return is_bad(name, why);
  }
}

ExrPart part_of(const Imf::Header& header) {
  ExrPart part;
  if (header.hasName()) part.name = header.name();
  const Imath::V2i size = header.dataWindow().size() + Imath::V2i(1);
  part.width = static_cast<std::uint32_t>(size.x);
  part.height = static_cast<std::uint32_t>(size.y);
  for (auto at = header.channels().begin(); at != header.channels().end(); ++at) {
    const Imf::PixelType type = at.channel().type;
    part.channels.push_back({at.name(), type == Imf::HALF ? "half" : type == Imf::FLOAT ? "float" : "uint"});
  }
  for (auto at = header.begin(); at != header.end(); ++at)
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&at.attribute()))
      part.texts.push_back({at.name(), text->value()});
  return part;
}

Result<LayeredImage> read_layers(Imf::InputFile& file, const std::string& name) {
  const Imf::Header& header = file.header();
  const ExrPart part = part_of(header);
  if (auto size = check_size(part.width, part.height, name); !size) return size.failure();

  // Memory for the layers.
  LayeredImage image{part.width, part.height, {}};
  const std::size_t count = std::size_t{image.width} * image.height;
  for (auto at = header.channels().begin(); at != header.channels().end(); ++at) {
    const Imf::Channel& channel = at.channel();
    if (channel.type == Imf::UINT || channel.xSampling != 1 || channel.ySampling != 1)
      return is_bad(name, std::string("the channel ") + at.name() + " is not of floats at every pixel");
    Layer& layer = image.layers.emplace_back(Layer{at.name(), std::vector<std::uint16_t>()});
    if (channel.type == Imf::HALF) {
      layer.values = std::vector<std::uint16_t>(count);
    } else {
      layer.values = std::vector<float>(count);
    }
  }

  // The values; slices count from pixel (0, 0), the window may begin elsewhere.
  const Imath::Box2i window = header.dataWindow();
  Imf::FrameBuffer slices = make_slices(image);
  for (auto at = slices.begin(); at != slices.end(); ++at)
    at.slice().base -= static_cast<std::ptrdiff_t>(at.slice().xStride) * window.min.x +
                       static_cast<std::ptrdiff_t>(at.slice().yStride) * window.min.y;
  file.setFrameBuffer(slices);
  file.readPixels(window.min.y, window.max.y);
  const auto* checksum = header.findTypedAttribute<Imf::StringAttribute>(kChecksum);
  if (checksum && checksum->value() != checksum_of(image)) return is_bad(name, "its values are damaged");
  return image;
}

}  // namespace

Result<void> save_exr(const std::filesystem::path& path, const LayeredImage& image,
                      const std::optional<ImageText>& text) {
  if (auto size = check_size(image.width, image.height, path.string()); !size) return size;
  Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const Layer& layer : image.layers) {
    BRUME_ASSERT(std::visit([](const auto& values) { return values.size(); }, layer.values) ==
                     std::size_t{image.width} * image.height,
                 layer.name);
    header.channels().insert(layer.name, Imf::Channel(type_of(layer)));
  }
  // Name the primaries of sRGB and Rec. 709: the format assumes them where none are named, but other programs
  // guess.
  Imf::addChromaticities(header, Imf::Chromaticities());
  header.insert(kChecksum, Imf::StringAttribute(checksum_of(image)));
  if (text) header.insert(text->keyword, Imf::StringAttribute(text->text));

  MemoryOut out(path.string());
  try {
    // Its destructor completes the table of offsets.
    Imf::OutputFile file(out, header);
    file.setFrameBuffer(make_slices(image));
    file.writePixels(static_cast<int>(image.height));
  } catch (const IEX_NAMESPACE::BaseExc& e) {
    return Failure{ErrorCode::internal, path.string() + ": cannot encode the OpenEXR image: " + e.what()};
  }
  return write_file_atomic(path, out.bytes());
}

Result<LayeredImage> decode_exr(std::span<const std::byte> bytes, const std::string& name) {
  return reading<LayeredImage>(name, [&]() -> Result<LayeredImage> {
    MemoryIn in(bytes, name);
    Imf::InputFile file(in);
    if (!file.isComplete()) return is_bad(name, "it is truncated");
    return read_layers(file, name);
  });
}

Result<std::uint64_t> exr_length(std::span<const std::byte> bytes, const std::string& name) {
  return reading<std::uint64_t>(name, [&]() -> Result<std::uint64_t> {
    MemoryIn in(bytes, name);
    Imf::InputFile file(in);
    if (!file.isComplete()) return is_bad(name, "it is truncated");
    if (const auto image = read_layers(file, name); !image) return image.failure();
    return in.end();
  });
}

Result<std::vector<ExrPart>> decode_exr_parts(std::span<const std::byte> bytes, const std::string& name) {
  return reading<std::vector<ExrPart>>(name, [&]() -> Result<std::vector<ExrPart>> {
    MemoryIn in(bytes, name);
    Imf::MultiPartInputFile file(in, 0, false);
    std::vector<ExrPart> parts;
    for (int i = 0; i < file.parts(); ++i) parts.push_back(part_of(file.header(i)));
    return parts;
  });
}

}  // namespace brume::image
