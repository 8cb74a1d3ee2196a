// The C interface of the smoke's textures (brume_textures.h) for C++17, as brume.hpp is for brume.h.
//
//   brume::api::Textures textures(field);
//   textures.update(field, seconds);
//   for (const brume_region& region : textures.regions()) upload(region);
#ifndef BRUME_BRUME_TEXTURES_HPP
#define BRUME_BRUME_TEXTURES_HPP

#include <brume/brume_textures.h>

#include <array>
#include <brume/brume.hpp>
#include <vector>

namespace brume::api {

/// A brume_textures.
class Textures : public detail::Handle<brume_textures, brume_textures_destroy> {
 public:
  /// brume_textures_create.
  explicit Textures(const Field& field, const brume_textures_params& params = brume_textures_defaults())
      : Handle(detail::created<brume_textures>(
            [&](brume_textures** out) { return brume_textures_create(field.get(), &params, out); })) {}

  /// brume_textures_update.
  void update(const Field& field, const brume_textures_frame& frame) {
    check(brume_textures_update(get(), field.get(), &frame));
  }
  /// The same with the defaults at a time.
  void update(const Field& field, double seconds) {
    brume_textures_frame frame = brume_textures_frame_defaults();
    frame.seconds = seconds;
    update(field, frame);
  }
  /// The textures, by their brume_texture_kind.
  std::array<brume_texture, BRUME_TEXTURE_COUNT> list() const {
    std::array<brume_texture, BRUME_TEXTURE_COUNT> list{};
    check(brume_textures_list(get(), list.data(), list.size()));
    return list;
  }
  /// The regions that the last update changed. Their texels are valid until the next one.
  std::vector<brume_region> regions() const {
    const brume_region* first = nullptr;
    std::size_t count = 0;
    check(brume_textures_regions(get(), &first, &count));
    return {first, first + count};
  }
  /// brume_constants of the shader.
  std::array<float, BRUME_CONSTANTS> constants() const {
    std::array<float, BRUME_CONSTANTS> constants{};
    check(brume_textures_constants(get(), constants.data(), constants.size()));
    return constants;
  }
};

}  // namespace brume::api

#endif  // BRUME_BRUME_TEXTURES_HPP
