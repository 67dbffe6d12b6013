#include "validation/report/report.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

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
          render_specimen("prism.json", "The same before the eyes of the CIE 1931 observer.",
                          {samples, observer}, settings.threads),
          render_specimen("cornell.json", "The Cornell box, as measured.", {samples}, settings.threads)};
}

// Whether a case is asked for; of the cells of the matrix a quick run of all suites affords but few.
bool runs(const Case& item, const ValidationSettings& settings) {
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

double worst_share(const CaseResult& result) {
  if (!result.measured()) return 0;
  if (result.figures.empty()) return INFINITY;
  const Figure& worst = result.figures[result.worst];
  return std::abs(worst.deviation()) / result.allowed(worst);
}

std::size_t ValidationReport::failures() const {
  return static_cast<std::size_t>(
      std::count_if(outcomes.begin(), outcomes.end(), [](const Outcome& o) { return !o.result.passed(); }));
}

double ValidationReport::cpu_s() const {
  return std::accumulate(outcomes.begin(), outcomes.end(), 0.0,
                         [](double sum, const Outcome& o) { return sum + o.result.cpu_s; });
}

std::size_t ValidationReport::unreached() const {
  return static_cast<std::size_t>(
      std::count_if(outcomes.begin(), outcomes.end(), [](const Outcome& o) { return !o.result.measured(); }));
}

ValidationReport validate(const ValidationSettings& settings) {
  const auto start = std::chrono::steady_clock::now();
  ValidationReport report{this_machine(), settings.version, data_sha256(), settings.quick, {}, {}, 0};
  for (const Case& item : all_cases()) {
    if (!runs(item, settings)) continue;
    if (settings.say) settings.say(fmt::format("{} {}: {}", suite_name(item.suite), item.id, item.title));
    report.outcomes.push_back(
        {&item, run_case(item, {.thorough = !settings.quick, .threads = settings.threads})});
  }
  if (settings.specimens) report.specimens = render_specimens(settings);
  report.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace abbe
