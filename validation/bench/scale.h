#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace abbe {

/// Cost of a scene with a given number of one kind of item. CPU times are those of all threads.
struct ScaleRow {
  /// "triangles", "shapes" (spheres), "instances" (of a mesh of 7938 triangles), "lights" or "channels".
  std::string subject;
  std::uint64_t count;  ///< Number of items requested; the triangles of a mesh may be slightly fewer.
  double load_cpu_s;    ///< CPU time for reading, checking and building the scene.
  /// Part of `load_cpu_s` that builds Embree's structure and finds the scene's features.
  double build_cpu_s;
  double plan_cpu_s;      ///< CPU time for the plan that a render makes first.
  double bytes;           ///< Bytes of all geometry (`Scene::memory_bytes`) divided by `count`.
  double rays_per_cpu_s;  ///< Rays per second of CPU time of a render, without the plan.
};

/// Writes to the existing `folder`, loads and renders a scene for each subject and count. `quick` omits all
/// but the first two counts. Rows are sorted by subject, then by count. Throws Error{output} if a file
/// cannot be written, and the errors of `render`.
[[nodiscard]] std::vector<ScaleRow> measure_scale(const std::filesystem::path& folder, int threads,
                                                  bool quick);

/// Exponent p of the growth figure ~ count^p between two rows of a subject with different counts; both
/// figures must be positive.
[[nodiscard]] double growth(const ScaleRow& before, const ScaleRow& after, double ScaleRow::*figure);

/// Table of the rows in plain text. Each row shows the exponents by which load time and rays per second grew
/// since the previous row.
[[nodiscard]] std::string readable_text(const std::vector<ScaleRow>& rows);

}  // namespace abbe
