#include "preview/viewer_film.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>

#include "io/error.h"
#include "io/picture.h"
#include "io/spectral_exr.h"
#include "results/rendered_film.h"
#include "transport/render/threads.h"

namespace abbe {
namespace {

// Number of cached pictures of a snapshot.
constexpr std::size_t kMaxPictures = 16;

// Adds its lifetime to a sum [s].
class Stopwatch {
 public:
  explicit Stopwatch(std::atomic<double>& sum_s) : sum_s_(sum_s) {}
  ~Stopwatch() { sum_s_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  std::atomic<double>& sum_s_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

Snapshot take_snapshot(const Scene& scene, const FilmIdentity& identity, const RenderResult& result,
                       int threads) {
  const Film& film = result.film;
  Snapshot snapshot{result.stats.samples_per_pixel, film.crop(), {film.width(), film.height(), {}, identity}};
  for (const std::string& plane : scene.film_planes())
    snapshot.film.channels.push_back({plane, std::vector<float>(snapshot.film.pixels())});
  std::atomic<int> next_row = 0;
  run_on_threads(threads, [&] {
    for (int y = next_row++; y < film.height(); y = next_row++)
      for (int x = 0; x < film.width(); ++x) {
        const std::size_t pixel = film.pixel_at(x, y);
        for (int k = 0; k < film.channels(); ++k)
          snapshot.film.channels[static_cast<std::size_t>(k)].values[pixel] =
              static_cast<float>(film.mean(pixel, k));
      }
  });
  return snapshot;
}

ViewerFilm::ViewerFilm(const Scene& scene, ViewOptions options)
    : scene_(scene), options_(std::move(options)), views_(view_names(options_)) {
  try {
    transforms_.emplace(views_.front(), display_of(scene_, options_));
  } catch (const Error& error) {
    if (error.code == ErrorCode::internal) throw;
    displayable_ = false;
    views_ = scene_.channel_names();
  }
}

void ViewerFilm::replace(Snapshot snapshot) {
  auto next = std::make_shared<ProcessedSnapshot>();
  next->samples = snapshot.samples;
  next->crop = snapshot.crop;
  next->film = std::move(snapshot.film);
  const std::scoped_lock lock(swap_);
  next->number = latest_->number + 1;
  latest_ = std::move(next);
}

std::shared_ptr<ViewerFilm::ProcessedSnapshot> ViewerFilm::latest() const {
  const std::scoped_lock lock(swap_);
  return latest_;
}

std::uint64_t ViewerFilm::number() const {
  return latest()->number;
}

std::uint64_t ViewerFilm::samples() const {
  return latest()->samples;
}

void ViewerFilm::make_film(ProcessedSnapshot& snapshot) const {
  if (snapshot.made) return;
  snapshot.film = film_image(std::move(snapshot.film));
  if (scene_.mosaic) snapshot.demosaiced = film_for_display(scene_, snapshot.film);
  snapshot.made = true;
}

const DisplayTransform& ViewerFilm::transform(const std::string& view) {
  const auto known = transforms_.find(view);
  if (known != transforms_.end()) return known->second;
  if (displayable_) {
    ViewOptions options = options_;
    options.view = view;
    return transforms_.emplace(view, display_of(scene_, options)).first->second;
  }
  const auto channel = std::find_if(scene_.channels.begin(), scene_.channels.end(),
                                    [&view](const Channel& c) { return c.name == view; });
  return transforms_.emplace(view, make_display({*channel}, Curve(1.0), options_)).first->second;
}

std::shared_ptr<const std::string> ViewerFilm::picture(const std::string& view, double stops) {
  const std::scoped_lock lock(work_);
  const std::shared_ptr<ProcessedSnapshot> snapshot = latest();
  if (snapshot->number == 0 || std::find(views_.begin(), views_.end(), view) == views_.end()) return nullptr;
  auto& pictures = snapshot->pictures;
  if (const auto made = pictures.find({view, stops}); made != pictures.end()) return made->second;
  const Stopwatch watch(spent_s_);
  make_film(*snapshot);
  const DisplayTransform& display = transform(view);
  const Image& planes = scene_.mosaic ? snapshot->demosaiced : snapshot->film;
  const std::optional<double> white = scene_.output.display_exposure;
  const double scale = white ? 1 / *white : display.automatic_scale(planes);
  Image image = display(planes, scale * std::exp2(stops)).image;
  image.metadata.clear();
  if (pictures.size() == kMaxPictures) pictures.clear();
  return pictures[{view, stops}] = std::make_shared<const std::string>(encoded_picture(".png", image));
}

std::optional<ViewerFilm::Pixel> ViewerFilm::pixel(int x, int y) {
  const std::scoped_lock lock(work_);
  const std::shared_ptr<ProcessedSnapshot> snapshot = latest();
  const Crop& rendered = snapshot->crop;  // empty before the first snapshot
  if (x < rendered.x0 || y < rendered.y0 || x >= rendered.x1 || y >= rendered.y1) return std::nullopt;
  const Stopwatch watch(spent_s_);
  make_film(*snapshot);
  const Image& film = snapshot->film;
  Pixel pixel{snapshot->samples, {}};
  for (const ImageChannel& channel : film.channels) {
    const auto name = parse_spectral_channel(channel.name, "");
    pixel.values.push_back(
        {channel.name,
         channel.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(film.width) +
                        static_cast<std::size_t>(x)],
         name ? std::optional(name->center_nm) : std::nullopt});
  }
  return pixel;
}

}  // namespace abbe
