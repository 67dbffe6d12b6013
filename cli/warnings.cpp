#include "cli/warnings.h"

#include <string>
#include <string_view>

#include <fmt/format.h>

#include "cli/answer.h"
#include "film/field_response.h"
#include "film/shortcomings.h"
#include "io/error.h"

namespace abbe::cli {
namespace {

void warn(const std::string& message, bool is_error) {
  if (is_error) throw Error(ErrorCode::scene, "", message);
  say("warning: " + message);
}

}  // namespace

void warn_of_lost_light(const Scene& scene, bool strict) {
  if (const auto lost = lost_light(scene)) warn(*lost, strict);
}

void warn_of_dark_camera(const Scene& scene, bool strict) {
  if (const auto dark = dark_camera(scene)) warn(*dark, strict);
}

void warn_of_tinted_corners(const Scene& scene) {
  const std::string remedy = "develop --field balances pictures over the field";
  if (const auto tinted = tinted_corners(neutral_shift(scene).value_or(0), remedy)) warn(*tinted, false);
}

std::optional<std::string> held_index(const Material& material, double wavelength_nm) {
  const auto held = [&](std::string_view what, const DataRange& data) {
    return fmt::format("the {} of material \"{}\" is held from the end of its data, [{:g}, {:g}] nm", what,
                       material.name, data.low_nm, data.high_nm);
  };
  for (const IndexUse& use : indices(material)) {
    const DataRange n{use.index->low_nm(), use.index->high_nm()};
    if (!n.contains(wavelength_nm)) return held("index", n);
    const auto& k = use.index->k_range();
    if (k && !k->contains(wavelength_nm)) return held("extinction", *k);
  }
  return std::nullopt;
}

std::optional<std::string> held_index(const Scene& scene, const RayTree& tree, double wavelength_nm) {
  for (const RayBranch& branch : tree.branches)
    for (const TraceEvent& event : branch.trace.events) {
      if (!event.passage) continue;
      const Material& material = material_of(scene, event.shape);
      if (auto held = held_index(material, wavelength_nm)) return held;
    }
  return std::nullopt;
}

void warn_of_hidden_sheet(const Scene& scene, bool strict) {
  if (const auto hidden = hidden_sheet(scene)) warn(*hidden, strict);
}

void warn_of_hidden_lamp(const Scene& scene, bool strict) {
  if (const auto hidden = hidden_lamp(scene)) warn(*hidden, strict);
}

void warn_of_rare_photons(const Guides* guides) {
  if (const auto rare = rare_photons(guides)) warn(*rare, false);
}

void warn_of_unused_settings(const Scene& scene) {
  if (const auto unused = unused_settings(scene)) warn(*unused, false);
}

void note_polarisation(const Scene& scene) {
  if (!scene.needs.polarisation_matters || scene.render.polarisation) return;
  say(fmt::format(
      "render/polarisation is \"off\", which matters after {}: it takes 0.3 % of the light off a prism of "
      "N-BK7, 3 % of N-SF11, more where mirrors cross (docs/physics/conventions.md)",
      scene.needs.because.at("polarisation_matters")));
}

void warn_of_unpolarised_measurement(const Scene& scene, bool strict) {
  if (const auto unpolarised = unpolarised_measurement(scene)) warn(*unpolarised, strict);
}

}  // namespace abbe::cli
