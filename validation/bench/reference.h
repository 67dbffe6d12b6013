#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "io/image.h"
#include "scene/scene.h"

namespace abbe {

/// Converts a film with channels X, Y, Z to linear sRGB (R, G, B) without chromatic adaptation. Channels R,
/// G, B are copied. Throws Error{internal} for other channels.
[[nodiscard]] Image linear_srgb(const Image& film);

/// Replaces the sensor's channels X, Y, Z by those of linear sRGB, so that the film records their variances.
void expose_in_srgb(Scene& scene);

/// Everything that a reference image depends on.
struct ReferenceKey {
  std::string scene_sha256;
  int width, height;
  std::string version;
  std::string data_sha256;
  std::uint64_t seed;
  int samples;

  /// SHA-256 over all members, in hexadecimal.
  [[nodiscard]] std::string text() const;
};

struct Reference {
  Image image;  ///< Channels R, G, B, Variance.R, Variance.G and Variance.B.
  std::string key;
  bool cached;  ///< True if the image was read from the cache.
};

/// Reference image of the scene with `samples` per pixel and the given seed. It is read from the folder
/// `cache`, or rendered and written there. Throws Error{output} and the errors of reading EXR files.
[[nodiscard]] Reference reference_of(const Scene& scene, const std::filesystem::path& cache,
                                     const std::string& version, std::uint64_t seed, int samples,
                                     int threads);

}  // namespace abbe
