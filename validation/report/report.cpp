#include "validation/report/report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "calibration/output/display.h"
#include "io/data_directory.h"
#include "transport/render/render.h"
#include "transport/render/white.h"

namespace abbe {
namespace {

Specimen render_specimen(const std::string& file, const std::string& caption,
                         const std::vector<Override>& settings, int threads) {
  Diagnostics diagnostics;
  const std::optional<Scene> scene = load_scene(data_directory() / "scenes" / file, settings, diagnostics);
  if (!scene) throw Error(ErrorCode::internal, file, diagnostics.text());
  const RenderResult rendered = render(*scene, {.threads = threads});
  std::vector<std::string> names;
  for (const Channel& channel : scene->channels) names.push_back(channel.name);
  const DisplayTransform display = make_display(scene->channels, *white_of(*scene).spectrum);
  return {fmt::format("{} {} samples per pixel, {:.1f} CPU s.", caption, scene->render.samples,
                      rendered.stats.cpu_s),
          display(rendered.film.image(names)).image};
}

std::vector<Specimen> render_specimens(const ValidationSettings& settings) {
  const Override samples{"/render/samples", settings.quick ? "64" : "256"};
  const Override observer{"/sensor",
                          R"({"observer": "1931", "resolution": [480, 270], "pixel_pitch_um": 18})"};
  return {render_specimen("prism.json",
                          "A slit of illuminant A through a prism of N-SF11, on a CCD behind ideal filters.",
                          {samples, {"/sensor/resolution", "[480, 270]"}, {"/sensor/pixel_pitch_um", "18"}},
                          settings.threads),
          render_specimen("prism.json", "The same scene, recorded by the CIE 1931 observer.",
                          {samples, observer}, settings.threads),
          render_specimen("cornell.json", "The Cornell box, as measured.", {samples}, settings.threads)};
}

// True if the settings select the case. A quick run of all suites includes only a few cells of the matrix.
bool is_selected(const Case& item, const ValidationSettings& settings) {
  const std::vector<Suite>& suites = settings.suites;
  if (!suites.empty() && std::find(suites.begin(), suites.end(), item.suite) == suites.end()) return false;
  const auto* cell = std::get_if<TechniqueMean>(&item.method);
  if (cell == nullptr || cell->tier == Tier::quick) return true;
  return cell->tier != Tier::never && (!settings.quick || !suites.empty());
}

}  // namespace

std::string suite_name(Suite suite) {
  return kSuiteNames.at(static_cast<std::size_t>(suite));
}

std::string verdict_name(Verdict verdict) {
  return verdict == Verdict::pass ? "pass" : verdict == Verdict::fail ? "FAIL" : "UNDECIDED";
}

double worst_margin_ratio(const CaseResult& result) {
  if (!result.measured()) return 0;
  if (result.figures.empty()) return INFINITY;
  const Figure& worst = result.figures[result.worst];
  return std::abs(worst.deviation()) / result.allowed(worst);
}

DeviationText deviation_text(const Outcome& outcome, const Figure& figure) {
  constexpr double kMinPercent = 1e-4;  // smaller margins are printed as fractions
  const Margin margin = figure.margin.value_or(outcome.result.margin);
  if (margin.kind == Margin::Kind::absolute)
    return {
        fmt::format("{:.2g}", figure.deviation()),
        fmt::format("{:.2g}{}{}", margin.value, outcome.item->unit.empty() ? "" : " ", outcome.item->unit)};
  const double relative = figure.deviation() / std::abs(figure.reference);
  if (margin.value < kMinPercent)
    return {fmt::format("{:.2g}", relative), fmt::format("{:.2g} relative", margin.value)};
  return {fmt::format("{:.2g} %", 100 * relative), fmt::format("{:g} %", 100 * margin.value)};
}

// The first figure is the mean of the others.
ChartSummary chart_summary(const CaseResult& result) {
  ChartSummary summary{result.figures.at(0).measured.mean, 0};
  for (std::size_t i = 1; i < result.figures.size(); ++i)
    summary.worst = std::max(summary.worst, result.figures[i].measured.mean);
  return summary;
}

std::string chart_table(const std::vector<Outcome>& outcomes) {
  std::string head = "| ΔE2000 |";
  std::string rule = "| --- |";
  std::string means = "| mean of 24 patches |";
  std::string worst = "| worst patch |";
  bool empty = true;
  for (const Outcome& outcome : outcomes) {
    const auto* chart = std::get_if<RenderedChart>(&outcome.item->method);
    if (chart == nullptr) continue;
    empty = false;
    const ChartSummary summary = chart_summary(outcome.result);
    head += fmt::format(" {} |", chart->illuminant);
    rule += " --- |";
    means += fmt::format(" {:.3f} |", summary.mean);
    worst += fmt::format(" {:.3f} |", summary.worst);
  }
  return empty ? "" : fmt::format("{}\n{}\n{}\n{}\n", head, rule, means, worst);
}

std::size_t ValidationReport::failures() const {
  return static_cast<std::size_t>(
      std::count_if(outcomes.begin(), outcomes.end(), [](const Outcome& o) { return !o.result.passed(); }));
}

std::size_t ValidationReport::unsampled() const {
  return static_cast<std::size_t>(
      std::count_if(outcomes.begin(), outcomes.end(), [](const Outcome& o) { return !o.result.measured(); }));
}

ValidationReport validate(const ValidationSettings& settings) {
  const CostMeter meter;
  ValidationReport report{this_machine(), settings.version, data_sha256(), settings.quick, {}, {}, {}};
  for (const Case& item : all_cases()) {
    if (!is_selected(item, settings)) continue;
    if (settings.say) settings.say(fmt::format("{} {}: {}", suite_name(item.suite), item.id, item.title));
    report.outcomes.push_back(
        {&item, run_case(item, {.thorough = !settings.quick, .threads = settings.threads})});
  }
  if (settings.specimens) report.specimens = render_specimens(settings);
  report.cost = meter.spent();
  return report;
}

}  // namespace abbe
