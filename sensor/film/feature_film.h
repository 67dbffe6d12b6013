#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sensor/film/film.h"

namespace abbe {

/// Features that a film can record besides its exposure: properties of the first surface that the camera
/// paths of a pixel hit. Positions and lengths are in the coordinates and unit of the scene file. Normals are
/// unit vectors towards the camera. Depth is measured along the axis of the camera, or along the ray if it
/// has none. Albedos are fractions of the incident light, weighted by each channel. `id` is 1 plus the index
/// of the shape, and 0 for none.
enum class Feature { depth, position, normal, shading_normal, albedo, id };
/// Names of the features in commands and files, in the order of `Feature`.
inline constexpr std::array kFeatureNames{"depth", "position", "normal", "shading-normal", "albedo", "id"};

/// Attribute with the features of a film, separated by commas; absent if it has none.
inline constexpr const char* kFeaturesKey = "aov";
/// Attribute with the names of the shapes of the scene, a JSON array. Shape `id` i has the name i - 1.
inline constexpr const char* kShapeNamesKey = "shapes";

/// Conversion between features and their names, separated by commas. Parsing sorts them and removes
/// duplicates; it gives nothing for any other name.
[[nodiscard]] std::string to_text(std::span<const Feature> features);
[[nodiscard]] std::optional<std::vector<Feature>> parse_features(std::string_view text);

/// A feature plane of a film. Coverage, the fraction of samples that hit a surface, belongs to no feature.
struct FeaturePlane {
  std::string name;
  std::optional<Feature> feature;  ///< Nothing for coverage.
};
/// Feature planes for a film with the planes `film_planes`: `Coverage`, then those of each feature in the
/// given order. Their names are those that denoisers and compositors expect: `depth.Z`, `P.X` to `P.Z`, `N.X`
/// to `N.Z`, `Ns.X` to `Ns.Z`, `Id`, and `Albedo.<plane>` for each intensity plane. Throws Error{scene} if a
/// plane of the film has such a name.
[[nodiscard]] std::vector<FeaturePlane> feature_planes(std::span<const Feature> features,
                                                       std::span<const std::string> film_planes);

inline constexpr float kFeatureDepthOfNothing = 1e10F;  ///< Depth of pixels whose samples hit no surface.

/// Exact sums of the features of first hits, one plane each. They have a single replicate, since they need no
/// variance. Their own unit resolves lengths and directions to 2^-60.
class FeatureFilm {
 public:
  /// Throws Error{resource} if memory does not suffice, and like `feature_planes`.
  FeatureFilm(std::vector<Feature> features, const FilmShape& film, std::span<const std::string> film_planes);
  /// Feature film with the bytes of its sums; nothing if their number does not fit. Throws like the
  /// constructor.
  [[nodiscard]] static std::optional<FeatureFilm> from_bytes(std::vector<Feature> features,
                                                             const FilmShape& film,
                                                             std::span<const std::string> film_planes,
                                                             std::string_view bytes);

  [[nodiscard]] const std::vector<Feature>& features() const { return features_; }
  [[nodiscard]] Film& sums() { return sums_; }
  [[nodiscard]] const Film& sums() const { return sums_; }

  /// Adds the feature values of one sample, one per plane, to the pixel of this index (`Film::pixel_at`) in
  /// the crop. `Id` is a plain sum: all samples of a pixel but the first of the render must have the id 0, as
  /// `FeatureTracer::trace` ensures. Adds nothing if a value exceeds what the sums can hold. Thread-safe.
  /// Throws Error{scene} if a sum overflows.
  void add(std::size_t pixel, std::span<const double> values);

  /// Appends a channel per plane to the image: 0, or `kFeatureDepthOfNothing` for depth.
  void add_channels(Image& image) const;
  /// Writes the planes to the last channels of the image, which `add_channels` appended, in an area whose
  /// pixels have `samples` samples each. Depth and position are means over the samples that hit a surface.
  /// Coverage, normals and albedo are means over all samples, where the others count as 0. `Id` is the sum,
  /// which is the id that the first sample recorded (see `add`).
  void develop(Image& image, const Crop& area, double samples) const;

 private:
  FeatureFilm(std::vector<Feature> features, std::vector<FeaturePlane> planes, Film sums);

  std::vector<Feature> features_;
  std::vector<FeaturePlane> planes_;
  Film sums_;
};

/// Memory of the feature sums [bytes]; 0 without features. Throws like `feature_planes`.
[[nodiscard]] std::size_t bytes_of_features(std::span<const Feature> features, const FilmShape& film,
                                            std::span<const std::string> film_planes);

}  // namespace abbe
