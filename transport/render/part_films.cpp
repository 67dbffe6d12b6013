#include "transport/render/part_films.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "io/text.h"
#include "sensor/film/relative_error.h"
#include "sensor/response/polarised_channels.h"
#include "transport/render/layers.h"

namespace abbe {
namespace {

// Features that an identity records; an empty list without the attribute, no value for unknown names.
std::optional<std::vector<Feature>> features_of(const FilmIdentity& identity) {
  const auto entry = identity.find(kFeaturesKey);
  return entry == identity.end() ? std::vector<Feature>() : parse_features(entry->second);
}

std::optional<FilmShape> shape_of_layers(const FilmIdentity& identity, const FilmShape& shape) {
  const auto entry = identity.find(kLayersKey);
  if (entry == identity.end()) return std::nullopt;
  return layered(shape, split(entry->second, ',').size());
}

// Calls `function` for the main film, for that of the layers and for that of the features.
template <typename Films, typename Function>
void for_each_film(Films& films, const Function& function) {
  function(films.film);
  if (films.layers) function(*films.layers);
  if (films.features) function(films.features->sums());
}

// Replicates of the samples of a range, in the order of the samples.
std::vector<int> replicates_of(const SampleRange& samples, const Film& film) {
  const auto all = static_cast<std::uint64_t>(film.replicates());
  std::vector<int> some;
  for (std::uint64_t s = samples.first; s < std::min(samples.last, samples.first + all); ++s)
    some.push_back(static_cast<int>(s % all));
  return some;
}

// True if pixels within the film's crop have no samples.
bool has_gaps(const RenderPart& part) {
  std::size_t sampled = 0;
  for (const SampledArea& area : part.areas) sampled += pixel_count(area.pixels);
  return !part.areas.empty() && sampled < pixel_count(part.result.film.crop());
}

// True if the samples of some pixels lie in fewer than two replicates.
bool lacks_variance(const RenderPart& part) {
  const int replicates = part.result.film.replicates();
  return std::any_of(part.areas.begin(), part.areas.end(), [replicates](const SampledArea& area) {
    const std::vector<std::uint64_t> counts = count_per_replicate(area.samples, replicates);
    return counts.size() - static_cast<std::size_t>(std::count(counts.begin(), counts.end(), 0U)) < 2;
  });
}

}  // namespace

std::vector<std::string> film_planes(const FilmIdentity& identity) {
  return split(identity.at("sensor_channels"), ',');
}

std::optional<std::size_t> bytes_of_films(const FilmIdentity& identity, const FilmShape& shape) {
  const auto features = features_of(identity);
  if (!features) return std::nullopt;
  const auto layers = shape_of_layers(identity, shape);
  return bytes_of_sums(shape) + (layers ? bytes_of_sums(*layers) : 0) +
         bytes_of_features(*features, shape, film_planes(identity));
}

RenderResult empty_films(const FilmIdentity& identity, const FilmShape& shape) {
  RenderResult films{Film(shape), {}, {}};
  if (const auto layers = shape_of_layers(identity, shape)) films.layers.emplace(*layers);
  if (const auto features = features_of(identity); !features->empty())
    films.features.emplace(*features, shape, film_planes(identity));
  return films;
}

std::optional<RenderResult> films_from_bytes(const FilmIdentity& identity, const FilmShape& shape,
                                             std::string_view bytes) {
  if (bytes.size() != bytes_of_films(identity, shape)) return std::nullopt;
  const auto take = [&bytes](std::size_t count) {
    const std::string_view taken = bytes.substr(0, count);
    bytes.remove_prefix(count);
    return taken;
  };
  RenderResult films{*Film::from_bytes(shape, take(bytes_of_sums(shape))), {}, {}};
  if (const auto layers = shape_of_layers(identity, shape))
    films.layers = Film::from_bytes(*layers, take(bytes_of_sums(*layers)));
  if (const auto features = features_of(identity); !features->empty())
    films.features = FeatureFilm::from_bytes(*features, shape, film_planes(identity), bytes);
  return films;
}

std::vector<std::string_view> sums_of(const RenderResult& films) {
  std::vector<std::string_view> bytes;
  for_each_film(films, [&bytes](const Film& film) { bytes.push_back(film.bytes()); });
  return bytes;
}

void crop_films(const FilmShape& shape, RenderResult& films) {
  if (shape == films.film.shape()) return;
  for_each_film(films, [&shape](Film& film) {
    FilmShape cropped_shape = film.shape();
    cropped_shape.crop = shape.crop;
    Film cropped(cropped_shape);
    cropped.add(film);
    film = std::move(cropped);
  });
}

void add_films(RenderResult& sum, const RenderResult& films) {
  sum.film.add(films.film);
  if (sum.layers) sum.layers->add(*films.layers);
  if (sum.features) sum.features->sums().add(films.features->sums());
}

std::vector<Film> copy_replicates(const RenderResult& films, const SampleRange& samples) {
  std::vector<Film> saved;
  for_each_film(films, [&](const Film& film) { saved.push_back(film.only(replicates_of(samples, film))); });
  return saved;
}

std::optional<std::vector<Film>> read_replicates(const RenderResult& films, const SampleRange& samples,
                                                 std::string_view bytes) {
  std::vector<Film> saved;
  for_each_film(films, [&](const Film& film) {
    FilmShape shape = film.shape();
    shape.replicates = static_cast<int>(replicates_of(samples, film).size());
    const std::string_view own = bytes.substr(0, bytes_of_sums(shape));
    if (auto read = Film::from_bytes(shape, own)) saved.push_back(*std::move(read));
    bytes.remove_prefix(own.size());
  });
  const bool all = saved.size() == sums_of(films).size() && bytes.empty();
  return all ? std::optional(std::move(saved)) : std::nullopt;
}

void restore_replicates(RenderResult& films, const std::vector<Film>& saved, const SampleRange& samples) {
  auto next = saved.begin();
  for_each_film(films, [&](Film& film) { film.put_back(replicates_of(samples, film), *next++); });
}

void set_samples(RenderResult& films, const SampleRanges& samples) {
  const std::vector<std::uint64_t> counts = count_per_replicate(samples, films.film.replicates());
  films.film.set_samples(counts);
  if (films.layers) films.layers->set_samples(counts);
}

std::optional<double> frame_mean_error(const RenderPart& part) {
  if (lacks_variance(part)) return std::numeric_limits<double>::infinity();
  if (part.result.samples.empty()) return std::nullopt;
  return frame_mean_error(part.result.film, intensities(film_planes(part.identity)).size());
}

std::optional<std::uint64_t> few_samples(const RenderPart& part) {
  if (lacks_variance(part) || part.result.samples.empty()) return std::nullopt;
  return few_samples(part.result.film, intensities(film_planes(part.identity)).size());
}

Image developed(const Film& film, std::span<const std::string> names, const RenderPart& part) {
  Image image = film.image(names);
  if (part.result.samples.empty())
    for (const SampledArea& area : part.areas)
      film.develop(image, area.pixels, count_per_replicate(area.samples, film.replicates()));
  image.metadata = part.identity;
  for (const char* key : {kBuildKey, kInstructionSetKey}) image.metadata.erase(key);
  if (!has_gaps(part) && !part.result.samples.empty()) return image;
  image.metadata[kAreasKey] = to_text(part.areas);
  image.metadata.erase(kStatedSamplesKey);
  return image;
}

}  // namespace abbe
