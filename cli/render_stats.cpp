#include "cli/render_stats.h"

#include <vector>

#include "calibration/output/display.h"
#include "cli/answer.h"
#include "io/data_directory.h"
#include "results/spectral.h"
#include "validation/statistics/students_interval.h"

namespace abbe::cli {
namespace {

Json json_of(const Cost& cost) {
  return {{"wall_s", cost.wall_s}, {"cpu_s", cost.cpu_s}};
}

// Mean and error of each plane over the rendered pixels. Planes of a spectral sensor are radiances, as in its
// file.
Json film_figures(const Scene& scene, const Film& film) {
  const Crop crop = film.crop();
  const std::vector<std::string> planes = scene.film_planes();
  const std::vector<double> divisors = scene.spectral ? exposure_per_radiance(scene) : std::vector<double>();
  Json figures;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const Film::Average average =
        film.average(static_cast<int>(i), crop.x0, crop.y0, crop.x1, crop.y1, divisors);
    const bool known = average.degrees_of_freedom > 0;
    figures[planes[i]] = {
        {"mean", average.mean},
        {"standard_error", known ? Json(average.standard_error) : Json()},
        {"degrees_of_freedom", average.degrees_of_freedom},
        {"half_interval_95",
         known ? Json(half_interval(average.standard_error, average.degrees_of_freedom, 0.95)) : Json()}};
  }
  return figures;
}

}  // namespace

std::string stats_text(const Scene& scene, const RenderResult& result, const Costs& costs,
                       std::optional<double> display_white) {
  const RenderStats& stats = result.stats;
  Json answer;
  answer["wall_s"] = stats.wall_s;
  answer["cpu_s"] = stats.cpu_s;
  answer["command"] = json_of(costs.command.spent());
  answer["overhead"] = {{"load", json_of(costs.load)},
                        {"plan", json_of(costs.plan)},
                        {"display", json_of(costs.display)},
                        {"write", json_of(costs.write)}};
  answer["threads"] = stats.threads;
  answer["processes"] = stats.processes;
  answer["samples_per_pixel"] = stats.samples_per_pixel;
  answer["samples_before"] = stats.samples_before;
  answer["photons_per_sample"] = result.film.shape().photons;
  answer["path_interval"] = result.film.shape().path_interval;
  answer["path_splitting"] = stats.path_splitting;
  answer["paths"] = stats.paths;
  answer["rays"] = stats.rays;
  answer["embree_replay_share"] = Json();  // measured by bench, which traces paths again
  answer["relative_error"] = stats.error.median;
  answer["relative_error_p95"] = stats.error.p95;
  answer["frame_mean_error"] = stats.error.frame_mean;
  answer["half_noise_samples"] = stats.error.few_samples ? Json(*stats.error.few_samples) : Json();
  answer["hidden_noise"] = stats.error.hidden_noise > 0 ? Json(stats.error.hidden_noise) : Json();
  answer["nonfinite_samples"] = stats.nonfinite_samples;
  answer["cut_paths"] = stats.cut.paths;
  answer["cut_throughput"] = stats.cut.throughput();
  answer["film"] = film_figures(scene, result.film);
  answer[kDisplayExposureKey] = display_white ? Json(*display_white) : Json();
  answer["version"] = ABBE_VERSION;
  answer["seed"] = scene.render.seed;
  answer["scene_sha256"] = scene.sha256;
  answer["data_sha256"] = data_sha256();
  return text(answer, true);
}

}  // namespace abbe::cli
