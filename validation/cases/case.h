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
#include "scene/lost_light.h"
#include "validation/statistics.h"

namespace abbe {

/// Largest deviation that passes, absolute or relative to the reference.
struct Margin {
  enum class Kind { absolute, relative };
  double value;  ///< In the unit of the case if absolute; a fraction of |reference| if relative.
  Kind kind = Kind::absolute;

  /// Largest absolute deviation that passes for this reference value, in the unit of the case.
  [[nodiscard]] double of(double reference) const;
};

/// A measured value and its known answer, in the unit of the case.
struct Figure {
  std::string what;  ///< Empty if the case has a single one.
  double reference;
  Estimate measured;
  std::optional<Margin> margin = {};  ///< Margin of this figure, if it differs from the case's.

  [[nodiscard]] double deviation() const { return measured.mean - reference; }
};

using Figures = std::vector<Figure>;

/// Figures computed from formulas and tables, without rendering. `figures` may throw the errors of tables.
struct Computed {
  std::function<Figures()> figures;
};

/// Value of a closed form, evaluated at each call, since some forms take a tenth of a second. Numbers and
/// functions without arguments convert to it.
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
  std::string scene;  ///< Path relative to `data/scenes/validation`.
  std::vector<Override> settings;
  std::string channel;
  Expected expected;   ///< Mean of the channel over all pixels.
  int samples;         ///< Samples per pixel for the margin of the case.
  double fine_margin;  ///< Margin of a thorough run, as a fraction of the expected mean.
  /// Path classes that contribute nothing to this film, as the expressions before the colon of
  /// `unsampled_paths`, such as "E L". An integrator may omit them.
  std::vector<std::string> absent = {};
};

/// Runs that include a measurement. Each tier but `never` includes the measurements of the tiers above it.
enum class Tier {
  quick,     ///< Every validation.
  tests,     ///< The default tests.
  thorough,  ///< Thorough validations, validations of this suite alone, and the nightly tests.
  never      ///< No run: too little light arrives at any number of samples, or each path takes too long.
};

/// Mean of another case's film, rendered by one integrator.
struct TechniqueMean {
  std::string case_id;
  Integrator integrator;
  FilmMean film;  ///< Film of the other case; `integrator` replaces the one of its settings.
  Tier tier;
};

/// Colour differences of a rendered ColorChecker from the colours integrated over its spectra, for each patch
/// and in the mean.
struct RenderedChart {
  std::string illuminant;  ///< Name of a shipped illuminant.
  int samples;             ///< Samples per pixel, in quick and thorough runs.
  double mean_margin;      ///< Margin of the mean [ΔE2000]; the case's margin applies to each patch.
};

enum class Suite { optics, radiometry, colour, camera, sensor, techniques };
inline constexpr std::array kSuiteNames{"optics", "radiometry", "colour", "camera", "sensor", "techniques"};

/// A quantity whose answer is known.
struct Case {
  Suite suite;
  std::string id;  ///< Unique.
  std::string title;
  std::string source;  ///< Formula or measurement, with its key in `docs/references.bib`.
  std::string unit;    ///< Unit of the figures; empty for pure numbers.
  Margin margin;       ///< Margin of figures without their own. A thorough run replaces that of films.
  std::variant<Computed, FilmMean, RenderedChart, TechniqueMean> method;
};

struct CaseSettings {
  bool thorough = false;  ///< Render films at their fine margins, with accordingly more samples.
  int threads = 0;        ///< 0 for one per processor.
};

/// A value that is reported without a verdict.
struct Remark {
  std::string what;
  double value;
};

struct CaseResult {
  /// Figures of the case: those of `Computed`, one for a film, the mean and then the patches for a chart.
  /// Empty if nothing was measured.
  Figures figures;
  Margin margin;      ///< Margin of this run, for figures without their own.
  Verdict verdict;    ///< `pass` if all figures pass; otherwise the verdict of one that does not pass.
  std::size_t worst;  ///< Index of the figure with the largest deviation in units of its margin.
  int samples;        ///< Samples per pixel of the last render; 0 if nothing was rendered.
  double cpu_s;       ///< CPU time of the whole case, including loading its scene.
  std::vector<Remark> remarks = {};
  /// Path classes that the integrator of a `TechniqueMean` cannot sample. If there is one, nothing was
  /// measured.
  std::vector<PathClass> unsampled = {};
  /// Path classes that each technique of a `TechniqueMean` samples, one text per technique.
  std::vector<std::string> owned = {};
  /// Picture with code values in [0, 1]: the developed chart, or for a film that is not uniform a false-
  /// colour map from 0 to twice the expected mean.
  std::optional<Image> picture = {};

  /// Largest absolute deviation with which this figure passes, in the unit of the case.
  [[nodiscard]] double allowed(const Figure& figure) const {
    return figure.margin.value_or(margin).of(figure.reference);
  }

  [[nodiscard]] bool measured() const { return unsampled.empty(); }
  [[nodiscard]] bool passed() const { return verdict == Verdict::pass; }
};

/// Scene with the samples of a case, index and expected mean of its channel.
struct FilmSetup {
  Scene scene;
  int channel;
  double expected;
};
/// Scene and expected mean of a case measured by `FilmMean` or `TechniqueMean`. Throws Error{internal} for
/// other methods, for an unknown channel, and if the scene does not load.
[[nodiscard]] FilmSetup film_of(const Case& item);

/// Measures one case. A `TechniqueMean` whose integrator cannot sample the film's light passes without a
/// measurement. The samples of a film are doubled up to 4 times while the verdict is inconclusive. Throws
/// Error{internal} if a scene does not load, Error{input} for a missing table, and the errors of `render`.
[[nodiscard]] CaseResult run_case(const Case& item, const CaseSettings& settings = {});

/// All cases, sorted by suite. The first call builds them and throws Error{input} if a shipped table is
/// missing.
[[nodiscard]] const std::vector<Case>& all_cases();

/// A topic that a validation should cover and Abbe's does not.
struct Uncovered {
  Suite suite;
  std::string what;
  std::string reason;
};
/// All topics, sorted by suite.
[[nodiscard]] const std::vector<Uncovered>& uncovered();

}  // namespace abbe
