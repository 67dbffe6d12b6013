#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "transport/path/film_response.h"
#include "transport/path/path_batch.h"
#include "transport/path/path_recorder.h"
#include "transport/plan/plan.h"
#include "transport/technique/path.h"

namespace abbe {

/// Common part of both brute-force techniques [Marschner2021, ch. 14]. Paths have one wavelength each and are
/// never connected. An event preserves the throughput or absorbs the path at random.
template <TransportMode mode>
class BruteForceTechnique : public PathCallbacks<mode> {
 public:
  using Path = RecordedPath;

  /// Sets throughput and pdf of all wavelengths but the hero to 0.
  static void keep_hero_only(PathPacket& packet);

  // Callbacks (`PathCallbacks`).
  [[nodiscard]] std::optional<BsdfSample> scatter(RecordedPath& path, const SurfaceVertex& vertex,
                                                  const BsdfRandom& u) const;
};

/// Brute-force photon tracing: photons of one wavelength each that enter the camera's opening, or hit its
/// probe, by chance. One instance per thread.
///
/// Path classes owned: all, except light to a camera without an opening, and light from a directional or
/// point light to a probe that is a point. Deposited values are those of one sample per pixel.
class BrutePhotonTracer : public BruteForceTechnique<TransportMode::power>, public LayerSource {
 public:
  /// `sample_fraction` is the fraction of a sample per pixel that one photon represents: one over the number
  /// of photons per sample. Plan and caster must outlive the tracer.
  BrutePhotonTracer(const Plan& plan, RayCaster& caster, double sample_fraction);

  /// Traces a photon for each sampler and deposits those that the camera records, under the photon's index in
  /// `photons`. Throws Error{resource} if more than `MediumStack::kMaxShapes` media nest.
  void trace(std::span<const Sampler> photons, const Deposit& deposit);

  // Callbacks (`PathCallbacks`).
  [[nodiscard]] float survival_weight(RecordedPath& path, const SurfaceVertex& /*vertex*/,
                                      const BsdfSample& /*event*/) {
    return record_camera_hit(path, path.depth + 1), 1.0F;
  }
  [[nodiscard]] float survival_weight_in_medium(RecordedPath& path) {
    return record_camera_hit(path, path.depth + 1), 1.0F;
  }

 private:
  // Records the path if its current ray, at the given depth, enters the opening.
  void record_camera_hit(const RecordedPath& path, int depth);

  const Plan& plan_;
  const Scene& scene_;
  RayCaster& caster_;
  std::optional<Opening> opening_;
  float scale_;
  bool measures_polarisation_;
  FilmResponse response_;
  PathBatch<BrutePhotonTracer> batch_;
  const Deposit* deposit_ = nullptr;
};

/// Brute-force adjoint tracing: paths of one wavelength each from the pixels that hit lights by chance. One
/// instance per thread.
///
/// Path classes owned: all that end on an area, environment or sun light. Deposited values are those of one
/// sample per pixel.
class AdjointBruteTracer : public BruteForceTechnique<TransportMode::radiance>, public LayerSource {
 public:
  /// Plan and caster must outlive the tracer.
  AdjointBruteTracer(const Plan& plan, RayCaster& caster);

  /// Traces a path for each sample and deposits each sum under its sample's index in `samples`. Throws
  /// Error{resource} if more than `MediumStack::kMaxShapes` media nest.
  void trace(std::span<const PixelSample> samples, const Deposit& deposit);

  // Callbacks (`PathCallbacks`).
  void on_escape(RecordedPath& path);
  void on_hit(RecordedPath& path, const SurfaceHit& hit);
  [[nodiscard]] float survival_weight(RecordedPath& /*path*/, const SurfaceVertex& /*vertex*/,
                                      const BsdfSample& /*event*/) const {
    return 1;
  }

 private:
  void add_emission(const RecordedPath& path, std::uint32_t light);
  template <typename Contribution, typename DepositAt>
  void expose(const RecordedPath& path, const Contribution& contribution, DepositAt deposit);

  const Plan& plan_;
  const Scene& scene_;
  FilmResponse response_;
  PathBatch<AdjointBruteTracer> batch_;
  std::vector<FilmPoint> film_points_;    // film point of each path
  std::vector<WavelengthImages> images_;  // film position per wavelength, for lenses that disperse them
  PathRadiance radiance_;                 // sums of each path
};

}  // namespace abbe
