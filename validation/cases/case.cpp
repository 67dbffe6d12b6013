#include "validation/cases/case.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "io/data_directory.h"
#include "report/display_color.h"
#include "transport/plan/techniques.h"
#include "transport/render/cost.h"
#include "transport/render/render.h"
#include "validation/cases/suites.h"

namespace abbe {
namespace {

constexpr int kDoublings = 4;

int channel_index(const Scene& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.channels.size(); ++i)
    if (scene.channels[i].name == name) return static_cast<int>(i);
  throw Error(ErrorCode::internal, "case", "no channel " + name);
}

// False-colour picture of the film from 0 to twice the expected mean; empty for a uniform film.
std::optional<Image> film_map(const Film& film, int channel, double expected) {
  constexpr double kFlat = 0.1;  // relative root mean square
  std::vector<double> values(static_cast<std::size_t>(film.width()) *
                             static_cast<std::size_t>(film.height()));
  double squares = 0;
  for (std::size_t pixel = 0; pixel < values.size(); ++pixel) {
    values[pixel] = film.mean(pixel, channel);
    squares += std::pow(values[pixel] / expected - 1, 2);
  }
  if (squares < kFlat * kFlat * static_cast<double>(values.size())) return std::nullopt;
  return false_color(values, film.width(), film.height(), 0, 2 * expected);
}

CaseResult measure(const Case& item, const Computed& method, const CaseSettings&) {
  return {method.figures(), item.margin, Verdict::pass, 0, 0, 0};
}

const FilmMean& film_mean(const Case& item) {
  if (const auto* cell = std::get_if<TechniqueMean>(&item.method)) return cell->film;
  if (const auto* film = std::get_if<FilmMean>(&item.method)) return *film;
  throw Error(ErrorCode::internal, item.id, "the case does not render a film");
}

// Renders a film with the samples for its margin, n ~ 1/margin^2, and more while the verdict is inconclusive.
CaseResult measure_film(const Case& item, FilmSetup film, const CaseSettings& settings) {
  Scene& scene = film.scene;
  CaseResult result{{}, item.margin, Verdict::fail, 0, 0, 0};
  if (settings.thorough) result.margin.value = film_mean(item).fine_margin;
  const double ratio = item.margin.value / result.margin.value;
  scene.render.samples = static_cast<int>(std::lround(scene.render.samples * ratio * ratio));
  for (int doubling = 0; doubling <= kDoublings; ++doubling, scene.render.samples *= 2) {
    const RenderResult rendered = render(scene, {.threads = settings.threads});
    const Film::Average measured = rendered.film.average(film.channel);
    result.figures = {{"", film.expected, {measured.mean, measured.standard_error}}};
    result.samples = scene.render.samples;
    result.picture = film_map(rendered.film, film.channel, film.expected);
    if (equivalence(result.figures[0].measured, film.expected, result.margin.value) != Verdict::inconclusive)
      break;
  }
  return result;
}

CaseResult measure(const Case& item, const FilmMean&, const CaseSettings& settings) {
  return measure_film(item, film_of(item), settings);
}

CaseResult measure(const Case& item, const TechniqueMean& method, const CaseSettings& settings) {
  FilmSetup film = film_of(item);
  const Scene& scene = film.scene;
  std::vector<PathClass> classes = unsampled_paths(scene);
  std::erase_if(classes, [&absent = method.film.absent](const PathClass& path_class) {
    return std::ranges::count(absent, path_class.substr(0, path_class.find(':'))) > 0;
  });
  const std::vector<Technique> techniques = chosen_techniques(scene);
  CaseResult result = classes.empty() ? measure_film(item, std::move(film), settings)
                                      : CaseResult{{}, item.margin, Verdict::pass, 0, 0, 0};
  result.unsampled = std::move(classes);
  for (const Technique technique : techniques)
    result.owned.push_back(owned_paths(technique, techniques, scene.camera));
  return result;
}

// Verdict of one figure. A figure that is not sampled has no interval.
Verdict verdict_of(const Figure& figure, double allowed) {
  if (figure.measured.standard_error == 0)
    return std::abs(figure.deviation()) <= allowed ? Verdict::pass : Verdict::fail;
  return equivalence(figure.measured, figure.reference, allowed / std::abs(figure.reference));
}

void set_verdict(CaseResult& result) {
  if (!result.measured()) return;
  result.verdict = result.figures.empty() ? Verdict::fail : Verdict::pass;
  double worst = -1;
  for (std::size_t i = 0; i < result.figures.size(); ++i) {
    const Figure& figure = result.figures[i];
    if (const Verdict verdict = verdict_of(figure, result.allowed(figure)); verdict != Verdict::pass)
      result.verdict = verdict;
    const double deviation = std::abs(figure.deviation()) / result.allowed(figure);
    if (deviation <= worst || std::isnan(worst)) continue;  // NaN counts as the worst deviation
    worst = deviation;
    result.worst = i;
  }
}

}  // namespace

FilmSetup film_of(const Case& item) {
  const FilmMean& method = film_mean(item);
  std::vector<Override> settings = method.settings;
  if (const auto* cell = std::get_if<TechniqueMean>(&item.method))
    settings.push_back(
        {"/render/integrator",
         fmt::format("\"{}\"", kIntegratorNames.at(static_cast<std::size_t>(cell->integrator)))});
  Scene scene = load_case_scene(item.id, method.scene, settings);
  scene.render.samples = method.samples;
  const int channel = channel_index(scene, method.channel);
  return {std::move(scene), channel, method.expected()};
}

Scene load_case_scene(const std::string& id, const std::string& file, std::span<const Override> settings) {
  Diagnostics diagnostics;
  std::optional<Scene> scene =
      load_scene(data_directory() / "scenes" / "validation" / file, settings, diagnostics);
  if (!scene) throw Error(ErrorCode::internal, id, diagnostics.text());
  return std::move(*scene);
}

double Margin::of(double reference) const {
  return kind == Kind::absolute ? value : value * std::abs(reference);
}

CaseResult run_case(const Case& item, const CaseSettings& settings) {
  const CostMeter meter;
  CaseResult result =
      std::visit([&](const auto& method) { return measure(item, method, settings); }, item.method);
  set_verdict(result);
  result.cpu_s = meter.spent().cpu_s;
  return result;
}

const std::vector<Case>& all_cases() {
  static const std::vector<Case> cases = [] {
    std::vector<Case> all;
    for (std::vector<Case> (*suite)() : {optics_cases, radiometry_cases, colour_cases, color_metric_cases,
                                         chart_cases, camera_cases, sensor_cases})
      for (Case& item : suite()) all.push_back(std::move(item));
    for (Case& cell : technique_cases(all)) all.push_back(std::move(cell));
    return all;
  }();
  return cases;
}

const std::vector<Uncovered>& uncovered() {
  static const std::vector<Uncovered> all{
      {Suite::optics, "published lenses: double Gauss, Edmund, Cooke, Thorlabs",
       "covered by the tests of lenses instead of a case"},
      {Suite::optics, "Airy's shift of the rainbow", "light is traced as rays, not as waves"},
      {Suite::radiometry, "Cornell box against its photographs", "no measured pixel values are published"},
      {Suite::radiometry, "tables of CIE 171",
       "not freely available; its analytic cases are computed from formulas"},
      {Suite::camera, "sensitivity metamerism indices of ISO 17321", "no published values per camera"},
      {Suite::sensor, "blooming and response curves",
       "covered by the tests of the read-out instead of a case"},
      {Suite::sensor, "lag and imperfect charge transfer", "the read-out does not model them"},
  };
  return all;
}

}  // namespace abbe
