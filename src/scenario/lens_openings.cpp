#include "scenario/lens_openings.hpp"

#include <algorithm>

#include "image/decode.hpp"
#include "scenario/shot_masks.hpp"

namespace brume::scenario {
namespace {

/// Which of the parts, given by their sums up to and with each, holds a share of the whole, and where in it
/// [0, 1).
template <typename Sum>
std::pair<std::size_t, float> part_at(const Sum* sums, std::size_t count, float share) {
  const double chosen = double{share} * static_cast<double>(sums[count - 1]);
  const Sum* const part = std::upper_bound(sums, sums + count - 1, chosen,
                                           [](double at, Sum sum) { return at < static_cast<double>(sum); });
  const double before = part == sums ? 0 : static_cast<double>(part[-1]);
  const double size = static_cast<double>(*part) - before;
  return {static_cast<std::size_t>(part - sums),
          size > 0 ? static_cast<float>(std::min((chosen - before) / size, 1.0)) : 0.5f};
}

Result<std::shared_ptr<const LensOpening>> load_opening(const std::filesystem::path& file) {
  const auto picture = image::load_image(file);
  if (!picture) return picture.failure();
  if (const std::uint32_t side = std::max(picture->width, picture->height); side > kMostOpeningTexels)
    return Failure{ErrorCode::resource_limit,
                   file.string() + ": " + std::to_string(picture->width) + " x " +
                       std::to_string(picture->height) + " texels; the opening of a lens has at most " +
                       std::to_string(kMostOpeningTexels) + " along each axis, make it smaller"};
  const auto mask = make_mask(*picture, file.string());
  if (!mask) return mask.failure();
  auto opening = LensOpening::create(*mask, file.string());
  if (!opening) return opening.failure();
  return std::make_shared<const LensOpening>(std::move(*opening));
}

}  // namespace

Result<LensOpening> LensOpening::create(const smoke::Mask& mask, const std::string& name) {
  LensOpening opening;
  opening.side_ = mask.width;
  std::uint64_t all = 0;
  for (std::uint32_t y = 0; y < mask.height; ++y) {
    std::uint32_t row = 0;
    for (std::uint32_t x = 0; x < mask.width; ++x)
      opening.texels_up_to_.push_back(row += mask.texels[std::size_t{y} * mask.width + x]);
    opening.rows_up_to_.push_back(all += row);
  }
  if (all == 0)
    return Failure{ErrorCode::bad_input,
                   name + ": lets no light through; expected an image with a part that is not black"};
  return opening;
}

glm::vec2 LensOpening::point(const glm::vec2& u) const {
  const auto [y, down] = part_at(rows_up_to_.data(), side_, u.y);
  const auto [x, right] = part_at(texels_up_to_.data() + y * side_, side_, u.x);
  const glm::vec2 at(static_cast<float>(x) + right, static_cast<float>(y) + down);
  return (at / static_cast<float>(side_) * 2.0f - 1.0f) * glm::vec2(1, -1);
}

Result<void> load_lens_openings(const scene::Timeline& timeline, LensOpenings& openings) {
  for (const scene::CameraKey& key : timeline.camera) {
    const std::filesystem::path& file = key.camera.lens.opening;
    if (file.empty() || openings.contains(file)) continue;
    auto opening = load_opening(file);
    if (!opening)
      return Failure{opening.failure().code,
                     (key.place.empty() ? "" : key.place + ": ") + opening.failure().message};
    openings[file] = std::move(*opening);
  }
  return {};
}

}  // namespace brume::scenario
