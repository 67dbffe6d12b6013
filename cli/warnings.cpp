#include "cli/warnings.h"

#include <string>
#include <string_view>

#include <fmt/format.h>

#include "cli/answer.h"
#include "io/error.h"
#include "results/scene_warnings.h"
#include "results/white.h"

namespace abbe::cli {
namespace {

void warn(const std::string& message, bool is_error) {
  if (is_error) throw Error(ErrorCode::scene, "", message);
  print_message("warning: " + message);
}

}  // namespace

void warn_of_unsampled_light(const Scene& scene, bool strict) {
  if (const auto warning = unsampled_light_warning(scene)) warn(*warning, strict);
}

void warn_of_dark_camera(const Scene& scene, bool strict) {
  if (const auto warning = dark_camera_warning(scene)) warn(*warning, strict);
}

void warn_of_tinted_corners(const Scene& scene) {
  const std::string remedy = "develop --field balances pictures over the field";
  if (const auto warning = field_tint_warning(neutral_shift(scene).value_or(0), remedy))
    warn(*warning, false);
}

std::optional<std::string> extrapolated_index_warning(const Material& material, double wavelength_nm) {
  const auto warning = [&](std::string_view quantity, const DataRange& data) {
    return fmt::format("the {} of material \"{}\" is extrapolated from the end of its data, [{:g}, {:g}] nm",
                       quantity, material.name, data.low_nm, data.high_nm);
  };
  for (const IndexUse& use : indices(material)) {
    const DataRange n{use.index->low_nm(), use.index->high_nm()};
    if (!n.contains(wavelength_nm)) return warning("index", n);
    const auto& k = use.index->k_range();
    if (k && !k->contains(wavelength_nm)) return warning("extinction", *k);
  }
  return std::nullopt;
}

std::optional<std::string> extrapolated_index_warning(const Scene& scene, const RayTree& tree,
                                                      double wavelength_nm) {
  for (const RayBranch& branch : tree.branches)
    for (const TraceEvent& event : branch.trace.events) {
      if (!event.passage) continue;
      const Material& material = material_of(scene, event.shape);
      if (auto warning = extrapolated_index_warning(material, wavelength_nm)) return warning;
    }
  return std::nullopt;
}

void warn_of_hidden_sheet(const Scene& scene, bool strict) {
  if (const auto warning = hidden_sheet_warning(scene)) warn(*warning, strict);
}

void warn_of_hidden_light(const Scene& scene, bool strict) {
  if (const auto warning = hidden_light_warning(scene)) warn(*warning, strict);
}

void warn_of_undertrained_guides(const GuidingData* guides) {
  if (const auto warning = undertrained_warning(guides)) warn(*warning, false);
}

void warn_of_unused_settings(const Scene& scene) {
  if (const auto warning = unused_settings_warning(scene)) warn(*warning, false);
}

void note_polarisation(const Scene& scene) {
  if (!scene.features.polarisation_relevant || scene.render.polarisation) return;
  print_message(fmt::format(
      "render/polarisation is \"off\", which affects the image after {}: a prism is 0.3 % too dark with "
      "N-BK7, 3 % with N-SF11, and crossed mirrors by any factor (docs/physics/conventions.md)",
      scene.features.reasons.at("polarisation_matters")));
}

void warn_of_ignored_polarisation(const Scene& scene, bool strict) {
  if (const auto warning = ignored_polarisation_warning(scene)) warn(*warning, strict);
}

}  // namespace abbe::cli
