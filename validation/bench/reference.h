#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "io/image.h"
#include "scene/scene.h"

namespace abbe {

/// Converts a film with channels X, Y, Z to linear sRGB (R, G, B) in the same scale, without chromatic
/// adaptation. The channels R, G, B of a film that has R are copied. Other channels and metadata are omitted.
/// Throws Error{internal} if neither set of channels is complete.
[[nodiscard]] Image linear_srgb(const Image& film);

/// Replaces the sensor's channels X, Y, Z by R, G, B of linear sRGB, so that the film records their
/// variances. A scene with other channels remains as it is.
void expose_in_srgb(Scene& scene);

/// Everything that a reference image depends on.
struct ReferenceKey {
  std::string scene_sha256;  ///< Hash of the scene with its settings and files.
  int width, height;         ///< Size of the film in pixels.
  std::string version;       ///< Version of Abbe.
  std::string data_sha256;   ///< Hash of the shipped tables, by `data_sha256`.
  std::uint64_t seed;
  int samples;  ///< Samples per pixel.

  /// SHA-256 over all members, in hexadecimal.
  [[nodiscard]] std::string text() const;
};

/// Reference image of a scene.
struct Reference {
  Image image;      ///< Channels R, G, B, Variance.R, Variance.G and Variance.B, in linear sRGB.
  std::string key;  ///< Text of its `ReferenceKey`.
  bool cached;      ///< True if the image was read from the cache.
};

/// Reference image of the scene with `samples` per pixel and the given seed, rendered by the scene's own
/// integrator. It is read from the file of its key in the folder `cache`, or rendered and written there. The
/// folder is created if needed. `version` is that of Abbe; `threads` of 0 means one per processor.
/// Throws Error{output} if the file cannot be written, and the errors of `read_exr` and `render`.
[[nodiscard]] Reference reference_of(const Scene& scene, const std::filesystem::path& cache,
                                     const std::string& version, std::uint64_t seed, int samples,
                                     int threads);

}  // namespace abbe
