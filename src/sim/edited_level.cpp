#include "sim/edited_level.hpp"

#include <array>

namespace brume::sim {
namespace {

/// The bits of an edit that are set in `within`.
EditBlock part_of(const EditBlock& edit, std::uint64_t within) {
  return {edit.at, edit.make_solid & within, edit.make_free & within, edit.make_glass & within,
          edit.make_grille & within};
}

}  // namespace

EditedLevel::Grids& EditedLevel::grids() {
  if (!now_) {
    now_.emplace(Grids{loaded_.smoke, {}});
    if (&loaded_.sight != &loaded_.smoke) now_->roles.sight = loaded_.sight;
    if (&loaded_.bodies != &loaded_.smoke) now_->roles.bodies = loaded_.bodies;
  }
  return *now_;
}

void EditedLevel::add(const EditBlocks& more) {
  auto& [grid, roles] = grids();
  apply_edits(grid, roles, more);
  edits_ = std::make_shared<const EditBlocks>(edits_ ? merge_edits(*edits_, more) : more);
}

void EditedLevel::replace(const std::shared_ptr<const EditBlocks>& edits) {
  if (edits == edits_) return;
  for_each_difference(edits_.get(), edits.get(), [&](const EditBlock& was, const EditBlock& is) {
    // The level as loaded where the block is no longer edited.
    const EditBlock content = merge_edits(content_of(loaded_, glm::ivec3(is.at)), is);
    auto& [grid, roles] = grids();
    apply_edits(grid, roles, std::array{part_of(content, was.all() | is.all())});
  });
  edits_ = edits;
}

}  // namespace brume::sim
