#include "transport/render/part.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "io/part_file.h"
#include "io/text.h"
#include "sensor/film/recorded_attributes.h"
#include "transport/render/layers.h"
#include "transport/render/part_films.h"
#include "transport/render/pass.h"

namespace abbe {
namespace {

namespace fs = std::filesystem;

// Keys of the header that describe the sums; all others are the identity.
constexpr const char* kShape = "film";
constexpr const char* kSamples = "samples";  // replaced by `kAreasKey` if pixels have different samples
constexpr const char* kCounts = "paths_rays_nonfinite_cut";
constexpr const char* kCutSum = "cut_sum";  // its upper and lower 64 bits
constexpr std::array<std::string_view, 9> kNonDistinguishingKeys{
    "scene",     kStatedSamplesKey,  "to_xyz_d65", kNoPictureKey, kWhiteKey,
    kWhiteXyKey, kWhiteRequestedKey, kLightsXyKey, kShapeNamesKey};
constexpr const char* kUnfinished = "unfinished";  // samples of a pass from first to last, and its items done

template <typename Number>
std::optional<std::vector<Number>> parse_numbers(const std::string& text, std::size_t count) {
  std::vector<Number> numbers;
  for (const std::string& word : split(text, ' ')) {
    Number number{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
    numbers.push_back(number);
  }
  return numbers.size() == count ? std::optional(std::move(numbers)) : std::nullopt;
}

// Shape from the text that `write_part` writes; nothing for sizes that no film has.
std::optional<FilmShape> parse_shape(const std::string& text) {
  const auto n = parse_numbers<std::int64_t>(text, 7);
  if (!n || *std::max_element(n->begin(), n->begin() + 5) > std::numeric_limits<int>::max())
    return std::nullopt;
  const auto as_int = [&n](std::size_t i) { return static_cast<int>((*n)[i]); };
  const auto photons = static_cast<std::uint64_t>((*n)[5]);
  const auto interval = static_cast<std::uint32_t>((*n)[6]);
  const FilmShape shape{as_int(0), as_int(1), as_int(2), as_int(3), as_int(4), photons, interval};
  constexpr double kMaxSums = 0x1p48;  // more than the memory of any machine
  constexpr int kMaxExponent = 2048;   // range of doubles, with the digits below
  const auto up_to = [](int number, int limit) { return number > 0 && number <= limit; };
  const bool possible =
      up_to(shape.width, kMaxImageEdge) && up_to(shape.height, kMaxImageEdge) &&
      up_to(shape.channels, 1 << 14) && up_to(shape.replicates, 1 << 14) &&
      double{1} * shape.width * shape.height * shape.channels * shape.replicates <= kMaxSums &&
      std::abs((*n)[4]) <= kMaxExponent;
  return possible ? std::optional(shape) : std::nullopt;
}

std::string take(FilmIdentity& header, const char* key) {
  auto entry = header.extract(key);
  return entry ? std::move(entry.mapped()) : "";
}

/// The header of a part or a checkpoint, parsed.
struct ParsedHeader {
  PartHeader header;
  SampleRanges samples = {};  ///< Samples of all pixels; empty if pixels differ.
  std::optional<UnfinishedPass> unfinished = {};
  RenderStats stats = {};
};

// Reads the areas of a merged film. Returns false if they do not fill its crop.
bool take_areas(FilmIdentity& header, ParsedHeader& parsed) {
  auto areas = parse_sampled_areas(take(header, kAreasKey));
  if (!areas || bounds(*areas) != pixels_of(parsed.header.shape)) return false;
  parsed.header.areas = *std::move(areas);
  return true;
}

// Reads the samples of a film and of its unfinished pass. Returns false if they are invalid or overlap.
bool take_samples(FilmIdentity& header, ParsedHeader& parsed) {
  if (header.contains(kAreasKey)) return take_areas(header, parsed);
  const std::string samples = take(header, kSamples);
  const std::string unfinished = take(header, kUnfinished);
  if (!samples.empty() || unfinished.empty()) {
    auto ranges = parse_sample_ranges(samples);
    if (!ranges) return false;
    parsed.samples = *std::move(ranges);
  }
  parsed.header.areas = {{pixels_of(parsed.header.shape), parsed.samples}};
  if (unfinished.empty()) return true;
  const auto n = parse_numbers<std::uint64_t>(unfinished, 3);
  if (!n || (*n)[0] >= (*n)[1] || (*n)[2] > std::numeric_limits<std::uint32_t>::max()) return false;
  parsed.unfinished = UnfinishedPass{{(*n)[0], (*n)[1]}, static_cast<std::uint32_t>((*n)[2])};
  SampleRanges both = parsed.samples;
  return add(both, parsed.unfinished->samples);
}

// Reads the crop. Returns false if it exceeds the film.
bool read_crop(const FilmIdentity& header, FilmShape& shape) {
  const auto text = header.find(kCropKey);
  if (text == header.end()) return true;
  shape.crop = parse_crop(text->second);
  return shape.crop && contains({0, 0, shape.width, shape.height}, *shape.crop);
}

// Splits the attributes of a part file into identity, shape, samples and counts; nothing if one is invalid.
std::optional<ParsedHeader> parse_header(FilmIdentity header) {
  auto shape = parse_shape(take(header, kShape));
  const auto counts = parse_numbers<std::uint64_t>(take(header, kCounts), 4);
  const auto cut_sum = parse_numbers<std::uint64_t>(take(header, kCutSum), 2);
  const bool named =
      split(header["sensor_channels"], ',').size() == static_cast<std::size_t>(shape ? shape->channels : 0);
  if (!shape || !counts || !cut_sum || !named || !bytes_of_films(header, *shape) ||
      !read_crop(header, *shape))
    return std::nullopt;
  ParsedHeader parsed{{{}, *shape, {}}};
  if (!take_samples(header, parsed)) return std::nullopt;
  parsed.header.identity = std::move(header);
  parsed.stats.samples_per_pixel = count(parsed.samples);
  parsed.stats.paths = (*counts)[0];
  parsed.stats.rays = (*counts)[1];
  parsed.stats.nonfinite_samples = (*counts)[2];
  parsed.stats.cut = {(*counts)[3], static_cast<Int128>((*cut_sum)[0]) << 64 | (*cut_sum)[1]};
  return parsed;
}

[[noreturn]] void refuse_contents(const fs::path& path) {
  throw Error(ErrorCode::input, path.string(), "holds no part of a render");
}

std::uint64_t stated_samples(const FilmIdentity& identity) {
  const auto stated = identity.find(kStatedSamplesKey);
  const auto number =
      stated == identity.end() ? std::nullopt : parse_numbers<std::uint64_t>(stated->second, 1);
  return number ? number->front() : 0;
}

FilmIdentity without_crop(FilmIdentity identity) {
  identity.erase(kCropKey);
  return identity;
}

FilmShape without_crop(FilmShape shape) {
  shape.crop.reset();
  return shape;
}

void set_crop(PartHeader& header, const Crop& crop) {
  const bool whole = crop == Crop{0, 0, header.shape.width, header.shape.height};
  header.shape.crop = whole ? std::nullopt : std::optional(crop);
  header.identity.erase(kCropKey);
  if (!whole) header.identity[kCropKey] = to_text(crop);
}

// Text for messages; empty for the whole film.
std::string of_pixels(const Crop& pixels, const FilmShape& shape) {
  const bool whole = pixels == pixels_of(without_crop(shape));
  return whole ? "" : fmt::format(" of pixels {}", to_text(pixels));
}

// Adds the samples of an unfinished pass to the pixels of its finished tiles. A film without other samples is
// cropped to these pixels. Photons of the pass may fall on any pixel, so with photons no pixel has its
// samples.
void count_done_tiles(const fs::path& path, ParsedHeader& parsed) {
  if (!parsed.unfinished) return;
  PartHeader& header = parsed.header;
  if (parsed.samples.empty()) header.areas.clear();
  if (header.shape.photons == 0)
    for (const Crop& tiles : tiles_done(header.shape, parsed.unfinished->items))
      (void)add(header.areas, {tiles, {parsed.unfinished->samples}});
  if (header.areas.empty()) throw Error(ErrorCode::input, path.string(), "holds no sample of any pixel yet");
  set_crop(header, bounds(header.areas));
}

SampledAreas areas_of(const RenderPart& part) {
  if (!part.areas.empty() || part.result.samples.empty()) return part.areas;
  return {{part.result.film.crop(), part.result.samples}};
}

void set_areas(RenderPart& part, SampledAreas areas) {
  RenderResult& result = part.result;
  const bool same = std::all_of(areas.begin(), areas.end(), [&areas](const SampledArea& area) {
    return area.samples == areas.front().samples;
  });
  result.samples = same ? areas.front().samples : SampleRanges{};
  result.stats.samples_per_pixel = count(result.samples);
  set_samples(result, result.samples);
  const bool everywhere = areas.size() == 1 && areas.front().pixels == result.film.crop();
  part.areas = everywhere ? SampledAreas{} : std::move(areas);
}

/// Content of a part file.
struct ParsedPart {
  ParsedHeader parsed;
  RenderResult result;
};

ParsedPart read_sums(const fs::path& path) {
  PartFile file = read_part_file(path);
  auto parsed = parse_header(std::move(file.header));
  if (!parsed) refuse_contents(path);
  const PartHeader& header = parsed->header;
  const std::string_view bytes = file.bytes;
  const std::size_t sum_bytes = std::min(bytes_of_sums(header), bytes.size());
  auto films = films_from_bytes(header.identity, header.shape, bytes.substr(0, sum_bytes));
  if (!films) refuse_contents(path);
  if (parsed->unfinished && header.shape.photons > 0) {
    auto before = read_replicates(*films, parsed->unfinished->samples, bytes.substr(sum_bytes));
    if (!before) refuse_contents(path);
    films->before_pass = std::make_shared<const std::vector<Film>>(*std::move(before));
  } else if (bytes.size() > sum_bytes) {
    refuse_contents(path);
  }
  films->stats = parsed->stats;
  return {*std::move(parsed), *std::move(films)};
}

}  // namespace

PartHeader header_of(const RenderPart& part) {
  return {part.identity, part.result.film.shape(), areas_of(part)};
}

void write_part(const fs::path& path, const FilmIdentity& identity, const RenderResult& result,
                const SampledAreas& areas) {
  FilmIdentity header = identity;
  const FilmShape& s = result.film.shape();
  header[kShape] = fmt::format("{} {} {} {} {} {} {}", s.width, s.height, s.channels, s.replicates,
                               s.unit_exponent, s.photons, s.path_interval);
  header[areas.empty() ? kSamples : kAreasKey] = areas.empty() ? to_text(result.samples) : to_text(areas);
  if (const auto& pass = result.unfinished)
    header[kUnfinished] = fmt::format("{} {} {}", pass->samples.first, pass->samples.last, pass->items);
  const RenderStats& stats = result.stats;
  header[kCounts] =
      fmt::format("{} {} {} {}", stats.paths, stats.rays, stats.nonfinite_samples, stats.cut.paths);
  header[kCutSum] = fmt::format("{} {}", static_cast<std::uint64_t>(stats.cut.sum >> 64),
                                static_cast<std::uint64_t>(stats.cut.sum));
  std::vector<std::string_view> sums = sums_of(result);
  if (result.unfinished && result.before_pass)
    for (const Film& film : *result.before_pass) sums.push_back(film.bytes());
  write_part_file(path, header, sums);
}

RenderPart read_checkpoint(const fs::path& path) {
  auto [parsed, result] = read_sums(path);
  result.unfinished = parsed.unfinished;
  RenderPart part{std::move(parsed.header.identity), std::move(result)};
  set_areas(part, std::move(parsed.header.areas));
  return part;
}

RenderPart read_part(const fs::path& path) {
  auto [parsed, result] = read_sums(path);
  count_done_tiles(path, parsed);
  if (const auto before = std::exchange(result.before_pass, nullptr))
    restore_replicates(result, *before, parsed.unfinished->samples);
  crop_films(parsed.header.shape, result);
  RenderPart part{std::move(parsed.header.identity), std::move(result)};
  set_areas(part, std::move(parsed.header.areas));
  return part;
}

PartHeader read_part_header(const fs::path& path) {
  auto parsed = parse_header(read_part_file_header(path));
  if (!parsed) refuse_contents(path);
  count_done_tiles(path, *parsed);
  return std::move(parsed->header);
}

FilmIdentity distinguishing_keys(FilmIdentity identity) {
  for (const std::string_view key : kNonDistinguishingKeys) identity.erase(std::string(key));
  return identity;
}

void require_same_film(const fs::path& path, const FilmIdentity& identity, const FilmIdentity& wanted) {
  FilmIdentity all = wanted;
  all.insert(identity.begin(), identity.end());
  const auto value = [](const FilmIdentity& keys, const std::string& key) {
    const auto found = keys.find(key);
    return found == keys.end() ? std::string("none") : found->second;
  };
  for (const auto& [key, unused] : distinguishing_keys(std::move(all))) {
    if (value(identity, key) == value(wanted, key)) continue;
    throw Error(ErrorCode::input, path.string(),
                fmt::format("belongs to another render, with another {} (got {}, allowed {})", key,
                            value(identity, key), value(wanted, key)));
  }
}

void merge(PartHeader& sum, const PartHeader& part, const fs::path& path) {
  require_same_film(path, without_crop(part.identity), without_crop(sum.identity));
  if (without_crop(part.shape) != without_crop(sum.shape))
    throw Error(ErrorCode::input, path.string(), "has a film of another shape");
  SampledAreas areas = sum.areas;
  for (const SampledArea& area : part.areas)
    if (const auto overlap = add(areas, area))
      throw Error(ErrorCode::input, path.string(),
                  fmt::format("has samples that are already included (got {}{})", to_text(overlap->samples),
                              of_pixels(overlap->pixels, part.shape)));
  sum.areas = std::move(areas);
  if (stated_samples(part.identity) > stated_samples(sum.identity))
    sum.identity[kStatedSamplesKey] = part.identity.at(kStatedSamplesKey);
  set_crop(sum, bounds(sum.areas));
}

std::size_t bytes_of_sums(const PartHeader& header) {
  return bytes_of_films(header.identity, header.shape).value_or(0);
}

RenderPart empty_part(const PartHeader& header) {
  return {header.identity, empty_films(header.identity, header.shape)};
}

void merge(RenderPart& sum, const RenderPart& part, const fs::path& path) {
  PartHeader header{sum.identity, sum.result.film.shape(), areas_of(sum)};
  merge(header, {part.identity, part.result.film.shape(), areas_of(part)}, path);
  if (!contains(sum.result.film.crop(), part.result.film.crop()))
    throw Error(ErrorCode::input, path.string(), "has pixels outside the film that it is added to");
  add_films(sum.result, part.result);
  set_areas(sum, std::move(header.areas));
  if (const auto stated = header.identity.find(kStatedSamplesKey); stated != header.identity.end())
    sum.identity[kStatedSamplesKey] = stated->second;
  sum.result.stats += part.result.stats;
}

SampledAreas missing_samples(const PartHeader& sum, const std::optional<Crop>& crop) {
  SampledArea wanted{crop.value_or(Crop{0, 0, sum.shape.width, sum.shape.height}), {}};
  if (const std::uint64_t stated = stated_samples(sum.identity); stated > 0)
    wanted.samples = {{0, stated}};
  else
    for (const SampledArea& area : sum.areas)
      for (const SampleRange& range : area.samples)
        for (const SampleRange& more : missing(wanted.samples, range)) (void)add(wanted.samples, more);
  return missing(sum.areas, wanted);
}

std::string describe_samples(const SampledAreas& areas, const FilmShape& shape, std::string_view whole_film) {
  std::string text;
  for (const auto& [pixels, samples] : areas) {
    const std::string pixel_text = of_pixels(pixels, shape);
    text += fmt::format("{}samples {}{}", text.empty() ? "" : ", ", to_text(samples),
                        pixel_text.empty() ? std::string(whole_film) : pixel_text);
  }
  return text;
}

Image image_of(const RenderPart& part) {
  const RenderResult& result = part.result;
  Image image = developed(result.film, film_planes(part.identity), part);
  image.metadata["renderer"] = "Abbe";
  if (!result.samples.empty() && !image.metadata.contains(kAreasKey))
    image.metadata["samples_per_pixel"] = fmt::format("{}", result.stats.samples_per_pixel);
  if (const auto error = frame_mean_error(part))
    image.metadata[kFrameMeanErrorKey] = fmt::format("{}", *error);
  if (const auto samples = few_samples(part))
    image.metadata[kHalfNoiseSamplesKey] = fmt::format("{}", *samples);
  return image;
}

std::vector<LayerImage> layer_images(const RenderPart& part) {
  if (!part.result.layers) return {};
  const std::vector<std::string> names = split(part.identity.at(kLayersKey), ',');
  const std::vector<std::string> planes = film_planes(part.identity);
  std::vector<std::string> repeated;
  for (std::size_t i = 0; i < names.size(); ++i)
    repeated.insert(repeated.end(), planes.begin(), planes.end());
  Image all = developed(*part.result.layers, repeated, part);
  std::vector<LayerImage> images;
  for (std::size_t i = 0; i < names.size(); ++i) {
    LayerImage& layer = images.emplace_back(LayerImage{names[i], {all.width, all.height, {}, all.metadata}});
    for (const std::size_t first : {i * planes.size(), (names.size() + i) * planes.size()})
      for (std::size_t k = first; k < first + planes.size(); ++k)
        layer.image.channels.push_back(std::move(all.channels[k]));
  }
  return images;
}

void add_features(Image& image, const RenderPart& part) {
  if (!part.result.features) return;
  part.result.features->add_channels(image);
  for (const SampledArea& area : areas_of(part))
    part.result.features->develop(image, area.pixels, static_cast<double>(count(area.samples)));
}

}  // namespace abbe
