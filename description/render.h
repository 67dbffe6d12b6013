#pragma once

#include <cstdint>
#include <optional>

#include "io/schema/fields.h"
#include "scene/scene.h"

namespace abbe::spec {

/// Settings of photon tracing and gathering.
struct Photons {
  /// Photons per sample. If absent, the number of pixels, but at least 16384.
  std::optional<std::uint64_t> per_sample;
  /// Initial gathering radius [scene units]; by default from the size of the scene and the number of photons.
  std::optional<double> radius;
  int nearest = 50;           ///< Number of nearest photons in an estimate of the integrator `photon-map`.
  bool final_gather = false;  ///< True if `photon-map` gathers one event after the first scattering surface.
};

/// Mode in which paths carry polarisation: where it changes the result (`automatic`), or never (`off`).
enum class PolarisationMode { automatic, off };

/// Settings of a render.
struct Render {
  Integrator integrator = Integrator::automatic;
  int samples = 64;              ///< Samples per pixel.
  std::optional<int> max_depth;  ///< Largest number of scattering events of a path; unlimited if absent.
  schema::Located<int> roulette_depth{{4}, {}};  ///< Events before Russian roulette begins; -1 disables it.
  std::uint64_t seed = 0;                        ///< Seed of the random numbers.
  std::optional<Photons> photons;                ///< Defaults if absent.
  /// True to let `auto` choose `vcm` for light paths that no unbiased integrator can sample.
  schema::Located<bool> consistent;
  PolarisationMode polarisation = PolarisationMode::automatic;
  schema::Located<DirectionSampling> directions;  ///< Only for the integrator `path`.
  schema::Located<LightStrategy> lights;          ///< Only for the integrator `path`.
  schema::Located<MisHeuristic> heuristic;  ///< Only for the integrator `path` with the light strategy `mis`.
};
/// Key table by which scene files are read, written and documented.
[[nodiscard]] schema::Fields fields(schema::Tag<Render>);

}  // namespace abbe::spec

namespace abbe::description {

/// Builds the settings of a render, with lengths in metres; `render` has them in scene units of `unit_m`
/// metres. Returns settings also after an error. Reports to `diagnostics`:
/// - Russian roulette that never ends a path, without `max_depth`;
/// - path sampling options other than the defaults, with another integrator than `path`;
/// - another MIS heuristic than the default, if `lights` uses only one technique;
/// - `consistent` with another integrator than `auto`.
[[nodiscard]] RenderSettings build(const spec::Render& render, double unit_m, Diagnostics& diagnostics);

}  // namespace abbe::description

namespace abbe {

// Largest values that scene files, the command line and Python accept for a render.

/// Samples per pixel: a float counts integers exactly up to here.
inline constexpr std::int64_t kMaxSamples = 1 << 24;
/// Seed of the random numbers: JSON numbers hold integers exactly up to here.
inline constexpr std::int64_t kMaxSeed = (std::int64_t{1} << 53) - 1;
inline constexpr std::int64_t kMaxThreads = 1024;                   ///< Threads of a render.
inline constexpr std::int64_t kMaxPhotons = std::int64_t{1} << 31;  ///< Photons per sample.

}  // namespace abbe
