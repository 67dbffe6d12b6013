#include "cli/rays.h"

#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "cli/answer.h"
#include "cli/output_files.h"
#include "io/atomic_file.h"
#include "io/text.h"
#include "report/layout.h"
#include "report/light_rays.h"

namespace abbe::cli {
namespace {

Json list(const Imath::V3d& v) {
  return {v.x, v.y, v.z};
}

// Names in the order of `TraceEvent::Kind`.
constexpr std::array kEventNames{"refract", "reflect", "total_reflection", "hit", "escape"};

// A point of the scene [m] in the coordinates and units of its file.
Json file_point(const Scene& scene, const Imath::V3d& point) {
  return list((point + scene.origin_m) / scene.unit_m);
}

Json matrix(const FullMueller& mueller) {
  Json rows = Json::array();
  for (const StokesVector& row : mueller.rows) rows.push_back(row);
  return rows;
}

Json event_answer(const Scene& scene, const TraceEvent& event) {
  Json answer{{"kind", kEventNames.at(static_cast<std::size_t>(event.kind))}};
  if (event.kind == TraceEvent::Kind::escape) return answer;
  answer["point"] = file_point(scene, event.at.point);
  answer["normal"] = list(event.at.normal);
  answer["shape"] = scene.shapes[event.shape].name;
  if (const auto& polarisation = event.polarisation) {
    answer["axis"] = list(polarisation->axis);
    answer["mueller"] = matrix(polarisation->mueller);
    answer["stokes"] = polarisation->stokes;
  }
  if (!event.passage) return answer;
  const Passage& passage = *event.passage;
  answer["n_from"] = passage.n_from;
  if (passage.n_to > 0) answer["n_to"] = passage.n_to;
  if (passage.k_to > 0) answer["k_to"] = passage.k_to;
  answer["angle_in_deg"] = passage.angle_in_deg;
  answer["angle_out_deg"] = passage.angle_out_deg;
  answer["Rs"] = passage.Rs;
  answer["Rp"] = passage.Rp;
  return answer;
}

// Adds the events of a branch, its last ray and its polarisation; in a tree also fractions of the power.
void add_path(const Scene& scene, const RayTrace& trace, bool tree, const StokesVector& light, Json& answer) {
  answer["events"] = Json::array();
  for (const TraceEvent& event : trace.events) {
    Json event_json = event_answer(scene, event);
    if (tree) event_json["share"] = event.power_fraction;
    if (tree && event.kind != TraceEvent::Kind::escape) {
      event_json["R"] = event.R;
      event_json["T"] = event.T;
    }
    answer["events"].push_back(std::move(event_json));
  }
  answer["final_origin"] = file_point(scene, trace.last.origin);
  answer["final_dir"] = list(trace.last.direction);
  answer["first_axis"] = list(trace.polarisation.first_axis);
  answer["last_axis"] = list(trace.polarisation.last_axis);
  answer["mueller"] = matrix(trace.polarisation.mueller);
  answer["stokes"] = trace.polarisation.mueller * light;
}

Json branch_answer(const Scene& scene, const RayTree& tree, std::size_t number, const StokesVector& light) {
  const RayBranch& branch = tree.branches[number];
  Json answer{{"branch", number},
              {"from_branch", branch.from},
              {"from_event", branch.event},
              {"share", branch.power_fraction}};
  add_path(scene, branch.trace, true, light, answer);
  answer["deviation_deg"] = angle_deg(tree.branches.front().start.direction, branch.trace.last.direction);
  return answer;
}

Json tree_answer(const Scene& scene, const RayTree& tree, bool with_branches, const StokesVector& light) {
  const RayBranch& main = tree.branches.front();
  Json answer;
  add_path(scene, main.trace, with_branches, light, answer);
  answer["deviation_deg"] = angle_deg(main.start.direction, main.trace.last.direction);
  if (!with_branches) return answer;
  answer["branches"] = Json::array();
  for (std::size_t i = 1; i < tree.branches.size(); ++i)
    answer["branches"].push_back(branch_answer(scene, tree, i, light));
  answer["cut_branches"] = tree.truncated;
  answer["cut_share"] = tree.truncated_power;
  return answer;
}

// Warns of branches and events that the limits cut off.
void warn_cut(const RayTree& tree, const TraceOptions& options, const FollowLimits& limits) {
  if (options.follow == Follow::both && tree.truncated > 0)
    print_message(
        fmt::format("warning: {} branches with {:.2g} of the power were cut off at the limits of {} events, "
                    "{} branches and a power fraction of {:g}",
                    tree.truncated, tree.truncated_power, limits.max_events, limits.max_branches,
                    limits.min_power_fraction));
  else if (tree.branches.front().trace.truncated)
    print_message(fmt::format("warning: stopped after {} events", limits.max_events));
}

void print_events(const Json& events) {
  for (const Json& event : events) {
    fmt::print("{}\n", event["kind"].get<std::string>());
    for (const auto& [key, value] : event.items())
      if (key != "kind") fmt::print("  {}", text({{key, value}}, false));
  }
}

void print_readable(const Json& answer) {
  const auto print_rest = [](const Json& path) {
    for (const auto& [key, value] : path.items())
      if (key != "events" && key != "branches") print({{key, value}}, false);
  };
  print_events(answer["events"]);
  print_rest(answer);
  if (!answer.contains("branches")) return;
  for (const Json& branch : answer["branches"]) {
    fmt::print("\n");
    print_rest(branch);
    print_events(branch["events"]);
  }
}

// Ray from --origin and --dir, or from the light, in the coordinates of the scene [m].
BasicRay<double> first_ray(const Scene& scene, const TraceOptions& options) {
  if (options.direction && !(options.direction->length() > 0))
    throw Error(ErrorCode::usage, "--dir", "a direction must not be zero");
  if (options.origin && options.direction)
    return {*options.origin * scene.unit_m - scene.origin_m, options.direction->normalized()};
  if (options.light.empty())
    throw Error(ErrorCode::usage, "trace", "needs --origin and --dir, or --from-light");
  std::optional<BasicRay<double>> ray = central_ray(scene, light_named(scene, options.light, "--from-light"));
  if (!ray)
    throw Error(ErrorCode::usage, "--from-light",
                "has no central ray, since this light comes from all directions");
  if (options.direction) ray->direction = options.direction->normalized();
  return *ray;
}

// The requested ray, or those of the lights, in the coordinates of the scene [m].
std::vector<BasicRay<double>> rays_of(const Scene& scene, const DrawOptions& options) {
  if (options.origin)
    return {{*options.origin * scene.unit_m - scene.origin_m, options.direction.normalized()}};
  std::vector<BasicRay<double>> rays;
  if (options.rays == 0) return rays;
  for (const Light& light : scene.lights)
    for (const BasicRay<double>& ray : light_rays(scene, light, options.rays)) rays.push_back(ray);
  return rays;
}

// Warning for the first extrapolated index on the path of a ray of this wavelength [nm]; empty if there is
// none.
std::optional<std::string> first_extrapolation(const Scene& scene, const RayTree& tree,
                                               double wavelength_nm) {
  for (const RayBranch& branch : tree.branches)
    for (const TraceEvent& event : branch.trace.events) {
      if (!event.passage) continue;
      const Material& material = material_of(scene, event.shape);
      if (auto warning = extrapolated_index_warning(material, wavelength_nm)) return warning;
    }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> extrapolated_index_warning(const Material& material, double wavelength_nm) {
  const auto warning = [&](std::string_view quantity, const DataRange& data) {
    return fmt::format("the {} of material \"{}\" is extrapolated from the end of its data, [{:g}, {:g}] nm",
                       quantity, material.name, data.low_nm, data.high_nm);
  };
  for (const IndexUse& use : indices(material)) {
    const DataRange n{use.index->low_nm(), use.index->high_nm()};
    if (!n.contains(wavelength_nm)) return warning("index", n);
    const auto& k = use.index->k_range();
    if (k && !k->contains(wavelength_nm)) return warning("extinction", *k);
  }
  return std::nullopt;
}

void trace(const TraceOptions& options) {
  Diagnostics diagnostics;
  Inputs inputs(options.max_memory_bytes);
  const Scene scene =
      accepted(load_scene(options.scene, options.overrides, diagnostics, &inputs), diagnostics);
  const BasicRay<double> ray = first_ray(scene, options);
  const FollowLimits limits{.max_events = options.max_events};
  const RayTree tree = follow_ray(scene, ray, options.wavelength_nm, options.follow, limits, options.stokes);
  const Json answer = tree_answer(scene, tree, options.follow == Follow::both, options.stokes);
  if (options.json)
    print(answer, true);
  else
    print_readable(answer);
  warn(first_extrapolation(scene, tree, options.wavelength_nm));
  warn_cut(tree, options, limits);
}

void draw(const DrawOptions& options) {
  require_extension(options.output, {".svg"});
  require_writable(options.output);
  if (options.origin && !(options.direction.length() > 0))
    throw Error(ErrorCode::usage, "--dir", "a direction must not be zero");
  Diagnostics diagnostics;
  Inputs inputs(options.max_memory_bytes);
  const Scene scene =
      accepted(load_scene(options.scene, options.overrides, diagnostics, &inputs), diagnostics);
  require_distinct(std::array{options.output}, inputs.files());
  const FollowLimits limits{.max_events = options.max_events, .min_power_fraction = kMinDrawnFraction};
  std::vector<DrawnRay> drawn;
  std::optional<std::string> warning;
  for (const double nm : options.wavelengths_nm)
    for (const BasicRay<double>& ray : rays_of(scene, options)) {
      const RayTree tree = follow_ray(scene, ray, nm, options.follow, limits);
      if (!warning) warning = first_extrapolation(scene, tree, nm);
      for (DrawnRay& drawn_ray : drawn_rays(scene, tree, nm)) drawn.push_back(std::move(drawn_ray));
    }
  const std::string name = options.scene == kStandardStream ? "stdin" : options.scene.filename().string();
  write_atomically(options.output, layout_drawing(scene, drawn, name));
  warn(warning);
}

}  // namespace abbe::cli
