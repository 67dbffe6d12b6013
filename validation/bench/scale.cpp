#include "validation/bench/scale.h"

#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "description/load.h"
#include "io/atomic_file.h"
#include "transport/render/cost.h"
#include "transport/render/render.h"
#include "transport/render/trained_plan.h"
#include "validation/bench/generated_scene.h"

namespace abbe {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kInstancedCells = 63;  // 7938 triangles on 40 m

// A subject, its counts and the function that writes a scene's files and returns its description.
struct Subject {
  const char* name;
  std::vector<std::uint64_t> counts;
  std::function<std::string(std::uint64_t count, const fs::path& folder)> describe;
};

constexpr const char* kGrey = R"({"grey": {"diffuse": {"reflectance": 0.5}}})";
constexpr const char* kGround =
    R"({"quad": {"corner": [20, 0, -20], "edge_u": [-40, 0, 0], "edge_v": [0, 0, 40]}, "material": "grey"})";
constexpr const char* kSky = R"({"environment": {}, "emission": {"spectrum": 1, "luminance": 100}})";
constexpr const char* kObserver = R"("observer": "1931")";

std::string scene_text(const std::string& shapes, const std::string& lights,
                       const std::string& objects = "{}", const std::string& sensor = kObserver) {
  return fmt::format(
      R"({{"abbe": 1, "camera": {{"pinhole": {{"fov_deg": 45}}, "from": [0, 12, -30], "to": [0, 0, 0], "up": [0, 1, 0]}},
"sensor": {{"resolution": [256, 256], {}}}, "materials": {}, "objects": {},
"lights": [{}], "shapes": [{}], "render": {{"samples": 4, "max_depth": 6}}}})",
      sensor, kGrey, objects, lights, shapes);
}

// Entries on a square grid over the ground; `entry` receives the position and the spacing of the grid.
std::string grid(std::uint64_t count,
                 const std::function<std::string(double x, double z, double step)>& entry) {
  const auto side = static_cast<std::uint64_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  const double step = 40.0 / static_cast<double>(side);
  std::string all;
  const auto center = [step](std::uint64_t cell) { return (static_cast<double>(cell) + 0.5) * step - 20; };
  for (std::uint64_t i = 0; i < count; ++i)
    all += (i == 0 ? "" : ",\n") + entry(center(i % side), center(i / side), step);
  return all;
}

std::string triangles(std::uint64_t count, const fs::path& folder) {
  write_ply(folder / "terrain.ply",
            make_terrain(static_cast<std::uint32_t>(std::sqrt(static_cast<double>(count) / 2))));
  return scene_text(R"({"mesh": "terrain.ply", "material": "grey"})", kSky);
}

std::string shapes(std::uint64_t count, const fs::path&) {
  return scene_text(grid(count,
                         [](double x, double z, double step) {
                           return fmt::format(
                               R"({{"sphere": {{"center": [{}, 0, {}], "radius": {}}}, "material": "grey"}})",
                               x, z, step / 3);
                         }),
                    kSky);
}

std::string instances(std::uint64_t count, const fs::path& folder) {
  write_ply(folder / "piece.ply", make_terrain(kInstancedCells));
  return scene_text(
      grid(
          count,
          [](double x, double z, double step) {
            return fmt::format(
                R"({{"instance": {{"of": "piece", "transform": {{"scale": {}, "translate": [{}, 0, {}]}}}}}})",
                step / 60, x, z);
          }),
      kSky, R"({"piece": {"shapes": [{"mesh": "piece.ply", "material": "grey"}]}})");
}

std::string lights(std::uint64_t count, const fs::path&) {
  const auto light = [](double x, double z, double step) {
    return fmt::format(
        R"({{"sphere": {{"center": [{}, 3, {}], "radius": {}}}, "emission": {{"illuminant": "A", "luminance": 1000}}}})",
        x, z, step / 10);
  };
  return scene_text(kGround, grid(count, light));
}

std::string channels(std::uint64_t count, const fs::path&) {
  std::string bands;
  const double width = 300.0 / static_cast<double>(count);
  for (std::uint64_t i = 0; i < count; ++i)
    bands += fmt::format(R"({}"band{}": {{"band": [{}, {}]}})", i == 0 ? "" : ", ", i,
                         400 + width * static_cast<double>(i), 400 + width * static_cast<double>(i + 1));
  return scene_text(kGround, kSky, "{}", fmt::format(R"("channels": {{{}}})", bands));
}

Scene load(const fs::path& path) {
  Diagnostics diagnostics;
  std::optional<Scene> scene = load_scene(path, {}, diagnostics);
  if (!scene) throw Error(ErrorCode::internal, path.string(), diagnostics.text());
  return std::move(*scene);
}

// CPU time of all threads [s].
double cpu_seconds_of(const std::function<void()>& work) {
  const double start = process_cpu_seconds();
  work();
  return process_cpu_seconds() - start;
}

ScaleRow measure(const Subject& subject, std::uint64_t count, const fs::path& folder, int threads) {
  const fs::path path = folder / "scale.json";
  write_atomically(path, subject.describe(count, folder));
  ScaleRow row{subject.name, count, 0, 0, 0, 0, 0};
  std::optional<Scene> scene;
  row.load_cpu_s = cpu_seconds_of([&] { scene = load(path); });
  row.build_cpu_s = cpu_seconds_of([&] { scene->commit(); });
  row.plan_cpu_s = cpu_seconds_of([&] { (void)make_trained_plan(*scene, 1); });
  row.bytes = static_cast<double>(scene->memory_bytes()) / static_cast<double>(count);
  RenderOptions options;
  options.threads = threads;
  const RenderStats stats = render(*scene, options).stats;
  row.rays_per_cpu_s = static_cast<double>(stats.rays) / (stats.cpu_s - row.plan_cpu_s);
  return row;
}

}  // namespace

std::vector<ScaleRow> measure_scale(const fs::path& folder, int threads, bool quick) {
  const std::vector<Subject> subjects{{"triangles", {10'000, 100'000, 1'000'000, 10'000'000}, triangles},
                                      {"shapes", {10, 100, 1'000, 10'000, 100'000}, shapes},
                                      {"instances", {10, 100, 1'000, 10'000, 100'000}, instances},
                                      {"lights", {1, 10, 100, 1'000, 10'000}, lights},
                                      {"channels", {1, 4, 16, 64}, channels}};
  std::vector<ScaleRow> rows;
  for (const Subject& subject : subjects)
    for (const std::uint64_t count : subject.counts)
      if (!quick || count <= subject.counts[1]) rows.push_back(measure(subject, count, folder, threads));
  return rows;
}

double growth(const ScaleRow& before, const ScaleRow& after, double ScaleRow::*figure) {
  return std::log(after.*figure / (before.*figure)) /
         std::log(static_cast<double>(after.count) / static_cast<double>(before.count));
}

std::string readable_text(const std::vector<ScaleRow>& rows) {
  constexpr const char* kHeader = "{:>10} {:>9} {:>10} {:>11} {:>10} {:>12} {:>12} {:>18}\n";
  std::string all = fmt::format(kHeader, "subject", "count", "load_cpu_s", "build_cpu_s", "plan_cpu_s",
                                "bytes/count", "rays/cpu_s", "growth load, rays");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const ScaleRow& row = rows[i];
    const bool first = i == 0 || rows[i - 1].subject != row.subject;
    all +=
        fmt::format("{:>10} {:>9} {:>10.3g} {:>11.3g} {:>10.3g} {:>12.4g} {:>12.3g} {:>18}\n", row.subject,
                    row.count, row.load_cpu_s, row.build_cpu_s, row.plan_cpu_s, row.bytes, row.rays_per_cpu_s,
                    first ? ""
                          : fmt::format("{:.2f}, {:.2f}", growth(rows[i - 1], row, &ScaleRow::load_cpu_s),
                                        growth(rows[i - 1], row, &ScaleRow::rays_per_cpu_s)));
  }
  return all;
}

}  // namespace abbe
