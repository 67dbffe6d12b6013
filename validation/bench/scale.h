#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace abbe {

/// Cost of a scene as a function of the number of one kind of item. The subject is "triangles", "shapes",
/// "instances" (of a mesh of 8000 triangles), "lights" or "channels".
struct ScaleRow {
  std::string subject;
  std::uint64_t count;
  double load_cpu_s;  ///< CPU time for reading, checking and building the scene.
  /// Part of `load_cpu_s` that builds Embree's structure and finds the scene's features.
  double build_cpu_s;
  double plan_cpu_s;      ///< CPU time for the plan that a render makes first.
  double bytes;           ///< Bytes of geometry per item.
  double rays_per_cpu_s;  ///< Rays per second of CPU time, without the plan.
};

/// Writes, loads and renders a scene for each subject and count. The counts grow by factors of 4 to 10;
/// `quick` omits all but the first two. Files are written to `folder`, which must exist. Throws
/// Error{output}.
[[nodiscard]] std::vector<ScaleRow> measure_scale(const std::filesystem::path& folder, int threads,
                                                  bool quick);

/// Exponent p of the growth figure ~ count^p between two rows of a subject.
[[nodiscard]] double growth(const ScaleRow& before, const ScaleRow& after, double ScaleRow::*figure);

/// Table of the rows in plain text. Each row shows the exponents by which load time and rays per second grew
/// since the previous row.
[[nodiscard]] std::string readable_text(const std::vector<ScaleRow>& rows);

}  // namespace abbe
