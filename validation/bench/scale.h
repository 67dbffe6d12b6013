#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace abbe {

/// What a scene costs by the number of something in it: "triangles", "shapes", "instances" of a mesh of 8000
/// triangles, "lights" or "channels".
struct ScaleRow {
  std::string subject;
  std::uint64_t count;
  double load_cpu_s;      ///< Reading, checking and building.
  double build_cpu_s;     ///< Of it, Embree's structure and the needs.
  double plan_cpu_s;      ///< What a render works out first.
  double bytes;           ///< Of the geometry per one more of the subject.
  double rays_per_cpu_s;  ///< Once planned.
};

/// Makes, loads and renders a scene for each subject and count, ten times as many from one to the next; the
/// largest are left out with `quick`. Files go to `folder`, which must exist. Throws Error{output}.
[[nodiscard]] std::vector<ScaleRow> measure_scale(const std::filesystem::path& folder, int threads,
                                                  bool quick);

/// The power of the count by which a figure grew over the last step of its subject.
[[nodiscard]] double growth(const ScaleRow& before, const ScaleRow& after, double ScaleRow::*figure);

/// The rows as a table, each with the powers by which load, plan and rays per second grew since the row
/// before.
[[nodiscard]] std::string readable_text(const std::vector<ScaleRow>& rows);

}  // namespace abbe
