#pragma once

#include <array>
#include <concepts>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "description/load.h"
#include "io/image.h"
#include "scene/unsampled_paths.h"
#include "validation/statistics/equivalence.h"

namespace abbe {

/// Largest deviation that passes, absolute or relative to the reference.
struct Margin {
  enum class Kind { absolute, relative };
  double value;
  Kind kind = Kind::absolute;

  /// Largest deviation that passes for this reference value, in the unit of the value.
  [[nodiscard]] double of(double reference) const;
};

/// A measured value and its known answer.
struct Figure {
  std::string what;  ///< Name of the figure within its case; empty if the case has a single one.
  double reference;
  Estimate measured;                  ///< The standard error is 0 for a value that is not sampled.
  std::optional<Margin> margin = {};  ///< Margin of this figure, if it differs from the case's.

  /// Measured value minus reference.
  [[nodiscard]] double deviation() const { return measured.mean - reference; }
};

/// Figures computed from formulas and tables, without rendering.
struct Computed {
  std::function<std::vector<Figure>()> figures;
};

/// Value of a closed form. It is computed at each call, since some forms take a tenth of a second.
class Expected {
 public:
  Expected(double value) : compute_([value] { return value; }) {}
  template <std::invocable Form>
  Expected(Form form) : compute_(std::move(form)) {}

  [[nodiscard]] double operator()() const { return compute_(); }

 private:
  std::function<double()> compute_;
};

/// Mean of one channel of a rendered film, compared with a closed form.
struct FilmMean {
  std::string scene;               ///< Path relative to `data/scenes/validation`.
  std::vector<Override> settings;  ///< Overrides applied to the scene.
  std::string channel;
  Expected expected;
  int samples;         ///< Samples per pixel for the margin of the case.
  double fine_margin;  ///< Relative margin of a thorough run.
  /// Path classes, written as `unsampled_paths` writes them, that contribute nothing to this film. An
  /// integrator may omit them.
  std::vector<std::string> absent = {};
};

/// Runs that include a measurement. Each tier includes the measurements of the tiers above it.
enum class Tier {
  quick,     ///< Every validation.
  tests,     ///< The default tests.
  thorough,  ///< Thorough validations, validations of this suite alone, and the nightly tests.
  never      ///< No run: too little light arrives at any number of samples, or each path takes too long.
};

/// Mean of another case's film, rendered by one integrator: a cell of the table in `docs/techniques.md`.
struct TechniqueMean {
  std::string case_id;  ///< Id of the other case.
  Integrator integrator;
  FilmMean film;  ///< Film of the other case; `integrator` replaces the one of its settings.
  Tier tier;
};

/// Colour differences of a rendered ColorChecker from the colours integrated over its spectra, for each patch
/// and in the mean.
struct RenderedChart {
  std::string illuminant;
  int samples;
  double mean_margin;  ///< Margin of the mean; the case's margin applies to each patch.
};

/// Part of the report.
enum class Suite { optics, radiometry, colour, camera, sensor, techniques };
inline constexpr std::array kSuiteNames{"optics", "radiometry", "colour", "camera", "sensor", "techniques"};

/// A quantity whose answer is known.
struct Case {
  Suite suite;
  std::string id;  ///< Unique.
  std::string title;
  std::string source;  ///< Formula or measurement, with its key in `docs/references.bib`.
  std::string unit;    ///< Unit of the figures; empty for pure numbers.
  Margin margin;
  std::variant<Computed, FilmMean, RenderedChart, TechniqueMean> method;
};

/// Accuracy and threads of a measurement.
struct CaseSettings {
  bool thorough = false;  ///< Render films at their fine margins.
  int threads = 0;        ///< Number of threads; 0 for one per processor.
};

/// A value that is reported without a verdict.
struct Remark {
  std::string what;
  double value;
};

/// Result of measuring a case.
struct CaseResult {
  std::vector<Figure> figures;
  Margin margin;      ///< Margin of this run.
  Verdict verdict;    ///< `inconclusive` counts as a failure.
  std::size_t worst;  ///< Index of the figure with the largest deviation in units of its margin.
  int samples;        ///< Samples per pixel; 0 if nothing was rendered.
  double cpu_s;       ///< CPU time of the whole case, including loading its scene.
  std::vector<Remark> remarks = {};
  /// Path classes that the integrator cannot sample. If there is one, nothing was measured.
  std::vector<PathClass> unsampled = {};
  std::vector<std::string> owned = {};  ///< Path classes that each technique of a cell samples.
  std::optional<Image> picture = {};    ///< Display picture of the film, if the film is not uniform.

  /// Largest deviation with which this figure passes.
  [[nodiscard]] double allowed(const Figure& figure) const {
    return figure.margin.value_or(margin).of(figure.reference);
  }

  [[nodiscard]] bool measured() const { return unsampled.empty(); }
  [[nodiscard]] bool passed() const { return verdict == Verdict::pass; }
};

/// Scene, channel and expected mean of a case that renders a film.
struct FilmSetup {
  Scene scene;  ///< Its samples per pixel are those of the case.
  int channel;  ///< Index of the film's channel.
  double expected;
};
/// Scene and expected mean of a case measured by `FilmMean` or `TechniqueMean`. Throws Error{internal} for
/// other methods and if the scene does not load.
[[nodiscard]] FilmSetup film_of(const Case& item);

/// Measures one case. A case whose integrator cannot sample the film's light passes without a measurement.
/// The samples of a film are doubled up to 4 times while the verdict is inconclusive. Throws Error{internal}
/// if a scene does not load, and the errors of the table loaders.
[[nodiscard]] CaseResult run_case(const Case& item, const CaseSettings& settings = {});

/// All cases, sorted by suite.
[[nodiscard]] const std::vector<Case>& all_cases();

/// A topic that a validation should cover and Abbe's does not.
struct Uncovered {
  Suite suite;
  std::string what;
  std::string reason;
};
[[nodiscard]] const std::vector<Uncovered>& uncovered();

}  // namespace abbe
