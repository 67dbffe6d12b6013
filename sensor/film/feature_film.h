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
/// paths of a pixel hit.
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
  std::optional<Feature> feature;
};
/// Feature planes for a film with the planes `film_planes`: `Coverage`, then those of each feature. Their
/// names are those that denoisers and compositors expect: `depth.Z`, `P.X` to `P.Z`, `N.X` to `N.Z`, `Ns.X`
/// to `Ns.Z`, `Id`, and `Albedo.<plane>` for each intensity plane. Throws Error{scene} if a plane of the film
/// has such a name.
[[nodiscard]] std::vector<FeaturePlane> feature_planes(std::span<const Feature> features,
                                                       std::span<const std::string> film_planes);

/// Depth of pixels whose samples hit no surface.
inline constexpr float kFeatureDepthOfNothing = 1e10F;

/// Exact sums of the features of first hits, one plane each. They have a single replicate, since they need no
/// variance. Their own unit resolves lengths and directions to 2^-60.
class FeatureFilm {
 public:
  /// Creates feature sums for a film of this shape with these planes. Throws Error{resource} if memory does
  /// not suffice.
  FeatureFilm(std::vector<Feature> features, const FilmShape& film, std::span<const std::string> film_planes);
  /// Feature film whose sums have these bytes, or nothing if their number does not fit the shape.
  [[nodiscard]] static std::optional<FeatureFilm> from_bytes(std::vector<Feature> features,
                                                             const FilmShape& film,
                                                             std::span<const std::string> film_planes,
                                                             std::string_view bytes);

  [[nodiscard]] const std::vector<Feature>& features() const { return features_; }
  [[nodiscard]] Film& sums() { return sums_; }
  [[nodiscard]] const Film& sums() const { return sums_; }

  /// Adds the feature values of one sample, one per plane, to a pixel of the crop. Adds nothing if a value
  /// exceeds what the sums can hold. Thread-safe.
  void add(std::size_t pixel, std::span<const double> values);

  /// Appends a channel per plane to the image: 0, or `kFeatureDepthOfNothing` for depth.
  void add_channels(Image& image) const;
  /// Writes the planes to the last channels of the image, in an area whose pixels have `samples` samples
  /// each. Depth and position are means over the samples that hit a surface. Normals and albedo are means
  /// over all samples, where the others count as 0. `Id` is the shape that the first sample of the render
  /// hit.
  void develop(Image& image, const Crop& area, double samples) const;

 private:
  FeatureFilm(std::vector<Feature> features, std::vector<FeaturePlane> planes, Film sums);

  std::vector<Feature> features_;
  std::vector<FeaturePlane> planes_;
  Film sums_;
};

/// Memory of the feature sums for a film of this shape with these planes; 0 without features. Throws like
/// `feature_planes`.
[[nodiscard]] std::size_t bytes_of_features(std::span<const Feature> features, const FilmShape& film,
                                            std::span<const std::string> film_planes);

}  // namespace abbe
