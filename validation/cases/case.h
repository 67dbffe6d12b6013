#pragma once

#include <string>
#include <vector>

#include "scene/description/load.h"
#include "validation/statistics/equivalence.h"

namespace abbe {

/// A scene whose answer is known in closed form.
struct Case {
  std::string id;
  std::string title;
  std::string source;              ///< Formula and key of the reference.
  std::string scene;               ///< Relative to `data/scenes/validation`.
  std::vector<Override> settings;  ///< Applied to the scene.
  std::string channel;             ///< Film channel that is compared.
  double expected;                 ///< Mean film value of that channel.
  int samples;                     ///< Per pixel, for the default margin.
  double margin = 0.01;            ///< Relative.
  double nightly_margin = 0.002;
};

/// What a case measured.
struct CaseResult {
  Estimate measured;
  Verdict verdict;
  int samples;
  double cpu_s;
};

/// Renders the case, with up to 4 doublings of the samples while the verdict is open. An inconclusive end
/// counts as a failure. Throws Error{internal} when the scene does not load.
[[nodiscard]] CaseResult run_case(const Case& item, double margin);

/// Radiometric closed forms: rooms, form factors, integrating spheres, furnaces, slabs.
[[nodiscard]] std::vector<Case> radiometry_cases();

}  // namespace abbe
