#include <csetjmp>
#include <cstdio>
// jpeglib.h needs size_t and FILE declared before it.
#include <jpeglib.h>

#include <jerror.h>

#include "image/formats.hpp"

namespace brume::image {
namespace {

// A small progressive file can request any number of passes over all texels.
constexpr int kMaxScans = 200;

// libjpeg reports errors by a function that must not return: it jumps back to the start of decoding.
// Everything that owns memory lives in this struct, outside of the stack frames that the jump discards.
struct Decoder {
  jpeg_decompress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg_progress_mgr progress{};
  std::jmp_buf start;
  char message[JMSG_LENGTH_MAX] = {};
  const char* reason = nullptr;  // Set when the failure is ours, not libjpeg's.
  Image8 image;
  Result<void> size;

  Decoder() = default;
  Decoder(const Decoder&) = delete;
  ~Decoder() { jpeg_destroy_decompress(&jpeg); }
};

Decoder& decoder_of(j_common_ptr common) {
  return *static_cast<Decoder*>(common->client_data);
}

[[noreturn]] void fail(j_common_ptr common) {
  Decoder& decoder = decoder_of(common);
  common->err->format_message(common, decoder.message);
  std::longjmp(decoder.start, 1);
}

// Warnings about missing data become errors: libjpeg would fill the gap with grey and continue.
void on_message(j_common_ptr common, int level) {
  if (level >= 0) return;
  const int code = common->err->msg_code;
  if (code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER) fail(common);
}

void on_progress(j_common_ptr common) {
  Decoder& decoder = decoder_of(common);
  if (decoder.jpeg.input_scan_number <= kMaxScans) return;
  decoder.reason = "it has too many scans";
  std::longjmp(decoder.start, 1);
}

// Decodes the whole picture, or sets `size` to a failure, or jumps. No local that is alive while libjpeg runs
// may own anything: longjmp runs no destructors.
[[gnu::noinline]] void decode_rows(Decoder& decoder, std::span<const std::byte> bytes,
                                   const std::string& name) {
  jpeg_decompress_struct* jpeg = &decoder.jpeg;
  jpeg_create_decompress(jpeg);
  jpeg->client_data = &decoder;
  jpeg->progress = &decoder.progress;
  jpeg_mem_src(jpeg, reinterpret_cast<const unsigned char*>(bytes.data()),
               static_cast<unsigned long>(bytes.size()));
  jpeg_read_header(jpeg, TRUE);
  decoder.size = check_size(jpeg->image_width, jpeg->image_height, name);
  if (!decoder.size) return;

  jpeg->out_color_space = JCS_EXT_RGBA;
  jpeg_start_decompress(jpeg);
  decoder.image.width = jpeg->output_width;
  decoder.image.height = jpeg->output_height;
  decoder.image.rgba.resize(std::size_t{jpeg->output_width} * jpeg->output_height * 4);
  while (jpeg->output_scanline < jpeg->output_height) {
    JSAMPROW row = decoder.image.rgba.data() + std::size_t{jpeg->output_scanline} * jpeg->output_width * 4;
    jpeg_read_scanlines(jpeg, &row, 1);
  }
  jpeg_finish_decompress(jpeg);
}

// False when libjpeg failed. Separate from decode_rows, so that the stack frame of setjmp has no locals that
// the jump could clobber.
bool try_to_decode(Decoder& decoder, std::span<const std::byte> bytes, const std::string& name) {
  if (setjmp(decoder.start) != 0) return false;
  decode_rows(decoder, bytes, name);
  return true;
}

}  // namespace

Result<Image8> decode_jpeg(std::span<const std::byte> bytes, const std::string& name) {
  Decoder decoder;
  decoder.jpeg.err = jpeg_std_error(&decoder.errors);
  decoder.jpeg.client_data = &decoder;
  decoder.errors.error_exit = fail;
  decoder.errors.emit_message = on_message;
  decoder.progress.progress_monitor = on_progress;
  const bool decoded = try_to_decode(decoder, bytes, name);
  if (!decoder.size) return decoder.size.failure();
  if (decoded) return std::move(decoder.image);
  return Failure{ErrorCode::bad_input, name + ": not a complete, supported JPEG file: " +
                                           (decoder.reason ? decoder.reason : decoder.message)};
}

}  // namespace brume::image
