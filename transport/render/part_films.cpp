#include "transport/render/part_films.h"

#include <utility>

#include "io/text.h"
#include "transport/render/layers.h"

namespace abbe {
namespace {

// Those an identity tells, none where it tells none; nothing for what are no features.
std::optional<std::vector<Feature>> features_of(const FilmIdentity& identity) {
  const auto told = identity.find(kFeaturesKey);
  return told == identity.end() ? std::vector<Feature>() : parse_features(told->second);
}

std::optional<FilmShape> shape_of_layers(const FilmIdentity& identity, const FilmShape& shape) {
  const auto told = identity.find(kLayersKey);
  if (told == identity.end()) return std::nullopt;
  return layered(shape, parse_layers(told->second).size());
}

}  // namespace

std::vector<std::string> film_planes(const FilmIdentity& identity) {
  return split(identity.at("sensor_channels"), ',');
}

std::optional<std::size_t> bytes_of_films(const FilmIdentity& identity, const FilmShape& shape) {
  const auto features = features_of(identity);
  if (!features) return std::nullopt;
  const auto layers = shape_of_layers(identity, shape);
  return bytes_of_sums(shape) + (layers ? bytes_of_sums(*layers) : 0) + bytes_of_features(*features, shape);
}

RenderResult dark_films(const FilmIdentity& identity, const FilmShape& shape) {
  RenderResult films{Film(shape), {}, {}};
  if (const auto layers = shape_of_layers(identity, shape)) films.layers.emplace(*layers);
  if (const auto features = features_of(identity); !features->empty())
    films.features.emplace(*features, shape, film_planes(identity));
  return films;
}

std::optional<RenderResult> films_of(const FilmIdentity& identity, const FilmShape& shape,
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
  std::vector<std::string_view> bytes{films.film.bytes()};
  if (films.layers) bytes.push_back(films.layers->bytes());
  if (films.features) bytes.push_back(films.features->sums().bytes());
  return bytes;
}

void crop_films(const FilmShape& shape, RenderResult& films) {
  if (shape == films.film.shape()) return;
  const auto crop = [&shape](Film& film) {
    FilmShape of = film.shape();
    of.crop = shape.crop;
    Film cropped(of);
    cropped.add(film);
    film = std::move(cropped);
  };
  crop(films.film);
  if (films.layers) crop(*films.layers);
  if (films.features) crop(films.features->sums());
}

void add_films(RenderResult& sum, const RenderResult& films) {
  sum.film.add(films.film);
  if (sum.layers) sum.layers->add(*films.layers);
  if (sum.features) sum.features->sums().add(films.features->sums());
}

void set_samples(RenderResult& films, const SampleRanges& samples) {
  const std::vector<std::uint64_t> counts = count_per_replicate(samples, films.film.replicates());
  films.film.set_samples(counts);
  if (films.layers) films.layers->set_samples(counts);
}

}  // namespace abbe
