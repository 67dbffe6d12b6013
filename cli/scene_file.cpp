#include "cli/render.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <system_error>

#include <fmt/format.h>

#include "cli/answer.h"
#include "cli/command_options.h"
#include "cli/output_files.h"
#include "description/load.h"
#include "importers/importers.h"
#include "io/atomic_file.h"
#include "io/error.h"
#include "io/inputs.h"
#include "io/text.h"
#include "lens/paraxial.h"
#include "results/rendered_film.h"
#include "results/scene_warnings.h"
#include "results/white.h"
#include "scene/camera/lens_optics.h"
#include "scene/lost_light.h"
#include "transport/render/pass.h"
#include "transport/render/technique_balance.h"
#include "transport/render/threads.h"
#include "transport/render/trained_plan.h"

namespace abbe::cli {
namespace {

namespace fs = std::filesystem;

struct InfoOptions {
  fs::path scene;
  std::vector<Override> overrides;
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};

struct ConvertOptions {
  fs::path scene;
  fs::path output = kStandardStream;
  std::optional<fs::path> materials;
  std::vector<Override> overrides;
  std::size_t max_memory_bytes = default_memory_limit();
};

// Channel names of a mosaic, rows from the top.
std::string pattern(const Scene& scene) {
  std::vector<std::string> names;
  for (const Channel& channel : scene.channels) names.push_back(channel.name);
  return to_text(*scene.mosaic, names);
}

/// Plan of a render. Only the techniques are set if no plan can be made.
struct PlannedRender {
  std::vector<Technique> techniques;
  std::optional<std::array<double, 2>> wavelengths_nm = {};  ///< Minimum and maximum.
  Json technique_costs = nullptr;  ///< Costs of camera paths and photons; null without photons.
  int path_splitting = 1;
};

Json json_of(const TechniqueCost& cost) {
  return {{"relative_variance", cost.relative_variance}, {"rays", cost.rays}};
}

PlannedRender plan_render(const Scene& scene, const std::shared_ptr<const GuidingData>& guides) {
  if (refusal(scene)) return {chosen_techniques(scene)};
  const int threads = thread_count(0);
  Plan plan = make_trained_plan(scene, threads, guides);
  choose_path_splitting(plan, threads);
  const std::optional<TechniqueCosts> costs = balance_techniques(plan, threads);
  PlannedRender render{plan.techniques, {{plan.wavelengths.low_nm(), plan.wavelengths.high_nm()}}};
  render.path_splitting = 1 << plan.log2_splits;
  if (costs)
    render.technique_costs = {{"photons_per_sample", plan.photons},
                              {"photons_part", plan.photons_split_wavelengths},
                              {"path_interval", plan.path_interval},
                              {"camera_paths", json_of(costs->camera_paths)},
                              {"photons", json_of(costs->photons)}};
  return render;
}

// Figures of the lens of a camera at its primary wavelength. Null for cameras without a lens system.
Json lens_answer(const Camera& camera) {
  const auto* lens_system = std::get_if<LensSystem>(&camera.kind);
  if (lens_system == nullptr) return nullptr;
  const lens::SpectralSystem& system = lens_system->optics->system;
  const lens::SystemAt at(system.system(), system.system().primary_nm());
  Json answer{{"title", system.system().title},
              {"wavelength_nm", at.wavelength_nm},
              {"focal_length_mm", lens::first_order(at).focal_length_mm},
              {"stop_radius_mm", system.stop_radius_mm()},
              {"image_mm", system.system().surfaces.back().thickness_mm},
              {"ghosts", lens_system->optics->routes.size() - 1}};
  if (const auto& speed = lens_system->optics->speed)
    answer.update({{"f_number", speed->f_number},
                   {"working_f_number", speed->working_f_number},
                   {"t_stop", speed->t_stop},
                   {"airy_radius_um", speed->airy_radius_um}});
  return answer;
}

Json answer_for(const Scene& scene, const IntegratorChoice& choice) {
  const PlannedRender render = plan_render(scene, choice.guides);
  Json answer;
  answer["shapes"] = scene.shapes.size();
  answer["triangles"] = scene.triangle_count();
  answer["lights"] = scene.lights.size();
  answer["materials"] = scene.materials.size();
  for (const FeatureName& need : feature_names()) answer["needs"][need.key] = scene.features.*need.member;
  answer["because"] = scene.features.reasons;
  answer["integrator"] = {{"name", integrator_name(choice.integrator)}, {"because", choice.reason}};
  if (choice.cost_ratio)
    answer["integrator"][fmt::format("cost_of_path_over_{}", integrator_name(choice.alternative))] =
        *choice.cost_ratio;
  answer["techniques"] = Json::array();
  answer["owned"] = Json::object();
  for (const Technique technique : render.techniques) {
    answer["techniques"].push_back(integrator_name(technique));
    answer["owned"][integrator_name(technique)] = owned_paths(technique, render.techniques, scene.camera);
  }
  answer["bias"] = nullptr;
  for (const Technique technique : render.techniques)
    if (!bias_of(technique).empty()) answer["bias"] = bias_of(technique);
  answer["shares"] = render.technique_costs;
  answer["path_splitting"] = render.path_splitting;
  answer["lens"] = lens_answer(scene.camera);
  answer["unreached"] = unsampled_paths(scene, scene.features, traces(render.techniques, TracedPaths::light));
  if (scene.mosaic) answer["mosaic"] = pattern(scene);
  if (scene.output.white)
    answer["white"] = {{"name", scene.output.white->name},
                       {"xy", scene.output.white->xy},
                       {"because", scene.output.white->reason}};
  if (const auto shift = neutral_shift(scene)) answer["neutral_shift_dE00"] = *shift;
  if (render.wavelengths_nm) answer["wavelength_range_nm"] = *render.wavelengths_nm;
  answer["memory_bytes"] = scene.memory_bytes() + film_bytes(scene) + bytes_of_light_paths(scene);
  return answer;
}

std::string joined(const Json& words) {
  return words.empty() ? "none" : fmt::format("{}", fmt::join(words.get<std::vector<std::string>>(), ", "));
}

// Numbers of photons and camera paths per sample, and the pilot statistics that determine them.
std::string technique_costs_line(const Json& technique_costs) {
  const auto cost = [&technique_costs](const char* technique) {
    const Json& statistics = technique_costs[technique];
    return fmt::format("{:.3g} at {:.3g} rays", statistics["relative_variance"].get<double>(),
                       statistics["rays"].get<double>());
  };
  return fmt::format(
      "balance      {} photons per sample, a camera path per pixel in 1 of {} samples; relative variance {} "
      "per camera path, {} per photon and pixel\n",
      technique_costs["photons_per_sample"].get<std::uint64_t>(),
      technique_costs["path_interval"].get<std::uint32_t>(), cost("camera_paths"), cost("photons"));
}

std::string lens_line(const Json& lens) {
  const auto number = [&lens](const char* key) { return lens[key].get<double>(); };
  const double focal_length = number("focal_length_mm");
  std::string line = fmt::format(
      "lens         {}: {}, film {:.5g} mm behind it", lens["title"].get<std::string>(),
      std::isfinite(focal_length) ? fmt::format("focal length {:.5g} mm", focal_length) : "afocal",
      number("image_mm"));
  if (const auto ghosts = lens["ghosts"].get<std::size_t>(); ghosts > 0)
    line += fmt::format(", {} {}", ghosts, ghosts == 1 ? "ghost" : "ghosts");
  if (!lens.contains("f_number")) return line + "\n";
  if (std::isfinite(number("f_number")))
    line += fmt::format(", f/{:.4g} (T/{:.4g})", number("f_number"), number("t_stop"));
  return line + fmt::format(", Airy radius {:.3g} um at {:g} nm (diffraction is not rendered)\n",
                            number("airy_radius_um"), number("wavelength_nm"));
}

// True if a scene in this folder names the file by a path relative to the folder.
bool is_inside_folder(const fs::path& file, const fs::path& folder) {
  return file.is_relative() ||
         (folder.is_absolute() &&
          std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end());
}

// Relative file names would refer to other files in another folder.
void require_same_folder(const ConvertOptions& options, const Inputs& inputs) {
  const auto real = [](const fs::path& folder) { return folder.empty() ? fs::path(".") : folder; };
  const fs::path folder = options.scene.parent_path();
  std::error_code ignored;
  if (fs::equivalent(real(folder), real(options.output.parent_path()), ignored)) return;
  for (const fs::path& file : inputs.files())
    if (file != options.scene && is_inside_folder(file, folder))
      throw Error(ErrorCode::usage, options.output.string(),
                  fmt::format("is in another folder than the scene, which names the file {} (allowed: the "
                              "folder {} or standard output)",
                              file.string(), real(folder).string()));
}

// Converts a scene of another renderer. File names become relative to the folder of the output.
std::string converted(const ConvertOptions& options, Inputs& inputs) {
  if (!options.overrides.empty())
    throw Error(
        ErrorCode::usage, "--set",
        "applies to scene files of Abbe only: convert the scene first, then replace values of the result");
  const bool is_file = options.output != kStandardStream;
  const fs::path folder = is_file ? options.output.parent_path() : options.scene.parent_path();
  Diagnostics diagnostics;
  return accepted(convert_scene(options.scene, {folder, options.materials}, diagnostics, &inputs),
                  diagnostics);
}

std::string canonical(const ConvertOptions& options, Inputs& inputs) {
  if (options.materials)
    throw Error(ErrorCode::usage, "--materials", "applies to scenes of other renderers only");
  Diagnostics diagnostics;
  return accepted(canonical_scene(options.scene, options.overrides, diagnostics, &inputs), diagnostics);
}

}  // namespace

std::string describe(const Scene& scene, const IntegratorChoice& choice) {
  const Json answer = answer_for(scene, choice);
  std::string lines = fmt::format(
      "{} shapes ({} triangles), {} lights, {} materials; {} x {} pixels, channels ",
      answer["shapes"].get<int>(), answer["triangles"].get<std::size_t>(), answer["lights"].get<int>(),
      answer["materials"].get<int>(), scene.camera.width, scene.camera.height);
  for (const Channel& channel : scene.channels) lines += channel.name + " ";
  if (scene.mosaic) lines += fmt::format("in a mosaic {}", pattern(scene));
  lines += "\n";
  if (!answer["lens"].is_null()) lines += lens_line(answer["lens"]);
  lines += "needs\n";
  for (const FeatureName& need : feature_names())
    if (scene.features.*need.member)
      lines += fmt::format("  {:<21} {} ({})\n", need.key, need.meaning, scene.features.reasons.at(need.key));
  lines += "skips\n";
  for (const FeatureName& need : feature_names())
    if (!(scene.features.*need.member)) lines += fmt::format("  {}\n", need.key);
  lines += fmt::format("integrator   {}{}\n", integrator_name(choice.integrator),
                       choice.reason.empty() ? "" : fmt::format(" ({})", choice.reason));
  lines += "techniques\n";
  for (const auto& [technique, paths] : answer["owned"].items())
    lines += fmt::format("  {:<10} {}\n", technique, paths.get<std::string>());
  if (!answer["shares"].is_null()) lines += technique_costs_line(answer["shares"]);
  if (const int parts = answer["path_splitting"].get<int>(); parts > 1)
    lines += fmt::format("splitting    camera paths continue in {} directions from their first scattering\n",
                         parts);
  if (!answer["bias"].is_null()) lines += fmt::format("bias         {}\n", answer["bias"].get<std::string>());
  lines += fmt::format("not sampled  {}\n", joined(answer["unreached"]));
  if (answer.contains("wavelength_range_nm"))
    lines += fmt::format("wavelengths  {:g} to {:g} nm\n", answer["wavelength_range_nm"][0].get<double>(),
                         answer["wavelength_range_nm"][1].get<double>());
  if (const auto& white = scene.output.white)
    lines += fmt::format("white        {} (x {:.4f}, y {:.4f}: {})\n", white->name, white->xy[0],
                         white->xy[1], white->reason);
  return lines + fmt::format("memory       {}\n", bytes_text(answer["memory_bytes"].get<std::size_t>()));
}

void note_polarisation(const Scene& scene) {
  if (!scene.features.polarisation_relevant || scene.render.polarisation) return;
  print_message(fmt::format(
      "render/polarisation is \"off\", which affects the image after {}: a prism is 0.3 % too dark with "
      "N-BK7, 3 % with N-SF11, and crossed mirrors by any factor (docs/reference/physics.md)",
      scene.features.reasons.at("polarisation_matters")));
}

namespace {

void info(const InfoOptions& options) {
  Diagnostics diagnostics;
  Inputs inputs(options.max_memory_bytes);
  Scene scene = accepted(load_scene(options.scene, options.overrides, diagnostics, &inputs), diagnostics);
  const IntegratorChoice choice = choose_integrator(scene, thread_count(0));
  scene.render.integrator = choice.integrator;
  resolve_white(scene, options.scene, 1, choice.guides);
  if (options.json)
    print(answer_for(scene, choice), true);
  else
    fmt::print("{}", describe(scene, choice));
  if (const auto refused = refusal(scene)) warn(refused->what());
  warn(ignored_polarisation_warning(scene));
  warn(field_tint_warning(neutral_shift(scene).value_or(0),
                          "develop --field balances pictures over the field"));
  warn(dark_camera_warning(scene));
  warn(coincidence_warning(scene));
  warn(unused_settings_warning(scene));
  note_polarisation(scene);
}

void convert(const ConvertOptions& options) {
  const bool is_file = options.output != kStandardStream;
  if (is_file) {
    require_extension(options.output, {".json"});
    require_writable(options.output);
  }
  const bool is_imported = is_importable_scene(options.scene);
  Inputs inputs(options.max_memory_bytes);
  const std::string text = is_imported ? converted(options, inputs) : canonical(options, inputs);
  if (is_file) require_distinct(std::array{options.output}, inputs.files());
  if (is_file && !is_imported) require_same_folder(options, inputs);
  if (is_file)
    write_atomically(options.output, text);
  else
    fmt::print("{}", text);
}

}  // namespace

void add_info(CLI::App& app, Command& command) {
  const Subcommand<InfoOptions> sub(
      app, "info",
      "Report what a scene contains, which features its render needs, and which integrator it uses", command,
      info);
  add_scene(*sub.app, sub->scene);
  add_overrides(*sub.app, sub.options);
  add_max_memory(*sub.app, sub.options);
  add_json(*sub.app, sub->json);
}

void add_convert(CLI::App& app, Command& command) {
  const Subcommand<ConvertOptions> sub(
      app, "convert",
      "Write a scene file in canonical form, without comments and default values, or convert a scene of pbrt "
      "(.pbrt), Mitsuba (.xml) or glTF (.gltf, .glb) to a scene file",
      command, convert);
  add_value(*sub.app, "scene", sub->scene,
            "Scene file of Abbe or of another renderer, or - for standard input", "SCENE")
      ->required();
  add_value(*sub.app, "-o,--output", sub->output,
            "File to write, in the folder of the scene if the scene names files (default: - for "
            "standard output)",
            "FILE.json");
  add_value(*sub.app, "--materials", sub->materials,
            "Materials that replace those of another renderer's scene, by name: {NAME: MATERIAL, ...} "
            "as in scene files",
            "FILE.json");
  add_overrides(*sub.app, sub.options);
  add_max_memory(*sub.app, sub.options);
}

}  // namespace abbe::cli
