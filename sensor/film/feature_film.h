#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sensor/film/film.h"

namespace abbe {

/// What a film may tell, beside its exposure, of the first surface that a pixel's camera paths meet.
enum class Feature { depth, position, normal, shading_normal, albedo, id };
/// Their words in commands and files, in that order.
inline constexpr std::array kFeatureNames{"depth", "position", "normal", "shading-normal", "albedo", "id"};

/// The key under which a film tells its features, as words separated by commas; absent where it has none.
inline constexpr const char* kFeaturesKey = "aov";
/// The key of the names of the scene's shapes, a JSON array: of `id` i the (i - 1)-th.
inline constexpr const char* kShapeNamesKey = "shapes";

/// Features as words separated by commas, and back: each once and in their order. Nothing for any other word.
[[nodiscard]] std::string to_text(std::span<const Feature> features);
[[nodiscard]] std::optional<std::vector<Feature>> parse_features(std::string_view text);

/// A plane beside those of a film. Coverage, the share of samples that meet a surface, is of no feature.
struct FeaturePlane {
  std::string name;
  std::optional<Feature> feature;
};
/// The planes of features beside a film of such planes: first `Coverage`, then of each feature its own, under
/// the names that denoisers and compositors read: `depth.Z`, `P.X` to `P.Z`, `N` and `Ns` likewise,
/// `Albedo.<plane of the film>` for those of intensities, `Id`. Throws Error{scene} where a plane of the film
/// has such a name.
[[nodiscard]] std::vector<FeaturePlane> feature_planes(std::span<const Feature> features,
                                                       std::span<const std::string> film_planes);

/// The depth of pixels whose samples meet no surface.
inline constexpr float kFeatureDepthOfNothing = 1e10F;

/// Exact sums of what samples have met, one plane each. They have one replicate, since no variance is asked
/// of them, and a unit of their own, in which lengths and directions are kept to 2^-60.
class FeatureFilm {
 public:
  /// Beside a film of that shape and planes. Throws Error{resource} when there is no memory for the sums.
  FeatureFilm(std::vector<Feature> features, const FilmShape& beside,
              std::span<const std::string> film_planes);
  /// The film whose sums had these bytes, or nothing if there are more or fewer than its shape needs.
  [[nodiscard]] static std::optional<FeatureFilm> from_bytes(std::vector<Feature> features,
                                                             const FilmShape& beside,
                                                             std::span<const std::string> film_planes,
                                                             std::string_view bytes);

  [[nodiscard]] const std::vector<Feature>& features() const { return features_; }
  [[nodiscard]] Film& sums() { return sums_; }
  [[nodiscard]] const Film& sums() const { return sums_; }

  /// Adds what a sample of a pixel of the crop has met, a value per plane, or nothing met where a value is
  /// more than sums can hold; any thread may, at any time.
  void add(std::size_t pixel, std::span<const double> values);

  /// Adds a channel per plane to the image, 0 everywhere but for the depth of nothing.
  void add_channels(Image& image) const;
  /// Sets these channels, the image's last, in an area whose pixels have so many samples: depth and position
  /// are means over the samples that have met a surface; normals and albedo over all, those that have met
  /// none counting as 0, and Id is what the first sample of the render has met.
  void develop(Image& image, const Crop& area, double samples) const;

 private:
  FeatureFilm(std::vector<Feature> features, std::vector<FeaturePlane> planes, Film sums);

  std::vector<Feature> features_;
  std::vector<FeaturePlane> planes_;
  Film sums_;
};

/// Memory of those sums beside a film of that shape and planes; of no features, none. Throws as
/// `feature_planes`.
[[nodiscard]] std::size_t bytes_of_features(std::span<const Feature> features, const FilmShape& beside,
                                            std::span<const std::string> film_planes);

}  // namespace abbe
