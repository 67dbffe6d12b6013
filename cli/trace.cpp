#include "cli/trace.h"

#include <fmt/format.h>

#include "cli/answer.h"
#include "description/load.h"
#include "transport/path/ray_trace.h"
#include "validation/layout/lamp_rays.h"

namespace abbe::cli {
namespace {

Json list(const Imath::V3d& v) {
  return {v.x, v.y, v.z};
}

const char* name(TraceEvent::Kind kind) {
  switch (kind) {
    case TraceEvent::Kind::refract:
      return "refract";
    case TraceEvent::Kind::reflect:
      return "reflect";
    case TraceEvent::Kind::total_reflection:
      return "total_reflection";
    case TraceEvent::Kind::hit:
      return "hit";
    case TraceEvent::Kind::escape:
      break;
  }
  return "escape";
}

// A point of the scene [m] in the coordinates and units of its file.
Json file_point(const Scene& scene, const Imath::V3d& point) {
  return list((point + scene.origin_m) / scene.unit_m);
}

Json event_answer(const Scene& scene, const TraceEvent& event) {
  Json answer{{"kind", name(event.kind)}};
  if (event.kind == TraceEvent::Kind::escape) return answer;
  answer["point"] = file_point(scene, event.at.point);
  answer["normal"] = list(event.at.normal);
  answer["shape"] = scene.shapes[event.shape].name;
  if (!event.passage) return answer;
  const Passage& passage = *event.passage;
  answer["n_from"] = passage.n_from;
  answer["n_to"] = passage.n_to;
  if (passage.k_to > 0) answer["k_to"] = passage.k_to;
  answer["angle_in_deg"] = passage.angle_in_deg;
  answer["angle_out_deg"] = passage.angle_out_deg;
  answer["Rs"] = passage.Rs;
  answer["Rp"] = passage.Rp;
  return answer;
}

void warn_beyond_data(const Scene& scene, const RayTrace& trace, double wavelength_nm) {
  for (const TraceEvent& event : trace.events) {
    if (!event.passage) continue;
    const Material& material = scene.materials[scene.shapes[event.shape].material];
    const auto* metal = std::get_if<ConductorMaterial>(&material.model);
    const RefractiveIndex* index = metal != nullptr ? &metal->index : interior(material);
    if (index == nullptr) continue;  // matter without an interface
    if (wavelength_nm >= index->low_nm() && wavelength_nm <= index->high_nm()) continue;
    say(fmt::format("warning: the index of material \"{}\" is held from the end of its data, [{:g}, {:g}] nm",
                    material.name, index->low_nm(), index->high_nm()));
    return;
  }
}

void print_readable(const Json& answer) {
  for (const Json& event : answer["events"]) {
    fmt::print("{}\n", event["kind"].get<std::string>());
    for (const auto& [key, value] : event.items())
      if (key != "kind") fmt::print("  {}", text({{key, value}}, false));
  }
  for (const char* key : {"final_origin", "final_dir", "deviation_deg"}) print({{key, answer[key]}}, false);
}

BasicRay<double> first_ray(const Scene& scene, const TraceOptions& options) {
  if (options.direction && !(options.direction->length() > 0))
    throw Error(ErrorCode::usage, "--dir", "a direction must not be zero");
  if (options.origin && options.direction)
    return {*options.origin * scene.unit_m - scene.origin_m, options.direction->normalized()};
  if (options.light.empty())
    throw Error(ErrorCode::usage, "trace", "needs --origin and --dir, or --from-light");
  std::optional<BasicRay<double>> ray = middle_ray(scene, light_named(scene, options.light, "--from-light"));
  if (!ray) throw Error(ErrorCode::usage, "--from-light", "light from everywhere has no middle");
  if (options.direction) ray->direction = options.direction->normalized();
  return *ray;
}

}  // namespace

int trace(const TraceOptions& options) {
  Diagnostics diagnostics;
  Inputs inputs(options.max_memory_bytes);
  const Scene scene = accepted(load_scene(options.scene, {}, diagnostics, &inputs), diagnostics);
  const BasicRay<double> ray = first_ray(scene, options);
  const RayTrace trace = trace_ray(scene, ray, options.wavelength_nm, options.max_events);
  Json answer;
  answer["events"] = Json::array();
  for (const TraceEvent& event : trace.events) answer["events"].push_back(event_answer(scene, event));
  answer["final_origin"] = file_point(scene, trace.last.origin);
  answer["final_dir"] = list(trace.last.direction);
  answer["deviation_deg"] = angle_deg(ray.direction, trace.last.direction);
  if (options.json)
    print(answer, true);
  else
    print_readable(answer);
  warn_beyond_data(scene, trace, options.wavelength_nm);
  if (trace.cut_short) say(fmt::format("warning: stopped after {} events", options.max_events));
  return 0;
}

}  // namespace abbe::cli
