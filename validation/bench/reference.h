#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "io/image.h"
#include "scene/scene.h"

namespace abbe {

/// The film of a scene as linear sRGB (channels R, G, B, no adaptation): from X, Y, Z by the matrix, or R, G,
/// B as they are. Throws Error{internal} for other channels.
[[nodiscard]] Image linear_srgb(const Image& film);

/// Replaces X, Y, Z by the three channels of linear sRGB, so that a film knows its own variance in them.
void expose_in_srgb(Scene& scene);

/// What a reference is a function of.
struct ReferenceKey {
  std::string scene_sha256;
  int width, height;
  std::string version;
  std::string data_sha256;
  std::uint64_t seed;
  int samples;

  /// SHA-256 over all of them.
  [[nodiscard]] std::string text() const;
};

struct Reference {
  Image image;  ///< R, G, B and Variance.R, Variance.G, Variance.B.
  std::string key;
  bool cached;  ///< Found rather than rendered.
};

/// The scene's reference with `samples` per pixel of `seed`: read from `cache`, else rendered and written
/// there. Throws as reading and writing do.
[[nodiscard]] Reference reference_of(const Scene& scene, const std::filesystem::path& cache,
                                     const std::string& version, std::uint64_t seed, int samples,
                                     int threads);

}  // namespace abbe
