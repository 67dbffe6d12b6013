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
#include "scene/unreached.h"
#include "validation/statistics/equivalence.h"

namespace abbe {

/// The largest deviation that passes.
struct Margin {
  enum class Kind { absolute, relative };
  double value;
  Kind kind = Kind::absolute;

  /// The largest deviation that passes for one reference value, in its unit.
  [[nodiscard]] double of(double reference) const;
};

/// One figure of the program beside what it should be.
struct Figure {
  std::string what;  ///< Which of a case's figures; empty where it has one.
  double reference;
  Estimate measured;                  ///< Its standard error is 0 where nothing is sampled.
  std::optional<Margin> margin = {};  ///< Its own, where that is not the case's.

  /// Measured minus reference.
  [[nodiscard]] double deviation() const { return measured.mean - reference; }
};

/// Figures that follow from formulas and tables alone.
struct Computed {
  std::function<std::vector<Figure>()> figures;
};

/// What closed forms tell, which is worked out when it is asked for: some take a tenth of a second.
class Expected {
 public:
  Expected(double value) : work_out_([value] { return value; }) {}
  template <std::invocable Form>
  Expected(Form form) : work_out_(std::move(form)) {}

  [[nodiscard]] double operator()() const { return work_out_(); }

 private:
  std::function<double()> work_out_;
};

/// The mean of a rendered film's channel, which closed forms tell.
struct FilmMean {
  std::string scene;               ///< Relative to `data/scenes/validation`.
  std::vector<Override> settings;  ///< Applied to the scene.
  std::string channel;
  Expected expected;
  int samples;         ///< Per pixel, for the margin of the case.
  double fine_margin;  ///< Relative; for a thorough run.
  /// Classes of paths, as `unreached` writes them, that bring no light to this film: losing them is no loss.
  std::vector<std::string> absent = {};
};

/// Which runs afford a measurement, each beside those of the ones before.
enum class Tier {
  quick,     ///< Every validation.
  tests,     ///< The default tests.
  thorough,  ///< Thorough validations, those of its suite alone, and the tests of the night.
  never      ///< None: too little arrives at any number of samples, or each path takes too long.
};

/// The mean of another case's film by one technique: a cell of the matrix in `docs/techniques.md`.
struct TechniqueMean {
  std::string of;  ///< The id of that case.
  Integrator by;
  FilmMean film;  ///< Rendered by that technique, whatever its settings ask for.
  Tier tier;
};

/// Colour differences of a rendered ColorChecker to what its spectra give: patch by patch, and their mean.
struct RenderedChart {
  std::string illuminant;
  int samples;
  double mean_margin;  ///< Of the mean; the case's margin is that of each patch.
};

/// A part of the report.
enum class Suite { optics, radiometry, colour, camera, sensor, techniques };
inline constexpr std::array kSuiteNames{"optics", "radiometry", "colour", "camera", "sensor", "techniques"};

/// Something whose answer is known.
struct Case {
  Suite suite;
  std::string id;  ///< Unique.
  std::string title;
  std::string source;  ///< Formula or measurement, with its key in `docs/references.bib`.
  std::string unit;    ///< Of the figures; empty for pure numbers.
  Margin margin;
  std::variant<Computed, FilmMean, RenderedChart, TechniqueMean> method;
};

/// How carefully to measure.
struct CaseSettings {
  bool thorough = false;  ///< Films at their fine margins.
  int threads = 0;        ///< 0: one per processor.
};

/// A figure that is told and not judged.
struct Remark {
  std::string what;
  double value;
};

/// What a case measured.
struct CaseResult {
  std::vector<Figure> figures;
  Margin margin;      ///< Of this run.
  Verdict verdict;    ///< An inconclusive end counts as a failure.
  std::size_t worst;  ///< Of the figures, the one furthest from its reference in margins.
  int samples;        ///< Per pixel; 0 where nothing was rendered.
  double cpu_s;       ///< Of the case as a whole, loading its scene included.
  std::vector<Remark> remarks = {};
  /// The classes of paths that the technique loses: nothing was measured where there is one.
  std::vector<PathClass> unreached = {};
  std::vector<std::string> owned = {};  ///< Those that the techniques of a cell own, one for each.
  std::optional<Image> picture = {};    ///< Of what was rendered, for display, where it shows something.

  /// The largest deviation that passes one of the figures.
  [[nodiscard]] double allowed(const Figure& figure) const {
    return figure.margin.value_or(margin).of(figure.reference);
  }

  [[nodiscard]] bool measured() const { return unreached.empty(); }
  [[nodiscard]] bool passed() const { return verdict == Verdict::pass; }
};

/// What a case renders.
struct FilmSetup {
  Scene scene;  ///< With the case's samples.
  int channel;  ///< Of its film.
  double expected;
};
/// The film of a case measured by `FilmMean` or `TechniqueMean`. Throws Error{internal} for another, or where
/// its scene does not load.
[[nodiscard]] FilmSetup film_of(const Case& item);

/// Measures one case. A technique that does not reach a film's light passes unmeasured. A film gets up to 4
/// doublings of its samples while the verdict is open. Throws Error{internal} when its scene does not load,
/// and as its tables' loaders do.
[[nodiscard]] CaseResult run_case(const Case& item, const CaseSettings& settings = {});

/// All cases, suite by suite.
[[nodiscard]] const std::vector<Case>& all_cases();

/// Something of the trade that a validation should know and Abbe cannot do yet.
struct Uncovered {
  Suite suite;
  std::string what;
  std::string reason;
};
[[nodiscard]] const std::vector<Uncovered>& uncovered();

}  // namespace abbe
