#include "cli/compare.h"

#include <algorithm>
#include <array>
#include <optional>
#include <system_error>

#include <fmt/format.h>

#include "cli/answer.h"
#include "cli/output_files.h"
#include "description/load.h"
#include "io/atomic_file.h"
#include "io/exr.h"
#include "io/picture.h"
#include "report/chart_difference.h"
#include "report/maps.h"
#include "results/white.h"
#include "sensor/film/recorded_attributes.h"

namespace abbe::cli {
namespace {

// Keys of the formulas, in the order of `DeltaE`.
constexpr std::array kDeltaEKeys{"dE00", "dE94", "dE76", "dE_CAM16_UCS", "dE_ITP"};
const char* key_of(DeltaE formula) {
  return kDeltaEKeys.at(static_cast<std::size_t>(formula));
}

void add_color(Json& answer, const std::string& key, const std::optional<ColorDifference>& color) {
  answer[key + "_mean"] = color ? Json(color->mean) : Json();
  answer[key + "_p95"] = color ? Json(color->p95) : Json();
  answer[key + "_max"] = color ? Json(color->max) : Json();
}

// Adds the difference in polarisation if both films measure it.
void add_polarisation(Json& answer, const std::optional<PolarisationDifference>& difference) {
  if (!difference) return;
  answer["polarised_share"] = difference->polarised_fraction;
  answer["degree_mean"] = difference->degree_mean;
  answer["degree_max"] = difference->degree_max;
  answer["angle_deg_mean"] = difference->angle_deg_mean;
  answer["angle_deg_max"] = difference->angle_deg_max;
}

Json patch_answer(const std::vector<PatchDifference>& patches, const std::string& key) {
  Json list = Json::array();
  for (const PatchDifference& patch : patches)
    list.push_back({{"patch", patch.name},
                    {"pixels", patch.pixels},
                    {"Lab", or_null(patch.image)},
                    {"reference_Lab", or_null(patch.reference)},
                    {key, or_null(patch.delta_e)}});
  return list;
}

std::string lab_cells(const std::optional<Lab>& lab) {
  return lab ? fmt::format(" {:>9.3f} {:>9.3f} {:>9.3f}", (*lab)[0], (*lab)[1], (*lab)[2])
             : fmt::format(" {0:>9} {0:>9} {0:>9}", "-");
}

void print_patches(const std::vector<PatchDifference>& patches, const std::string& key) {
  fmt::print("{:<24} {:>7} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>8}\n", "patch", "pixels", "L*", "a*", "b*",
             "ref L*", "ref a*", "ref b*", key);
  for (const PatchDifference& p : patches)
    fmt::print("{:<24} {:>7}{}{} {:>8}\n", p.name, p.pixels, lab_cells(p.image), lab_cells(p.reference),
               p.delta_e ? fmt::format("{:.4f}", *p.delta_e) : "-");
}

void add_patch_summary(Json& answer, const std::vector<PatchDifference>& patches, const std::string& key) {
  double sum = 0;
  double largest = 0;
  bool known = true;
  for (const PatchDifference& patch : patches) {
    known = known && patch.delta_e;
    sum += patch.delta_e.value_or(0);
    largest = std::max(largest, patch.delta_e.value_or(0));
  }
  answer["patches_" + key + "_mean"] = known ? Json(sum / static_cast<double>(patches.size())) : Json();
  answer["patches_" + key + "_max"] = known ? Json(largest) : Json();
}

std::string histogram_of(const std::string& map) {
  return map + "_histogram";
}

// Files that maps may be written to. None of them may be an input.
std::vector<std::filesystem::path> map_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  if (folder.empty()) return files;
  for (const char* map : {kRelativeErrorMap, kDeltaEMap})
    for (const std::string& name : {std::string(map), histogram_of(map)})
      files.push_back(folder / (name + ".png"));
  return files;
}

Json write_maps(const std::filesystem::path& folder, const std::vector<DifferenceMap>& maps) {
  Json written = Json::array();
  for (const DifferenceMap& map : maps) {
    write_picture(folder / (map.name + ".png"), map.map);
    const std::string histogram = histogram_of(map.name) + ".png";
    write_picture(folder / histogram, map.histogram);
    written.push_back({{"map", map.name + ".png"}, {"histogram", histogram}, {"to", map.high}});
  }
  return written;
}

// Adds the figures of two images and writes their maps if requested.
void compare_pixels(const CompareOptions& options, const Image& image, const Image& reference, Json& answer) {
  std::optional<Chromaticity> white;
  if (!options.white.empty())
    white = requested_white(options.white, recorded_white(reference) ? reference : image, "--white").xy;
  const Comparison c = compare_images(image, reference, white);
  if (const auto undeclared = channel_with_undeclared_unit(image, reference))
    print_message(
        fmt::format("warning: only one of the images declares the unit of channel {}", *undeclared));
  warn(uncompared_channels(image, reference));
  answer["relMSE"] = c.rel_mse;
  answer["rmse"] = c.rmse;
  answer["mean_ratio"] = c.mean_ratio;
  add_color(answer, "dE00", c.color);
  add_polarisation(answer, polarisation_difference(image, reference));
  const std::optional<ColorDifference> color =
      options.formula == DeltaE::cie2000 ? c.color
                                         : color_difference(image, reference, options.formula, white);
  if (options.formula != DeltaE::cie2000) add_color(answer, key_of(options.formula), color);
  if (options.maps.empty()) return;
  answer["maps"] = write_maps(
      options.maps, difference_maps(relative_errors(image, reference), color, image.width, image.height));
}

// Compares the pixels that both films contain. Pixels outside the crops of a film are black because they were
// not rendered.
void compare_films(const CompareOptions& options, const Image& image, const Image& reference, Json& answer) {
  const std::vector<Crop> part = common_areas(image, reference);
  if (part.front() == Crop{0, 0, image.width, image.height})
    return compare_pixels(options, image, reference, answer);
  if (part.size() > 1 && !options.maps.empty())
    throw Error(
        ErrorCode::usage, "--maps",
        fmt::format("needs films whose common pixels form one rectangle (got the areas {})", to_text(part)));
  Json areas = Json::array();
  for (const Crop& area : part) areas.push_back({area.x0, area.y0, area.x1, area.y1});
  if (part.size() == 1)
    answer["crop"] = areas.front();
  else
    answer["areas"] = std::move(areas);
  compare_pixels(options, extract_areas(image, part), extract_areas(reference, part), answer);
}

}  // namespace

void compare(const CompareOptions& options) {
  if (options.reference.empty() && options.chart.empty())
    throw Error(ErrorCode::usage, options.image.string(), "needs a reference or --chart to compare with");
  if (options.reference.empty() && !options.maps.empty())
    throw Error(ErrorCode::usage, "--maps", "needs a reference");
  if (options.reference.empty() && !options.white.empty())
    throw Error(ErrorCode::usage, "--white",
                "needs a reference, since a chart is evaluated under the light of its scene");
  if (!options.maps.empty()) {
    std::error_code ignored;
    std::filesystem::create_directories(options.maps, ignored);
    for (const std::filesystem::path& file : map_files(options.maps)) require_writable(file);
  }
  Inputs inputs(options.max_memory_bytes);
  for (const std::filesystem::path& file : {options.image, options.reference}) inputs.add_file(file);
  std::optional<Scene> scene;
  if (!options.chart.empty()) {
    Diagnostics diagnostics;
    scene = accepted(load_scene(options.chart, {}, diagnostics, &inputs), diagnostics);
  }
  require_distinct(map_files(options.maps), inputs.files());
  const Image image = read_exr(options.image, &inputs);
  std::optional<Image> reference;
  if (!options.reference.empty()) reference = read_exr(options.reference, &inputs);
  Json answer;
  if (reference) compare_films(options, image, *reference, answer);
  if (scene) {
    const std::string key = key_of(options.formula);
    const std::vector<PatchDifference> patches =
        compare_chart(*scene, image, reference ? &*reference : nullptr, options.formula);
    add_patch_summary(answer, patches, key);
    if (options.json)
      answer["patches"] = patch_answer(patches, key);
    else
      print_patches(patches, key);
  }
  print(answer, options.json);
}

}  // namespace abbe::cli
